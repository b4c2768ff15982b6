"""The moving mesh: results, errors, and identical results after save and load."""
import numpy as np
import pytest

import motet
from motet import shapes


def sphere_at(moving, by, turn=0.0):
    """Displacements that shift the sphere and turn it about z, and keep the box."""
    places = moving.driven_places
    is_sphere = np.linalg.norm(places, axis=1) < 1.01
    c, s = np.cos(turn), np.sin(turn)
    moved = places @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]) + by
    return np.where(is_sphere[:, None], moved - places, 0.0)


def test_no_tet_is_bad_after_large_motions_of_a_sphere():
    moving = motet.MovingMesh(shapes.sphere_in_box(5, 4), smooth=2, watch=["sphere", "box"], warn=1.5)
    first = np.arange(moving.mesh.n_points, dtype=float)
    changes = 0
    for k in range(1, 9):
        phase = 2.0 * np.pi * k / 8.0
        step = moving.advance(k * 0.1, sphere_at(moving, (3.0 * np.sin(phase), 0.0, 0.0), 1.2 * np.sin(phase)))
        assert step.complete and step.bad == 0 and step.inverted == 0
        assert step.worst.eas >= 0.2 and step.gaps.least == pytest.approx(4.0 - abs(3.0 * np.sin(phase)), abs=0.2)
        assert (step.gaps.warned > 0) == (step.gaps.least < 1.5)
        changes += len(step.changes)
        assert moving.points.shape == moving.velocity.shape == moving.displacement.shape == (moving.mesh.n_points, 3)
    assert changes > 0 and moving.step == 8 and moving.time == pytest.approx(0.8)
    carried = moving.history_since(0).transfer(first, on="points")
    assert carried.shape == (moving.mesh.n_points,)
    assert moving.remembers(0) and moving.history_since(8) is None


def test_a_loaded_mesh_continues_with_the_same_results(tmp_path):
    options = {"smooth": 2}
    whole = motet.MovingMesh(shapes.sphere_in_box(4, 4), **options)
    broken = motet.MovingMesh(shapes.sphere_in_box(4, 4), **options)
    for k in range(1, 7):
        by = sphere_at(whole, (0.5 * k, 0.0, 0.0), 0.2 * k)
        whole.advance(k, by)
        broken.save(tmp_path / "state.vtu")
        broken = motet.MovingMesh.load(tmp_path / "state.vtu", **options)
        broken.advance(k, by)
        assert np.array_equal(whole.points, broken.points)
    assert not broken.remembers(0)
    with pytest.raises(motet.OptionsError, match="since step 0"):
        broken.history_since(0)
    with pytest.raises(motet.OptionsError, match="motion.smooth was 2 and is 0"):
        motet.MovingMesh.load(tmp_path / "state.vtu")


def test_a_refined_mesh_follows_the_walls():
    moving = motet.MovingMesh(shapes.sphere_in_box(3, 3), smooth=2)
    moving.set_array("dye", np.ones(moving.mesh.n_cells), on="cells")
    [change] = moving.refine(ball=[((0.0, 0.0, 0.0), 1.4)])
    assert change.why == "refinement" and change.tets_after > change.tets_before
    assert moving.refine(coarsen=True)
    assert moving.coarsen() is None
    moving.refine(patch=["sphere"])
    step = moving.advance(1.0, sphere_at(moving, (0.5, 0.0, 0.0)))
    assert step.complete and np.all(moving.mesh.cell_data["dye"] == 1.0)


def test_invalid_arguments_raise_an_error():
    mesh = shapes.sphere_in_box(3, 3)
    moving = motet.MovingMesh(mesh)
    still = np.zeros_like(moving.driven_places)
    with pytest.raises(motet.InputError, match="driven"):
        moving.advance(1.0, still[1:])
    with pytest.raises(motet.OptionsError, match="not after"):
        moving.advance(0.0, still)
    with pytest.raises(motet.Error, match="no patch|sphere, box"):
        motet.MovingMesh(mesh, slide=["door"])
    with pytest.raises(motet.OptionsError, match="surface"):
        motet.MovingMesh(mesh, surface="melt")
    with pytest.raises(TypeError):
        motet.MovingMesh(mesh, speed=3)
    with pytest.raises(motet.InputError, match="rows"):
        moving.set_array("p", np.zeros(3), on="cells")


def test_a_copy_continues_with_the_same_bytes_and_alone():
    first = motet.MovingMesh(shapes.sphere_in_box(4, 4))
    is_sphere = np.linalg.norm(first.driven_places, axis=1) < 2
    by = np.outer(is_sphere, [1.0, 0.5, 0.0])
    first.advance(1.0, by)
    second = first.copy()
    before = first.points
    reports = [moving.advance(2.0, 2 * by) for moving in (first, second)]
    assert reports[0].tets == reports[1].tets and np.array_equal(first.points, second.points)
    assert np.array_equal(first.mesh.tets, second.mesh.tets) and not np.array_equal(first.points[: len(before)], before)
    second.advance(3.0, 0 * by)
    assert first.step == 2 and not np.array_equal(first.points, second.points[: len(first.points)])


def test_a_preview_is_the_step_without_repair_and_changes_nothing():
    moving = motet.MovingMesh(shapes.sphere_in_box(4, 4), repair=False)
    by = np.outer(np.linalg.norm(moving.driven_places, axis=1) < 2, [0.3, 0.0, 0.0])
    before = moving.points
    points = moving.preview(by)
    assert np.array_equal(moving.points, before) and moving.step == 0
    moving.advance(1.0, by)
    assert np.array_equal(moving.points, points)
    with pytest.raises(motet.InputError):
        moving.preview(by[1:])
