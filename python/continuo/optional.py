"""Packages that only some functions need."""

from __future__ import annotations

import importlib
from typing import Any


def needed(package: str, what: str) -> Any:
    """The package.

    Raises
    ------
    ImportError
        Where it is not installed; the message says what needs it.
    """
    try:
        return importlib.import_module(package)
    except ImportError as error:
        name = package.split(".")[0]
        raise ImportError(f"{what} needs {name}: python3 -m pip install {name}", name=name) from error
