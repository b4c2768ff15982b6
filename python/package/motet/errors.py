"""Errors. Each states what was expected and found, in which file and where, and how to correct it."""
from __future__ import annotations

from pathlib import Path


class Error(Exception):
    """Base class of all errors of motet.

    Attributes
    ----------
    what : str
        What was expected and what was found.
    file : pathlib.Path or None
        The file concerned.
    place : str or None
        Position in the file or the mesh: a line, a cell or an array.
    remedy : str or None
        How to correct the error.
    """

    def __init__(self, message: str, what: str = "", file: Path | None = None, place: str | None = None, remedy: str | None = None):
        super().__init__(message)
        self.what = what or message
        self.file = file
        self.place = place
        self.remedy = remedy


class InputError(Error, ValueError):
    """Input data cannot be read or are not valid."""


class FileError(Error, OSError):
    """The operating system could not open, read or write a file."""


class InternalError(Error, RuntimeError):
    """An internal error in motet: please report it, with the call.

    Objects used in the call may be left in an invalid state.
    """


class OptionsError(Error, ValueError):
    """Options of a call are not valid, or contradict each other."""
