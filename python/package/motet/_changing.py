"""Verbs that change a mesh: bad tets repaired, devices implanted, surfaces filled."""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _motet
from .errors import OptionsError
from ._mesh import Mesh, MeshLike, as_mesh, named, point
from ._report import Progress, Report, report
from ._words import checked, checked_class

Carry = Literal["mean", "linear", "inherit", "drop"]


@checked_class
class History:
    """Where everything in a new mesh came from; carries any array of the old mesh along, at any later time."""

    def __init__(self, native: Any):
        self._native = native

    @property
    def vertex_to_old(self) -> NDArray[np.int64]:
        """For each new vertex the old one that it is, to the bit; -1 for those that came."""
        return _signed(self._native.vertex_to_old)

    @property
    def cell_to_old(self) -> NDArray[np.int64]:
        """For each new cell the old one that it is; -1 for those that came."""
        return _signed(self._native.cell_to_old)

    @property
    def vertex_to_main(self) -> NDArray[np.int64]:
        """For each new vertex the old one that it is or has most of."""
        return _signed(self._native.vertex_to_main)

    @property
    def cell_to_main(self) -> NDArray[np.int64]:
        """For each new cell the old one that it is or has most of."""
        return _signed(self._native.cell_to_main)

    @property
    def ledger(self) -> Report:
        """How well the volumes of old and new tets fit, by region."""
        return report(self._native.ledger)

    def transfer(
        self, array: ArrayLike, *, on: Literal["points", "cells"], rule: Literal["mean", "linear", "inherit"] | None = None, name: str = "array"
    ) -> Any:
        """An array of the old mesh on the new one; what did not change goes over bit for bit.

        Parameters
        ----------
        array : array (n, ..)
            A row for each old point, or cell.
        on : {"points", "cells"}
        rule : {"mean", "linear", "inherit"}
            ``mean``: on points interpolated (exact for quadratic fields off walls, between the values around), on cells averaged by volume, so that integrals stay.
            ``linear``: on points linear in each old tet. ``inherit``: the value of what has the largest share.
            None: real numbers get their mean; whole numbers, texts, directions (by ``name`` or by their lengths) are inherited.
        """
        given = array if isinstance(array, list) else np.asarray(array)
        shape = np.shape(given)[1:]
        new = self._native.transfer(name, given, on, rule)
        return np.reshape(new, (-1, *shape)) if len(shape) > 1 else new

    def then(self, later: History) -> History:
        """This change and a later one, as one."""
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
    """What a verb made of a mesh."""

    mesh: Mesh
    history: History | None
    """Where everything came from; None for a mesh that was made of surfaces."""
    report: Report
    """What was done. ``quality`` tells how good all tets are (``worst``, ``p1``, ``p5``, ``median``, ``mean`` EAS, ``mean_ratio``): of a mesh made of surfaces; of host and mesh
    where something was implanted; in ``before`` and ``after`` of a repair; in each of ``steps`` of a refinement."""
    not_reached: str | None = None
    """Why the requested result was not reached; None where it was. The report has the details."""

    @property
    def complete(self) -> bool:
        """Whether the requested result was reached."""
        return self.not_reached is None

    def __repr__(self) -> str:
        return f"motet.Changed: {'complete' if self.complete else 'not complete'}; {self.mesh!r}"


def _changed(native: tuple) -> Changed:
    parts, history, told, not_reached = native
    return Changed(Mesh._of(parts), History(history), report(told), not_reached)


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
    progress: Progress | None = None,
) -> Changed:
    """Finds the bad tets of a mesh and repairs them, and only them (after Moyle and Ventikos 2008).

    Parameters
    ----------
    mesh : mesh, path, meshio.Mesh or PyVista data set
    min_eas : float
        A tet below this equi-angle quality is bad.
    min_dihedral_deg : float
        A tet with a dihedral angle below this is bad, too.
    goal : {"repair", "best"}
        ``best``: the worst tets as good as they get, everywhere.
    surface : {"keep", "adapt", "loose"}
        ``keep``: to the bit. ``adapt``: it may change within ``distance``, features kept. ``loose``: features too, where nothing else helps.
    distance : float
        In units of the mesh; a thousandth of its largest extent if None.
    keep_layers : bool
        Whether thin tets of boundary layers stay as they are.
    hold : sequence of names or labels of regions and patches
        Tets of these regions and triangles of these patches stay to the bit, with their vertices.
    sizes : float, name of a point array, or array (n,)
        How long edges are to be.
    carry : mapping from array to {"mean", "linear", "inherit", "drop"}
        What becomes of arrays where the mesh changes.
    progress : callable
        Gets what is being done, how much of it is done and how much there is (0 where that is not known), some times a second. What it raises ends the
        call and comes out of it, as Ctrl-C does; the mesh stays as it was.

    Returns
    -------
    Changed
    """
    given = as_mesh(mesh)
    if isinstance(sizes, str):
        if sizes not in given.point_data:
            raise OptionsError(f"the mesh has no point array {sizes!r}; it has {', '.join(given.point_data) or 'none'}")
        sizes = given.point_data[sizes]
    if sizes is not None and not isinstance(sizes, (int, float)):
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
    progress: Progress | None = None,
) -> Changed:
    """Puts devices into a mesh of tets: one conforming mesh, whose regions and patches are named after the devices.

    Parameters
    ----------
    host : mesh, path, meshio.Mesh or PyVista data set
        Of tets.
    devices : one of these, a sequence, or a mapping from names
        Closed surfaces, or meshes of tets. Files are named after themselves, others ``device``, ``device_2`` and so on.
    inside : {"own", "fill", "hollow"}
        ``own``: devices keep their tets, surfaces are filled. ``hollow``: their room is left out.
    interface : {"match", "conform"}
        ``match``: each triangle of a device is a facet of the mesh. ``conform``: a new surface within ``tolerance``, for devices that touch or cross themselves.
    outside : {"cut", "keep"}
        What becomes of what lies outside of the host.
    stray : float
        How far surfaces may stray where a device meets a wall; a twentieth of the device's edges if None.
    adapt, size, growth : str, float, float
        What of the host is refined first, how long edges are beside the devices, how much they grow per unit of distance.
    carve, reach : float
        What is nearer than ``carve`` edges is replaced, what is farther than ``reach`` stays to the bit.
    values : mapping from array to its components
        What arrays begin with in the devices; what the host had there if not named.
    progress : callable
        As of :func:`remesh`.

    Returns
    -------
    Changed
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
"""How many layers, how thick the first one, how many times as thick each next one."""


@dataclass
class _Filling:
    size: float | None
    surface: str
    is_graded: bool
    growth: float | None
    size_array: str | None
    seeds: list
    holes: list
    min_eas: float | None
    layers: Layers | None
    layers_on: dict
    keep_prisms: bool
    repair: bool
    cut: bool
    voids: bool
    merge: float
    hole_edges: int


@checked
def mesh(
    surfaces: MeshLike | Sequence[MeshLike] | Mapping[str, MeshLike],
    *,
    membranes: Sequence[MeshLike] = (),
    size: float | Literal["auto"] | None = None,
    surface: Literal["auto", "divide", "keep"] = "auto",
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
    voids: bool = False,
    threads: int = 0,
    progress: Progress | None = None,
) -> Changed:
    """Fills closed surfaces with tets: every triangle is a facet of the mesh, or divided where it is far coarser than ``size``.

    Parameters
    ----------
    surfaces : a surface, a sequence, or a mapping from names
        Each closed, or together with others that end at the same edges. Nested, side by side, sharing triangles: what each encloses is a region.
    membranes : sequence
        Surfaces that may end inside the others, such as a flap.
    size : float or "auto"
        How long edges inside are; ``auto``: as those of the surface, growing inwards. None: no points inside but those that are needed.
    surface : "auto", "divide" or "keep"
        Whether triangles of the surfaces are divided to ``size`` in their own planes, creases kept: where most are far coarser or narrow, all, or none.
    growth : float
        How much sizes grow from the surface per unit of distance, up to ``size``.
    size_array : str
        An array of the surfaces with the sizes there.
    seeds : mapping from name to place
        Names the regions that hold these places.
    holes : sequence of places
        What encloses one of them is left out.
    min_eas : float
        Tets below this are repaired; 0.2 with sizes, none without, if None.
    layers : (count, first, growth), or a mapping from patch to these
        Thin layers on walls.
    keep_prisms : bool
        Whether layers stay wedges and pyramids.
    repair, merge, hole_edges : bool, float, int
        Mends the surfaces first: vertices on edges (T-junctions) and faces that lie on each other, duplicates, orientation, points nearer than ``merge``, holes of at most
        so many edges.
    cut : bool
        Whether surfaces that go through each other, or touch, are divided where they do: each room between them is a region.
    voids : bool
        Whether what closed surfaces turned inward enclose is left out.
    progress : callable
        As of :func:`remesh`.

    Returns
    -------
    Changed
        Without a history.

    Raises
    ------
    InputError
        The first thing that stops a surface from being filled, with its place.
    """
    if isinstance(size, str) and size != "auto":
        raise OptionsError(f"size={size!r} means nothing: a length is expected, or 'auto'")
    given = [(as_mesh(one), name, False) for name, one in named(surfaces, "surface").items()]
    given += [(as_mesh(one), name, True) for name, one in named(list(membranes), "membrane").items()]
    request = _Filling(
        size=None if size == "auto" else size, surface=surface, is_graded=size == "auto", growth=growth, size_array=size_array,
        seeds=[(point(place), name) for name, place in (seeds or {}).items()], holes=[point(place) for place in holes], min_eas=min_eas,
        layers=None if isinstance(layers, Mapping) else layers, layers_on=dict(layers) if isinstance(layers, Mapping) else {},
        keep_prisms=keep_prisms, repair=repair, cut=cut, voids=voids, merge=merge, hole_edges=hole_edges,
    )  # fmt: skip
    parts, told, not_reached = _motet.mesh(given, request, threads, progress)
    return Changed(Mesh._of(parts), None, report(told), not_reached)
