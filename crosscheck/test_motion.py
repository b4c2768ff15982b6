"""Mesh motion compared with affine maps, and with a simple implementation of the method in SciPy.

`pytest -s` prints the tables.
"""
import importlib.util
import json

import meshio
import numpy as np
import pytest
from conftest import ROOT
from meshes import volumes
from scipy.spatial import Delaunay

# All real meshes with tetrahedra; the tests of the crate read the same list.
TET_MESHES = (ROOT / "crates" / "motet" / "tests" / "real_tet_meshes.txt").read_text().split()
GARBAGE = 1e6  # displacement of interior vertices, which must be ignored


def tets_of(mesh):
    return np.vstack([block.data for block in mesh.cells if block.type == "tetra"])


def boundary_vertices(tets):
    """Return the ids of the vertices of all facets that belong to only one tet."""
    facets = np.sort(np.vstack([tets[:, [1, 2, 3]], tets[:, [0, 2, 3]], tets[:, [0, 1, 3]], tets[:, [0, 1, 2]]]), axis=1)
    unique, counts = np.unique(facets, axis=0, return_counts=True)
    return np.unique(unique[counts == 1])


def write_with_displacement(path, points, tets, displacement, boundary):
    """Write a mesh with an array `u`: the displacement on the boundary, and garbage inside."""
    u = np.full_like(points, GARBAGE)
    u[boundary] = displacement[boundary]
    meshio.Mesh(points, [("tetra", tets)], point_data={"u": u}).write(path)


def near_identity(rng):
    """Return a 3x4 matrix: the identity with a random change of up to 20 % in each entry, and a
    translation."""
    return np.hstack([np.eye(3) + rng.uniform(-0.2, 0.2, (3, 3)), rng.uniform(-1, 1, (3, 1))])


@pytest.mark.parametrize("name", TET_MESHES)
def test_an_affine_boundary_motion_moves_every_vertex_affinely(name, motet, data, tmp_path):
    motet("convert", data / name, tmp_path / "in.vtu")
    mesh = meshio.read(tmp_path / "in.vtu")
    points, tets = mesh.points, tets_of(mesh)
    box = np.linalg.norm(np.ptp(points, axis=0))
    used = np.zeros(len(points), bool)
    used[tets] = True
    worst = 0.0
    for seed in range(3):
        matrix = near_identity(np.random.default_rng(seed))
        matrix[:, 3] *= box
        expected = points @ matrix[:, :3].T + matrix[:, 3]
        write_with_displacement(tmp_path / "u.vtu", points, tets, expected - points, boundary_vertices(tets))
        motet("move", tmp_path / "u.vtu", "-o", tmp_path / "out.vtu", "--displacement", "u")
        moved = meshio.read(tmp_path / "out.vtu").points
        worst = max(worst, np.abs(moved - expected)[used].max() / box)
    print(f"\n{name}: {len(points)} vertices, largest error {worst:.1e} of the bounding box")
    assert worst < 1e-10


def test_the_list_contains_all_tetrahedral_meshes(data):
    """A new mesh in the data must be added to the list."""
    holds_tets = {str(path.relative_to(data)) for path in data.rglob("*")
                  if path.suffix in (".msh", ".mesh", ".node", ".vtu", ".gz") and "boundary.vtu" not in path.name
                  and "devices" not in path.parts}
    assert holds_tets == set(TET_MESHES)


def gmsh_meshes():
    """Import the module of the benchmarks that creates meshes with Gmsh."""
    spec = importlib.util.spec_from_file_location("gmsh_meshes", ROOT / "bench-compare" / "meshes.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def plain_mapping(points, boundary):
    """Set up the method with Qhull, find_simplex and barycentric weights.

    Return the map of boundary positions.
    """
    graph = Delaunay(points[boundary])
    inner = np.setdiff1d(np.arange(len(points)), boundary)
    tet = np.maximum(graph.find_simplex(points[inner], tol=1e-12), 0)
    transform = graph.transform[tet]
    first = np.einsum("nij,nj->ni", transform[:, :3], points[inner] - transform[:, 3])
    weights = np.c_[first, 1 - first.sum(axis=1)]

    def moved(boundary_positions):
        out = points.copy()
        out[boundary] = boundary_positions
        out[inner] = np.einsum("nk,nkc->nc", weights, boundary_positions[graph.simplices[tet]])
        return out
    return moved


def test_a_sphere_moves_in_a_box_without_inverted_tets(motet, tmp_path):
    """By 0.5, 1 and 2 radii in one step; by 3 radii in sub-steps, possibly with exit status 4."""
    made = gmsh_meshes()
    points, tets, sphere, wall = made.sphere_in_box("B", str(tmp_path))
    boundary = np.union1d(sphere, wall)
    plain = plain_mapping(points, boundary)
    print(f"\n{len(points)} vertices, {len(boundary)} on the boundary, {len(tets)} tets\n"
          "travel  worst EAS  inverted  exit  reached  sub-steps | SciPy: worst EAS  inverted")
    for travel in (0.5, 1.0, 2.0, 3.0):
        displacement = np.zeros_like(points)
        displacement[sphere, 0] = travel * made.RADIUS
        write_with_displacement(tmp_path / "u.vtu", points, tets, displacement, boundary)
        done = motet("move", tmp_path / "u.vtu", "-o", tmp_path / "out.vtu", "--displacement", "u", "--json", code=None)
        assert done.returncode in ((0,) if travel <= 2 else (0, 4)), done.stderr
        moved = meshio.read(tmp_path / "out.vtu").points
        assert np.abs(moved).max() <= made.HALF_EDGE + 1e-12
        inverted = int((volumes(moved, tets) <= 0).sum())
        ours = motet.json("info", tmp_path / "out.vtu")
        meshio.Mesh(plain((points + displacement)[boundary]), [("tetra", tets)]).write(tmp_path / "plain.vtu")
        theirs = motet.json("info", tmp_path / "plain.vtu")
        report = json.loads(done.stdout)["after"]
        reached = (moved - points)[sphere, 0].mean() / made.RADIUS
        print(f"{travel:4.1f} R  {ours['quality']['eas']['min']:9.4f}  {inverted:8d}  {done.returncode:4d}"
              f"  {reached:5.3f} R  {report['substeps']:9} | {theirs['quality']['eas']['min']:16.4f}  {theirs['inverted']:8d}")
        assert inverted == 0
        if travel <= 2:
            assert np.array_equal(moved[boundary], (points + displacement)[boundary])
