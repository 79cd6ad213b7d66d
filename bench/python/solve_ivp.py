"""Times of solve_ivp beside SciPy's in one run: the same problem, method and tolerances, with the error of each.

    PYTHONPATH=build/python python3 bench/python/solve_ivp.py

A right-hand side in Python is the same function for both; that in C is compiled here.
"""

import ctypes
import pathlib
import subprocess
import sys
import tempfile
import threading
import time
from typing import Any, Callable

import numpy as np
import scipy
import scipy.integrate

import continuo
from continuo import _continuo

Vector = Any
RATES = [
    0.35, 26.6, 12300, 0.86e-3, 0.82e-3, 15000, 0.13e-3, 24000, 16500, 9000, 0.022, 12000, 1.88, 16300, 4.8e6, 0.35e-3,
    0.0175, 1e8, 0.444e12, 1240, 2.1, 5.78, 0.0474, 1780, 3.12,
]  # fmt: skip

C_SOURCE = """
void lorenz(double t, const double *y, double *f, void *user) {
  f[0] = 10 * (y[1] - y[0]);
  f[1] = y[0] * (28 - y[2]) - y[1];
  f[2] = y[0] * y[1] - 8.0 / 3 * y[2];
}
void robertson(double t, const double *y, double *f, void *user) {
  f[0] = -0.04 * y[0] + 1e4 * y[1] * y[2];
  f[2] = 3e7 * y[1] * y[1];
  f[1] = -f[0] - f[2];
}
static const double k[] = {RATES};
void pollution(double t, const double *v, double *f, void *user) {
  const double *y = v - 1;
  const double r1 = k[0]*y[1], r2 = k[1]*y[2]*y[4], r3 = k[2]*y[5]*y[2], r4 = k[3]*y[7], r5 = k[4]*y[7],
    r6 = k[5]*y[7]*y[6], r7 = k[6]*y[9], r8 = k[7]*y[9]*y[6], r9 = k[8]*y[11]*y[2], r10 = k[9]*y[11]*y[1],
    r11 = k[10]*y[13], r12 = k[11]*y[10]*y[2], r13 = k[12]*y[14], r14 = k[13]*y[1]*y[6], r15 = k[14]*y[3],
    r16 = k[15]*y[4], r17 = k[16]*y[4], r18 = k[17]*y[16], r19 = k[18]*y[16], r20 = k[19]*y[17]*y[6],
    r21 = k[20]*y[19], r22 = k[21]*y[19], r23 = k[22]*y[1]*y[4], r24 = k[23]*y[19]*y[1], r25 = k[24]*y[20];
  f[0] = -r1-r10-r14-r23-r24+r2+r3+r9+r11+r12+r22+r25; f[1] = -r2-r3-r9-r12+r1+r21; f[2] = -r15+r1+r17+r19+r22;
  f[3] = -r2-r16-r17-r23+r15; f[4] = -r3+2*r4+r6+r7+r13+r20; f[5] = -r6-r8-r14-r20+r3+2*r18; f[6] = -r4-r5-r6+r13;
  f[7] = r4+r5+r6+r7; f[8] = -r7-r8; f[9] = -r12+r7+r9; f[10] = -r9-r10+r8+r11; f[11] = r9; f[12] = -r11+r10;
  f[13] = -r14+r12; f[14] = r14; f[15] = -r18-r19+r16; f[16] = -r20; f[17] = r20; f[18] = -r21-r22-r24+r23+r25;
  f[19] = -r25+r24;
}
"""  # fmt: skip


def lorenz(t: float, y: Vector) -> list[float]:
    """The Lorenz system, with a list."""
    a, b, c = y
    return [10 * (b - a), a * (28 - c) - b, a * b - 8 / 3 * c]


def lorenz_array(t: float, y: Vector) -> Vector:
    """The same with an array."""
    return np.array([10 * (y[1] - y[0]), y[0] * (28 - y[2]) - y[1], y[0] * y[1] - 8 / 3 * y[2]])


def robertson(t: float, y: Vector) -> list[float]:
    """A chemical reaction with rates of three sizes."""
    a, b, c = y
    first, third = -0.04 * a + 1e4 * b * c, 3e7 * b * b
    return [first, -first - third, third]


def pollution(t: float, y: Vector) -> list[float]:
    """Twenty-five reactions of twenty substances in the air."""
    k = RATES
    y1, y2, y3, y4, y5, y6, y7, y8, y9, y10, y11, y12, y13, y14, y15, y16, y17, y18, y19, y20 = y
    r = [
        0.0, k[0] * y1, k[1] * y2 * y4, k[2] * y5 * y2, k[3] * y7, k[4] * y7, k[5] * y7 * y6, k[6] * y9, k[7] * y9 * y6,
        k[8] * y11 * y2, k[9] * y11 * y1, k[10] * y13, k[11] * y10 * y2, k[12] * y14, k[13] * y1 * y6, k[14] * y3,
        k[15] * y4, k[16] * y4, k[17] * y16, k[18] * y16, k[19] * y17 * y6, k[20] * y19, k[21] * y19, k[22] * y1 * y4,
        k[23] * y19 * y1, k[24] * y20,
    ]  # fmt: skip
    return [
        -r[1] - r[10] - r[14] - r[23] - r[24] + r[2] + r[3] + r[9] + r[11] + r[12] + r[22] + r[25],
        -r[2] - r[3] - r[9] - r[12] + r[1] + r[21],
        -r[15] + r[1] + r[17] + r[19] + r[22],
        -r[2] - r[16] - r[17] - r[23] + r[15],
        -r[3] + 2 * r[4] + r[6] + r[7] + r[13] + r[20],
        -r[6] - r[8] - r[14] - r[20] + r[3] + 2 * r[18],
        -r[4] - r[5] - r[6] + r[13],
        r[4] + r[5] + r[6] + r[7],
        -r[7] - r[8],
        -r[12] + r[7] + r[9],
        -r[9] - r[10] + r[8] + r[11],
        r[9],
        -r[11] + r[10],
        -r[14] + r[12],
        r[14],
        -r[18] - r[19] + r[16],
        -r[20],
        r[20],
        -r[21] - r[22] - r[24] + r[23] + r[25],
        -r[25] + r[24],
    ]


def compiled(folder: pathlib.Path) -> dict[str, _continuo.Native]:
    """The right-hand sides in C."""
    (folder / "functions.c").write_text(C_SOURCE.replace("RATES", ", ".join(map(str, RATES))))
    library = folder / "functions.so"
    subprocess.run(["cc", "-O2", "-shared", "-fPIC", "-o", library, folder / "functions.c"], check=True)
    loaded = ctypes.CDLL(str(library))
    return {
        name: _continuo.Native(ctypes.cast(loaded[name], ctypes.c_void_p).value or 0, owner=loaded)
        for name in ("lorenz", "robertson", "pollution")
    }


def least_time(
    call: Callable[[], Any], seconds: float = 0.3, clock: Callable[[], float] = time.thread_time
) -> tuple[float, Any]:
    """The least time of several calls, and the result: that of the processor, which other programs do not lengthen."""
    least, begin = float("inf"), time.perf_counter()
    while True:
        start = clock()
        result = call()
        least = min(least, clock() - start)
        if time.perf_counter() - begin > seconds:
            return least, result


def print_calls(native: _continuo.Native, y0: Vector) -> None:
    """Print what one call of a few steps takes, by the kind of f."""
    in_c = native.owner.lorenz
    pointer = ctypes.POINTER(ctypes.c_double)
    in_c.restype, in_c.argtypes = None, [ctypes.c_double, pointer, pointer, ctypes.c_void_p]
    kinds = {
        "in C": native,
        "a LowLevelCallable": scipy.LowLevelCallable(in_c, signature="void (double, double *, double *, void *)"),
        "of ctypes": in_c,
        "traced": continuo.trace(lorenz, 3),
        "a text": continuo.expression("x' = 10*(y - x); y' = x*(28 - z) - y; z' = x*y - 8/3*z"),
    }
    steps = len(continuo.solve_ivp(native, (0, 0.3), y0).t) - 1
    for kind, f in kinds.items():
        call = lambda f=f: [continuo.solve_ivp(f, (0, 0.3), y0) for _ in range(100)]  # noqa: E731
        times = sorted(least_time(call, 0.0)[0] for _ in range(200))
        print(f"one call with f {kind} and {steps} steps: {times[100] * 1e4:.1f} us, at least {times[0] * 1e4:.1f}")


def elapsed(act: Callable[[], None]) -> float:
    """The seconds that pass while something is done."""
    start = time.perf_counter()
    act()
    return time.perf_counter() - start


def main() -> None:
    """Print the table."""
    native = compiled(pathlib.Path(tempfile.mkdtemp()))
    print(f"continuo {continuo.__version__}, SciPy {scipy.__version__}, NumPy {np.__version__}, Python", end=" ")
    print(sys.version.split()[0])
    air = np.zeros(20)
    air[[1, 3, 6, 7, 8, 16]] = 0.2, 0.04, 0.1, 0.3, 0.01, 0.007
    problems: list[tuple[str, tuple[float, float], Any, float, list[tuple[str, float, float]], dict[str, Any]]] = [
        ("lorenz", (0, 10), [1.0, 1, 1], 1, [("RK45", 1e-6, 1e-6), ("DOP853", 1e-9, 1e-9)],
         {"list": lorenz, "array": lorenz_array}),
        ("robertson", (0, 1e5), [1.0, 0, 0], 1, [("BDF", 1e-6, 1e-10), ("Radau", 1e-6, 1e-10)], {"list": robertson}),
        ("pollution", (0, 60), air, 1, [("BDF", 1e-6, 1e-10), ("Radau", 1e-6, 1e-10)], {"list": pollution}),
    ]  # fmt: skip
    print(f"{'problem':10} {'method':7} {'f':18} {'SciPy':>10} {'continuo':>10} {'ratio':>6}  {'errors':>16}")
    for name, span, y0, _, methods, functions in problems:
        strict = "DOP853" if name == "lorenz" else "radau"
        reference = continuo.solve_ivp(native[name], span, y0, method=strict, rtol=2.3e-14, atol=1e-18).y[:, -1]
        for method, rtol, atol in methods:
            options: dict[str, Any] = {"method": method, "rtol": rtol, "atol": atol}
            scipys = {
                form: least_time(lambda f=f: scipy.integrate.solve_ivp(f, span, y0, **options))  # type: ignore[misc]
                for form, f in functions.items()
            }
            traced = continuo.trace(functions["list"], len(y0))
            rows = [
                ("in C, Python", native[name], "list", {}),
                ("traced, Python", traced, "list", {}),
                ("list", functions["list"], "list", {}),
            ]
            if "array" in functions:
                rows.append(("array", functions["array"], "array", {}))
                rows.append(("array handed over", functions["list"], "list", {"state": "array"}))
            for form, f, beside, more in rows:
                scipys_time, theirs = scipys[beside]
                ours_time, ours = least_time(lambda: continuo.solve_ivp(f, span, y0, **options, **more))
                errors = [np.abs(one.y[:, -1] - reference).max() for one in (theirs, ours)]
                print(
                    f"{name:10} {method:7} {form:18} {scipys_time * 1e3:7.2f} ms {ours_time * 1e3:7.3f} ms"
                    f" {scipys_time / ours_time:6.1f}  {errors[0]:.1e} {errors[1]:.1e}"
                )
    y0 = np.array([1.0, 1.0, 1.0])
    print_calls(native["lorenz"], y0)

    def solves(count: int) -> None:
        for _ in range(count):
            continuo.solve_ivp(native["lorenz"], (0, 100), y0, method="DOP853", rtol=1e-9, atol=1e-9)

    def together() -> None:
        threads = [threading.Thread(target=solves, args=(100,)) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()

    # On an idle machine: this is the time that passes. Both in turn, since the speed of a processor that others share
    # drifts.
    pairs = [(elapsed(lambda: solves(400)), elapsed(together)) for _ in range(8)]
    print(f"four threads: {sum(one for one, _ in pairs) / sum(four for _, four in pairs):.2f} times one")


if __name__ == "__main__":
    main()
