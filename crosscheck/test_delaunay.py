"""Delaunay triangulation compared with other programs, and with the definition in integer arithmetic.

Where the triangulation is unique, sets of tets are equal. Elsewhere the volume is that of the hull, facets
match, and spheres are empty.
"""
import shutil
import subprocess
from collections import Counter

import numpy as np
import pytest
from conftest import ROOT
from meshes import tet_set, volumes
from scipy.spatial import ConvexHull, Delaunay


@pytest.fixture
def triangulate(example, tmp_path):
    """A function that triangulates points and returns the tets, or the completed process if
    `code` is not 0."""
    program = example("delaunay")

    def call(points, threads=1, code=0):
        source, tets = tmp_path / "points.f64", tmp_path / "tets.u32"
        np.ascontiguousarray(points, float).tofile(source)
        done = program.run(source, "--threads", threads, "--tets", tets, code=code)
        return np.fromfile(tets, np.uint32).reshape(-1, 4).astype(np.int64) if code == 0 else done

    return call


def grid(*counts):
    return np.stack(np.meshgrid(*map(np.arange, counts), indexing="ij"), -1).reshape(-1, 3)


def lattice_sphere(radius_squared):
    """Return all integer points at one distance from the origin, which are exactly cospherical."""
    reach = int(radius_squared**0.5) + 1
    points = grid(*[2 * reach + 1] * 3) - reach
    return points[(points**2).sum(axis=1) == radius_squared]


def in_sphere(tet, point):
    """Return an exact value for integer points: positive inside the sphere of a positive tet."""
    rows = [[int(v) for v in corner - point] for corner in tet]
    rows = [[*r, sum(v * v for v in r)] for r in rows]

    def minor(matrix):
        if len(matrix) == 1:
            return matrix[0][0]
        return sum((-1) ** i * row[0] * minor([r[1:] for j, r in enumerate(matrix) if j != i])
                   for i, row in enumerate(matrix) if row[0])

    return -minor(rows)


def assert_triangulates(points, tets):
    """Assert that tets are positive, meet in whole facets, use every point and fill the convex hull."""
    sizes = volumes(points, tets)
    assert (sizes > 0).all()
    facets = Counter(tuple(sorted(f)) for t in tets.tolist()
                     for f in (t[1:], [t[0], *t[2:]], [t[0], t[1], t[3]], t[:3]))
    assert set(facets.values()) <= {1, 2}
    assert np.array_equal(np.unique(tets), np.arange(len(points)))
    assert sizes.sum() == pytest.approx(ConvexHull(points).volume, rel=1e-12)


def clouds():
    random = np.random.default_rng(11)
    for n in (5, 30, 300, 3000):
        yield f"cube {n}", random.random((n, 3))
    yield "normal 1000", random.normal(size=(1000, 3))
    yield "thin", random.random((500, 3)) * [10.0, 1.0, 0.1]
    direction = random.normal(size=(400, 3))
    yield "shell", direction / np.linalg.norm(direction, axis=1, keepdims=True) * random.uniform(0.9, 1.1, (400, 1))


@pytest.mark.parametrize("points", [pytest.param(p, id=name) for name, p in clouds()])
def test_tets_of_generic_points_are_those_of_qhull(triangulate, points):
    tets = triangulate(points)
    assert_triangulates(points, tets)
    assert np.array_equal(tet_set(tets), tet_set(Delaunay(points).simplices))


@pytest.mark.skipif(not shutil.which("tetgen"), reason="tetgen is not installed")
@pytest.mark.parametrize("n", [100, 20_000])
def test_tets_of_generic_points_are_those_of_tetgen(triangulate, tmp_path, n):
    points = np.random.default_rng(n).random((n, 3))
    rows = [f"{i} {x!r} {y!r} {z!r}" for i, (x, y, z) in enumerate(points.tolist())]
    (tmp_path / "cloud.node").write_text("\n".join([f"{n} 3 0 0", *rows, ""]))
    subprocess.run(["tetgen", "-z", str(tmp_path / "cloud.node")], check=True, capture_output=True)
    theirs = np.loadtxt(tmp_path / "cloud.1.ele", skiprows=1, usecols=(1, 2, 3, 4), dtype=np.int64, comments="#")
    assert np.array_equal(tet_set(triangulate(points)), tet_set(theirs))


CGAL = ROOT / "bench-compare" / "target" / "delaunay_cgal"


@pytest.mark.skipif(not CGAL.exists(), reason="CGAL's driver is not built (bench-compare/run builds it)")
def test_the_number_of_tets_is_that_of_cgal(triangulate, tmp_path):
    import json

    points = np.random.default_rng(2).random((50_000, 3))
    points.tofile(tmp_path / "cloud.f64")
    done = subprocess.run([CGAL, tmp_path / "cloud.f64", "0", "1"], check=True, capture_output=True, text=True)
    assert len(triangulate(points)) == json.loads(done.stdout)["tets"]


@pytest.mark.parametrize("points", [
    pytest.param(grid(5, 5, 5), id="grid"),
    pytest.param(grid(2, 2, 2), id="cube"),
    pytest.param(grid(9, 3, 2), id="slab"),
    pytest.param(lattice_sphere(26), id="sphere 26"),
    pytest.param(lattice_sphere(101), id="sphere 101"),
    pytest.param(np.vstack([lattice_sphere(26), (grid(3, 3, 3) - 1) * 9]), id="sphere in a box"),
])
def test_spheres_of_degenerate_points_are_exactly_empty(triangulate, points):
    tets = triangulate(points)
    assert_triangulates(points.astype(float), tets)
    for tet in tets:
        corners = points[tet]
        assert all(in_sphere(corners, p) <= 0 for p in points), f"the sphere of {tet} is not empty"


def test_the_in_sphere_test_has_the_right_sign():
    corner = np.array([[0, 0, 0], [2, 0, 0], [0, 2, 0], [0, 0, 2]])
    assert volumes(corner, [[0, 1, 2, 3]])[0] > 0
    assert in_sphere(corner, np.array([1, 1, 1])) > 0
    assert in_sphere(corner, np.array([2, 2, 2])) == 0
    assert in_sphere(corner, np.array([3, 3, 3])) < 0


@pytest.mark.parametrize("points", [
    pytest.param(np.random.default_rng(1).random((20_000, 3)), id="cube"),
    pytest.param(grid(20, 20, 20) * 0.1, id="grid"),
])
def test_two_threads_give_the_same_tets(triangulate, points):
    assert np.array_equal(triangulate(points, threads=1), triangulate(points, threads=2))


def test_rotated_points_have_the_same_tets(triangulate):
    points = np.random.default_rng(4).random((2000, 3))
    turn, _ = np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    assert np.array_equal(tet_set(triangulate(points)), tet_set(triangulate(points @ turn.T * 3.0 + 1.0)))


@pytest.mark.parametrize("points, reason", [
    pytest.param(np.zeros((0, 3)), "", id="none"),
    pytest.param(np.eye(3), "", id="three"),
    pytest.param(np.outer(np.arange(10.0), [1.0, 2.0, 3.0]), "line", id="collinear"),
    pytest.param(grid(4, 4, 1), "plan", id="coplanar"),
    pytest.param(np.ones((50, 3)), "", id="one place"),
])
def test_points_that_span_no_volume_are_refused_with_the_reason(triangulate, points, reason):
    done = triangulate(points, code=None)
    assert done.returncode not in (0, 101, -6)
    assert reason in done.stderr
