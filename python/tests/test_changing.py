"""Repair, implantation and meshing, and histories that transfer arrays."""
import numpy as np
import pytest

import motet
from motet import shapes


def shaken(seed=1):
    """A box with randomly displaced interior vertices, so that some tets are bad."""
    mesh = shapes.box((6, 6, 6))
    inside = (np.abs(mesh.points - 0.5) < 0.49).all(axis=1)
    mesh.points[inside] += np.random.default_rng(seed).uniform(-0.05, 0.05, (inside.sum(), 3))
    mesh.point_data["linear"] = mesh.points @ [1.0, 2.0, 3.0]
    mesh.cell_data["volume"] = mesh.quality("volume")
    mesh.cell_data["id"] = np.arange(mesh.n_cells)
    return mesh


def test_repair_removes_bad_tets_and_keeps_the_others():
    mesh = shaken()
    done = motet.remesh(mesh)
    assert done.complete and done.report.before.bad > 0 == done.report.after.bad
    assert np.nanmin(done.mesh.quality()) >= 0.2 and done.report.after.quality.worst >= 0.2 > done.report.before.quality.worst
    old = done.history.cell_to_old
    kept = old >= 0
    np.testing.assert_array_equal(done.mesh.cell_data["id"][kept], old[kept])
    assert kept.mean() > 0.3
    stayed = done.history.vertex_to_old >= 0
    assert done.mesh.summary().volume == pytest.approx(1.0)
    np.testing.assert_allclose(done.mesh.point_data["linear"], done.mesh.points @ [1.0, 2.0, 3.0], atol=0.05)
    assert stayed.any()


def test_a_history_transfers_arrays_after_the_change():
    mesh = shaken()
    done = motet.remesh(mesh, carry={"id": "drop"})
    assert "id" not in done.mesh.cell_data
    later = done.history.transfer(mesh.point_data["linear"], on="points")
    np.testing.assert_array_equal(later, done.mesh.point_data["linear"])
    density = np.random.default_rng(2).uniform(1, 2, mesh.n_cells)
    new = done.history.transfer(density, on="cells")
    volume = lambda m: np.nan_to_num(m.quality("volume"))  # noqa: E731
    off = sum(region.deviation for region in done.history.ledger.regions)
    assert abs(new @ volume(done.mesh) - density @ volume(mesh)) <= density.max() * off + 1e-12 and off < 1e-4
    assert set(done.history.transfer(mesh.cell_data["id"], on="cells", rule="inherit")) <= set(mesh.cell_data["id"])
    exact = mesh.point_data["linear"]
    np.testing.assert_allclose(done.history.transfer(exact, on="points", rule="linear"), later, atol=1e-12)
    tensors = np.arange(9.0 * mesh.n_points).reshape(-1, 3, 3)
    assert done.history.transfer(tensors, on="points").shape == (done.mesh.n_points, 3, 3)
    again = motet.remesh(done.mesh, sizes=0.1)
    both = done.history.then(again.history)
    np.testing.assert_allclose(
        both.transfer(density, on="cells"), again.history.transfer(new, on="cells"), rtol=1e-12, atol=1e-12
    )
    with pytest.raises(motet.InputError):
        again.history.then(done.history)
    with pytest.raises(motet.InputError, match="rows|values"):
        done.history.transfer(np.zeros(3), on="cells")


def test_remeshing_reaches_requested_edge_lengths():
    mesh = shapes.box((4, 4, 4))
    fine = motet.remesh(mesh, sizes=0.12, surface="adapt")
    assert fine.mesh.n_points > 3 * mesh.n_points
    mesh.point_data["h"] = np.full(mesh.n_points, 0.12)
    np.testing.assert_array_equal(motet.remesh(mesh, sizes="h", surface="adapt").mesh.points, fine.mesh.points)


def test_implanting_a_device_gives_a_conforming_mesh():
    host, device = shapes.box((8, 8, 8), (-2, -2, -2), (2, 2, 2)), shapes.coil()
    done = motet.implant(host, {"coil": device})
    assert done.complete and "coil" in done.mesh.region_names.values() and "coil" in done.mesh.patch_names.values()
    summary = done.mesh.summary()
    assert summary.conforming and summary.inverted == 0
    assert summary.volume == pytest.approx(64.0)
    assert done.report.quality == [host.summary().quality.distribution, summary.quality.distribution]
    assert summary.regions["coil"].volume == pytest.approx(device.summary().volume or motet.mesh(device).mesh.summary().volume)
    hollow = motet.implant(host, [device, motet.shapes.coil((0, 0, -1.2))], inside="hollow")
    assert {"device", "device_2"} <= set(hollow.mesh.patch_names.values())
    assert hollow.mesh.summary().volume < 64.0


def test_closed_surfaces_are_filled_with_tets():
    done = motet.mesh(shapes.aneurysm(), size="auto", layers=(3, 0.02, 1.2))
    assert done.complete and done.history is None and done.report.layers.prisms > 0
    summary = done.mesh.summary()
    assert set(summary.patches) == {"wall", "inlet", "outlet"} and summary.quality.eas.min > 0
    assert done.report.quality.p1 == summary.quality.distribution.p1 and done.report.quality.mean > done.report.quality.p5
    plain = motet.mesh(shapes.stent())
    assert plain.mesh.n_points >= shapes.stent().n_points and plain.report.triangles_kept == plain.report.triangles


def test_seeds_name_regions_and_holes_are_left_empty():
    outer, inner = shapes.ball(), shapes.ball()
    inner.points = inner.points * 0.5
    surfaces = {"outer": outer, "inner": inner}
    surfaces = {name: motet.Mesh(mesh.points, {"triangle": mesh.triangles}) for name, mesh in surfaces.items()}
    both = motet.mesh(surfaces, size=0.3, seeds={"core": (0, 0, 0), "shell": (0.75, 0, 0)})
    assert set(both.mesh.summary().regions) == {"core", "shell"}
    shell = motet.mesh(surfaces, size=0.3, holes=[(0, 0, 0)])
    assert shell.mesh.summary().volume == pytest.approx(both.mesh.summary().regions["shell"].volume)


def test_membranes_may_have_names_and_be_one():
    ball = shapes.ball()
    ball = motet.Mesh(ball.points, {"triangle": ball.triangles})
    flap = motet.Mesh([[-0.2, -0.2, 0], [0.2, -0.2, 0], [0.2, 0.2, 0], [-0.2, 0.2, 0]], [[0, 1, 2], [0, 2, 3]])
    for membranes, name in (({"flap": flap}, "flap"), ([flap], "membrane"), (flap, "membrane")):
        mesh = motet.mesh({"wall": ball}, membranes=membranes, size=0.3).mesh
        assert set(mesh.patch_names.values()) == {"wall", name}
    assert mesh.summary().volume == pytest.approx(motet.mesh(ball).mesh.summary().volume)


@pytest.mark.parametrize(
    "call, message",
    [
        (lambda: motet.remesh(shaken(), goal="x"), "repair, best"),
        (lambda: motet.remesh(shaken(), sizes="h"), "`h`"),
        (lambda: motet.remesh(shaken(), carry={"none": "drop"}), "none"),
        (lambda: motet.remesh(shapes.aneurysm()), "tet"),
        (lambda: motet.implant(shapes.box(), []), "no device"),
        (lambda: motet.implant(shapes.box(), shapes.coil(centre=(50, 0, 0))), "outside"),
        (lambda: motet.implant(shapes.box(), shapes.coil(), growth=-1.0), "grow"),
        (lambda: motet.mesh(shapes.aneurysm(), size="small"), "auto; got `small`"),
        (lambda: motet.mesh(motet.Mesh(np.eye(3), [[0, 1, 2]])), "edge"),
        (lambda: motet.mesh(shapes.aneurysm(), layers={"door": (3, 0.1, 1.2)}), "door"),
    ],
)
def test_invalid_arguments_raise_an_error(call, message):
    with pytest.raises(ValueError) as error:
        call()
    assert isinstance(error.value, motet.Error) and message in str(error.value)
