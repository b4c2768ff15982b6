"""Draws two meshes at extreme positions of their walls (writes docs/run.png).

    ./test --setup                                        (once: the Python packages)
    cargo run --release -- demo motet-demo
    target/venv/bin/python docs/demo_picture.py motet-demo

Shows the tets behind a plane, coloured by equi-angle quality: the aneurysm with a coil when its wall is
widest and narrowest, and the dissection when its flap is up and down.
"""
import sys
from pathlib import Path

import pyvista as pv
from pictures import COPPER, EDGES, HERE, QUALITY, RANGE, lit, save_sheet, seen_straight

PANEL = (520, 400)


def frame(folder, name, k):
    return pv.read(folder / f"{name}_{k:04d}.vtu")


def behind(mesh, axis, at):
    tets = mesh.extract_cells(mesh.celltypes == pv.CellType.TETRA)
    return tets.extract_cells(tets.cell_centers().points[:, axis] < at)


def panel(mesh, axis, at, focus, height, offset, up, sheet=None):
    """Return an image of the tets behind a plane, with the line in which a sheet cuts the plane in copper."""
    plotter = lit(mesh, PANEL)
    if sheet is not None:
        label = int(mesh.field_data[f"patch:{sheet}"][0])
        flap = mesh.extract_cells((mesh.celltypes == pv.CellType.TRIANGLE) & (mesh.cell_data["patch"] == label))
        rim = flap.extract_cells(abs(flap.cell_centers().points[:, axis] - at) < 0.12)
        lines = rim.extract_all_edges().translate([1.0 if k == axis else 0.0 for k in range(3)])
        plotter.add_mesh(lines, color=COPPER, line_width=5.0, lighting=False)
    plotter.add_mesh(behind(mesh, axis, at), scalars="eas", cmap=QUALITY, clim=RANGE, show_scalar_bar=False, **EDGES)
    return seen_straight(plotter, focus, offset, up, height)


def text(mesh, what):
    tets = mesh.celltypes == pv.CellType.TETRA
    eas = mesh.cell_data["eas"][tets]
    return f"{what}: {tets.sum():,} tets, worst {eas.min():.2f}"


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder = Path(sys.argv[1])
    panels = []
    for k, what in ((4, "wall out"), (12, "wall in")):
        mesh = frame(folder, "aneurysm", k)
        panels.append((panel(mesh, 2, 0.0, (0.0, 0.9, 0.0), 6.6, (0.0, 0.0, 40.0), (0.0, 1.0, 0.0)), text(mesh, what)))
    for k, what in ((6, "flap up"), (18, "flap down")):
        mesh = frame(folder, "dissection", k)
        panels.append((panel(mesh, 2, 3.0, (0.0, 0.0, 3.0), 2.2, (0.0, 0.0, 40.0), (0.0, 1.0, 0.0), "flap"), text(mesh, what)))
    save_sheet(panels, HERE / "run.png")


if __name__ == "__main__":
    main()
