"""Draws an aneurysm refined towards a coil (writes docs/refine.png).

    ./test --setup                                        (once: the Python packages)
    cargo run --release -p motet --example coil target/coil.vtp
    cargo run --release -- refine ANEURYSM -o target/fine.vtu --near-size target/coil.vtp=0.075
    target/venv/bin/python docs/refine_picture.py target/fine.vtu target/coil.vtp

ANEURYSM is `aneurysm.xml.gz` of the DOLFIN project (LGPL-3; data/meshes). A plane through the axis of the
coil cuts the tets. The outline of the wire is dark; on the right is one turn.
"""
import sys

import pyvista as pv

from pictures import HERE, QUALITY, RANGE, lit, save_sheet, seen_straight, tets

PANEL = (520, 560)
PLANE = 43.3
# Centre of view and visible height.
VIEWS = (((50.5, PLANE, 27.0), 48.0), ((53.7, PLANE, 35.3), 7.6), ((55.2, PLANE, 35.3), 0.9))


def panel(cut, coil, wall, centre, height):
    """Return an image of a cut with the outline of the wire, and of the wall if the view is large."""
    plotter = lit(cut, PANEL)
    is_whole = height > 20.0
    plotter.add_mesh(cut, scalars="EAS", cmap=QUALITY, clim=RANGE, show_scalar_bar=False, lighting=False,
                     show_edges=not is_whole, edge_color="#2b3640", line_width=0.8, edge_opacity=0.7)
    lift = coil.slice(normal="y", origin=(0.0, PLANE, 0.0)).translate((0.0, -0.01, 0.0))
    plotter.add_mesh(lift, color="#14181c", line_width=1.5 if is_whole else 4.0, lighting=False)
    if is_whole:
        plotter.add_mesh(wall, color="#d9a79a", opacity=0.3, ambient=0.4, diffuse=0.6)
    return seen_straight(plotter, centre, (0.0, -100.0, 0.0), (0.0, 0.0, 1.0), height)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    mesh, coil = tets(sys.argv[1]), pv.read(sys.argv[2])
    cut = mesh.slice(normal="y", origin=(0.0, PLANE, 0.0), generate_triangles=False)
    wall = mesh.extract_surface(algorithm="dataset_surface")
    texts = (f"{mesh.n_cells:,} tets", "the sac, cut through", "one turn of the wire, four tets across")
    save_sheet([(panel(cut, coil, wall, *view), text) for view, text in zip(VIEWS, texts)], HERE / "refine.png")


if __name__ == "__main__":
    main()
