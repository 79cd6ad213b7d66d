"""Right-hand sides in C for the tests, compiled once where there is a compiler."""

import ctypes
import functools
import pathlib
import shutil
import subprocess
import tempfile
from typing import Any

import pytest

_SOURCE = """
void lorenz(double t, const double *y, double *dydt, void *user) {
  dydt[0] = 10 * (y[1] - y[0]);
  dydt[1] = y[0] * (28 - y[2]) - y[1];
  dydt[2] = y[0] * y[1] - 8.0 / 3 * y[2];
}
void lorenz_without_user(double t, const double *y, double *dydt) { lorenz(t, y, dydt, 0); }
void decay(double t, const double *y, double *dydt, void *user) { dydt[0] = -*(const double *)user * y[0]; }
void oscillator(double t, const double *x, double *a, void *user) { a[0] = -x[0]; }
void robertson(double t, const double *y, double *dydt, void *user) {
  dydt[0] = -0.04 * y[0] + 1e4 * y[1] * y[2];
  dydt[2] = 3e7 * y[1] * y[1];
  dydt[1] = -dydt[0] - dydt[2];
}
void robertson_jacobian(double t, const double *y, double *rows, void *user) {
  rows[0] = -0.04, rows[1] = 1e4 * y[2], rows[2] = 1e4 * y[1];
  rows[7] = 6e7 * y[1];
  rows[3] = 0.04, rows[4] = -rows[1] - rows[7], rows[5] = -rows[2];
}
"""


@functools.cache
def library() -> ctypes.CDLL:
    """Give the library; skips the test where there is no compiler."""
    compiler = shutil.which("cc")
    if compiler is None:
        pytest.skip("no C compiler")
    folder = pathlib.Path(tempfile.mkdtemp())
    (folder / "functions.c").write_text(_SOURCE)
    subprocess.run(
        [compiler, "-O2", "-shared", "-fPIC", "-o", folder / "functions.so", folder / "functions.c"], check=True
    )
    return ctypes.CDLL(str(folder / "functions.so"))


def function(name: str, arguments: int = 4) -> Any:
    """Give a function of the library with its types."""
    numbers = ctypes.POINTER(ctypes.c_double)
    found = library()[name]
    found.restype = None
    found.argtypes = [ctypes.c_double, numbers, numbers, ctypes.c_void_p][:arguments]
    return found


def address(name: str) -> int:
    """Give the address of a function of the library."""
    found = ctypes.cast(library()[name], ctypes.c_void_p).value
    assert found is not None
    return found
