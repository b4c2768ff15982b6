"""Stages of a call, shown as they go on, or logged."""
from __future__ import annotations

import logging
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

Progress = Callable[[str, int, int], object]
"""A function ``progress(stage, done, total)``; ``total`` is 0 if unknown."""

log = logging.getLogger("motet")


@contextmanager
def shown(call: str, progress: Any) -> Iterator[Any]:
    """Give the function that is told the stages of a call: the given one, or bars if it is True.

    Without one, the stages are logged where the logger ``motet`` shows messages of level INFO.
    """
    if progress is True:
        bars = _Bars()
        try:
            yield bars
        finally:
            bars.close()
    elif progress is None or progress is False:
        yield _Logged(call) if log.isEnabledFor(logging.INFO) else None
    else:
        yield progress


class _Logged:
    """Logs each stage once."""

    def __init__(self, call: str):
        self.call, self.stage = call, ""

    def __call__(self, stage: str, done: int, total: int) -> None:
        if stage != self.stage:
            self.stage = stage
            log.info("%s: %s", self.call, stage)


class _Bars:
    """A bar for each stage: tqdm's if it is installed, otherwise one line of text on standard error."""

    def __init__(self) -> None:
        try:
            from tqdm.auto import tqdm
        except ImportError:
            tqdm = _Line
        self.bar_of, self.stage = tqdm, ""
        self.bar: Any = None

    def __call__(self, stage: str, done: int, total: int) -> None:
        if stage != self.stage or self.bar is None:
            self.close()
            self.stage, self.bar = stage, self.bar_of(desc=stage, total=total or None)
        if total:
            self.bar.total = total
        self.bar.n = done
        self.bar.refresh()

    def close(self) -> None:
        if self.bar is not None:
            self.bar.close()
            self.bar = None


class _Line:
    """One line that shows a stage; has what is used of a bar of tqdm."""

    def __init__(self, desc: str, total: int | None):
        self.desc, self.total, self.n = desc, total, 0

    def refresh(self) -> None:
        text = f"{self.desc}: {100 * self.n // self.total} %" if self.total else self.desc
        sys.stderr.write(f"\r{text:<60}")
        sys.stderr.flush()

    def close(self) -> None:
        self.refresh()
        sys.stderr.write("\n")
