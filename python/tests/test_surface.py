"""Surfaces with even triangles: distances, rims, patches and arrays."""
import numpy as np
import pytest

import motet
from motet import shapes


def open_vessel():
    """The wall and the outlet of an aneurysm, open at the inlet."""
    whole = shapes.aneurysm()
    inlet = next(label for label, name in whole.patch_names.items() if name == "inlet")
    patch = whole.cell_data["patch"][whole.cell_ids("triangle")]
    vessel = motet.Mesh(whole.points, whole.triangles[patch != inlet], cell_data={"patch": patch[patch != inlet]}, patch_names=whole.patch_names)
    vessel.point_data["height"] = whole.points @ [1.0, 2.0, 3.0]
    vessel.point_data["velocity"] = whole.points[:, ::-1].copy()
    return vessel


def disk(n=40):
    """A flat ring of narrow triangles, with a linear field."""
    angles = np.linspace(0, 2 * np.pi, n, endpoint=False)
    circle = np.column_stack([np.cos(angles), np.sin(angles), np.zeros(n)])
    inner, outer = np.arange(n), np.arange(n) + n
    triangles = np.concatenate([np.column_stack([inner, outer, np.roll(outer, -1)]), np.column_stack([inner, np.roll(outer, -1), np.roll(inner, -1)])])
    points = np.concatenate([circle, 3 * circle])
    return motet.Mesh(points, triangles, point_data={"f": 1.0 + points @ [2.0, -1.0, 0.0]})


def test_an_open_vessel_keeps_its_rims_patches_and_arrays():
    vessel = open_vessel()
    done = motet.surface(vessel, size=0.25, distance=0.01)
    report = done.report
    assert done.complete and max(report.to_given, report.from_given) <= report.allowed == 0.01
    assert report.before.rims == report.after.rims == 1
    assert report.after.angles.worst > 20 and report.after.crossings == 0
    assert done.mesh.patch_names == vessel.patch_names
    assert set(done.mesh.cell_data["patch"]) == set(vessel.cell_data["patch"])
    np.testing.assert_allclose(done.mesh.point_data["height"], done.mesh.points @ [1.0, 2.0, 3.0], atol=0.1)
    assert done.mesh.point_data["velocity"].shape == (done.mesh.n_points, 3)
    carried = done.history.transfer(vessel.point_data["height"], on="points")
    np.testing.assert_array_equal(carried, done.mesh.point_data["height"])


def test_a_linear_field_on_a_plane_is_exact():
    done = motet.surface(disk(), size=0.3)
    assert done.report.after.rims == 2 and done.report.after.volume is None
    assert done.report.after.angles.worst > 20 > done.report.before.angles.worst
    np.testing.assert_allclose(done.mesh.point_data["f"], 1.0 + done.mesh.points @ [2.0, -1.0, 0.0], rtol=1e-12)
    assert (done.mesh.points[:, 2] == 0).all()


def test_a_volume_mesh_gives_its_surface():
    box = shapes.box((3, 3, 3))
    done = motet.surface(box, size=0.2)
    assert done.report.after.volume == pytest.approx(1.0) and done.mesh.patch_names == box.patch_names
    assert len(done.mesh.tets) == 0 and done.report.left_out == len(box.tets)


def test_smoothing_is_reported():
    done = motet.surface(disk(), smooth=3)
    assert done.report.smoothed.passes == 3 and done.report.smoothed.to_given < 1e-12


@pytest.mark.parametrize(
    "options, message",
    [({"size": -1.0}, "size"), ({"size": "large"}, "auto"), ({"distance": -1.0}, "distance"), ({"size_array": "h"}, "no array `h`"), ({"feature_angle": 200.0}, "angle")],
)
def test_options_out_of_range_raise_an_error(options, message):
    with pytest.raises(motet.Error, match=message):
        motet.surface(disk(), **options)


def test_meshes_without_a_surface_raise_an_error():
    with pytest.raises(motet.InputError, match="no surface"):
        motet.surface(motet.Mesh(np.zeros((2, 3)), [("line", np.array([[0, 1]]))]))


def test_data_sets_of_pyvista_have_it_as_a_method():
    pyvista = pytest.importorskip("pyvista")
    tube = pyvista.Cylinder(radius=1, height=4, resolution=40, capping=False).triangulate()
    even = tube.motet.surface(size=0.3, distance=0.02)
    assert even.motet.complete and even.motet.report.after.rims == 2
    assert "Give a surface even triangles" in type(even.motet).surface.__doc__


def test_ends_are_cut_off():
    vessel = shapes.tube(radius=1.0, length=4.0)
    done = motet.surface(vessel, clip=[(0, 0, 3.1, 0, 0, 1), (0, 0, 0, 0.5)])
    assert [cut.divided > 0 for cut in done.report.cuts] == [True, True]
    assert done.mesh.points[:, 2].max() == pytest.approx(3.1) and done.report.after.rims == 2
    with pytest.raises(motet.OptionsError, match="6 numbers"):
        motet.surface(vessel, clip=[(1, 2, 3)])
    with pytest.raises(motet.InputError, match="does not meet"):
        motet.surface(vessel, clip=[(0, 0, 9, 0, 0, 1)])


def test_wires_become_one_closed_surface():
    braid = shapes.braid(0.6, length=1.0, wires=4, pitch=3.0, wire_radius=0.05)
    made = motet.surface(braid, tubes="radius")
    wires = made.report["wires"]
    assert made.history is None and made.complete
    assert made.report["after"]["crossings"] == made.report["after"]["open_edges"] == 0
    assert (wires["chains"], wires["branching_edges"], wires["bodies"]) == (4, 0, 1)
    assert abs(wires["volume"] / wires["wire_volume"] - 1) < 0.1
    same = motet.surface(braid, tubes=0.05)
    assert np.array_equal(same.mesh.points, made.mesh.points)


def test_wires_of_two_texts_and_wrong_calls(tmp_path):
    (tmp_path / "positions.txt").write_text("0 0 0\n1 0 0\n2 0 1\n")
    (tmp_path / "segments.txt").write_text("1 2\n2 3\n")
    made = motet.surface(tmp_path / "positions.txt", segments=tmp_path / "segments.txt", tubes=0.1, sides=12)
    assert made.report["wires"]["sides"] == 12 and made.report["wires"]["segments"] == 2
    with pytest.raises(motet.OptionsError, match="tubes"):
        motet.surface(shapes.braid(), sides=8)
    with pytest.raises(motet.InputError, match="no array `r`"):
        motet.surface(shapes.braid(), tubes="r")
    with pytest.raises(motet.InputError, match="no line cells"):
        motet.surface(shapes.aneurysm(), tubes=0.1)


def test_a_torn_surface_is_wrapped():
    vessel = shapes.aneurysm()
    triangles = vessel.triangles
    corners = vessel.points[triangles].reshape(-1, 3)  # no triangle shares a vertex with another
    kept = np.arange(len(triangles)) % 12 != 0
    torn = motet.Mesh(corners, np.arange(len(corners)).reshape(-1, 3)[kept])
    volume = np.linalg.det(vessel.points[triangles]).sum() / 6
    made = motet.surface(torn, size=0.3, wrap=0.02)
    assert made.report.after.rims == made.report.after.crossings == 0
    assert made.report.after.volume == pytest.approx(volume, rel=0.03)
    filled = motet.mesh(torn, size=0.3, surface="adapt", wrap=0.02)
    assert filled.complete
    for wrong in ({"wrap": 0.0}, {"wrap": 0.02, "unite": True}):
        with pytest.raises(motet.errors.OptionsError):
            motet.mesh(torn, **wrong)
