"""Meshing of CAD bodies, which are planar up to rounding, compared with TetGen -pY.

Every triangle must be a facet, and every tet positive in exact arithmetic. CAD_BODIES is the number of bodies
(default 28).
"""
import os
import subprocess
import sys
from fractions import Fraction
from itertools import combinations

import meshio
import numpy as np

COUNT = int(os.environ.get("CAD_BODIES", "28"))

# TetGen runs in a separate process, body by body. Some bodies crash it; the next process continues after
# these.
TETGEN = """
import sys, meshio, numpy, tetgen
for seed in range(int(sys.argv[2]), int(sys.argv[3])):
    body = meshio.read(f"{sys.argv[1]}/{seed}.off")
    print(seed, flush=True)
    try:
        points, tets, *_ = tetgen.TetGen(body.points, body.cells_dict["triangle"].astype(numpy.int32)).tetrahedralize(switches="pYQ")
    except RuntimeError:
        continue
    numpy.savez(f"{sys.argv[1]}/{seed}.npz", points=points, tets=tets)
"""


def is_positive(corners):
    """Return whether the volume is above 0, in exact arithmetic."""
    a, b, c, d = ([Fraction(float(x)) for x in p] for p in corners)
    u, v, w = ([x - y for x, y in zip(p, a)] for p in (b, c, d))
    return u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0]) + u[2] * (v[0] * w[1] - v[1] * w[0]) > 0


def volumes(points, tets):
    a, b, c, d = (points[tets[:, i]] for i in range(4))
    return np.einsum("ij,ij->i", b - a, np.cross(c - a, d - a)) / 6


def all_positive(points, tets):
    """Return whether all volumes are above 0; exact arithmetic decides where floating point cannot."""
    extent = np.abs(points - points[0]).max()
    doubtful = np.flatnonzero(volumes(points, tets) < 1e-9 * extent**3)
    return all(is_positive(points[tet]) for tet in tets[doubtful])


def kept(body, points, tets):
    """Count the triangles of the body that are facets of tets, by exact coordinates."""
    key = lambda p: tuple(np.asarray(p, float) + 0.0)
    facets = {frozenset(three) for tet in tets for three in combinations(map(int, tet), 3)}
    place = {key(p): i for i, p in enumerate(points)}
    of = ([place.get(key(body["points"][v])) for v in triangle] for triangle in body["triangles"])
    return sum(frozenset(ids) in facets for ids in of)


def fill_by_tetgen(folder, count):
    """Write SEED.npz for each body that TetGen fills."""
    seed = 0
    while seed < count:
        # TetGen writes skipped facets to its working directory.
        command = [sys.executable, "-c", TETGEN, folder, str(seed), str(count)]
        done = subprocess.run(command, capture_output=True, text=True, cwd=folder)
        started = [int(line) for line in done.stdout.split("\n") if line.isdigit()]
        assert started, done.stderr
        seed = started[-1] + 1


def test_each_triangle_is_a_facet_and_each_tet_positive(motet, example, tmp_path):
    example("cad_bodies").run(COUNT, 0, tmp_path)
    fill_by_tetgen(tmp_path, COUNT)
    counts = {"bodies": 0, "motet": 0, "TetGen: none": 0, "TetGen: triangles lost": 0, "TetGen: tets not positive": 0, "TetGen: correct": 0}
    for seed in range(COUNT):
        read = meshio.read(tmp_path / f"{seed}.off")
        body = {"points": read.points, "triangles": read.cells_dict["triangle"].astype(np.int32)}
        # As text: meshio 5.3.5 confuses arrays of appended raw data that happen to have equal offsets.
        motet("mesh", tmp_path / f"{seed}.off", "-o", tmp_path / "mesh.vtu", "-q", "--ascii")
        mesh = meshio.read(tmp_path / "mesh.vtu")
        tets = mesh.cells_dict["tetra"]
        assert kept(body, mesh.points, tets) == len(body["triangles"]), seed
        assert all_positive(mesh.points, tets), seed
        counts["bodies"] += 1
        counts["motet"] += 1
        if not (tmp_path / f"{seed}.npz").exists():
            counts["TetGen: none"] += 1
            continue
        filled = np.load(tmp_path / f"{seed}.npz")
        theirs = filled["points"], filled["tets"]
        is_lost = kept(body, *theirs) < len(body["triangles"])
        is_off = not all_positive(*theirs)
        counts["TetGen: triangles lost"] += is_lost
        counts["TetGen: tets not positive"] += is_off
        if not is_lost and not is_off:
            counts["TetGen: correct"] += 1
            # Both meshes fill the same body.
            ours, other = volumes(mesh.points, tets).sum(), volumes(*theirs).sum()
            assert abs(ours - other) <= 1e-9 * abs(other), seed
    print(counts)
