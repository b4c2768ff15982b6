"""Data over time: series of meshes, and values at nodes."""
from __future__ import annotations

import os

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _motet
from ._mesh import MeshLike, as_mesh
from ._keywords import NotPickled, checked, checked_class
from .errors import InputError


@checked
def read_series(path: str | os.PathLike[str]) -> list[tuple[float, str]]:
    """Read the times and file names of a series of meshes.

    Parameters
    ----------
    path : path-like
        A ``.pvd`` file.

    Returns
    -------
    list of (float, str)
        Time and file name of each mesh.
    """
    return _motet.read_series(path)


@checked_class
class SeriesWriter(NotPickled):
    """Writes meshes over time as a series that ParaView can play.

    The series is a ``.pvd`` file and one ``.vtu`` file per time. Points and cells may differ between times.
    The series on disk is complete after each :meth:`add`; there is nothing to close. Can be used as a context
    manager.

    Parameters
    ----------
    path : path-like
        Name of the ``.pvd`` file.
    """

    _instead = "read the written series with motet.read_series"

    def __init__(self, path: str | os.PathLike[str]):
        self._native = _motet.SeriesWriter(path)
        self._path, self._n = os.fspath(path), 0

    def add(self, time: float, mesh: MeshLike, *, threads: int = 0) -> str:
        """Write a mesh and add it to the series.

        Parameters
        ----------
        time : float
            Time of the mesh.
        mesh : MeshLike
            A :class:`Mesh`, file path, ``meshio.Mesh`` or PyVista data set.
        threads : int, default 0
            Number of threads; 0 uses all cores. The file does not depend on it.

        Returns
        -------
        str
            Name of the file with the mesh.
        """
        file, _ = self._native.add(time, as_mesh(mesh), threads)
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
    """Read values at nodes over time, such as displacements of a wall, from a file of svMultiPhysics.

    The format is the text format "temporal and spatial values".

    Parameters
    ----------
    path : path-like
        Name of the file.

    Returns
    -------
    times : float64 array, shape (t,)
        Times, ascending.
    ids : int64 array, shape (n,)
        ``GlobalNodeID`` of each node, or its number in the mesh, starting at 1.
    values : float64 array, shape (n, t, c)
        Values by node, time and component.
    """
    times, ids, values = _motet.read_nodal(path)
    return np.array(times), np.array(ids, np.int64), values


@checked
def write_nodal(path: str | os.PathLike[str], times: ArrayLike, ids: ArrayLike, values: ArrayLike) -> None:
    """Write values at nodes over time in the format that :func:`read_nodal` reads.

    Numbers have enough digits to be read back exactly.

    Parameters
    ----------
    path : path-like
        Name of the file.
    times : array_like, shape (t,)
        Times, ascending.
    ids : array_like of int, shape (n,)
        ``GlobalNodeID`` of each node, or its number in the mesh, starting at 1.
    values : array_like, shape (n, t, c)
        Values by node, time and component.
    """
    shaped = np.asarray(values, np.float64)
    if shaped.ndim != 3:
        raise InputError(f"values of shape {shaped.shape}, expected (nodes, times, components)")
    _motet.write_nodal(path, np.ravel(times).tolist(), np.ravel(ids).tolist(), shaped)
