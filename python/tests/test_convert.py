"""Lossless conversion from and to meshes of meshio and PyVista."""
import numpy as np
import pytest
from test_mesh import ALL, same

import motet
from motet import shapes

meshio = pytest.importorskip("meshio")
pyvista = pytest.importorskip("pyvista")


@pytest.mark.parametrize("shape", ALL)
def test_conversion_and_back_preserves_a_mesh(shape):
    mesh = shape()
    mesh.point_data["x"] = mesh.points[:, 0].copy()
    mesh.cell_data["eas"] = mesh.quality()
    same(mesh, motet.Mesh.from_pyvista(mesh.to_pyvista()))
    if shape is shapes.braid:  # meshio has no polylines
        with pytest.raises(motet.InputError, match="poly_line cannot be converted to meshio"):
            mesh.to_meshio()
    else:
        same(mesh, motet.Mesh.from_meshio(mesh.to_meshio()))


def test_volumes_agree_with_vtk():
    grid = shapes.mixed().to_pyvista()
    volume = grid.compute_cell_sizes(length=False, area=False)["Volume"].sum()
    assert motet.as_mesh(grid).summary().volume == pytest.approx(volume)


def test_functions_accept_meshes_paths_meshio_and_pyvista(tmp_path):
    path = tmp_path / "box.vtu"
    mesh = shapes.box()
    mesh.save(path)
    meshes = [mesh, path, str(path), mesh.to_meshio(), mesh.to_pyvista()]
    assert len({motet.as_mesh(one).summary().points for one in meshes}) == 1
    surface = pyvista.Sphere()
    assert motet.as_mesh(surface).summary().surface.closed
    flat = meshio.Mesh([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], [("triangle", [[0, 1, 2]])])
    assert motet.as_mesh(flat).points.shape == (3, 3)


def test_single_precision_points_of_pyvista_become_double():
    assert pyvista.Sphere().points.dtype == np.float32
    assert motet.as_mesh(pyvista.Sphere()).points.dtype == np.float64


def test_polyhedra_are_converted_from_pyvista_and_saved(tmp_path):
    corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]], float)
    faces = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]]
    stream = [6] + [v for face in faces for v in [4, *face]]
    grid = pyvista.UnstructuredGrid(np.array([len(stream), *stream]), [42], corners)
    mesh = motet.Mesh.from_pyvista(grid)
    assert mesh.summary().volume == pytest.approx(1.0)
    mesh.save(tmp_path / "cube.vtu")
    same(mesh, motet.read(tmp_path / "cube.vtu"))
    with pytest.raises(motet.InputError, match="polyhedra"):
        mesh.to_pyvista()


def test_the_readme_contains_the_example():
    from pathlib import Path

    folder = Path(__file__).parents[1]
    assert (folder / "examples" / "story.py").read_text() in (folder / "README.md").read_text()


def test_the_example_runs(monkeypatch, capsys):
    from pathlib import Path

    monkeypatch.setattr(pyvista.UnstructuredGrid, "plot", lambda grid, **options: grid["eas"])
    exec((Path(__file__).parents[1] / "examples" / "story.py").read_text(), {})
    assert "0 after the repair" in capsys.readouterr().out


def test_trimesh_surfaces_are_filled_and_come_back():
    trimesh = pytest.importorskip("trimesh")
    ball = trimesh.creation.icosphere(subdivisions=2, radius=0.5)
    ball.vertex_attributes["height"] = ball.vertices[:, 2].copy()
    ball.face_attributes["patch"] = 1 + np.arange(len(ball.faces)) % 2
    surface = motet.as_mesh(ball)
    assert np.array_equal(surface.points, ball.vertices) and np.array_equal(surface.triangles, ball.faces)
    assert np.array_equal(surface.point_data["height"], ball.vertices[:, 2])
    filled = motet.mesh(ball, size=0.2).mesh
    back = filled.to_trimesh()
    assert back.is_watertight and back.volume == pytest.approx(ball.volume)
    assert np.bincount(back.face_attributes["patch"]).tolist() == [0, 160, 160]
    assert back.volume == pytest.approx(filled.summary().volume)
