"""Draws an aneurysm filled with tets, without and with boundary layers (writes docs/mesh.png).

    ./test --setup                                        (once: the Python packages)
    cargo run --release -p motet --example shapes target
    cargo run --release -- mesh target/aneurysm.vtp -o target/filled.vtu --size auto
    cargo run --release -- mesh target/aneurysm.vtp -o target/layered.vtu --size 0.4 --growth 0.3 --layers 4,0.02,1.4
    target/venv/bin/python docs/mesh_picture.py target/filled.vtu target/layered.vtu

Shows the tets behind a plane along the vessel, coloured by equi-angle quality; on the right the neck of the
sac.
"""
import sys

from pictures import HERE, INK, QUALITY, RANGE, lit, save_sheet, seen_straight, tets

PANEL = (520, 400)
# Centre of view and visible height.
WHOLE, NECK = ((0.0, 0.3, 0.0), 8.2), ((-1.25, 1.0, 0.0), 1.3)


def panel(mesh, centre, height):
    """Return an image of the cells behind the plane."""
    plotter = lit(mesh, PANEL)
    behind = mesh.extract_cells(mesh.cell_centers().points[:, 2] < 0.0)
    plotter.add_mesh(behind, scalars="EAS", cmap=QUALITY, clim=RANGE, show_scalar_bar=False, show_edges=True, edge_color=INK, line_width=0.8,
                     edge_opacity=0.5, ambient=0.65, diffuse=0.4, specular=0.0)
    return seen_straight(plotter, centre, (0.0, -8.0, 40.0), (0.0, 1.0, 0.0), height)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    filled, layered = (tets(path) for path in sys.argv[1:])
    panels = [(filled, WHOLE, f"{filled.n_cells:,} tets, sizes from the surface"), (layered, WHOLE, f"{layered.n_cells:,} tets, four layers on the wall"),
              (layered, NECK, "the neck of the sac")]
    save_sheet([(panel(mesh, *view), text) for mesh, view, text in panels], HERE / "mesh.png")


if __name__ == "__main__":
    main()
