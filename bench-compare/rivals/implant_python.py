"""Surfaces of a host and of devices in it filled as one by TetGen, Gmsh, fTetWild or Mmg, one thread: NPZ in, NPZ out, JSON out.

usage: implant_python.py PROGRAM RUNS IN.npz OUT.npz

IN: points, triangles, part (of each triangle: 0 the host, then the devices one by one), wire (half of the thickness of the devices), edge (of the
host); for Mmg: background_points, background_tets. OUT: points, tets, and in_device where the program tells that itself. `seconds` run from the
program's own surfaces in memory to its own mesh in memory, `whole_seconds` from reading IN to OUT being written, `cpu_seconds` are those of the processor meanwhile.
"""
import json
import os
import statistics
import sys
import time
from importlib.metadata import version

os.environ |= {"IGL_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}

import numpy as np

from in_memory import clocked, gmsh_tets

BUDGET = 10.0  # no repeat is begun after so many seconds of work


def tetgen(given, switches):
    import tetgen as program

    surface = program.TetGen(given["points"], given["triangles"].astype(np.int32))
    seconds, _ = clocked(lambda: surface.tetrahedralize(switches=switches))
    return seconds, {"points": surface.node, "tets": surface.elem}, version("tetgen")


def gmsh(given, algorithm):
    import gmsh as program

    points, triangles, part = given["points"], given["triangles"], given["part"]
    program.initialize()
    for name, value in {"General.Terminal": 0, "General.NumThreads": 1, "Mesh.Algorithm3D": algorithm}.items():
        program.option.setNumber(name, value)
    mesh, loops = program.model.mesh, []
    for k in range(part.max() + 1):
        used, corners = np.unique(triangles[part == k], return_inverse=True)
        surface = program.model.addDiscreteEntity(2, k + 1)
        ids = int(mesh.getMaxNodeTag()) + 1 + np.arange(len(used))
        mesh.addNodes(2, surface, ids, points[used].ravel())
        mesh.addElementsByType(surface, 2, [], ids[corners.ravel()])
        loops.append(program.model.geo.addSurfaceLoop([surface]))
    for loop in loops[1:]:
        program.model.geo.addVolume([loop])
    program.model.geo.addVolume(loops)  # the first bounds it, the others are holes
    program.model.geo.synchronize()
    seconds, _ = clocked(lambda: mesh.generate(3))
    points, tets = gmsh_tets(mesh)
    program.finalize()
    return seconds, {"points": points, "tets": tets}, program.__version__


def ftetwild(given):
    import pytetwild as program

    work = lambda: program.tetrahedralize(given["points"], given["triangles"].astype(np.int32), num_threads=1)
    seconds, (points, tets) = clocked(work)
    return seconds, {"points": points, "tets": tets}, version("pytetwild")


def mmg(given):
    """Divided where the distance from the devices, negative inside, is 0."""
    import igl
    import mmgpy as program

    points, devices = given["background_points"], given["triangles"][given["part"] > 0].astype(np.int64)
    distance = np.sqrt(igl.point_mesh_squared_distance(points, given["points"], devices)[0])
    distance[igl.fast_winding_number(given["points"], devices, points) > 0.5] *= -1
    mesh = program.MmgMesh3D(points, given["background_tets"].astype(np.int32))
    wire, edge = float(given["wire"]), float(given["edge"])
    work = lambda: mesh.remesh_levelset(distance.reshape(-1, 1), verbose=-1, hausd=wire / 24, hmax=edge)
    seconds, _ = clocked(work)
    tets, reference = mesh.get_tetrahedra_with_refs()
    inside = 3  # what Mmg calls the part where the distance is negative
    return seconds, {"points": mesh.get_vertices(), "tets": tets, "in_device": np.asarray(reference).ravel() == inside}, version("mmgpy")


PROGRAMS = {
    "tetgen": (tetgen, "pq1.2YAQ"),
    "tetgen-angles": (tetgen, "pq1.2/14YAQ"),
    "gmsh": (gmsh, 1),
    "gmsh-hxt": (gmsh, 10),
    "ftetwild": (ftetwild,),
    "mmg": (mmg,),
}


def main(name, runs, source, target):
    os.chdir(os.path.dirname(target))  # fTetWild leaves a file where it runs
    program, *words = PROGRAMS[name]
    seconds, whole, cpu = [], [], []
    while len(seconds) < int(runs) and sum(seconds) < BUDGET:
        start, used = time.perf_counter(), time.process_time()
        took, made, release = program(dict(np.load(source)), *words)
        if len(made["tets"]) == 0:
            raise ValueError("no tets")
        np.savez(target, **made)
        seconds.append(took)
        whole.append(time.perf_counter() - start)
        cpu.append(time.process_time() - used)
    return {"seconds": seconds, "whole_seconds": statistics.median(whole), "cpu_seconds": statistics.median(cpu), "version": release}


try:
    print(json.dumps(main(*sys.argv[1:])))
except Exception as error:  # a refusal is a result, too
    print(json.dumps({"error": " ".join(str(error).split())[:200] or type(error).__name__}))
