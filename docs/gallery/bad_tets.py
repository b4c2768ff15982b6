"""Bad tets before and after a repair

A sphere has moved by three radii in its box. The tets below an EAS of 0.2 are red; the repair replaces them and their
neighbours by the blue ones. All others stay as they are.
"""
import pyvista as pv

import motet
from motet import shapes

moved = motet.move(shapes.sphere_in_box(8, 6), translate={"sphere": (3, 0, 0)}).mesh
repaired = motet.remesh(moved)
bad = moved.quality() < 0.2
new = repaired.history.cell_to_old < 0

plotter = pv.Plotter(shape=(1, 2), border=False, window_size=(1200, 560))
panels = [
    (moved, bad, "red", f"{bad.sum()} of {len(moved.tets)} tets are bad"),
    (repaired.mesh, new, "deepskyblue", f"{new.sum()} are new, {repaired.report.after.bad} bad"),
]
for k, (mesh, chosen, colour, text) in enumerate(panels):
    grid = mesh.to_pyvista()
    grid["chosen"] = chosen & (mesh.kinds == pv.CellType.TETRA)
    plotter.subplot(0, k)
    half = grid.extract_cells(mesh.cell_ids("tetra")).clip("y", crinkle=True, invert=False)
    plotter.add_mesh(half, color="white", show_edges=True, edge_opacity=0.3, ambient=0.5, diffuse=0.5)
    plotter.add_mesh(grid.extract_cells(grid["chosen"]), color=colour, show_edges=True)
    plotter.add_mesh(grid.motet.blocks()["sphere"], color="lightslategrey", smooth_shading=True)
    plotter.add_text(text, position="upper_edge", font_size=10)
    plotter.camera_position = [(2, -24, 7), (0.5, 0, 0.5), (0, 0, 1)]
plotter.show(screenshot="bad_tets.png")
