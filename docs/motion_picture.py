"""Draws a flap that bends by 60 degrees, moved by two methods (writes docs/motion.png).

    ./test --setup                                        (once: the Python packages)
    target/venv/bin/python docs/motion_picture.py target  (writes target/flap.vtu, a mesh by Gmsh)
    cargo run --release -- move target/flap.vtu -o target/flap_delaunay.vtu --displacement u --smooth 16
    cargo run --release -- move target/flap.vtu -o target/flap_guided.vtu --displacement u --smooth 16 --method guided
    target/venv/bin/python docs/motion_picture.py target/flap.vtu target/flap_delaunay.vtu target/flap_guided.vtu

Shows a cut through the channel at z = 0, coloured by the equi-angle quality of tets; bad tets are red.
"""
import sys
from pathlib import Path

import numpy as np
import pyvista as pv

from pictures import HERE, QUALITY, RANGE, lit, save_sheet, seen_straight, tets

sys.path.append(str(HERE.parent / "bench-compare"))
PANEL = (520, 470)
ANGLE = np.radians(60.0)


def bent(points):
    """Return displacements that bend the flap to an arc, and are 0 elsewhere."""
    x, y, z = points.T
    along = y + 1.0
    moved = np.stack([(1.0 - np.cos(ANGLE * along)) / ANGLE + x * np.cos(ANGLE * along),
                      np.sin(ANGLE * along) / ANGLE - 1.0 - x * np.sin(ANGLE * along), z], axis=1)
    is_flap = (np.abs(x) < 0.0301) & (y < 1e-6) & (np.abs(z) < 0.5001)
    return np.where(is_flap[:, None], moved - points, 0.0)


def write(folder):
    from meshes import flap_in_channel

    points, cells = flap_in_channel()
    mesh = pv.UnstructuredGrid({pv.CellType.TETRA: cells}, points)
    mesh.point_data["u"] = bent(points)
    mesh.save(Path(folder) / "flap.vtu")


def panel(path):
    mesh = tets(path)
    cut = mesh.slice(normal="z", origin=(0.0, 0.0, 1e-4), generate_triangles=False)
    plotter = lit(cut, PANEL)
    plotter.add_mesh(cut, scalars="EAS", cmap=QUALITY, clim=RANGE, show_scalar_bar=False, lighting=False, show_edges=True,
                     edge_color="#2b3640", line_width=0.8, edge_opacity=0.7)
    return seen_straight(plotter, (0.3, -0.3, 0.0), (0.0, 0.0, 100.0), (0.0, 1.0, 0.0), 1.6), int((mesh["EAS"] < 0.2).sum())


def main():
    if len(sys.argv) == 2:
        return write(sys.argv[1])
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    pictures = [panel(path) for path in sys.argv[1:]]
    captions = ("a flap in a channel", "bent, --method delaunay", "bent, --method guided")
    save_sheet([(picture, f"{text}: {bad} bad tets") for (picture, bad), text in zip(pictures, captions)], HERE / "motion.png")


if __name__ == "__main__":
    main()
