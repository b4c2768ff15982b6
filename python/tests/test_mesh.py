"""Meshes: creation from arrays, copies, summaries, and files."""
import numpy as np
import pytest

import motet
from motet import shapes

ALL = [shapes.sphere_in_box, shapes.box, shapes.ball, shapes.mixed, shapes.tube, shapes.aneurysm, shapes.stent, shapes.braid, shapes.coil]


def same(a, b):
    for name in ("points", "kinds", "offsets", "connectivity", "faces"):
        np.testing.assert_array_equal(getattr(a, name), getattr(b, name), err_msg=name)
    for name in ("point_data", "cell_data"):
        assert getattr(a, name).keys() == getattr(b, name).keys()
        for array, values in getattr(a, name).items():
            np.testing.assert_array_equal(values, getattr(b, name)[array], err_msg=array)


@pytest.mark.parametrize("shape", ALL)
def test_writing_and_reading_preserves_a_mesh(shape, tmp_path):
    mesh = shape()
    mesh.point_data["vectors"] = mesh.points * 2
    mesh.point_data["tensors"] = np.arange(9.0 * mesh.n_points).reshape(-1, 3, 3)
    assert mesh.save(tmp_path / "mesh.vtu") == []
    back = motet.read(tmp_path / "mesh.vtu")
    assert back.point_data["tensors"].shape == (mesh.n_points, 9)
    mesh.point_data["tensors"] = mesh.point_data["tensors"].reshape(-1, 9)
    same(mesh, back)
    assert back.patch_names == mesh.patch_names and back.region_names == mesh.region_names


def test_a_mesh_is_created_from_lists():
    points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    mesh = motet.Mesh(points, [[0, 1, 2, 3]])
    assert mesh.points.dtype == np.float64 and mesh.tets.dtype == np.uint32
    assert mesh.summary().volume == pytest.approx(1 / 6)
    assert mesh.quality("volume") == pytest.approx(1 / 6)
    both = motet.Mesh(points, {"tetra": [[0, 1, 2, 3]], "triangle": [[0, 2, 1]]}, cell_data={"patch": [0, 7]}, patch_names={7: "floor"})
    assert both.tets.tolist() == [[0, 1, 2, 3]] and both.triangles.tolist() == [[0, 2, 1]]
    assert both.cell_ids("triangle").tolist() == [1]
    assert both.patch_vertices("floor").tolist() == [0, 1, 2] == both.patch_vertices(7).tolist()
    assert np.isnan(both.quality()[1])


def test_arrays_keep_their_number_types_in_files(tmp_path):
    mesh = shapes.box((1, 1, 1))
    for kind in "i1 u1 i2 u2 i4 u4 i8 u8 f4 f8".split():
        mesh.point_data[kind] = np.arange(mesh.n_points).astype(kind)
    mesh.save(tmp_path / "mesh.vtu")
    back = motet.read(tmp_path / "mesh.vtu")
    assert all(back.point_data[kind].dtype == np.dtype(kind) for kind in mesh.point_data)


def test_a_copy_shares_nothing():
    mesh = shapes.box()
    copy = mesh.copy()
    copy.points += 1
    copy.cell_data["region"][:] = 9
    assert mesh.points.max() == 1 and mesh.cell_data["region"].max() == 1


def test_non_contiguous_arrays_are_accepted():
    mesh = shapes.box()
    reversed_rows = motet.Mesh(mesh.points[:, ::-1], mesh.tets[::-1].astype(np.int64), point_data={"x": mesh.points[:, 0]})
    assert reversed_rows.summary().cells == {"tetra": len(mesh.tets)}


@pytest.mark.parametrize(
    "make, message",
    [
        (lambda: motet.Mesh([[0, 0]], [[0, 1, 2, 3]]), "(n, 3)"),
        (lambda: motet.Mesh(np.eye(3), [[0, 1, 2, -1]]), "0 or more"),
        (lambda: motet.Mesh(np.eye(3), [[0.5, 1, 2, 3]]), "integers"),
        (lambda: motet.Mesh(np.eye(3), {"cube": [[0]]}), "'cube'"),
        (lambda: motet.Mesh(np.eye(3), [[0, 1, 2, 3]]).summary(), "refers to point 3"),
        (lambda: motet.Mesh(np.eye(3), {"tetra": [[0, 1, 2]]}).summary(), "4 vertices"),
        (lambda: motet.Mesh(np.eye(3), [[0, 1, 2]], point_data={"p": [1.0]}).summary(), "point array p"),
        (lambda: shapes.box().quality("beauty"), "mean_ratio"),
        (lambda: motet.remesh(42), "int is not a mesh"),
    ],
)
def test_invalid_meshes_raise_an_error(make, message):
    with pytest.raises((motet.InputError, motet.OptionsError)) as error:
        make()
    assert message in str(error.value) and isinstance(error.value, ValueError)


def test_errors_name_files_that_cannot_be_read(tmp_path):
    with pytest.raises(motet.FileError) as error:
        motet.read(tmp_path / "none.vtu")
    assert isinstance(error.value, OSError) and error.value.file == tmp_path / "none.vtu"
    (tmp_path / "bad.vtu").write_text("<VTKFile>")
    with pytest.raises(motet.InputError) as error:
        motet.read(tmp_path / "bad.vtu")
    assert error.value.file == tmp_path / "bad.vtu" and error.value.what
    with pytest.raises(motet.Error, match=r"\.vtu"):
        shapes.box().save(tmp_path / "mesh.unknown")


def test_save_returns_what_a_format_cannot_store(tmp_path):
    mesh = shapes.aneurysm()
    mesh.point_data["p"] = np.zeros(mesh.n_points)
    assert any("p" in sentence for sentence in mesh.save(tmp_path / "mesh.stl"))
    assert ".vtu" in motet.formats()


def test_reports_have_attributes_and_are_shown_as_tables():
    summary = shapes.box().summary()
    assert summary.quality.eas.bad == summary["quality"]["eas"]["bad"] == 0
    assert "<table>" in summary._repr_html_() and "eas" in repr(summary)
    with pytest.raises(AttributeError, match="it has points"):
        summary.beauty
