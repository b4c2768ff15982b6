"""Meshes of the remeshing benchmark in the formats of all programs, and reading of the results."""
import numpy as np

from common import TARGET
from moved import SPHERE, moved, patches
from tets import BAD, boundary, eas, volumes


class Case:
    """A moved mesh and its files."""

    def __init__(self, name):
        self.name, self.folder = name, TARGET / f"remesh_{name}"
        self.folder.mkdir(exist_ok=True)
        self.points, self.tets = moved(name)
        self.triangles = boundary(self.tets)
        self.vtu = TARGET / f"{name}.vtu"

    def numpy(self):
        """Write points, tets, boundary, and the tets that share no vertex with a bad one; return the path."""
        near = np.zeros(len(self.points), bool)
        near[self.tets[eas(self.points, self.tets) < BAD]] = True
        self.far = np.flatnonzero(~near[self.tets].any(axis=1))
        path = self.folder / "in.npz"
        np.savez(path, points=self.points, tets=self.tets, boundary=self.triangles, far=self.far)
        return path

    def raw(self):
        """Write points (boundary first), tets and triangles.

        Return the paths and the number of boundary points.
        """
        outer = np.unique(self.triangles)
        order = np.r_[outer, np.setdiff1d(np.arange(len(self.points)), outer)]
        row = np.argsort(order)
        paths = [self.folder / name for name in ("points.f64", "tets.u32", "triangles.u32")]
        self.points[order].tofile(paths[0])
        for path, corners in zip(paths[1:], (self.tets, self.triangles)):
            row[corners].astype(np.uint32).tofile(path)
        return [*paths, len(outer)]

    def medit(self):
        """Write the mesh as subdomain 1, with its cavity filled as subdomain 2; return the path."""
        sphere = self.triangles[patches(self.points, self.triangles) == SPHERE]
        points, cavity = filled(self.points, sphere)
        tets = np.r_[self.tets, cavity] + 1
        part = np.repeat([1, 2], [len(self.tets), len(cavity)])
        path = self.folder / "in.mesh"
        with open(path, "w") as file:
            file.write(f"MeshVersionFormatted 2\nDimension 3\nVertices\n{len(points)}\n")
            np.savetxt(file, np.c_[points, np.zeros(len(points))], fmt="%.17g %.17g %.17g %d")
            file.write(f"Tetrahedra\n{len(tets)}\n")
            np.savetxt(file, np.c_[tets, part], fmt="%d")
            file.write("End\n")
        return path

    def length(self):
        """Return the mean edge length over all tets."""
        corners = self.points[self.tets]
        return float(np.linalg.norm(corners[:, [0, 0, 0, 1, 1, 2]] - corners[:, [1, 2, 3, 2, 3, 3]], axis=2).mean())


def filled(points, triangles):
    """Fill a closed surface with tets that keep its triangles.

    Return all points including new ones, and the tets.
    """
    import gmsh

    ids, corners = np.unique(triangles, return_inverse=True)
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.NumThreads", 1)
    gmsh.model.addDiscreteEntity(2, 1)
    gmsh.model.mesh.addNodes(2, 1, np.arange(len(ids)) + 1, points[ids].ravel())
    gmsh.model.mesh.addElementsByType(1, 2, [], corners.ravel() + 1)
    gmsh.model.geo.addVolume([gmsh.model.geo.addSurfaceLoop([1])])
    gmsh.model.geo.synchronize()
    gmsh.model.mesh.generate(3)
    tags, places, _ = gmsh.model.mesh.getNodes(3)
    _, names = gmsh.model.mesh.getElementsByType(4)
    gmsh.finalize()
    row = np.r_[-1, ids, np.full(len(tags), -1)]
    row[tags.astype(np.int64)] = len(points) + np.arange(len(tags))
    points, tets = np.r_[points, places.reshape(-1, 3)], row[names.astype(np.int64).reshape(-1, 4)]
    turned = volumes(points, tets) < 0
    tets[turned] = tets[turned][:, [1, 0, 2, 3]]
    return points, tets


def made(path):
    """Read the points and tets written by a program: NAME.npz, NAME.vtu, or NAME.points and NAME.tets."""
    if path.suffix == ".npz":
        kept = np.load(path)
        return kept["points"], kept["tets"].astype(np.int64)
    if path.suffix == ".vtu":
        return read_vtu(path)
    raw = lambda end, kind, width: np.fromfile(f"{path}.{end}", kind).reshape(-1, width)
    return raw("points", np.float64, 3), raw("tets", np.uint32, 4).astype(np.int64)


def read_vtu(path):
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy

    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    grid = reader.GetOutput()
    ends = vtk_to_numpy(grid.GetCells().GetOffsetsArray())[:-1][vtk_to_numpy(grid.GetCellTypes()) == vtk.VTK_TETRA]
    corners = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).astype(np.int64)
    return vtk_to_numpy(grid.GetPoints().GetData()).astype(np.float64), corners[ends[:, None] + np.arange(4)]
