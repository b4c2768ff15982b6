"""Sides that slide

A piston presses the top of a box down by half. If the sides stay, the motion stops where tets would invert; if their
vertices slide in their planes, it arrives.
"""
import pyvista as pv

import motet
from motet import shapes

box = shapes.box((8, 8, 8))
press = {"zmax": (0, 0, -0.5)}
stays = motet.move(box, translate=press)
slides = motet.move(box, translate=press, slide=["xmin", "xmax", "ymin", "ymax"])

plotter = pv.Plotter(shape=(1, 2), border=False, window_size=(1200, 520))
for k, (moved, text) in enumerate(((stays, "the sides stay"), (slides, "the sides slide"))):
    certificate = moved.certificate
    grid = moved.mesh.to_pyvista().extract_cells(moved.mesh.cell_ids("tetra"))
    grid["downwards"] = grid.point_data_to_cell_data()["displacement"][:, 2]
    plotter.subplot(0, k)
    plotter.add_mesh(grid, scalars="downwards", clim=(-0.5, 0), show_edges=True, ambient=0.5, show_scalar_bar=k == 1)
    plotter.add_mesh(box.to_pyvista().outline(), color="black")
    text += f": {100 * certificate.fraction:.0f} % of the way, worst EAS {certificate.worst_eas.value:.2f}"
    plotter.add_text(text, position="upper_edge", font_size=10)
    plotter.camera_position = [(3, -3, 2), (0.5, 0.5, 0.5), (0, 0, 1)]
plotter.show(screenshot="sliding.png")
