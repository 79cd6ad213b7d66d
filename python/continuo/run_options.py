"""What stands behind the keywords of a run: numbers, texts with units, tolerances; and the warnings of the
library."""

from __future__ import annotations

import difflib
import math
import re
import sys
import warnings
from pathlib import Path
from typing import Any, Callable, Mapping, Optional, Union

from .errors import ModelError, ModelWarning, parsed

Tolerance = Union[float, Mapping[str, float]]

_Reader = Callable[[str], tuple[Optional[float], Optional[tuple[str, str]]]]

_BARE_UNIT = re.compile(r"\s*([-+]?[0-9.]+(?:[eE][-+]?[0-9]+)?)\s+([^\W\d_%°][^\[\]]*?)\s*$")  # 3 km/h


def warn(text: str) -> None:
    """Warns whoever called the package, unless there is nothing to say."""
    if text:
        warnings.warn(text, ModelWarning, stacklevel=outside())


def outside() -> int:
    """How many frames lie between the warning and whoever called the package."""
    depth, frame = 1, sys._getframe(1)
    while frame.f_back is not None and frame.f_globals.get("__name__", "").startswith("continuo."):
        depth, frame = depth + 1, frame.f_back
    return depth


def contents(path: Path) -> bytes:
    """The bytes of a file; an error says which one may have been meant."""
    try:
        return path.read_bytes()
    except FileNotFoundError as error:
        near = difflib.get_close_matches(path.name, [one.name for one in path.parent.glob("*.sim")], n=1)
        hint = f"; did you mean {path.parent / near[0]}?" if near else ""
        if "\n" in str(path):
            hint = '; a text is given by Model(text="...")'
        raise FileNotFoundError(error.errno, f"{error.strerror}{hint}", str(path)) from None


def number(name: str, value: Any) -> float:
    """A finite number.

    Raises
    ------
    TypeError, ValueError
        The message names what was given.
    """
    if isinstance(value, (bool, str, bytes)) or getattr(value, "ndim", 0) != 0:
        raise TypeError(f"{name} is one number, not {value!r}")
    try:
        converted = float(value)
    except (TypeError, ValueError):
        hint = "; several values are a sweep: model.sweep(...)" if hasattr(value, "__len__") else ""
        raise TypeError(f"{name} is one number, not {value!r}{hint}") from None
    except OverflowError:
        raise ValueError(f"{name} is too large for a number of 64 bits") from None
    if not math.isfinite(converted):
        raise ValueError(f"{name} is a finite number, not {converted}")
    return converted


def number_or_text(name: str, value: Any) -> Union[float, str]:
    """A number; or a text with its unit in brackets, as the command line takes it."""
    if not isinstance(value, str):
        return number(name, value)
    bare = _BARE_UNIT.match(value)
    return f"{bare.group(1)} [{bare.group(2)}]" if bare else value


def read_setting(reader: _Reader, name: str, value: Union[float, str]) -> float:
    """The value as the command line reads it, in the unit of its declaration."""
    read, messages = reader(f"{name} = {value!r}" if isinstance(value, float) else f"{name} = {value}")
    text, data = parsed(messages)
    if read is None:
        raise ModelError(text, data)
    warn(text)
    return read


def text_option(name: str, value: Any) -> str:
    """A text."""
    if not isinstance(value, str):
        raise TypeError(f"{name} is a str, not {value!r}")
    return value


def count_option(name: str, value: Any) -> int:
    """A whole number from 1 on."""
    count = number(name, value)
    if count != int(count) or count < 1:
        raise ValueError(f"{name} is a whole number from 1 on, not {value!r}")
    return int(count)


def put_numbers(asked: dict[str, Any], **numbers: Any) -> None:
    """Those that are given."""
    for name, value in numbers.items():
        if value is not None:
            asked[name] = number("until" if name == "to" else name, value)


def put_tolerances(
    asked: dict[str, Any], tol: Optional[Tolerance], rtol: Optional[Tolerance], atol: Optional[Tolerance]
) -> None:
    """Those that are given, of all states or of single ones."""
    if tol is not None and rtol is not None:
        raise TypeError("tol and rtol are two names of the relative tolerance: give one of them")
    for name, value in (("rtol", rtol if tol is None else tol), ("atol", atol)):
        if isinstance(value, Mapping):
            asked[f"{name}_of"] = {str(key): _tolerance(name, one) for key, one in value.items()}
        elif value is not None:
            asked[name] = _tolerance(name, value)


def _tolerance(name: str, value: Any) -> float:
    tolerance = number(name, value)
    if not tolerance > 0 or (name == "rtol" and tolerance >= 1):
        kind = "between 0 and 1" if name == "rtol" else "greater than 0"
        raise ValueError(f"{name} is {kind}, not {tolerance:g}")
    return tolerance
