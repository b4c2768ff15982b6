"""Contact: gaps, warnings and predicted contacts."""
import numpy as np
import pytest

import motet
from motet import shapes


def balls(apart):
    first, second = shapes.ball(), shapes.ball()
    second.points = second.points + [apart, 0.0, 0.0]
    return {"first": first, "second": second}


def test_gaps_agree_with_brute_force():
    contact = motet.Contact(balls(2.5), warn=0.6)
    gaps = contact.measure()
    assert gaps.least == pytest.approx(0.5) and gaps.pairs[0].bodies == ["first", "second"] and gaps.warnings
    body = gaps.bodies["first"]
    at = contact.points[body.vertices]
    np.testing.assert_allclose(np.linalg.norm(body.closest_point - at, axis=1), body.gap, atol=1e-12)
    others = contact.points[gaps.bodies["second"].vertices]
    to_vertices = np.linalg.norm(at[:, None] - others[None], axis=2).min(axis=1)
    assert (body.gap <= to_vertices + 1e-12).all()
    assert (body.closest_body == 1).all() and body.warning.any()


def test_contact_of_moving_points_is_predicted():
    contact = motet.Contact(balls(2.5))
    velocity = np.zeros_like(contact.points)
    velocity[len(contact.points) // 2 :, 0] = -1.0
    ahead = contact.look_ahead(velocity)
    assert ahead.first.time == pytest.approx(0.5) and ahead.times["first"].min() == pytest.approx(0.5)
    same = contact.look_ahead_to(contact.points + velocity, 1.0)
    assert same.first.time == pytest.approx(0.5)
    contact.refit(contact.points + 0.6 * velocity)
    assert contact.measure().least == 0.0 and contact.measure().pairs[0].crossings > 0
    assert motet.Contact(balls(2.5)).look_ahead(velocity, horizon=0.1).first is None


def test_patches_of_one_mesh_are_measured_in_a_room():
    mesh = shapes.sphere_in_box()
    gaps = motet.Contact(mesh, patches=["sphere", "box"], room=["box"]).measure()
    assert gaps.least == pytest.approx(4.0) and (gaps.bodies["sphere"].gap > 0).all()


def test_rooms_are_detected_and_can_be_specified():
    inner, outer = shapes.ball(), shapes.ball()
    outer.points = 3 * outer.points
    both = {"inner": inner, "outer": outer}
    contact = motet.Contact(both, warn=0.5)
    within = contact.rooms[0]
    assert (within.room, within.surface, within.share, len(contact.rooms)) == ("outer", "inner", 1.0, 1)
    assert (contact.measure().bodies["inner"].gap > 0).all() and not contact.measure().warnings
    assert motet.Contact(both, room=["outer"]).rooms[0].share is None
    solid = motet.Contact(both, room=(), warn=0.5)
    assert solid.rooms == [] and (solid.measure().bodies["inner"].gap < 0).all()


def test_unconnected_triangles_of_a_closed_surface_form_a_room():
    ball = shapes.ball()
    facets = np.concatenate([ball.tets[:, f] for f in ([1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1])])
    _, first, count = np.unique(np.sort(facets, 1), axis=0, return_index=True, return_counts=True)
    facets = facets[first[count == 1]].astype(int)
    soup = motet.Mesh(3 * ball.points[facets].reshape(-1, 3), np.arange(facets.size).reshape(-1, 3))
    contact = motet.Contact({"inner": shapes.ball(), "outer": soup})
    assert contact.rooms[0].room == "outer" and (contact.measure().bodies["inner"].gap > 0).all()


def test_a_surface_is_measured_against_itself():
    gaps = motet.Contact(shapes.coil(pitch=0.3, wire_radius=0.08), own=True, within=0.5).measure()
    assert 0.1 < gaps.least < 0.16


@pytest.mark.parametrize(
    "call, message",
    [
        (lambda: motet.Contact(balls(3.0), room=["third"]), "first, second"),
        (lambda: motet.Contact(shapes.sphere_in_box(), patches=["door"]), "sphere, box"),
        (lambda: motet.Contact(balls(3.0)).refit(np.zeros((3, 3))), "points"),
        (lambda: motet.Contact(balls(3.0)).look_ahead(np.zeros((3, 3))), "velocit"),
    ],
)
def test_invalid_arguments_raise_an_error(call, message):
    with pytest.raises(ValueError) as error:
        call()
    assert isinstance(error.value, motet.Error) and message in str(error.value)


@pytest.mark.parametrize("x", [-1.0, -0.9])
def test_a_vessel_is_the_room_of_a_flap_whether_it_is_attached_or_not(x):
    tube = shapes.tube(n=4, slices=15)
    wall = [i for i in tube.patch_vertices("wall") if abs(tube.points[i, 0] + 1) < 1e-9 and 1 < tube.points[i, 2] < 4]
    low, high = sorted(tube.points[wall, 2])[:2]
    flap = motet.Mesh([(x, 0, low), (x, 0, high), (0.2, 0, low)], [(0, 1, 2)])
    mesh = motet.mesh(motet.Mesh(tube.points, tube.triangles), membranes=[flap], size="auto").mesh
    contact = motet.Contact(mesh, patches=["membrane", "surface"])
    assert [room.room for room in contact.rooms] == ["surface"]
    assert 0.0 < contact.measure().least < 1.2
