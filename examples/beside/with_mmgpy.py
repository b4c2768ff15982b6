import mmgpy
import numpy as np
import pyvista as pv
import tetgen

# Mmg does not fill surfaces.
points, tets, *_ = tetgen.TetGen(pv.Sphere()).tetrahedralize()
mesh = mmgpy.MmgMesh3D(points, tets.astype(np.int32))
mmgpy.apply_sizing_constraints(mesh, [mmgpy.SphereSize(center=(0.5, 0, 0), radius=0.2, size=0.05)])
mesh.remesh(hmax=0.1, hausd=0.002, verbose=-1)
grid = pv.UnstructuredGrid({pv.CellType.TETRA: mesh.get_tetrahedra()}, mesh.get_vertices())
