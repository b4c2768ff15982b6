"""The loop: a mesh that moves with its walls, step after step, and stays good."""
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
from ._report import Progress, Report, report
from ._words import NotPickled, checked_class
from .errors import OptionsError


@dataclass
class _Asked:
    """What the native handle is told."""

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
    def of(cls, given: Mapping[str, Any]) -> _Asked:
        """By the words of a call that has them all."""
        return cls(**{field.name: given[field.name] for field in fields(cls)})

    def __post_init__(self) -> None:
        if self.rigid_layer is not None and self.rigid_layer_cells is not None:
            raise OptionsError("rigid_layer is a distance and rigid_layer_cells a number of cells: give one of them")
        for patches in ("bodies", "inside", "slide", "rigid_layer_at", "watch", "hold_names"):
            setattr(self, patches, [str(patch) for patch in several(getattr(self, patches))])
        self.contents, self.carry = list(self.contents), dict(self.carry or {})


@checked_class
class MovingMesh(NotPickled):
    """A mesh that moves with its walls and stays good: moved, certified, repaired, refined, watched, its arrays carried along.

    Displacements are always given for the walls as they came, counted from there, whatever the mesh becomes; what becomes bad is repaired while it still has
    a volume, and maps lead from any step to the present one.

    Parameters
    ----------
    mesh : mesh, path, meshio.Mesh or PyVista data set
    method, within_walls, smooth, rigid_layer, rigid_layer_cells, slide_tolerance : as of :class:`Mover`
    bodies, inside, slide, rigid_layer_at : sequences of names or labels of patches
        ``inside``: patches inside the volume that are driven, such as a flap. The others as of :class:`Mover`.
    strain : "even", "band" or None
        Where the method ``bodies`` puts the strain: over all that lies between a body and the walls that stay (None: even), or in a band beside the body, for bodies that keep moving.
    repair : bool
        Whether bad tets are repaired; if not, a step ends where a cell would turn over.
    min_eas, surface, distance : as of :func:`remesh`
    hold_names : sequence of names or labels of regions and patches
        What repair leaves as it is, as ``hold`` of :func:`remesh`. (``hold`` here is a distance between walls, see ``watch``.)
    margin, floor : float
        Repaired are tets to ``min_eas + margin``; no step takes one that can be repaired below ``floor``.
    improve_below : float
        Where a repair changes the mesh, tets below this EAS are made better, too: those near it, and those that are not as they were at first; and as many vertices inside are kept as
        there were at first. 0: bad tets are repaired, and nothing else is done.
    returns : bool
        Whether the walls come back to where they were at first, again and again. Then what is improved is to be good there, too: otherwise each cycle undoes what the last one did.
        A mesh that still changes in each cycle, and loses, is replaced by the first one when the walls are back: a change whose ``why`` is "return".
        Harmful where walls go on, such as a body that turns.
    valid_at_start : bool
        Whether a repair that brings tets without volume where their vertices were as the step began is made again with the tets that they replace held. See
        ``inverted_at_start`` of a step.
    contents : sequence of names
        Cell arrays that are densities of something that stays in its cell: their integrals are kept while cells move.
    carry : mapping from names to "mean", "linear", "inherit" or "drop"
        What becomes of arrays where the mesh changes.
    watch : sequence of patches
        Their gaps are measured at each step; ``warn``, ``within`` as of :class:`Contact`, ``horizon``: how far ahead is looked, in units of time; ``hold``: walls stop
        at this distance, wherever they are requested to go: each patch gives way to those after it.
    remembered : int
        So many changes are remembered for :meth:`history_since`.
    threads : int
        0 for all cores. The outcome does not depend on it.
    progress : callable
        As of :func:`remesh`, while it is set up.
    """

    _instead = "use save and load, or pickle its mesh"

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
        progress: Progress | None = None,
    ):
        self._native = _motet.MovingMesh(as_mesh(mesh), _Asked.of(locals()), threads, progress)
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
        """Goes on from what :meth:`save` wrote, with the same options, to the same bytes. What changed before is not in it: see :meth:`history_since`.

        Raises
        ------
        OptionsError
            When options differ from those that it was saved with; ``remembered`` may. The message names them.
        """
        moving = cls.__new__(cls)
        moving._native, moving._mesh = _motet.MovingMesh.load(path, _Asked.of(locals()), threads), None
        return moving

    def save(self, path: str | PathLike[str]) -> None:
        """Writes all that the next steps depend on, as a .vtu that ParaView opens."""
        self._native.save(path)

    def __repr__(self) -> str:
        return f"motet.MovingMesh: step {self.step}, time {self.time:.6g}; {self.mesh!r}"

    @property
    def driven_places(self) -> NDArray[np.float64]:
        """(k, 3): where the driven vertices were at first. Displacements have a row for each of these."""
        return self._native.driven_places

    @property
    def mesh(self) -> Mesh:
        """The mesh as it is, with its arrays."""
        if self._mesh is None:
            self._mesh = Mesh._of(self._native.mesh())
        return self._mesh

    @property
    def points(self) -> NDArray[np.float64]:
        """(n, 3): where its vertices are."""
        return self._native.points()

    @property
    def velocity(self) -> NDArray[np.float64]:
        """(n, 3): the velocity of each vertex in the last step."""
        return self._native.velocity()

    @property
    def displacement(self) -> NDArray[np.float64]:
        """(n, 3): how far each vertex is from where it was at first."""
        return self._native.displacement()

    @property
    def time(self) -> float:
        """The time that was reached."""
        return self._native.time

    @property
    def step(self) -> int:
        """How many steps were made."""
        return self._native.step

    def set_array(self, name: str, array: ArrayLike, *, on: str) -> None:
        """Puts an array on the mesh, ``on`` its "points" or "cells", in place of one of that name; it is carried where the mesh changes."""
        self._native.set_array(name, np.asarray(array), on)
        self._mesh = None

    def advance(self, time: float, displacement: ArrayLike, *, progress: Progress | None = None) -> Report:
        """Takes the walls to where they are at ``time``.

        Parameters
        ----------
        time : float
            After :attr:`time`.
        displacement : array (k, 3)
            Of each of :attr:`driven_places`, counted from there.

        Returns
        -------
        Report
            ``complete``, ``fraction``, ``bad``, ``inverted``, ``worst``, ``changes`` (each with its time), ``gaps``, ``seconds``.
        """
        self._mesh = None
        return report(self._native.advance(time, np.ascontiguousarray(displacement, np.float64), progress))

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
        """Divides tets and takes divisions back, by the criteria of :func:`refine`; what changed, in order."""
        criteria = _criteria(
            everything=everything, near=near, near_size=near_size, box=box, ball=ball, region=region, patch=patch, size=size, where=where,
            gradient=gradient, vorticity=vorticity, q=q, jump=jump, recovery=recovery, hessian=hessian, smallest=smallest,
        )  # fmt: skip
        self._mesh = None
        return [report(change) for change in self._native.refine(criteria, generations, coarsen)]

    def coarsen(self, *, smallest: float = 0.0) -> Report | None:
        """Takes back by lengths what ``refine`` cannot, since repairs have changed what was divided; None where nothing changed.

        Edges are collapsed that are shorter than about a third of what they were there at first, and of the gap beside them where patches are watched; no
        gap asks for less than ``smallest``. Vertices that walls had at first stay.
        """
        self._mesh = None
        change = self._native.coarsen(smallest)
        return None if change is None else report(change)

    def repair(self) -> Report | None:
        """Repairs what is bad where the mesh is: of one that came, or was refined. A step does so by itself."""
        self._mesh = None
        change = self._native.repair()
        return None if change is None else report(change)

    def remembers(self, step: int) -> bool:
        """Whether all changes since a step are known."""
        return self._native.remembers(step)

    def history_since(self, step: int) -> History | None:
        """From the mesh after ``step`` (0: the first) to the present one: carries arrays of any time level in between. None where nothing changed.

        Raises
        ------
        OptionsError
            When changes since ``step`` are not known: those before a state that was loaded, and those before the last ``remembered``. See :meth:`remembers`.
        """
        found = self._native.history_since(step)
        return None if found is None else History(found)
