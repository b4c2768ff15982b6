"""The same motion by two methods

A sphere turns by 60 degrees in its box. The Delaunay graph is the cheapest method and made for shifts; `bodies` is made
for bodies that turn. Colour is the quality after the motion, without repair.
"""
import pyvista as pv

import motet
from motet import shapes

box = shapes.sphere_in_box(8, 8)
turn = {"sphere": ((0, 1, 0), 60)}
panels = {"at first": box}
for method in ("delaunay", "bodies"):
    panels[method] = motet.move(box, rotate=turn, method=method, smooth=2).mesh

plotter = pv.Plotter(shape=(1, 3), border=False, window_size=(1200, 480))
look = dict(scalars="EAS", clim=(0, 1), show_edges=True, line_width=0.5, ambient=0.5, diffuse=0.5)
for k, (text, mesh) in enumerate(panels.items()):
    tets = mesh.to_pyvista().extract_cells(mesh.cell_ids("tetra"))
    tets["EAS"] = mesh.quality()[mesh.cell_ids("tetra")]
    plotter.subplot(0, k)
    plotter.add_mesh(tets.clip("y", crinkle=True, invert=False), **look, show_scalar_bar=k == 2)
    text += f": {(tets['EAS'] < 0.2).sum()} bad, mean {tets['EAS'].mean():.2f}"
    plotter.add_text(text, position="upper_edge", font_size=10)
    plotter.view_xz()
plotter.show(screenshot="methods.png")
