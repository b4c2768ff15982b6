"""A coil that turns in an aneurysm

The method `bodies` carries the mesh around a coil along as the coil turns by 40 degrees and shifts. The tets that become
bad are repaired afterwards.
"""
import pyvista as pv

import motet
from motet import shapes

vessel = motet.mesh(shapes.aneurysm(), size="auto").mesh
coil = shapes.coil((0, 2.3, 0), radius=0.5)
coiled = motet.implant(vessel, {"coil": coil}, inside="hollow").mesh
turn, shift = {"coil": ((0, 0, 1), 40)}, {"coil": (0, -0.3, 0)}
moved = motet.move(coiled, rotate=turn, translate=shift, method="bodies", bodies=["coil"])
repaired = motet.remesh(moved.mesh)
print(moved.certificate.bad, "bad tets after the motion,", repaired.report.after.bad, "after the repair")

plotter = pv.Plotter(shape=(1, 3), border=False, window_size=(1200, 480))
look = dict(scalars="EAS", clim=(0, 1), show_edges=True, line_width=0.5, ambient=0.5, diffuse=0.5)
for k, (mesh, text) in enumerate(((coiled, "at first"), (moved.mesh, "moved"), (repaired.mesh, "repaired"))):
    grid = mesh.to_pyvista()
    grid["EAS"] = mesh.quality()
    plotter.subplot(0, k)
    tets = grid.extract_cells(mesh.cell_ids("tetra"))
    plotter.add_mesh(tets.clip("z", crinkle=True), **look, show_scalar_bar=k == 2)
    plotter.add_mesh(grid.motet.blocks()["coil"], color="peru")
    plotter.add_text(f"{text}: {(mesh.quality() < 0.2).sum()} bad", position="upper_edge", font_size=10)
    plotter.camera_position = [(0.2, 2, 10), (0.2, 2, 0), (0, 1, 0)]
plotter.show(screenshot="coil_turns.png")
