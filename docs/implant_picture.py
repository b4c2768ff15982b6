"""Draws a coil in an aneurysm, before and after it is put in (writes docs/implant.png).

    ./test --setup                                        (once: the Python packages)
    cargo run --release -p motet --example shapes target
    cargo run --release -- mesh target/aneurysm.vtp -o target/host.vtu --size 0.3 --growth 0.3
    cargo run --release -- implant target/host.vtu target/loops.vtp -o target/coiled.vtu
    target/venv/bin/python docs/implant_picture.py target/host.vtu target/coiled.vtu

The tets behind a plane along the vessel: the lumen coloured by its equi-angle quality, the coil in copper; on the right the turns of the coil.
"""
import sys

from pictures import HERE, INK, QUALITY, RANGE, lit, save_row, seen_straight, tets

PANEL = (520, 400)
COPPER = "#b5652f"
# Where the camera looks, and how much it sees from top to bottom.
WHOLE, TURNS = ((0.0, 0.3, 0.0), 8.2), ((0.75, 2.2, 0.0), 1.8)


def panel(mesh, centre, height):
    """The cells behind the plane."""
    plotter = lit(mesh, PANEL)
    behind = mesh.cell_centers().points[:, 2] < 0.0
    in_device = mesh.cell_data["region"] > 1
    common = dict(show_edges=True, edge_color=INK, line_width=0.8, edge_opacity=0.5, ambient=0.65, diffuse=0.4, specular=0.0)
    lumen = mesh.extract_cells(behind & ~in_device)
    plotter.add_mesh(lumen, scalars="EAS", cmap=QUALITY, clim=RANGE, show_scalar_bar=False, **common)
    if in_device.any():
        plotter.add_mesh(mesh.extract_cells(behind & in_device), color=COPPER, **common)
    return seen_straight(plotter, centre, (0.0, -8.0, 40.0), (0.0, 1.0, 0.0), height)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    host, coiled = (tets(path) for path in sys.argv[1:])
    in_coil = int((coiled.cell_data["region"] > 1).sum())
    panels = [(host, WHOLE, f"host: {host.n_cells:,} tets"), (coiled, WHOLE, f"with the coil: {coiled.n_cells:,} tets, {in_coil:,} in the coil"),
              (coiled, TURNS, "turns of the coil")]
    save_row([(panel(mesh, *view), text) for mesh, view, text in panels], HERE / "implant.png")


if __name__ == "__main__":
    main()
