"""Remeshing with a fixed boundary by Mmg, Gmsh or Netgen with one thread; prints times as JSON.

usage: remesh_python.py PROGRAM IN.npz OUT.npz

IN: points, tets, boundary (triangles), far (ids of tets to keep). OUT: points, tets. Times are measured
between the program's own data structures in memory, with three repeats or fewer if they take long.
"""
import json
import sys
import time

import numpy as np

RUNS, BUDGET = 3, 3.0  # number of repeats; none is started after this number of seconds


def clocked(work):
    start = time.perf_counter()
    work()
    return time.perf_counter() - start


def mmg(points, tets, _boundary, far, options, local):
    import mmgpy

    mesh = mmgpy.MmgMesh3D(points.copy(), tets.astype(np.int32))

    def work():
        if local:
            mesh.set_required_tetrahedra(far)
        mesh.remesh(verbose=-1, optim=1, nosurf=1, **options)

    seconds = clocked(work)
    return seconds, mesh.get_vertices(), mesh.get_tetrahedra(), mmgpy.MMG_VERSION


def gmsh(points, tets, boundary, _far, method, options):
    import gmsh as program

    program.initialize()
    program.option.setNumber("General.Terminal", 0)
    program.option.setNumber("General.NumThreads", 1)
    for name, value in options.items():
        program.option.setNumber(name, value)
    program.model.addDiscreteEntity(2, 1)
    program.model.addDiscreteEntity(3, 1, [1])
    mesh = program.model.mesh
    outer = np.unique(boundary)
    inner = np.setdiff1d(np.arange(len(points)), outer)
    for dimension, ids in ((2, outer), (3, inner)):
        mesh.addNodes(dimension, 1, ids + 1, points[ids].ravel())
    given = len(boundary) + len(tets)
    mesh.addElementsByType(1, 2, np.arange(len(boundary)) + 1, (boundary + 1).ravel())
    mesh.addElementsByType(1, 4, np.arange(len(boundary), given) + 1, (tets + 1).ravel())
    seconds = clocked(lambda: mesh.optimize(method, True))
    tags, coordinates, _ = mesh.getNodes()
    row = np.zeros(int(tags.max()) + 1, np.int64)
    row[tags.astype(np.int64)] = np.arange(len(tags))
    names, corners = mesh.getElementsByType(4)
    tets = row[corners.astype(np.int64).reshape(-1, 4)]
    if method == "Netgen":  # a discrete volume keeps its old tets in addition to the new ones
        tets = tets[names > given]
    program.finalize()
    return seconds, coordinates.reshape(-1, 3), tets, program.__version__


def netgen(points, tets, boundary, _far):
    from importlib.metadata import version

    from netgen.meshing import FaceDescriptor, Mesh, MeshingParameters

    mesh = Mesh(dim=3)
    mesh.AddPoints(np.ascontiguousarray(points))
    mesh.SetMaterial(1, "volume")
    face = mesh.Add(FaceDescriptor(surfnr=1, domin=1, bc=1))
    turned = lambda corners: np.ascontiguousarray(corners.astype(np.int32))  # Netgen's tets have negative orientation
    mesh.AddElements(dim=3, index=1, data=turned(tets[:, [1, 0, 2, 3]]), base=0)
    mesh.AddElements(dim=2, index=face, data=turned(boundary), base=0)
    seconds = clocked(lambda: mesh.OptimizeVolumeMesh(MeshingParameters()))
    tets = mesh.Elements3D().NumPy()["nodes"][:, :4].astype(np.int64) - 1
    return seconds, np.array(mesh.Coordinates()), tets[:, [1, 0, 2, 3]], version("netgen-mesher")


PROGRAMS = {
    "mmg": (mmg, {}, False),
    "mmg-local": (mmg, {}, True),
    "gmsh": (gmsh, "", {}),
    "gmsh-half": (gmsh, "", {"Mesh.OptimizeThreshold": 0.5}),
    "gmsh-netgen": (gmsh, "Netgen", {}),
    "netgen": (netgen,),
}
name, source, target = sys.argv[1:]
given = np.load(source)
program, *options = PROGRAMS[name]
seconds = []
while len(seconds) < RUNS and sum(seconds) < BUDGET:
    duration, points, tets, version = program(*(given[k] for k in ("points", "tets", "boundary", "far")), *options)
    seconds.append(duration)
np.savez(target, points=points, tets=tets)
print(json.dumps({"seconds": seconds, "version": version}))
