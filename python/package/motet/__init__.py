"""Tetrahedral meshes that stay valid and well shaped while their boundaries move.

>>> import motet
>>> mesh = motet.read("vessel.vtu")                               # doctest: +SKIP
>>> mover = motet.Mover(mesh, slide=["inlet"], smooth=2)          # doctest: +SKIP
>>> points, certificate = mover.advance(displacement)             # doctest: +SKIP

Functions accept a :class:`Mesh`, a file path, a ``meshio.Mesh`` or a PyVista data set and return new meshes;
they never modify their arguments. :class:`Mover`, :class:`MovingMesh`, :class:`Refinement` and
:class:`Contact` are set up once and then used step after step.
"""
from . import shapes
from ._motet import __version__, formats
from ._cap import cap
from ._changing import Changed, History, implant, mesh, remesh, surface, wall
from ._contact import Ahead, Body, Contact, Gaps
from ._frames import read_log, to_frame
from .errors import Error, FileError, InputError, InternalError, OptionsError
from ._mesh import Mesh, MeshLike, as_mesh, read
from ._motion import Moved, Mover, PointMover, mesh_velocity, move
from ._moving import MovingMesh
from ._refinement import Refinement, refine
from ._report import Report
from ._series import SeriesWriter, read_nodal, read_series, write_nodal
from ._view import View, view

__all__ = [
    "Ahead", "Body", "Changed", "Contact", "Error", "FileError", "Gaps", "History", "InputError", "InternalError", "Mesh", "MeshLike", "Moved", "Mover",
    "MovingMesh", "OptionsError", "PointMover", "Refinement", "Report", "SeriesWriter", "View", "as_mesh", "cap", "formats", "implant", "mesh", "mesh_velocity", "move", "read", "read_log", "read_nodal",
    "read_series", "refine", "remesh", "shapes", "surface", "to_frame", "view", "wall", "write_nodal", "__version__",
]  # fmt: skip
