import pyvista as pv

grid = pv.Sphere().motet.mesh(size=0.1).motet.refine(ball=[((0.5, 0, 0), 0.2)])
