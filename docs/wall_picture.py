"""Draws a vessel that branches with its wall (writes docs/wall.png).

    ./test --setup                                        (once: the Python packages)
    cargo run --release -p motet --example shapes target
    cargo run --release -- mesh target/bifurcation.vtp -o target/blood.vtu --size auto
    cargo run --release -- wall target/blood.vtu -o target/fsi.vtu --of-radius 0.2 --layers 2
    target/venv/bin/python docs/wall_picture.py target/fsi.vtu

Shows blood and wall behind a plane along the vessel; in the middle where it branches; on the right the outer side.
"""
import sys

import numpy as np
import pyvista as pv
from pictures import COPPER, HERE, INK, lit, save_sheet, seen_straight

PANEL = (520, 400)
BLOOD = "#d9a0a0"


def panel(blood, wall, centre, height, behind=True):
    """Return an image of blood and wall behind the plane z = 0, or of all of the wall."""
    plotter = lit(wall, PANEL)
    for mesh, colour in [(blood, BLOOD), (wall, COPPER)]:
        part = mesh.extract_cells(mesh.cell_centers().points[:, 2] < 0.0) if behind else mesh
        plotter.add_mesh(part, color=colour, show_edges=behind, edge_color=INK, line_width=0.8, edge_opacity=0.5, ambient=0.5, diffuse=0.5, specular=0.0)
    return seen_straight(plotter, centre, (0.0, -8.0 if behind else -25.0, 40.0), (0.0, 1.0, 0.0), height)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    mesh = pv.read(sys.argv[1])
    solid = mesh.celltypes == pv.CellType.TETRA
    region = mesh.cell_data["region"]
    blood, wall = (mesh.extract_cells(np.flatnonzero(solid & (region == number))) for number in (1, 2))
    panels = [(panel(blood, wall, (0.2, 0.0, 0.0), 8.6), f"{blood.n_cells:,} tets of blood, {wall.n_cells:,} of the wall"),
              (panel(blood, wall, (0.9, 0.0, 0.0), 2.2), "where it branches"), (panel(blood, wall, (0.2, 0.0, 0.0), 8.6, behind=False), "the outer side")]
    save_sheet(panels, HERE / "wall.png")


if __name__ == "__main__":
    main()
