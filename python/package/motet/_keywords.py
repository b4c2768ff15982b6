"""Checks of keyword arguments: the error for an unknown keyword suggests the closest known one."""
from __future__ import annotations

import difflib
import functools
import inspect
from collections.abc import Callable
from typing import Any, TypeVar

from ._progress import shown

Function = TypeVar("Function", bound=Callable[..., Any])
Class = TypeVar("Class", bound=type)


def checked(function: Function) -> Function:
    """Decorate a function: unknown keywords raise a TypeError that suggests the closest known one, and
    ``progress`` may be True; see :func:`motet._progress.shown`."""
    known = [p.name for p in inspect.signature(function).parameters.values() if p.kind is not p.POSITIONAL_ONLY and p.name not in ("self", "cls")]
    allowed = frozenset(known)
    shows_progress = "progress" in allowed

    @functools.wraps(function)
    def call(*args: Any, **kwargs: Any) -> Any:
        if not allowed.issuperset(kwargs):
            unknown = next(name for name in kwargs if name not in allowed)
            name = function.__qualname__.removesuffix(".__init__")
            nearest = difflib.get_close_matches(unknown, known, n=1, cutoff=0.5)
            hint = f"did you mean {nearest[0]!r}?" if nearest else f"it takes {', '.join(known) or 'none'}"
            raise TypeError(f"{name}() has no keyword {unknown!r}: {hint}")
        if not shows_progress:
            return function(*args, **kwargs)
        with shown(function.__qualname__.removesuffix(".__init__"), kwargs.get("progress")) as kwargs["progress"]:
            return function(*args, **kwargs)

    return call  # type: ignore[return-value]


def checked_class(cls: Class) -> Class:
    """Decorate a class: its constructor and its public methods are :func:`checked`."""
    for name, member in list(vars(cls).items()):
        if name.startswith("_") and name != "__init__":
            continue
        if isinstance(member, classmethod):
            setattr(cls, name, classmethod(checked(member.__func__)))
        elif inspect.isfunction(member) and not any(p.kind is p.VAR_KEYWORD for p in inspect.signature(member).parameters.values()):
            setattr(cls, name, checked(member))
    return cls


class NotPickled:
    """Base of classes that cannot be pickled; the error says what can be stored instead."""

    _instead = ""

    def __reduce__(self) -> Any:
        raise TypeError(f"a motet.{type(self).__name__} cannot be pickled or copied: {self._instead}")
