"""Conversion from and to meshes of meshio, PyVista and trimesh, which are imported only here.

None of them stores names of labels. They are passed as field data ``region:NAME`` and ``patch:NAME`` with
the label as value, as in files that motet writes, and to meshio also as cell sets. Names of Gmsh's physical
groups (field data ``NAME: [label, dimension]``) are read from meshio meshes.
"""
from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from . import _motet
from .errors import InputError
from ._mesh import KINDS, NAMES, Mesh, ids


def from_meshio(mesh: Any) -> Mesh:
    names = {block.type for block in mesh.cells}
    unsupported = sorted(name for name in names if name not in KINDS or name in ("polygon", "polyhedron"))
    if unsupported:
        raise InputError(f"cells of kind {', '.join(unsupported)} cannot be converted from meshio; write a file and read it with motet.read")
    blocks = [(block.type, block.data) for block in mesh.cells]
    cell_data = {name: np.concatenate(list(arrays)) for name, arrays in mesh.cell_data.items()}
    new = Mesh(_in_space(mesh.points), blocks, point_data=mesh.point_data, cell_data=cell_data)
    field_data = dict(mesh.field_data)
    if "gmsh:physical" in cell_data:
        _take_groups(new, field_data)
    _take_field_data(new, field_data)
    _take_sets(new, mesh)
    return new


def from_trimesh(mesh: Any) -> Mesh:
    def arrays(attributes: Any) -> dict[str, Any]:
        found = {name: np.asarray(values) for name, values in attributes.items()}
        return {name: values for name, values in found.items() if values.dtype.kind in "biuf"}

    return Mesh(
        mesh.vertices, np.asarray(mesh.faces), point_data=arrays(mesh.vertex_attributes), cell_data=arrays(mesh.face_attributes)
    )


def to_trimesh(mesh: Mesh) -> Any:
    import trimesh

    of_triangles = mesh.kinds == KINDS["triangle"]
    used, faces = np.unique(mesh.triangles, return_inverse=True)
    return trimesh.Trimesh(
        mesh.points[used],
        faces.reshape(-1, 3),
        vertex_attributes={name: np.asarray(values)[used] for name, values in mesh.point_data.items()},
        face_attributes={name: np.asarray(values)[of_triangles] for name, values in mesh.cell_data.items()},
        process=False,
    )


UNKNOWN_TO_MESHIO = ("polyhedron", "poly_line", "poly_vertex", "triangle_strip")


def to_meshio(mesh: Mesh) -> Any:
    import meshio

    blocks: list[tuple[str, Any]] = []
    arrays: dict[str, list[Any]] = {name: [] for name in mesh.cell_data}
    # Consecutive cells of one kind and number of vertices form a block, which preserves the order.
    counts = np.diff(mesh.offsets.astype(np.int64))
    change = (np.diff(mesh.kinds.astype(int)) != 0) | (np.diff(counts) != 0)
    starts = [0, *(np.flatnonzero(change) + 1), mesh.n_cells]
    for first, last in zip(starts, starts[1:]):
        if first == last:
            continue
        kind = NAMES.get(int(mesh.kinds[first]))
        if kind is None or kind in UNKNOWN_TO_MESHIO:
            raise InputError(f"cells of kind {kind or mesh.kinds[first]} cannot be converted to meshio; use save")
        rows = mesh.connectivity[mesh.offsets[first] : mesh.offsets[last]].reshape(last - first, -1)
        blocks.append((kind, rows.astype(np.int64)))
        for name, array in mesh.cell_data.items():
            arrays[name].append(np.asarray(array)[first:last])
    field_data = {name: np.asarray(values) for name, values in _field_data(mesh).items()}
    new = meshio.Mesh(mesh.points.copy(), blocks, point_data=dict(mesh.point_data), cell_data=arrays, field_data=field_data)
    if mesh.region_names or mesh.patch_names:
        new.cell_sets = _sets(mesh, [len(block) for block in new.cells])
    if "gmsh:physical" in mesh.cell_data:
        # This is how meshio stores the names of physical groups and writes them to Gmsh files.
        for names, dim in ((mesh.region_names, 3), (mesh.patch_names, 2)):
            new.field_data.update({name: np.array([label, dim]) for label, name in names.items() if name not in new.field_data})
    return new


def _take_groups(new: Mesh, field_data: dict[str, Any]) -> None:
    """Move the names of Gmsh's physical groups from field data (label, dimension) to the mesh."""
    names = {3: new.region_names, 2: new.patch_names}
    for name, values in list(field_data.items()):
        pair = np.asarray(values)
        if pair.shape == (2,) and np.issubdtype(pair.dtype, np.integer) and 0 <= pair[1] <= 3:
            names.get(int(pair[1]), {})[int(pair[0])] = name
            del field_data[name]


def _take_field_data(new: Mesh, field_data: Mapping[str, Any]) -> None:
    """Copy numbers and strings from field data, and move names of labels to the mesh."""
    for name, values in field_data.items():
        array = np.asarray(values)
        if array.dtype.kind in "biuf":
            new.field_data[name] = np.atleast_1d(array)
        elif array.dtype.kind == "U" and not name.startswith("_PYVISTA"):
            new.field_data[name] = np.atleast_1d(array).tolist()
    single = [(name, int(array.flat[0])) for name, array in new.field_data.items() if _is_label(array)]
    regions, patches, taken = _motet.names_of_fields(single)
    for name in taken:
        del new.field_data[name]
    new.region_names.update(regions)
    new.patch_names.update(patches)


def _is_label(array: Any) -> bool:
    return isinstance(array, np.ndarray) and array.size == 1 and array.dtype.kind in "iu" and abs(int(array.flat[0])) < 2**63


def _take_sets(new: Mesh, mesh: Any) -> None:
    """Convert cell sets to names of labels.

    If the mesh has labels, a set names the label whose cells are exactly those of the set. Otherwise sets
    become labels; a cell in several sets belongs to the smallest.
    """
    sets = {name: _members(lists, mesh.cells) for name, lists in mesh.cell_sets.items() if not name.startswith("gmsh:")}
    if not sets:
        return
    dims = np.repeat([block.dim for block in mesh.cells], [len(block) for block in mesh.cells])
    found = dict(zip((3, 2), _motet.labels(new)))
    for dim, array, names in ((3, "region", new.region_names), (2, "patch", new.patch_names)):
        of_dim = {name: members & (dims == dim) for name, members in sets.items()}
        of_dim = {name: members for name, members in of_dim.items() if members.any()}
        labels = found[dim]
        if labels is not None:
            for name, members in of_dim.items():
                label = int(labels[members][0])
                if label and label not in names and np.array_equal(labels == label, members):
                    names[label] = name
        elif of_dim and not np.any(new.cell_data.get(array, 0)):
            labels = np.zeros(len(dims), np.int32)
            by_size = sorted(of_dim.items(), key=lambda one: -np.count_nonzero(one[1]))
            for label, (_, members) in enumerate(by_size, 1):
                labels[members] = label
            new.cell_data[array] = labels
            names.update({label: name for label, (name, _) in enumerate(by_size, 1) if (labels == label).any()})


def _members(lists: Any, blocks: Any) -> np.ndarray:
    """Mark the cells of a set, given by their indices within each block, among all cells."""
    is_in = [np.zeros(len(block), bool) for block in blocks]
    for mine, ids_of_block in zip(is_in, lists):
        if ids_of_block is not None:
            mine[np.asarray(ids_of_block, np.int64)] = True
    return np.concatenate(is_in or [np.zeros(0, bool)])


def _sets(mesh: Mesh, lengths: list[int]) -> dict[str, list[np.ndarray]]:
    """Return the cells of each name, block by block. A region and a patch of the same name form one set."""
    regions, patches = _motet.labels(mesh)
    ends = np.cumsum(lengths)[:-1]
    members: dict[str, np.ndarray] = {}
    for labels, names in ((regions, mesh.region_names), (patches, mesh.patch_names)):
        if labels is None:
            continue
        for label, name in names.items():
            of_label = labels == label
            members[name] = members[name] | of_label if name in members else of_label
    return {name: [np.flatnonzero(of_block) for of_block in np.split(is_in, ends)] for name, is_in in members.items() if is_in.any()}


def _field_data(mesh: Mesh) -> dict[str, Any]:
    """Return the field data including the names of labels."""
    names = {name: np.array([label], np.int32) for name, label in _motet.name_fields(mesh.region_names, mesh.patch_names)}
    others = {name: values if isinstance(values, list) else np.asarray(values) for name, values in mesh.field_data.items()}
    return {**others, **names}


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
    _take_field_data(new, {name: data.field_data[name] for name in data.field_data.keys()})
    return new


def _faces(grid: Any) -> np.ndarray:
    """Return for each polyhedron its number of faces, then each face as its number of vertices and these."""
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
        raise InputError("polyhedra cannot be converted to PyVista; use save")
    counts = np.diff(mesh.offsets.astype(np.int64))
    cells = np.insert(mesh.connectivity.astype(np.int64), mesh.offsets[:-1].astype(np.int64), counts)
    grid = pyvista.UnstructuredGrid(cells, mesh.kinds, mesh.points.copy())
    for name, array in mesh.point_data.items():
        grid.point_data[name] = array
    for name, array in mesh.cell_data.items():
        grid.cell_data[name] = array
    for name, values in _field_data(mesh).items():
        grid.field_data[name] = values
    return grid


def _in_space(points: Any) -> np.ndarray:
    points = np.asarray(points, np.float64)
    if points.ndim == 2 and points.shape[1] == 2:
        points = np.column_stack([points, np.zeros(len(points))])
    return points
