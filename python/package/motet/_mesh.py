"""The mesh: points, cells of any kinds and the arrays on them, all of it numpy arrays."""
from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _motet
from .errors import InputError
from ._report import Report, report
from ._words import checked, checked_class

# Names of kinds of cells, as meshio has them, and VTK's numbers.
KINDS = _motet.cell_kinds()
NAMES = {number: name for name, number in KINDS.items()}
# Kinds by how many vertices a row has, where only an array is given.
BY_COLUMNS = {2: "line", 3: "triangle", 4: "tetra"}

Cells = Union[ArrayLike, Mapping[str, ArrayLike], Sequence[tuple[str, ArrayLike]]]


@checked_class
class Mesh:
    """Points, cells of any kinds, and the arrays on them: all that a file holds.

    Parameters
    ----------
    points : array (n, 3)
        Coordinates, in any unit of length.
    cells : array (m, 4), or mapping or sequence of pairs from a kind to an array
        The vertices of each cell, from 0, in VTK's order. An array of four columns is tets, of three triangles, of two lines; other kinds go by
        meshio's names: ``{"tetra": (m, 4), "wedge": (k, 6), "triangle": (s, 3)}``.
    point_data, cell_data, field_data : mapping from names to arrays
        Arrays with a row for each point, a row for each cell (of all kinds, in their order), and about the whole.
    region_names, patch_names : mapping from label to name
        What the labels in the cell arrays ``region`` (of volume cells) and ``patch`` (of surface cells) are called.

    Attributes
    ----------
    points : float64 array (n, 3)
    kinds : uint8 array (m,)
        VTK's number of the kind of each cell.
    offsets, connectivity : uint32 arrays (m + 1,) and (k,)
        The vertices of cell ``i`` are ``connectivity[offsets[i]:offsets[i + 1]]``.
    faces : uint32 array
        For each polyhedron its number of faces, and for each of these its number of vertices and the vertices; empty without polyhedra.

    Verbs copy what they are given and never change it.
    """

    def __init__(
        self,
        points: ArrayLike,
        cells: Cells,
        *,
        point_data: Mapping[str, ArrayLike] | None = None,
        cell_data: Mapping[str, ArrayLike] | None = None,
        field_data: Mapping[str, ArrayLike] | None = None,
        region_names: Mapping[int, str] | None = None,
        patch_names: Mapping[int, str] | None = None,
    ):
        self.points = points
        blocks = list(_blocks(cells))
        counts = np.concatenate([np.full(len(rows), rows.shape[1], np.int64) for _, rows in blocks] or [np.zeros(0, np.int64)])
        self.kinds = np.concatenate([np.full(len(rows), KINDS[kind], np.uint8) for kind, rows in blocks] or [np.zeros(0, np.uint8)])
        self.offsets = np.concatenate([[0], np.cumsum(counts)]).astype(np.uint32)
        self.connectivity = np.concatenate([rows.ravel() for _, rows in blocks] or [np.zeros(0, np.uint32)])
        self.faces = np.zeros(0, np.uint32)
        self.point_data = _arrays(point_data)
        self.cell_data = _arrays(cell_data)
        self.field_data = _arrays(field_data)
        self.region_names = dict(region_names or {})
        self.patch_names = dict(patch_names or {})

    @classmethod
    def _of(cls, parts: dict) -> Mesh:
        mesh = cls.__new__(cls)
        mesh.points = parts.pop("points")
        mesh.__dict__.update(parts)
        return mesh

    @property
    def points(self) -> NDArray[np.float64]:
        return self._points

    @points.setter
    def points(self, points: ArrayLike) -> None:
        points = np.ascontiguousarray(points, np.float64)
        if points.ndim != 2 or points.shape[1] != 3:
            raise InputError(f"points of shape {points.shape}, expected (n, 3)")
        self._points = points

    @property
    def n_points(self) -> int:
        return len(self.points)

    @property
    def n_cells(self) -> int:
        return len(self.kinds)

    @property
    def tets(self) -> NDArray[np.uint32]:
        """The vertices of the tets, (m, 4)."""
        return self.cells("tetra")

    @property
    def triangles(self) -> NDArray[np.uint32]:
        """The vertices of the triangles among the cells, (m, 3)."""
        return self.cells("triangle")

    def cells(self, kind: str) -> NDArray[np.uint32]:
        """The vertices of the cells of a kind, a row each; of a kind whose cells differ in their number of vertices none can be told this way."""
        ids = self.cell_ids(kind)
        if not len(ids):
            return np.zeros((0, {"triangle": 3, "tetra": 4}.get(kind, 0)), np.uint32)
        counts = np.diff(self.offsets.astype(np.int64))[ids]
        if (counts != counts[0]).any():
            raise InputError(f"cells of kind {kind} differ in their number of vertices: use offsets and connectivity")
        if len(ids) == self.n_cells:
            return self.connectivity.reshape(-1, counts[0])
        return self.connectivity[self.offsets[ids].astype(np.int64)[:, None] + np.arange(counts[0])]

    def cell_ids(self, kind: str) -> NDArray[np.int64]:
        """Which cells are of a kind."""
        if kind not in KINDS:
            raise InputError(f"unknown cell kind {kind!r}; there are {', '.join(KINDS)}")
        return np.flatnonzero(self.kinds == KINDS[kind])

    def copy(self) -> Mesh:
        """A copy that shares nothing with this one."""
        new = Mesh.__new__(Mesh)
        for name, value in self.__dict__.items():
            shared = isinstance(value, dict)
            new.__dict__[name] = {k: v.copy() if hasattr(v, "copy") else v for k, v in value.items()} if shared else value.copy()
        return new

    def summary(self) -> Report:
        """Counts, bounds, volume, regions, patches, quality, and all that is wrong with it; as ``motet info --json``."""
        return report(_motet.summary(self))

    def quality(self, measure: str = "eas") -> NDArray[np.float64]:
        """A measure of each cell, NaN where it is no tet.

        ``eas`` (1 regular, 0 flat, negative inverted, bad below 0.2), ``mean_ratio``, ``min_dihedral_deg``, ``max_dihedral_deg``, ``edge_ratio``, ``volume``.
        """
        return _motet.quality(self, measure)

    def save(self, path: str | os.PathLike[str]) -> list[str]:
        """Writes the mesh; the format is given by the extension. What it cannot hold is reported as warnings and returned, one sentence each."""
        import warnings

        lost = _motet.write(path, self)
        for what in lost:
            warnings.warn(what, stacklevel=3)
        return lost

    def patch_vertices(self, patch: str | int) -> NDArray[np.uint32]:
        """The vertices of a patch, by its name or label, rising."""
        return _motet.patch_vertices(self, [patch])

    @classmethod
    def from_meshio(cls, mesh: Any) -> Mesh:
        """From a ``meshio.Mesh``."""
        from ._doors import from_meshio

        return from_meshio(mesh)

    def to_meshio(self) -> Any:
        """As a ``meshio.Mesh``."""
        from ._doors import to_meshio

        return to_meshio(self)

    @classmethod
    def from_pyvista(cls, mesh: Any) -> Mesh:
        """From any data set of PyVista or VTK that has cells."""
        from ._doors import from_pyvista

        return from_pyvista(mesh)

    def to_pyvista(self) -> Any:
        """As a ``pyvista.UnstructuredGrid``."""
        from ._doors import to_pyvista

        return to_pyvista(self)

    def plot(self, **words: Any) -> Any:
        """Shows it by PyVista, whose ``plot`` gets the words."""
        return self.to_pyvista().plot(**words)

    def __repr__(self) -> str:
        numbers, counts = np.unique(self.kinds, return_counts=True)
        cells = ", ".join(f"{n} {NAMES.get(int(kind), f'of kind {kind}')}" for kind, n in zip(numbers, counts)) or "no cells"
        arrays = [*(f"{name} on points" for name in self.point_data), *(f"{name} on cells" for name in self.cell_data)]
        return f"motet.Mesh: {self.n_points} points, {cells}" + (f"; {', '.join(arrays)}" if arrays else "")


MeshLike = Any
"""A :class:`Mesh`, a path of a file, a ``meshio.Mesh``, or a data set of PyVista or VTK."""


@checked
def read(path: str | os.PathLike[str]) -> Mesh:
    """Reads a mesh; the format is given by the extension. Skipped content of the file is reported as warnings."""
    import warnings

    parts, notes = _motet.read(path)
    for note in notes:
        warnings.warn(note, stacklevel=3)
    return Mesh._of(parts)


@checked
def as_mesh(mesh: MeshLike) -> Mesh:
    """A mesh from whatever is one: see :data:`MeshLike`."""
    from ._doors import from_meshio, from_pyvista

    if isinstance(mesh, Mesh):
        return mesh
    if isinstance(mesh, (str, os.PathLike)):
        return read(mesh)
    if hasattr(mesh, "GetPointData"):
        return from_pyvista(mesh)
    if hasattr(mesh, "points") and hasattr(mesh, "cells_dict"):
        return from_meshio(mesh)
    raise InputError(f"{type(mesh).__name__} is no mesh: a motet.Mesh, a path, a meshio.Mesh or a data set of PyVista is expected")


def named(meshes: Any, word: str) -> Mapping[str, Any]:
    """Meshes by names, each once: those that they come with, those of files, else the word."""
    if isinstance(meshes, Mapping):
        return meshes
    several = meshes if isinstance(meshes, (list, tuple)) else [meshes]
    by_name: dict[str, Any] = {}
    for mesh in several:
        base = Path(mesh).stem if isinstance(mesh, (str, os.PathLike)) else word
        name, k = base, 2
        while name in by_name:
            name, k = f"{base}_{k}", k + 1
        by_name[name] = mesh
    return by_name


def ids(array: ArrayLike, what: str) -> NDArray[np.uint32]:
    """Ids as they are passed on: whole numbers that fit."""
    given = np.asarray(array)
    if given.dtype == np.uint32:
        return np.ascontiguousarray(given)
    if given.size and not np.issubdtype(given.dtype, np.integer):
        raise InputError(f"{what} of type {given.dtype}, expected whole numbers")
    if given.size and (given.min() < 0 or given.max() >= 2**32 - 1):
        raise InputError(f"{what} from {given.min()} to {given.max()}, expected 0 or more, below 2^32 - 1")
    return np.ascontiguousarray(given, np.uint32)


def point(values: ArrayLike) -> list[float]:
    """Three numbers."""
    numbers = np.asarray(values, np.float64)
    if numbers.shape != (3,):
        raise InputError(f"{values!r} is no place or vector of three numbers")
    return numbers.tolist()


def _blocks(cells: Any) -> Iterator[tuple[str, NDArray[np.uint32]]]:
    if isinstance(cells, Mapping):
        pairs = list(cells.items())
    elif isinstance(cells, np.ndarray) or not (len(cells) and isinstance(cells[0], tuple) and isinstance(cells[0][0], str)):
        rows = np.asarray(cells)
        kind = BY_COLUMNS.get(rows.shape[1]) if rows.ndim == 2 else None
        if kind is None:
            raise InputError(f"cells of shape {rows.shape}, expected (m, 4) for tets, (m, 3) for triangles, or a mapping from kinds to arrays")
        pairs = [(kind, rows)]
    else:
        pairs = list(cells)
    for kind, rows in pairs:
        if kind not in KINDS:
            raise InputError(f"unknown cell kind {kind!r}; there are {', '.join(KINDS)}")
        rows = ids(rows, f"cells of kind {kind}")
        if rows.ndim != 2:
            raise InputError(f"cells of kind {kind}: an array of shape {rows.shape}, expected a row for each")
        yield kind, rows


def _arrays(data: Mapping[str, ArrayLike] | None) -> dict[str, Any]:
    return {name: np.asarray(array) for name, array in (data or {}).items()}
