"""SciPy's own tests of solve_ivp and its classes, run against continuo: those of the SciPy that is installed."""

import importlib.util
import pathlib
from typing import Any

import pytest

# What is different on purpose, with the reason.
DIFFERENCES = {
    "test_coefficient_properties": "reads the tableaus of SciPy's classes, which are private",
    "test_error_estimation": "calls a private method of SciPy's classes",
    "test_error_estimation_complex": "calls a private method of SciPy's classes",
}
# The same for single lines: what is tested instead.
CHANGES = {
    "assert res.nlu < 6": (
        "assert res.nlu < 8",
        "a complex component is integrated as two real ones: other step sizes, and two decompositions more by BDF",
    ),
}


def _tests() -> dict[str, Any]:
    spec = importlib.util.find_spec("scipy")
    if spec is None or spec.origin is None:
        return {}
    folder = pathlib.Path(spec.origin).parent / "integrate" / "_ivp" / "tests"
    tests: dict[str, Any] = {}
    for name in ("test_ivp.py", "test_rk.py"):
        path = folder / name
        if not path.exists():
            continue
        source = path.read_text().replace("from scipy.integrate import", "from continuo import")
        source = source.replace(
            "from scipy.integrate._ivp.base import ConstantDenseOutput",
            "from continuo.dense import ConstantDenseOutput",
        )
        for line, (instead, _) in CHANGES.items():
            source = source.replace(line, instead)
        names: dict[str, Any] = {"__name__": "scipy_" + path.stem, "__file__": str(path)}
        exec(compile(source, str(path), "exec"), names)
        tests.update((key, value) for key, value in names.items() if key.startswith("test_"))
    return tests


_found = _tests()
for _name, _test in _found.items():
    if _name in DIFFERENCES:
        _test = pytest.mark.skip(reason=DIFFERENCES[_name])(_test)
    globals()[_name] = _test


@pytest.mark.skipif(bool(_found), reason="SciPy's tests are there")
def test_without_scipy() -> None:
    pytest.skip("SciPy's tests are not installed")
