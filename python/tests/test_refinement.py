"""Refinement by criteria and by marks, and coarsening."""
import numpy as np
import pytest

import motet
from motet import shapes


def test_refinement_at_a_device_can_be_undone():
    mesh, device = shapes.sphere_in_box(), shapes.coil((3.0, 0.0, 0.0))
    fine = motet.refine(mesh, near_size=[(device, 0.2, 0.5)])
    assert fine.complete and fine.mesh.n_points > mesh.n_points and fine.report.steps[0].step == "came"
    back = motet.refine(fine.mesh, coarsen=True)
    while any(name.startswith("refine_") for name in back.mesh.cell_data):
        back = motet.refine(back.mesh, coarsen=True)
    np.testing.assert_array_equal(back.mesh.points, mesh.points)
    np.testing.assert_array_equal(back.mesh.connectivity, mesh.connectivity)


def test_every_criterion_refines_the_mesh():
    mesh = shapes.box((4, 4, 4))
    x = mesh.points[:, 0]
    mesh.point_data["p"] = np.exp(8 * x)
    mesh.point_data["v"] = np.column_stack([-mesh.points[:, 1], x, 0 * x])
    calls = [
        dict(everything=True), dict(ball=[((0.5, 0.5, 0.5), 0.1)]), dict(box=[((0, 0, 0), (0.3, 0.3, 0.3))]), dict(region=["box"]),
        dict(patch=["xmin"]), dict(patch=[("xmin", 0.1)]), dict(size=0.3), dict(where=["p>100"]), dict(gradient=["p>100"]),
        dict(vorticity=["v>1"]), dict(jump={"p": 0.5}), dict(recovery={"p": 1000}), dict(hessian={"p": "5%"}), dict(hessian={("p", "v"): 3000}),
    ]  # fmt: skip
    counts = [motet.refine(mesh, generations=1, **call).mesh.n_cells for call in calls]
    assert min(counts) > mesh.n_cells and counts[0] == max(counts)
    assert len(set(counts)) > 8


def test_marked_tets_are_refined_and_coarsened():
    refinement = motet.Refinement(shapes.box((3, 3, 3)))
    first = refinement.mesh
    middle = first.points[first.tets].mean(axis=1)
    history, _ = refinement.refine(first.cell_ids("tetra")[np.linalg.norm(middle - 0.5, axis=1) < 0.2])
    assert refinement.mesh.n_cells > first.n_cells and refinement.generations.max() == 1
    cells = np.flatnonzero(refinement.generations == 1)
    refinement.coarsen(cells)
    np.testing.assert_array_equal(refinement.mesh.connectivity, first.connectivity)
    assert history.vertex_to_main.max() < first.n_points
    assert "refine_root" not in refinement.with_memory().cell_data


@pytest.mark.parametrize(
    "call, message",
    [
        (dict(), "no criterion is given"),
        (dict(where=["p<"]), "p<"),
        (dict(where=["none>3"]), "none"),
        (dict(where="p>3"), "expected a list"),
        (dict(ball=[((9, 9, 9), 0.1)]), "no tet is marked"),
        (dict(hessian={"p": "some"}), "some"),
        (dict(size=-1.0), "above 0"),
        (dict(vorticity=["v<3"]), "ARRAY>VALUE"),
    ],
)
def test_invalid_arguments_raise_an_error(call, message):
    mesh = shapes.box()
    mesh.point_data["p"] = mesh.points[:, 0].copy()
    with pytest.raises(ValueError) as error:
        motet.refine(mesh, **call)
    assert isinstance(error.value, motet.Error) and message in str(error.value)


def test_invalid_marks_raise_an_error():
    refinement = motet.Refinement(shapes.box())
    with pytest.raises(motet.InputError, match="marks"):
        refinement.refine(np.zeros(3, bool))
    with pytest.raises(motet.InputError, match="but the mesh has"):
        refinement.refine([10**6])
