"""What can go wrong. Each error says what was expected and what came, in which file, where, and what to do."""
from __future__ import annotations

from pathlib import Path


class Error(Exception):
    """Any error of motet.

    Attributes
    ----------
    what : str
        What was expected and what came.
    file : pathlib.Path or None
    place : str or None
        Where in the file or the mesh: a line, a cell, an array.
    remedy : str or None
        What can be done about it.
    """

    def __init__(self, message: str, what: str = "", file: Path | None = None, place: str | None = None, remedy: str | None = None):
        super().__init__(message)
        self.what = what or message
        self.file = file
        self.place = place
        self.remedy = remedy


class InputError(Error, ValueError):
    """Data that cannot be read, or are not what is needed."""


class FileError(Error, OSError):
    """The operating system refused a file."""


class InternalError(Error, RuntimeError):
    """An internal error in motet: please report it, with the call. A handle may be left in a state that means nothing."""


class OptionsError(Error, ValueError):
    """Words of a call that mean nothing, or not together."""
