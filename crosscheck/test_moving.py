"""Moving walls and volumes, exchanged between motet and PyVista."""
import numpy as np
import pytest

pv = pytest.importorskip("pyvista")

import moving_walls  # noqa: E402

AFFINE = np.array([[1.1, 0.05, -0.02, 0.3], [0.03, 0.9, 0.04, -0.2], [-0.01, 0.02, 1.05, 0.1]])


def image(points, part):
    moved = np.asarray(points) @ AFFINE[:, :3].T + AFFINE[:, 3]
    return points + part * (moved - points)


def test_pyvista_reads_a_series_with_the_reported_quality(sphere):
    folder, report = sphere
    reader = pv.get_reader(folder / "moved.pvd")
    assert list(reader.time_values) == [step["time"] for step in report["steps"]]
    before = pv.read(folder / "box.vtu")
    for step, time in zip(report["steps"], reader.time_values):
        reader.set_active_time_value(time)
        mesh = reader.read()[0]
        assert np.array_equal(mesh.cells, before.cells)
        assert np.allclose(mesh.points - mesh["displacement"], before.points, rtol=0, atol=1e-14)
        eas = mesh["eas"][mesh.celltypes == pv.CellType.TETRA]
        assert np.isclose(eas.min(), step["worst_eas"]["value"], rtol=1e-12)
        assert (eas < 0.2).sum() == step["bad"]
        assert (eas <= 0).sum() == step["inverted"] == 0


@pytest.mark.parametrize("keep_ids", [True, False])
def test_a_surface_extracted_and_displaced_by_pyvista_moves_the_mesh(motet, sphere, tmp_path, keep_ids):
    source = sphere[0] / "box.vtu"
    mesh = pv.read(source)
    mesh = mesh.extract_cells(mesh.celltypes == pv.CellType.TETRA)
    mesh.clear_data()
    mesh.save(tmp_path / "tets.vtu")
    wall = mesh.extract_surface(pass_pointid=keep_ids, algorithm="dataset_surface")
    assert ("vtkOriginalPointIds" in wall.point_data) == keep_ids
    still = np.array(wall.points)
    moving_walls.write_series(tmp_path / "wall.pvd", wall, range(4), lambda k: image(still, k / 3) - still)
    report = motet.json("move", tmp_path / "tets.vtu", "-o", tmp_path / "out.pvd",
                        "--displacement", tmp_path / "wall.pvd", "--dt", 0.5)
    assert report["complete"] and [step["time"] for step in report["steps"]] == [0, 0.5, 1, 1.5]
    for k, (_, moved) in enumerate(moving_walls.frames(tmp_path / "out.pvd")):
        assert np.abs(moved.points - image(mesh.points, k / 3)).max() < 1e-13
    assert np.allclose(moved["velocity"], (image(mesh.points, 1) - image(mesh.points, 2 / 3)) / 0.5, rtol=0, atol=1e-12)


def dihedral_angles(p):
    """Return the six dihedral angles, in degrees, of tets with corners `p[:, 0..3]`, by their definition."""
    angles = []
    for a, b, c, d in [(0, 1, 2, 3), (0, 2, 1, 3), (0, 3, 1, 2), (1, 2, 0, 3), (1, 3, 0, 2), (2, 3, 0, 1)]:
        edge = p[:, b] - p[:, a]
        edge /= np.linalg.norm(edge, axis=1)[:, None]
        u, v = (p[:, k] - p[:, a] for k in (c, d))
        u, v = (w - (w * edge).sum(axis=1)[:, None] * edge for w in (u, v))
        angles.append(np.arctan2(np.linalg.norm(np.cross(u, v), axis=1), (u * v).sum(axis=1)))
    return np.degrees(angles).T


def test_quality_measures_of_every_tet_are_written(motet, sphere, tmp_path):
    motet("info", sphere[0] / "moved_0010.vtu", "-o", tmp_path / "quality.vtu")
    mesh = pv.read(tmp_path / "quality.vtu")
    tets = mesh.extract_cells(mesh.celltypes == pv.CellType.TETRA)
    # By definition: Verdict's minimum angle is too large on some of these tets.
    angles = dihedral_angles(np.asarray(tets.points)[tets.cells_dict[pv.CellType.TETRA]])
    assert np.allclose(tets["min_dihedral_deg"], angles.min(axis=1), rtol=0, atol=1e-9)
    assert np.allclose(tets["max_dihedral_deg"], angles.max(axis=1), rtol=0, atol=1e-9)
    assert np.allclose(tets["volume"], tets.cell_quality("volume")["volume"], rtol=1e-11)
    assert np.isnan(mesh["eas"][mesh.celltypes != pv.CellType.TETRA]).all()


def test_three_real_walls_move_without_inverted_cells(motet, data, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(moving_walls, "MOTET", motet.path)
    monkeypatch.setattr(moving_walls, "DATA", data)
    moving_walls.left_heart(tmp_path)
    moving_walls.vessel(tmp_path)
    moving_walls.boundary_layer(tmp_path)
    printed = capsys.readouterr().out
    assert printed.count("largest number of inverted cells 0\n") == 4
    assert printed.count("exactly at its initial position: True") == 3
