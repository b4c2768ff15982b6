"""Contact warning: how far apart surfaces are, where, and when they will touch."""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _motet
from .errors import OptionsError
from ._mesh import MeshLike, as_mesh, named
from ._report import Report, report
from ._words import NotPickled, checked_class


@dataclass(repr=False)
class Body:
    """The gap at each vertex of a surface; all arrays have a row a vertex."""

    vertices: NDArray[np.uint32]
    """Its vertices among all points of the handle, rising."""
    gap: NDArray[np.float64]
    """The distance to the nearest other surface, in units of the points; negative where the vertex is where it must not be, infinite where nothing is near."""
    normal: NDArray[np.float64]
    """(k, 3): the way that makes the gap smaller."""
    closest_body: NDArray[np.int64]
    """The surface that is nearest, by its place; -1 for none."""
    closest_triangle: NDArray[np.int64]
    closest_point: NDArray[np.float64]
    warning: NDArray[np.bool_]
    """Whether a triangle at the vertex is nearer to another surface than the warning distance."""

    def __repr__(self) -> str:
        least = f", least gap {self.gap.min():.4g}" if len(self.gap) else ""
        return f"motet.Body: {len(self.vertices)} vertices{least}, {int(self.warning.sum())} warn"


@dataclass(repr=False)
class Gaps:
    """The gaps of all surfaces at one time."""

    least: float
    """The least of all: 0 where surfaces meet."""
    bodies: dict[str, Body]
    pairs: list[Report]
    """For each pair its distance, the places, crossings, vertices beyond the other surface and how deep."""
    warnings: list[Report]
    """Groups of connected vertices that warn."""

    def __repr__(self) -> str:
        return f"motet.Gaps: least {self.least:.4g}, between {', '.join(self.bodies)}; {len(self.warnings)} warnings"


@dataclass(repr=False)
class Ahead:
    """When surfaces will touch; nothing touches earlier."""

    first: Report | None
    """The first contact of all: time, surfaces, triangles, place; None where there is none before the horizon."""
    times: dict[str, NDArray[np.float64]]
    """For each vertex: no triangle at it touches before this."""

    def __repr__(self) -> str:
        first = "no contact" if self.first is None else f"first contact at {self.first.time:.4g}"
        return f"motet.Ahead: {first}, of {', '.join(self.times)}"


@checked_class
class Contact(NotPickled):
    """Two or more surfaces, or one with itself, measured again and again while their points move.

    Parameters
    ----------
    surfaces : sequence of meshes, mapping from names to meshes, or one mesh with ``patches``
        Surfaces, or the boundaries of volume meshes.
    patches : sequence of names or labels
        Of one mesh: these are the surfaces.
    room : sequence of names, optional
        Surfaces that are walls of rooms, such as vessels, and others are within; ``()``: none is. Default: a closed surface that encloses most of
        another one's area at first is its room; ``rooms`` tells.
    warn : float
        Warn of gaps below this.
    own : bool
        Whether each surface is measured against itself as well.
    within : float
        How far is looked; farther gaps are infinite.
    facing : bool
        Whether a gap counts only where both surfaces face each other through free space.
    fold : float
        Places of one surface count as neighbours where the way along it is shorter than this many times the straight one.

    All distances are exact up to rounding, in the unit of the points.
    """

    _instead = "pickle the surfaces, and set another one up"

    def __init__(
        self,
        surfaces: MeshLike | Sequence[MeshLike] | Mapping[str, MeshLike],
        *,
        patches: Sequence[str | int] = (),
        room: Sequence[str] | None = None,
        warn: float | None = None,
        own: bool = False,
        within: float = float("inf"),
        facing: bool = False,
        fold: float = 3.0,
        threads: int = 0,
    ):
        points, bodies = [], []
        shift = 0
        for name, one in named(surfaces, "surface").items():
            mesh = as_mesh(one)
            bodies += _motet.bodies(mesh, name, [str(patch) for patch in patches], shift)
            points.append(mesh.points)
            shift += mesh.n_points
        strange = set(room or ()) - {name for name, _ in bodies}
        if strange:
            raise OptionsError(f"room: no surface {', '.join(sorted(strange))}; there are {', '.join(name for name, _ in bodies)}")
        self.points = np.concatenate(points)
        self._names = [name for name, _ in bodies]
        self._native = _motet.Contact(
            self.points, [(name, triangles, None if room is None else name in room) for name, triangles in bodies], warn=warn, own=own, within=within, facing=facing,
            fold=fold, threads=threads,
        )  # fmt: skip

    def __repr__(self) -> str:
        return f"motet.Contact: {len(self._names)} surfaces ({', '.join(self._names)}), {len(self.points)} points"

    @property
    def rooms(self) -> list[Report]:
        """Which surfaces lie in which rooms: ``room``, ``surface``, and ``share``, the part of its area that was inside at first; None where ``room`` told it."""
        return report(self._native.rooms())

    def refit(self, points: ArrayLike) -> None:
        """New places for all points, (n, 3), in the order of the surfaces."""
        self.points = np.ascontiguousarray(points, np.float64)
        self._native.refit(self.points)

    def measure(self) -> Gaps:
        """The gap at every vertex, and the nearest places of every pair."""
        told = self._native.measure()
        bodies = {name: Body(**body) for name, body in told["bodies"].items()}
        return Gaps(told["least"], bodies, report(told["pairs"]), report(told["warnings"]))

    def look_ahead(self, velocity: ArrayLike, horizon: float = float("inf")) -> Ahead:
        """When surfaces will touch if every point goes on straight at its velocity, (n, 3)."""
        return _ahead(self._native.look_ahead(np.ascontiguousarray(velocity, np.float64), horizon))

    def look_ahead_to(self, points: ArrayLike, dt: float) -> Ahead:
        """The same, on the way to where points will be after a time."""
        return _ahead(self._native.look_ahead_to(np.ascontiguousarray(points, np.float64), dt))


def _ahead(told: dict) -> Ahead:
    return Ahead(report(told["first"]), told["times"])
