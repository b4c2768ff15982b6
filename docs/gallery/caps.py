"""Open ends, closed

The wall of a vessel with a sac ends at two open rims. `motet.cap` closes each with a patch of its own, an inlet and an
outlet; the rest is the patch `wall`. The closed surface is then filled.
"""
import pyvista as pv

import motet
from motet import shapes

vessel = shapes.aneurysm(bend_deg=40)
wall = motet.Mesh(vessel.points, vessel.triangles[vessel.cell_data["patch"] == 1])
closed = motet.cap(wall)
filled = motet.mesh(closed, size="auto")
print(filled.mesh.patch_names, filled.report.improved.after.bad, "bad tets")

plotter = pv.Plotter(shape=(1, 2), border=False, window_size=(1200, 500))
plotter.add_mesh(wall.to_pyvista(), color="lightsteelblue", show_edges=True, line_width=0.5)
plotter.add_text("open", position="upper_edge", font_size=10)
plotter.subplot(0, 1)
blocks = closed.to_pyvista().motet.blocks()
for name, patch in zip(blocks.keys(), blocks):
    colour = {"wall": "lightsteelblue", "cap_1": "tomato", "cap_2": "gold"}[name]
    plotter.add_mesh(patch, color=colour, show_edges=True, line_width=0.5)
plotter.add_text("closed by caps", position="upper_edge", font_size=10)
plotter.link_views()
plotter.camera_position = [(9, -13, 13), (0, 0.7, 0), (0, 1, 0)]
plotter.show(screenshot="caps.png")
