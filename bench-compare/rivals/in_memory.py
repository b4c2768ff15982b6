"""Helpers of programs called from Python: measurement of time, and Gmsh's mesh as arrays."""
import time

import numpy as np


def clocked(work):
    start = time.perf_counter()
    done = work()
    return time.perf_counter() - start, done


def gmsh_tets(mesh):
    """Return the points and tets of `gmsh.model.mesh`, numbered from 0."""
    tags, coordinates, _ = mesh.getNodes()
    row = np.zeros(int(tags.max()) + 1, np.int64)
    row[tags.astype(np.int64)] = np.arange(len(tags))
    tets = row[mesh.getElementsByType(4)[1].astype(np.int64).reshape(-1, 4)]
    return coordinates.reshape(-1, 3), tets
