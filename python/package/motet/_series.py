"""What is over time: series of meshes, and of values of nodes."""
from __future__ import annotations

import os

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _motet
from ._mesh import MeshLike, as_mesh
from ._words import NotPickled, checked, checked_class
from .errors import InputError


@checked
def read_series(path: str | os.PathLike[str]) -> list[tuple[float, str]]:
    """The times of a series (``.pvd``), and the file of each."""
    return _motet.read_series(path)


@checked_class
class SeriesWriter(NotPickled):
    """Meshes over time, as ParaView plays them: a ``.pvd``, and a ``.vtu`` beside it for each time. Points and cells may differ from time to time.

    After each :meth:`add` the series on the disk is whole: there is nothing to close. In a ``with`` statement it works as files do.
    """

    _instead = "read the series that it wrote with motet.read_series"

    def __init__(self, path: str | os.PathLike[str]):
        self._native = _motet.SeriesWriter(path)
        self._path, self._n = os.fspath(path), 0

    def add(self, time: float, mesh: MeshLike) -> str:
        """Writes a mesh and the series that ends with it; gives the mesh's file."""
        file, _ = self._native.add(time, as_mesh(mesh))
        self._n += 1
        return file

    def __repr__(self) -> str:
        return f"motet.SeriesWriter: {self._path}, {self._n} times written"

    def __enter__(self) -> SeriesWriter:
        return self

    def __exit__(self, *_: object) -> None:
        pass


@checked
def read_nodal(path: str | os.PathLike[str]) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.float64]]:
    """Values of nodes over time, such as displacements of a wall, from the text that svMultiPhysics has them in ("temporal and spatial values").

    Returns
    -------
    times : array (t,), rising
    ids : array (n,)
        The nodes' ``GlobalNodeID``, or their numbers in the mesh counted from 1.
    values : array (n, t, c)
    """
    times, ids, values = _motet.read_nodal(path)
    return np.array(times), np.array(ids, np.int64), values


@checked
def write_nodal(path: str | os.PathLike[str], times: ArrayLike, ids: ArrayLike, values: ArrayLike) -> None:
    """Writes what :func:`read_nodal` reads, with as many digits as bring each number back to the bit."""
    shaped = np.asarray(values, np.float64)
    if shaped.ndim != 3:
        raise InputError(f"values of shape {shaped.shape}, expected (nodes, times, components)")
    _motet.write_nodal(path, np.ravel(times).tolist(), np.ravel(ids).tolist(), shaped)
