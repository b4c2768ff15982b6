"""Meshes made by motet itself: for first tries, tests and documentation."""
from __future__ import annotations

from typing import Literal

from numpy.typing import ArrayLike

from . import _motet
from ._mesh import Mesh, point
from ._words import checked


@checked
def sphere_in_box(n: int = 8, layers: int = 4) -> Mesh:
    """Tets round a ball of radius 1 in a box of edge 10: ``n`` cells along each side of the cubed sphere, ``layers`` from it to the walls."""
    return Mesh._of(_motet.sphere_in_box(n, layers))


@checked
def box(n: tuple[int, int, int] = (4, 4, 4), low: ArrayLike = (0.0, 0.0, 0.0), high: ArrayLike = (1.0, 1.0, 1.0)) -> Mesh:
    """A box of tets, so many cells along its sides."""
    return Mesh._of(_motet.box_grid(list(n), point(low), point(high)))


@checked
def ball(n: int = 4, layers: int = 4) -> Mesh:
    """A ball of tets, of radius 1."""
    return Mesh._of(_motet.ball(n, layers))


@checked
def mixed(n: int = 3) -> Mesh:
    """Hexahedra, wedges, pyramids and tets that meet facet to facet."""
    return Mesh._of(_motet.mixed(n))


@checked
def tube(
    *, radius: float = 1.0, length: float = 5.0, n: int = 4, slices: int = 15, wall_layers: int = 0, wall_cells: Literal["tets", "wedges"] = "tets"
) -> Mesh:
    """A straight vessel along z, with thin layers at its wall if wanted; patches ``wall``, ``inlet``, ``outlet``."""
    return Mesh._of(_motet.tube(radius, length, n, slices, wall_layers, wall_cells == "wedges"))


@checked
def aneurysm(*, around: int = 24, bend_deg: float = 90.0) -> Mesh:
    """The surface of a bent vessel of radius 1 with a sac; patches ``wall``, ``inlet``, ``outlet``."""
    return Mesh._of(_motet.aneurysm(around, bend_deg))


@checked
def stent(
    radius: float = 1.0, *, length: float = 10.0, rings: int = 6, crowns: int = 8, strut_width: float = 0.15, thickness: float = 0.1
) -> Mesh:
    """The surface of a stent along z from 0, its outer radius as given; the same triangles at every radius."""
    return Mesh._of(_motet.stent(radius, length, rings, crowns, strut_width, thickness))


@checked
def coil(
    centre: ArrayLike = (0.0, 0.0, 0.0),
    *,
    radius: float = 0.5,
    pitch: float = 0.3,
    turns: float = 3.0,
    wire_radius: float = 0.08,
    steps: int = 16,
    around: int = 8,
) -> Mesh:
    """The surface of a wire wound round a line along z: ``steps`` pieces a turn, ``around`` sides."""
    return Mesh._of(_motet.coil(point(centre), radius, pitch, turns, wire_radius, steps, around))
