"""Bodies that are flat but for rounding, filled: every triangle a facet, every tet positive in exact arithmetic; TetGen -pY beside.

CAD_BODIES: how many bodies (default 28)."""
import os
import subprocess
import sys
from fractions import Fraction
from itertools import combinations

import meshio
import numpy as np

COUNT = int(os.environ.get("CAD_BODIES", "28"))

# TetGen in a process of its own: some bodies end that process.
TETGEN = """
import sys, numpy, tetgen
body = numpy.load(sys.argv[1])
points, tets, *_ = tetgen.TetGen(body["points"], body["triangles"]).tetrahedralize(switches="pYQ")
numpy.savez(sys.argv[2], points=points, tets=tets)
"""


def is_positive(corners):
    """Whether the volume is above 0, exactly."""
    a, b, c, d = ([Fraction(float(x)) for x in p] for p in corners)
    u, v, w = ([x - y for x, y in zip(p, a)] for p in (b, c, d))
    return u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0]) + u[2] * (v[0] * w[1] - v[1] * w[0]) > 0


def volumes(points, tets):
    a, b, c, d = (points[tets[:, i]] for i in range(4))
    return np.einsum("ij,ij->i", b - a, np.cross(c - a, d - a)) / 6


def all_positive(points, tets):
    """Floating point decides what it can, exact arithmetic the rest."""
    extent = np.abs(points - points[0]).max()
    doubtful = np.flatnonzero(volumes(points, tets) < 1e-9 * extent**3)
    return all(is_positive(points[tet]) for tet in tets[doubtful])


def kept(body, points, tets):
    """How many triangles of the body are facets of tets, by the bits of their corners."""
    key = lambda p: tuple(np.asarray(p, float) + 0.0)
    facets = {frozenset(three) for tet in tets for three in combinations(map(int, tet), 3)}
    place = {key(p): i for i, p in enumerate(points)}
    of = ([place.get(key(body["points"][v])) for v in triangle] for triangle in body["triangles"])
    return sum(frozenset(ids) in facets for ids in of)


def by_tetgen(body, folder):
    """Points and tets; None where there are none."""
    source, made = folder / "body.npz", folder / "tets.npz"
    made.unlink(missing_ok=True)
    np.savez(source, **body)
    try:
        subprocess.run([sys.executable, "-c", TETGEN, source, made], capture_output=True, timeout=60)
    except subprocess.TimeoutExpired:
        return None
    if not made.exists():
        return None
    found = np.load(made)
    return found["points"], found["tets"]


def test_each_triangle_is_a_facet_and_each_tet_positive(motet, example, tmp_path):
    example("cad_bodies").run(COUNT, 0, tmp_path)
    counts = {"bodies": 0, "motet": 0, "TetGen: none": 0, "TetGen: triangles lost": 0, "TetGen: tets not positive": 0, "TetGen: right": 0}
    for seed in range(COUNT):
        read = meshio.read(tmp_path / f"{seed}.off")
        body = {"points": read.points, "triangles": read.cells_dict["triangle"].astype(np.int32)}
        motet("mesh", tmp_path / f"{seed}.off", "-o", tmp_path / "mesh.vtu", "-q")
        mesh = meshio.read(tmp_path / "mesh.vtu")
        tets = mesh.cells_dict["tetra"]
        assert kept(body, mesh.points, tets) == len(body["triangles"]), seed
        assert all_positive(mesh.points, tets), seed
        counts["bodies"] += 1
        counts["motet"] += 1
        theirs = by_tetgen(body, tmp_path)
        if theirs is None:
            counts["TetGen: none"] += 1
            continue
        is_lost = kept(body, *theirs) < len(body["triangles"])
        is_off = not all_positive(*theirs)
        counts["TetGen: triangles lost"] += is_lost
        counts["TetGen: tets not positive"] += is_off
        if not is_lost and not is_off:
            counts["TetGen: right"] += 1
            # Two fillings of one body.
            ours, other = volumes(mesh.points, tets).sum(), volumes(*theirs).sum()
            assert abs(ours - other) <= 1e-9 * abs(other), seed
    print(counts)
