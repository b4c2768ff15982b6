"""Functions that change or create a mesh: repair, implantation of devices, meshing and remeshing of surfaces."""
from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _motet
from ._mesh import Mesh, MeshLike, as_mesh, named, point
from ._progress import Progress
from ._report import Report, report
from ._keywords import checked, checked_class
from .errors import OptionsError

Carry = Literal["mean", "linear", "inherit", "drop"]


@checked_class
class History:
    """The origin of each vertex and cell of a changed mesh, used to transfer arrays from the old mesh.

    A history can be used at any later time, with any array of the old mesh. It can be pickled.
    """

    def __init__(self, native: Any):
        self._native = native

    @property
    def vertex_to_old(self) -> NDArray[np.int64]:
        """The old vertex that each new vertex is an exact copy of, shape (n,); -1 for all others."""
        return _signed(self._native.vertex_to_old)

    @property
    def cell_to_old(self) -> NDArray[np.int64]:
        """The old cell that each new cell is a copy of, shape (m,); -1 for all others."""
        return _signed(self._native.cell_to_old)

    @property
    def vertex_to_main(self) -> NDArray[np.int64]:
        """The old vertex of each new vertex, or the one with the largest share in it, shape (n,)."""
        return _signed(self._native.vertex_to_main)

    @property
    def cell_to_main(self) -> NDArray[np.int64]:
        """The old cell of each new cell, or the one with the largest share in it, shape (m,)."""
        return _signed(self._native.cell_to_main)

    @property
    def ledger(self) -> Report:
        """How well the volumes of old and new tets agree, by region."""
        return report(self._native.ledger)

    def transfer(
        self, array: ArrayLike, *, on: Literal["points", "cells"], rule: Literal["mean", "linear", "inherit"] | None = None, name: str = "array"
    ) -> Any:
        """Transfer an array of the old mesh to the new mesh.

        Values at unchanged vertices and cells are copied exactly.

        Parameters
        ----------
        array : array_like, shape (n, ...)
            Values with one row per point or per cell of the old mesh. A list of strings is allowed.
        on : {"points", "cells"}
            What the rows of `array` belong to.
        rule : {"mean", "linear", "inherit"}, optional
            How values are computed where the mesh changed:

            - ``"mean"``: point values are interpolated, exactly for quadratic fields away from walls, and
              limited to the range of the surrounding values. Cell values are averaged by volume, which
              preserves integrals.
            - ``"linear"``: point values are interpolated linearly in each old tet.
            - ``"inherit"``: the value of the old vertex or cell with the largest share is copied.

            By default, floating-point values use ``"mean"``. Integers, strings and directions (recognised by
            `name` or by their lengths) use ``"inherit"``.
        name : str, default "array"
            Name of the array, used in messages and to recognise directions.

        Returns
        -------
        ndarray or list of str
            The values on the new mesh, one row per point or cell.

        Raises
        ------
        InputError
            If the number of rows does not match the old mesh.
        """
        given = array if isinstance(array, list) else np.asarray(array)
        shape = np.shape(given)[1:]
        new = self._native.transfer(name, given, on, rule)
        return np.reshape(new, (-1, *shape)) if len(shape) > 1 else new

    def then(self, later: History) -> History:
        """Combine this change with a later one that starts from its resulting mesh.

        Parameters
        ----------
        later : History
            The history of the later change.

        Returns
        -------
        History
            The history from the old mesh of this change to the new mesh of `later`.

        Raises
        ------
        InputError
            If `later` does not start from the mesh that this change produced.
        """
        return History(self._native.then(later._native))

    def __repr__(self) -> str:
        return f"motet.History: {self._native!r}"

    def __reduce__(self) -> Any:
        return _restored, (self._native.state(),)


def _restored(state: Any) -> History:
    return History(_motet.History.of_state(state))


def _signed(old: NDArray[np.uint32]) -> NDArray[np.int64]:
    signed = old.astype(np.int64)
    signed[signed == 2**32 - 1] = -1
    return signed


@dataclass(repr=False)
class Changed:
    """The result of a function that changes or creates a mesh.

    Attributes
    ----------
    mesh : Mesh
        The new mesh.
    history : History or None
        The origin of its vertices and cells; None for a mesh created from surfaces.
    report : Report
        Statistics. ``quality`` summarises all tets: EAS (equi-angle quality) as ``worst``, ``p1``, ``p5``
        (percentiles), ``median`` and ``mean``, and the mean of the mean ratios as ``mean_ratio``. It is given
        once for a mesh created from surfaces, for host and result of an implantation, in ``before`` and
        ``after`` of a repair, and in each of the ``steps`` of a refinement.
    not_reached : str or None
        Why the requested result was not reached; None if it was.
    """

    mesh: Mesh
    history: History | None
    report: Report
    not_reached: str | None = None

    @property
    def complete(self) -> bool:
        """Whether the requested result was reached."""
        return self.not_reached is None

    def __repr__(self) -> str:
        return f"motet.Changed: {'complete' if self.complete else 'not complete'}; {self.mesh!r}"


def _changed(native: tuple) -> Changed:
    parts, history, reported, not_reached = native
    return Changed(Mesh._of(parts), History(history), report(reported), not_reached)


@checked
def remesh(
    mesh: MeshLike,
    *,
    min_eas: float = 0.2,
    min_dihedral_deg: float = 0.0,
    goal: Literal["repair", "best"] = "repair",
    surface: Literal["keep", "adapt", "loose"] = "keep",
    distance: float | None = None,
    keep_layers: bool = True,
    hold: Sequence[str | int] = (),
    sizes: float | str | ArrayLike | None = None,
    rounds: int = 20,
    carry: Mapping[str, Carry] | None = None,
    threads: int = 0,
    progress: Progress | bool | None = None,
) -> Changed:
    """Repair the bad tets of a mesh and leave all other tets unchanged (after Moyle and Ventikos 2008).

    Parameters
    ----------
    mesh : MeshLike
        Mesh of tets: a :class:`Mesh`, file path, ``meshio.Mesh`` or PyVista data set.
    min_eas : float, default 0.2
        Tets with an equi-angle quality below this are bad. Range 0 to 1.
    min_dihedral_deg : float, default 0.0
        Tets with a dihedral angle below this, in degrees, are also bad. Range 0 to 70.5.
    goal : {"repair", "best"}, default "repair"
        ``"repair"`` removes bad tets with as few changes as possible; ``"best"`` makes the worst tets
        everywhere as good as possible.
    surface : {"keep", "adapt", "loose"}, default "keep"
        What may happen to boundaries, interfaces and labelled facets. ``"keep"`` leaves them exactly
        unchanged. ``"adapt"`` allows changes within `distance` and keeps features such as creases.
        ``"loose"`` also allows changes of features where nothing else helps.
    distance : float, optional
        How far the surface may deviate, in units of the mesh. Default: 1e-3 of its largest extent.
    keep_layers : bool, default True
        Whether to leave thin tets of boundary layers unchanged.
    hold : sequence of str or int, optional
        Names or labels of regions whose tets, and of patches whose triangles, stay exactly unchanged,
        including their vertices.
    sizes : float, str or array_like of shape (n,), optional
        Target edge length, in units of the mesh: one value, the name of a point array, or one value per
        point. By default edge lengths are not adapted.
    rounds : int, default 20
        Maximum number of passes over the bad tets.
    carry : mapping of str to {"mean", "linear", "inherit", "drop"}, optional
        How to transfer each named array where the mesh changes; see :meth:`History.transfer`. ``"drop"``
        removes the array.
    threads : int, default 0
        Number of threads; 0 uses all cores. The result does not depend on it.
    progress : callable or True, optional
        True shows a bar for each stage (by tqdm, if it is installed). A function is called
        as ``progress(stage, done, total)`` several times per second; ``total`` is 0 if unknown. An
        exception that it raises, or Ctrl-C, ends the call.

    Returns
    -------
    Changed
        The new mesh with its history and report; ``complete`` is False if bad tets remain.
    """
    given = as_mesh(mesh)
    if sizes is not None and not isinstance(sizes, (int, float, str)):
        sizes = np.asarray(sizes, np.float64).ravel().tolist()
    native = _motet.remesh(
        given, min_eas=min_eas, min_dihedral_deg=min_dihedral_deg, goal=goal, surface=surface, distance=distance, keep_layers=keep_layers,
        hold=[str(name) for name in hold], sizes=sizes, rounds=rounds, carry=dict(carry or {}), threads=threads, progress=progress,
    )  # fmt: skip
    return _changed(native)


@checked
def implant(
    host: MeshLike,
    devices: MeshLike | Sequence[MeshLike] | Mapping[str, MeshLike],
    *,
    inside: Literal["own", "fill", "hollow"] = "own",
    interface: Literal["match", "conform"] = "match",
    tolerance: float | None = None,
    outside: Literal["cut", "keep"] = "cut",
    stray: float | None = None,
    adapt: Literal["none", "walls", "all"] = "walls",
    size: float | None = None,
    growth: float = 0.5,
    carve: float = 1.0,
    reach: float = 3.0,
    min_eas: float = 0.2,
    values: Mapping[str, ArrayLike] | None = None,
    carry: Mapping[str, Carry] | None = None,
    threads: int = 0,
    progress: Progress | bool | None = None,
) -> Changed:
    """Insert devices into a mesh of tets and return one conforming mesh.

    The regions and patches of the devices have the names of the devices.

    Parameters
    ----------
    host : MeshLike
        Mesh of tets: a :class:`Mesh`, file path, ``meshio.Mesh`` or PyVista data set.
    devices : MeshLike, sequence of MeshLike, or mapping of str to MeshLike
        Closed surfaces or meshes of tets. Devices without a name are named after their file, or ``device``,
        ``device_2``, ...
    inside : {"own", "fill", "hollow"}, default "own"
        ``"own"`` keeps the tets of devices that have them and fills the others; ``"fill"`` fills all devices
        with new tets; ``"hollow"`` leaves the interior of devices empty.
    interface : {"match", "conform"}, default "match"
        ``"match"`` makes each triangle of a device a facet of the mesh. ``"conform"`` creates a new surface
        within `tolerance`, for devices that touch or cross themselves, have open ends or bad triangles.
    tolerance : float, optional
        For ``interface="conform"``: largest distance between old and new surface, in units of the host.
        Default: a fifth of the radius of a round wire as thick as the device.
    outside : {"cut", "keep"}, default "cut"
        Whether to cut off or keep the parts of devices that lie outside the host.
    stray : float, optional
        How far surfaces may deviate where a device meets a wall, in units of the host. Default: a twentieth
        of the edge length of the device.
    adapt : {"none", "walls", "all"}, default "walls"
        Which part of the host is refined near the devices before the insertion.
    size : float, optional
        Edge length next to the devices where the host is refined, and on new surfaces, in units of the host.
        Default: that of the devices, and what `tolerance` requires.
    growth : float, default 0.5
        Increase of edge length per unit of distance from the devices. Above 0, at most 0.7.
    carve : float, default 1.0
        Host tets closer to a device than this multiple of their edge length are replaced.
    reach : float, default 3.0
        Host tets farther from all devices than this multiple of their edge length stay exactly unchanged.
    min_eas : float, default 0.2
        New tets with an equi-angle quality below this are repaired.
    values : mapping of str to array_like, optional
        Initial value of each named array inside the devices: a number, or one per component. Other arrays
        keep the values of the host.
    carry : mapping of str to {"mean", "linear", "inherit", "drop"}, optional
        How to transfer each named array where the mesh changes; see :meth:`History.transfer`. ``"drop"``
        removes the array.
    threads : int, default 0
        Number of threads; 0 uses all cores. The result does not depend on it.
    progress : callable or True, optional
        True shows a bar for each stage (by tqdm, if it is installed). A function is called
        as ``progress(stage, done, total)`` several times per second; ``total`` is 0 if unknown. An
        exception that it raises, or Ctrl-C, ends the call.

    Returns
    -------
    Changed
        The new mesh with its history and report.
    """
    by_name = named(devices, "device")
    native = _motet.implant(
        as_mesh(host), [(as_mesh(device), name) for name, device in by_name.items()], inside=inside, interface=interface, tolerance=tolerance,
        outside=outside, stray=stray, adapt=adapt, size=size, growth=growth, carve=carve, reach=reach, min_eas=min_eas,
        values={name: np.atleast_1d(np.asarray(value, np.float64)).tolist() for name, value in (values or {}).items()},
        carry=dict(carry or {}), threads=threads, progress=progress,
    )  # fmt: skip
    return _changed(native)


Layers = tuple[int, float, float]
"""Boundary layers: number, thickness of the first, and ratio of each thickness to the previous."""


@dataclass
class _Filling:
    """Options of :func:`mesh` for the native module."""

    size: float | str | None
    surface: str
    distance: float | None
    feature_angle: float
    growth: float | None
    size_array: str | None
    seeds: list
    holes: list
    min_eas: float | None
    layers: list
    keep_prisms: bool
    repair: bool
    cut: bool
    unite: bool
    wrap: float | None
    voids: bool
    merge: float
    hole_edges: int


@checked
def mesh(
    surfaces: MeshLike | Sequence[MeshLike] | Mapping[str, MeshLike],
    *,
    membranes: MeshLike | Sequence[MeshLike] | Mapping[str, MeshLike] = (),
    size: float | Literal["auto"] | None = None,
    surface: Literal["auto", "divide", "keep", "adapt"] = "auto",
    distance: float | None = None,
    feature_angle: float = 40.0,
    growth: float | None = None,
    size_array: str | None = None,
    seeds: Mapping[str, ArrayLike] | None = None,
    holes: Sequence[ArrayLike] = (),
    min_eas: float | None = None,
    layers: Layers | Mapping[str, Layers] | None = None,
    keep_prisms: bool = False,
    repair: bool = False,
    merge: float = 0.0,
    hole_edges: int = 32,
    cut: bool = False,
    unite: bool = False,
    wrap: float | None = None,
    voids: bool = False,
    threads: int = 0,
    progress: Progress | bool | None = None,
) -> Changed:
    """Fill closed surfaces with tets.

    Every triangle becomes a facet of the mesh, unless it is far coarser than `size` and therefore divided, or
    the surface is adapted.

    Parameters
    ----------
    surfaces : MeshLike, sequence of MeshLike, or mapping of str to MeshLike
        Surfaces that are closed, each alone or together with others that end at the same edges. They may be
        nested, adjacent or share triangles; each enclosed space becomes a region.
    membranes : MeshLike, sequence of MeshLike, or mapping of str to MeshLike, optional
        Surfaces that may end inside the others, such as a flap.
    size : float or "auto", optional
        Edge length inside, in units of the surfaces. ``"auto"`` starts from the edge length of the surface
        and grows inwards. By default only points that are required are inserted inside.
    surface : {"auto", "divide", "keep", "adapt"}, default "auto"
        Whether triangles are divided to `size` in their own planes; creases are kept. ``"auto"`` divides
        surfaces of which most triangles are far coarser than `size` or narrow, ``"divide"`` divides all
        surfaces and ``"keep"`` none. ``"adapt"`` replaces the triangles of all surfaces by even ones, within
        `distance`; creases, corners, rims and borders of patches are kept.
    distance : float, optional
        With ``surface="adapt"``: how far the new surface may stray from the given one, and that from the new
        one, in units of the surfaces. Default: a thousandth of their largest extent.
    feature_angle : float, default 40.0
        With ``surface="adapt"``: edges at which triangles meet at more than this angle, in degrees, are creases.
    growth : float, optional
        Increase of edge length per unit of distance from the surface, up to `size`. Above 0, at most 0.7.
        Default: 0.3 if sizes are graded.
    size_array : str, optional
        Name of an array of the surfaces with the edge length there.
    seeds : mapping of str to array_like of shape (3,), optional
        Names for regions, each with the coordinates of a point inside the region.
    holes : sequence of array_like of shape (3,), optional
        Points inside spaces to leave empty.
    min_eas : float, optional
        Tets with an equi-angle quality below this are repaired. Default: 0.2 if sizes are given, otherwise
        no repair.
    layers : (int, float, float) or mapping of str to (int, float, float), optional
        Boundary layers: their number, the thickness of the first in units of the surfaces, and the ratio of
        each thickness to the previous. A mapping gives them by patch.
    keep_prisms : bool, default False
        Whether boundary layers remain wedges and pyramids instead of being divided into tets.
    repair : bool, default False
        Whether to repair the surfaces first: vertices on edges (T-junctions), overlapping faces, duplicates,
        orientation, points closer than `merge`, and small holes.
    merge : float, default 0.0
        With `repair`: merge points closer than this, in units of the surfaces.
    hole_edges : int, default 32
        With `repair`: close holes of at most this many edges.
    cut : bool, default False
        Whether to divide surfaces where they cross or touch; each space between them becomes a region.
    unite : bool, default False
        Whether bodies that cross, touch or lie on each other become one, without what lies inside; voids, which
        face inward, stay. Not with `cut`.
    wrap : float, optional
        Replace the surfaces by a closed one within this distance around what they enclose, as winding numbers
        tell: they may be open, torn, double, and cross. Walls and gaps thinner than the distance may be lost.
        Not with `cut` or `unite`.
    voids : bool, default False
        Whether to leave empty what is enclosed by closed surfaces that are turned inward.
    threads : int, default 0
        Number of threads; 0 uses all cores. The result does not depend on it.
    progress : callable or True, optional
        True shows a bar for each stage (by tqdm, if it is installed). A function is called
        as ``progress(stage, done, total)`` several times per second; ``total`` is 0 if unknown. An
        exception that it raises, or Ctrl-C, ends the call.

    Returns
    -------
    Changed
        The new mesh and its report; ``history`` is None.

    Raises
    ------
    InputError
        If a surface cannot be filled; the message gives the first fault and its position.
    """
    given = [(as_mesh(one), name, False) for name, one in named(surfaces, "surface").items()]
    given += [(as_mesh(one), name, True) for name, one in named(membranes, "membrane").items()]
    request = _Filling(
        size=size, surface=surface, distance=distance, feature_angle=feature_angle, growth=growth, size_array=size_array,
        seeds=[(point(place), name) for name, place in (seeds or {}).items()], holes=[point(place) for place in holes], min_eas=min_eas,
        layers=list(layers.items()) if isinstance(layers, Mapping) else [] if layers is None else [(None, layers)],
        keep_prisms=keep_prisms, repair=repair, cut=cut, unite=unite, wrap=wrap, voids=voids, merge=merge,
        hole_edges=hole_edges,
    )  # fmt: skip
    parts, reported, not_reached = _motet.mesh(given, request, threads, progress)
    return Changed(Mesh._of(parts), None, report(reported), not_reached)


@checked
def surface(
    surface: MeshLike,
    *,
    size: float | Literal["auto"] | None = None,
    distance: float | None = None,
    feature_angle: float = 40.0,
    growth: float | None = None,
    size_array: str | None = None,
    clip: Sequence[ArrayLike] = (),
    repair: bool = False,
    unite: bool = False,
    wrap: float | None = None,
    merge: float = 0.0,
    hole_edges: int = 0,
    smooth: int = 0,
    tubes: float | str | None = None,
    sides: int | None = None,
    join: float | None = None,
    segments: str | os.PathLike[str] | None = None,
    threads: int = 0,
    progress: Progress | bool | None = None,
) -> Changed:
    """Give a surface even triangles within a distance of it; it may be open.

    Rims, borders of patches, edges of more than two triangles and creases are kept. Triangles that do not
    cross before do not cross afterwards. Arrays and patches are carried: on points, floats are interpolated
    in the nearest triangle of the same patch, and other values are those of one of its corners; triangles get
    the values of the nearest one. Equivalent to ``motet surface`` on the command line.

    Parameters
    ----------
    surface : MeshLike
        Surface of triangles, quads or polygons: a :class:`Mesh`, file path, ``meshio.Mesh`` or PyVista data
        set. Of a volume mesh its surface cells are used or, if it has none, its boundary. Points at the same
        place are merged, and triangles without area dropped.
    size : float or "auto", optional
        Edge length, in units of the surface; shorter where `distance` requires it. By default, and with
        ``"auto"``, that of as many even triangles.
    distance : float, optional
        How far the new surface may stray from the given one, and that from the new one, in units of the
        surface. Default: a thousandth of its largest extent.
    feature_angle : float, default 40.0
        Edges at which triangles meet at more than this angle, in degrees, are creases.
    growth : float, optional
        Increase of edge length per unit of distance from where it is smaller. Above 0, at most 0.7. Default:
        0.3.
    size_array : str, optional
        Name of a point or cell array of the surface with the edge length there.
    clip : sequence of array_like, optional
        Ends that are cut off first. Six numbers x, y, z, nx, ny, nz: the part in front of the plane through the
        place x, y, z with this normal, along the line nearest to the place; the rest of the vessel is kept
        where it meets the plane again. Four numbers x, y, z, r: all inside a sphere.
    repair : bool, default False
        Whether to repair the surface first: vertices on edges (T-junctions), overlapping faces, duplicates,
        orientation, and points closer than `merge`.
    unite : bool, default False
        Whether bodies that cross, touch or lie on each other become one, without what lies inside; voids, which
        face inward, stay. The surface has to be closed.
    wrap : float, optional
        Replace the surface by a closed one within this distance around what it encloses, as winding numbers
        tell: it may be open, torn, double, and cross itself. Walls and gaps thinner than the distance may be
        lost. Not with `unite`.
    merge : float, default 0.0
        With `repair`: merge points closer than this, in units of the surface.
    hole_edges : int, default 0
        With `repair`: close holes of at most this many edges.
    smooth : int, default 0
        Number of passes of smoothing before, which keep the volume (Taubin 1995) and leave rims, borders of
        patches and creases in place. `distance` then holds from the smoothed surface.
    tubes : float or str, optional
        `surface` is centre lines of wires (line cells), which become one closed surface of round tubes of
        this radius, or of the radii in the point or cell array of this name. `distance` is then an eighth
        of the smallest radius by default. With `repair`, segments that are not finite or have no length are
        left out.
    sides : int, optional
        With `tubes`: number of sides of each tube, 3 to 360. By default as many as `size` and `distance`
        require, at least 8.
    join : float, optional
        With `tubes`: wires whose gap is at most this, or that overlap by no more, are joined by material
        between them; 0 adds none. Default: a tenth of the smaller radius.
    segments : path, optional
        With `tubes`: `surface` is a text file of positions, three numbers a row, and this one has the
        segments: two numbers of positions a row, counted from 1.
    threads : int, default 0
        Number of threads; 0 uses all cores. The result does not depend on it.
    progress : callable or True, optional
        True shows a bar for each stage (by tqdm, if it is installed). A function is called
        as ``progress(stage, done, total)`` several times per second; ``total`` is 0 if unknown. An
        exception that it raises, or Ctrl-C, ends the call.

    Returns
    -------
    Changed
        The new surface with its history (None for `tubes`) and report; ``complete`` is False if the surface is farther away than
        allowed, or smoothing made triangles cross.

    Raises
    ------
    InputError
        If there is no surface or line, or a coordinate is not finite.
    """
    if tubes is None and any(option is not None for option in (sides, join, segments)):
        raise OptionsError("`sides`, `join` and `segments` need `tubes`: give the radius of the wires")
    given = as_mesh(surface) if segments is None else Mesh._of(_motet.read_segments(os.fspath(surface), os.fspath(segments)))
    native = _motet.surface(
        given, size=size, distance=distance, feature_angle=feature_angle, growth=growth, size_array=size_array,
        clip=[np.asarray(cut, dtype=float).ravel().tolist() for cut in clip], repair=repair, unite=unite, wrap=wrap,
        merge=merge, hole_edges=hole_edges, smooth=smooth, tubes=tubes, sides=sides, join=join, threads=threads, progress=progress,
    )  # fmt: skip
    parts, history, reported, not_reached = native
    return Changed(Mesh._of(parts), None if history is None else History(history), report(reported), not_reached)


@checked
def wall(
    mesh: MeshLike,
    *,
    thickness: float | str | ArrayLike | None = None,
    of_radius: float | None = None,
    layers: int = 1,
    growth: float = 1.0,
    on: Sequence[str] = (),
    keep_prisms: bool = False,
    name: str = "wall",
    threads: int = 0,
    progress: Progress | bool | None = None,
) -> Changed:
    """Put a solid wall around a vessel: layers outward that share the vertices of the lumen.

    The wall ends in the planes of caps and of open rims. Where there is no space, such as between branches, it
    is thinner. It is a region of the mesh; its outer side and its ends are patches. Equivalent to
    ``motet wall`` on the command line.

    Parameters
    ----------
    mesh : MeshLike
        Volume mesh on whose boundary the wall stands, or a surface, closed or open at its ends; of a surface
        the result is the wall alone. A :class:`Mesh`, file path, ``meshio.Mesh`` or PyVista data set.
    thickness : float, str or array_like of shape (n,), optional
        Thickness in units of the mesh: one number, the name of a point or cell array, or a value for each point.
    of_radius : float, optional
        Thickness as a part of the local radius: that of the largest ball that touches the surface from inside.
        One of `thickness` and `of_radius` is required.
    layers : int, default 1
        Number of layers.
    growth : float, default 1.0
        Ratio of the thickness of each layer to that of the one inside it.
    on : sequence of str, optional
        Names or numbers of the patches on which the wall stands. Default: all of the surface but caps, which are
        flat parts with a sharp crease all around.
    keep_prisms : bool, default False
        Whether layers stay wedges and pyramids instead of being divided into tets.
    name : str, default "wall"
        Name of the region of the wall.
    threads : int, default 0
        Number of threads; 0 uses all cores. The result does not depend on it.
    progress : callable or True, optional
        True shows a bar for each stage (by tqdm, if it is installed). A function is called
        as ``progress(stage, done, total)`` several times per second; ``total`` is 0 if unknown. An
        exception that it raises, or Ctrl-C, ends the call.

    Returns
    -------
    Changed
        The mesh with its wall, its history and report; ``complete`` is False if there is no space for a wall at
        some vertices. Points and cells of the wall have the values of arrays at its foot.

    Raises
    ------
    InputError
        If there is no surface, it crosses itself, or a facet for the wall is not a triangle.
    OptionsError
        If the thickness is given not at all or twice, or a patch does not exist.
    """
    if thickness is not None and not isinstance(thickness, (str, int, float)):
        thickness = np.asarray(thickness, dtype=float).ravel().tolist()
    native = _motet.wall(
        as_mesh(mesh), thickness=thickness, of_radius=of_radius, layers=layers, growth=growth, on=[str(patch) for patch in on],
        keep_prisms=keep_prisms, name=name, threads=threads, progress=progress,
    )  # fmt: skip
    return _changed(native)
