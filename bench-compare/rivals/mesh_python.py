"""Meshes a closed surface by TetGen, Gmsh or fTetWild; prints times as JSON.

usage: mesh_python.py PROGRAM SIZE RUNS IN.npz OUT.npz [THREADS]      IN: points, triangles; OUT: points, tets

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


def tetgen(points, triangles, size, threads, switches):
    import tetgen as program

    surface = program.TetGen(points, triangles.astype(np.int32))
    switches = switches.format(f"{size**3 / 72**0.5:.9g}")
    seconds, _ = clocked(lambda: surface.tetrahedralize(switches=switches))
    return seconds, surface.node, surface.elem, version("tetgen")


def gmsh(points, triangles, size, threads, algorithm):
    import gmsh as program

    program.initialize()
    options = {"General.Terminal": 0, "General.NumThreads": threads, "Mesh.Algorithm3D": algorithm,
               # A uniform interior size, as in the other programs.
               "Mesh.MeshSizeMin": size, "Mesh.MeshSizeMax": size, "Mesh.MeshSizeExtendFromBoundary": 0}
    for name, value in options.items():
        program.option.setNumber(name, value)
    program.model.addDiscreteEntity(2, 1)
    mesh = program.model.mesh
    mesh.addNodes(2, 1, np.arange(len(points)) + 1, points.ravel())
    mesh.addElementsByType(1, 2, [], triangles.ravel() + 1)
    program.model.geo.addVolume([program.model.geo.addSurfaceLoop([1])])
    program.model.geo.synchronize()
    seconds, _ = clocked(lambda: mesh.generate(3))
    points, tets = gmsh_tets(mesh)
    program.finalize()
    return seconds, points, tets, program.__version__


def ftetwild(points, triangles, size, threads):
    import pytetwild as program

    work = lambda: program.tetrahedralize(points, triangles.astype(np.int32), edge_length_abs=size, num_threads=threads)
    seconds, (points, tets) = clocked(work)
    return seconds, points, tets, version("pytetwild")


PROGRAMS = {
    "tetgen": (tetgen, "pQ"),
    "tetgen-keep": (tetgen, "pYQ"),
    "tetgen-quality": (tetgen, "pq1.2/14a{}YQ"),
    "gmsh": (gmsh, 1),
    "gmsh-hxt": (gmsh, 10),
    "ftetwild": (ftetwild,),
}


def main(name, size, runs, source, target, threads="1"):
    given = np.load(source)
    os.chdir(os.path.dirname(target))  # fTetWild writes a file to its working directory
    program, *options = PROGRAMS[name]
    seconds = []
    while len(seconds) < int(runs) and sum(seconds) < BUDGET:
        duration, points, tets, release = program(given["points"], given["triangles"], float(size), int(threads), *options)
        if len(tets) == 0:
            raise ValueError("no tets")
        seconds.append(duration)
    np.savez(target, points=points, tets=tets)
    return {"seconds": seconds, "version": release, "tets": len(tets)}


try:
    print(json.dumps(main(*sys.argv[1:])))
except Exception as error:  # errors are reported as results
    print(json.dumps({"error": " ".join(str(error).split())[:200] or type(error).__name__}))
