"""Reports: dictionaries with attribute access that are shown as tables in notebooks."""
from __future__ import annotations

import html
from typing import Any


class Report(dict):
    """Statistics of a call: a dictionary whose entries are also attributes.

    >>> Report(before={"bad": 12}).before.bad
    12
    """

    def __getattr__(self, name: str) -> Any:
        try:
            return self[name]
        except KeyError:
            raise AttributeError(f"the report has no {name!r}; it has {', '.join(map(str, self))}") from None

    def __dir__(self):
        return [*super().__dir__(), *(name for name in self if isinstance(name, str))]

    def __repr__(self) -> str:
        return "\n".join(lines(self)) or "Report()"

    def to_frame(self) -> Any:
        """Return the report as a pandas.DataFrame of one row; see :func:`motet.to_frame`."""
        from ._frames import to_frame

        return to_frame(self)

    def _repr_html_(self) -> str:
        return table(self)


def report(value: Any) -> Any:
    """Convert all dictionaries in nested lists and dictionaries to reports."""
    if isinstance(value, dict):
        return Report({name: report(entry) for name, entry in value.items()})
    if isinstance(value, (list, tuple)):
        return [report(entry) for entry in value]
    return value


# Number of entries of a list that are shown.
FIRST = 8


def short(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.4g}"
    if isinstance(value, (list, tuple)):
        more = f", .. {len(value)} in all" if len(value) > FIRST else ""
        return "[" + ", ".join(short(one) for one in value[:FIRST]) + more + "]"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{name}: {short(one)}" for name, one in value.items()) + "}"
    return str(value)


def lines(entries: dict, indent: str = "") -> list[str]:
    width = max((len(str(name)) for name in entries), default=0)
    all_lines = []
    for name, value in entries.items():
        if isinstance(value, dict) and value:
            all_lines += [f"{indent}{name}", *lines(value, indent + "  ")]
        else:
            all_lines.append(f"{indent}{str(name):{width}}  {short(value)}")
    return all_lines


def table(entries: dict) -> str:
    def row(name: Any, value: Any) -> str:
        inner = table(value) if isinstance(value, dict) and value else html.escape(short(value))
        return f"<tr><th style='text-align:left'>{html.escape(str(name))}</th><td style='text-align:left'>{inner}</td></tr>"

    return "<table>" + "".join(row(name, value) for name, value in entries.items()) + "</table>"
