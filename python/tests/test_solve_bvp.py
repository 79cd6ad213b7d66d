"""solve_bvp: true errors on random problems with closed forms, and every way in which a problem or a call can be bad."""

import ctypes
import os
import signal
import threading
import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from compiled import function

from continuo import solve_bvp, trace


def exponential(a: np.ndarray) -> np.ndarray:
    """exp(a) of a matrix that can be diagonalized."""
    values, vectors = np.linalg.eig(a)
    return (vectors * np.exp(values)) @ np.linalg.inv(vectors)


def random_linear(seed: int, is_complex: bool):
    """y' = A y + g with constant g, conditions Ba y(0) + Bb y(1) = c: its closed form, and how much it magnifies
    residuals."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 6))

    def numbers(*shape: int) -> np.ndarray:
        real = rng.normal(size=shape)
        return real + 1j * rng.normal(size=shape) if is_complex else real

    a, g, first, last, c = numbers(n, n), numbers(n), numbers(n, n), numbers(n, n), numbers(n)
    whole = exponential(a)
    particular = np.linalg.solve(a, g)  # y = exp(A x) v - A^-1 g
    condition = first + last @ whole
    v = np.linalg.solve(condition, c + (first + last) @ particular)

    def exact(x: np.ndarray) -> np.ndarray:
        return np.array([exponential(a * s) @ v - particular for s in x]).T

    # The error is bounded by Green's function: exp(A x) Q^-1 (conditions) exp(-A s).
    grid = np.linspace(0, 1, 21)
    sizes = max(np.linalg.norm(exponential(a * x), 2) for x in grid)
    inverse_sizes = max(np.linalg.norm(exponential(-a * x), 2) for x in grid)
    green = sizes * inverse_sizes * (1 + np.linalg.norm(np.linalg.solve(condition, last @ whole), 2))
    return n, (lambda x, y: a @ y + g[:, None]), (lambda ya, yb: first @ ya + last @ yb - c), exact, green


def traced(fun: Callable[..., Any], n: int) -> Any:
    """Its equations, with their exact Jacobian."""
    return trace(lambda x, y: fun(x, y[:, None])[:, 0], n)


def as_callback(fun: Callable[..., Any], n: int) -> Any:
    """A function of ctypes that calls it, without a Jacobian."""
    numbers = ctypes.POINTER(ctypes.c_double)

    @ctypes.CFUNCTYPE(None, ctypes.c_double, numbers, numbers, ctypes.c_void_p)
    def callback(x: float, y: Any, slopes: Any, _: Any) -> None:
        for i, slope in enumerate(fun(x, np.array(y[:n])[:, None])[:, 0]):
            slopes[i] = slope

    return callback


@pytest.mark.parametrize("kind", ["real", "complex", "traced", "compiled"])
@pytest.mark.parametrize("seed", range(12))
def test_error_of_random_linear_problems(seed: int, kind: str) -> None:
    is_complex = kind == "complex"
    n, fun, bc, exact, green = random_linear(seed, is_complex)
    if green > 1e4:
        pytest.skip("the problem magnifies residuals too much to say anything of the error")
    given = {"traced": traced, "compiled": as_callback}.get(kind, lambda fun, n: fun)(fun, n)
    dtype = complex if is_complex else float
    x = np.linspace(0, 1, 201)
    for tol in (1e-3, 1e-6) if kind == "compiled" else (1e-3, 1e-6, 1e-9):  # its calls come back to Python
        found = solve_bvp(given, bc, [0, 0.4, 1], np.zeros((n, 3), dtype), tol=tol, bc_tol=tol * 1e-3, max_nodes=100000)
        assert found.success, found.message
        y = exact(x)
        slope = np.abs(fun(x, y)).max()
        # Residuals below tol (1 + |f|), in the root mean square of each interval, which bounds their integral.
        assert np.abs(found.sol(x) - y).max() <= green * tol * (1 + slope) * np.sqrt(n)
        residual = found.sol(x, 1) - fun(x, found.sol(x))
        assert np.abs(residual).max() <= 10 * tol * (1 + slope)


@pytest.mark.parametrize("seed", range(6))
def test_meshes_are_those_of_scipy(seed: int) -> None:
    scipy_integrate = pytest.importorskip("scipy.integrate")
    n, fun, bc, _, _ = random_linear(seed, False)
    for tol in (1e-3, 1e-7):
        ours = solve_bvp(fun, bc, [0, 0.4, 1], np.zeros((n, 3)), tol=tol)
        theirs = scipy_integrate.solve_bvp(fun, bc, [0, 0.4, 1], np.zeros((n, 3)), tol=tol)
        assert ours.status == theirs.status
        if theirs.success:
            np.testing.assert_array_equal(ours.x, theirs.x)
            np.testing.assert_allclose(ours.y, theirs.y, rtol=1e-6, atol=1e-6 * np.abs(theirs.y).max())
            by_same_points = theirs.rms_residuals < 0.3 * tol  # the others are found more exactly
            np.testing.assert_allclose(ours.rms_residuals[by_same_points], theirs.rms_residuals[by_same_points],
                                       rtol=1e-2, atol=1e-2 * tol)
            assert ours.niter == theirs.niter


def random_bump(seed: int) -> tuple[Any, ...]:
    """A nonlinear problem with waves and a bump as its solution, of which few points see too little."""
    rng = np.random.default_rng(seed)
    a, b = rng.normal(size=(2, 2)) * 5, rng.normal(size=(2, 2))
    place, width, rates = rng.uniform(0, 1), rng.uniform(0.03, 0.3), rng.uniform(1, 12, size=(2, 1))

    def solution(x: np.ndarray) -> np.ndarray:
        return np.sin(rates * x) + np.exp(-((x - place) / width)**2)

    def field(y: np.ndarray) -> np.ndarray:
        return a @ y + np.sin(b @ y)

    def fun(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return field(y) + solution(x + 1e-20j).imag / 1e-20 - field(solution(x))

    first, last = solution(np.array([0.0]))[0, 0], solution(np.array([1.0]))[1, 0]
    return fun, (lambda ya, yb: np.array([ya[0] - first, yb[1] - last]))


@pytest.mark.parametrize("tol", [1e-2, 1e-3])
def test_residuals_are_below_the_tolerance(tol: float) -> None:
    """By Gauss's quadrature with 20 points. Of five points, nine of these residuals at 1e-2 are up to 1.2 times it."""
    points, weights = np.polynomial.legendre.leggauss(20)
    for seed in range(40):
        fun, bc = random_bump(seed)
        found = solve_bvp(fun, bc, np.linspace(0, 1, 5), np.zeros((2, 5)), tol=tol)
        assert found.success
        x = (found.x[:-1, None] + np.diff(found.x)[:, None] * (0.5 + 0.5 * points)).ravel()
        slope = fun(x, found.sol(x))
        squares = np.sum(((found.sol(x, 1) - slope) / (1 + np.abs(slope)))**2, axis=0)
        assert np.sqrt(0.5 * (squares.reshape(-1, 20) @ weights)).max() <= 1.05 * tol, seed  # of nine points


def test_unknown_parameters() -> None:
    """y'' + p^2 y = 0, y(0) = y(1) = 0, y'(0) = p: p is a multiple of pi, for each by its own guess."""
    for k in (1, 2, 3):
        x = np.linspace(0, 1, 12)
        guess = np.vstack((np.sin(k * np.pi * x), k * np.pi * np.cos(k * np.pi * x)))
        found = solve_bvp(lambda x, y, p: np.vstack((y[1], -p[0]**2 * y[0])),
                          lambda ya, yb, p: np.array([ya[0], yb[0], ya[1] - p[0]]), x, guess, p=[3.0 * k], tol=1e-9,
                          max_nodes=10000)
        assert found.success
        assert abs(found.p[0] - k * np.pi) < 1e-8


@pytest.mark.parametrize("power", [1, 2, 3])
def test_singular_term(power: int) -> None:
    """u'' + k/x u' = -2 (k + 1), u'(0) = 0, u(1) = 0 has u = 1 - x^2; k = 1, 2: a cylinder, a sphere."""
    S = np.array([[0, 0], [0, -power]])
    found = solve_bvp(lambda x, y: np.vstack((y[1], np.full_like(x, -2.0 * (power + 1)))),
                      lambda ya, yb: np.array([ya[1], yb[0]]), np.linspace(0, 1, 4), np.ones((2, 4)), S=S)
    assert found.success
    x = np.linspace(0, 1, 50)
    assert np.abs(found.sol(x)[0] - (1 - x**2)).max() < 1e-8  # a cubic contains it; differences know 1e-8


def test_unsolvable_is_not_solved() -> None:
    """Bratu's equation has no solution beyond k = 3.5138; a periodic resonance none either."""
    x = np.linspace(0, 1, 5)

    def bc(ya: np.ndarray, yb: np.ndarray) -> np.ndarray:
        return np.array([ya[0], yb[0]])

    for k in (3.6, 4.0, 10.0):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            assert not solve_bvp(lambda x, y: np.vstack((y[1], -k * np.exp(y[0]))), bc, x, np.zeros((2, 5))).success
    t = np.linspace(0, 2 * np.pi, 9)
    resonance = solve_bvp(lambda x, y: np.vstack((y[1], -y[0] + np.sin(x))), lambda ya, yb: ya - yb, t, np.zeros((2, 9)))
    assert not resonance.success
    contradiction = solve_bvp(lambda x, y: np.zeros_like(y), lambda ya, yb: np.array([ya[0], ya[0] - 1]), x,
                              np.zeros((2, 5)))
    assert contradiction.status == 2


def test_growing_and_decaying_solutions() -> None:
    """y'' = k^2 y with k = 200: over the interval solutions grow and decay by exp(200), of which shooting fails."""
    k = 200.0
    found = solve_bvp(lambda x, y: np.vstack((y[1], k**2 * y[0])), lambda ya, yb: np.array([ya[0] - 1, yb[0] - 1]),
                      np.linspace(0, 1, 11), np.zeros((2, 11)), tol=1e-8, max_nodes=20000)
    x = np.linspace(0, 1, 1001)
    assert found.success
    assert np.abs(found.sol(x)[0] - np.exp(-k * x) - np.exp(-k * (1 - x))).max() < 1e-6


def line(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    return np.vstack((y[1], np.zeros_like(x)))


def ends(ya: np.ndarray, yb: np.ndarray) -> np.ndarray:
    return np.array([ya[0], yb[0] - 1])


X, Y = np.linspace(0, 1, 5), np.zeros((2, 5))


def test_not_a_number_is_no_success() -> None:
    """SciPy reports success where f is not a number, as no comparison with it is true."""
    found = solve_bvp(lambda x, y: np.full_like(y, np.nan), ends, X, Y)
    assert (found.status, found.success) == (4, False)
    assert found.message == "Component 0 of `fun` is infinite or not a number at x = 0."
    # Between nodes and middles, where the residual is measured.
    found = solve_bvp(lambda x, y: np.vstack((y[1], np.where(abs(x - 0.2068) < 0.01, np.nan, 0 * x))), ends, X, Y)
    assert (found.status, found.success) == (4, False)
    with np.errstate(all="ignore"):
        found = solve_bvp(lambda x, y: np.vstack((y[1], 1 / (x - 0.25))), ends, X, Y)
        assert "Component 1 of `fun`" in found.message and "x = 0.25" in found.message
        assert solve_bvp(lambda x, y: np.vstack((y[1], 1 / (x - 0.3))), ends, X, Y).success is False
    found = solve_bvp(line, lambda ya, yb: np.array([ya[0], np.inf]), X, Y)
    assert found.message == "Component 1 of `bc` is infinite or not a number."


def test_root_of_a_trial_that_is_negative() -> None:
    """Newton's first correction leads to where f has no value: it is shortened."""
    with np.errstate(invalid="ignore"):
        found = solve_bvp(lambda x, y: np.vstack((y[1], 6 * np.sqrt(y[0]))),
                          lambda ya, yb: np.array([ya[0] - 0.25, yb[0] - 2.25]), X, np.vstack((4 + 0 * X, 0 * X)))
    assert found.success
    assert np.all(found.y[0] > 0)


@pytest.mark.parametrize(("function", "error", "text"), [
    (lambda x, y: None, TypeError, "`fun`"),
    (lambda x, y: "no numbers", TypeError, "`fun`"),
    (lambda x, y: [[1, 2], [3]], TypeError, "`fun`"),
    (lambda x, y: y[0], ValueError, r"`fun` return is expected to have shape \(2, 5\), but actually has \(5,\)"),
    (lambda x, y: y + 1j, TypeError, "complex"),
    (lambda x: x, TypeError, "positional argument"),
    (lambda x, y: 1 / 0, ZeroDivisionError, "division by zero"),
    (3, TypeError, "must be a function"),
])
def test_bad_functions(function, error, text: str) -> None:
    with pytest.raises(error, match=text):
        solve_bvp(function, ends, X, Y)


@pytest.mark.parametrize("kept", [{"fun": line, "bc": lambda ya, yb: ya[0]},
                                  {"fun": line, "bc": lambda ya, yb: np.zeros(3)},
                                  {"fun": line, "bc": ends, "fun_jac": lambda x, y: np.zeros((2, 2))},
                                  {"fun": line, "bc": ends, "bc_jac": lambda ya, yb: np.zeros((2, 2, 2, 1))},
                                  {"fun": line, "bc": ends, "bc_jac": lambda ya, yb: np.zeros((3, 2, 2))}])
def test_bad_shapes_of_other_functions(kept) -> None:
    name = list(kept)[-1]
    with pytest.raises(ValueError, match=f"`{name}`"):
        solve_bvp(x=X, y=Y, **kept)


@pytest.mark.parametrize("bad", [
    {"x": [0.0]}, {"x": [0, np.nan, 1, 2, 3]}, {"x": [0, 1, 2, 3, np.inf]}, {"x": [[0, 1, 2, 3, 4]]},
    {"x": [0, 1, 1, 2, 3]}, {"y": np.full((2, 5), np.nan)}, {"y": np.zeros(5)}, {"y": np.zeros((0, 5))},
    {"p": [[1.0]]}, {"p": [np.nan]}, {"S": np.zeros(2)}, {"S": np.full((2, 2), np.nan)}, {"tol": np.nan},
    {"tol": -1.0}, {"tol": np.inf}, {"bc_tol": 0.0}, {"verbose": 3}, {"max_nodes": -1}, {"max_nodes": "a"}])
def test_bad_arguments(bad) -> None:
    with pytest.raises(ValueError, match="`"):
        solve_bvp(**{"fun": line, "bc": ends, "x": X, "y": Y, **bad})


@pytest.mark.parametrize("bad", [{"fun": None}, {"bc": 3}, {"fun_jac": 3}, {"bc_jac": "a"}, {"tol": None}])
def test_bad_types_of_arguments(bad) -> None:
    with pytest.raises(TypeError, match=f"`{list(bad)[0]}` must be"):
        solve_bvp(**{"fun": line, "bc": ends, "x": X, "y": Y, **bad})


def test_exception_later_passes_through() -> None:
    class Own(Exception):
        pass

    calls = 0

    def fun(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        nonlocal calls
        calls += 1
        if calls > 6:
            raise Own(str(calls))
        return np.vstack((y[1], -np.exp(y[0])))

    with pytest.raises(Own) as caught:
        solve_bvp(fun, ends, X, Y, tol=1e-9)
    assert caught.traceback[-1].name == "fun"


def test_functions_that_take_meshes_only() -> None:
    """A right-hand side that refuses repeated points, or whose points depend on each other, is called as SciPy does."""
    def refuses(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        if np.any(np.diff(x) <= 0):
            raise ValueError("no mesh")
        return np.vstack((y[1], -np.exp(y[0])))

    def depends(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return np.vstack((y[1], -np.exp(y[0]) + 0.1 * np.mean(x) + 0 * x))

    usual = solve_bvp(lambda x, y: np.vstack((y[1], -np.exp(y[0]))), ends, X, Y, tol=1e-6)
    refused = solve_bvp(refuses, ends, X, Y, tol=1e-6)
    np.testing.assert_allclose(refused.y, usual.y, rtol=1e-7, atol=1e-9)
    assert solve_bvp(depends, ends, X, Y).success


def test_spline_is_that_of_scipy() -> None:
    pytest.importorskip("scipy.interpolate")
    sol = solve_bvp(lambda x, y: np.vstack((y[1], -np.exp(y[0]))), ends, X, Y).sol
    spline = sol.ppoly()
    points = np.array([[-0.5, 0, 0.1], [0.25, 1, 1.5]])
    for nu in range(5):
        np.testing.assert_allclose(sol(points, nu), spline(points, nu), rtol=1e-12, atol=1e-12)
    assert np.isnan(sol(points, extrapolate=False)[:, 0, 0]).all()
    np.testing.assert_allclose(sol(1.25, extrapolate="periodic"), sol(0.25), rtol=1e-12)
    np.testing.assert_allclose(sol.integrate(0, 1), spline.integrate(0, 1))
    assert np.isnan(sol(np.nan)).all()
    assert sol(0.5).shape == (2,) and sol([]).shape == (2, 0)


def test_interrupt_at_once() -> None:
    def fun(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return np.vstack((y[1], 1e4 * np.sin(50 * y[0]) + np.cos(1000 * x)))

    threading.Timer(0.2, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        for _ in range(1000):
            solve_bvp(fun, ends, np.linspace(0, 1, 2000), np.zeros((2, 2000)), tol=1e-12, max_nodes=10**6)


def eigenvalue(fun: Any, n: int = 2) -> Any:
    """Mathieu's equation y'' = -(p - 10 cos 2x) y with the eigenvalue a_4(5)."""
    x = np.linspace(0, np.pi, 10)
    guess = np.vstack((np.cos(4 * x), -4 * np.sin(4 * x)))
    return solve_bvp(fun, lambda a, b, p: [a[1], b[1], a[0] - 1], x, guess[:n], p=[15.0], tol=1e-9, max_nodes=10000)


def test_unknown_parameters_are_components_of_a_compiled_function() -> None:
    special = pytest.importorskip("scipy.special")
    exact = special.mathieu_a(4, 5)
    by_numpy = eigenvalue(lambda x, y, p: np.vstack((y[1], -(p[0] - 10 * np.cos(2 * x)) * y[0])))
    by_trace = eigenvalue(trace(lambda x, z: [z[1], -(z[2] - 10 * np.cos(2 * x)) * z[0], 0 * z[0]], 3))
    by_text = eigenvalue(["y[1]", "-(y[2] - 10*cos(2*t))*y[0]", "0"])
    for found in (by_numpy, by_trace, by_text):
        assert found.success and found.y.shape[0] == 2
        assert abs(found.p[0] - exact) < 1e-7


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
def test_wrong_compiled_functions() -> None:
    with pytest.raises(ValueError, match=r"one of 2 components, but `y` and `p`.* have 2 and 1"):
        eigenvalue(["y[1]", "-y[0]"])
    with pytest.raises(ValueError, match=r"component 2 of the compiled `fun` is p\[0\], a constant"):
        eigenvalue(["y[1]", "-y[2]*y[0]", "y[0] + 1"])

    def conditions(a: Any, b: Any) -> Any:
        return [a[0], b[0] - 1, b[2]]

    with pytest.raises(TypeError, match="real numbers"):
        solve_bvp(function("lorenz"), conditions, [0, 1], np.zeros((3, 2), complex))
    found = solve_bvp(["y[1]", "y[0] + sqrt(t - 0.5)", "0"], conditions, [0, 1], np.zeros((3, 2)))
    assert found.status == 4 and "Component 1 of `fun`" in found.message
    silent = as_callback(lambda x, y: 1 / 0, 3)  # ctypes prints the exception, and nothing is written
    assert solve_bvp(silent, conditions, [0, 1], np.zeros((3, 2))).status == 4
