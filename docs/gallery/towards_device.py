"""Refined towards a coil

Tets near a coil are divided until their edges are 0.1 long at the wire, and 0.7 longer per unit of distance. What
division made bad is repaired at the end.
"""
import pyvista as pv

import motet
from motet import shapes

vessel = motet.mesh(shapes.aneurysm(around=16), size="auto").mesh
coil = shapes.coil((0, 2.3, 0), radius=0.5, turns=2)
coiled = motet.implant(vessel, {"coil": coil}, inside="hollow").mesh
finer = motet.refine(coiled, near_size=[(coil, 0.15, 0.7)], at_most=60_000)
repaired = motet.remesh(finer.mesh)

plotter = pv.Plotter(shape=(1, 2), border=False, window_size=(1200, 560))
look = dict(scalars="EAS", clim=(0, 1), show_edges=True, line_width=0.5, ambient=0.5, diffuse=0.5)
for k, mesh in enumerate((coiled, repaired.mesh)):
    tets = mesh.to_pyvista().extract_cells(mesh.cell_ids("tetra"))
    tets["EAS"] = mesh.quality()[mesh.cell_ids("tetra")]
    plotter.subplot(0, k)
    plotter.add_mesh(tets.clip("z", crinkle=True), **look, show_scalar_bar=k == 1)
    plotter.add_mesh(coil.to_pyvista(), color="peru")
    text = f"{tets.n_cells} tets, worst {tets['EAS'].min():.2f}, mean {tets['EAS'].mean():.2f}"
    plotter.add_text(text, position="upper_edge", font_size=10)
    plotter.camera_position = [(0, 2.3, 8), (0, 2.3, 0), (0, 1, 0)]
plotter.show(screenshot="towards_device.png")
