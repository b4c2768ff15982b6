"""Data over time: series of meshes, and values at nodes."""
import numpy as np
import pytest

import motet
from motet import shapes


def test_a_series_can_be_read_after_each_step(tmp_path):
    meshes = [shapes.sphere_in_box(), shapes.ball()]
    with motet.SeriesWriter(tmp_path / "run.pvd") as writer:
        for time, mesh in zip([0.0, 0.5], meshes):
            assert str(writer.add(time, mesh)).endswith(".vtu")
            assert [at for at, _ in motet.read_series(tmp_path / "run.pvd")][-1] == time
    for (_, file), mesh in zip(motet.read_series(tmp_path / "run.pvd"), meshes):
        np.testing.assert_array_equal(motet.read(file).points, mesh.points)


def test_values_at_nodes_are_written_and_read_exactly(tmp_path):
    times, ids = [0.0, 0.1], [5, 3, 9]
    values = np.random.default_rng(1).normal(size=(3, 2, 3))
    motet.write_nodal(tmp_path / "wall.dat", times, ids, values)
    back = motet.read_nodal(tmp_path / "wall.dat")
    for is_, was in zip(back, (times, ids, values)):
        np.testing.assert_array_equal(is_, was)
    # The numbers in the file, as numpy parses them.
    numbers = np.array((tmp_path / "wall.dat").read_text().split(), float)
    np.testing.assert_array_equal(numbers[5 : 5 + 7], [5, *values[0].ravel()])


def test_invalid_values_at_nodes_raise_an_error(tmp_path):
    with pytest.raises(motet.InputError, match="shape"):
        motet.write_nodal(tmp_path / "wall.dat", [0.0], [1], np.zeros((1, 3)))
    with pytest.raises(motet.InputError, match="2 nodes at 1 times"):
        motet.write_nodal(tmp_path / "wall.dat", [0.0], [1], np.zeros((2, 1, 3)))
    with pytest.raises(motet.FileError):
        motet.read_nodal(tmp_path / "none.dat")
    (tmp_path / "bad.dat").write_text("3 1 1\n0\n1\n0 0\n")
    with pytest.raises(motet.InputError, match="line"):
        motet.read_nodal(tmp_path / "bad.dat")
