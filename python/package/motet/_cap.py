"""Open rims of surfaces closed by caps."""
from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from typing import Any, overload

import numpy as np

from . import _motet
from ._mesh import Mesh, MeshLike, as_mesh, read
from ._series import read_series
from ._words import checked
from .errors import InputError


@overload
def cap(surfaces: str | os.PathLike[str]) -> Any: ...
@overload
def cap(surfaces: Mesh) -> Mesh: ...
@overload
def cap(surfaces: Sequence[MeshLike]) -> list[Mesh]: ...
@overload
def cap(surfaces: Any) -> Any: ...
@checked
def cap(surfaces: Any) -> Any:
    """Closes the open rims of a surface, or of every frame of one that moves; as ``motet cap``.

    Each rim gets a cap of triangles about as long as the rim's edges: a patch ``cap_1``, ``cap_2``, .., the longest rim first. Triangles without a patch
    become the patch ``wall``. Points of the surface come first and stay to the bit. The caps of all frames have the same triangles, and follow the rims.

    Parameters
    ----------
    surfaces : a surface; a sequence of frames; or the path of a series (``.pvd``)
        A surface is a mesh, path, meshio.Mesh or PyVista data set. All frames have the same points in the same order; those after the first may be arrays
        (n, 3) of their points alone.

    Returns
    -------
    Mesh
        The closed surface; of a sequence a list with the closed frames, of a series a list of pairs: the time and the closed frame.

    Raises
    ------
    InputError
        There is no open rim, rims touch, or a frame has another number of points.
    """
    if isinstance(surfaces, (str, os.PathLike)) and _motet.is_series(surfaces):
        times = read_series(surfaces)
        return list(zip([time for time, _ in times], _closed(read(file) for _, file in times)))
    if isinstance(surfaces, (list, tuple)):
        return _closed(surfaces)
    return _closed([surfaces])[0]


def _closed(frames: Iterable[Any]) -> list[Mesh]:
    caps, first, closed = None, None, []
    for given in frames:
        if isinstance(given, np.ndarray):
            if first is None:
                raise InputError("the first frame is an array of points alone: give it as a surface, with its triangles")
            frame = first.copy()
            frame.points = given
            if frame.n_points != first.n_points:
                raise InputError(f"a frame of {frame.n_points} points, the first one has {first.n_points}")
        else:
            frame = as_mesh(given)
        if caps is None:
            caps, first = _motet.Caps(frame), frame
        closed.append(Mesh._of(caps.close(frame)))
    if not closed:
        raise InputError("no frames to cap")
    return closed
