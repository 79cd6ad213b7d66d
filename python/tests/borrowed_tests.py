"""Runs tests that SciPy has installed with names of SciPy replaced by ours."""

import importlib.util
import pathlib
from typing import Any

import pytest


def borrow(
    module_name: str,
    replaced: dict[str, Any],
    differences: dict[str, str] | None = None,
    changes: dict[str, tuple[str, str]] | None = None,
) -> dict[str, Any]:
    """The tests of an installed module, in whose namespace names are replaced.

    `differences` has the names of tests that are not run, as 'test_name' or 'TestClass.test_name', each with
    the reason; `changes` has lines of the tests, what is tested instead, and the reason.
    """
    try:
        spec = importlib.util.find_spec(module_name)
    except ModuleNotFoundError:
        spec = None
    if spec is None or spec.origin is None:
        return {"test_scipy": pytest.mark.skip(reason=f"{module_name} is not installed")(lambda: None)}
    source = pathlib.Path(spec.origin).read_text()
    for line, (instead, _) in (changes or {}).items():
        assert line in source, f"{module_name} has no line {line!r} to be changed"
        source = source.replace(line, instead)
    names: dict[str, Any] = {"__name__": f"borrowed_{module_name}", "__file__": spec.origin}
    exec(compile(source, spec.origin, "exec"), names)
    for name, ours in replaced.items():
        assert name in names, f"{module_name} has no {name} to be replaced"
        names[name] = ours
    for name in [name for name in names if name.startswith("Test")]:
        for attribute, value in vars(names[name]).items():
            if attribute == "ode_class" and value is not None:
                names[name].ode_class = replaced[value.__name__]
    for name, reason in (differences or {}).items():
        owner, _, test = name.rpartition(".")
        if owner:
            setattr(names[owner], test, pytest.mark.skip(reason=reason)(getattr(names[owner], test)))
        else:
            names[test] = pytest.mark.skip(reason=reason)(names[test])
    return {name: value for name, value in names.items() if name.startswith(("test_", "Test"))}
