"""A sphere moves through its box

A sphere moves by three and a half radii and back. Each step moves the mesh, and repairs the tets that become bad before
they invert.
"""
import numpy as np
import pyvista as pv

import motet
from motet import shapes

moving = motet.MovingMesh(shapes.sphere_in_box(8, 6), smooth=2)
at_sphere = np.linalg.norm(moving.driven_places, axis=1) < 1.5
plotter = pv.Plotter(shape=(1, 3), border=False, window_size=(1200, 480))
look = dict(scalars="EAS", clim=(0, 1), show_edges=True, line_width=0.5, ambient=0.5, diffuse=0.5)
for k in range(1, 9):
    displacement = np.zeros_like(moving.driven_places)
    displacement[at_sphere, 0] = 3.5 * np.sin(np.pi * k / 8)
    step = moving.advance(k / 8, displacement)
    if k in (1, 4, 8):
        grid = moving.mesh.to_pyvista()
        grid["EAS"] = moving.mesh.quality()
        plotter.subplot(0, (1, 4, 8).index(k))
        tets = grid.extract_cells(moving.mesh.cell_ids("tetra")).clip("y", crinkle=True, invert=False)
        plotter.add_mesh(tets, **look, show_scalar_bar=k == 8)
        text = f"step {k}: {len(moving.mesh.tets)} tets, worst {step.worst.eas:.2f}"
        plotter.add_text(text, position="upper_edge", font_size=10)
        plotter.view_xz()
plotter.show(screenshot="sphere.png")
