"""Mesh motion: the volume mesh follows displacements of its boundary."""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _motet
from .errors import InputError, OptionsError
from ._mesh import Mesh, MeshLike, as_mesh, ids, point
from ._progress import Progress
from ._report import Report, report
from ._keywords import NotPickled, checked, checked_class

Patch = Union[str, int, ArrayLike]
"""A patch given by name or label, or by its facets: an array of vertex ids with one row per facet."""


@dataclass
class _Request:
    """Options of a mover for the native module."""

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


def _request(given: Mapping[str, Any]) -> _Request:
    """Return the options of a mover from the keywords of a call, which must include all of them."""
    if given["rigid_layer"] is not None and given["rigid_layer_cells"] is not None:
        raise OptionsError("rigid_layer is a distance and rigid_layer_cells a number of cells: give one of them")
    options = {field.name: given[field.name] for field in fields(_Request)}
    for patches in ("bodies", "rigid_layer_at", "slide"):
        options[patches] = _facets(options[patches])
    if options["also_moved"] is not None:
        options["also_moved"] = ids(options["also_moved"], "also_moved")
    return _Request(**options)


def _facet(patch: Patch) -> Any:
    if isinstance(patch, (str, int, np.integer)):
        return patch if isinstance(patch, str) else int(patch)
    rows = ids(patch, "facets")
    if rows.ndim != 2 or rows.shape[1] < 3:
        raise InputError(f"facets of shape {rows.shape}, expected rows of three vertices or more")
    return rows.ravel(), rows.shape[1]


def _facets(patches: Sequence[Patch]) -> list:
    if isinstance(patches, (str, int)):
        raise OptionsError(f"{patches!r} is a single patch, expected a list of patches: [{patches!r}]")
    return [_facet(patch) for patch in patches]


def _vectors(array: ArrayLike, n: int, what: str) -> NDArray[np.float64]:
    vectors = np.ascontiguousarray(array, np.float64)
    if vectors.shape != (n, 3):
        raise InputError(f"{what} of shape {vectors.shape}, expected ({n}, 3)")
    return vectors


@checked_class
class Mover(NotPickled):
    """Moves the vertices of a mesh so that they follow its boundary.

    The set-up is done once; a step is then a weighted sum, by default in the Delaunay graph of the boundary
    (Liu, Qin, Xia 2006). A step depends only on the displacement and never on previous steps, so a wall that
    returns to its initial position brings every vertex back exactly.

    Parameters
    ----------
    mesh : MeshLike
        Mesh with volume cells of any kind: a :class:`Mesh`, file path, ``meshio.Mesh`` or PyVista data set.
    method : {"delaunay", "bodies", "guided", "elastic", "laplace", "idw", "rbf"}, default "delaunay"
        How interior vertices follow:

        - ``"delaunay"``: by weights in the graph of the boundary; the cheapest.
        - ``"bodies"``: rigid bodies carry along the mesh around them, for large rotations and translations.
        - ``"guided"``: by a graph with interior nodes that rotate, for walls that bend.
        - ``"elastic"``, ``"laplace"``: by linear elasticity or a Laplace equation, one system per step.
        - ``"idw"``, ``"rbf"``: by inverse distance weighting or radial basis functions.

        The last four are provided for comparison.
    bodies : sequence of patches, optional
        The rigid bodies of ``method="bodies"``: names, labels or facet arrays. By default each connected part
        of the walls is a body, except the outermost. Walls are the boundary and interior interfaces that are
        moved; the space that an interface encloses moves along rigidly.
    within_walls : bool, default False
        Whether the graph stays inside the walls, so that no vertex follows the wall of another lumen or the
        far side of a flap.
    smooth : int, default 0
        Number of smoothing sweeps over the vertices of bad tets after each step.
    also_moved : array_like of int, shape (k,), optional
        Ids of interior vertices that are moved as well, such as those of an interface.
    rigid_layer : float, optional
        Vertices within this distance of the wall, in units of the mesh, keep their position relative to it.
    rigid_layer_cells : int, optional
        Thickness of that layer in cells, instead of `rigid_layer`.
    rigid_layer_at : sequence of patches, optional
        The wall of the rigid layer; ``method="laplace"`` is stiff near the same wall. Default: all of the
        boundary that does not slide.
    slide : sequence of patches, optional
        Flat patches whose vertices slide in their plane, and along the line where two such planes meet.
    slide_tolerance : float, default 0.05
        How far vertices of a sliding patch may be off its plane, as a fraction of its radius; they keep that
        distance.
    residual : float, default 1e-6
        Relative residual at which iterative solvers (``"elastic"``, ``"laplace"``) stop.
    factor_gib : float, default 0.0
        Memory limit in GiB for keeping a factorization of the linear system. If the factorization does not
        fit, the system is solved iteratively.
    substeps : int, default 50
        Maximum number of sub-steps in :meth:`advance`.
    threads : int, default 1
        Number of threads; 0 uses all cores. The result does not depend on it.
    progress : callable or True, optional
        True shows a bar for each stage (by tqdm, if it is installed). A function is called
        during the set-up as ``progress(stage, done, total)`` several times per second; ``total`` is 0
        if unknown. An exception that it raises, or Ctrl-C, ends the call.

    Raises
    ------
    InputError
        If the mesh has no volume cells, or its boundary does not span a volume.
    OptionsError
        If a patch or the method does not exist.
    """

    _instead = "pickle the mesh and the options, and create a new Mover from them"

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
        progress: Progress | bool | None = None,
    ):
        self._mover = _motet.Mover(as_mesh(mesh), _request(locals()), threads, progress)
        self._method = method
        self._boundary = self._mover.boundary
        self._reference = self._mover.reference
        self._boundary.flags.writeable = self._reference.flags.writeable = False

    @property
    def boundary(self) -> NDArray[np.uint32]:
        """Ids of the driven vertices, shape (k,), ascending: the boundary and ``also_moved``. Read-only."""
        return self._boundary

    @property
    def reference(self) -> NDArray[np.float64]:
        """The initial points of the mesh, shape (n, 3). Read-only."""
        return self._reference

    @property
    def setup(self) -> Report:
        """Statistics and timings of the set-up."""
        return report(self._mover.setup)

    def __repr__(self) -> str:
        return f"motet.Mover: {len(self._reference)} points after {len(self._boundary)} of the boundary, method {self._method}"

    def weights(self, vertex: int) -> tuple[tuple[int, ...], tuple[float, ...]] | None:
        """Return the four vertices that a vertex follows in the graph, and their weights.

        Parameters
        ----------
        vertex : int
            Id of the vertex.

        Returns
        -------
        (tuple of int, tuple of float) or None
            Vertex ids and weights; None if the vertex does not follow the graph.
        """
        found = self._mover.weights(vertex)
        return found and (tuple(found[0]), tuple(found[1]))

    def step(self, displacement: ArrayLike, out: NDArray[np.float64] | None = None) -> NDArray[np.float64]:
        """Move the mesh from its initial position, without checking the cells.

        Parameters
        ----------
        displacement : array_like, shape (k, 3)
            Displacement of each vertex of :attr:`boundary` from its initial position. A contiguous float64
            array is read in place, others are copied.
        out : float64 array, shape (n, 3), optional
            Contiguous array that receives the points. It must not share memory with `displacement`. By
            default a new array is created.

        Returns
        -------
        float64 array, shape (n, 3)
            The points; `out` itself if given.
        """
        given = self._displacement(displacement)
        out = _checked_out(out, self._reference.shape, given)
        self._mover.step(given, out)
        return out

    def advance(self, displacement: ArrayLike, out: NDArray[np.float64] | None = None) -> tuple[NDArray[np.float64], Report]:
        """Move the mesh in sub-steps if necessary, and certify the quality of the result.

        No cell is inverted unless it was inverted initially.

        Parameters
        ----------
        displacement : array_like, shape (k, 3)
            Displacement of each vertex of :attr:`boundary` from its initial position. A contiguous float64
            array is read in place, others are copied.
        out : float64 array, shape (n, 3), optional
            Contiguous array that receives the points. It must not share memory with `displacement`. By
            default a new array is created.

        Returns
        -------
        points : float64 array, shape (n, 3)
            The points; `out` itself if given.
        certificate : Report
            ``complete``; ``fraction`` of the motion that was reached; ``inverted`` and ``bad``, numbers of
            cells; ``worst_eas`` with cell and position; ``quality`` of all tets; ``substeps``; ``seconds``.
            For quadratic cells also ``worst_curved_jacobian``, the smallest scaled Jacobian, with cell and
            position.
        """
        given = self._displacement(displacement)
        out = _checked_out(out, self._reference.shape, given)
        certificate = self._mover.advance(given, out)
        return out, report(certificate)

    def _displacement(self, displacement: ArrayLike) -> NDArray[np.float64]:
        return _vectors(displacement, len(self._boundary), "displacement")


@checked_class
class PointMover(NotPickled):
    """Moves arbitrary points by the Delaunay graph of a set of nodes, without a mesh.

    Intended for parallel processes that each hold a part of a mesh: every process passes the nodes of the
    whole boundary, in any order, and its own points. Cells are unknown, so quality is not checked.

    Parameters
    ----------
    nodes : array_like, shape (m, 3)
        Initial positions of the nodes.
    points : array_like, shape (n, 3)
        Initial positions of the points.
    threads : int, default 1
        Number of threads; 0 uses all cores. The result does not depend on it.

    Raises
    ------
    InputError
        If the nodes do not span a volume.
    """

    _instead = "pickle the nodes and the points, and create a new PointMover from them"

    def __init__(self, nodes: ArrayLike, points: ArrayLike, *, threads: int = 1):
        self._n_nodes = len(np.asarray(nodes))
        self._n_points = len(np.asarray(points))
        self._native = _motet.PointMover(_vectors(nodes, self._n_nodes, "nodes"), _vectors(points, self._n_points, "points"), threads)

    def __repr__(self) -> str:
        return f"motet.PointMover: {self._n_points} points after {self._n_nodes} nodes"

    @property
    def n_outside(self) -> int:
        """Number of points outside the graph; they follow the nearest point of it."""
        return self._native.n_outside

    def step(self, displacement: ArrayLike, out: NDArray[np.float64] | None = None) -> NDArray[np.float64]:
        """Move the points from their initial positions.

        Parameters
        ----------
        displacement : array_like, shape (m, 3)
            Displacement of each node from its initial position. A contiguous float64 array is read in place,
            others are copied.
        out : float64 array, shape (n, 3), optional
            Contiguous array that receives the points. It must not share memory with `displacement`. By
            default a new array is created.

        Returns
        -------
        float64 array, shape (n, 3)
            The points; `out` itself if given.
        """
        given = _vectors(displacement, self._n_nodes, "displacement")
        out = _checked_out(out, (self._n_points, 3), given)
        self._native.step(given, out)
        return out


def _checked_out(out: NDArray[np.float64] | None, shape: tuple[int, ...], given: NDArray[np.float64]) -> NDArray[np.float64]:
    if out is None:
        return np.empty(shape)
    fits = isinstance(out, np.ndarray) and out.dtype == np.float64 and out.shape == shape
    if not fits or not out.flags.c_contiguous or not out.flags.writeable:
        raise InputError(f"out must be a contiguous, writeable float64 array of shape {shape}")
    # Both arrays are contiguous, so they overlap exactly if their bounds do.
    if np.may_share_memory(out, given):
        raise InputError("out shares memory with displacement: pass a separate array, or None")
    return out


@dataclass(repr=False)
class Moved:
    """The result of a motion.

    Attributes
    ----------
    mesh : Mesh
        The mesh at the position that was reached, with the point array ``displacement``.
    certificate : Report
        How much of the motion was completed, and the quality of the cells; see :meth:`Mover.advance`.
    choice : Report or None
        For ``method="auto"``: the chosen ``method``, the bound ``least``, and the result of each method in
        ``tried``.
    """

    mesh: Mesh
    certificate: Report
    choice: Report | None = None

    @property
    def complete(self) -> bool:
        """Whether the mesh reached the requested position."""
        return self.certificate.complete

    def __repr__(self) -> str:
        return f"motet.Moved: {'complete' if self.complete else f'{100 * self.certificate.fraction:.4g} % of the way'}; {self.mesh!r}"

    @property
    def not_reached(self) -> str | None:
        """Why the mesh did not reach the requested position; None if it did."""
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
    progress: Progress | bool | None = None,
) -> Moved:
    """Move a mesh once so that it follows its boundary. For repeated motion use a :class:`Mover`.

    Parameters
    ----------
    mesh : MeshLike
        Mesh with volume cells of any kind: a :class:`Mesh`, file path, ``meshio.Mesh`` or PyVista data set.
    displacement : str or array_like of shape (n, 3), optional
        Displacement of every point, or the name of a point array with it. In the interior only non-zero
        values on interfaces between regions and on labelled facets are used. Boundary vertices with zero
        displacement stay.
    translate : mapping of str or int to array_like of shape (3,), optional
        Translation vector by patch. A patch may be interior, such as the surface of a device. Patches that
        share vertices must move these equally.
    rotate : mapping of str or int to (axis, degrees) or (axis, degrees, centre), optional
        Rotation by patch. Default centre: the middle of the patch. A patch that is also translated is rotated
        first.
    steps : int, default 1
        Number of equal parts in which the motion is done; rotations follow the arc.
    method : str, default "delaunay"
        A method of :class:`Mover`, or ``"auto"`` for the cheapest that keeps the worst cell at `least`.
    least : float, optional
        For ``method="auto"``: lower bound on the EAS of tets. Default: half of the worst EAS of the mesh, at
        most 0.1.
    bodies, within_walls, smooth, also_moved, rigid_layer, rigid_layer_cells, rigid_layer_at
        Options of :class:`Mover`.
    slide, slide_tolerance, residual, factor_gib, substeps
        Options of :class:`Mover`.
    threads : int, default 0
        Number of threads; 0 uses all cores. The result does not depend on it.
    progress : callable or True, optional
        True shows a bar for each stage (by tqdm, if it is installed). A function is called
        as ``progress(stage, done, total)`` several times per second; ``total`` is 0 if unknown. An
        exception that it raises, or Ctrl-C, ends the call.

    Returns
    -------
    Moved
        The mesh and its certificate. An incomplete motion is not an error: see ``complete``.
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
    prescribed = {**(translate or {}), **(rotate or {})}
    if prescribed:
        also = [] if also_moved is None else [ids(also_moved, "also_moved")]
        also_moved = np.unique(np.concatenate([_motet.patch_vertices(given, _facets(list(prescribed))), *also]))
    auto = method == "auto"
    if least is not None and not auto:
        raise OptionsError("least is an option of method='auto', but another method is given")

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
        name, bound, tried = _motet.choose(given, _request({**locals(), "method": "bodies"}), least, frames, threads, progress)
        choice = report({"method": name, "least": bound, "tried": tried})
        if name != "delaunay":
            first = mover(name)
    points = first.reference.copy()
    certificate = Report()
    for k, frame in enumerate(frames):
        if callable(progress):
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
            raise OptionsError("displacement defines the whole motion: leave out translate and rotate")
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
    """Return the velocity of each point by backward difference.

    Parameters
    ----------
    before : array_like, shape (n, 3)
        Points at the beginning of the step.
    points : array_like, shape (n, 3)
        Points at the end of the step.
    dt : float
        Duration of the step, above 0.

    Returns
    -------
    float64 array, shape (n, 3)
        ``(points - before) / dt``.
    """
    before = np.ascontiguousarray(before, np.float64)
    return _motet.mesh_velocity(before, _vectors(points, len(before), "points"), dt)
