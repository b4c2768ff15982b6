"""Files that motet knows and meshio does not, for ``meshio.read`` and ``meshio.write``: import this module once.

>>> import meshio                                                    # doctest: +SKIP
>>> import motet.meshio                                              # doctest: +SKIP
>>> mesh = meshio.read("case.foam")                                  # doctest: +SKIP

meshio's own readers and writers stay as they are.
"""
from __future__ import annotations

from typing import Any

import meshio

from ._motet import formats
from ._mesh import Mesh, read


def _read(path: Any) -> Any:
    return read(path).to_meshio()


def _write(path: Any, mesh: Any, **_: Any) -> None:
    Mesh.from_meshio(mesh).save(path)


def _register() -> None:
    known = {extension: can_write for extension, can_write in formats().items() if "/" not in extension and extension not in meshio.extension_to_filetypes}
    for extension, can_write in known.items():
        name = f"motet{extension}"
        meshio.register_format(name, [extension], _read, {name: _write} if can_write else {})


_register()
