"""solve_bvp beside SciPy's: time, nodes and true error, at the same tolerance, in one run.

OPENBLAS_NUM_THREADS=1 PYTHONPATH=build/python python3 bench/python/solve_bvp.py
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from beside import least_times, versions
from scipy.integrate import solve_bvp as scipy_solve_bvp
from scipy.special import erf

from continuo import solve_bvp, trace


class Problem(NamedTuple):
    """A problem, and its solution's first component where it has a closed form."""

    name: str
    fun: Callable[..., Any]
    bc: Callable[..., Any]
    x: np.ndarray
    y: np.ndarray
    p: Any
    tol: float
    exact: Callable[[np.ndarray], np.ndarray] | None


def bratu(tol: float) -> Problem:
    theta = 1.5171645990507543  # of theta = sqrt(1 / 2) cosh(theta / 4)
    return Problem("Bratu", lambda x, y: np.vstack((y[1], -np.exp(y[0]))), lambda a, b: np.array([a[0], b[0]]),
                   np.linspace(0, 1, 5), np.zeros((2, 5)), None, tol,
                   lambda x: -2 * np.log(np.cosh((x - 0.5) * theta / 2) / np.cosh(theta / 4)))


def mathieu(tol: float) -> Problem:
    x = np.linspace(0, np.pi, 10)
    return Problem("Mathieu, eigenvalue",
                   lambda x, y, p: np.vstack((y[1], -(p[0] - 10 * np.cos(2 * x)) * y[0])),
                   lambda a, b, p: np.array([a[1], b[1], a[0] - 1]),
                   x, np.vstack((np.cos(4 * x), -4 * np.sin(4 * x))), [15.0], tol, None)


def layer(eps: float, tol: float) -> Problem:
    root = np.sqrt(2 * eps)

    def fun(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return np.vstack((y[1], -(x * y[1] + eps * np.pi**2 * np.cos(np.pi * x)
                                  + np.pi * x * np.sin(np.pi * x)) / eps))

    return Problem(f"shock layer {eps:.0e}", fun, lambda a, b: np.array([a[0] + 2, b[0]]),
                   np.linspace(-1, 1, 5), np.zeros((2, 5)), None, tol,
                   lambda x: np.cos(np.pi * x) + erf(x / root) / erf(1 / root))


def boundary_layer(eps: float, tol: float) -> Problem:
    root = np.sqrt(eps)
    return Problem(f"boundary layer {eps:.0e}", lambda x, y: np.vstack((y[1], y[0] / eps)),
                   lambda a, b: np.array([a[0] - 1, b[0]]), np.linspace(0, 1, 5), np.zeros((2, 5)), None, tol,
                   lambda x: (np.exp(-x / root) - np.exp((x - 2) / root)) / (1 - np.exp(-2 / root)))


def troesch(factor: float, tol: float) -> Problem:
    x = np.linspace(0, 1, 11)
    return Problem(f"Troesch {factor:g}", lambda x, y: np.vstack((y[1], factor * np.sinh(factor * y[0]))),
                   lambda a, b: np.array([a[0], b[0] - 1]), x, np.vstack((x, np.ones_like(x))), None, tol, None)


def emden(tol: float) -> Problem:
    """With a singular term, by an own solve below."""
    return Problem("Emden, singular", lambda x, y: np.vstack((y[1], -y[0]**5)),
                   lambda a, b: np.array([a[1], b[0] - np.sqrt(3) / 2]), np.linspace(0, 1, 5),
                   np.vstack((np.full(5, 0.9), np.zeros(5))), None, tol, lambda x: (1 + x**2 / 3)**-0.5)


def true_error(problem: Problem, found: Any, reference: Any) -> float:
    x = np.linspace(problem.x[0], problem.x[-1], 2001)
    exact = problem.exact(x) if problem.exact else reference.sol(x)[0]
    return float(np.max(np.abs(found.sol(x)[0] - exact)))


def equations_of(problem: Problem) -> Any:
    """The right-hand side traced, with unknown parameters as further components."""
    n, k = problem.y.shape[0], 0 if problem.p is None else len(problem.p)

    def components(x: Any, z: Any) -> list[Any]:
        rows = problem.fun(x, z[:n], z[n:]) if k else problem.fun(x, z)
        return [*rows[:, 0], *([0.0] * k)]

    return trace(components, n + k)


def compare(problem: Problem, options: dict[str, Any]) -> tuple[float, float]:
    def run(solver: Callable[..., Any], fun: Any = problem.fun, tol: float = problem.tol) -> Any:
        return solver(fun, problem.bc, problem.x, problem.y.copy(), problem.p, tol=tol, max_nodes=100000, **options)

    traced = equations_of(problem)
    ours, theirs, compiled = run(solve_bvp), run(scipy_solve_bvp), run(solve_bvp, traced)
    reference = None if problem.exact else run(solve_bvp, tol=1e-11)
    our_time, their_time, compiled_time = least_times(lambda: run(solve_bvp), lambda: run(scipy_solve_bvp),
                                                      lambda: run(solve_bvp, traced))
    print(f"{problem.name:22} {problem.tol:7.0e} {their_time * 1e3:9.3f} {our_time * 1e3:9.3f} "
          f"{their_time / our_time:7.1f} {compiled_time * 1e3:9.3f} {their_time / compiled_time:7.1f} {theirs.x.size:7} "
          f"{ours.x.size:6} {compiled.x.size:6} {true_error(problem, theirs, reference):9.1e} "
          f"{true_error(problem, ours, reference):9.1e} {true_error(problem, compiled, reference):9.1e}  "
          f"{theirs.status} {ours.status} {compiled.status}")
    return their_time / our_time, their_time / compiled_time


def main() -> None:
    print(versions())
    print(f"{'problem':22} {'tol':>7} {'SciPy ms':>9} {'ours ms':>9} {'ratio':>7} {'traced ms':>9} {'ratio':>7} "
          f"{'nodes':>7} {'ours':>6} {'traced':>6} {'error':>9} {'ours':>9} {'traced':>9}  status")
    ratios = []
    for tol in (1e-3, 1e-6):
        for problem in (bratu(tol), mathieu(tol), boundary_layer(1e-3, tol), boundary_layer(1e-4, tol),
                        layer(1e-3, tol), troesch(5, tol)):
            ratios.append(compare(problem, {}))
        ratios.append(compare(emden(tol), {"S": np.array([[0, 0], [0, -2]])}))
    for name, values in zip(("Python's fun", "traced"), zip(*ratios)):
        print(f"{name}: geometric mean of the ratios {np.exp(np.mean(np.log(values))):.1f}, least {min(values):.1f}")


if __name__ == "__main__":
    main()
