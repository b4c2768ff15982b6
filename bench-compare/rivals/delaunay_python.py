"""Delaunay tetrahedralisation of raw f64 triples by Qhull (SciPy), Gmsh or TetGen; prints seconds as JSON.

usage: delaunay_python.py PROGRAM FILE RUNS
"""
import json
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np


def clocked(build, runs):
    seconds, tets = [], 0
    for _ in range(runs):
        start = time.perf_counter()
        tets = build()
        seconds.append(time.perf_counter() - start)
    return seconds, tets


def qhull(points, runs):
    import scipy
    from scipy.spatial import Delaunay

    return *clocked(lambda: len(Delaunay(points).simplices), runs), scipy.__version__


def gmsh(points, runs):
    import gmsh as program

    program.initialize()
    program.option.setNumber("General.Terminal", 0)
    program.option.setNumber("General.NumThreads", 1)
    flat = points.ravel()
    return *clocked(lambda: len(program.algorithm.tetrahedralize(flat)[0]) // 4, runs), program.__version__


def tetgen(points, runs):
    """Run TetGen, which reports its "Delaunay seconds" as CPU time."""
    seconds, tets = [], 0
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "points.node"
        rows = [f"{i} {x!r} {y!r} {z!r}" for i, (x, y, z) in enumerate(points.tolist())]
        path.write_text("\n".join([f"{len(points)} 3 0 0", *rows, ""]))
        for _ in range(runs):
            done = subprocess.run(["tetgen", "-VNEF", str(path)], capture_output=True, text=True)
            reported = re.search(r"Delaunay seconds:\s*(\S+)", done.stdout)
            if reported is None:
                sys.exit(f"tetgen ended with {done.returncode}: {(done.stdout + done.stderr)[-150:]!r}")
            seconds.append(float(reported[1]))
            count = re.search(r"Mesh tetrahedra:\s*(\d+)", done.stdout)
            tets = int(count[1]) if count else 0
        version = subprocess.run(["tetgen", "-h"], capture_output=True, text=True).stdout
        found = re.search(r"Version (\S+)", version)
    return seconds, tets, found[1] if found else "?"


program, path, runs = sys.argv[1:]
seconds, tets, version = {"qhull": qhull, "gmsh": gmsh, "tetgen": tetgen}[program](
    np.fromfile(path).reshape(-1, 3), int(runs))
print(json.dumps({"seconds": seconds, "tets": tets, "version": version}))
