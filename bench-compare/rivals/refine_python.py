"""Refinement by NGSolve, MFEM, dolfinx or Gmsh, one thread, generation by generation: the same mesh and marks for all; JSON out.

usage: refine_python.py PROGRAM CASE.json OUT     meshes go to OUT_1.points, OUT_1.tets, ..., unless they are there

What is clocked: the call that refines, from the program's own mesh in memory to its own mesh in memory, and the call that tells it
the marks where that is another one. Not clocked: its own first mesh, which tets to mark, an array of their ids in the program's own
type, reading points and tets. No generation is waited for longer than the case's `limit`: the program is ended, and the next round
begins no such generation. `examples/refine_rivals.rs` says what is marked.
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
    """Bisection, each marked tet until all its edges are halved; uniform: into eight."""

    def __init__(self, points, tets, boundary):
        import ngsolve
        from netgen.meshing import FaceDescriptor, Mesh

        mesh = Mesh(dim=3)
        mesh.AddPoints(np.ascontiguousarray(points))
        mesh.SetMaterial(1, "volume")
        face = mesh.Add(FaceDescriptor(surfnr=1, domin=1, bc=1))
        turned = lambda corners: np.ascontiguousarray(corners.astype(np.int32))  # Netgen's tets are negative
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
    """Bisection, each marked tet until all its edges are halved; uniform: into eight."""

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
    """Marked tets into eight, their neighbours left alone."""

    conforming = False


class Dolfinx:
    """Plaza: edges of marked tets halved, and the longest edges of the facets that these are in."""

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
    """Uniform alone: into eight."""

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
    """Ids of the tets to divide."""
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


def refine(name, case, folder, out, last, tell):
    """All generations up to `last`; tells when one begins, and what it came to."""
    raw = lambda file, kind, width: np.fromfile(folder / file, kind).reshape(-1, width)
    ids = lambda file, width: raw(file, np.uint32, width).astype(np.int64)
    near = raw(case["near"], np.float64, 3) if case["near"] else None
    program = PROGRAMS[name](raw("first.points", np.float64, 3), ids("first.tets", 4), ids("boundary.u32", 3))
    points, tets = program.arrays()  # a program may number the first mesh anew
    for generation in range(1, last + 1):
        marked = np.arange(len(tets)) if near is None else marks(case, near, points, tets, generation)
        if not len(marked):
            break
        tell("begin")
        seconds = program.uniform() if near is None else program.local(marked)
        tell("end")
        points, tets = program.arrays()
        write(points, tets, out, generation)
        tell({"seconds": seconds, "marked": len(marked), "tets": len(tets), "version": program.version})
    tell(None)


def watched(name, case, folder, out):
    """The generations' rows, and why there are no more, from a process that is ended when one takes too long."""
    stop = Path(f"{out}.stop")
    last = int(stop.read_text().split()[0]) - 1 if stop.exists() else case["generations"]
    here, there = multiprocessing.Pipe(duplex=False)
    child = multiprocessing.get_context("fork").Process(target=refine, args=(name, case, folder, out, last, there.send))
    child.start()
    there.close()
    rows, why = [], None
    try:
        while (told := here.recv()) is not None:
            if told == "begin" and not here.poll(case["limit"]):
                why = f"> {case['limit']:g} s"
                break
            if isinstance(told, dict):
                rows.append(told)
    except EOFError:
        why = "failed"
    child.kill()
    child.join()
    if why and rows:
        stop.write_text(f"{len(rows) + 1} {why}")
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
