"""A coil in an aneurysm

A coil is put into the mesh of a vessel. Its triangles become facets of the mesh, unchanged; tets far from it stay as they
are. The view of `plot` makes the wall transparent and shows the device whole.
"""
import motet
from motet import shapes

vessel = motet.mesh(shapes.aneurysm(), size="auto").mesh
coil = shapes.coil((0, 2.3, 0), radius=0.6, pitch=0.35, turns=4, wire_radius=0.1)
coiled = motet.implant(vessel, {"coil": coil}, inside="hollow")
quality, kept = coiled.report.quality[-1], coiled.report.kept_share
print(f"{len(coiled.mesh.tets)} tets, {100 * kept:.0f} % of the vessel's kept")
print(f"EAS worst {quality.worst:.3f}, 1 % {quality.p1:.3f}, median {quality.median:.3f}, mean {quality.mean:.3f}")

grid = coiled.mesh.to_pyvista()
grid.motet.plot(cpos=[(3.5, 4.5, 18), (1.2, 0.5, 0), (0, 1, 0)], screenshot="coil.png")
