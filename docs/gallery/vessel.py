"""A vessel filled with tets

The surface of a vessel with an aneurysm is filled. The cut shows whole tets, coloured by their quality (EAS): 1 is a
regular tet, below 0.2 is bad.
"""
import motet
from motet import shapes

filled = motet.mesh(shapes.aneurysm(), size="auto")
quality = filled.report.quality
print(f"{len(filled.mesh.tets)} tets, {filled.report.triangles_kept} of {filled.report.triangles} triangles kept")
print(f"EAS worst {quality.worst:.3f}, 1 % {quality.p1:.3f}, median {quality.median:.3f}, mean {quality.mean:.3f}")

vessel = filled.mesh.to_pyvista()
print("patches:", ", ".join(vessel.motet.blocks().keys()))
front = [(1.5, 0.5, 22), (1.5, 0.5, 0), (0, 1, 0)]
vessel.motet.plot(cpos=front, screenshot="vessel.png")
