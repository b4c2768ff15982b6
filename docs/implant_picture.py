"""Draws devices implanted in meshes (writes docs/implant_ball.png, docs/implant.png and
docs/implant_wall.png).

    ./test --setup                                        (once: the Python packages)
    cargo run --release -p motet --example shapes target
    cargo run --release -- mesh target/aneurysm.vtp -o target/host.vtu --size 0.3 --growth 0.3
    cargo run --release -- implant target/box.vtu target/ball.vtu -o target/with_ball.vtu
    cargo run --release -- implant target/host.vtu target/loops.vtp -o target/with_coil.vtu
    cargo run --release -- implant target/host.vtu target/stent.vtp -o target/with_stent.vtu
    target/venv/bin/python docs/implant_picture.py target

Shows a ball in a box, a coil in an aneurysm, and a stent across its neck. The tets behind a plane are
coloured by equi-angle quality in the host, and copper in the device. The surface of the stent is copper
inside the vessel, and blue where it shares the wall.
"""
import sys
from pathlib import Path

import numpy as np
import pyvista as pv
from pictures import COPPER, EDGES, HERE, QUALITY, RANGE, lit, save_sheet, seen_straight, shot, tets

PANEL = (520, 400)
BLUE = "#2f7fb5"
# Centre of view and visible height.
WHOLE, TURNS, BOX = ((0.0, 0.3, 0.0), 8.2), ((0.75, 2.2, 0.0), 1.8), ((0.0, 0.0, 0.0), 5.9)
ACROSS = ((0.0, 0.0, 0.0), 2.6)


def panel(mesh, view, axis=2, offset=(0.0, -8.0, 40.0), up=(0.0, 1.0, 0.0)):
    """Return an image of the cells behind the plane through the origin normal to an axis."""
    plotter = lit(mesh, PANEL)
    behind = mesh.cell_centers().points[:, axis] * np.sign(offset[axis]) < 0.0
    in_device = mesh.cell_data["region"] > 1
    lumen = mesh.extract_cells(behind & ~in_device)
    plotter.add_mesh(lumen, scalars="EAS", cmap=QUALITY, clim=RANGE, show_scalar_bar=False, **EDGES)
    if (behind & in_device).any():
        plotter.add_mesh(mesh.extract_cells(behind & in_device), color=COPPER, **EDGES)
    return seen_straight(plotter, view[0], offset, up, view[1])


def surface_panel(path):
    """Return an image of the surface of the stent, inside the vessel and shared with the transparent wall."""
    mesh = pv.read(path)
    mesh = mesh.extract_cells(mesh.celltypes == pv.CellType.TRIANGLE)
    plotter = lit(mesh, PANEL)
    patch = mesh.cell_data["patch"]
    contact = patch.max()
    plotter.add_mesh(mesh.extract_cells(patch == contact - 1), color=COPPER, **EDGES)
    plotter.add_mesh(mesh.extract_cells(patch == contact), color=BLUE, **EDGES)
    veil = mesh.extract_cells((patch < contact - 1) & (mesh.cell_centers().points[:, 2] < 0.0))
    plotter.add_mesh(veil, color="#dfe6ec", opacity=0.45, ambient=0.6, diffuse=0.4)
    plotter.camera_position = [(5.0, 9.5, 17.0), (0.0, 0.1, 0.0), (0.0, 1.0, 0.0)]
    plotter.camera.view_angle = 20.0
    return shot(plotter)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder = Path(sys.argv[1])
    names = ("box", "with_ball", "host", "with_coil", "with_stent")
    box, with_ball, host, with_coil, with_stent = (tets(folder / f"{name}.vtu") for name in names)

    def text(mesh, what):
        return f"{what}: {mesh.n_cells:,} tets, {int((mesh.cell_data['region'] > 1).sum()):,} in it"

    save_sheet([(panel(box, BOX), f"a box of {box.n_cells:,} tets"), (panel(with_ball, BOX), text(with_ball, "with a ball"))], HERE / "implant_ball.png")
    save_sheet([(panel(host, WHOLE), f"host: {host.n_cells:,} tets"), (panel(with_coil, WHOLE), text(with_coil, "with the coil")),
              (panel(with_coil, TURNS), "turns of the coil")], HERE / "implant.png")
    save_sheet([(panel(with_stent, WHOLE), text(with_stent, "with the stent")),
              (panel(with_stent, ACROSS, axis=0, offset=(40.0, 6.0, 0.0)), "across the vessel, at the neck"),
              (surface_panel(folder / "with_stent.vtu"), "blue: stent and wall in common")], HERE / "implant_wall.png")


if __name__ == "__main__":
    main()
