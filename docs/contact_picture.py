"""Draws a stent that expands in an artery, coloured by its gaps (writes docs/contact.png).

    ./test --setup                                        (once: the Python packages)
    cargo run --release -p motet --example contact_stent target/contact/stent.pvd
    cargo run --release -- contact target/contact/stent.pvd VESSEL -o target/contact/gaps.pvd --warn 0.15
    target/venv/bin/python docs/contact_picture.py target/contact

VESSEL is `id1_model.vtp` of the VMTK tutorials (BSD-3; github.com/vmtk/vmtk.github.com,
resources/img/tutorials).
"""
import sys
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pyvista as pv
from matplotlib.colors import LinearSegmentedColormap

from pictures import HERE, lit, save_sheet, scale_of, shot

PANEL = (420, 330)
RANGE = (0.0, 0.6)
WARN = 0.15
STEPS = (0, 12, 15)
# Red: warning (below a quarter of the range); blue: far.
GAP = LinearSegmentedColormap.from_list("gap", [
    (0.0, "#8c0f2d"), (0.249, "#e0583f"), (0.251, "#f0c36a"), (0.6, "#8fc7b4"), (1.0, "#2b6c8a")])


def panel(mesh):
    """Return an image of the stent and the transparent wall, with warnings on the wall highlighted."""
    body = mesh.cell_data["body"]
    stent = mesh.extract_cells(body == 1).extract_surface(algorithm="dataset_surface")
    wall = mesh.extract_cells(body == 2).extract_surface(algorithm="dataset_surface")
    plotter = lit(stent, PANEL)
    plotter.add_mesh(wall, color="#d9c7bb", opacity=0.22, smooth_shading=True, ambient=0.35, diffuse=0.6, specular=0.1)
    near = wall.threshold(0.5, scalars="warning", all_scalars=False) if wall["warning"].any() else None
    if near is not None and near.n_cells:
        plotter.add_mesh(near, color="#e0583f", opacity=0.55, ambient=0.5, diffuse=0.4)
    plotter.add_mesh(stent, scalars="gap", cmap=GAP, clim=RANGE, show_scalar_bar=False, ambient=0.65, diffuse=0.45)
    centre = np.array(wall.center)
    plotter.camera_position = [centre + np.array([-62.0, 4.0, 16.0]), centre + np.array([0.0, -1.2, -0.6]), (0.0, 0.0, 1.0)]
    plotter.camera.view_angle = 15.5
    plotter.enable_depth_peeling(8)
    return shot(plotter)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder = Path(sys.argv[1])
    entries = list(ElementTree.parse(folder / "gaps.pvd").iter("DataSet"))
    pictures = []
    for step in STEPS:
        mesh = pv.read(folder / entries[step].get("file"))
        stent = np.unique(mesh.cells_dict[pv.CellType.TRIANGLE][mesh.cell_data["body"] == 1])
        gap, warned = np.nanmin(mesh["gap"]), int(mesh["warning"][stent].sum())
        pictures.append((panel(mesh), f"step {step}: gap {gap:.2f} mm, " + (f"{warned:,} vertices warn" if warned else "no warning")))
    save_sheet(pictures, HERE / "contact.png", bar=scale_of(GAP, RANGE, (0.0, WARN, 0.3, 0.45, 0.6), "gap"))


if __name__ == "__main__":
    main()
