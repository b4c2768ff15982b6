"""Solid walls around vessels: volumes, names, arrays, and what is refused."""
import numpy as np
import pytest

import motet
from motet import shapes


def test_a_tube_gets_a_wall_with_names():
    lumen = shapes.tube(radius=1.0, length=4.0)
    lumen.point_data["height"] = lumen.points[:, 2].copy()
    done = motet.wall(lumen, thickness=0.2, layers=2)
    assert done.complete and done.report.ends == ["wall_inlet", "wall_outlet"] and done.report.outer == "outer"
    np.testing.assert_array_equal(done.mesh.points[: lumen.n_points], lumen.points)
    np.testing.assert_allclose(done.mesh.point_data["height"], done.mesh.points[:, 2], atol=1e-9)
    shell = np.pi * 4.0 * (1.2**2 - 1.0)
    assert done.report.layers.volume == pytest.approx(shell, rel=0.05)
    assert done.mesh.region_names[done.report.region] == "wall"
    assert len(done.mesh.tets) == len(lumen.tets) + done.report.layers.tets
    assert motet.as_mesh(done.mesh).summary().defects == []


def test_thickness_by_array_and_by_values():
    lumen = shapes.tube()
    values = 0.1 + 0.02 * lumen.points[:, 2]
    lumen.point_data["t"] = values
    by_name, by_values = motet.wall(lumen, thickness="t"), motet.wall(lumen, thickness=values)
    np.testing.assert_array_equal(by_name.mesh.points, by_values.mesh.points)
    assert by_name.report.layers.thickness[0] < by_name.report.layers.thickness[2]
    with pytest.raises(motet.OptionsError, match="values for"):
        motet.wall(lumen, thickness=values[:-1])


def test_a_surface_gets_the_wall_alone():
    vessel = shapes.aneurysm()
    done = motet.wall(vessel, of_radius=0.2, layers=2, keep_prisms=True)
    assert done.complete and set(done.mesh.region_names.values()) == {"wall"}
    assert done.report.interface == (vessel.cell_data["patch"] == 1).sum()


def test_what_is_refused():
    with pytest.raises(motet.OptionsError, match="no thickness"):
        motet.wall(shapes.tube())
    with pytest.raises(motet.OptionsError, match="twice"):
        motet.wall(shapes.tube(), thickness=0.1, of_radius=0.1)
    with pytest.raises(motet.OptionsError, match="no patch"):
        motet.wall(shapes.tube(), thickness=0.1, on=["x"])
    with pytest.raises(motet.InputError, match="no array"):
        motet.wall(shapes.tube(), thickness="t")
