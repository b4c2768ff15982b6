"""Sizes from curvature

Edges are a third as long as the radius of curvature of the wall, within limits, and grow inwards. The triangles of the
wall are changed, too: by at most 0.03.
"""
import numpy as np
import pyvista as pv

import motet
from motet import shapes

coarse = motet.mesh(shapes.aneurysm(around=16), size="auto").mesh
wall = coarse.to_pyvista().extract_surface(algorithm="dataset_surface")
bend = np.maximum(abs(wall.curvature("maximum")), abs(wall.curvature("minimum")))
at_wall = np.clip(1 / (3 * np.maximum(bend, 1e-6)), 0.15, 0.6)
distance = np.linalg.norm(coarse.points[:, None] - wall.points[None], axis=2)
sizes = np.min(at_wall + 0.4 * distance, axis=1)
fine = motet.remesh(coarse, sizes=sizes, surface="adapt", distance=0.03).mesh

tets = fine.to_pyvista().extract_cells(fine.cell_ids("tetra")).clip("z", crinkle=True)
tets["edge length"] = np.cbrt(6 * np.sqrt(2) * abs(tets.compute_cell_sizes()["Volume"]))
plotter = pv.Plotter()
plotter.add_mesh(tets, scalars="edge length", cmap="viridis_r", show_edges=True, line_width=0.5, ambient=0.5)
plotter.camera_position = [(1, 0.5, 20), (1, 0.5, 0), (0, 1, 0)]
plotter.show(screenshot="sizes.png")
