"""The answer of a study: what the command gives as JSON, with arrays."""

from __future__ import annotations

import html
import math
from typing import Any, Optional

import numpy as np

from .optional import needed
from .values import Value, table_html

MOST_SHOWN = 20  # rows of a table, numbers of a list

_COMPLEX = frozenset(["eigenvalue", "eigenvalues", "multipliers"])  # pairs of real and imaginary part
_OF_COMMAND = ("layout", "exit", "messages")


def converted(key: str, value: Any) -> Any:
    """Lists of numbers as arrays, in which what is not finite or not known is NaN; objects with
    attributes."""
    if isinstance(value, dict):
        return Record(value)
    if not isinstance(value, list):
        return value
    if value and all(isinstance(one, dict) for one in value):
        return Records(value)
    array = _array(value)
    if array is None:
        return [converted(key, one) if isinstance(one, (list, dict)) else one for one in value]
    if key in _COMPLEX and array.ndim >= 1 and array.shape[-1] == 2:
        return array[..., 0] + 1j * array[..., 1]
    return array


def _is_numeric(value: Any) -> bool:
    if isinstance(value, list):
        return all(_is_numeric(one) for one in value)
    return value is None or (isinstance(value, (int, float)) and not isinstance(value, bool))


def _array(value: list[Any]) -> Optional[Any]:
    """An array of numbers; None where these are others, or lists of several lengths."""
    if not _is_numeric(value):
        return None
    try:
        return np.array(value, dtype=float)
    except ValueError:
        return None


class Record(dict[str, Any]):
    """An object of the answer: its fields are attributes, lists of numbers are arrays."""

    def __getattr__(self, name: str) -> Any:
        if name in self:
            return converted(name, self[name])
        raise AttributeError(f"there is no `{name}`; there are {', '.join(self)}", name=name, obj=self)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *(key for key in self if key.isidentifier())]

    def __repr__(self) -> str:
        return "\n".join(_lines(self))

    def _repr_html_(self) -> str:
        return _html_of(self)


class Records(list[Any]):
    """Objects of one kind: ``records[0].step`` is a number, ``records.step`` an array of those of all."""

    def __getitem__(self, place: Any) -> Any:
        found = super().__getitem__(place)
        return Records(found) if isinstance(place, slice) else Record(found)

    def __iter__(self) -> Any:
        return (Record(one) for one in super().__iter__())

    def __getattr__(self, name: str) -> Any:
        if any(name in one for one in list.__iter__(self)):
            return converted(name, [one.get(name) for one in list.__iter__(self)])
        names = ", ".join(dict.fromkeys(key for one in list.__iter__(self) for key in one))
        raise AttributeError(f"there is no `{name}`; there are {names}", name=name, obj=self)

    def __dir__(self) -> list[str]:
        return [
            *super().__dir__(), *(key for one in list.__iter__(self) for key in one if key.isidentifier())
        ]

    def to_pandas(self) -> Any:
        """A ``pandas.DataFrame`` with a row for each."""
        return needed("pandas", "to_pandas()").DataFrame([_flat(one) for one in list.__iter__(self)])

    def __repr__(self) -> str:
        return "\n".join(_table_lines(self))

    def _repr_html_(self) -> str:
        return _records_html(self)


class StudyResult:
    """What a study found.

    The fields of the command's answer are attributes: numbers, arrays (what is not finite or not known is
    NaN), and objects with attributes of their own. ``json`` is the answer as it came: docs/scripting.md and
    the schemas of the command describe it.

    Attributes
    ----------
    verb : str
        Of the command.
    json : dict
    messages : list of dict
    svg : str or None
        The picture, where one was made.
    """

    def __init__(self, verb: str, json: dict[str, Any], svg: Optional[str] = None) -> None:
        self.verb, self.json, self.svg = verb, json, svg

    @property
    def messages(self) -> list[dict[str, Any]]:
        """Warnings and notes."""
        return list(self.json.get("messages", []))

    def _fields(self) -> dict[str, Any]:
        return {key: value for key, value in self.json.items() if key not in _OF_COMMAND}

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or "json" not in self.__dict__:
            raise AttributeError(name)
        if name in self._fields():
            return converted(name, self.json[name])
        raise AttributeError(
            f"the answer of `{self.verb}` has no `{name}`; it has {', '.join(self._fields())}",
            name=name,
            obj=self,
        )

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._fields()]

    def __repr__(self) -> str:
        return "\n".join([f"{self.verb}:", *("  " + line for line in _lines(self._fields()))])

    def _repr_html_(self) -> str:
        return _html_of(self._fields()) + (self.svg or "")


class FitResult(StudyResult):
    """Parameters and initial values from measurements.

    Attributes
    ----------
    values : dict of str to Value
        What was found, by the names of the unknowns, with units; ``model.take(fit)`` sets it.
    deviations : dict of str to float
        The standard deviation of each.
    unknowns : Records
        The same with the ``interval`` of 95 per cent and the ``status`` of each.
    correlations : ndarray, shape (unknowns, unknowns)
    converged : bool
    doubts : list of str
        Why the result may be wrong.
    columns : Records
        Of each column of measurements: ``t``, ``measured``, ``fitted``, ``residuals``, ...
    """

    @property
    def values(self) -> dict[str, Value]:
        """What was found, by name."""
        return {one["name"]: Value(_or_nan(one["value"]), one["unit"] or "") for one in self.json["unknowns"]}

    @property
    def deviations(self) -> dict[str, float]:
        """The standard deviation of each; NaN where there is none."""
        return {one["name"]: _or_nan(one["deviation"]) for one in self.json["unknowns"]}


def _or_nan(value: Any) -> float:
    return math.nan if value is None else float(value)


class LinearModel(StudyResult):
    """``dx/dt = A dx + B du``, ``dy = C dx + D du`` about a point.

    Attributes
    ----------
    A : ndarray, shape (states, states)
    B : ndarray, shape (states, inputs)
    C : ndarray, shape (outputs, states)
    D : ndarray, shape (outputs, inputs)
    states, inputs, outputs : list of str
    x : ndarray, shape (states,)
        The point.
    modes : Records
        ``eigenvalue`` (complex), ``frequency``, ``damping`` of each.
    """

    def _matrix(self, name: str, rows: int, columns: int) -> Any:
        return np.array(self.json[name], dtype=float).reshape(rows, columns)

    @property
    def A(self) -> Any:
        """df/dx."""
        return self._matrix("A", len(self.json["states"]), len(self.json["states"]))

    @property
    def B(self) -> Any:
        """df/du."""
        return self._matrix("B", len(self.json["states"]), len(self.json["inputs"]))

    @property
    def C(self) -> Any:
        """dy/dx."""
        return self._matrix("C", len(self.json["outputs"]), len(self.json["states"]))

    @property
    def D(self) -> Any:
        """dy/du."""
        return self._matrix("D", len(self.json["outputs"]), len(self.json["inputs"]))

    def to_control(self) -> Any:
        """The same as a ``control.StateSpace`` of python-control.

        A model without inputs or outputs gets one input and one output per state, so that there is a system:
        its B is zero, its C the identity.
        """
        control = needed("control", "to_control()")
        states, inputs, outputs = (list(self.json[key]) for key in ("states", "inputs", "outputs"))
        b, c = self.B, self.C
        if not inputs:
            inputs, b = ["u"], np.zeros((len(states), 1))
        if not outputs:
            outputs, c = [f"y_{name}" for name in states], np.eye(len(states))
        d = self.D if self.D.size else np.zeros((len(outputs), len(inputs)))
        return control.ss(self.A, b, c, d, states=states, inputs=inputs, outputs=outputs)


# ---- how answers are shown ---------------------------------------------------------------------------------


def _short(value: Any, key: str = "") -> str:
    if key in _COMPLEX and isinstance(value, list):
        numbers = np.ravel(converted(key, value))
        return ", ".join(f"{number:.5g}" for number in numbers[:4]) + (", ..." if numbers.size > 4 else "")
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, list):
        array = _array(value)
        if array is not None and array.ndim > 1:
            return f"array of shape {array.shape}"
        if len(value) > MOST_SHOWN or any(isinstance(one, (list, dict)) for one in value):
            return f"{len(value)} values"
        return ", ".join(_short(one) for one in value)
    return "-" if value is None else str(value)


def _flat(record: dict[str, Any]) -> dict[str, Any]:
    """Fields of fields as ``order.global``."""
    flat: dict[str, Any] = {}
    for key, value in record.items():
        if isinstance(value, dict):
            flat.update({f"{key}.{inner}": one for inner, one in value.items()})
        else:
            flat[key] = value
    return flat


def _table(records: Any) -> tuple[list[str], list[list[str]]]:
    flat = [_flat(one) for one in list.__iter__(records)][:MOST_SHOWN]
    keys = list(dict.fromkeys(key for one in flat for key in one))
    return keys, [[_short(one.get(key), key.split(".")[-1]) for key in keys] for one in flat]


def _table_lines(records: Any) -> list[str]:
    keys, rows = _table(records)
    widths = [max(len(row[i]) for row in [keys, *rows]) for i in range(len(keys))]
    lines = [
        "  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() for row in [keys, *rows]
    ]
    return lines + ([f"... {len(records)} in all"] if len(records) > MOST_SHOWN else [])


def _is_table(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and all(isinstance(one, dict) for one in value)


def _lines(fields: dict[str, Any]) -> list[str]:
    lines = []
    for key, value in fields.items():
        if _is_table(value):
            lines += [f"{key}:", *("  " + line for line in _table_lines(value))]
        elif isinstance(value, dict):
            lines += [f"{key}:", *("  " + line for line in _lines(value))]
        else:
            lines.append(f"{key}: {_short(value, key)}")
    return lines


def _records_html(records: Any) -> str:
    keys, rows = _table(records)
    more = f"<div>{len(records)} in all</div>" if len(records) > MOST_SHOWN else ""
    return table_html(keys, rows) + more


def _html_of(fields: dict[str, Any]) -> str:
    plain = [
        [key, _short(v, key)] for key, v in fields.items() if not _is_table(v) and not isinstance(v, dict)
    ]
    parts = [table_html(["", "value"], plain)] if plain else []
    for key, value in fields.items():
        if _is_table(value):
            parts.append(f"<div><b>{html.escape(key)}</b></div>{_records_html(value)}")
        elif isinstance(value, dict):
            parts.append(f"<div><b>{html.escape(key)}</b></div>{_html_of(value)}")
    return "".join(parts)
