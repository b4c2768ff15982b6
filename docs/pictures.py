"""Draws the picture of docs/remesh.md, and contains functions shared by the other drawing scripts.

    ./test --setup                                        (once: the Python packages)
    cargo run --release -p motet --example remesh_cases sphere target/moved.vtu
    cargo run --release -- remesh target/moved.vtu -o target/repaired.vtu --history target/history.json
    target/venv/bin/python docs/pictures.py target/moved.vtu target/repaired.vtu target/history.json

Shows the bad tets of a mesh and their replacements in a cut (writes docs/remesh.png).
"""
import json
import sys
from pathlib import Path

import numpy as np
import pyvista as pv
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.font_manager import findfont as find_font
from PIL import Image, ImageDraw, ImageFont
from vtkmodules.vtkFiltersVerdict import vtkMeshQuality

HERE = Path(__file__).resolve().parent
PANEL = (550, 550)
INK = "#22303c"
COPPER = "#b5652f"
# Options for drawing the edges of tets.
EDGES = dict(show_edges=True, edge_color=INK, line_width=0.8, edge_opacity=0.5, ambient=0.65, diffuse=0.4, specular=0.0)
RANGE = (0.0, 0.8)
# Red: bad (below 0.2); sand: fair; blue-green: good. Pale enough for edges to remain visible.
QUALITY = LinearSegmentedColormap.from_list("quality", [
    (0.0, "#7d0a2a"), (0.25, "#e0583f"), (0.4, "#f6d58e"), (0.6, "#b9dfc0"), (0.8, "#5fb3b3"), (1.0, "#17607a")])


def tets(path):
    """Read the tets of a file, with their equi-angle quality, which is negative for inverted tets."""
    mesh = pv.read(path)
    mesh = mesh.extract_cells(mesh.celltypes == pv.CellType.TETRA)
    verdict = vtkMeshQuality()
    verdict.SetInputData(mesh)
    verdict.SetTetQualityMeasureToEquiangleSkew()
    verdict.Update()
    skew = pv.wrap(verdict.GetOutput())["Quality"]
    a, b, c, d = mesh.points[mesh.cells_dict[pv.CellType.TETRA]].astype(float).transpose(1, 0, 2)
    mesh.cell_data["EAS"] = np.sign(np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a)) * (1.0 - skew)
    return mesh


def ball(mesh):
    """Return the part of the surface that is not on the walls of the box."""
    surface = mesh.extract_surface(algorithm="dataset_surface")
    low, high = np.array(surface.bounds).reshape(3, 2).T
    reach = 1e-6 * (high - low).max()
    on_wall = (np.abs(surface.cell_centers().points[:, None] - np.array([low, high])).min(axis=1) < reach).any(axis=1)
    return surface.extract_cells(~on_wall).extract_surface(algorithm="dataset_surface")


def lit(mesh, panel=PANEL):
    """Return an empty scene with lights for a mesh."""
    plotter = pv.Plotter(off_screen=True, window_size=panel, lighting="none")
    plotter.set_background("white")
    centre, size = np.array(mesh.center), mesh.length / np.sqrt(3.0)
    for place, strength in (((-0.8, -1.6, 1.4), 0.8), ((1.2, -1.0, 0.1), 0.3)):
        plotter.add_light(pv.Light(position=centre + 3 * size * np.array(place), focal_point=centre, intensity=strength))
    return plotter


def shot(plotter):
    """Render a scene to an image, and close it."""
    plotter.enable_anti_aliasing("ssaa")
    image = Image.fromarray(plotter.screenshot(return_img=True))
    plotter.close()
    return image


def seen_straight(plotter, centre, offset, up, height):
    """Render a scene in parallel projection from `centre` + `offset`, with a visible height."""
    centre = np.array(centre)
    plotter.camera_position = [centre + offset, centre, up]
    plotter.enable_parallel_projection()
    plotter.camera.parallel_scale = height / 2
    return shot(plotter)


def save_sheet(pictures, path, columns=None, bar=None):
    """Save pictures of equal size in rows of `columns` (default: one row), each with its text below.

    `bar` draws a colour scale below all pictures.
    """
    width, height = pictures[0][0].size
    columns = columns or len(pictures)
    rows, foot = -(-len(pictures) // columns), 52 if bar else 0
    sheet = Image.new("RGB", (columns * width, rows * (height + 40) + foot), "white")
    draw = ImageDraw.Draw(sheet)
    for i, (picture, text) in enumerate(pictures):
        left, top = i % columns * width, i // columns * (height + 40)
        sheet.paste(picture, (left, top))
        draw.text((left + width // 2, top + height + 8), text, fill=INK, font=font(17), anchor="ma")
    if bar:
        bar(draw, sheet.width // 2 - 180, sheet.height - foot + 6, 360)
    save(sheet, path)


CUT_PANEL = (550, 430)
BAD = "#d5352c"
NEW = "#1d9bb8"
# Chosen cells in front of the cut, up to this depth, are shown as well.
STANDS_OUT = -0.1


def cut_panel(mesh, chosen, colour):
    """Return an image of the cells behind the plane y = 0 in a pale colour, with the chosen ones in a solid
    colour.

    A few chosen cells in front of the plane are shown as well.
    """
    plotter = lit(mesh, CUT_PANEL)
    depth = mesh.cell_centers().points[:, 1]
    plotter.add_mesh(mesh.extract_cells((depth > 0.0) & ~chosen), color="#f1f3f5", show_edges=True, edge_color=INK, line_width=1.0,
                     edge_opacity=0.3, ambient=0.75, diffuse=0.28)
    plotter.add_mesh(mesh.extract_cells((depth > STANDS_OUT) & chosen), color=colour, show_edges=True, edge_color=INK,
                     line_width=1.2, edge_opacity=0.7, ambient=0.5, diffuse=0.55)
    plotter.add_mesh(ball(mesh), color="#b9c6d2", smooth_shading=True, ambient=0.3, diffuse=0.75, specular=0.12,
                     specular_power=8)
    centre = np.array(mesh.center)
    plotter.camera_position = [centre + np.array([-0.5, -6.5, 1.3]), centre + np.array([0.0, 0.0, -0.04]), (0.0, 0.0, 1.0)]
    plotter.camera.view_angle = 20.2
    return shot(plotter)


def draw_repair(moved, repaired, history):
    """Draw the bad tets before a repair, and the new tets after it."""
    before, after = tets(moved), tets(repaired)
    none = 2**32 - 1
    kept = np.array(json.loads(Path(history).read_text())["cells"]["kept"])
    kinds = pv.read(repaired).celltypes
    bad = before["EAS"] < 0.2
    new = kept[kinds == pv.CellType.TETRA] == none
    width, height = CUT_PANEL
    sheet = Image.new("RGB", (2 * width, height + 40), "white")
    draw = ImageDraw.Draw(sheet)
    panels = [(before, bad, BAD, f"before: {bad.sum():,} of {before.n_cells:,} tets are bad"),
              (after, new, NEW, f"after: {np.count_nonzero(after['EAS'] < 0.2) or 'none'} left, {new.sum():,} tets are new")]
    for column, (mesh, chosen, colour, text) in enumerate(panels):
        sheet.paste(cut_panel(mesh, chosen, colour), (column * width, 0))
        middle = column * width + width // 2
        half = draw.textlength(text, font=font(17)) / 2
        draw.rectangle([middle - half - 14, height + 5, middle - half, height + 19], fill=colour, outline=INK)
        draw.text((middle + 11, height + 2), text, fill=INK, font=font(17), anchor="ma")
    save(sheet, HERE / "remesh.png")


def save(sheet, path):
    sheet.quantize(256, kmeans=2, dither=Image.Dither.NONE).save(path, optimize=True)
    print(f"{path}: {path.stat().st_size // 1024} kB")


def font(size):
    return ImageFont.truetype(find_font("DejaVu Sans"), size)


def scale_of(colours, limits, ticks, name):
    """Return a function `(draw, left, top, width)` that draws a scale of these colours."""
    def bar(draw, left, top, width):
        for x in range(width):
            colour = tuple(int(255 * c) for c in colours(x / (width - 1))[:3])
            draw.line([(left + x, top), (left + x, top + 12)], fill=colour)
        for value in ticks:
            x = left + int((value - limits[0]) / (limits[1] - limits[0]) * (width - 1))
            draw.text((x, top + 18), f"{value:g}", fill=INK, font=font(15), anchor="ma")
        draw.text((left - 14, top + 6), name, fill=INK, font=font(16), anchor="rm")

    return bar


# The scale of quality, with the limit of bad tets.
colour_bar = scale_of(QUALITY, RANGE, (0.0, 0.2, 0.4, 0.6, 0.8), "EAS")


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    draw_repair(*sys.argv[1:])
