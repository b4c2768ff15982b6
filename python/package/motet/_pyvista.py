"""``data.motet``: motet's functions as methods of PyVista's data sets; and files that ``pyvista.read`` reads
with motet.

PyVista (0.48 or later) finds this module by its entry points ``pyvista.accessors`` and ``pyvista.readers``, and
imports it when ``.motet`` is used for the first time, or such a file is read.
"""
from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal

import numpy as np
import pyvista
from numpy.typing import NDArray
from pyvista.core.utilities.reader_registry import LocalFileRequiredError

from . import _motet
from ._cap import cap
from ._changing import History, implant, mesh, remesh, surface, wall
from ._contact import Contact, Gaps
from ._convert import to_pyvista
from ._mesh import Mesh, MeshLike, as_mesh, named, read
from ._motion import move
from ._refinement import refine
from ._report import Report
from ._view import View, view
from .errors import InputError, OptionsError

# Tets below this EAS are bad.
BAD = 0.2
TETS = (pyvista.CellType.TETRA, pyvista.CellType.QUADRATIC_TETRA, pyvista.CellType.LAGRANGE_TETRAHEDRON)


def read_grid(path: str, **options: Any) -> Any:
    """Read a file for ``pyvista.read``; names of regions and patches are field data ``region:NAME``, ``patch:NAME``.

    Parameters
    ----------
    path : str
        The file.
    **options
        Keywords of :func:`motet.read`.
    """
    if "://" in path:
        raise LocalFileRequiredError(path)
    return to_pyvista(read(path, **options))


def _documented(function: Callable[..., Any]) -> Callable[[Any], Any]:
    """Say in a method's docstring which function's parameters it takes."""

    def decorate(method: Any) -> Any:
        first = (function.__doc__ or "").strip().splitlines()[0]
        method.__doc__ = f"{first}\n\nTakes the keywords of :func:`motet.{function.__name__}`; returns a new data set."
        return method

    return decorate


@pyvista.register_dataset_accessor("motet", pyvista.DataObject)
class MotetAccessor:
    """Functions of motet for this data set. They leave it as it is and return new data sets.

    >>> import pyvista as pv
    >>> grid = pv.Sphere().motet.mesh(size=0.1)                         # doctest: +SKIP
    >>> grid.motet.refine(ball=[((0, 0, 0), 0.2)]).motet.plot()         # doctest: +SKIP

    A ``pyvista.MultiBlock`` stands for several meshes by name: surfaces to be filled, or between which gaps
    are measured.

    Attributes
    ----------
    report : Report or None
        What the call that made this data set reports; None for data sets that no call has made.
    history : History or None
        Where points and cells came from, if a call has changed them.
    gaps : Gaps or None
        The gaps, if :meth:`contact` has measured them.
    not_reached : str or None
        Why the call that made this data set did not reach what was requested; None if it did.
    """

    def __init__(self, data: Any):
        self._data = data
        self.report: Report | None = None
        self.history: History | None = None
        self.gaps: Gaps | None = None
        self.not_reached: str | None = None

    @property
    def complete(self) -> bool:
        """Whether the call that made this data set reached what was requested."""
        return self.not_reached is None

    def to_mesh(self) -> Mesh:
        """Convert the data set to a :class:`motet.Mesh`."""
        return as_mesh(self._one("to_mesh"))

    def summary(self) -> Report:
        """Summarise counts, quality, volume, regions and patches."""
        return self.to_mesh().summary()

    def quality(self, measure: str = "eas") -> NDArray[np.float64]:
        """Return the quality of each cell; NaN for cells that have none.

        Parameters
        ----------
        measure : str, default "eas"
            A measure of :meth:`motet.Mesh.quality`.
        """
        return self.to_mesh().quality(measure)

    @_documented(cap)
    def cap(self, **options: Any) -> Any:
        return to_pyvista(cap(self.to_mesh(), **options))

    @_documented(mesh)
    def mesh(self, membranes: MeshLike | Sequence[MeshLike] | Mapping[str, MeshLike] = (), **options: Any) -> Any:
        return _result(mesh(_blocks_of(self._data), membranes=_blocks_of(membranes), **options))

    @_documented(surface)
    def surface(self, **options: Any) -> Any:
        return _result(surface(self._one("surface"), **options))

    @_documented(wall)
    def wall(self, **options: Any) -> Any:
        return _result(wall(self._one("wall"), **options))

    @_documented(remesh)
    def remesh(self, **options: Any) -> Any:
        return _result(remesh(self._one("remesh"), **options))

    @_documented(refine)
    def refine(self, **options: Any) -> Any:
        return _result(refine(self._one("refine"), **options))

    @_documented(implant)
    def implant(self, devices: MeshLike | Sequence[MeshLike] | Mapping[str, MeshLike], **options: Any) -> Any:
        return _result(implant(self._one("implant"), _blocks_of(devices), **options))

    @_documented(move)
    def move(self, **options: Any) -> Any:
        moved = move(self._one("move"), **options)
        grid = to_pyvista(moved.mesh)
        grid.motet.report, grid.motet.not_reached = moved.certificate, moved.not_reached
        return grid

    def contact(self, others: Any = None, **options: Any) -> Any:
        """Measure the gap from each vertex to the nearest other surface.

        Parameters
        ----------
        others : data set, sequence or mapping of str to data set, optional
            The other surfaces. A ``MultiBlock`` has its own, a volume mesh may have several in `patches`.
        **options
            Keywords of :class:`motet.Contact`.

        Returns
        -------
        pyvista.DataSet or pyvista.MultiBlock
            This data set with the point arrays ``gap``, ``closest_point`` and ``warning``; for a ``MultiBlock``,
            all of its blocks. Points that are on no surface have an infinite gap. Its ``motet.gaps`` has the pairs.
        """
        own = _blocks_of(self._data)
        own = dict(own) if isinstance(own, Mapping) else {"this": own}
        rest = {} if others is None else dict(named(_blocks_of(others), "other"))
        clash = sorted(own.keys() & rest.keys())
        if clash:
            raise OptionsError(f"two surfaces have the name {clash[0]!r}")
        contact = Contact({**own, **rest} if len(own) + len(rest) > 1 else next(iter(own.values())), **options)
        gaps = contact.measure()
        result, shift = pyvista.MultiBlock(), 0
        for name, block in own.items():
            result[name] = _with_gaps(block, gaps, shift)
            shift += block.n_points
        data = result if isinstance(self._data, pyvista.MultiBlock) else result[0]
        data.motet.gaps = gaps
        return data

    def view(self, **options: Any) -> View:
        """Show the mesh in the browser, and drag its parts. Takes the keywords of :func:`motet.view`."""
        return view(self._one("view"), **options)

    def blocks(self) -> Any:
        """Return the regions and patches as a ``pyvista.MultiBlock``, by name; those without a name by number.

        Regions are unstructured grids, patches surfaces. A region and a patch with one name are told apart by
        `` (patch)``.
        """
        given = self.to_mesh()
        grid = to_pyvista(given)
        blocks = pyvista.MultiBlock()
        for kind, labels, names in zip(("region", "patch"), _motet.labels(given), (given.region_names, given.patch_names)):
            for label in np.unique(labels) if labels is not None else ():
                if label == 0:
                    continue
                name = names.get(int(label), f"{kind} {label}")
                name = f"{name} (patch)" if name in blocks.keys() else name
                part = grid.extract_cells(np.flatnonzero(labels == label))
                blocks[name] = _surface(part) if kind == "patch" else part
        return blocks

    def plot(
        self, show: Literal["quality", "gaps"] | None = None, *, cut: str | Sequence[float] | None = "auto", bad: float = BAD, **options: Any
    ) -> Any:
        """Show the data set: a cut through its tets coloured by EAS, bad ones in red, walls transparent.

        Parameters
        ----------
        show : {"quality", "gaps"}, optional
            What is coloured. By default gaps if they were measured, otherwise quality.
        cut : str or sequence of 3 floats, optional
            Normal of the plane through the middle beyond which tets are left out, such as ``"x"`` or ``"-x"``;
            None shows all. By default the axis along which the mesh is shortest, seen from that side.
        bad : float, default 0.2
            Tets below this EAS are red, wherever they are.
        **options
            Keywords of ``pyvista.Plotter.show``; ``off_screen`` and ``window_size`` go to the plotter.

        Returns
        -------
        What ``pyvista.Plotter.show`` returns.
        """
        own = {name: options.pop(name) for name in ("off_screen", "window_size") if name in options}
        plotter = pyvista.Plotter(**own)
        if (show or ("gaps" if self.gaps else "quality")) == "gaps":
            _add_gaps(plotter, self._data)
        else:
            _add_quality(plotter, self._one("plot"), cut, bad)
        return plotter.show(**options)

    def _one(self, verb: str) -> Any:
        if isinstance(self._data, pyvista.MultiBlock):
            raise InputError(f"{verb} takes one data set, not a MultiBlock: choose one of {', '.join(map(str, self._data.keys()))}")
        return self._data


def _blocks_of(data: Any) -> Any:
    """Return the blocks of a ``MultiBlock`` by name, also nested ones; anything else as it is."""
    if not isinstance(data, pyvista.MultiBlock):
        return data
    blocks: dict[str, Any] = {}
    for name, block in zip(data.keys(), data):
        if isinstance(block, pyvista.MultiBlock):
            blocks.update({f"{name}/{inner}": one for inner, one in _blocks_of(block).items()})
        elif block is not None and block.n_cells:
            blocks[str(name)] = block
    if not blocks:
        raise InputError("the MultiBlock has no block with cells")
    return blocks


def _result(changed: Any) -> Any:
    grid = to_pyvista(changed.mesh)
    own = grid.motet
    own.report, own.history, own.not_reached = changed.report, changed.history, changed.not_reached
    return grid


def _with_gaps(block: Any, gaps: Gaps, shift: int) -> Any:
    """Copy a data set whose points have numbers from `shift` on, with the gaps of its points."""
    block = block.copy()
    n = block.n_points
    gap, closest, warning = np.full(n, np.inf), np.full((n, 3), np.nan), np.zeros(n, np.uint8)
    for body in gaps.bodies.values():
        is_own = (shift <= body.vertices) & (body.vertices < shift + n)
        own = body.vertices[is_own].astype(np.int64) - shift
        gap[own], closest[own], warning[own] = body.gap[is_own], body.closest_point[is_own], body.warning[is_own]
    block.point_data["gap"], block.point_data["closest_point"], block.point_data["warning"] = gap, closest, warning
    block.set_active_scalars("gap")
    return block


# Little shading, so that colours are those of the bar.
_FLAT = {"ambient": 0.5, "diffuse": 0.5, "specular": 0.0}


def _bar(title: str) -> dict[str, Any]:
    """Return a vertical bar, whose title stands above it."""
    return {"title": title, "vertical": True, "position_x": 0.88, "position_y": 0.25, "height": 0.5, "width": 0.06, "n_labels": 6, "fmt": "%.1f" if title == "EAS" else "%.3g"}


def _add_quality(plotter: Any, data: Any, cut: str | Sequence[float] | None, bad: float) -> None:
    given = as_mesh(data)
    grid = to_pyvista(given)
    grid.cell_data["EAS"] = given.quality()
    tets = grid.extract_cells(np.isin(grid.celltypes, TETS))
    surfaces = [block for block in grid.motet.blocks() if isinstance(block, pyvista.PolyData)]
    if not tets.n_cells:
        plotter.add_mesh(grid, color="lightsteelblue", show_edges=True)
        return
    view = None
    if cut == "auto":
        low, high = np.reshape(tets.bounds, (3, 2)).T
        shortest = int(np.argmin(high - low))
        cut, view = np.eye(3)[shortest], (np.eye(3)[shortest], np.eye(3)[(shortest + 2) % 3])
    shown = tets if cut is None else tets.clip(cut, crinkle=True)
    plotter.add_mesh(shown, scalars="EAS", cmap="viridis", clim=(0.0, 1.0), show_edges=True, scalar_bar_args=_bar("EAS"), **_FLAT)
    worst = tets.extract_cells(tets.cell_data["EAS"] < bad)
    if worst.n_cells:
        plotter.add_mesh(worst, color="red", show_edges=True, label=f"{worst.n_cells} tets below {bad:g}")
    # The surface that extends farthest is the wall; other closed ones are devices in it, open ones are ends.
    surfaces.sort(key=lambda surface: surface.length)
    for surface in surfaces[:-1]:
        is_device = surface.n_open_edges == 0
        plotter.add_mesh(surface, color="silver" if is_device else "lightsteelblue", opacity=1.0 if is_device else 0.15)
    plotter.add_mesh(surfaces[-1] if surfaces else _surface(tets), color="lightsteelblue", opacity=0.15)
    if view is not None:
        plotter.view_vector(*view)


def _add_gaps(plotter: Any, data: Any) -> None:
    blocks = _blocks_of(data) if isinstance(data, pyvista.MultiBlock) else {"": data}
    if not all("gap" in block.point_data for block in blocks.values()):
        raise InputError("there are no gaps to show: measure them with contact()")
    largest = max(blocks.values(), key=lambda block: block.length)
    # The wall extends far beyond the devices: the colours are for these.
    devices = [block for block in blocks.values() if block is not largest] or [largest]
    finite = np.concatenate([block.point_data["gap"] for block in devices])
    finite = finite[np.isfinite(finite)]
    limits = (float(finite.min()), float(finite.max())) if len(finite) else (0.0, 1.0)
    for block in blocks.values():
        opacity = 0.3 if block is largest and len(blocks) > 1 else 1.0
        plotter.add_mesh(block, scalars="gap", cmap="viridis_r", clim=limits, opacity=opacity, scalar_bar_args=_bar("gap"), **_FLAT)


def _surface(grid: Any) -> Any:
    return grid.extract_surface(pass_pointid=False, pass_cellid=False, algorithm="dataset_surface")
