"""Comparison of arrays bit by bit, of meshes cell by cell, and of tetrahedralisations as sets."""
import numpy as np


def assert_same_array(ours, theirs, what="array"):
    """Assert equal shapes and values: floats bit by bit, including -0 and NaN; integers of any width."""
    ours, theirs = np.asarray(ours), np.asarray(theirs)
    assert ours.shape == theirs.shape, f"{what}: shape {ours.shape}, expected {theirs.shape}"
    floats = ours.dtype.kind == "f", theirs.dtype.kind == "f"
    assert floats[0] == floats[1], f"{what}: {ours.dtype}, expected {theirs.dtype}"
    if floats[0]:
        assert ours.dtype == theirs.dtype, f"{what}: {ours.dtype}, expected {theirs.dtype}"
        same = np.ascontiguousarray(ours).view(f"u{ours.itemsize}") == np.ascontiguousarray(theirs).view(f"u{ours.itemsize}")
    else:
        same = ours == theirs
    if not np.all(same):
        at = tuple(np.argwhere(~np.asarray(same))[0])
        raise AssertionError(f"{what}: {np.count_nonzero(~np.asarray(same))} values differ, first at {at}: "
                             f"{ours[at]!r}, expected {theirs[at]!r}")


def cells_of(mesh):
    """Return the cells of a meshio mesh as {kind: (n, k) array}, with blocks of one kind joined in order."""
    blocks = {}
    for block in mesh.cells:
        blocks.setdefault(block.type, []).append(np.asarray(block.data))
    return {kind: np.vstack(parts) for kind, parts in blocks.items() if sum(map(len, parts))}


def cell_array_of(mesh, name):
    """Return a cell array of a meshio mesh by kind, in the order of `cells_of`."""
    blocks = {}
    for block, values in zip(mesh.cells, mesh.cell_data[name]):
        blocks.setdefault(block.type, []).append(np.asarray(values))
    return {kind: np.concatenate(parts) for kind, parts in blocks.items() if sum(map(len, parts))}


def assert_same_mesh(ours, theirs, point_data=None, cell_data=None):
    """Assert equal points, cells and arrays of two meshio meshes.

    `point_data` and `cell_data` are the names of the arrays to compare, by default all those in `theirs`.
    """
    assert_same_array(ours.points, theirs.points, "points")
    a, b = cells_of(ours), cells_of(theirs)
    assert sorted(a) == sorted(b), f"kinds of cells: {sorted(a)}, expected {sorted(b)}"
    for kind in b:
        assert_same_array(a[kind], b[kind], f"{kind} cells")
    for name in theirs.point_data if point_data is None else point_data:
        assert name in ours.point_data, f"point array {name} is missing; there are {sorted(ours.point_data)}"
        assert_same_array(ours.point_data[name], theirs.point_data[name], f"point array {name}")
    for name in theirs.cell_data if cell_data is None else cell_data:
        assert name in ours.cell_data, f"cell array {name} is missing; there are {sorted(ours.cell_data)}"
        x, y = cell_array_of(ours, name), cell_array_of(theirs, name)
        for kind in y:
            assert_same_array(x[kind], y[kind], f"cell array {name} on {kind} cells")


def tet_set(tets):
    """Sort the vertices of each tet, and the tets; the result is equal for equal sets of tets."""
    rows = np.sort(np.asarray(tets, dtype=np.int64).reshape(-1, 4), axis=1)
    return rows[np.lexsort(rows.T[::-1])]


def volumes(points, tets):
    """Return the signed volume of each tet, positive if (b-a)x(c-a).(d-a) > 0."""
    a, b, c, d = (np.asarray(points)[np.asarray(tets)[:, i]] for i in range(4))
    return np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6.0
