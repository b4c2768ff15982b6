"""Draws the pictures of docs/guide from the output of the commands on its pages.

    ./test --setup && target/venv/bin/python -m pip install ./python    (once)
    cargo build --release
    target/venv/bin/python docs/guide_pictures.py         (writes docs/guide/*.png)

The commands of each page are run, as in `crosscheck/test_guide.py`, until the files for its picture exist.
"""
import sys
import tempfile
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pyvista as pv
from contact_picture import GAP
from pictures import COPPER, EDGES, HERE, INK, QUALITY, RANGE, colour_bar, lit, save_sheet, scale_of, seen_straight, shot, tets
from program import binary

sys.path.insert(0, str(HERE.parent / "crosscheck"))
from test_guide import follow  # noqa: E402

GUIDE = HERE / "guide"
SURFACE = dict(color="#dfe6ec", show_edges=True, edge_color=INK, line_width=0.9, edge_opacity=0.45, ambient=0.7, diffuse=0.38)
PANEL, SQUARE = (600, 390), (440, 440)
# Centre of view and visible height.
WHOLE, SAC = ((0.0, 0.6, 0.0), 7.0), ((0.0, 2.25, 0.0), 3.0)


def cut(mesh, panel=PANEL):
    """Return a scene with the cells behind the centre plane, coloured by quality."""
    plotter = lit(mesh, panel)
    behind = mesh.extract_cells(mesh.cell_centers().points[:, 2] < 0.0)
    plotter.add_mesh(behind, scalars="EAS", cmap=QUALITY, clim=RANGE, show_scalar_bar=False, **EDGES)
    return plotter


def outside(path):
    return pv.read(path).extract_surface(algorithm="dataset_surface")


def seen(plotter, view):
    return seen_straight(plotter, view[0], np.array([0.0, 0.0, 40.0]), (0.0, 1.0, 0.0), view[1])


def counted(mesh, what):
    bad = np.count_nonzero(mesh["EAS"] < 0.2)
    return f"{what}: {mesh.n_cells:,} tets, {f'{bad:,}' if bad else 'none'} bad"


def draw_mesh(folder):
    lumen = tets(folder / "lumen.vtu")
    surface = outside(folder / "vessel.stl")
    plotter = lit(surface, PANEL)
    plotter.add_mesh(surface, **SURFACE)
    save_sheet([(seen(plotter, WHOLE), f"the surface: {surface.n_cells:,} triangles"), (seen(cut(lumen), WHOLE), counted(lumen, "cut open"))], GUIDE / "mesh.png", bar=colour_bar)


def draw_wall_moves(folder):
    frames = [tets(folder / "out" / f"lumen_{k:04}.vtu") for k in (0, 4)]
    at_rest = outside(folder / "out" / "lumen_0000.vtu").slice(normal="z", origin=(0, 0, 0))
    pictures = []
    for mesh, text in zip(frames, ("at rest", "at its widest")):
        plotter = cut(mesh)
        if mesh is frames[1]:
            line = at_rest.copy()
            line.points[:, 2] = 2.0  # in front of everything else
            plotter.add_mesh(line, color=COPPER, line_width=4, lighting=False)
        pictures.append((seen(plotter, WHOLE), counted(mesh, text)))
    save_sheet(pictures, GUIDE / "wall-moves.png", bar=colour_bar)


def draw_device(folder):
    pictures = []
    for name, text in (("coiled", "put in"), ("fine", "refined"), ("better", "repaired")):
        mesh = tets(folder / f"{name}.vtu")
        plotter = cut(mesh, SQUARE)
        plotter.add_mesh(outside(folder / "coil.vtp"), color=COPPER, ambient=0.5, diffuse=0.5, specular=0.2, specular_power=10)
        pictures.append((seen(plotter, SAC), counted(mesh, text)))
    save_sheet(pictures, GUIDE / "device.png", bar=colour_bar)


def draw_gaps(folder):
    warn = 0.1
    entries = list(ElementTree.parse(folder / "out" / "gaps.pvd").iter("DataSet"))
    pictures = []
    for step in (2, 7, 9):
        mesh = pv.read(folder / "out" / entries[step].get("file"))
        stent = mesh.extract_cells(mesh["body"] == 1).extract_surface(algorithm="dataset_surface")
        artery = mesh.extract_cells(mesh["body"] == 2).extract_surface(algorithm="dataset_surface")
        plotter = lit(artery, (380, 440))
        plotter.add_mesh(stent, scalars="gap", cmap=GAP, clim=(0.0, 4 * warn), show_scalar_bar=False, ambient=0.5, diffuse=0.5)
        behind = artery.extract_cells(artery.cell_centers().points[:, 1] > 0.0)
        plotter.add_mesh(behind, color="#eef1f4", ambient=0.6, diffuse=0.4, show_edges=True, edge_color=INK, edge_opacity=0.15)
        plotter.camera_position = [(-9.5, -9.0, 6.5), (0.0, 0.0, 2.5), (0.0, 0.0, 1.0)]
        plotter.camera.view_angle = 23.0
        least = np.nanmin(mesh["gap"])
        pictures.append((shot(plotter), f"step {step}: least gap {least:.2f}" + (", warns" if least < warn else "")))

    save_sheet(pictures, GUIDE / "gaps.png", bar=scale_of(GAP, (0.0, 4 * warn), (0.0, warn, 2 * warn, 4 * warn), "gap"))


PICTURES = {"README": ("motet info", draw_mesh), "wall-moves": ("motet move lumen.vtu", draw_wall_moves), "device": ("motet remesh fine.vtu", draw_device), "gaps": ("motet contact stent.pvd", draw_gaps)}


def main():
    for page, (last, draw) in PICTURES.items():
        with tempfile.TemporaryDirectory() as folder:
            for command, code, lines in follow(GUIDE / f"{page}.md", binary(), Path(folder)):
                if code != command.code:
                    sys.exit(f"$ {command.text}\n" + "\n".join(lines))
                if command.text.startswith(last):
                    break
            draw(Path(folder))


if __name__ == "__main__":
    main()
