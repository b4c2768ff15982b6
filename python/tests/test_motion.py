"""Motion of a mesh by its boundary, without copies of arrays."""
import tracemalloc

import numpy as np
import pytest

import motet
from motet import shapes


def shifted(mover, by=(0.5, 0.0, 0.0)):
    """Displacements that shift the sphere of radius 1 and keep the box."""
    at = mover.reference[mover.boundary]
    return np.where((np.linalg.norm(at, axis=1) < 1.01)[:, None], by, 0.0)


@pytest.mark.parametrize("method", ["delaunay", "bodies", "guided", "elastic", "laplace", "idw", "rbf"])
def test_every_method_moves_the_boundary_exactly(method):
    mesh = shapes.sphere_in_box()
    mover = motet.Mover(mesh, method=method)
    displacement = shifted(mover)
    points, certificate = mover.advance(displacement)
    assert certificate.complete and certificate.inverted == 0
    np.testing.assert_array_equal(points[mover.boundary], mesh.points[mover.boundary] + displacement)


def test_an_affine_motion_moves_every_vertex_by_the_same_map():
    mesh = shapes.sphere_in_box()
    mover = motet.Mover(mesh)
    a = np.array([[1.1, 0.2, 0.0], [0.0, 0.9, 0.1], [0.0, 0.0, 1.2]])
    points = mover.step((mesh.points @ a.T + 3 - mesh.points)[mover.boundary])
    np.testing.assert_allclose(points, mesh.points @ a.T + 3, atol=1e-12)


def test_vertices_follow_their_weights():
    mesh = shapes.sphere_in_box()
    mover = motet.Mover(mesh)
    displacement = np.zeros((mesh.n_points, 3))
    displacement[mover.boundary] = shifted(mover)
    points = mover.step(displacement[mover.boundary])
    inside = np.setdiff1d(np.arange(mesh.n_points), mover.boundary)
    for vertex in inside[::50]:
        vertices, weights = mover.weights(int(vertex))
        np.testing.assert_allclose(points[vertex], mesh.points[vertex] + np.array(weights) @ displacement[list(vertices)], atol=1e-13)
    assert mover.weights(int(mover.boundary[0])) is None


def test_a_step_copies_no_array():
    mesh = shapes.sphere_in_box(16, 12)
    mover = motet.Mover(mesh)
    displacement, out = shifted(mover), np.empty_like(mesh.points)
    mover.step(displacement, out)
    place = out.ctypes.data
    tracemalloc.start()
    for _ in range(10):
        assert mover.step(displacement, out) is out
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert out.ctypes.data == place
    # numpy reports its arrays to tracemalloc; even the smallest of these would exceed the limit.
    assert peak < displacement.nbytes / 4


def test_a_part_of_the_points_moves_like_all_points():
    mesh = shapes.sphere_in_box()
    mover = motet.Mover(mesh)
    nodes, displacement = mesh.points[mover.boundary], shifted(mover)
    whole = motet.PointMover(nodes, mesh.points)
    moved = whole.step(displacement)
    np.testing.assert_allclose(moved[mover.boundary], nodes + displacement, atol=1e-14)
    part = motet.PointMover(nodes[::-1], mesh.points[:700], threads=2).step(displacement[::-1])
    np.testing.assert_allclose(part, moved[:700], atol=1e-14)
    assert whole.n_outside == 0
    with pytest.raises(motet.InputError, match="span"):
        motet.PointMover(nodes[:3], mesh.points)
    with pytest.raises(motet.InputError, match="displacement"):
        whole.step(displacement[:-1])


def test_displacements_of_any_array_type_are_accepted():
    mover = motet.Mover(shapes.sphere_in_box())
    displacement = shifted(mover)
    first = mover.step(displacement)
    displacement.flags.writeable = False
    for same in (displacement, displacement.tolist(), np.asfortranarray(displacement), displacement.astype(np.float32)):
        np.testing.assert_array_equal(mover.step(same), first)


@pytest.mark.parametrize("threads", [2, 0])
def test_results_do_not_depend_on_threads(threads):
    mesh = shapes.sphere_in_box(16, 12)
    one, more = motet.Mover(mesh, smooth=2), motet.Mover(mesh, smooth=2, threads=threads)
    displacement = shifted(one, (1.5, 0.3, 0.0))
    np.testing.assert_array_equal(one.advance(displacement)[0], more.advance(displacement)[0])


def test_options_of_a_mover():
    mesh = shapes.tube(wall_layers=3)
    turned = motet.Mover(mesh, slide=["inlet", 3], rigid_layer_cells=3, rigid_layer_at=["wall"], within_walls=True, smooth=1)
    assert turned.setup.sliding > 0 and turned.setup.layer > 0
    by_facets = motet.Mover(mesh, slide=[mesh.triangles[mesh.cell_data["patch"][mesh.cell_ids("triangle")] == 2], "outlet"])
    by_name = motet.Mover(mesh, slide=["inlet", "outlet"])
    displacement = np.zeros((len(by_name.boundary), 3))
    displacement[:, 2] = 0.1 * by_name.reference[by_name.boundary, 0] ** 2
    np.testing.assert_array_equal(by_facets.step(displacement), by_name.step(displacement))
    inside = np.setdiff1d(np.arange(mesh.n_points), by_name.boundary)[:5]
    assert set(inside) <= set(motet.Mover(mesh, also_moved=inside).boundary)


def test_move_translates_rotates_and_displaces():
    mesh = shapes.sphere_in_box()
    moved = motet.move(mesh, translate={"sphere": (1.0, 0.0, 0.0)}, smooth=2)
    assert moved.complete and moved.mesh.cell_data.keys() == mesh.cell_data.keys()
    sphere = mesh.patch_vertices("sphere")
    np.testing.assert_allclose(moved.mesh.point_data["displacement"][sphere], [[1.0, 0.0, 0.0]] * len(sphere), atol=1e-15)
    turned = motet.move(mesh, rotate={"sphere": ((0, 0, 1), 90)}, method="bodies", steps=3).mesh
    x, y, z = mesh.points[sphere].T
    np.testing.assert_allclose(turned.points[sphere], np.column_stack([-y, x, z]), atol=1e-14)
    mesh.point_data["u"] = np.where(np.isin(np.arange(mesh.n_points), sphere)[:, None], (1.0, 0.0, 0.0), 0.0)
    np.testing.assert_array_equal(motet.move(mesh, displacement="u", smooth=2).mesh.points, moved.mesh.points)


def test_auto_reports_the_methods_that_it_tried():
    moved = motet.move(shapes.sphere_in_box(), rotate={"sphere": ((0, 0, 1), 60)}, method="auto", least=0.1)
    assert moved.choice.tried[0].method == "delaunay" and not moved.choice.tried[0].kept
    assert moved.choice.method != "delaunay" and moved.certificate.worst_eas.value >= 0.1


def test_an_incomplete_motion_is_reported_without_an_error():
    moved = motet.move(shapes.sphere_in_box(), translate={"sphere": (9.0, 0.0, 0.0)})
    assert not moved.complete and 0 < moved.certificate.fraction < 1 and moved.certificate.inverted == 0


def test_mesh_velocity_is_a_backward_difference():
    points = shapes.box().points
    np.testing.assert_allclose(motet.mesh_velocity(points, points + 0.5, 0.25), 2.0)


@pytest.mark.parametrize(
    "call, message",
    [
        (lambda mesh: motet.Mover(mesh, method="magic"), "guided"),
        (lambda mesh: motet.Mover(mesh, slide=["door"]), "sphere, box"),
        (lambda mesh: motet.Mover(mesh, slide="box"), "['box']"),
        (lambda mesh: motet.Mover(mesh, slide=[[[0, 1]]]), "three vertices"),
        (lambda mesh: motet.Mover(mesh, rigid_layer=0.1, rigid_layer_cells=1), "one of them"),
        (lambda mesh: motet.Mover(mesh, also_moved=[99999]), "vertex 99999"),
        (lambda mesh: motet.Mover(shapes.aneurysm()), "volume"),
        (lambda mesh: motet.Mover(mesh).step(np.zeros((3, 3))), "expected ("),
        (lambda mesh: motet.Mover(mesh).step(np.full((len(motet.Mover(mesh).boundary), 3), np.nan)), "finite"),
        (lambda mesh: motet.Mover(mesh).step(shifted(motet.Mover(mesh)), np.zeros((3, 3))), "float64"),
        (lambda mesh: motet.Mover(mesh).step(shifted(motet.Mover(mesh)), mesh.points.astype("f4")), "float64"),
        (lambda mesh: motet.Mover(mesh).weights(99999), "99999"),
        (lambda mesh: motet.move(mesh), "nothing moves"),
        (lambda mesh: motet.move(mesh, displacement="u"), "'u'"),
        (lambda mesh: motet.move(mesh, translate={"sphere": (1, 2)}), "three numbers"),
        (lambda mesh: motet.move(mesh, translate={"door": (1, 2, 3)}), "door"),
        (lambda mesh: motet.move(mesh, translate={"box": (1, 2, 3)}, steps=0), "1 or more"),
    ],
)
def test_invalid_arguments_raise_an_error(call, message):
    with pytest.raises(ValueError) as error:
        call(shapes.sphere_in_box())
    assert isinstance(error.value, motet.Error) and message in str(error.value)
    with pytest.raises(TypeError):
        motet.Mover(shapes.box(), speed=1)


def test_arrays_that_share_memory_are_refused():
    mesh = shapes.sphere_in_box(4, 3)
    mover = motet.Mover(mesh)
    n, k = mesh.n_points, len(mover.boundary)
    memory = np.zeros((n + k, 3))
    apart = mover.step(memory[n:], memory[:n])
    np.testing.assert_array_equal(apart, mesh.points)
    raw = bytearray(8 * 3 * n)
    views = [np.frombuffer(raw, np.float64).reshape(-1, 3) for _ in range(2)]
    for call in (mover.step, mover.advance):
        for out in (memory[: n], memory[k - 1 : n + k - 1]):
            with pytest.raises(motet.InputError, match="shares memory"):
                call(memory[:k], out)
        # Two arrays over one buffer, without a common base array.
        with pytest.raises(motet.InputError, match="shares memory"):
            call(views[0][:k], views[1])
    whole = motet.PointMover(mesh.points[mover.boundary], mesh.points)
    with pytest.raises(motet.InputError, match="shares memory"):
        whole.step(memory[:k], memory[:n])


@pytest.mark.parametrize(
    "out",
    [
        lambda n: np.zeros((n, 4))[:, :3],
        lambda n: np.zeros((2 * n, 3))[::2],
        lambda n: np.zeros((n, 3), order="F"),
        lambda n: np.zeros((n, 3), np.float32),
        lambda n: np.zeros((n, 3), ">f8"),
        lambda n: np.zeros((n + 1, 3)),
        lambda n: np.zeros(3 * n),
        lambda n: np.zeros((n, 3)).tolist(),
        lambda n: np.broadcast_to(np.zeros(3), (n, 3)),
    ],
)
def test_output_arrays_that_cannot_be_written_are_refused(out):
    mesh = shapes.box((2, 2, 2))
    mover = motet.Mover(mesh)
    still = np.zeros((len(mover.boundary), 3))
    for call in (mover.step, mover.advance):
        with pytest.raises(motet.InputError, match="contiguous"):
            call(still, out(mesh.n_points))


def test_the_native_module_refuses_shared_memory_and_other_types():
    """Without the checks of the package, such arrays raise an error instead of a panic."""
    mesh = shapes.box((2, 2, 2))
    native = motet.Mover(mesh)._mover
    memory = np.zeros((mesh.n_points, 3))
    k = len(native.boundary)
    for displacement, out in [(memory[:k], memory), (memory[:k].astype("f4"), memory.copy()), (memory[0], memory.copy()), (memory[:k].tolist(), memory.copy())]:
        with pytest.raises(motet.InputError):
            native.step(displacement, out)
    fixed = memory.copy()
    fixed.flags.writeable = False
    with pytest.raises(motet.InputError, match="writeable"):
        native.step(memory[:k], fixed)


def test_a_mesh_with_arrays_of_another_type_raises_an_error():
    mesh = shapes.box((1, 1, 1))
    mesh.connectivity = mesh.connectivity.astype(np.int64)
    with pytest.raises(motet.InputError, match="expected an array of uint32 and 1 axes, found an array of int64"):
        mesh.summary()
