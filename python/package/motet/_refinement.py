"""Adaptive refinement and coarsening of tets."""
from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _motet
from ._changing import Carry, Changed, History, _changed
from .errors import InputError, OptionsError
from ._mesh import Mesh, MeshLike, as_mesh, ids, point
from ._progress import Progress
from ._report import Report, report
from ._keywords import checked, checked_class


@dataclass
class _Request:
    """Options of :func:`refine` for the native module."""

    criteria: list
    coarsen: bool
    coarsen_where: list
    generations: int | None
    limit_generation: int | None
    smallest: float | None
    at_most: int | None
    surface: Mesh | None
    carry: dict
    forget: bool


@checked
def refine(
    mesh: MeshLike,
    *,
    everything: bool = False,
    near: Sequence[tuple[MeshLike, float]] = (),
    near_size: Sequence[tuple[MeshLike, float] | tuple[MeshLike, float, float]] = (),
    box: Sequence[tuple[ArrayLike, ArrayLike]] = (),
    ball: Sequence[tuple[ArrayLike, float]] = (),
    region: Sequence[str | int] = (),
    patch: Sequence[str | int | tuple[str | int, float]] = (),
    size: float | str | None = None,
    where: Sequence[str] = (),
    gradient: Sequence[str] = (),
    vorticity: Sequence[str] = (),
    q: Sequence[str] = (),
    jump: Mapping[str, float] | None = None,
    recovery: Mapping[str, float] | None = None,
    hessian: Mapping[str | tuple[str, ...], float | str] | None = None,
    generations: int | None = None,
    limit_generation: int | None = None,
    smallest: float | None = None,
    at_most: int | None = None,
    coarsen: bool = False,
    coarsen_where: Sequence[str] = (),
    surface: MeshLike | None = None,
    carry: Mapping[str, Carry] | None = None,
    forget: bool = False,
    threads: int = 0,
    progress: Progress | bool | None = None,
) -> Changed:
    """Refine tets by regular division without loss of quality, and coarsen them again.

    A tet is marked for division if any criterion marks it. The divisions are stored in arrays ``refine_*`` of
    the mesh, so that a later call can continue.

    Parameters
    ----------
    mesh : MeshLike
        Mesh of tets: a :class:`Mesh`, file path, ``meshio.Mesh`` or PyVista data set.
    everything : bool, default False
        Mark all tets.
    near : sequence of (MeshLike, float), optional
        Mark tets within a distance of a surface.
    near_size : sequence of (MeshLike, float) or (MeshLike, float, float), optional
        Surface, edge length ``h`` and growth (default 0.5): divide until no edge is longer than ``h`` at the
        surface, and ``h + growth * distance`` away from it.
    box : sequence of (low, high), optional
        Mark tets whose centre lies in an axis-aligned box, given by two corners.
    ball : sequence of (centre, radius), optional
        Mark tets that are at least partly inside a ball.
    region : sequence of str or int, optional
        Mark tets of regions, given by name or label.
    patch : sequence of str, int or (str or int, float), optional
        Mark tets at patches, given by name or label, or within a distance of them.
    size : float or str, optional
        Divide until no edge is longer than this, or than the values of the named array.
    where : sequence of str, optional
        Mark tets where a condition on an array holds, such as ``"wss>4"``.
    gradient, vorticity, q : sequence of str, optional
        Mark tets where the gradient of an array, or the vorticity or the Q criterion of a velocity array,
        exceeds a threshold: ``"ARRAY>VALUE"``.
    jump, recovery : mapping of str to float or int, optional
        Mark tets by an error estimate for a point array: gradient jumps (Kelly et al. 1983) or gradient
        recovery (Zienkiewicz and Zhu 1987). A float is the share of the total error to mark, an int the
        target number of tets.
    hessian : mapping of str or tuple of str to float, str or int, optional
        Divide by the second derivatives of one or more point arrays. The value is the interpolation error to
        reach (float), the same as a percentage of the range (``"2%"``), or the target number of tets (int).
    generations : int, optional
        Maximum number of divisions in this call. Default: 1, or as many as sizes require. If only `coarsen`
        is given, the number of divisions to undo.
    limit_generation : int, optional
        Maximum number of divisions of a tet since the initial mesh.
    smallest : float, optional
        Do not divide tets whose parts would have a longest edge below this, in units of the mesh.
    at_most : int, optional
        Maximum number of tets; tets that are divided only for conformity are added to it.
    coarsen : bool, default False
        Undo divisions where no criterion marks a tet.
    coarsen_where : sequence of str, optional
        Undo divisions where a condition holds, such as ``"wss<1"``.
    surface : MeshLike, optional
        The exact surface, onto which new boundary points are projected.
    carry : mapping of str to {"mean", "linear", "inherit", "drop"}, optional
        How to transfer each named array where the mesh changes; see :meth:`History.transfer`. ``"drop"``
        removes the array.
    forget : bool, default False
        Discard previous divisions: the given mesh becomes the initial one.
    threads : int, default 0
        Number of threads; 0 uses all cores. The result does not depend on it.
    progress : callable or True, optional
        True shows a bar for each stage (by tqdm, if it is installed). A function is called
        as ``progress(stage, done, total)`` between generations; ``total`` is 0 if unknown. An
        exception that it raises, or Ctrl-C, ends the call.

    Returns
    -------
    Changed
        The new mesh with its history and report; ``complete`` is False if edges are longer than requested.
    """
    criteria = _criteria(
        everything=everything, near=near, near_size=near_size, box=box, ball=ball, region=region, patch=patch, size=size, where=where,
        gradient=gradient, vorticity=vorticity, q=q, jump=jump, recovery=recovery, hessian=hessian, smallest=smallest,
    )  # fmt: skip
    request = _Request(
        criteria, coarsen, several(coarsen_where), generations, limit_generation, smallest, at_most, None if surface is None else as_mesh(surface),
        dict(carry or {}), forget,
    )  # fmt: skip
    return _changed(_motet.refined(as_mesh(mesh), request, threads, progress))


def _criteria(smallest: float | None, **criteria: Any) -> list:
    """Return native criteria for the keywords of :func:`refine` that are given."""
    make = _motet.Criterion
    given = ((maker, criteria[name]) for name, maker in _MAKERS.items() if criteria.get(name) is not None)
    return [criterion for maker, value in given for criterion in maker(make, value, smallest)]


# In the order in which the criteria are evaluated.
_MAKERS: dict[str, Callable[[Any, Any, float | None], list]] = {
    "everything": lambda make, given, _: [make.all()] if given else [],
    "near": lambda make, given, _: [make.near(as_mesh(one), distance) for one, distance in given],
    "near_size": lambda make, given, _: [make.near_size(as_mesh(one), h, *(growth or (None,))) for one, h, *growth in given],
    "box": lambda make, given, _: [make.box(point(low), point(high)) for low, high in given],
    "ball": lambda make, given, _: [make.ball(point(centre), radius) for centre, radius in given],
    "region": lambda make, given, _: [make.region(str(name)) for name in several(given)],
    "patch": lambda make, given, _: [make.patch(str(p[0]), p[1]) if isinstance(p, tuple) else make.patch(str(p), None) for p in several(given)],
    "size": lambda make, given, _: [make.size_array(given) if isinstance(given, str) else make.size(given)],
    "where": lambda make, given, _: [make.where(text) for text in several(given)],
    "gradient": lambda make, given, _: [make.gradient(text) for text in several(given)],
    "vorticity": lambda make, given, _: [make.vorticity(text) for text in several(given)],
    "q": lambda make, given, _: [make.q(text) for text in several(given)],
    "jump": lambda make, given, _: [make.jump(array, amount) for array, amount in given.items()],
    "recovery": lambda make, given, _: [make.recovery(array, amount) for array, amount in given.items()],
    "hessian": lambda make, given, smallest: [_hessian(arrays, aim, smallest) for arrays, aim in given.items()],
}


def several(values: Any) -> list:
    if isinstance(values, (str, int)):
        raise OptionsError(f"{values!r} is a single value, expected a list: [{values!r}]")
    return list(values)


def _hessian(arrays: str | tuple[str, ...], aim: float | str, smallest: float | None) -> Any:
    names = [arrays] if isinstance(arrays, str) else list(arrays)
    if isinstance(aim, str):
        if not aim.endswith("%"):
            raise OptionsError(f"hessian: {aim!r} is not valid: expected an error, a percentage such as '2%', or a number of tets")
        return _motet.Criterion.hessian(names, range_part=float(aim[:-1]) / 100, smallest=smallest)
    if isinstance(aim, (int, np.integer)) and not isinstance(aim, bool):
        return _motet.Criterion.hessian(names, tets=int(aim), smallest=smallest)
    return _motet.Criterion.hessian(names, error=float(aim), smallest=smallest)


@checked_class
class Refinement:
    """A mesh whose tets are refined and coarsened step by step, as marked by the caller.

    The parts of a divided cell take its place in the order of cells; new points are appended. The mesh
    depends only on the initial mesh and on the requested divisions, so undoing all of them restores the
    initial mesh exactly. A refinement can be pickled.

    Parameters
    ----------
    mesh : MeshLike
        Mesh of tets: a :class:`Mesh`, file path, ``meshio.Mesh`` or PyVista data set.
    threads : int, default 0
        Number of threads; 0 uses all cores. The result does not depend on it.
    """

    def __init__(self, mesh: MeshLike, *, threads: int = 0):
        self._native = _motet.Refinement(as_mesh(mesh), threads)
        self._threads = threads
        self._mesh: Mesh | None = None

    def __repr__(self) -> str:
        return f"motet.Refinement: up to {max(0, int(self.generations.max(initial=0)))} generations; {self.mesh!r}"

    def __reduce__(self) -> Any:
        return _restored, (self.with_memory(), self._threads)

    @property
    def mesh(self) -> Mesh:
        """The current mesh, with its transferred arrays."""
        if self._mesh is None:
            self._mesh = Mesh._of(self._native.mesh(False))
        return self._mesh

    def with_memory(self) -> Mesh:
        """Return the mesh with arrays ``refine_*`` that store the divisions.

        Save this mesh to continue the refinement later.

        Returns
        -------
        Mesh
        """
        return Mesh._of(self._native.mesh(True))

    @property
    def generations(self) -> NDArray[np.int16]:
        """Number of divisions that led to each cell, shape (m,); -1 for cells other than tets."""
        return self._native.generations()

    def refine(self, cells: ArrayLike, *, carry: Mapping[str, Carry] | None = None) -> tuple[History, Report]:
        """Divide tets into eight, and others as required for conformity and quality.

        Parameters
        ----------
        cells : bool array of shape (m,), or array_like of int
            The tets to divide, as a mask or as cell ids.
        carry : mapping of str to {"mean", "linear", "inherit", "drop"}, optional
            How to transfer each named array where the mesh changes; see :meth:`History.transfer`.
            ``"drop"`` removes the array.

        Returns
        -------
        history : History
            The history from the previous mesh to the new one.
        report : Report
            Numbers of ``tets``, and of tets that are ``promoted`` (divided without request), ``cut`` (divided
            for conformity) or ``held`` (marked, but left unchanged).
        """
        return self._change(cells, False, carry)

    def coarsen(self, cells: ArrayLike, *, carry: Mapping[str, Carry] | None = None) -> tuple[History, Report]:
        """Undo divisions whose eight parts are all marked.

        Parameters
        ----------
        cells : bool array of shape (m,), or array_like of int
            The tets whose divisions may be undone, as a mask or as cell ids.
        carry : mapping of str to {"mean", "linear", "inherit", "drop"}, optional
            How to transfer each named array where the mesh changes; see :meth:`History.transfer`.
            ``"drop"`` removes the array.

        Returns
        -------
        history : History
            The history from the previous mesh to the new one.
        report : Report
            Numbers of ``tets``, and of tets that are ``promoted`` (divided without request), ``cut`` (divided
            for conformity) or ``held`` (marked, but left unchanged).
        """
        return self._change(cells, True, carry)

    def _change(self, cells: ArrayLike, is_back: bool, carry: Mapping[str, Carry] | None) -> tuple[History, Report]:
        marks = np.asarray(cells)
        if marks.dtype != bool:
            chosen = ids(marks, "cells")
            marks = np.zeros(self.mesh.n_cells, bool)
            if chosen.size and chosen.max() >= len(marks):
                raise InputError(f"cells up to {chosen.max()}, but the mesh has {len(marks)}")
            marks[chosen] = True
        history, reported = self._native.change(np.ascontiguousarray(marks), is_back, dict(carry or {}))
        self._mesh = None
        return History(history), report(reported)


def _restored(mesh: Mesh, threads: int) -> Refinement:
    return Refinement(mesh, threads=threads)
