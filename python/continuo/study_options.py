"""Keywords of a study as options of the command."""

from __future__ import annotations

import os
from typing import Any, Mapping, Optional

import numpy as np

_LISTS = ("NAMES", "STATES", "RTOL,...", "H,...")  # options whose values are separated by commas


def dashed(name: str) -> str:
    return name.rstrip("_").replace("_", "-")


def joined(names: Any, by: str) -> Optional[str]:
    return names if names is None or isinstance(names, str) else by.join(str(name) for name in names)


def told_apart(
    declared: Mapping[str, Mapping[str, Any]], options: Mapping[str, Any]
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Options of the verb, without those that are None; and what is left: parameters."""
    names = {dashed(name) for name in options}
    own = {name for name in names if f"--{name}" in declared or f"-{name}" in declared} - {
        "json", "set", "help"
    }
    options = {name: value for name, value in options.items() if value is not None}
    asked = {dashed(name): value for name, value in options.items() if dashed(name) in own}
    unknown = {name: value for name, value in options.items() if dashed(name) not in own}
    return asked, unknown


def arguments_of(verb: str, declared: Mapping[str, Mapping[str, Any]], asked: Mapping[str, Any]) -> list[str]:
    arguments: list[str] = []
    for name, value in asked.items():
        long = f"--{name}" if f"--{name}" in declared else f"-{name}"
        option = declared[long]
        if not option["value"]:
            if not isinstance(value, (bool, np.bool_)):
                raise TypeError(f"{name} of {verb} is True or False, not {value!r}")
            texts: list[Optional[str]] = [None] if value else []
        else:
            texts = list(_texts_of(f"{name} of {verb}", option, value))
        for text in texts:
            arguments += [long] if text is None else [
                f"{long}={text}"
            ] if long.startswith("--") else [long, text]
    return arguments


def _texts_of(name: str, option: Mapping[str, Any], value: Any) -> list[str]:
    kind = option["value"]
    if isinstance(value, Mapping):
        pairs = [f"{key}={text_of(name, one)}" for key, one in value.items()]
        if ";" in kind:
            return [";".join(pairs)]
        if len(pairs) > 1 and not option["repeated"]:
            raise TypeError(f"{name} takes one name: {{{next(iter(value))!r}: ...}}")
        return pairs
    if "FILE" in kind and not isinstance(value, (list, tuple)):
        return [os.path.abspath(os.fsdecode(value))]
    if isinstance(value, str) and kind in _LISTS:
        value = [one.strip() for one in value.split(",")]
    if isinstance(value, str) or not hasattr(value, "__iter__"):
        return [text_of(name, value)]
    texts = [text for one in value for text in (_texts_of(name, option, one) if isinstance(one, Mapping)
                                                else [text_of(name, one)])]  # fmt: skip
    if kind in _LISTS:
        return [",".join(texts)] if texts else []
    if not option["repeated"]:
        raise TypeError(f"{name} takes one value, not {value!r}")
    return texts


def text_of(name: str, value: Any) -> str:
    """A number, a name, or a range."""
    if isinstance(value, str):
        return value
    if isinstance(value, tuple) and len(value) == 2:
        return "..".join("" if end is None else text_of(name, end) for end in value)
    if isinstance(value, (bool, np.bool_)) or np.ndim(value) != 0:
        raise TypeError(f"{name} cannot be {value!r}")
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    try:
        return repr(float(value))
    except (TypeError, ValueError):
        raise TypeError(f"{name} cannot be {value!r}") from None
