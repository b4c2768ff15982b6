"""Adaptive refinement: tets divided where it matters, taken back where it does not."""
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
from ._report import Progress, Report, report
from ._words import checked, checked_class


@dataclass
class _Asked:
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
    progress: Progress | None = None,
) -> Changed:
    """Divides whole tets, many generations deep, without loss of shape; and takes divisions back.

    Several criteria mark what any of them does. The mesh remembers in arrays ``refine_*`` what was divided, so that a later call goes on.

    Parameters
    ----------
    mesh : mesh, path, meshio.Mesh or PyVista data set
    everything : bool
    near : sequence of (surface, distance)
        Tets so near to a surface.
    near_size : sequence of (surface, h) or (surface, h, growth)
        Until no edge is longer than ``h`` at a surface, and ``growth`` (0.5) more per unit of distance from it.
    box, ball : sequences of (low, high) and of (centre, radius)
    region, patch : sequences of names or labels; a patch also with a distance
    size : float or name of an array
        Until no edge is longer.
    where : sequence of conditions, such as ``"wss>4"``
    gradient, vorticity, q : sequences of ``"ARRAY>VALUE"``
    jump, recovery : mapping from point array to a share of the error (a float), or to a number of tets (an int)
    hessian : mapping from one or more point arrays to an error (a float), a part of their range (``"2%"``), or a number of tets (an int)
    generations : int
        At most so often; once if None, for sizes as often as it takes. Where ``coarsen`` stands alone: so many divisions are taken back.
    limit_generation, smallest, at_most : int, float, int
        No tet is divided more often since the first mesh, none whose parts were shorter, no more than bring the mesh to so many tets.
    coarsen, coarsen_where : bool, sequence of conditions
        Takes divisions back where no criterion marks, or where a condition holds.
    surface : mesh
        The true surface: new points of the boundary are put on it.
    forget : bool
        The mesh as it is counts as the first one.
    progress : callable
        As of :func:`remesh`; it is heard between generations.

    Returns
    -------
    Changed
        ``complete`` says whether all edges are as short as was asked for.
    """
    criteria = _criteria(
        everything=everything, near=near, near_size=near_size, box=box, ball=ball, region=region, patch=patch, size=size, where=where,
        gradient=gradient, vorticity=vorticity, q=q, jump=jump, recovery=recovery, hessian=hessian, smallest=smallest,
    )  # fmt: skip
    if not criteria and not coarsen and not coarsen_where:
        raise OptionsError("nothing says what to divide: give a criterion, such as near_size=[(stent, 0.05)], or coarsen=True")
    asked = _Asked(
        criteria, coarsen, several(coarsen_where), generations, limit_generation, smallest, at_most, None if surface is None else as_mesh(surface),
        dict(carry or {}), forget,
    )  # fmt: skip
    return _changed(_motet.refined(as_mesh(mesh), asked, threads, progress))


def _criteria(smallest: float | None, **words: Any) -> list:
    """What the criteria of :func:`refine` mark, by their names; those that are not given mark nothing."""
    make = _motet.Criterion
    given = ((maker, words[name]) for name, maker in _MAKERS.items() if words.get(name) is not None)
    return [criterion for maker, words in given for criterion in maker(make, words, smallest)]


# In the order in which they are asked.
_MAKERS: dict[str, Callable[[Any, Any, float | None], list]] = {
    "everything": lambda make, given, _: [make.all()] if given else [],
    "near": lambda make, given, _: [make.near(as_mesh(one), distance) for one, distance in given],
    "near_size": lambda make, given, _: [make.near_size(as_mesh(one), h, *(growth or (0.5,))) for one, h, *growth in given],
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


def several(words: Any) -> list:
    if isinstance(words, (str, int)):
        raise OptionsError(f"{words!r} is one, a list is expected: [{words!r}]")
    return list(words)


def _hessian(arrays: str | tuple[str, ...], aim: float | str, smallest: float | None) -> Any:
    names = [arrays] if isinstance(arrays, str) else list(arrays)
    if isinstance(aim, str):
        if not aim.endswith("%"):
            raise OptionsError(f"hessian: {aim!r} means nothing: an error, a part such as '2%', or a number of tets is expected")
        return _motet.Criterion.hessian(names, range_part=float(aim[:-1]) / 100, smallest=smallest)
    if isinstance(aim, (int, np.integer)) and not isinstance(aim, bool):
        return _motet.Criterion.hessian(names, tets=int(aim), smallest=smallest)
    return _motet.Criterion.hessian(names, error=float(aim), smallest=smallest)


@checked_class
class Refinement:
    """A mesh whose tets are divided and taken back, step after step, by marks of the caller's own.

    Each cell that is divided is followed in its place by its parts; points that come are behind all others. The mesh is a function of the first one and of
    what is asked to be divided: taking all back gives the first mesh, to the bit.
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
        """The mesh as it is now, with its arrays carried this far."""
        if self._mesh is None:
            self._mesh = Mesh._of(self._native.mesh(False))
        return self._mesh

    def with_memory(self) -> Mesh:
        """The mesh with arrays ``refine_*`` that remember what was divided: what to save."""
        return Mesh._of(self._native.mesh(True))

    @property
    def generations(self) -> NDArray[np.int16]:
        """How often each cell was divided; -1 for those that are no tets."""
        return self._native.generations()

    def refine(self, cells: ArrayLike, *, carry: Mapping[str, Carry] | None = None) -> tuple[History, Report]:
        """Divides tets into eight, and what has to be so that all fit.

        Parameters
        ----------
        cells : bool array (m,), or ids
            The tets to divide.
        """
        return self._change(cells, False, carry)

    def coarsen(self, cells: ArrayLike, *, carry: Mapping[str, Carry] | None = None) -> tuple[History, Report]:
        """Takes divisions back of which all eight parts are marked."""
        return self._change(cells, True, carry)

    def _change(self, cells: ArrayLike, is_back: bool, carry: Mapping[str, Carry] | None) -> tuple[History, Report]:
        marks = np.asarray(cells)
        if marks.dtype != bool:
            chosen = ids(marks, "cells")
            marks = np.zeros(self.mesh.n_cells, bool)
            if chosen.size and chosen.max() >= len(marks):
                raise InputError(f"cells up to {chosen.max()}, but the mesh has {len(marks)}")
            marks[chosen] = True
        history, told = self._native.change(np.ascontiguousarray(marks), is_back, dict(carry or {}))
        self._mesh = None
        return History(history), report(told)


def _restored(mesh: Mesh, threads: int) -> Refinement:
    return Refinement(mesh, threads=threads)
