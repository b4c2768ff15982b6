"""Refined by a field

The second derivatives of a field say where tets are too large to interpolate it: here around a shell of radius 0.6. The
field is computed on 30,000 tets, where it needs them.
"""
import numpy as np
import pyvista as pv

import motet
from motet import shapes


def field(points):
    return np.tanh(20 * (np.linalg.norm(points, axis=1) - 0.6))


mesh = shapes.box((6, 6, 6))
for aim in (8_000, 30_000):
    mesh.point_data["field"] = field(mesh.points)
    mesh = motet.refine(mesh, hessian={"field": aim}).mesh
mesh.point_data["field"] = field(mesh.points)

tets = mesh.to_pyvista().extract_cells(mesh.cell_ids("tetra"))
plotter = pv.Plotter()
part = tets.clip(normal=(-1, 0, 0), origin=(0.3, 0, 0), crinkle=True)
plotter.add_mesh(part, scalars="field", cmap="coolwarm", show_edges=True, line_width=0.5, ambient=0.5, diffuse=0.5)
plotter.add_mesh(tets.outline(), color="black")
plotter.add_text(f"{tets.n_cells} tets", position="upper_edge", font_size=10)
plotter.camera_position = [(-1.6, -1.8, 1.6), (0.55, 0.5, 0.45), (0, 0, 1)]
plotter.show(screenshot="by_field.png")
