"""Meshes a closed surface by TetGen, Gmsh, fTetWild, or MeshLab and TetGen; prints times as JSON.

usage: mesh_python.py PROGRAM SIZE RUNS IN.npz OUT.npz [THREADS]      IN: points, triangles, perhaps distance; OUT: points, tets

SIZE is the requested edge length; for TetGen the volume of the regular tet with such edges is the limit.
Times are measured between the program's own data structures in memory, with fewer repeats than RUNS if they
take long.
"""
import json
import os
import sys
from importlib.metadata import version

import numpy as np

from in_memory import clocked, gmsh_tets

BUDGET = 3.0  # no repeat is started after this number of seconds


def tetgen(points, triangles, size, threads, distance, switches):
    import tetgen as program

    surface = program.TetGen(points, triangles.astype(np.int32))
    switches = switches.format(f"{size**3 / 72**0.5:.9g}")
    seconds, _ = clocked(lambda: surface.tetrahedralize(switches=switches))
    return seconds, surface.node, surface.elem, version("tetgen")


def meshlab_tetgen(points, triangles, size, threads, distance):
    """Remesh the surface in MeshLab within the distance, then fill it with TetGen."""
    import pymeshlab as program

    meshes = program.MeshSet(verbose=False)
    meshes.add_mesh(program.Mesh(points, triangles.astype(np.int32)))
    length, most = program.PureValue(size), program.PureValue(distance)
    remesh = lambda: meshes.meshing_isotropic_explicit_remeshing(targetlen=length, maxsurfdist=most, checksurfdist=True, featuredeg=40)
    seconds, _ = clocked(remesh)
    even = meshes.current_mesh()
    more, *made = tetgen(even.vertex_matrix(), even.face_matrix(), size, threads, distance, "pq1.2/14a{}YQ")
    return seconds + more, *made


def gmsh_surface(program, points, triangles, options):
    """Return Gmsh's mesh, with the triangles as its discrete surface 1."""
    for name, value in options.items():
        program.option.setNumber(name, value)
    program.model.addDiscreteEntity(2, 1)
    mesh = program.model.mesh
    mesh.addNodes(2, 1, np.arange(len(points)) + 1, points.ravel())
    mesh.addElementsByType(1, 2, [], triangles.ravel() + 1)
    return mesh


def gmsh_adapt(points, triangles, size, threads, distance):
    """Find features of the surface in Gmsh, remesh it, fill it and optimise with Netgen."""
    import gmsh as program

    program.initialize()
    options = {"General.Terminal": 0, "General.NumThreads": threads, "Mesh.MeshSizeMin": size, "Mesh.MeshSizeMax": size, "Mesh.OptimizeNetgen": 1}
    mesh = gmsh_surface(program, points, triangles, options)

    def work():
        mesh.classifySurfaces(np.radians(40), True, True)
        mesh.createGeometry()
        faces = [tag for _, tag in program.model.getEntities(2)]
        program.model.geo.addVolume([program.model.geo.addSurfaceLoop(faces)])
        program.model.geo.synchronize()
        mesh.generate(3)

    seconds, _ = clocked(work)
    points, tets = gmsh_tets(mesh)
    program.finalize()
    return seconds, points, tets, program.__version__


def gmsh(points, triangles, size, threads, distance, algorithm):
    import gmsh as program

    program.initialize()
    options = {"General.Terminal": 0, "General.NumThreads": threads, "Mesh.Algorithm3D": algorithm,
               # A uniform interior size, as in the other programs.
               "Mesh.MeshSizeMin": size, "Mesh.MeshSizeMax": size, "Mesh.MeshSizeExtendFromBoundary": 0}
    mesh = gmsh_surface(program, points, triangles, options)
    program.model.geo.addVolume([program.model.geo.addSurfaceLoop([1])])
    program.model.geo.synchronize()
    seconds, _ = clocked(lambda: mesh.generate(3))
    points, tets = gmsh_tets(mesh)
    program.finalize()
    return seconds, points, tets, program.__version__


def ftetwild(points, triangles, size, threads, distance):
    import pytetwild as program

    limits = {} if distance is None else {"epsilon": distance / np.linalg.norm(np.ptp(points, axis=0))}  # of the diagonal
    work = lambda: program.tetrahedralize(points, triangles.astype(np.int32), edge_length_abs=size, num_threads=threads, **limits)
    seconds, (points, tets) = clocked(work)
    return seconds, points, tets, version("pytetwild")


PROGRAMS = {
    "tetgen": (tetgen, "pQ"),
    "tetgen-keep": (tetgen, "pYQ"),
    "tetgen-quality": (tetgen, "pq1.2/14a{}YQ"),
    "tetgen-divide": (tetgen, "pq1.2/14a{}Q"),
    "meshlab-tetgen": (meshlab_tetgen,),
    "gmsh": (gmsh, 1),
    "gmsh-adapt": (gmsh_adapt,),
    "gmsh-hxt": (gmsh, 10),
    "ftetwild": (ftetwild,),
}


def main(name, size, runs, source, target, threads="1"):
    given = np.load(source)
    os.chdir(os.path.dirname(target))  # fTetWild writes a file to its working directory
    program, *options = PROGRAMS[name]
    distance = float(given["distance"]) if "distance" in given else None
    seconds = []
    while len(seconds) < int(runs) and sum(seconds) < BUDGET:
        duration, points, tets, release = program(given["points"], given["triangles"], float(size), int(threads), distance, *options)
        if len(tets) == 0:
            raise ValueError("no tets")
        seconds.append(duration)
    np.savez(target, points=points, tets=tets)
    return {"seconds": seconds, "version": release, "tets": len(tets)}


try:
    print(json.dumps(main(*sys.argv[1:])))
except Exception as error:  # errors are reported as results
    print(json.dumps({"error": " ".join(str(error).split())[:200] or type(error).__name__}))
