"""odeint and the loop of ode beside SciPy's: time and true error, in one run.

OPENBLAS_NUM_THREADS=1 PYTHONPATH=build/python python3 bench/python/ode.py

The compiled functions need a C compiler, cc.
"""

import ctypes
import pathlib
import subprocess
import tempfile
from collections.abc import Callable
from typing import Any

import numpy as np
import scipy.integrate
from beside import least_times, versions

import continuo

SOURCE = """
void lorenz(double t, const double* y, double* f, void* user) {
  f[0] = 10 * (y[1] - y[0]), f[1] = y[0] * (28 - y[2]) - y[1], f[2] = y[0] * y[1] - 8.0 / 3 * y[2];
}
void robertson(double t, const double* y, double* f, void* user) {
  f[0] = -0.04 * y[0] + 1e4 * y[1] * y[2], f[2] = 3e7 * y[1] * y[1], f[1] = -f[0] - f[2];
}
"""


def compiled() -> ctypes.CDLL:
    folder = pathlib.Path(tempfile.mkdtemp())
    (folder / "f.c").write_text(SOURCE)
    subprocess.run(["cc", "-O2", "-shared", "-fPIC", "-o", folder / "f.so", folder / "f.c"], check=True)
    library = ctypes.CDLL(str(folder / "f.so"))
    for function in (library.lorenz, library.robertson):
        function.argtypes = [ctypes.c_double, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p]
        function.restype = None
    return library


def lorenz(y: Any, t: float) -> list[float]:
    a, b, c = y
    return [10 * (b - a), a * (28 - c) - b, a * b - 8 / 3 * c]


def robertson(y: Any, t: float) -> list[float]:
    a, b, c = y
    first, third = -0.04 * a + 1e4 * b * c, 3e7 * b * b
    return [first, -first - third, third]


def oscillator(t: float, y: Any) -> list[float]:
    return [y[1], -y[0]]


def reference(f: Callable[..., Any], y0: list[float], t: np.ndarray, method: str) -> np.ndarray:
    return scipy.integrate.solve_ivp(lambda t, y: f(y, t), (t[0], t[-1]), y0, method, t, rtol=1e-12, atol=1e-13).y.T


def row(name: str, theirs: Callable[[], Any], ours: Callable[[], Any], error: Callable[[Any], float]) -> None:
    our_error, their_error = error(ours()), error(theirs())
    our_time, their_time = least_times(ours, theirs)
    print(f"{name:44} {their_time * 1e3:10.3f} {our_time * 1e3:10.3f} {their_time / our_time:7.1f} "
          f"{their_error:9.1e} {our_error:9.1e}")


def compare_odeint(name: str, f: Any, native: Any, y0: list[float], t: np.ndarray, method: str, tol: float) -> None:
    exact = reference(f, y0, t, method)

    def error(y: np.ndarray) -> float:
        return float(np.max(np.abs(y - exact) / (np.abs(exact) + 1e-6)))

    def run(solver: Callable[..., Any], function: Any) -> Callable[[], Any]:
        return lambda: solver(function, y0, t, rtol=tol, atol=tol * 1e-3, mxstep=0)

    row(f"odeint {name} {tol:.0e}, f in Python", run(scipy.integrate.odeint, f), run(continuo.odeint, f), error)
    row(f"odeint {name} {tol:.0e}, f compiled", run(scipy.integrate.odeint, f), run(continuo.odeint, native), error)


def loop(module: Any, f: Any, integrator: str, dt: float, end: float) -> Callable[[], Any]:
    def run() -> Any:
        r = module.ode(f).set_integrator(integrator, rtol=1e-9, atol=1e-12, nsteps=5000)
        r.set_initial_value([1.0, 0.0], 0.0)
        while r.successful() and r.t < end:
            r.integrate(r.t + dt)
        return r.t, r.y

    return run


def error_of_oscillator(found: Any) -> float:
    t, y = found
    return float(np.abs(y - [np.cos(t), -np.sin(t)]).max())


def main() -> None:
    print(versions())
    print(f"{'':44} {'SciPy ms':>10} {'ours ms':>10} {'ratio':>7} {'error':>9} {'ours':>9}")
    library = compiled()
    times = np.linspace(0, 5, 101)
    for tol in (1e-6, 1e-9):
        compare_odeint("Lorenz", lorenz, library.lorenz, [1.0, 1.0, 1.0], times, "DOP853", tol)
    decades = np.concatenate(([0.0], np.logspace(-2, 5, 50)))
    for tol in (1e-4, 1e-7):
        compare_odeint("Robertson", robertson, library.robertson, [1.0, 0.0, 0.0], decades, "Radau", tol)
    for integrator in ("dop853", "dopri5", "vode", "lsoda"):
        for dt in (0.01, 0.5):
            row(f"loop of ode, {integrator}, dt {dt}", loop(scipy.integrate, oscillator, integrator, dt, 10.0),
                loop(continuo, oscillator, integrator, dt, 10.0), error_of_oscillator)


if __name__ == "__main__":
    main()
