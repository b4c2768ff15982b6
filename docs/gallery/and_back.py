"""Refined, and back

A ball passes through a mesh. Tets are divided where it is, and divisions are undone where it was. In the end the mesh is
the first one again, point for point.
"""
import numpy as np
import pyvista as pv

import motet
from motet import shapes

first = shapes.box((12, 4, 6), high=(3, 1, 1.5))
plotter = pv.Plotter(shape=(2, 2), border=False, window_size=(1100, 640))
mesh = first
for k, x in enumerate((0.6, 1.5, 2.4, 9.0)):
    mesh = motet.refine(mesh, ball=[((x, 0, 0.75), 0.35)], generations=2, coarsen=True).mesh
    plotter.subplot(*divmod(k, 2))
    tets = mesh.to_pyvista().extract_cells(mesh.cell_ids("tetra"))
    tets["EAS"] = mesh.quality()[mesh.cell_ids("tetra")]
    plotter.add_mesh(tets, scalars="EAS", clim=(0, 1), show_edges=True, ambient=0.5, diffuse=0.5, show_scalar_bar=False)
    plotter.add_text(f"{tets.n_cells} tets, worst {tets['EAS'].min():.2f}", position="upper_edge", font_size=10)
    plotter.camera_position = [(1.5, -4.2, 1.9), (1.5, 0.4, 0.7), (0, 0, 1)]
print("the same as at first:", np.array_equal(mesh.points, first.points) and np.array_equal(mesh.tets, first.tets))
plotter.show(screenshot="and_back.png")
