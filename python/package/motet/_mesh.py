"""The mesh: points, cells of any kind and data arrays, all as numpy arrays."""
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
from ._keywords import checked, checked_class

# meshio's names of cell kinds, with VTK's numbers.
KINDS = _motet.cell_kinds()
NAMES = {number: name for name, number in KINDS.items()}
# The kind of cells given as an array, by its number of columns.
BY_COLUMNS = {2: "line", 3: "triangle", 4: "tetra"}

Cells = Union[ArrayLike, Mapping[str, ArrayLike], Sequence[tuple[str, ArrayLike]]]


@checked_class
class Mesh:
    """A mesh: points, cells of any kind, and data arrays.

    Functions of the package copy the arrays and never modify a mesh that they are given.

    Parameters
    ----------
    points : array_like, shape (n, 3)
        Coordinates, in any unit of length.
    cells : array_like, mapping of str to array_like, or sequence of (str, array_like)
        Vertex ids of each cell, starting at 0, in VTK's order. An array with four columns contains tets, with
        three columns triangles, and with two columns lines. Otherwise the keys are meshio's names of cell
        kinds, such as ``{"tetra": tets, "wedge": wedges, "triangle": triangles}``.
    point_data : mapping of str to array_like, optional
        Arrays with one row per point.
    cell_data : mapping of str to array_like, optional
        Arrays with one row per cell, over all kinds in the order of `cells`.
    field_data : mapping of str to array_like, optional
        Arrays that belong to the mesh as a whole.
    region_names : mapping of int to str, optional
        Names of the labels in the cell array ``region`` (of volume cells).
    patch_names : mapping of int to str, optional
        Names of the labels in the cell array ``patch`` (of surface cells).

    Attributes
    ----------
    points : float64 array, shape (n, 3)
        Coordinates.
    kinds : uint8 array, shape (m,)
        VTK's number of the kind of each cell.
    offsets : uint32 array, shape (m + 1,)
        The vertices of cell ``i`` are ``connectivity[offsets[i]:offsets[i + 1]]``.
    connectivity : uint32 array, shape (k,)
        Vertex ids of all cells, one cell after the other.
    faces : uint32 array
        For each polyhedron its number of faces, then for each face its number of vertices and the vertices;
        empty if there are no polyhedra.
    point_data, cell_data, field_data : dict of str to ndarray
        Data arrays by name.
    region_names, patch_names : dict of int to str
        Names of labels.
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
        """Number of points."""
        return len(self.points)

    @property
    def n_cells(self) -> int:
        """Number of cells."""
        return len(self.kinds)

    @property
    def tets(self) -> NDArray[np.uint32]:
        """Vertex ids of the tets, shape (m, 4)."""
        return self.cells("tetra")

    @property
    def triangles(self) -> NDArray[np.uint32]:
        """Vertex ids of the triangular cells, shape (m, 3)."""
        return self.cells("triangle")

    def cells(self, kind: str) -> NDArray[np.uint32]:
        """Return the vertex ids of the cells of one kind, one row per cell.

        Parameters
        ----------
        kind : str
            meshio's name of the kind, such as ``"tetra"``.

        Returns
        -------
        uint32 array, shape (number of cells, vertices per cell)

        Raises
        ------
        InputError
            If the kind is unknown, or its cells have different numbers of vertices.
        """
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
        """Return the ids of the cells of one kind, ascending.

        Parameters
        ----------
        kind : str
            meshio's name of the kind, such as ``"tetra"``.

        Returns
        -------
        int64 array, shape (number of cells,)
        """
        if kind not in KINDS:
            raise InputError(f"unknown cell kind {kind!r}; known kinds: {', '.join(KINDS)}")
        return np.flatnonzero(self.kinds == KINDS[kind])

    def copy(self) -> Mesh:
        """Return a deep copy."""
        new = Mesh.__new__(Mesh)
        for name, value in self.__dict__.items():
            shared = isinstance(value, dict)
            new.__dict__[name] = {k: v.copy() if hasattr(v, "copy") else v for k, v in value.items()} if shared else value.copy()
        return new

    def summary(self) -> Report:
        """Return counts, bounds, volume, regions, patches, quality and defects of the mesh.

        The contents are those of ``motet info --json`` on the command line.

        Returns
        -------
        Report
        """
        return report(_motet.summary(self))

    def quality(self, measure: str = "eas") -> NDArray[np.float64]:
        """Return a quality measure of each tet.

        Parameters
        ----------
        measure : str, default "eas"
            ``"eas"`` (equi-angle quality: 1 regular, 0 flat, negative inverted; bad below 0.2),
            ``"scaled_jacobian"``, ``"radius_ratio"``, ``"aspect_ratio"`` (as in Verdict), ``"mean_ratio"``
            (12 (3 V)^(2/3) over the sum of squared edge lengths), ``"edge_ratio"``, ``"min_dihedral_deg"``,
            ``"max_dihedral_deg"`` or ``"volume"``.

        Returns
        -------
        float64 array, shape (m,)
            One value per cell; NaN for cells that are not tets.
        """
        return _motet.quality(self, measure)

    def save(self, path: str | os.PathLike[str], *, threads: int = 0) -> list[str]:
        """Write the mesh to a file.

        Parameters
        ----------
        path : path-like
            Name of the file. Its extension determines the format; see :func:`formats`.
        threads : int, default 0
            Number of threads; 0 uses all cores. The file does not depend on it.

        Returns
        -------
        list of str
            What the format cannot store, one sentence each. These are also issued as warnings.
        """
        import warnings

        lost = _motet.write(path, self, threads)
        for sentence in lost:
            warnings.warn(sentence, stacklevel=3)
        return lost

    def patch_vertices(self, patch: str | int) -> NDArray[np.uint32]:
        """Return the vertex ids of a patch, ascending.

        Parameters
        ----------
        patch : str or int
            Name or label of the patch.

        Returns
        -------
        uint32 array, shape (k,)
        """
        return _motet.patch_vertices(self, [patch])

    @classmethod
    def from_meshio(cls, mesh: Any) -> Mesh:
        """Create a mesh from a ``meshio.Mesh``."""
        from ._convert import from_meshio

        return from_meshio(mesh)

    @classmethod
    def from_trimesh(cls, mesh: Any) -> Mesh:
        """Create a surface from a ``trimesh.Trimesh``, with its ``vertex_attributes`` and ``face_attributes``."""
        from ._convert import from_trimesh

        return from_trimesh(mesh)

    def to_trimesh(self) -> Any:
        """Convert the triangles of the mesh to a ``trimesh.Trimesh``."""
        from ._convert import to_trimesh

        return to_trimesh(self)

    def to_meshio(self) -> Any:
        """Convert the mesh to a ``meshio.Mesh``."""
        from ._convert import to_meshio

        return to_meshio(self)

    @classmethod
    def from_pyvista(cls, mesh: Any) -> Mesh:
        """Create a mesh from any PyVista or VTK data set with cells."""
        from ._convert import from_pyvista

        return from_pyvista(mesh)

    def to_pyvista(self) -> Any:
        """Convert the mesh to a ``pyvista.UnstructuredGrid``."""
        from ._convert import to_pyvista

        return to_pyvista(self)

    def plot(self, **kwargs: Any) -> Any:
        """Show the mesh with PyVista.

        Parameters
        ----------
        **kwargs
            Keyword arguments of ``pyvista.UnstructuredGrid.plot``.
        """
        return self.to_pyvista().plot(**kwargs)

    def __repr__(self) -> str:
        numbers, counts = np.unique(self.kinds, return_counts=True)
        cells = ", ".join(f"{n} {NAMES.get(int(kind), f'of kind {kind}')}" for kind, n in zip(numbers, counts)) or "no cells"
        arrays = [*(f"{name} on points" for name in self.point_data), *(f"{name} on cells" for name in self.cell_data)]
        return f"motet.Mesh: {self.n_points} points, {cells}" + (f"; {', '.join(arrays)}" if arrays else "")


MeshLike = Any
"""A :class:`Mesh`, a file path, a ``meshio.Mesh``, a PyVista or VTK data set, or a ``trimesh.Trimesh``."""


@checked
def read(path: str | os.PathLike[str], *, threads: int = 0) -> Mesh:
    """Read a mesh from a file.

    Parts of the file that cannot be used are reported as warnings.

    Parameters
    ----------
    path : path-like
        Name of the file. Its extension determines the format; see :func:`formats`.
    threads : int, default 0
        Number of threads; 0 uses all cores. The mesh does not depend on it.

    Returns
    -------
    Mesh

    Raises
    ------
    FileError
        If the file cannot be opened.
    InputError
        If its contents are not valid.
    """
    import warnings

    parts, notes = _motet.read(path, threads)
    for note in notes:
        warnings.warn(note, stacklevel=3)
    return Mesh._of(parts)


@checked
def as_mesh(mesh: MeshLike) -> Mesh:
    """Convert an object to a mesh.

    Parameters
    ----------
    mesh : MeshLike
        A :class:`Mesh`, which is returned as it is, a file path, a ``meshio.Mesh``, a PyVista or VTK data set,
        or a ``trimesh.Trimesh``.

    Returns
    -------
    Mesh

    Raises
    ------
    InputError
        If the object is not a mesh, or cannot be converted.
    """
    from ._convert import from_meshio, from_pyvista, from_trimesh

    if isinstance(mesh, Mesh):
        return mesh
    if isinstance(mesh, (str, os.PathLike)):
        return read(mesh)
    if hasattr(mesh, "GetPointData"):
        return from_pyvista(mesh)
    if hasattr(mesh, "points") and hasattr(mesh, "cells_dict"):
        return from_meshio(mesh)
    if hasattr(mesh, "vertices") and hasattr(mesh, "faces"):
        return from_trimesh(mesh)
    raise InputError(f"{type(mesh).__name__} is not a mesh: expected a motet.Mesh, a path, a meshio.Mesh, a PyVista data set or a trimesh.Trimesh")


def named(meshes: Any, default: str) -> Mapping[str, Any]:
    """Return meshes by unique names: the given names, file names, or `default` with a number."""
    if isinstance(meshes, Mapping):
        return meshes
    several = meshes if isinstance(meshes, (list, tuple)) else [meshes]
    by_name: dict[str, Any] = {}
    for mesh in several:
        base = Path(mesh).stem if isinstance(mesh, (str, os.PathLike)) else default
        name, k = base, 2
        while name in by_name:
            name, k = f"{base}_{k}", k + 1
        by_name[name] = mesh
    return by_name


def ids(array: ArrayLike, what: str) -> NDArray[np.uint32]:
    """Convert ids to uint32; raise InputError for values that are not integers or out of range."""
    given = np.asarray(array)
    if given.dtype == np.uint32:
        return np.ascontiguousarray(given)
    if given.size and not np.issubdtype(given.dtype, np.integer):
        raise InputError(f"{what} of type {given.dtype}, expected integers")
    if given.size and (given.min() < 0 or given.max() >= 2**32 - 1):
        raise InputError(f"{what} from {given.min()} to {given.max()}, expected 0 or more, below 2^32 - 1")
    return np.ascontiguousarray(given, np.uint32)


def point(values: ArrayLike) -> list[float]:
    """Convert a position or vector to a list of three numbers."""
    numbers = np.asarray(values, np.float64)
    if numbers.shape != (3,):
        raise InputError(f"{values!r} is not a position or vector of three numbers")
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
            raise InputError(f"unknown cell kind {kind!r}; known kinds: {', '.join(KINDS)}")
        rows = ids(rows, f"cells of kind {kind}")
        if rows.ndim != 2:
            raise InputError(f"cells of kind {kind}: an array of shape {rows.shape}, expected one row per cell")
        yield kind, rows


def _arrays(data: Mapping[str, ArrayLike] | None) -> dict[str, Any]:
    return {name: np.asarray(array) for name, array in (data or {}).items()}
