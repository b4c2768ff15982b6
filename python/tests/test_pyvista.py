"""Methods of PyVista's data sets, and files that ``pyvista.read`` reads with motet."""
import numpy as np
import pytest

import motet
from motet import shapes

pyvista = pytest.importorskip("pyvista", minversion="0.48")

BOX = shapes.sphere_in_box(n=6, layers=4)


def grid():
    return BOX.to_pyvista()


def tets(data):
    return int((np.asarray(data.celltypes) == pyvista.CellType.TETRA).sum())


def surface(center=(0.0, 0.0, 0.0), radius=0.5):
    return pyvista.Icosphere(radius=radius, center=center, nsub=2)


# Calls of one line, each with what its result must be.
LINES = {
    "mesh": (lambda: surface().motet.mesh(size=0.15), lambda new: np.nanmin(new.motet.quality()) > 0.2),
    "mesh, then refine": (lambda: surface().motet.mesh(size=0.3).motet.refine(everything=True), lambda new: tets(new) > 8 * 100),
    "remesh": (lambda: grid().motet.remesh(goal="best"), lambda new: new.motet.report.after.bad == 0),
    "refine": (lambda: grid().motet.refine(ball=[((0, 0, 0), 1.2)]), lambda new: tets(new) > len(BOX.tets)),
    "move": (lambda: grid().motet.move(translate={"sphere": (0.3, 0, 0)}), lambda new: "displacement" in new.point_data),
    "implant": (
        lambda: shapes.box((8, 8, 8)).to_pyvista().motet.implant({"ball": surface((0.5, 0.5, 0.5), 0.2)}, inside="fill"),
        lambda new: "ball" in new.motet.to_mesh().region_names.values(),
    ),
    "contact": (lambda: surface().motet.contact(surface((1.25, 0, 0))), lambda new: new["gap"].min() == pytest.approx(0.25, abs=0.02)),
    "quality": (lambda: grid().motet.quality(), lambda new: len(new) == BOX.n_cells),
    "blocks": (lambda: grid().motet.blocks(), lambda new: {"sphere", "box"} <= set(new.keys())),
    "cap": (lambda: pyvista.Cylinder(capping=False).triangulate().motet.cap(), lambda new: new.motet.summary().surface.closed),
    "summary": (lambda: surface().motet.summary(), lambda new: new.surface.closed),
    "to_mesh": (lambda: grid().motet.to_mesh(), lambda new: isinstance(new, motet.Mesh)),
}


@pytest.mark.parametrize("name", LINES)
def test_one_line(name):
    call, is_right = LINES[name]
    assert is_right(call())


def test_the_result_is_that_of_the_function():
    options = {"ball": [((0, 0, 0), 1.2)], "threads": 1}
    data = grid()
    new, expected = data.motet.refine(**options), motet.refine(BOX, **options)
    assert np.array_equal(new.points, expected.mesh.points) and new.motet.report.steps[-1].quality == expected.report.steps[-1].quality
    assert motet.as_mesh(new).patch_names == BOX.patch_names
    assert data.n_cells == BOX.n_cells and data.motet.report is None


def test_what_a_call_reports_is_with_its_result():
    new = grid().motet.move(translate={"sphere": (0.3, 0, 0)})
    assert new.motet.report.fraction == 1.0 and new.motet.complete and new.motet.not_reached is None
    repaired = new.motet.remesh()
    array = np.arange(new.n_points, dtype=float)
    assert len(repaired.motet.history.transfer(array, on="points")) == repaired.n_points
    # PyVista copies arrays, not accessors.
    assert repaired.copy().motet.report is None


def test_a_multiblock_is_several_surfaces_by_name():
    both = pyvista.MultiBlock({"outer": surface(), "inner": pyvista.MultiBlock({"ball": surface(radius=0.2)}), "none": pyvista.PolyData()})
    filled = both.motet.mesh(size=0.2)
    assert {"outer", "inner/ball"} <= set(filled.motet.to_mesh().patch_names.values())
    measured = both.motet.contact()
    assert measured.motet.gaps.least == pytest.approx(0.3, abs=0.02)
    assert measured["inner/ball"]["gap"].max() < 0.32 and set(measured.keys()) == {"outer", "inner/ball"}
    with pytest.raises(motet.InputError, match="not a MultiBlock: choose one of outer"):
        both.motet.remesh()


def test_points_that_are_on_no_surface_have_no_gap():
    far = grid().motet.contact(surface((20.0, 0, 0)))
    on_boundary = np.isfinite(far["gap"])
    assert 0 < on_boundary.sum() < far.n_points and np.isnan(far["closest_point"][~on_boundary]).all()


def test_options_are_checked_as_in_the_functions():
    with pytest.raises(TypeError, match="did you mean 'size'"):
        surface().motet.mesh(sise=0.1)
    with pytest.raises(motet.OptionsError, match="two surfaces have the name 'this'"):
        surface().motet.contact({"this": surface((2, 0, 0))})
    assert "motet.remesh" in type(grid().motet).remesh.__doc__


@pytest.mark.parametrize("suffix", [".mesh", ".meshb", ".msh", ".node", ".su2", ".unv", ".vol", ".elem", ".bdf", ".cdb", ".med"])
def test_pyvista_reads_files_with_motet(suffix, tmp_path):
    path = tmp_path / f"box{suffix}"
    BOX.save(path)
    new, expected = pyvista.read(path), motet.read(path)
    assert tets(new) == len(expected.tets) and np.array_equal(new.points, expected.points)
    assert motet.as_mesh(new).patch_names == expected.patch_names


def test_pictures_have_what_they_show(tmp_path):
    moved = grid().motet.move(translate={"sphere": (2.6, 0, 0)})
    assert (moved.motet.quality() < 0.2).any()
    near = pyvista.MultiBlock({"wall": surface(), "ball": surface(radius=0.2)}).motet.contact()
    pictures = []
    for k, data in enumerate((moved, near, surface())):
        path = tmp_path / f"{k}.png"
        data.motet.plot(off_screen=True, screenshot=path, window_size=(300, 200))
        pictures.append(pyvista.read(path).active_scalars.reshape(200, 300, -1)[..., :3].astype(int))
    red = [((p[..., 0] > 150) & (p[..., 1] < 60) & (p[..., 2] < 60)).sum() for p in pictures]
    assert red[0] > 20 and red[1] == red[2] == 0
    assert all(len(np.unique(picture.reshape(-1, 3), axis=0)) > 50 for picture in pictures)
    with pytest.raises(motet.InputError, match="no gaps to show"):
        moved.motet.plot("gaps")
