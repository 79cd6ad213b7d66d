"""Numbers of a model with their units: its parameters, inputs, states and outputs as mappings."""

from __future__ import annotations

import difflib
import html
from collections.abc import Iterable, Iterator, Mapping, MutableMapping
from typing import Any, Callable, Optional

MOST_ROWS = 40  # of a table in a notebook


class Value(float):
    """A number of a model: a float that knows its unit.

    Attributes
    ----------
    unit : str
        As the model has it; empty where it has none.
    description : str
        What the author wrote beside it.
    range : tuple of float or None
        The smallest and the largest value that the author means.
    """

    unit: str
    description: str
    range: Optional[tuple[float, float]]

    def __new__(
        cls, value: float, unit: str = "", description: str = "", range: Optional[tuple[float, float]] = None
    ) -> "Value":
        self = super().__new__(cls, value)
        self.unit, self.description, self.range = unit, description, range
        return self

    def __repr__(self) -> str:
        number = float.__repr__(self)
        return f"{number} {self.unit}" if self.unit else number

    def __reduce__(self) -> tuple[Any, ...]:
        return Value, (float(self), self.unit, self.description, self.range)


def did_you_mean(name: str, names: Iterable[str]) -> str:
    """ "did you mean `k`?", else all of the names if they are few; may be empty."""
    known = list(names)
    near = difflib.get_close_matches(name, known, n=3, cutoff=0.6)
    if near:
        return "did you mean " + " or ".join(f"`{one}`" for one in near) + "?"
    return f"there are {', '.join(known)}" if 0 < len(known) <= 20 else ""


class Values(Mapping[str, Value]):
    """Numbers of a model by their names.

    In a notebook it shows itself as a table.
    """

    def __init__(self, what: str, read: Callable[[], dict[str, Value]]) -> None:
        self._what, self._read = what, read

    def __getitem__(self, name: str) -> Value:
        values = self._read()
        if name not in values:
            raise KeyError(
                f"the model has no {self._what} `{name}`; {did_you_mean(str(name), values)}".rstrip("; ")
            )
        return values[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._read())

    def __len__(self) -> int:
        return len(self._read())

    def __repr__(self) -> str:
        values = self._read()
        width = max((len(name) for name in values), default=0)
        lines = [
            f"{name:<{width}}  {value!r}" + (f"  # {value.description}" if value.description else "")
            for name, value in list(values.items())[:MOST_ROWS]
        ]
        if len(values) > MOST_ROWS:
            lines.append(f"... {len(values)} in all")
        return "\n".join(lines) or f"no {self._what}s"

    def _repr_html_(self) -> str:
        rows = [
            [name, f"{float(value):.10g}", value.unit, _range_text(value.range), value.description]
            for name, value in list(self._read().items())[:MOST_ROWS]
        ]
        more = f"<div>{len(self)} in all</div>" if len(self) > MOST_ROWS else ""
        return table_html([self._what, "value", "unit", "range", "description"], rows) + more

    def _ipython_key_completions_(self) -> list[str]:
        return list(self)


class SettableValues(Values, MutableMapping[str, Value]):
    """The same, of which each can be set for the runs to come; ``del`` gives it back the value in the
    text."""

    def __init__(
        self,
        what: str,
        read: Callable[[], dict[str, Value]],
        write: Callable[[str, Any], None],
        forget: Callable[[str], None],
    ) -> None:
        super().__init__(what, read)
        self._write, self._forget = write, forget

    def __setitem__(self, name: str, value: Any) -> None:
        self[name]  # the names that there are: a KeyError says so
        self._write(name, value)

    def __delitem__(self, name: str) -> None:
        self[name]
        self._forget(name)


def _range_text(range: Optional[tuple[float, float]]) -> str:
    return f"{range[0]:g} .. {range[1]:g}" if range else ""


def table_html(header: list[str], rows: list[list[Any]]) -> str:
    """A small table. Columns in which nothing stands are left out."""
    used = [i for i in range(len(header)) if any(str(row[i]) for row in rows)] if rows else list(
        range(len(header))
    )
    head = "".join(f"<th>{html.escape(header[i])}</th>" for i in used)
    body = "".join(
        "<tr>" + "".join(f"<td>{html.escape(str(row[i]))}</td>" for i in used) + "</tr>" for row in rows
    )
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"
