"""A vessel in its tissue

Nested surfaces give one conforming mesh with a region for each space between them: tissue, lumen, and a clot in the sac.
A point inside each names it.
"""
import pyvista as pv

import motet
from motet import shapes

block = shapes.box((22, 14, 8), low=(-6, -3.2, -2), high=(6, 4.2, 2))
tissue = motet.Mesh(block.points, block.triangles)
clot = pv.Icosphere(radius=0.7, nsub=3, center=(0.2, 2.5, 0))
seeds = {"tissue": (0, -3, 0), "lumen": (0, 0.3, 0), "clot": (0.2, 2.5, 0)}
filled = motet.mesh([tissue, shapes.aneurysm(around=20), clot], size="auto", seeds=seeds)
quality = filled.report.quality
print(f"EAS worst {quality.worst:.3f}, 1 % {quality.p1:.3f}, median {quality.median:.3f}, mean {quality.mean:.3f}")

plotter = pv.Plotter()
blocks = filled.mesh.to_pyvista().motet.blocks()
for name, colour in (("tissue", "rosybrown"), ("lumen", "steelblue"), ("clot", "firebrick")):
    label = f"{name}: {blocks[name].n_cells} tets"
    part = blocks[name].clip("z", crinkle=True)
    plotter.add_mesh(part, color=colour, show_edges=True, line_width=0.5, ambient=0.4, label=label)
plotter.add_legend(face="rectangle", bcolor=None, size=(0.25, 0.16), loc="upper left")
plotter.camera_position = [(3, 4, 22), (0, 0.8, 0), (0, 1, 0)]
plotter.show(screenshot="regions.png")
