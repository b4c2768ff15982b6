"""Closing the open rims of surfaces with caps."""
from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Literal, overload

import numpy as np
from numpy.typing import ArrayLike

from . import _motet
from ._mesh import Mesh, MeshLike, as_mesh, point, read
from ._series import read_series
from ._keywords import checked
from .errors import InputError


Inlet = Literal["largest"] | ArrayLike


@overload
def cap(surfaces: str | os.PathLike[str], *, inlet: Inlet | None = ..., extend: float | Mapping[str, float] | None = ...) -> Any: ...
@overload
def cap(surfaces: Mesh, *, inlet: Inlet | None = ..., extend: float | Mapping[str, float] | None = ...) -> Mesh: ...
@overload
def cap(surfaces: Sequence[MeshLike], *, inlet: Inlet | None = ..., extend: float | Mapping[str, float] | None = ...) -> list[Mesh]: ...
@overload
def cap(surfaces: Any, *, inlet: Inlet | None = ..., extend: float | Mapping[str, float] | None = ...) -> Any: ...
@checked
def cap(surfaces: Any, *, inlet: Any = None, extend: float | Mapping[str, float] | None = None) -> Any:
    """Close the open rims of a surface, or of every frame of a moving surface.

    Each rim is closed by a cap of triangles about as large as the edges of the rim. The caps are patches
    ``cap_1``, ``cap_2``, ..., starting at the longest rim. Triangles without a patch form the patch ``wall``.
    The points of the surface come first and keep their exact coordinates. The caps of all frames have the
    same triangles and follow the rims. Equivalent to ``motet cap`` on the command line.

    Parameters
    ----------
    surfaces : MeshLike, sequence, or path of a series
        A surface (a :class:`Mesh`, file path, ``meshio.Mesh`` or PyVista data set), a sequence of frames, or
        the path of a ``.pvd`` series. All frames must have the same points in the same order. Frames after
        the first may be arrays of points only, shape (n, 3).
    inlet : "largest" or array_like of shape (3,), optional
        Names the ends by size instead: ``inlet`` the largest one, or the one nearest to this place; the others
        ``outlet_1``, ``outlet_2``, ..., by falling size, or ``outlet`` if there is only one.
    extend : float or mapping of str to float, optional
        Length of straight tubes that continue the vessel beyond its open ends, in units of the surface, or one
        length for each of some ends, by the names of their caps. Cross-sections become circles of the same area.

    Returns
    -------
    Mesh, list of Mesh, or list of (float, Mesh)
        The closed surface. For a sequence, the list of closed frames; for a series, the list of pairs of time
        and closed frame.

    Raises
    ------
    InputError
        If there is no open rim, if rims touch, if the number of points differs between frames, or if an
        extension meets the surface.
    OptionsError
        If an end does not exist.
    """
    if isinstance(surfaces, (str, os.PathLike)) and _motet.is_series(surfaces):
        times = read_series(surfaces)
        return list(zip([time for time, _ in times], _closed((read(file) for _, file in times), inlet, extend)))
    if isinstance(surfaces, (list, tuple)):
        return _closed(surfaces, inlet, extend)
    return _closed([surfaces], inlet, extend)[0]


def _closed(frames: Iterable[Any], inlet: Any, extend: float | Mapping[str, float] | None) -> list[Mesh]:
    if inlet is not None:
        inlet = (None,) if isinstance(inlet, str) and inlet == "largest" else (point(inlet),)
    lengths: list[tuple[str | None, float]] = []
    if isinstance(extend, Mapping):
        lengths.extend(extend.items())
    elif extend is not None:
        lengths.append((None, extend))
    caps, first, closed = None, None, []
    for given in frames:
        if isinstance(given, np.ndarray):
            if first is None:
                raise InputError("the first frame is an array of points: pass a surface with triangles")
            frame = first.copy()
            frame.points = given
            if frame.n_points != first.n_points:
                raise InputError(f"a frame has {frame.n_points} points, but the first frame has {first.n_points}")
        else:
            frame = as_mesh(given)
        if caps is None:
            caps, first = _motet.Caps(frame, inlet, lengths), frame
        closed.append(Mesh._of(caps.close(frame)))
    if not closed:
        raise InputError("no frames to cap")
    return closed
