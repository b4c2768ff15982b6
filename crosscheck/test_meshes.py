"""Tests of the comparisons: each detects differences."""
import numpy as np
import pytest
from meshes import assert_same_array, tet_set, volumes


def test_equal_arrays_compare_equal():
    values = np.array([[1.0, np.nan], [0.0, -np.inf]])
    assert_same_array(values, values.copy())
    assert_same_array(np.array([1, 2], np.int32), np.array([1, 2], np.int64))


@pytest.mark.parametrize("other", [
    np.array([0.0, -0.0]),                      # differs in the sign bit
    np.array([0.0, np.nextafter(0.0, 1.0)]),
    np.array([0.0]),
    np.array([0.0, 0.0], np.float32),
    np.array([0, 0]),
])
def test_any_difference_is_detected(other):
    with pytest.raises(AssertionError):
        assert_same_array(np.array([0.0, 0.0]), other)


def test_tets_are_compared_as_sets():
    assert np.array_equal(tet_set([[3, 1, 2, 0], [4, 5, 6, 7]]), tet_set([[7, 6, 5, 4], [0, 1, 2, 3]]))
    assert not np.array_equal(tet_set([[0, 1, 2, 3]]), tet_set([[0, 1, 2, 4]]))


def test_volumes_are_signed():
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
    assert np.allclose(volumes(points, [[0, 1, 2, 3], [0, 2, 1, 3]]), [1 / 6, -1 / 6])
