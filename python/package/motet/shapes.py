"""Built-in meshes for tests, documentation and first experiments."""
from __future__ import annotations

from typing import Literal

from numpy.typing import ArrayLike

from . import _motet
from ._mesh import Mesh, point
from ._keywords import checked


@checked
def sphere_in_box(n: int = 8, layers: int = 4) -> Mesh:
    """Create tets around a sphere of radius 1 in a cube of edge length 10.

    Parameters
    ----------
    n : int, default 8
        Number of cells along each side of the cubed sphere.
    layers : int, default 4
        Number of cells from the sphere to the walls.

    Returns
    -------
    Mesh
        With the patches ``sphere`` and ``box``.
    """
    return Mesh._of(_motet.sphere_in_box(n, layers))


@checked
def box(n: tuple[int, int, int] = (4, 4, 4), low: ArrayLike = (0.0, 0.0, 0.0), high: ArrayLike = (1.0, 1.0, 1.0)) -> Mesh:
    """Create a box of tets.

    Parameters
    ----------
    n : (int, int, int), default (4, 4, 4)
        Number of cells along x, y and z.
    low, high : array_like, shape (3,)
        Opposite corners. Default: (0, 0, 0) and (1, 1, 1).

    Returns
    -------
    Mesh
        With the region ``box`` and the patches ``xmin``, ``xmax``, ``ymin``, ``ymax``, ``zmin`` and ``zmax``.
    """
    return Mesh._of(_motet.box_grid(list(n), point(low), point(high)))


@checked
def ball(n: int = 4, layers: int = 4) -> Mesh:
    """Create a ball of tets with radius 1, centred at the origin.

    Parameters
    ----------
    n : int, default 4
        Number of cells along each side of the core.
    layers : int, default 4
        Number of shells of cells around the core.

    Returns
    -------
    Mesh
        With the region ``ball`` and the patch ``sphere``.
    """
    return Mesh._of(_motet.ball(n, layers))


@checked
def mixed(n: int = 3) -> Mesh:
    """Create a conforming mesh of hexahedra, wedges, pyramids and tets.

    Parameters
    ----------
    n : int, default 3
        Number of cells along a side.

    Returns
    -------
    Mesh
    """
    return Mesh._of(_motet.mixed(n))


@checked
def tube(
    *, radius: float = 1.0, length: float = 5.0, n: int = 4, slices: int = 15, wall_layers: int = 0, wall_cells: Literal["tets", "wedges"] = "tets"
) -> Mesh:
    """Create a straight vessel along z, starting at z = 0, with optional thin layers at its wall.

    Parameters
    ----------
    radius : float, default 1.0
        Radius.
    length : float, default 5.0
        Length along z.
    n : int, default 4
        Number of cells along each side of the core, a quarter of the number around.
    slices : int, default 15
        Number of cells along z.
    wall_layers : int, default 0
        Number of thin layers at the wall.
    wall_cells : {"tets", "wedges"}, default "tets"
        Kind of the cells in the thin layers.

    Returns
    -------
    Mesh
        With the region ``lumen`` and the patches ``wall``, ``inlet`` and ``outlet``.
    """
    return Mesh._of(_motet.tube(radius, length, n, slices, wall_layers, wall_cells == "wedges"))


@checked
def aneurysm(*, around: int = 24, bend_deg: float = 90.0) -> Mesh:
    """Create the surface of a bent vessel of radius 1 with a sac.

    Parameters
    ----------
    around : int, default 24
        Number of vertices around the vessel, rounded up to an even number.
    bend_deg : float, default 90.0
        Angle by which the axis bends, in degrees; 0 is straight.

    Returns
    -------
    Mesh
        With the patches ``wall``, ``inlet`` and ``outlet``.
    """
    return Mesh._of(_motet.aneurysm(around, bend_deg))


@checked
def stent(
    radius: float = 1.0, *, length: float = 10.0, rings: int = 6, crowns: int = 8, strut_width: float = 0.15, thickness: float = 0.1
) -> Mesh:
    """Create the surface of a stent along z, starting at z = 0.

    The triangles are the same for every radius.

    Parameters
    ----------
    radius : float, default 1.0
        Outer radius.
    length : float, default 10.0
        Length along z.
    rings : int, default 6
        Number of rings.
    crowns : int, default 8
        Number of crowns of each ring.
    strut_width : float, default 0.15
        Width of the struts seen from outside; less where a small radius leaves no space.
    thickness : float, default 0.1
        Radial thickness, inwards.

    Returns
    -------
    Mesh
        With the patch ``stent``.
    """
    return Mesh._of(_motet.stent(radius, length, rings, crowns, strut_width, thickness))


@checked
def braid(
    radius: float = 2.0,
    *,
    length: float = 10.0,
    wires: int = 24,
    pitch: float = 10.0,
    wire_radius: float = 0.05,
    gap: float = 0.0,
    over: int = 1,
    steps: int = 8,
) -> Mesh:
    """Create the centre lines of a braided stent along z, starting at z = 0, such as a flow diverter.

    ``motet.surface(braid, tubes="radius")`` turns them into one closed surface.

    Parameters
    ----------
    radius : float, default 2.0
        Mean radius: where wires cross, one is farther out and the other farther in.
    length : float, default 10.0
        Length along z.
    wires : int, default 24
        Number of wires, half of them winding each way.
    pitch : float, default 10.0
        Length along z of one turn of a wire.
    wire_radius : float, default 0.05
        Radius of the wires, which is also the point array ``radius``.
    gap : float, default 0.0
        Gap between wires where they cross; at 0 they touch, below 0 they overlap.
    over : int, default 1
        How many wires each wire passes over before it passes under as many: 1 or 2.
    steps : int, default 8
        Number of segments of a wire from one crossing to the next.

    Returns
    -------
    Mesh
        A polyline for each wire, with the point array ``radius`` and the cell array ``wire``.
    """
    return Mesh._of(_motet.braid(radius, length, wires, pitch, wire_radius, gap, over, steps))


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
    """Create the surface of a wire that forms a helix around a line along z.

    Parameters
    ----------
    centre : array_like, shape (3,), default (0, 0, 0)
        Midpoint of the axis.
    radius : float, default 0.5
        Distance from the axis to the centre line of the wire.
    pitch : float, default 0.3
        Distance between turns along the axis.
    turns : float, default 3.0
        Number of turns.
    wire_radius : float, default 0.08
        Radius of the wire.
    steps : int, default 16
        Number of segments per turn.
    around : int, default 8
        Number of sides of the wire.

    Returns
    -------
    Mesh
        With the patch ``wire``.
    """
    return Mesh._of(_motet.coil(point(centre), radius, pitch, turns, wire_radius, steps, around))
