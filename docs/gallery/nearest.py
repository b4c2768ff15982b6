"""Nearest points

From each vertex on the outer side of a coil a line goes to the nearest point of the wall of the aneurysm, coloured by its
length.
"""
import numpy as np
import pyvista as pv

import motet
from motet import shapes

vessel = shapes.aneurysm()
wall = motet.Mesh(vessel.points, vessel.triangles)
coil = shapes.coil((0.15, 2.4, 0), radius=0.7, pitch=0.35, turns=3)
contact = motet.Contact({"coil": coil, "vessel": wall}, room=["vessel"])
body = contact.measure().bodies["coil"]
feet = contact.points[body.vertices]
near = np.flatnonzero(body.gap < 0.6)[::2]

ends = np.stack([feet[near], body.closest_point[near]], axis=1)
lines = pv.line_segments_from_points(ends.reshape(-1, 3))
lines["gap"] = body.gap[near]
plotter = pv.Plotter()
plotter.add_mesh(wall.to_pyvista(), color="lightsteelblue", opacity=0.2)
plotter.add_mesh(coil.to_pyvista(), color="peru")
plotter.add_mesh(lines, scalars="gap", cmap="viridis_r", line_width=3)
plotter.camera_position = [(2, 5.5, 6.5), (0, 2.2, 0), (0, 1, 0)]
plotter.show(screenshot="nearest.png")
