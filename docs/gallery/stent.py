"""A stent in its artery

A stent is put into the mesh of an artery. Struts and artery share their vertices; the flow goes around the struts. The few bad
tets lie on narrow triangles of the stent.
"""
import numpy as np
import pyvista as pv

import motet
from motet import shapes

artery = shapes.tube(n=6, slices=24)
stent = shapes.stent(0.8, length=3, rings=3, crowns=4, strut_width=0.12)
stent.points += (0, 0, 1)
stented = motet.implant(artery, {"stent": stent}, inside="hollow")
tets = stented.mesh.to_pyvista().extract_cells(stented.mesh.cell_ids("tetra"))
tets["EAS"] = stented.mesh.quality()[stented.mesh.cell_ids("tetra")]
bad = (tets["EAS"] < 0.2).sum()
reasons = {next(iter(left.reason)) for left in stented.report.improved.left}
print(f"{tets.n_cells} tets, {bad} bad because of {reasons}")
print(f"EAS worst {tets['EAS'].min():.3f}, median {np.median(tets['EAS']):.3f}, mean {tets['EAS'].mean():.3f}")

plotter = pv.Plotter()
look = dict(scalars="EAS", clim=(0, 1), show_edges=True, line_width=0.5, ambient=0.5, diffuse=0.5)
plotter.add_mesh(tets.clip("y", crinkle=True, invert=False), **look)
plotter.add_mesh(stent.to_pyvista(), color="lightgrey", smooth_shading=True, split_sharp_edges=True, specular=0.5)
plotter.camera_position = [(5, -10, 4), (0, 0, 2), (1, 0, 0)]
plotter.camera.zoom(1.1)
plotter.show(screenshot="stent.png")
