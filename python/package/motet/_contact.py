"""Contact between surfaces: gaps, warnings, and times of first contact."""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _motet
from ._mesh import MeshLike, as_mesh, named
from ._report import Report, report
from ._keywords import NotPickled, checked_class


@dataclass(repr=False)
class Body:
    """The gap at each of the k vertices of a surface.

    Attributes
    ----------
    vertices : uint32 array, shape (k,)
        Ids of the vertices among all points of the :class:`Contact`, ascending.
    gap : float64 array, shape (k,)
        Distance to the nearest other surface, in units of the points. Negative where the vertex is on the
        wrong side of it, infinite if no surface is within range.
    normal : float64 array, shape (k, 3)
        Direction that reduces the gap.
    closest_body : int64 array, shape (k,)
        Index of the nearest surface; -1 for none.
    closest_triangle : int64 array, shape (k,)
        Index of the nearest triangle; -1 for none.
    closest_point : float64 array, shape (k, 3)
        Nearest point of the other surface.
    warning : bool array, shape (k,)
        Whether a triangle at the vertex is closer to another surface than the warning distance.
    """

    vertices: NDArray[np.uint32]
    gap: NDArray[np.float64]
    normal: NDArray[np.float64]
    closest_body: NDArray[np.int64]
    closest_triangle: NDArray[np.int64]
    closest_point: NDArray[np.float64]
    warning: NDArray[np.bool_]

    def __repr__(self) -> str:
        least = f", least gap {self.gap.min():.4g}" if len(self.gap) else ""
        return f"motet.Body: {len(self.vertices)} vertices{least}, {int(self.warning.sum())} warn"


@dataclass(repr=False)
class Gaps:
    """The gaps between all surfaces at one time.

    Attributes
    ----------
    least : float
        The smallest gap, in units of the points; 0 if surfaces meet.
    bodies : dict of str to Body
        The gaps at the vertices of each surface, by name.
    pairs : list of Report
        For each pair of surfaces: distance, nearest points, number of crossings, and number and depth of
        vertices beyond the other surface.
    warnings : list of Report
        Groups of connected vertices that are closer than the warning distance.
    """

    least: float
    bodies: dict[str, Body]
    pairs: list[Report]
    warnings: list[Report]

    def __repr__(self) -> str:
        return f"motet.Gaps: least {self.least:.4g}, between {', '.join(self.bodies)}; {len(self.warnings)} warnings"


@dataclass(repr=False)
class Ahead:
    """Predicted contacts. All times are lower bounds: nothing touches earlier.

    Attributes
    ----------
    first : Report or None
        The first contact: time, surfaces, triangles and position. None if there is none before the horizon.
    times : dict of str to float64 array of shape (k,)
        For each surface and each of its vertices, a time before which no triangle at the vertex touches.
    """

    first: Report | None
    times: dict[str, NDArray[np.float64]]

    def __repr__(self) -> str:
        first = "no contact" if self.first is None else f"first contact at {self.first.time:.4g}"
        return f"motet.Ahead: {first}, of {', '.join(self.times)}"


@checked_class
class Contact(NotPickled):
    """Measures the gaps between surfaces, or within one surface, while their points move.

    Distances are exact up to rounding, in units of the points.

    Parameters
    ----------
    surfaces : MeshLike, sequence of MeshLike, or mapping of str to MeshLike
        Surfaces, or volume meshes whose boundaries are used. A single mesh is divided by `patches`.
    patches : sequence of str or int, optional
        Names or labels of patches of a single mesh, each of which is a surface.
    room : sequence of str, optional
        Names of surfaces that enclose others, such as vessels; ``()`` for none. By default a closed surface
        is a room if it initially encloses most of the area of another surface; see :attr:`rooms`.
    warn : float, optional
        Gaps below this distance give a warning. By default there are no warnings.
    own : bool, default False
        Whether to measure each surface against itself as well.
    within : float, default inf
        Search range; larger gaps are infinite.
    facing : bool, default False
        Whether a gap counts only if both surfaces face each other through free space.
    fold : float, default 3.0
        Two points of one surface are neighbours, not a gap, if the path along the surface is shorter than
        this multiple of their straight distance.
    threads : int, default 0
        Number of threads; 0 uses all cores. The result does not depend on it.

    Attributes
    ----------
    points : float64 array, shape (n, 3)
        Current positions of the points of all surfaces, one surface after the other.
    """

    _instead = "pickle the surfaces and create a new Contact from them"

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
        self.points = np.concatenate(points)
        self._names = [name for name, _ in bodies]
        self._native = _motet.Contact(
            self.points, bodies, room=None if room is None else list(room), warn=warn, own=own, within=within, facing=facing, fold=fold, threads=threads,
        )  # fmt: skip

    def __repr__(self) -> str:
        return f"motet.Contact: {len(self._names)} surfaces ({', '.join(self._names)}), {len(self.points)} points"

    @property
    def rooms(self) -> list[Report]:
        """Which surfaces lie in which rooms: a list of reports with ``room``, ``surface`` and ``share``.

        ``share`` is the fraction of the surface's area that was inside the room initially, or None if the
        room was given by the parameter `room`.
        """
        return report(self._native.rooms())

    def refit(self, points: ArrayLike) -> None:
        """Update the positions of all points.

        Parameters
        ----------
        points : array_like, shape (n, 3)
            New positions, in the order of :attr:`points`.
        """
        self.points = np.ascontiguousarray(points, np.float64)
        self._native.refit(self.points)

    def measure(self) -> Gaps:
        """Measure the gap at every vertex and the nearest points of every pair of surfaces.

        Returns
        -------
        Gaps
        """
        measured = self._native.measure()
        bodies = {name: Body(**body) for name, body in measured["bodies"].items()}
        return Gaps(measured["least"], bodies, report(measured["pairs"]), report(measured["warnings"]))

    def look_ahead(self, velocity: ArrayLike, horizon: float = float("inf")) -> Ahead:
        """Predict contacts if every point continues in a straight line at constant velocity.

        Parameters
        ----------
        velocity : array_like, shape (n, 3)
            Velocity of each point.
        horizon : float, default inf
            Time up to which contacts are searched.

        Returns
        -------
        Ahead
        """
        return _ahead(self._native.look_ahead(np.ascontiguousarray(velocity, np.float64), horizon))

    def look_ahead_to(self, points: ArrayLike, dt: float) -> Ahead:
        """Predict contacts while every point moves in a straight line to a given position.

        Parameters
        ----------
        points : array_like, shape (n, 3)
            Positions after `dt`.
        dt : float
            Duration of the motion, above 0.

        Returns
        -------
        Ahead
        """
        return _ahead(self._native.look_ahead_to(np.ascontiguousarray(points, np.float64), dt))


def _ahead(found: dict) -> Ahead:
    return Ahead(report(found["first"]), found["times"])
