"""Meshes of meshio and PyVista, in and out. Neither is needed otherwise."""
from __future__ import annotations

from typing import Any

import numpy as np

from .errors import InputError
from ._mesh import KINDS, NAMES, Mesh, ids


def from_meshio(mesh: Any) -> Mesh:
    names = {block.type for block in mesh.cells}
    strange = sorted(name for name in names if name not in KINDS or name in ("polygon", "polyhedron"))
    if strange:
        raise InputError(f"cells of kind {', '.join(strange)} cannot come from meshio; write a file and read it with motet.read")
    blocks = [(block.type, block.data) for block in mesh.cells]
    cell_data = {name: np.concatenate(list(arrays)) for name, arrays in mesh.cell_data.items()}
    return Mesh(_in_space(mesh.points), blocks, point_data=mesh.point_data, cell_data=cell_data)


def to_meshio(mesh: Mesh) -> Any:
    import meshio

    blocks: list[tuple[str, Any]] = []
    arrays: dict[str, list[Any]] = {name: [] for name in mesh.cell_data}
    # Runs of one kind and one number of vertices are a block, so that the order stays.
    counts = np.diff(mesh.offsets.astype(np.int64))
    change = (np.diff(mesh.kinds.astype(int)) != 0) | (np.diff(counts) != 0)
    starts = [0, *(np.flatnonzero(change) + 1), mesh.n_cells]
    for first, last in zip(starts, starts[1:]):
        if first == last:
            continue
        kind = NAMES.get(int(mesh.kinds[first]))
        if kind in (None, "polyhedron"):
            raise InputError(f"cells of kind {kind or mesh.kinds[first]} cannot go to meshio; use save")
        rows = mesh.connectivity[mesh.offsets[first] : mesh.offsets[last]].reshape(last - first, -1)
        blocks.append((kind, rows.astype(np.int64)))
        for name, array in mesh.cell_data.items():
            arrays[name].append(np.asarray(array)[first:last])
    return meshio.Mesh(mesh.points.copy(), blocks, point_data=dict(mesh.point_data), cell_data=arrays)


def from_pyvista(mesh: Any) -> Mesh:
    import pyvista

    data = pyvista.wrap(mesh)
    if not hasattr(data, "points") or not hasattr(data, "n_cells"):
        raise InputError(f"{type(mesh).__name__} has no points and cells")
    grid = data if isinstance(data, pyvista.UnstructuredGrid) else data.cast_to_unstructured_grid()
    new = Mesh(_in_space(grid.points), np.zeros((0, 4), np.uint32))
    new.kinds = np.ascontiguousarray(grid.celltypes, np.uint8)
    new.offsets = ids(grid.cell_offsets if hasattr(grid, "cell_offsets") else grid.offset, "offsets")
    new.connectivity = ids(grid.cell_connectivity, "cells")
    if (new.kinds == KINDS["polyhedron"]).any():
        new.faces = _faces(grid)
    new.point_data = {name: np.asarray(grid.point_data[name]) for name in grid.point_data.keys()}
    new.cell_data = {name: np.asarray(grid.cell_data[name]) for name in grid.cell_data.keys()}
    return new


def _faces(grid: Any) -> np.ndarray:
    """The faces of each polyhedron: how many, and of each how many vertices, and these."""
    stream: list[int] = []
    for cell in np.flatnonzero(grid.celltypes == KINDS["polyhedron"]):
        of_cell = grid.get_cell(int(cell))
        stream.append(of_cell.n_faces)
        for face in of_cell.faces:
            stream += [len(face.point_ids), *face.point_ids]
    return np.array(stream, np.uint32)


def to_pyvista(mesh: Mesh) -> Any:
    import pyvista

    if (mesh.kinds == KINDS["polyhedron"]).any():
        raise InputError("polyhedra cannot go to PyVista; use save")
    counts = np.diff(mesh.offsets.astype(np.int64))
    cells = np.insert(mesh.connectivity.astype(np.int64), mesh.offsets[:-1].astype(np.int64), counts)
    grid = pyvista.UnstructuredGrid(cells, mesh.kinds, mesh.points.copy())
    for name, array in mesh.point_data.items():
        grid.point_data[name] = array
    for name, array in mesh.cell_data.items():
        grid.cell_data[name] = array
    return grid


def _in_space(points: Any) -> np.ndarray:
    points = np.asarray(points, np.float64)
    if points.ndim == 2 and points.shape[1] == 2:
        points = np.column_stack([points, np.zeros(len(points))])
    return points
