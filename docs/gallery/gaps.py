"""Gaps between a stent and its artery

A stent lies off the axis of its artery. Colour is the exact distance from each vertex of the stent to the nearest
triangle of the wall; `plot` makes the artery transparent.
"""
import pyvista as pv

from motet import shapes

artery = shapes.tube(n=10, slices=40).to_pyvista().extract_surface(algorithm="dataset_surface")
stent = shapes.stent(0.75, length=3, rings=4, crowns=8).to_pyvista().translate((0.15, 0, 1))
both = pv.MultiBlock({"stent": stent, "artery": artery})
measured = both.motet.contact(warn=0.12, room=["artery"])
gaps = measured.motet.gaps
print(f"least gap {gaps.least:.4f}, at {gaps.pairs[0].points[0]}")
print(gaps.bodies["stent"].warning.sum(), "of", stent.n_points, "vertices of the stent warn")

measured.motet.plot(cpos=[(4, -10, 4), (0, 0, 2), (1, 0, 0)], screenshot="gaps.png")
