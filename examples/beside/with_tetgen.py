import numpy as np
import pyvista as pv
import tetgen

box = pv.ImageData(dimensions=(21, 21, 21), spacing=(0.06,) * 3, origin=(-0.6,) * 3).cast_to_unstructured_grid()
background = box.triangulate()
near = np.linalg.norm(background.points - (0.5, 0, 0), axis=1) < 0.2
background["target_size"] = np.where(near, 0.05, 0.1)
tet = tetgen.TetGen(pv.Sphere())
tet.tetrahedralize(switches="pq1.4", bgmesh=background)
grid = tet.grid
