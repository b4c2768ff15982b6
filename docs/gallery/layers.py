"""Boundary layers

Four layers of prisms on the wall of a vessel, the first 0.03 thick and each next one 1.3 times as thick. The ends have
none. Prisms are kept here; by default they are divided into tets.
"""
import pyvista as pv

import motet
from motet import shapes

vessel = motet.mesh(shapes.aneurysm(around=32), size="auto", layers={"wall": (4, 0.03, 1.3)}, keep_prisms=True).mesh

half = vessel.to_pyvista().extract_cells(vessel.kinds > pv.CellType.TRIANGLE).clip("z", crinkle=True)
is_tet = half.celltypes == pv.CellType.TETRA
plotter = pv.Plotter()
plotter.add_mesh(half.extract_cells(is_tet), color="darkgrey", show_edges=True, line_width=0.5, ambient=0.4, label="tets")
plotter.add_mesh(half.extract_cells(~is_tet), color="steelblue", show_edges=True, line_width=0.5, ambient=0.4, label="prisms")
plotter.add_legend(face="rectangle", bcolor=None, size=(0.15, 0.12), loc="upper left")
plotter.view_xy()
plotter.camera.zoom(1.5)
plotter.show(screenshot="layers.png")
