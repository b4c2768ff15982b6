"""A wall around a vessel

A solid wall of two layers, a fifth of the local radius thick, which shares the vertices of the blood: what fluid-structure
interaction starts from.
"""
import pyvista as pv

import motet
from motet import shapes

blood = motet.mesh(shapes.aneurysm(around=32), size="auto").mesh
done = motet.wall(blood, of_radius=0.2, layers=2)

half = done.mesh.to_pyvista().extract_cells(done.mesh.kinds == pv.CellType.TETRA).clip("z", crinkle=True)
is_wall = half.cell_data["region"] == done.report.region
plotter = pv.Plotter()
plotter.add_mesh(half.extract_cells(~is_wall), color="indianred", show_edges=True, line_width=0.5, ambient=0.4, label="blood")
plotter.add_mesh(half.extract_cells(is_wall), color="tan", show_edges=True, line_width=0.5, ambient=0.4, label="wall")
plotter.add_legend(face="rectangle", bcolor=None, size=(0.15, 0.12), loc="upper left")
plotter.view_xy()
plotter.camera.zoom(1.5)
plotter.show(screenshot="wall.png")
