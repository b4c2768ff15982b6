"""Meshes a host with devices from their surfaces by TetGen, Gmsh, fTetWild or Mmg with one thread; prints
times as JSON.

usage: implant_python.py PROGRAM RUNS IN.npz OUT.npz

IN: points, triangles, part (of each triangle: 0 for the host, then 1, 2, ... for the devices), wire (half the
thickness of the devices), edge (edge length of the host); for Mmg also background_points and background_tets.
OUT: points, tets, and in_device if the program reports it. `seconds` are measured between the program's own
data structures in memory, `whole_seconds` include reading and writing of files, `cpu_seconds` are the CPU
time.
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

BUDGET = 10.0  # no repeat is started after this number of seconds


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
    program.model.geo.addVolume(loops)  # the first loop is the boundary, the others are holes
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
    """Divide the background mesh at the zero level set of the signed distance from the devices."""
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
    inside = 3  # Mmg's reference of tets with negative distance
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
    os.chdir(os.path.dirname(target))  # fTetWild writes a file to its working directory
    program, *options = PROGRAMS[name]
    seconds, whole, cpu = [], [], []
    while len(seconds) < int(runs) and sum(seconds) < BUDGET:
        start, used = time.perf_counter(), time.process_time()
        duration, made, release = program(dict(np.load(source)), *options)
        if len(made["tets"]) == 0:
            raise ValueError("no tets")
        np.savez(target, **made)
        seconds.append(duration)
        whole.append(time.perf_counter() - start)
        cpu.append(time.process_time() - used)
    return {"seconds": seconds, "whole_seconds": statistics.median(whole), "cpu_seconds": statistics.median(cpu), "version": release}


try:
    print(json.dumps(main(*sys.argv[1:])))
except Exception as error:  # errors are reported as results
    print(json.dumps({"error": " ".join(str(error).split())[:200] or type(error).__name__}))
