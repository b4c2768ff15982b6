"""The time loop: a mesh that follows its walls step by step and keeps its quality."""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from os import PathLike
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _motet
from ._changing import Carry, History
from ._mesh import Mesh, MeshLike, as_mesh
from ._refinement import _criteria, several
from ._progress import Progress
from ._report import Report, report
from ._keywords import NotPickled, checked_class
from .errors import OptionsError


@dataclass
class _Request:
    """Options of a moving mesh for the native module."""

    method: str
    bodies: Sequence[str | int]
    strain: str | None
    within_walls: bool
    smooth: int
    inside: Sequence[str | int]
    slide: Sequence[str | int]
    slide_tolerance: float
    rigid_layer: float | None
    rigid_layer_cells: int | None
    rigid_layer_at: Sequence[str | int]
    repair: bool
    min_eas: float
    surface: str
    distance: float | None
    hold_names: Sequence[str | int]
    margin: float
    floor: float
    improve_below: float
    returns: bool
    valid_at_start: bool
    contents: Sequence[str]
    carry: Mapping[str, Carry] | None
    watch: Sequence[str | int]
    warn: float | None
    within: float
    horizon: float | None
    hold: float | None
    remembered: int

    @classmethod
    def of(cls, given: Mapping[str, Any]) -> _Request:
        """Return the options from the keywords of a call, which must include all of them."""
        return cls(**{field.name: given[field.name] for field in fields(cls)})

    def __post_init__(self) -> None:
        if self.rigid_layer is not None and self.rigid_layer_cells is not None:
            raise OptionsError("rigid_layer is a distance and rigid_layer_cells a number of cells: give one of them")
        for patches in ("bodies", "inside", "slide", "rigid_layer_at", "watch", "hold_names"):
            setattr(self, patches, [str(patch) for patch in several(getattr(self, patches))])
        self.contents, self.carry = list(self.contents), dict(self.carry or {})


@checked_class
class MovingMesh(NotPickled):
    """A mesh that follows its walls and keeps its quality.

    In each step the mesh is moved, checked and repaired, and its arrays are transferred; it can also be
    refined, and gaps between patches can be watched. Displacements always refer to the walls of the initial
    mesh, no matter how the mesh has changed since. Bad tets are repaired while they still have positive
    volume. :meth:`history_since` transfers arrays from any earlier step to the current mesh.

    Parameters
    ----------
    mesh : MeshLike
        Initial mesh: a :class:`Mesh`, file path, ``meshio.Mesh`` or PyVista data set.
    method : str, default "delaunay"
        How interior vertices follow the walls; see :class:`Mover`.
    bodies : sequence of str or int, optional
        Names or labels of the patches that are rigid bodies; see :class:`Mover`.
    strain : {"even", "band"}, optional
        Where the method ``bodies`` puts the strain: over all that lies between a body and the walls that stay,
        or in a band beside the body, for bodies that keep moving. Default: even.
    within_walls : bool, default False
        Whether vertices follow only walls that they can reach; see :class:`Mover`.
    smooth : int, default 0
        Number of smoothing sweeps over the vertices of bad tets after each step.
    inside : sequence of str or int, optional
        Names or labels of driven patches in the interior, such as a flap.
    slide : sequence of str or int, optional
        Names or labels of flat patches whose vertices slide in their plane; see :class:`Mover`.
    slide_tolerance : float, default 0.05
        How far vertices of a sliding patch may be off its plane, as a fraction of its radius.
    rigid_layer : float, optional
        Vertices within this distance of the wall, in units of the mesh, keep their position relative to it.
    rigid_layer_cells : int, optional
        Thickness of that layer in cells, instead of `rigid_layer`.
    rigid_layer_at : sequence of str or int, optional
        Names or labels of the patches of that wall. Default: all of the boundary that does not slide.
    repair : bool, default True
        Whether bad tets are repaired. If False, a step stops before a cell would be inverted.
    min_eas : float, default 0.2
        Tets with an equi-angle quality (EAS) below this are bad.
    surface : {"keep", "adapt", "loose"}, default "keep"
        What repair may do to walls; see :func:`remesh`.
    distance : float, optional
        How far walls may deviate, in units of the mesh; see :func:`remesh`.
    hold_names : sequence of str or int, optional
        Names or labels of regions and patches that repair leaves unchanged: the parameter ``hold`` of
        :func:`remesh`. (Here `hold` is a distance.)
    margin : float, default 0.05
        Repaired tets are improved to an EAS of ``min_eas + margin``.
    floor : float, default 0.05
        Tets are repaired during a step before their EAS falls below this, if they can be.
    improve_below : float, default 0.75
        Where a repair changes the mesh, tets below this EAS are improved as well: those near the change, and
        those that have deteriorated since the start. The number of interior vertices is kept. With 0 only bad
        tets are repaired.
    returns : bool, default False
        Whether the walls return to their initial position periodically. Tets are then improved for that
        position as well, so that a cycle does not undo the improvements of the previous one. A mesh that
        still changes in every cycle and loses quality is replaced by the initial mesh when the walls return;
        the ``why`` of this change is ``"return"``. Harmful if walls do not return, such as for a rotating
        body.
    valid_at_start : bool, default False
        Whether a repair is repeated if new tets have no positive volume at the positions that their vertices
        had at the beginning of the step; the tets that they replace are then held. See
        ``inverted_at_start`` in the report of :meth:`advance`.
    contents : sequence of str, optional
        Names of cell arrays that are densities of a quantity that stays in its cell: their integrals are
        preserved while cells move.
    carry : mapping of str to {"mean", "linear", "inherit", "drop"}, optional
        How to transfer each named array where the mesh changes; see :meth:`History.transfer`. ``"drop"``
        removes the array.
    watch : sequence of str or int, optional
        Names or labels of patches whose gaps are measured in each step.
    warn : float, optional
        Gaps of watched patches below this distance give a warning.
    within : float, default inf
        Search range for gaps; larger gaps are infinite.
    horizon : float, optional
        Time span for which contact is predicted. Default: the duration of the last step.
    hold : float, optional
        Watched patches are stopped at this distance from each other; each gives way to those that follow it
        in `watch`. By default a step ends where walls meet.
    remembered : int, default 64
        Number of changes remembered for :meth:`history_since`.
    threads : int, default 0
        Number of threads; 0 uses all cores. The result does not depend on it.
    progress : callable or True, optional
        True shows a bar for each stage (by tqdm, if it is installed). A function is called
        during the set-up as ``progress(stage, done, total)`` several times per second; ``total`` is 0
        if unknown. An exception that it raises, or Ctrl-C, ends the call.
    """

    _instead = "use its method copy, save and load, or pickle its mesh"

    def __init__(
        self,
        mesh: MeshLike,
        *,
        method: str = "delaunay",
        bodies: Sequence[str | int] = (),
        strain: Literal["even", "band"] | None = None,
        within_walls: bool = False,
        smooth: int = 0,
        inside: Sequence[str | int] = (),
        slide: Sequence[str | int] = (),
        slide_tolerance: float = 0.05,
        rigid_layer: float | None = None,
        rigid_layer_cells: int | None = None,
        rigid_layer_at: Sequence[str | int] = (),
        repair: bool = True,
        min_eas: float = 0.2,
        surface: Literal["keep", "adapt", "loose"] = "keep",
        distance: float | None = None,
        hold_names: Sequence[str | int] = (),
        margin: float = 0.05,
        floor: float = 0.05,
        improve_below: float = 0.75,
        returns: bool = False,
        valid_at_start: bool = False,
        contents: Sequence[str] = (),
        carry: Mapping[str, Carry] | None = None,
        watch: Sequence[str | int] = (),
        warn: float | None = None,
        within: float = float("inf"),
        horizon: float | None = None,
        hold: float | None = None,
        remembered: int = 64,
        threads: int = 0,
        progress: Progress | bool | None = None,
    ):
        self._native = _motet.MovingMesh(as_mesh(mesh), _Request.of(locals()), threads, progress)
        self._mesh: Mesh | None = None

    @classmethod
    def load(
        cls,
        path: str | PathLike[str],
        *,
        method: str = "delaunay",
        bodies: Sequence[str | int] = (),
        strain: Literal["even", "band"] | None = None,
        within_walls: bool = False,
        smooth: int = 0,
        inside: Sequence[str | int] = (),
        slide: Sequence[str | int] = (),
        slide_tolerance: float = 0.05,
        rigid_layer: float | None = None,
        rigid_layer_cells: int | None = None,
        rigid_layer_at: Sequence[str | int] = (),
        repair: bool = True,
        min_eas: float = 0.2,
        surface: Literal["keep", "adapt", "loose"] = "keep",
        distance: float | None = None,
        hold_names: Sequence[str | int] = (),
        margin: float = 0.05,
        floor: float = 0.05,
        improve_below: float = 0.75,
        returns: bool = False,
        valid_at_start: bool = False,
        contents: Sequence[str] = (),
        carry: Mapping[str, Carry] | None = None,
        watch: Sequence[str | int] = (),
        warn: float | None = None,
        within: float = float("inf"),
        horizon: float | None = None,
        hold: float | None = None,
        remembered: int = 64,
        threads: int = 0,
    ) -> MovingMesh:
        """Continue from a state written by :meth:`save`, with identical results.

        Earlier changes are not part of the state; see :meth:`history_since`.

        Parameters
        ----------
        path : path-like
            The file written by :meth:`save`.
        method, bodies, ..., threads
            Options of :class:`MovingMesh`. They must be those of the saved mesh, except `remembered` and
            `threads`.

        Returns
        -------
        MovingMesh

        Raises
        ------
        OptionsError
            If options differ from those of the saved mesh; the message names them.
        """
        moving = cls.__new__(cls)
        moving._native, moving._mesh = _motet.MovingMesh.load(path, _Request.of(locals()), threads), None
        return moving

    def copy(self) -> MovingMesh:
        """Return a copy that continues independently, with identical results.

        A step of an implicit coupling is repeated from a copy made before it.
        """
        moving = type(self).__new__(type(self))
        moving._native, moving._mesh = self._native.copy(), None
        return moving

    def save(self, path: str | PathLike[str]) -> None:
        """Write everything that later steps depend on.

        Parameters
        ----------
        path : path-like
            A ``.vtu`` file, which ParaView can open.
        """
        self._native.save(path)

    def __repr__(self) -> str:
        return f"motet.MovingMesh: step {self.step}, time {self.time:.6g}; {self.mesh!r}"

    @property
    def driven_places(self) -> NDArray[np.float64]:
        """Initial positions of the driven vertices, shape (k, 3); displacements have one row for each."""
        return self._native.driven_places

    @property
    def mesh(self) -> Mesh:
        """The current mesh, with its arrays."""
        if self._mesh is None:
            self._mesh = Mesh._of(self._native.mesh())
        return self._mesh

    @property
    def points(self) -> NDArray[np.float64]:
        """Current positions of the vertices, shape (n, 3)."""
        return self._native.points()

    @property
    def velocity(self) -> NDArray[np.float64]:
        """Velocity of each vertex in the last step, shape (n, 3)."""
        return self._native.velocity()

    @property
    def displacement(self) -> NDArray[np.float64]:
        """Displacement of each vertex from its initial position, shape (n, 3)."""
        return self._native.displacement()

    @property
    def time(self) -> float:
        """The current time."""
        return self._native.time

    @property
    def step(self) -> int:
        """The number of steps done."""
        return self._native.step

    def set_array(self, name: str, array: ArrayLike, *, on: str) -> None:
        """Set an array of the mesh, replacing one of the same name. It is transferred where the mesh changes.

        Parameters
        ----------
        name : str
            Name of the array.
        array : array_like, shape (n, ...)
            Values with one row per point or cell.
        on : {"points", "cells"}
            What the rows of `array` belong to.
        """
        self._native.set_array(name, np.asarray(array), on)
        self._mesh = None

    def advance(self, time: float, displacement: ArrayLike, *, progress: Progress | bool | None = None) -> Report:
        """Move the walls to their positions at `time`; the mesh follows and is repaired where necessary.

        An incomplete motion is not an error: see ``complete`` in the report.

        Parameters
        ----------
        time : float
            The new time, later than :attr:`time`.
        displacement : array_like, shape (k, 3)
            Displacement of each of :attr:`driven_places` from there.
        progress : callable or True, optional
            True shows a bar for each stage (by tqdm, if it is installed). A function is called
            as ``progress(stage, done, total)`` several times per second; ``total`` is 0 if unknown. An
            exception that it raises, or Ctrl-C, ends the call; the mesh is then as before.

        Returns
        -------
        Report
            ``complete``; ``fraction`` of the motion that was completed; ``bad`` and ``inverted``, numbers of
            tets; ``worst`` tet; ``changes`` of the mesh, each with its time; ``gaps``; ``seconds``.
        """
        self._mesh = None
        return report(self._native.advance(time, np.ascontiguousarray(displacement, np.float64), progress))

    def preview(self, displacement: ArrayLike) -> NDArray[np.float64]:
        """Return where the vertices would be with the walls at these displacements, in one part and without repair.

        Nothing changes. This costs the motion alone; tets may be inverted.

        Parameters
        ----------
        displacement : array_like, shape (k, 3)
            Displacement of each of :attr:`driven_places` from there.

        Returns
        -------
        float64 array, shape (n, 3)
        """
        return self._native.preview(np.ascontiguousarray(displacement, np.float64))

    def refine(
        self,
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
        smallest: float | None = None,
        generations: int | None = None,
        coarsen: bool = False,
    ) -> list[Report]:
        """Refine and coarsen tets by criteria. A tet is marked for division if any criterion marks it.

        Parameters
        ----------
        everything : bool, default False
            Mark all tets.
        near : sequence of (MeshLike, float), optional
            Mark tets within a distance of a surface.
        near_size : sequence of (MeshLike, float) or (MeshLike, float, float), optional
            Surface, edge length ``h`` and growth (default 0.5): divide until no edge is longer than ``h`` at
            the surface, and ``h + growth * distance`` away from it.
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
            Mark tets by an error estimate for a point array: gradient jumps or gradient recovery. A float is
            the share of the total error to mark, an int the target number of tets.
        hessian : mapping of str or tuple of str to float, str or int, optional
            Divide by the second derivatives of one or more point arrays. The value is the interpolation error
            to reach (float), the same as a percentage of the range (``"2%"``), or the target number of tets
            (int).
        smallest : float, optional
            Smallest size that `hessian` requests, in units of the mesh.
        generations : int, optional
            Maximum number of divisions in this call. Default: 1, or as many as sizes require.
        coarsen : bool, default False
            Undo divisions where no criterion marks a tet.

        Returns
        -------
        list of Report
            The changes of the mesh, in order.
        """
        criteria = _criteria(
            everything=everything, near=near, near_size=near_size, box=box, ball=ball, region=region, patch=patch, size=size, where=where,
            gradient=gradient, vorticity=vorticity, q=q, jump=jump, recovery=recovery, hessian=hessian, smallest=smallest,
        )  # fmt: skip
        self._mesh = None
        return [report(change) for change in self._native.refine(criteria, generations, coarsen)]

    def coarsen(self, *, smallest: float = 0.0) -> Report | None:
        """Coarsen by edge length where :meth:`refine` cannot, because repairs have changed divided tets.

        Edges are collapsed if they are shorter than about a third of the initial edge length at that place
        and, where patches are watched, of the gap beside them. The initial vertices of walls are kept.

        Parameters
        ----------
        smallest : float, default 0.0
            Smallest edge length that a gap can require, in units of the mesh.

        Returns
        -------
        Report or None
            The change; None if nothing changed.
        """
        self._mesh = None
        change = self._native.coarsen(smallest)
        return None if change is None else report(change)

    def repair(self) -> Report | None:
        """Repair bad tets at the current position.

        Each step repairs automatically; an initial or refined mesh may need a repair before the first step.

        Returns
        -------
        Report or None
            The change; None if nothing changed.
        """
        self._mesh = None
        change = self._native.repair()
        return None if change is None else report(change)

    def remembers(self, step: int) -> bool:
        """Return whether all changes since a step are known, so that :meth:`history_since` succeeds.

        Parameters
        ----------
        step : int
            Number of the step; 0 is the initial mesh.
        """
        return self._native.remembers(step)

    def history_since(self, step: int) -> History | None:
        """Return the history from the mesh after a step to the current mesh.

        It transfers arrays of any time level in between.

        Parameters
        ----------
        step : int
            Number of the step; 0 is the initial mesh.

        Returns
        -------
        History or None
            None if the connectivity has not changed.

        Raises
        ------
        OptionsError
            If changes since `step` are not known, because they precede a loaded state or the last
            `remembered` changes. See :meth:`remembers`.
        """
        found = self._native.history_since(step)
        return None if found is None else History(found)
