"""Mesh motion by the Delaunay graph in SciPy; measures set-up and update, and writes the weights for the C
loop.

usage: motion_scipy.py prepare MESH.npz FOLDER       set-up once, weights are written to FOLDER
       motion_scipy.py update FOLDER SECONDS         only the update, repeated
"""
import json
import sys
import time
from pathlib import Path

import numpy as np
import scipy
import scipy.sparse
from scipy.spatial import Delaunay


def prepare(path, folder):
    mesh = np.load(path)
    points, boundary = mesh["points"], np.concatenate([mesh["sphere"], mesh["walls"]])
    inside = np.setdiff1d(np.arange(len(points)), boundary)
    start = time.perf_counter()
    graph = Delaunay(points[boundary])
    tet = graph.find_simplex(points[inside], tol=1e-12)
    missed = int(np.count_nonzero(tet < 0))
    tet = np.maximum(tet, 0)
    transform = graph.transform[tet]
    three = np.einsum("nij,nj->ni", transform[:, :3], points[inside] - transform[:, 3])
    weights = np.column_stack([three, 1.0 - three.sum(axis=1)])
    ids = graph.simplices[tet].astype(np.uint32)
    seconds = time.perf_counter() - start
    moved = points[boundary].copy()
    moved[:len(mesh["sphere"]), 0] += 0.5
    folder.mkdir(parents=True, exist_ok=True)
    ids.tofile(folder / "ids.u32")
    weights.tofile(folder / "weights.f64")
    moved.tofile(folder / "boundary.f64")
    # Data for the same computation as motet's: displacements of all vertices, with boundary vertices at their
    # own node.
    all_ids = np.empty((len(points), 4), np.uint32)
    all_weights = np.full((len(points), 4), 0.25)
    all_ids[boundary] = np.arange(len(boundary))[:, None]
    all_ids[inside], all_weights[inside] = ids, weights
    all_ids.tofile(folder / "all_ids.u32")
    all_weights.tofile(folder / "all_weights.f64")
    (moved - points[boundary]).tofile(folder / "displacement.f64")
    points.tofile(folder / "from.f64")
    return {"seconds": [seconds], "missed": missed, "graph_tets": len(graph.simplices), "inside": len(inside)}


def update(folder, budget):
    ids = np.fromfile(folder / "ids.u32", np.uint32).reshape(-1, 4)
    weights = np.fromfile(folder / "weights.f64")
    boundary = np.fromfile(folder / "boundary.f64").reshape(-1, 3)
    rows = np.arange(0, 4 * len(ids) + 1, 4)
    matrix = scipy.sparse.csr_matrix((weights, ids.ravel().astype(np.int32), rows), (len(ids), len(boundary)))
    seconds, until = [], time.perf_counter() + budget
    matrix @ boundary
    while len(seconds) < 5 or time.perf_counter() < until:
        start = time.perf_counter()
        matrix @ boundary
        seconds.append(time.perf_counter() - start)
    return {"seconds": seconds}


verb, source, last = sys.argv[1:]
result = prepare(Path(source), Path(last)) if verb == "prepare" else update(Path(source), float(last))
print(json.dumps({**result, "version": scipy.__version__}))
