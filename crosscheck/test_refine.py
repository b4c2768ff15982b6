"""Refined meshes read by meshio and VTK: conformity, volumes, areas, quality by Verdict, and stored
divisions."""
import numpy as np
import pytest
from meshes import assert_same_array, cell_array_of, cells_of, volumes
from test_remesh import region_volumes, verdict_eas

meshio = pytest.importorskip("meshio")

FACETS = ((1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1))


def facet_uses(tets):
    """Return the number of tets at each facet."""
    facets = np.sort(np.concatenate([tets[:, list(facet)] for facet in FACETS]), axis=1)
    _, uses = np.unique(facets, axis=0, return_counts=True)
    return uses


def areas(mesh):
    """Return the area of each patch."""
    triangles, patches = cells_of(mesh)["triangle"], cell_array_of(mesh, "patch")["triangle"]
    a, b, c = mesh.points[triangles].transpose(1, 0, 2)
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
    return {int(patch): area[patches == patch].sum() for patch in np.unique(patches)}


@pytest.fixture(scope="module")
def box(sphere):
    """The path of a mesh of a sphere in a box, with two patches."""
    return sphere[0] / "box.vtu"


def assert_conforms(first, fine):
    """Assert that a mesh derived from `first` is conforming, with the same volumes and areas."""
    tets = cells_of(fine)["tetra"]
    before, after = facet_uses(cells_of(first)["tetra"]), facet_uses(tets)
    assert after.max() == 2 and before.max() == 2
    for was, now in ((areas(first), areas(fine)), (region_volumes(first, "region"), region_volumes(fine, "region"))):
        assert was.keys() == now.keys()
        assert all(np.isclose(was[label], now[label], rtol=1e-12) for label in was)
    # Interior facets with only one tet would be counted in addition.
    triangles = len(cells_of(fine)["triangle"])
    assert (after == 1).sum() == triangles
    assert len({*map(tuple, fine.points)}) == len(fine.points), "two points coincide"


def test_refined_meshes_conform_and_have_the_reported_quality(motet, box, tmp_path):
    fine = tmp_path / "fine.vtu"
    report = motet.json("refine", box, "-o", fine, "--ball", "1.1,0,0,0.3", "--generations", 3)
    first, mesh = meshio.read(box), meshio.read(fine)
    assert_conforms(first, mesh)
    last = report["steps"][-1]
    tets = cells_of(mesh)["tetra"]
    assert last["tets"] == len(tets) and last["points"] == len(mesh.points)
    assert (volumes(mesh.points, tets) > 0).all()
    eas = verdict_eas(fine)
    assert abs(eas.min() - last["worst_eas"]) < 1e-7 and abs(eas.mean() - last["mean_eas"]) < 1e-9
    assert_same_array(mesh.points[:len(first.points)], first.points, "points of the initial mesh")


@pytest.mark.parametrize("ending", [".vtu", ".vtk"])
def test_divisions_can_be_undone_after_another_program_rewrote_the_file(motet, box, tmp_path, ending):
    fine, theirs, back = tmp_path / "fine.vtu", tmp_path / f"theirs{ending}", tmp_path / "back.vtu"
    motet("refine", box, "-o", fine, "--ball", "1.1,0,0,0.3", "--generations", 2)
    meshio.write(theirs, meshio.read(fine))
    for _ in range(2):
        motet("refine", theirs, "-o", back, "--coarsen")
        theirs = back
    first, last = meshio.read(box), meshio.read(back)
    assert_same_array(last.points, first.points, "points")
    for kind, cells in cells_of(first).items():
        assert_same_array(cells_of(last)[kind], cells, kind)


def test_a_repaired_mesh_is_coarsened_where_it_was_not_changed(motet, box, tmp_path):
    fine, moved, repaired, back = (tmp_path / f"{name}.vtu" for name in ("fine", "moved", "repaired", "back"))
    # Refined at the moving sphere and in a corner that does not move.
    motet("refine", box, "-o", fine, "--ball", "1.2,0,0,0.2", "--ball=-4,-4,-4,0.6")
    motet("move", fine, "-o", moved, "--translate", "sphere=0.6,0,0")
    report = motet.json("remesh", moved, "-o", repaired, "--min-eas", 0.33)
    assert 0 < report["before"]["tets"] - report["kept"] < 1000, "unexpected number of changed tets"
    motet("refine", repaired, "-o", back, "--coarsen")
    mesh, was = meshio.read(back), meshio.read(repaired)
    assert_conforms(was, mesh)
    # Away from the repair, the initial mesh is restored.
    first, moved_mesh = meshio.read(box), meshio.read(moved)
    place = dict(zip(map(tuple, moved_mesh.points[:len(first.points)]), range(len(first.points))))
    number = np.array([place.get(tuple(point), -1) for point in mesh.points])
    there = {tuple(sorted(tet)) for tet in number[cells_of(mesh)["tetra"]]}
    of_first = cells_of(first)["tetra"]
    lost = [tet for tet in of_first if tuple(sorted(tet)) not in there]
    assert len(lost) < 0.02 * len(of_first), len(lost)
    far = first.points[np.array(lost, int).reshape(-1, 4)].mean(axis=1)[:, 0]
    assert (far > 0.0).all(), "the corner has changed"
