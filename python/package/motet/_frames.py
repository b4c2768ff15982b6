"""Reports and logs as data frames of pandas, which is imported only here."""
from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from ._keywords import checked
from .errors import FileError, InputError


@checked
def to_frame(reports: Mapping[str, Any] | Iterable[Mapping[str, Any]]) -> Any:
    """Convert reports to a data frame.

    Parameters
    ----------
    reports : mapping or iterable of mappings
        One report, or several, such as those of the steps of a :class:`MovingMesh`.

    Returns
    -------
    pandas.DataFrame
        A row for each report and a column for each number or text in it: ``quality.mean`` for
        ``report.quality.mean``. Lists stay as they are.
    """
    import pandas

    rows = [reports] if isinstance(reports, Mapping) else reports
    return pandas.DataFrame([_flat(row) for row in rows])


@checked
def read_log(path: str | os.PathLike[str]) -> Any:
    """Read the log of ``motet run``.

    Parameters
    ----------
    path : path-like
        The log, ``NAME.jsonl``, or the series beside it, ``NAME.pvd``.

    Returns
    -------
    pandas.DataFrame
        A row for each step, indexed by ``step``, with the columns of :func:`to_frame`, the number of
        ``changes``, and the times of ``NAME.times.jsonl`` where that exists (``seconds.total``, ...). The
        changes themselves are in the column ``change_list``.

    Raises
    ------
    FileError
        If the file cannot be opened.
    InputError
        If a line of it is not a JSON object; a last line without an end, of a run that goes on, is left out.
    """
    log = Path(path).with_suffix(".jsonl")
    rows = _lines(log)
    for row in rows:
        row["change_list"] = row.pop("changes", [])
        row["changes"] = len(row["change_list"])
    frame = to_frame(rows).set_index("step")
    times = log.with_suffix(".times.jsonl")
    return frame.join(to_frame(_lines(times)).set_index("step")) if times.exists() else frame


def _lines(path: Path) -> list[dict[str, Any]]:
    try:
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise FileError(f"{path}: {error.strerror}") from error
    rows = {}
    # A run that was killed and goes on writes the steps after its state again.
    for number, line in enumerate(text[: text.rfind("\n") + 1].splitlines(), 1):
        try:
            row = json.loads(line)
            rows[row["step"]] = row
        except (ValueError, TypeError, KeyError) as error:
            raise InputError(f"{path}: line {number}: not a step of a log: {error}") from error
    return list(rows.values())


def _flat(entries: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    flat: dict[str, Any] = {}
    for name, value in entries.items():
        if isinstance(value, Mapping):
            flat |= _flat(value, f"{prefix}{name}.")
        else:
            flat[f"{prefix}{name}"] = value
    return flat
