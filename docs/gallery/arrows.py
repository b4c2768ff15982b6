"""Displacements as arrows

The wall of a vessel swells along its normals; its ends slide in their planes. Arrows show how far each vertex of the
surface moved, twice as long as it is.
"""
import numpy as np
import pyvista as pv

import motet
from motet import shapes

vessel = motet.mesh(shapes.aneurysm(), size="auto").mesh
centre = np.array([0, 2.3, 0])
away = vessel.points - centre
share = np.exp(-np.sum(away**2, axis=1) / 3)[:, None]
moved = motet.move(vessel, displacement=0.35 * share * away, slide=["inlet", "outlet"])

surface = moved.mesh.to_pyvista().extract_surface(algorithm="dataset_surface")
arrows = surface.glyph(orient="displacement", scale="displacement", factor=1.5, tolerance=0.015)
plotter = pv.Plotter()
plotter.add_mesh(vessel.to_pyvista().extract_surface(algorithm="dataset_surface"), color="lightgrey", opacity=0.5)
plotter.add_mesh(arrows, scalars="GlyphScale", cmap="plasma", scalar_bar_args={"title": "displacement"})
plotter.view_xy()
plotter.camera.zoom(1.4)
plotter.show(screenshot="arrows.png")
