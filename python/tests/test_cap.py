"""Closing open rims with caps."""
import numpy as np
import pytest

import motet
from motet import shapes


def open_vessel():
    whole = shapes.aneurysm()
    patch = whole.cell_data["patch"]
    wall = next(label for label, name in whole.patch_names.items() if name == "wall")
    return motet.Mesh(whole.points, whole.triangles[patch == wall])


def test_an_open_vessel_is_closed():
    vessel = open_vessel()
    closed = motet.cap(vessel)
    assert closed.summary().surface.closed and not vessel.summary().surface.closed
    assert list(closed.patch_names.values()) == ["wall", "cap_1", "cap_2"]
    np.testing.assert_array_equal(closed.points[: vessel.n_points], vessel.points)
    assert motet.mesh(closed).complete


def test_all_frames_have_the_same_triangles(tmp_path):
    vessel = open_vessel()
    moved = [vessel.points * s for s in (1.1, 1.2)]
    closed = motet.cap([vessel, moved[0], motet.Mesh(moved[1], vessel.triangles)])
    for frame, scale in zip(closed, (1.0, 1.1, 1.2)):
        np.testing.assert_array_equal(frame.connectivity, closed[0].connectivity)
        np.testing.assert_allclose(frame.points, scale * closed[0].points, rtol=1e-12, atol=1e-14)
    with motet.SeriesWriter(tmp_path / "wall.pvd") as writer:
        for time, points in zip((0.0, 0.5), (vessel.points, moved[0])):
            writer.add(time, motet.Mesh(points, vessel.triangles))
    series = motet.cap(tmp_path / "wall.pvd")
    assert [time for time, _ in series] == [0.0, 0.5]
    for (_, frame), same in zip(series, closed):
        np.testing.assert_array_equal(frame.points, same.points)


@pytest.mark.parametrize(
    "given, message",
    [
        (lambda: shapes.aneurysm(), "no open rim"),
        (lambda: [], "no frames"),
        (lambda: [open_vessel().points], "triangles"),
        (lambda: [open_vessel(), open_vessel().points[1:]], "points"),
        (lambda: [open_vessel(), shapes.aneurysm(around=12)], "points"),
    ],
)
def test_surfaces_that_cannot_be_capped_raise_an_error(given, message):
    with pytest.raises(motet.InputError, match=message):
        motet.cap(given())


def test_ends_are_named_and_extended():
    vessel = open_vessel()
    long = motet.cap(vessel, inlet="largest", extend={"inlet": 3.0, "outlet": 2.0})
    assert sorted(long.patch_names.values()) == ["inlet", "outlet", "wall"]
    plain = motet.cap(vessel)
    volumes = [motet.mesh(mesh).mesh.summary().volume for mesh in (plain, long)]
    assert volumes[1] > volumes[0] + 4.0
    np.testing.assert_array_equal(long.points[: vessel.n_points], vessel.points)
    outlet = long.points[long.triangles[long.cell_data["patch"] == next(k for k, v in long.patch_names.items() if v == "outlet")]].mean((0, 1))
    turned = motet.cap(vessel, inlet=outlet, extend=1.0)
    assert sorted(turned.patch_names.values()) == ["inlet", "outlet", "wall"]
    with pytest.raises(motet.OptionsError, match="no open end `x`"):
        motet.cap(vessel, extend={"x": 1.0})
    with pytest.raises(motet.InputError, match="three numbers"):
        motet.cap(vessel, inlet=[1.0, 2.0])
