#!/usr/bin/env python3
"""The 35 problems of Cash and Mazzia's test set for boundary-value solvers, run by `continuo run` as anybody would write
them: without a guess, at eps = 1e-1 ... 1e-6 and tolerances 1e-3, 1e-6, 1e-9.

    test_set.py CONTINUO [--problems 1,24] [--eps 1e-1,1e-2] [--tol 1e-6] [--rows] [--peer PROGRAM]

The problems: F. Mazzia, J. R. Cash, "A fortran test set for boundary value problem solvers", AIP Conf. Proc. 1648 (2015).
The referee is the closed form where there is one, else a run a hundred times as strict on a mesh of its own that comes to
eps another way (--along). An error is the greatest of a state over all rows, relative to the greatest
value of that state. Needs python3-scipy. Solved: within the tolerance. Wrong: further off than that, and success said
without a doubt. Refused: not solved, with the reason. eps enters the problems 23, 32 as 1/eps, 16 as 1/eps nearest to
an odd number (for an even one it has no solution, or many) and 34 as 35*eps.

--peer runs the same cases by other solvers beside: PROGRAM is called as `PROGRAM SOLVER NUMBER EPS TOL GUESS`, where SOLVER
is one of --solvers, GUESS `none` (all zero) or `line` (straight between the conditions, with its slope), and prints
`solved` or `failed`, the solver's own flag, seconds and points of the mesh, then a row `t,state,...` for each point. A peer
has solved where one of the guesses leads to rows within the tolerance, of the greatest value as ours or, as the peers
themselves count, of 1 + |state|.
"""
import argparse
import concurrent.futures
import csv
import json
import math
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
from scipy.special import airye, erf, hyp1f1

pi, exp, sqrt, cos, sin, log = math.pi, np.exp, np.sqrt, np.cos, np.sin, np.log


def pair(y, dy):
    """Closed form of y and y'."""
    return lambda x, e: np.array([y(x, e), dy(x, e)])


def wave(part, slope):
    """cos(pi x) and something more."""
    return pair(lambda x, e: cos(pi * x) + part(x, e), lambda x, e: -pi * sin(pi * x) + slope(x, e))


nothing = lambda x, e: 0 * x


def corner_layer(x, e):
    s = sqrt(e)
    return pair(lambda x, e: exp(-x / s), lambda x, e: -exp(-x / s) / s)(x, e)


def two_exponentials(x, e, s):
    """(exp(s x) - exp(-s x)) / (exp(2 s) - exp(-2 s)) and its derivative, x from 0 to 2."""
    down = -np.expm1(-4 * s)
    return (exp(s * (x - 2)) - exp(-s * (x + 2))) / down, s * (exp(s * (x - 2)) + exp(-s * (x + 2))) / down


def interior_7(x, e):
    a, c = sqrt(2 * e), sqrt(2 * e / pi)
    norm = erf(1 / a) + c * exp(-1 / (2 * e))
    y = cos(pi * x) + x + (x * erf(x / a) + c * exp(-x**2 / (2 * e))) / norm
    return np.array([y, -pi * sin(pi * x) + 1 + erf(x / a) / norm])


def airy_15(x, e):
    """eps y'' = x y: a Ai + b Bi of z = x / eps^(1/3), scaled at the end 1 where they are exponentials."""
    k = e ** (-1 / 3)
    right = 2 / 3 * k**1.5

    def scaled(x):
        z = k * x
        ai, dai, bi, dbi = airye(np.asarray(z, dtype=float))
        # airye scales by exp(+-2/3 z^1.5); for z < 0 that of Ai is complex, and the plain functions will do
        from scipy.special import airy
        low = airy(np.minimum(z, 0))
        grow = 2 / 3 * np.maximum(z, 0) ** 1.5
        down, up = exp(-grow), exp(grow - right)
        pick = lambda a, b, f: np.where(z < 0, b, a * f)
        ups = exp(-right)
        return (pick(ai, low[0], down), pick(dai, low[1], down) * k,
                np.where(z < 0, low[2] * ups, bi * up), np.where(z < 0, low[3] * ups, dbi * up) * k)

    left, end = scaled(np.array([-1.0])), scaled(np.array([1.0]))
    a, b = np.linalg.solve([[left[0][0], left[2][0]], [end[0][0], end[2][0]]], [1, 1])
    ai, dai, bi, dbi = scaled(x)
    return np.array([a * ai + b * bi, a * dai + b * dbi])


def ratio_35(x, e):
    """y = x/2 + 3/2 M(x)/M(1), M = 1F1(-1/2; 1/2; x^2/(2 eps)) the even solution."""
    z = x**2 / (2 * e)
    end = 1 / (2 * e)
    if end < 600:
        m = hyp1f1(-0.5, 0.5, z) / hyp1f1(-0.5, 0.5, end)
        dm = -hyp1f1(0.5, 1.5, z) * x / e / hyp1f1(-0.5, 0.5, end)
    else:  # asymptotic: 1F1 ~ -exp(z) / (2 z) (1 + 3/(2 z))
        far = lambda z: (1 + 1.5 / z) / z
        safe = np.maximum(z, 1.0)
        m = exp(z - end) * far(safe) / far(end)
        dm = m * x / e
    return np.array([x / 2 + 1.5 * m, 0.5 + 1.5 * dm])


def bratu_34(x, e):
    """y = -2 log(cosh((x - 1/2) theta/2) / cosh(theta/4)), theta = sqrt(2 lambda) cosh(theta/4): the lower solution."""
    root = math.sqrt(70 * e)
    theta = root
    for _ in range(200):  # Newton's iteration from below, where the equation is convex
        theta -= (theta - root * math.cosh(theta / 4)) / (1 - root / 4 * math.sinh(theta / 4))
    return np.array([-2 * log(np.cosh((x - 0.5) * theta / 2) / math.cosh(theta / 4)),
                     -theta * np.tanh((x - 0.5) * theta / 2)])


# number: equation, conditions, interval, closed form
P = {
    1: ("y'' = y/eps", "y(0) = 1; y(1) = 0", (0, 1),
        lambda x, e: np.array([(exp(-x / sqrt(e)) - exp((x - 2) / sqrt(e))) / -np.expm1(-2 / sqrt(e)),
                               -(exp(-x / sqrt(e)) + exp((x - 2) / sqrt(e))) / -np.expm1(-2 / sqrt(e)) / sqrt(e)])),
    2: ("y'' = y'/eps", "y(0) = 1; y(1) = 0", (0, 1),
        pair(lambda x, e: np.expm1((x - 1) / e) / np.expm1(-1 / e), lambda x, e: exp((x - 1) / e) / e / np.expm1(-1 / e))),
    3: ("y'' = (-(2 + cos(pi*t))*y' + y - (1 + eps*pi^2)*cos(pi*t) - (2 + cos(pi*t))*pi*sin(pi*t))/eps",
        "y(-1) = -1; y(1) = -1", (-1, 1), wave(nothing, nothing)),
    4: ("y'' = ((1 + eps)*y - y')/eps", "y(-1) = 1 + exp(-2); y(1) = 1 + exp(-2*(1 + eps)/eps)", (-1, 1),
        pair(lambda x, e: exp(x - 1) + exp(-(1 + e) * (1 + x) / e),
             lambda x, e: exp(x - 1) - (1 + e) / e * exp(-(1 + e) * (1 + x) / e))),
    5: ("y'' = (t*y' + y - (1 + eps*pi^2)*cos(pi*t) + pi*t*sin(pi*t))/eps", "y(-1) = -1; y(1) = -1", (-1, 1),
        wave(nothing, nothing)),
    6: ("y'' = (-t*y' - eps*pi^2*cos(pi*t) - pi*t*sin(pi*t))/eps", "y(-1) = -2; y(1) = 0", (-1, 1),
        wave(lambda x, e: erf(x / sqrt(2 * e)) / erf(1 / sqrt(2 * e)),
             lambda x, e: sqrt(2 / (pi * e)) * exp(-x**2 / (2 * e)) / erf(1 / sqrt(2 * e)))),
    7: ("y'' = (-t*y' + y - (1 + eps*pi^2)*cos(pi*t) - pi*t*sin(pi*t))/eps", "y(-1) = -1; y(1) = 1", (-1, 1), interior_7),
    8: ("y'' = -y'/eps", "y(0) = 1; y(1) = 2", (0, 1),
        pair(lambda x, e: (2 - exp(-1 / e) - exp(-x / e)) / -np.expm1(-1 / e), lambda x, e: exp(-x / e) / e / -np.expm1(-1 / e))),
    9: ("y'' = -(4*t*y' + 2*y)/(eps + t^2)", "y(-1) = 1/(1 + eps); y(1) = 1/(1 + eps)", (-1, 1),
        pair(lambda x, e: 1 / (e + x**2), lambda x, e: -2 * x / (e + x**2) ** 2)),
    10: ("y'' = -t*y'/eps", "y(-1) = 0; y(1) = 2", (-1, 1),
         pair(lambda x, e: 1 + erf(x / sqrt(2 * e)) / erf(1 / sqrt(2 * e)),
              lambda x, e: sqrt(2 / (pi * e)) * exp(-x**2 / (2 * e)) / erf(1 / sqrt(2 * e)))),
    11: ("y'' = (y - (1 + eps*pi^2)*cos(pi*t))/eps", "y(-1) = -1; y(1) = -1", (-1, 1), wave(nothing, nothing)),
    12: ("y'' = (y - (1 + eps*pi^2)*cos(pi*t))/eps", "y(-1) = -1; y(1) = 0", (-1, 1),
         wave(lambda x, e: two_exponentials(x + 1, e, 1 / sqrt(e))[0],
              lambda x, e: two_exponentials(x + 1, e, 1 / sqrt(e))[1])),
    13: ("y'' = (y - (1 + eps*pi^2)*cos(pi*t))/eps", "y(-1) = 0; y(1) = -1", (-1, 1),
         wave(lambda x, e: two_exponentials(1 - x, e, 1 / sqrt(e))[0],
              lambda x, e: -two_exponentials(1 - x, e, 1 / sqrt(e))[1])),
    14: ("y'' = (y - (1 + eps*pi^2)*cos(pi*t))/eps", "y(-1) = 0; y(1) = 0", (-1, 1),
         wave(lambda x, e: two_exponentials(x + 1, e, 1 / sqrt(e))[0] + two_exponentials(1 - x, e, 1 / sqrt(e))[0],
              lambda x, e: two_exponentials(x + 1, e, 1 / sqrt(e))[1] - two_exponentials(1 - x, e, 1 / sqrt(e))[1])),
    15: ("y'' = t*y/eps", "y(-1) = 1; y(1) = 1", (-1, 1), airy_15),
    16: ("y'' = -pi^2/4*y/eps^2", "y(0) = 0; y(1) = sin(pi/(2*eps))", (0, 1),
         pair(lambda x, e: sin(pi * x / (2 * e)), lambda x, e: pi / (2 * e) * cos(pi * x / (2 * e)))),
    17: ("y'' = -3*eps*y/(eps + t^2)^2", "y(-0.1) = -0.1/sqrt(eps + 0.01); y(0.1) = 0.1/sqrt(eps + 0.01)", (-0.1, 0.1),
         pair(lambda x, e: x / sqrt(e + x**2), lambda x, e: e / (e + x**2) ** 1.5)),
    18: ("y'' = -y'/eps", "y(0) = 1; y(1) = exp(-1/eps)", (0, 1),
         pair(lambda x, e: exp(-x / e), lambda x, e: -exp(-x / e) / e)),
    19: ("y'' = (-exp(y)*y' + pi/2*sin(pi*t/2)*exp(2*y))/eps", "y(0) = 0; y(1) = 0", (0, 1), None),
    20: ("y'' = (1 - y'^2)/eps",  # log(cosh(a)) = a + log(1 + exp(-2 a)) - log(2)
         "y(0) = 1 + eps*(0.745/eps + log((1 + exp(-1.49/eps))/2)); y(1) = 1 + eps*(0.255/eps + log((1 + exp(-0.51/eps))/2))",
         (0, 1),
         pair(lambda x, e: 1 + abs(x - 0.745) + e * log((1 + exp(-2 * abs(x - 0.745) / e)) / 2),
              lambda x, e: np.tanh((x - 0.745) / e))),
    21: ("y'' = (y + y^2 - exp(-2*t/sqrt(eps)))/eps", "y(0) = 1; y(1) = exp(-1/sqrt(eps))", (0, 1), corner_layer),
    22: ("y'' = (-y' - y^2)/eps", "y(0) = 0; y(1) = 1/2", (0, 1), None),
    23: ("y'' = sinh(y/eps)/eps", "y(0) = 0; y(1) = 1", (0, 1), None),
    24: ("let A = 1 + t^2, dA = 2*t\n"
         "y'' = ((2.4/2 - eps*dA)*y*y' - y'/y - dA/A*(1 - 0.2*y^2))/(eps*A*y)", "y(0) = 0.9129; y(1) = 0.375", (0, 1), None),
    **{number: ("y'' = (y - y*y')/eps", f"y(0) = {a}; y(1) = {b}", (0, 1), None)
       for number, a, b in ((25, "-1/3", "1/3"), (26, "1", "-1/3"), (27, "1", "1/3"), (28, "1", "3/2"), (29, "0", "3/2"),
                            (30, "-7/6", "3/2"))},
    31: ("let T = 1/cos(theta) + eps*Q*tan(theta)\ny' = sin(theta)\ntheta' = M\nM' = -Q/eps\n"
         "Q' = ((y - 1)*cos(theta) - M*T)/eps", "y(0) = 0; M(0) = 0; y(1) = 0; M(1) = 0", (0, 1), None),
    32: ("y'''' = (y'*y'' - y*y''')/eps", "y(0) = 0; y'(0) = 0; y(1) = 1; y'(1) = 0", (0, 1), None),
    33: ("f'''' = -(f*f''' + g*g')/eps\ng'' = (f'*g - f*g')/eps",
         "g(0) = -1; f(0) = 0; f'(0) = 0; g(1) = 1; f(1) = 0; f'(1) = 0", (0, 1), None),
    34: ("y'' = -35*eps*exp(y)", "y(0) = 0; y(1) = 0", (0, 1), bratu_34),
    35: ("y'' = (t*y' - y)/eps", "y(-1) = 1; y(1) = 2", (-1, 1), ratio_35),
}


STATES = {number: ["y", "y'"] for number in P}
STATES[31] = ["y", "theta", "M", "Q"]
STATES[32] = ["y"] + ["y" + "'" * primes for primes in (1, 2, 3)]
STATES[33] = ["f"] + ["f" + "'" * primes for primes in (1, 2, 3)] + ["g", "g'"]


def model(number, eps):
    equation, conditions, (a, b), _ = P[number]
    if number == 16:  # 1/eps is to be odd
        eps = 1 / (2 * round((1 / eps - 1) / 2) + 1)
    return eps, f"param eps = {eps!r}\n{equation}\n{conditions}\nrun {a}..{b}\n"


def run(command, number, eps, tol, folder, *more, name="run", asked=()):
    """What `continuo run` says, its reason or doubt, the states at its rows, or at the instants asked for, and seconds."""
    eps, text = model(number, eps)
    path = folder / f"T{number}_{eps:.3g}_{tol:g}_{name}.sim"
    states = STATES[number]
    text += "".join(f"check {state}({t!r}) = 0 within 1e300\n" for t in asked for state in states)
    path.write_text(text)
    rows = path.with_suffix(".csv")
    try:
        done = subprocess.run([command, "run", str(path), "--tol", repr(tol), "-o", str(rows), "--json", *more],
                              capture_output=True, text=True, timeout=60)
    except subprocess.TimeoutExpired:
        return "timeout", "longer than a minute", None, None, math.nan
    said = json.loads(done.stdout) if done.stdout.strip() else {}
    if done.returncode != 0 or said.get("outcome") != "reached end":
        lines = [line.strip() for line in done.stderr.splitlines() if line.startswith("error") or "= help" in line]
        return "refused", " ".join(lines) or done.stderr.strip()[:200], None, None, math.nan
    seconds = said["statistics"]["seconds"]
    if asked:
        values = np.array([check["value"] for check in said["checks"]]).reshape(len(asked), len(states)).T
        return "ok", said.get("hint", ""), np.array(asked), values, seconds
    with open(rows) as file:
        lines = [line for line in file if not line.startswith("#")]
    header = next(csv.reader(lines[:1]))
    data = np.loadtxt(lines[1:], delimiter=",", ndmin=2)
    keep = [header.index(name) for name in states]
    return "ok", said.get("hint", ""), data[:, 0], data[:, keep].T, seconds


def truth(command, number, eps, tol, t, x, folder, name="ours"):
    """What the run says the states are at some instants, and what they are."""
    closed = P[number][3]
    if closed:
        with np.errstate(over="ignore", under="ignore"):
            return x, closed(t, model(number, eps)[0])
    few = np.unique(np.linspace(0, len(t) - 1, 150).astype(int))
    state, _, _, strict, _ = run(command, number, eps, max(1e-2 * tol, 1e-11), folder, "--along",
                              f"eps={0.3 if eps < 0.3 else 1}..{eps!r}", name=f"strict_{name}", asked=[float(v) for v in t[few]])
    return (x[:, few], strict) if state == "ok" else (x, None)


def judge(command, number, eps, tol, folder):
    state, reason, t, x, seconds = run(command, number, eps, tol, folder)
    if state != "ok":
        return state, reason, math.nan, seconds
    x, true = truth(command, number, eps, tol, t, x, folder)
    if true is None:
        return "unjudged", "no referee", math.nan, seconds
    size = np.maximum(np.abs(true).max(axis=1, keepdims=True), 1e-300)
    error = float(np.max(np.abs(x - true) / size))
    if error <= tol:
        return "solved", reason, error, seconds
    return ("doubted" if reason else "WRONG"), reason, error, seconds


def is_exact(true, x, tol):
    """By our measure, or by |error| <= tol*(1 + |x|), which is that of the peers."""
    size = np.maximum(np.abs(true).max(axis=1, keepdims=True), 1e-300)
    error = np.abs(x - true)
    return bool(np.all(np.isfinite(x)) and (np.max(error / size) <= tol or np.max(error / (1 + np.abs(true))) <= tol))


def peer_case(program, solver, command, number, eps, tol, folder):
    """`solved`, `wrong` (success said), `failed` or `unjudged`, and the seconds where it has solved."""
    state = "failed"
    for guess in ("none", "line"):
        try:
            done = subprocess.run([program, solver, str(number), repr(model(number, eps)[0]), repr(tol), guess],
                                  capture_output=True, text=True, timeout=5)
        except subprocess.TimeoutExpired:
            continue
        lines = done.stdout.splitlines()
        if not lines or not lines[0].startswith("solved"):
            continue
        data = np.loadtxt(lines[1:], delimiter=",", ndmin=2)
        if len(data) > 20000:
            data = data[np.unique(np.linspace(0, len(data) - 1, 20000).astype(int))]
        x, true = truth(command, number, eps, tol, data[:, 0], data[:, 1:].T, folder, solver)
        if true is None:
            state = "unjudged"
        elif is_exact(true, x, tol):
            return "solved", float(lines[0].split()[2])
        else:
            state = "wrong"
    return state, math.nan


def beside(options, results, folder):
    """The tables of the peers, how much of what they solve ours does, and the times where both have solved."""
    cases = list(results)
    print()
    of_peers = {}
    for solver in options.solvers:
        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            judged = pool.map(lambda case: peer_case(options.peer, solver, options.continuo, *case, folder), cases)
            of_peers[solver] = dict(zip(cases, judged))
    for solver, of_peer in of_peers.items():
        counts = {state: sum(result[0] == state for result in of_peer.values())
                  for state in ("solved", "failed", "wrong", "unjudged")}
        both = [(results[case][2], of_peer[case][1]) for case in cases
                if of_peer[case][0] == "solved" and results[case][0] == "solved"]
        ratios = np.array([ours / max(theirs, 1e-6) for ours, theirs in both])
        print(f"{solver}: " + ", ".join(f"{count} {state}" for state, count in counts.items()) +
              f"; of its solved ours solves {len(both)}; time, ours through theirs: "
              f"median {np.median(ratios):.2g}, nine in ten below {np.quantile(ratios, 0.9):.2g}, "
              f"sums {sum(ours for ours, _ in both):.3g} s and {sum(theirs for _, theirs in both):.3g} s")
    either = [case for case in cases if any(of[case][0] == "solved" for of in of_peers.values())]
    lacking = [case for case in either if results[case][0] not in ("solved",)]
    print(f"solved by any peer: {len(either)}, of these by ours {len(either) - len(lacking)} "
          f"({100 * (1 - len(lacking) / len(either)):.1f} %)")
    for number, eps, tol in lacking:
        print(f"  T{number} eps={eps:g} tol={tol:g}: ours {results[number, eps, tol][0]}, "
              + ", ".join(f"{solver} {of[number, eps, tol][0]}" for solver, of in of_peers.items()))
    slow = sorted(((results[c][2] / max(of[c][1], 1e-6), solver, c) for solver, of in of_peers.items() for c in cases
                   if of[c][0] == "solved" and results[c][0] == "solved" and results[c][2] > 0.05), reverse=True)
    for ratio, solver, (number, eps, tol) in slow[:10]:
        print(f"  slow: T{number} eps={eps:g} tol={tol:g}: {results[number, eps, tol][2]:.3g} s, {ratio:.3g} times {solver}")


def main():
    options = argparse.ArgumentParser()
    options.add_argument("continuo")
    numbers = lambda kind: lambda text: [kind(part) for part in text.split(",")]
    options.add_argument("--problems", type=numbers(int), default=list(P))
    options.add_argument("--eps", type=numbers(float), default=[1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6])
    options.add_argument("--tol", type=numbers(float), default=[1e-3, 1e-6, 1e-9])
    options.add_argument("--jobs", type=int, default=2)
    options.add_argument("--rows", action="store_true", help="every run on a line of its own")
    options.add_argument("--peer", help="a program that runs other solvers on the same problems")
    options.add_argument("--solvers", type=lambda text: text.split(","), default=["twpbvpc", "colnew"])
    options = options.parse_args()
    cases = [(n, e, tol) for n in options.problems for e in options.eps for tol in options.tol]
    results = {}
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        judged = pool.map(lambda case: judge(options.continuo, *case, pathlib.Path(folder)), cases)
        for case, (state, reason, error, seconds) in zip(cases, judged):
            results[case] = state, error, seconds
            if options.rows or state not in ("solved",):
                print(f"T{case[0]:<2} eps={case[1]:g} tol={case[2]:g}: {state} {error:.2g} {reason[:230]}", file=sys.stderr,
                      flush=True)
    print("| Problem | " + " | ".join(f"eps = {e:g}" for e in options.eps) + " |")
    print("|---|" + "---|" * len(options.eps))
    letter = {"solved": "s", "refused": "r", "timeout": "t", "doubted": "d", "WRONG": "W", "unjudged": "?"}
    for n in options.problems:
        cells = ["".join(letter[results[n, e, tol][0]] for tol in options.tol) for e in options.eps]
        print(f"| T{n} | " + " | ".join(cells) + " |")
    counts = {state: sum(result[0] == state for result in results.values()) for state in letter}
    print("\n" + ", ".join(f"{count} {state}" for state, count in counts.items() if count))
    if options.peer:
        with tempfile.TemporaryDirectory() as folder:
            beside(options, results, pathlib.Path(folder))


if __name__ == "__main__":
    main()
