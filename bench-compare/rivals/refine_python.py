"""Refinement by NGSolve, MFEM, dolfinx or Gmsh with one thread, generation by generation; prints times as
JSON.

usage: refine_python.py PROGRAM CASE.json OUT     meshes are written to OUT_1.points, OUT_1.tets, ..., unless they exist

All programs have the same mesh and marks. Times include the calls that refine and that pass the marks,
between the program's own data structures in memory. They exclude the creation of the first mesh, the choice
of tets to mark, arrays of their ids in the program's own type, and reading of points and tets. A generation
that exceeds the `limit` of the case is aborted and not started in later rounds. `examples/refine_rivals.rs`
defines the marks.
"""
import json
import multiprocessing
import os
import sys
import time
from pathlib import Path

os.environ["OMP_NUM_THREADS"] = "1"
import numpy as np


def clocked(work):
    start = time.perf_counter()
    work()
    return time.perf_counter() - start


class NGSolve:
    """Bisection of each marked tet until all its edges are halved; uniform refinement into eight."""

    def __init__(self, points, tets, boundary):
        import ngsolve
        from netgen.meshing import FaceDescriptor, Mesh

        mesh = Mesh(dim=3)
        mesh.AddPoints(np.ascontiguousarray(points))
        mesh.SetMaterial(1, "volume")
        face = mesh.Add(FaceDescriptor(surfnr=1, domin=1, bc=1))
        turned = lambda corners: np.ascontiguousarray(corners.astype(np.int32))  # Netgen's tets have negative orientation
        mesh.AddElements(dim=3, index=1, data=turned(tets[:, [1, 0, 2, 3]]), base=0)
        mesh.AddElements(dim=2, index=face, data=turned(boundary), base=0)
        self.mesh, self.version = ngsolve.Mesh(mesh), ngsolve.__version__

    def uniform(self):
        return clocked(self.mesh.ngmesh.Refine)

    def local(self, marked):
        flags = np.zeros(self.mesh.ne, bool)
        flags[marked] = True
        flags = flags.tolist()

        def work():
            self.mesh.SetRefinementFlags(flags)
            self.mesh.Refine()

        return clocked(work)

    def arrays(self):
        tets = self.mesh.ngmesh.Elements3D().NumPy()["nodes"][:, :4].astype(np.int64) - 1
        return np.array(self.mesh.ngmesh.Coordinates()), tets[:, [1, 0, 2, 3]]


class MFEM:
    """Bisection of each marked tet until all its edges are halved; uniform refinement into eight."""

    conforming = True

    def __init__(self, points, tets, _boundary):
        from importlib.metadata import version

        import mfem.ser as mfem

        self.program, self.version = mfem, version("mfem")
        self.mesh = mfem.Mesh(3, len(points), len(tets), 0, 3)
        for point in points.tolist():
            self.mesh.AddVertex(*point)
        for tet in tets.tolist():
            self.mesh.AddTet(*tet)
        self.mesh.FinalizeTopology()
        self.mesh.Finalize(True, True)
        if not self.conforming:
            self.mesh.EnsureNCMesh(True)

    def uniform(self):
        return clocked(self.mesh.UniformRefinement)

    def local(self, marked):
        ids = self.program.intArray(marked.tolist())
        return clocked(lambda: self.mesh.GeneralRefinement(ids, -1 if self.conforming else 1))

    def arrays(self):
        corners, kinds, points = self.program.intArray(), self.program.intArray(), self.program.Vector()
        self.mesh.GetElementData(self.program.Geometry.TETRAHEDRON, corners, kinds)
        self.mesh.GetVertices(points)
        as_numpy = lambda array: np.array(array.GetDataArray())
        return as_numpy(points).reshape(3, -1).T, as_numpy(corners).astype(np.int64).reshape(-1, 4)


class HangingMFEM(MFEM):
    """Division of marked tets into eight, with their neighbours unchanged."""

    conforming = False


class Dolfinx:
    """Plaza refinement: edges of marked tets are halved, and the longest edges of the facets that contain
    these."""

    def __init__(self, points, tets, _boundary):
        import dolfinx
        import ufl
        from mpi4py import MPI

        self.program, self.version = dolfinx.mesh, dolfinx.__version__
        domain = ufl.Mesh(ufl.VectorElement("Lagrange", ufl.tetrahedron, 1))
        self.mesh = self.program.create_mesh(MPI.COMM_SELF, tets, points, domain)

    def edges(self):
        self.mesh.topology.create_entities(1)
        self.mesh.topology.create_connectivity(3, 1)

    def uniform(self):
        self.edges()

        def work():
            self.mesh = self.program.refine(self.mesh, redistribute=False)

        return clocked(work)

    def local(self, marked):
        self.edges()

        def work():
            edges = self.program.compute_incident_entities(self.mesh, marked.astype(np.int32), 3, 1)
            self.mesh = self.program.refine(self.mesh, edges, redistribute=False)

        return clocked(work)

    def arrays(self):
        return self.mesh.geometry.x.copy(), self.mesh.geometry.dofmap.array.reshape(-1, 4).astype(np.int64)


class Gmsh:
    """Only uniform refinement into eight."""

    def __init__(self, points, tets, boundary):
        import gmsh

        gmsh.initialize()
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("General.NumThreads", 1)
        gmsh.model.addDiscreteEntity(2, 1)
        gmsh.model.addDiscreteEntity(3, 1, [1])
        self.mesh, self.version = gmsh.model.mesh, gmsh.__version__
        outer = np.unique(boundary)
        for dimension, ids in ((2, outer), (3, np.setdiff1d(np.arange(len(points)), outer))):
            self.mesh.addNodes(dimension, 1, ids + 1, points[ids].ravel())
        self.mesh.addElementsByType(1, 2, [], (boundary + 1).ravel())
        self.mesh.addElementsByType(1, 4, [], (tets + 1).ravel())

    def uniform(self):
        return clocked(self.mesh.refine)

    def arrays(self):
        tags, coordinates, _ = self.mesh.getNodes()
        row = np.zeros(int(tags.max()) + 1, np.int64)
        row[tags.astype(np.int64)] = np.arange(len(tags))
        _, corners = self.mesh.getElementsByType(4)
        return coordinates.reshape(-1, 3), row[corners.astype(np.int64).reshape(-1, 4)]


PROGRAMS = {"ngsolve": NGSolve, "mfem": MFEM, "mfem-hanging": HangingMFEM, "dolfinx": Dolfinx, "gmsh": Gmsh}


def marks(case, near, points, tets, generation):
    """Return the ids of the tets to divide."""
    from scipy.spatial import cKDTree

    corners = points[tets]
    longest = np.linalg.norm(corners[:, [0, 0, 0, 1, 1, 2]] - corners[:, [1, 2, 3, 2, 3, 3]], axis=2).max(axis=1)
    ids = np.flatnonzero(longest > case["longest"])
    centres = corners[ids].mean(axis=1)
    reach = case["radii"][min(generation, len(case["radii"])) - 1]
    if case["whole"]:
        reach = reach + np.linalg.norm(corners[ids] - centres[:, None], axis=2).max(axis=1)
    return ids[cKDTree(near).query(centres)[0] < reach]


def write(points, tets, out, generation):
    if not Path(f"{out}_{generation}.tets").exists():
        np.ascontiguousarray(points).tofile(f"{out}_{generation}.points")
        tets.astype(np.uint32).tofile(f"{out}_{generation}.tets")


def refine(name, case, folder, out, last, send):
    """Refine up to the generation `last`.

    Send a message when a generation begins and ends, and its result.
    """
    raw = lambda file, kind, width: np.fromfile(folder / file, kind).reshape(-1, width)
    ids = lambda file, width: raw(file, np.uint32, width).astype(np.int64)
    near = raw(case["near"], np.float64, 3) if case["near"] else None
    program = PROGRAMS[name](raw("first.points", np.float64, 3), ids("first.tets", 4), ids("boundary.u32", 3))
    points, tets = program.arrays()  # a program may renumber the first mesh
    for generation in range(1, last + 1):
        marked = np.arange(len(tets)) if near is None else marks(case, near, points, tets, generation)
        if not len(marked):
            break
        send("begin")
        seconds = program.uniform() if near is None else program.local(marked)
        send("end")
        points, tets = program.arrays()
        write(points, tets, out, generation)
        send({"seconds": seconds, "marked": len(marked), "tets": len(tets), "version": program.version})
    send(None)


def watched(name, case, folder, out):
    """Refine in a separate process that is killed if a generation takes too long.

    Return the rows of generations.
    """
    stop = Path(f"{out}.stop")
    last = int(stop.read_text().split()[0]) - 1 if stop.exists() else case["generations"]
    receiver, sender = multiprocessing.Pipe(duplex=False)
    child = multiprocessing.get_context("fork").Process(target=refine, args=(name, case, folder, out, last, sender.send))
    child.start()
    sender.close()
    rows, reason = [], None
    try:
        while (message := receiver.recv()) is not None:
            if message == "begin" and not receiver.poll(case["limit"]):
                reason = f"> {case['limit']:g} s"
                break
            if isinstance(message, dict):
                rows.append(message)
    except EOFError:
        reason = "failed"
    child.kill()
    child.join()
    if reason and rows:
        stop.write_text(f"{len(rows) + 1} {reason}")
    return rows


def main():
    name, case, out = sys.argv[1:]
    folder = Path(case).parent
    rows = watched(name, json.loads(Path(case).read_text()), folder, out)
    if not rows:
        sys.exit("no generation was refined")
    result = {f"generation_{i}_seconds": row.pop("seconds") for i, row in enumerate(rows, 1)}
    result |= {"seconds": sum(result.values()), "version": rows[0]["version"], "generations": rows}
    print(json.dumps(result))


if __name__ == "__main__":
    main()
