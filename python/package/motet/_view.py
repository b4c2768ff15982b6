"""A mesh in a window of the browser, in which its parts are dragged."""
from __future__ import annotations

import html
import os
import webbrowser
from typing import Any

from . import _motet
from ._keywords import NotPickled, checked, checked_class
from ._mesh import Mesh, MeshLike, as_mesh


@checked_class
class View(NotPickled):
    """A page with a mesh whose parts are dragged, served until it is closed or deleted.

    In a notebook the page is shown where the object is the last value of a cell. Only this machine can reach it,
    under an address that contains a random word; where the notebook runs on another machine, forward the port.

    Attributes
    ----------
    url : str
        The address of the page.
    """

    _instead = "pickle its mesh"

    def __init__(self, native: Any):
        self._view = native
        self.url: str = native.address

    @property
    def mesh(self) -> Mesh:
        """The mesh as it is now, as a new :class:`Mesh`."""
        return Mesh._of(self._view.mesh())

    def open(self) -> None:
        """Open the page in the browser of this machine."""
        webbrowser.open(self.url)

    def close(self) -> None:
        """Stop serving the page. The mesh remains available."""
        self._view.close()

    def __enter__(self) -> View:
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"motet.View at {self.url}"

    def _repr_html_(self) -> str:
        return f'<iframe src="{html.escape(self.url)}" style="width: 100%; height: 760px; border: 0"></iframe>'


@checked
def view(mesh: MeshLike, *, port: int = 0, browser: bool = False, threads: int = 0) -> View:
    """Show a mesh in the browser, and drag its parts: the mesh follows.

    A coil, a stent or any other patch is dragged with the mouse. While it moves, so does the mesh, with the worst
    tets in red; when it is released, bad tets are repaired. Parts stop before others and slide along them. Steps
    can be undone; the mesh and the page can be saved.

    Parameters
    ----------
    mesh : MeshLike
        The mesh. One without volume cells can be looked at, but not moved.
    port : int, default 0
        The port of this machine to listen on; 0 is any free one.
    browser : bool, default False
        Whether to open the page in the browser of this machine.
    threads : int, default 0
        Number of threads; 0 is one per core. Results do not depend on it.

    Returns
    -------
    View
        The page, with :attr:`View.url` and :attr:`View.mesh`.
    """
    name = os.path.basename(os.fspath(mesh)) if isinstance(mesh, (str, os.PathLike)) else "mesh"
    shown = View(_motet.View(as_mesh(mesh), name=name, port=port, threads=threads))
    if browser:
        shown.open()
    return shown
