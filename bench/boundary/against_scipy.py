"""Reads our lines (see ours.cpp) from standard input, solves the same problems by SciPy, prints ratios at equal residual."""
import sys
import time

import numpy as np
from scipy import __version__
from scipy.integrate import solve_bvp


def ends(a, b):
    return lambda left, right: np.array([left[0] - a, right[0] - b])


t, s = np.linspace(0, 1, 9), np.linspace(0, 12, 9)
problems = {
    "bratu, upper": (lambda t, x: np.vstack((x[1], -np.exp(x[0]))), ends(0, 0), t,
                     np.vstack((12 * t * (1 - t), 12 * (1 - 2 * t)))),
    "troesch, mu = 5": (lambda t, x: np.vstack((x[1], 5 * np.sinh(5 * x[0]))), ends(0, 1), t, np.vstack((t, 1 + 0 * t))),
    "blasius": (lambda t, x: np.vstack((x[1], x[2], -x[0] * x[2] / 2)),
                lambda left, right: np.array([left[0], left[1], right[1] - 1]), s,
                np.vstack((s * s / (s + 2), s / (s + 1), np.exp(-s)))),
    "layer, eps = 1e-4": (lambda t, x: np.vstack((x[1], -x[1] / 1e-4)), ends(0, 1), t, np.zeros((2, 9))),
}


def residual(f, found):
    theta = (np.arange(40) + 0.5) / 40
    at = (found.x[:-1, None] + theta * np.diff(found.x)[:, None]).ravel()
    value = f(at, found.sol(at))
    relative = (found.sol(at, 1) - value) / (1 + np.abs(value))
    return np.sqrt(np.mean(np.sum(relative**2, axis=0).reshape(-1, 40), axis=1)).max()


def theirs(name):
    f, conditions, mesh, guess = problems[name]
    rows = []
    for tolerance in 10.0 ** np.arange(-3, -11, -1):
        best, found = np.inf, None
        for _ in range(3):
            begin = time.perf_counter()
            found = solve_bvp(f, conditions, mesh, guess, tol=tolerance, max_nodes=200_000)
            best = min(best, time.perf_counter() - begin)
        if found.success:
            rows.append((residual(f, found), best))
        if best > 5:
            break
    return sorted(rows)


def at(rows, wanted):
    """Seconds at a residual, on straight lines through the logarithms; nothing beyond the ends."""
    x, y = np.log([row[0] for row in rows]), np.log([row[1] for row in rows])
    if not rows or not x[0] <= np.log(wanted) <= x[-1]:
        return None
    return float(np.exp(np.interp(np.log(wanted), x, y)))


ours = {}
for line in sys.stdin:
    name, _, size, seconds, _ = line.split(";")
    ours.setdefault(name, []).append((float(size), float(seconds)))
print(f"| Problem | Residual | Ours | solve_bvp of SciPy {__version__} | Time, ours : theirs |\n|---|---|---|---|---|")
for name in problems:
    mine, other = sorted(ours.get(name, [])), theirs(name)
    for wanted in (1e-4, 1e-6, 1e-8):
        a, b = at(mine, wanted), at(other, wanted)
        text = ["-" if value is None else f"{1e3 * value:.2f} ms" for value in (a, b)]
        ratio = "-" if a is None or b is None else f"**{a / b:.3f}**"
        print(f"| {name} | {wanted:.0e} | {text[0]} | {text[1]} | {ratio} |", flush=True)
