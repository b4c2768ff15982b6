import motet
from motet import shapes

vessel = motet.mesh(shapes.aneurysm(), size="auto").mesh  # or motet.read("vessel.vtu")
coil = shapes.coil((0, 2.3, 0), radius=0.5)  # or "coil.stl"
coiled = motet.implant(vessel, {"coil": coil}, inside="hollow")
turn, shift = {"coil": ((0, 0, 1), 40)}, {"coil": (0, -0.3, 0)}
moved = motet.move(coiled.mesh, rotate=turn, translate=shift, method="bodies", bodies=["coil"])
repaired = motet.remesh(moved.mesh)
print(moved.certificate.bad, "bad tets after the motion,", repaired.report.after.bad, "after the repair")
grid = repaired.mesh.to_pyvista()
grid["eas"] = repaired.mesh.quality()
grid.clip("z", crinkle=True).plot(scalars="eas", cmap="viridis", show_edges=True, cpos="xy", zoom=1.4)
