"""Mesh motion: boundary displacement in, volume mesh out."""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _motet
from .errors import InputError, OptionsError
from ._mesh import Mesh, MeshLike, as_mesh, ids, point
from ._report import Progress, Report, report
from ._words import NotPickled, checked, checked_class

Patch = Union[str, int, ArrayLike]
"""A patch by its name or label, or facets as an array of vertex ids, a row each."""


@dataclass
class _Asked:
    """What the native mover is told."""

    method: str
    bodies: list
    within_walls: bool
    smooth: int
    also_moved: Any
    rigid_layer: float | None
    rigid_layer_cells: int | None
    rigid_layer_at: list
    slide: list
    slide_tolerance: float
    residual: float
    factor_gib: float
    substeps: int


def _asked(given: Mapping[str, Any]) -> _Asked:
    """What the native mover is told, by the words of a call that has them all."""
    if given["rigid_layer"] is not None and given["rigid_layer_cells"] is not None:
        raise OptionsError("rigid_layer is a distance and rigid_layer_cells a number of cells: give one of them")
    words = {field.name: given[field.name] for field in fields(_Asked)}
    for patches in ("bodies", "rigid_layer_at", "slide"):
        words[patches] = _facets(words[patches])
    if words["also_moved"] is not None:
        words["also_moved"] = ids(words["also_moved"], "also_moved")
    return _Asked(**words)


def _facet(patch: Patch) -> Any:
    if isinstance(patch, (str, int, np.integer)):
        return patch if isinstance(patch, str) else int(patch)
    rows = ids(patch, "facets")
    if rows.ndim != 2 or rows.shape[1] < 3:
        raise InputError(f"facets of shape {rows.shape}, expected a row of three vertices or more for each")
    return rows.ravel(), rows.shape[1]


def _facets(patches: Sequence[Patch]) -> list:
    if isinstance(patches, (str, int)):
        raise OptionsError(f"{patches!r} is one patch, a list of patches is expected: [{patches!r}]")
    return [_facet(patch) for patch in patches]


def _vectors(array: ArrayLike, n: int, what: str) -> NDArray[np.float64]:
    vectors = np.ascontiguousarray(array, np.float64)
    if vectors.shape != (n, 3):
        raise InputError(f"{what} of shape {vectors.shape}, expected ({n}, 3)")
    return vectors


@checked_class
class Mover(NotPickled):
    """Moves the vertices of one mesh after its boundary: set up once, a weighted sum a step.

    The Delaunay graph of the boundary (Liu, Qin, Xia 2006) and what goes past it; a step depends on the displacement alone, never on the steps
    before it, so that a wall that comes back brings every vertex back to the same bits.

    Parameters
    ----------
    mesh : mesh, path, meshio.Mesh or PyVista data set
        Volume cells of any kind.
    method : {"delaunay", "bodies", "guided", "elastic", "laplace", "idw", "rbf"}
        ``delaunay``: weights in the graph of the boundary, the cheapest. ``bodies``: rigid bodies carry along what is round them, for parts that turn
        or shift far. ``guided``: nodes inside with rotations, for walls that bend. The others are there to compare with.
    bodies : sequence of patches
        The rigid bodies of ``method="bodies"``; where none is named, each part of the walls that hangs together is one, but for the outer one. Walls are
        the boundary, and interfaces inside that are moved: what one encloses goes along rigidly.
    within_walls : bool
        Whether the graph keeps within the walls, so that no vertex follows the wall of another lumen or the far side of a flap.
    smooth : int
        Sweeps over the vertices of bad tets after each step.
    also_moved : array of ids
        Vertices inside that are moved, too, such as those of an interface.
    rigid_layer, rigid_layer_cells : float, int
        Vertices so near to the wall, in units of the mesh or in cells, keep their place relative to it.
    rigid_layer_at : sequence of patches
        The wall of the rigid layer, and where ``laplace`` is stiff; all of the boundary that does not slide, if empty.
    slide : sequence of patches
        Flat patches whose vertices slide in their plane, where two planes meet along their line.
    slide_tolerance : float
        How far vertices of such a patch may be off its plane, as a part of its radius; they stay as far off.
    residual : float
        When an iterated linear system (``elastic``, ``laplace``) is solved.
    factor_gib : float
        A factor of that system is kept where it takes no more gibibytes than this.
    substeps : int
        At most so many sub-steps in :meth:`advance`.
    threads : int
        0 for all cores. The outcome does not depend on it.
    progress : callable
        As of :func:`remesh`, while it is set up.

    Raises
    ------
    InputError
        The mesh has no volume cells, or a boundary that spans no space.
    OptionsError
        A patch that is not there, a method that is none.
    """

    _instead = "pickle the mesh and the options, and set another one up"

    def __init__(
        self,
        mesh: MeshLike,
        *,
        method: str = "delaunay",
        bodies: Sequence[Patch] = (),
        within_walls: bool = False,
        smooth: int = 0,
        also_moved: ArrayLike | None = None,
        rigid_layer: float | None = None,
        rigid_layer_cells: int | None = None,
        rigid_layer_at: Sequence[Patch] = (),
        slide: Sequence[Patch] = (),
        slide_tolerance: float = 0.05,
        residual: float = 1e-6,
        factor_gib: float = 0.0,
        substeps: int = 50,
        threads: int = 1,
        progress: Progress | None = None,
    ):
        self._mover = _motet.Mover(as_mesh(mesh), _asked(locals()), threads, progress)
        self._method = method
        self._boundary = self._mover.boundary
        self._reference = self._mover.reference
        self._boundary.flags.writeable = self._reference.flags.writeable = False

    @property
    def boundary(self) -> NDArray[np.uint32]:
        """The vertices that the caller moves, rising: those of the boundary, and ``also_moved``; read-only."""
        return self._boundary

    @property
    def reference(self) -> NDArray[np.float64]:
        """The points of the mesh in its first place, (n, 3); read-only."""
        return self._reference

    @property
    def setup(self) -> Report:
        """What setting up found, and how long it took."""
        return report(self._mover.setup)

    def __repr__(self) -> str:
        return f"motet.Mover: {len(self._reference)} points after {len(self._boundary)} of the boundary, method {self._method}"

    def weights(self, vertex: int) -> tuple[tuple[int, ...], tuple[float, ...]] | None:
        """The four vertices that a vertex follows, and their weights; None where it follows something else."""
        found = self._mover.weights(vertex)
        return found and (tuple(found[0]), tuple(found[1]))

    def step(self, displacement: ArrayLike, out: NDArray[np.float64] | None = None) -> NDArray[np.float64]:
        """Moves the mesh from its first place; nothing is checked.

        Parameters
        ----------
        displacement : array (k, 3)
            Of each vertex of :attr:`boundary`, from its first place. Contiguous float64 is read where it lies, all else is copied.
        out : float64 array (n, 3), contiguous
            Where the points go; a new array if None. It shares no memory with ``displacement``.

        Returns
        -------
        The points, ``out`` itself where it was given.
        """
        given = self._displacement(displacement)
        out = _checked_out(out, self._reference.shape, given)
        self._mover.step(given, out)
        return out

    def advance(self, displacement: ArrayLike, out: NDArray[np.float64] | None = None) -> tuple[NDArray[np.float64], Report]:
        """Moves the mesh there in sub-steps if need be, and certifies what it reached: no cell that was upright at first is inverted.

        Parameters as for :meth:`step`.

        Returns
        -------
        points : array (n, 3)
        certificate : Report
            ``complete``, ``fraction`` of the way that was reached, ``inverted``, ``bad``, ``worst_eas`` with cell and place, ``quality`` of all tets, ``substeps``, ``seconds``; with quadratic cells
            ``worst_curved_jacobian``, the least scaled Jacobian with cell and place.
        """
        given = self._displacement(displacement)
        out = _checked_out(out, self._reference.shape, given)
        certificate = self._mover.advance(given, out)
        return out, report(certificate)

    def _displacement(self, displacement: ArrayLike) -> NDArray[np.float64]:
        return _vectors(displacement, len(self._boundary), "displacement")


@checked_class
class PointMover(NotPickled):
    """Moves any points after nodes by their Delaunay graph, without a mesh: for processes that have a part of it each.

    All give the nodes of the whole boundary, in any order, and their own points. Cells are not known, so nothing is certified.

    Parameters
    ----------
    nodes : array (m, 3)
    points : array (n, 3)
    threads : int
        0 for all cores.

    Raises
    ------
    InputError
        The nodes do not span space.
    """

    _instead = "pickle the nodes and the points, and set another one up"

    def __init__(self, nodes: ArrayLike, points: ArrayLike, *, threads: int = 1):
        self._n_nodes = len(np.asarray(nodes))
        self._n_points = len(np.asarray(points))
        self._native = _motet.PointMover(_vectors(nodes, self._n_nodes, "nodes"), _vectors(points, self._n_points, "points"), threads)

    def __repr__(self) -> str:
        return f"motet.PointMover: {self._n_points} points after {self._n_nodes} nodes"

    @property
    def n_outside(self) -> int:
        """How many points lie outside of the graph: they follow the nearest place of it."""
        return self._native.n_outside

    def step(self, displacement: ArrayLike, out: NDArray[np.float64] | None = None) -> NDArray[np.float64]:
        """Moves the points from their first place; parameters as for :meth:`Mover.step`."""
        given = _vectors(displacement, self._n_nodes, "displacement")
        out = _checked_out(out, (self._n_points, 3), given)
        self._native.step(given, out)
        return out


def _checked_out(out: NDArray[np.float64] | None, shape: tuple[int, ...], given: NDArray[np.float64]) -> NDArray[np.float64]:
    if out is None:
        return np.empty(shape)
    fits = isinstance(out, np.ndarray) and out.dtype == np.float64 and out.shape == shape
    if not fits or not out.flags.c_contiguous or not out.flags.writeable:
        raise InputError(f"out is to be a contiguous, writeable array of float64 of shape {shape}")
    # Both are contiguous: where their bounds overlap, they do.
    if np.may_share_memory(out, given):
        raise InputError("out shares memory with displacement: give it memory of its own, or none")
    return out


@dataclass(repr=False)
class Moved:
    """What a motion came to."""

    mesh: Mesh
    """The mesh where it was reached, with the point array ``displacement``."""
    certificate: Report
    """How far it got, and how good the cells are there."""
    choice: Report | None = None
    """With ``method="auto"``: the method, the bound, and what each method came to."""

    @property
    def complete(self) -> bool:
        """Whether the mesh is where it was asked to be."""
        return self.certificate.complete

    def __repr__(self) -> str:
        return f"motet.Moved: {'complete' if self.complete else f'{100 * self.certificate.fraction:.4g} % of the way'}; {self.mesh!r}"

    @property
    def not_reached(self) -> str | None:
        """Why the mesh is not where it was requested to be; None where it is."""
        return self.certificate.not_reached


Turn = Union[tuple[ArrayLike, float], tuple[ArrayLike, float, ArrayLike]]


@checked
def move(
    mesh: MeshLike,
    *,
    displacement: str | ArrayLike | None = None,
    translate: Mapping[str | int, ArrayLike] | None = None,
    rotate: Mapping[str | int, Turn] | None = None,
    steps: int = 1,
    method: str = "delaunay",
    least: float | None = None,
    bodies: Sequence[Patch] = (),
    within_walls: bool = False,
    smooth: int = 0,
    also_moved: ArrayLike | None = None,
    rigid_layer: float | None = None,
    rigid_layer_cells: int | None = None,
    rigid_layer_at: Sequence[Patch] = (),
    slide: Sequence[Patch] = (),
    slide_tolerance: float = 0.05,
    residual: float = 1e-6,
    factor_gib: float = 0.0,
    substeps: int = 50,
    threads: int = 0,
    progress: Progress | None = None,
) -> Moved:
    """Moves a mesh after its boundary, once. For motion step after step keep a :class:`Mover`.

    Parameters
    ----------
    mesh : mesh, path, meshio.Mesh or PyVista data set
    displacement : str or array
        A point array of the mesh by its name, or an array (n, 3) of all points. Inside, values move the interfaces of
        regions and of labelled facets on which they are not zero; others are not looked at. Boundary vertices of no displacement stay.
    translate : mapping from patch to vector
        A patch may lie inside, such as the surface of a device. Patches that share vertices must move them alike.
    rotate : mapping from patch to (axis, degrees) or (axis, degrees, centre)
        The centre is the middle of the patch where none is given. A patch that turns and shifts turns first.
    steps : int
        In so many equal parts; a turn goes along the arc.
    method : str
        As for :class:`Mover`, or ``auto``: the cheapest that keeps the worst cell at ``least``.
    least : float
        The bound of ``auto``: the EAS that no tet may be below. Half of the worst one that came, at most 0.1, if None.
    bodies, within_walls, smooth, also_moved, rigid_layer, rigid_layer_cells, rigid_layer_at, slide, slide_tolerance, residual, factor_gib, substeps
        As for :class:`Mover`.
    threads : int
        0 for all cores.
    progress : callable
        As of :func:`remesh`.

    Returns
    -------
    Moved
        With the mesh and its certificate. A motion that does not get all the way is no error: see ``complete``.
    """
    given = as_mesh(mesh)
    if steps < 1:
        raise OptionsError(f"{steps} steps, expected 1 or more")
    if displacement is not None and not (translate or rotate):
        displacement = _whole(given, displacement)
        inside = _motet.interface_vertices(given, displacement)
        if len(inside):
            also = [] if also_moved is None else [ids(also_moved, "also_moved")]
            also_moved = np.unique(np.concatenate([inside, *also]))
    told = {**(translate or {}), **(rotate or {})}
    if told:
        also = [] if also_moved is None else [ids(also_moved, "also_moved")]
        also_moved = np.unique(np.concatenate([_motet.patch_vertices(given, _facets(list(told))), *also]))
    auto = method == "auto"
    if least is not None and not auto:
        raise OptionsError("least is a criterion for choosing a method, but the method is given: method='auto'")

    def mover(name: str) -> Mover:
        return Mover(
            given, method=name, bodies=bodies, within_walls=within_walls, smooth=smooth, also_moved=also_moved, rigid_layer=rigid_layer,
            rigid_layer_cells=rigid_layer_cells, rigid_layer_at=rigid_layer_at, slide=slide, slide_tolerance=slide_tolerance, residual=residual,
            factor_gib=factor_gib, substeps=substeps, threads=threads, progress=progress,
        )  # fmt: skip

    first = mover("delaunay" if auto else method)
    frames = _frames(given, first.boundary, displacement, translate, rotate, steps)
    choice = None
    if auto:
        name, bound, tried = _motet.choose(given, _asked({**locals(), "method": "bodies"}), least, frames, threads, progress)
        choice = report({"method": name, "least": bound, "tried": tried})
        if name != "delaunay":
            first = mover(name)
    points = first.reference.copy()
    certificate = Report()
    for k, frame in enumerate(frames):
        if progress is not None:
            progress("moving in steps", k, len(frames))
        points, certificate = first.advance(frame, points)
        if not certificate.complete:
            break
    moved = given.copy()
    moved.points = points
    moved.point_data["displacement"] = points - given.points
    return Moved(moved, certificate, choice)


def _whole(given: Mesh, displacement: str | ArrayLike) -> NDArray[np.float64]:
    if isinstance(displacement, str):
        if displacement not in given.point_data:
            raise OptionsError(f"the mesh has no point array {displacement!r}; it has {', '.join(given.point_data) or 'none'}")
        displacement = given.point_data[displacement]
    return _vectors(displacement, given.n_points, "displacement")


def _frames(given: Mesh, boundary, displacement, translate, rotate, steps) -> list:
    fractions = [k / steps for k in range(1, steps + 1)]
    if displacement is not None:
        if translate or rotate:
            raise OptionsError("displacement says where all goes: leave translate and rotate away")
        whole = _whole(given, displacement)[boundary]
        return [fraction * whole for fraction in fractions]
    if not translate and not rotate:
        raise OptionsError("nothing moves: give displacement, translate or rotate")
    motions: dict[Any, list] = {}
    for patch, (axis, degrees, *centre) in (rotate or {}).items():
        motions.setdefault(patch, []).append((point(axis), float(degrees), point(centre[0]) if centre else None))
    for patch, by in (translate or {}).items():
        motions.setdefault(patch, []).append(point(by))
    return _motet.prescribed(given, boundary, list(motions.items()), fractions)


@checked
def mesh_velocity(before: ArrayLike, points: ArrayLike, dt: float) -> NDArray[np.float64]:
    """The velocity of each point, (n, 3), by backward difference over a time."""
    before = np.ascontiguousarray(before, np.float64)
    return _motet.mesh_velocity(before, _vectors(points, len(before), "points"), dt)
