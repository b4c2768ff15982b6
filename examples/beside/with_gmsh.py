import gmsh
import pyvista as pv

pv.Sphere().save("sphere.stl")
gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 0)
gmsh.merge("sphere.stl")
gmsh.model.mesh.createTopology()
surfaces = [tag for _, tag in gmsh.model.getEntities(2)]
gmsh.model.geo.addVolume([gmsh.model.geo.addSurfaceLoop(surfaces)])
gmsh.model.geo.synchronize()
field = gmsh.model.mesh.field.add("Ball")
for name, value in {"XCenter": 0.5, "Radius": 0.2, "VIn": 0.05, "VOut": 0.1}.items():
    gmsh.model.mesh.field.setNumber(field, name, value)
gmsh.model.mesh.field.setAsBackgroundMesh(field)
gmsh.model.mesh.generate(3)
gmsh.write("sphere.vtk")
gmsh.finalize()
grid = pv.read("sphere.vtk")
