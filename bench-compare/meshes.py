"""The sphere in a box at the paper's four sizes, meshed by Gmsh, for the motion and Delaunay benchmarks.

The paper (table 1) has for A 10,203 vertices with 2,700 on the boundary, for B 32,102/5,704, for C
72,655/10,854 and for D 157,887/16,947. The sizes below give both numbers within 2 % with the pinned Gmsh.
"""
import os

import numpy as np

RADIUS = 1.0
HALF_EDGE = 5.0
# Name: cell size at the sphere and at the walls, and exponent of the grading in between (found by trial).
SIZES = {
    "A": (0.1324, 0.6339, 0.633),
    "B": (0.0907, 0.4349, 0.694),
    "C": (0.0652, 0.3121, 0.603),
    "D": (0.0525, 0.2487, 0.690),
}


def geometric(sphere_size, wall_size, depth):
    return f"{sphere_size}*{wall_size / sphere_size}^({depth})"


def linear(sphere_size, wall_size, depth):
    return f"{sphere_size}+({wall_size}-{sphere_size})*({depth})"


def build(sphere_size, wall_size, grading, ahead=HALF_EDGE, growth=geometric):
    """Return points (n, 3) and positive tets (m, 4) of the box without the ball.

    The box extends to `ahead` in x.
    """
    import gmsh

    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.NumThreads", 1)
    occ = gmsh.model.occ
    box = occ.addBox(*[-HALF_EDGE] * 3, HALF_EDGE + ahead, *[2 * HALF_EDGE] * 2)
    ball = occ.addSphere(0, 0, 0, RADIUS)
    occ.cut([(3, box)], [(3, ball)])
    occ.synchronize()
    # Cell sizes grow from the sphere (depth 0) to the nearest point of a wall (depth 1) and beyond.
    depth = f"Min(1,Max(0,(Sqrt(x*x+y*y+z*z)-{RADIUS})/({HALF_EDGE - RADIUS})))"
    field = gmsh.model.mesh.field.add("MathEval")
    gmsh.model.mesh.field.setString(field, "F", growth(sphere_size, wall_size, f"{depth}^{grading}"))
    return meshed(gmsh, field)


def meshed(gmsh, field):
    """Mesh Gmsh's model with the sizes of a field; return points and positive tets."""
    gmsh.model.mesh.field.setAsBackgroundMesh(field)
    for option in ("ExtendFromBoundary", "FromPoints", "FromCurvature"):
        gmsh.option.setNumber(f"Mesh.MeshSize{option}", 0)
    gmsh.model.mesh.generate(3)
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    _, corners = gmsh.model.mesh.getElementsByType(4)
    gmsh.finalize()
    points = coordinates.reshape(-1, 3)
    row = np.zeros(int(tags.max()) + 1, np.int64)
    row[tags.astype(np.int64)] = np.arange(len(tags))
    used, tets = np.unique(row[corners.astype(np.int64)], return_inverse=True)
    points, tets = points[used], tets.reshape(-1, 4)
    a, b, c, d = (points[tets[:, i]] for i in range(4))
    negative = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) < 0
    tets[negative] = tets[negative][:, [1, 0, 2, 3]]
    return points, tets


def flap_in_channel():
    """Return points and tets of a channel, 4 by 2 by 2, with a flap of 0.06 by 1 by 1 on its
    floor at y = -1."""
    import gmsh

    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.NumThreads", 1)
    occ = gmsh.model.occ
    channel, flap = occ.addBox(-2, -1, -1, 4, 2, 2), occ.addBox(-0.03, -1, -0.5, 0.06, 1, 1)
    occ.cut([(3, channel)], [(3, flap)])
    occ.synchronize()
    field = gmsh.model.mesh.field.add("Box")
    sizes = dict(VIn=0.05, VOut=0.25, XMin=-0.05, XMax=0.05, YMin=-1, YMax=0.02, ZMin=-0.52, ZMax=0.52, Thickness=1)
    for name, value in sizes.items():
        gmsh.model.mesh.field.setNumber(field, name, value)
    return meshed(gmsh, field)


def boundary_vertices(points):
    """Return the ids of the vertices on the sphere, and of those on the walls."""
    on_wall = np.isclose(np.abs(points).max(axis=1), HALF_EDGE, rtol=0, atol=1e-9)
    on_sphere = np.isclose(np.linalg.norm(points, axis=1), RADIUS, rtol=0, atol=1e-9)
    return np.flatnonzero(on_sphere), np.flatnonzero(on_wall)


def sphere_in_box(name, folder):
    """Return points, tets, and ids of vertices on the sphere and on the walls; cached in `folder`."""
    path = os.path.join(folder, f"sphere_in_box_{name}.npz")
    if not os.path.exists(path):
        points, tets = build(*SIZES[name])
        sphere, walls = boundary_vertices(points)
        np.savez(path, points=points, tets=tets, sphere=sphere, walls=walls)
    kept = np.load(path)
    return kept["points"], kept["tets"], kept["sphere"], kept["walls"]


def vtu(name, folder):
    """Write the sphere in a box as a VTU file, and return its path."""
    points, tets, _, _ = sphere_in_box(name, folder)
    return written(f"sphere_in_box_{name}", lambda: (points, tets), folder)


def written(name, made, folder):
    """Return the path of a VTU file, which is created from the points and tets of `made()` if it does not
    exist."""
    path = os.path.join(folder, f"{name}.vtu")
    if not os.path.exists(path):
        points, tets = made()
        import vtk
        from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray

        grid, places, cells = vtk.vtkUnstructuredGrid(), vtk.vtkPoints(), vtk.vtkCellArray()
        places.SetData(numpy_to_vtk(points, deep=True))
        cells.SetData(numpy_to_vtkIdTypeArray(np.arange(0, 4 * len(tets) + 1, 4), deep=True),
                      numpy_to_vtkIdTypeArray(tets.ravel().astype(np.int64), deep=True))
        grid.SetPoints(places)
        grid.SetCells(vtk.VTK_TETRA, cells)
        writer = vtk.vtkXMLUnstructuredGridWriter()
        writer.SetFileName(path)
        writer.SetInputData(grid)
        writer.Write()
    return path
