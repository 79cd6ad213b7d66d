"""Runs tests that SciPy has installed with names of SciPy replaced by ours."""

import importlib
from typing import Any

import pytest


def borrow(module_name: str, replaced: dict[str, Any], differences: dict[str, str] | None = None) -> dict[str, Any]:
    """The tests of an installed module, in whose namespace names are replaced.

    `differences` has the names of tests that are not run, as 'test_name' or 'TestClass.test_name', each with
    the reason.
    """
    module = pytest.importorskip(module_name, reason="SciPy and its tests are not installed")
    module = importlib.reload(module)  # a copy of its own would be better, but its classes refer to its globals
    for name, ours in replaced.items():
        if not hasattr(module, name):
            raise AttributeError(f"{module_name} has no {name} to be replaced")
        setattr(module, name, ours)
    for name, reason in (differences or {}).items():
        owner, _, test = name.rpartition(".")
        holder = getattr(module, owner) if owner else module
        setattr(holder, test, pytest.mark.skip(reason=reason)(getattr(holder, test)))
    return {name: value for name, value in vars(module).items() if name.startswith(("test_", "Test"))}
