"""solve_ivp: accuracy of every method on random systems, options, compiled right-hand sides, results."""

import ctypes
import pickle
from typing import Any

import numpy as np
import pytest
from compiled import address, function

import continuo
from continuo import _continuo, solve_ivp

linalg = pytest.importorskip("scipy.linalg")
sparse = pytest.importorskip("scipy.sparse")

METHODS = [(name, info) for name, *info in _continuo.methods()]
ADAPTIVE = [name for name, (order, error_order, second_order, _) in METHODS if error_order > 0 and not second_order]
FIXED = [name for name, (order, error_order, second_order, _) in METHODS if error_order == 0 and not second_order]


def _linear(n: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """A random system with eigenvalues of sizes around 1 to the left of 0.5, and an initial state."""
    random = np.random.default_rng(seed)
    matrix = random.normal(size=(n, n)) / np.sqrt(n)
    return matrix - 0.5 * np.eye(n), random.normal(size=n)


@pytest.mark.parametrize("name", ADAPTIVE + ["RK23", "RK45", "DOP853", "Radau", "BDF", "LSODA", None])
def test_adaptive_methods_follow_the_exponential(name: str | None) -> None:
    low = name in ("implicit_euler", "explicit_euler", "rkc2", "bdf2", "rosenbrock23", "trbdf2", "trapezoidal")
    for seed, span in ((1, (0.0, 3.0)), (2, (1.0, -1.0))):
        matrix, y0 = _linear(5, seed)
        for rtol in (1e-3, 1e-4) if low else (1e-4, 1e-7):
            result = solve_ivp(lambda t, y: matrix @ y, span, y0, method=name, rtol=rtol, atol=rtol)
            assert result.success, result.message
            exact = linalg.expm(matrix * (span[1] - span[0])) @ y0
            # A step may err by the tolerance; some tens of steps and e^3 of growth come to it.
            assert np.abs(result.y[:, -1] - exact).max() < 300 * rtol * (1 + np.abs(exact).max())


@pytest.mark.parametrize("name", FIXED)
def test_fixed_steps_converge_with_the_order(name: str) -> None:
    if name in ("semi_implicit_euler", "symplectic_euler_position_first", "velocity_verlet", "central_difference"):
        pairs = {"pairs": [(0, 1)]}
    else:
        pairs = {}
    order = dict((key, info[0]) for key, info in METHODS)[name]
    ends = [
        solve_ivp(lambda t, y: [y[1], -y[0]], (0, 2), [1.0, 0.5], method=name, step=h, **pairs).y[:, -1]
        for h in (0.1, 0.05)
    ]
    exact = [np.cos(2) + 0.5 * np.sin(2), -np.sin(2) + 0.5 * np.cos(2)]
    errors = [np.abs(end - exact).max() for end in ends]
    assert errors[0] / errors[1] > 0.75 * 2**order or errors[1] < 1e-12


def test_dense_output_meets_the_steps_and_is_as_accurate() -> None:
    matrix, y0 = _linear(4, 3)
    for method in ("RK23", "RK45", "DOP853", "Radau", "BDF", "LSODA", "verner9", "rodas5p"):
        result = solve_ivp(
            lambda t, y: matrix @ y, (0, 4), y0, method=method, rtol=1e-7, atol=1e-9, dense_output=True
        )
        assert np.array_equal(result.sol(result.t[1:]), result.y[:, 1:])
        times = np.linspace(0, 4, 101)
        exact = np.array([linalg.expm(matrix * t) @ y0 for t in times]).T
        assert np.abs(result.sol(times) - exact).max() < 1e-4
        at_times = solve_ivp(lambda t, y: matrix @ y, (0, 4), y0, method=method, rtol=1e-7, atol=1e-9, t_eval=times)
        assert np.array_equal(at_times.t, times)
        assert np.abs(at_times.y - result.sol(times)).max() < 1e-12
        assert result.sol(2.5).shape == (4,)


def test_complex_states() -> None:
    random = np.random.default_rng(5)
    matrix = random.normal(size=(3, 3)) + 1j * random.normal(size=(3, 3)) - 2 * np.eye(3)
    y0 = random.normal(size=3) + 1j * random.normal(size=3)
    exact = linalg.expm(matrix) @ y0
    for method, jac in (("RK45", None), ("DOP853", None), ("BDF", matrix), ("Radau", lambda t, y: matrix)):
        options = {} if jac is None else {"jac": jac}
        result = solve_ivp(lambda t, y: matrix @ y, (0, 1), y0, method=method, rtol=1e-8, atol=1e-10, **options)
        assert result.y.dtype == complex
        assert np.abs(result.y[:, -1] - exact).max() < 1e-6


def test_sparse_jacobians_agree_with_dense_ones() -> None:
    n = 60
    diffusion = sparse.diags([1.0, -2.0, 1.0], [-1, 0, 1], shape=(n, n), format="csc") * 50.0
    y0 = np.sin(np.arange(n))

    def f(t: float, y: Any) -> Any:
        return diffusion @ y - y**3

    def jac(t: float, y: Any) -> Any:
        return diffusion - sparse.diags(3 * y**2)

    def dense(t: float, y: Any) -> Any:
        return jac(t, y).toarray()

    ways: list[dict[str, Any]] = [
        {"jac": jac},
        {"jac": dense},
        {"jac_sparsity": diffusion != 0},
        {"lband": 1, "uband": 1},
        {},
    ]
    for method in ("BDF", "Radau", "LSODA"):
        ends = [
            solve_ivp(f, (0, 1), y0, method=method, rtol=1e-8, atol=1e-10, **way).y[:, -1] for way in ways
        ]
        for end in ends[1:]:
            assert np.abs(end - ends[0]).max() < 1e-6


def test_a_pattern_that_grows() -> None:
    n = 30

    def f(t: float, y: Any) -> Any:
        f = -y.copy()
        f[1:] += y[:-1] * (t > 0.5)
        return f

    def jac(t: float, y: Any) -> Any:
        matrix = -np.eye(n)
        if t > 0.5:
            matrix[np.arange(1, n), np.arange(n - 1)] = 1
        return sparse.csc_matrix(matrix)

    def dense(t: float, y: Any) -> Any:
        return jac(t, y).toarray()

    one = solve_ivp(f, (0, 1), np.ones(n), method="BDF", jac=jac, max_step=0.01)
    other = solve_ivp(f, (0, 1), np.ones(n), method="BDF", jac=dense, max_step=0.01)
    assert np.abs(one.y[:, -1] - other.y[:, -1]).max() < 1e-6


def test_compiled_right_hand_sides() -> None:
    y0 = [1.0, 1.0, 1.0]
    lorenz = function("lorenz")
    reference = solve_ivp(lorenz, (0, 2), y0, rtol=1e-8)
    assert reference.success

    class Traced:
        def __continuo_native__(self) -> _continuo.Native:
            return _continuo.Native(address("lorenz"), size=3)

    for f in (function("lorenz_without_user", 3), _continuo.Native(address("lorenz")), Traced()):
        assert np.array_equal(solve_ivp(f, (0, 2), y0, rtol=1e-8).y, reference.y)

    def python(t: float, y: Any) -> Any:
        a, b, c = y
        return [10 * (b - a), a * (28 - c) - b, a * b - 8.0 / 3 * c]

    assert np.abs(solve_ivp(python, (0, 2), y0, rtol=1e-8).y - reference.y).max() < 1e-9

    scipy = pytest.importorskip("scipy")
    rate = ctypes.c_double(2.0)
    decay = scipy.LowLevelCallable(
        function("decay"),
        ctypes.cast(ctypes.pointer(rate), ctypes.c_void_p),
        signature="void (double, double *, double *, void *)",
    )
    assert abs(solve_ivp(decay, (0, 1), [1.0], rtol=1e-9, atol=1e-12).y[0, -1] - np.exp(-2)) < 1e-8

    exact = _continuo.Native(address("robertson"), address("robertson_jacobian"))
    for method in ("BDF", "Radau", None):
        ends = [
            solve_ivp(f, (0, 1e4), [1.0, 0, 0], method=method, rtol=1e-8, atol=1e-12).y[:, -1]
            for f in (exact, function("robertson"))
        ]
        assert np.abs(ends[0] - ends[1]).max() < 1e-6


def test_compiled_right_hand_sides_that_do_not_fit() -> None:
    with pytest.raises(ValueError, match="one of 3 components, and y0 gives 2"):
        solve_ivp(_continuo.Native(address("lorenz"), size=3), (0, 1), [1.0, 2.0])
    with pytest.raises(TypeError, match="args"):
        solve_ivp(function("lorenz"), (0, 1), [1.0, 1, 1], args=(3,))
    with pytest.raises(TypeError, match="complex"):
        solve_ivp(function("lorenz"), (0, 1), [1j, 1, 1])
    wrong = function("lorenz")
    wrong = ctypes.CFUNCTYPE(None, ctypes.c_int)(lambda i: None)
    with pytest.raises(TypeError, match="signature"):
        solve_ivp(wrong, (0, 1), [1.0])
    with pytest.raises(ValueError, match="zero"):
        _continuo.Native(0)


def test_accelerations() -> None:
    for method in ("dprkn8", "dprkn12", "kahan_li8", None):
        options = {"step": 0.02} if method == "kahan_li8" else {}
        for f in (lambda t, x: [-x[0]], function("oscillator")):
            result = solve_ivp(
                f, (0, 10), [1.0, 0.0], method=method, second_order=True, rtol=1e-10, atol=1e-12, **options
            )
            assert np.abs(result.y[:, -1] - [np.cos(10), -np.sin(10)]).max() < 1e-8
    with pytest.raises(ValueError, match="second_order"):
        solve_ivp(lambda t, y: [y[1], -y[0]], (0, 1), [1.0, 0.0], method="dprkn8")
    with pytest.raises(ValueError, match="positions"):
        solve_ivp(lambda t, x: [-x[0]], (0, 1), [1.0, 0.0, 0.0], second_order=True)


def test_results_are_pickled() -> None:
    result = solve_ivp(lambda t, y: [-y[0]], (0, 1), [1.0], dense_output=True, events=lambda t, y: y[0] - 0.5)
    copy = pickle.loads(pickle.dumps(result))
    assert type(copy) is continuo.OdeResult
    assert np.array_equal(copy.sol(np.linspace(-1, 2, 7)), result.sol(np.linspace(-1, 2, 7)))
    assert copy["message"] == result.message
    with pytest.raises(AttributeError):
        _ = result.nothing
    assert "success: True" in repr(result)
    for damaged in (b"", b"12345678"):
        with pytest.raises(ValueError, match="damaged"):
            _continuo.DenseSolution.__new__(_continuo.DenseSolution).__setstate__((1, damaged, b"", b"", False))


def _decay(t: float, y: Any) -> list[float]:
    return [-y[0]]


def test_solvers_are_pickled() -> None:
    solver = continuo.DOP853(_decay, 0, [1.0], 5, rtol=1e-9, atol=1e-12)
    for _ in range(3):
        solver.step()
    copy = pickle.loads(pickle.dumps(solver))
    assert copy.t == solver.t and copy.nfev == solver.nfev
    while copy.status == "running":
        copy.step()
    assert copy.t == 5 and abs(copy.y[0] - np.exp(-5)) < 1e-9


def test_solver_classes_agree_with_solve_ivp() -> None:
    matrix, y0 = _linear(3, 7)
    for name in ("RK23", "RK45", "DOP853", "Radau", "LSODA"):
        solver = getattr(continuo, name)(lambda t, y: matrix @ y, 0, y0, 3)
        times = [0.0]
        while solver.status == "running":
            assert solver.step() is None
            times.append(solver.t)
        result = solve_ivp(lambda t, y: matrix @ y, (0, 3), y0, method=name)
        assert np.array_equal(times, result.t) and np.array_equal(solver.y, result.y[:, -1])
    with pytest.raises(RuntimeError, match="finished"):
        solver.step()


def test_options_without_effect_and_wrong_ones() -> None:
    with pytest.warns(UserWarning, match="no effect for a chosen solver: `jac`"):
        solve_ivp(_decay, (0, 1), [1.0], jac=[[-1.0]])
    for options, match in (
        ({"method": "rk4"}, "give it a step"),
        ({"method": "no such"}, "must be one of"),
        ({"rtol": [1e-3, 1e-3]}, "`rtol` has wrong shape"),
        ({"atol": -1.0}, "`atol` must be positive"),
        ({"max_step": 0}, "`max_step` must be positive"),
        ({"first_step": 2.0}, "exceeds bounds"),
        ({"state": "tuple"}, "`state`"),
        ({"t_eval": [0.5, 2]}, "not within"),
        ({"t_eval": [0.5, 0.2]}, "not properly sorted"),
    ):
        with pytest.raises(ValueError, match=match):
            solve_ivp(_decay, (0, 1), [1.0], **options)
    for span in ((0, np.nan), (np.nan, 1)):
        with pytest.raises(ValueError, match="not finite"):
            solve_ivp(_decay, span, [1.0])
    with pytest.raises(ValueError, match="All components of the initial state `y0` must be finite"):
        solve_ivp(_decay, (0, 1), [np.nan])
    result = solve_ivp(lambda t, y: y**2, (0, 2), [1.0])
    assert not result.success and result.status == -1 and abs(result.t[-1] - 1) < 1e-3


@pytest.mark.parametrize("name, value", [
    ("rtol", "a"), ("rtol", np.nan), ("atol", np.nan), ("atol", None), ("max_step", "a"), ("first_step", "a"),
    ("min_step", np.nan), ("max_steps", "a"), ("t_eval", ["a"]), ("t_eval", [1j]), ("jac", "a"), ("jac", [[np.nan]]),
    ("mass", "a"), ("pairs", [(0, -1)]), ("pairs", 3), ("pairs", [(0, 0.5)]), ("names", 3), ("names", [3]),
    ("names", ["a", "b"]), ("t_span", (0, 1, 2)), ("t_span", 5), ("t_span", (0, "b")), ("t_span", (0, None)),
])  # fmt: skip
def test_wrong_values_are_named(name: str, value: Any) -> None:
    arguments = {"fun": lambda t, y: [-y[0]], "t_span": (0, 1), "y0": [1.0], "method": "BDF", name: value}
    with pytest.raises((TypeError, ValueError), match=f"`{name}`"):
        solve_ivp(**arguments)


def test_attributes_of_events_that_cannot_be() -> None:
    for attribute, value in (("terminal", "yes"), ("terminal", np.nan), ("direction", "up"), ("direction", 1j)):

        def event(t: float, y: Any) -> Any:
            return y[0] - 0.5

        setattr(event, attribute, value)
        with pytest.raises(ValueError, match=f"`{attribute}` attribute of the event event"):
            solve_ivp(lambda t, y: [-y[0]], (0, 1), [1.0], events=event)
    with pytest.raises(TypeError, match="an event is a function"):
        solve_ivp(lambda t, y: [-y[0]], (0, 1), [1.0], events=3)


def test_a_solution_at_what_is_no_time() -> None:
    solution = solve_ivp(lambda t, y: [-y[0]], (0, 1), [1.0], dense_output=True).sol
    for time in ("a", ["a"]):
        with pytest.raises((TypeError, ValueError)):
            solution(time)


def test_progress() -> None:
    seen: list[float] = []
    result = solve_ivp(_decay, (0, 1), [1.0], progress=lambda t, part: seen.append(part))
    assert result.success and seen[-1] == 1


def test_the_time_of_an_infinite_run() -> None:
    def event(t: float, y: Any) -> float:
        return float(y[0] - 0.125)

    event.terminal = True  # type: ignore[attr-defined]  # as SciPy has it
    result = solve_ivp(_decay, (0, np.inf), [1.0], events=event, rtol=1e-10, atol=1e-12)
    assert result.status == 1 and abs(result.t[-1] - 3 * np.log(2)) < 1e-9


def test_functions_of_numba_and_methods_of_scipy() -> None:
    class Compiled:  # what a cfunc of numba has
        address = address("lorenz_without_user")
        native_name = "lorenz"

        class _sig:
            args = ("double", "double*", "double*")

    ends = [solve_ivp(f, (0, 1), [1.0, 1, 1]).y[:, -1] for f in (Compiled(), function("lorenz"))]
    assert np.array_equal(ends[0], ends[1])
    integrate = pytest.importorskip("scipy.integrate")
    by_class = solve_ivp(_decay, (0, 1), [1.0], method=integrate.DOP853)
    assert np.array_equal(by_class.y, solve_ivp(_decay, (0, 1), [1.0], method="DOP853").y)


def test_a_cfunc_of_numba() -> None:
    numba = pytest.importorskip("numba")
    types = numba.types
    signature = types.void(types.double, types.CPointer(types.double), types.CPointer(types.double), types.voidptr)

    @numba.cfunc(signature)
    def lorenz(t, y, dydt, user):  # type: ignore[no-untyped-def]  # numba has its own types
        dydt[0] = 10 * (y[1] - y[0])
        dydt[1] = y[0] * (28 - y[2]) - y[1]
        dydt[2] = y[0] * y[1] - 8.0 / 3 * y[2]

    for f in (lorenz, lorenz.ctypes):
        found, in_c = (solve_ivp(g, (0, 1), [1.0, 1, 1], rtol=1e-9, atol=1e-9) for g in (f, function("lorenz")))
        assert found.success and np.abs(found.y[:, -1] - in_c.y[:, -1]).max() < 1e-7
    without_user = numba.cfunc(types.void(*signature.args[:3]))(lambda t, y, dydt: None)
    assert solve_ivp(without_user, (0, 1), [1.0]).success
    with pytest.raises(TypeError, match="numba"):
        solve_ivp(numba.cfunc("double(double)")(lambda t: t), (0, 1), [1.0])


def test_a_band_of_complex_components() -> None:
    n = 25
    matrix = np.diag(np.full(n - 1, 1j), 1) + np.diag(np.full(n, -1 + 1j)) + np.diag(np.full(n - 1, 0.5), -1)
    y0 = np.exp(1j * np.arange(n))
    exact = linalg.expm(matrix) @ y0
    for options in ({"lband": 1, "uband": 1}, {"jac_sparsity": matrix != 0}, {"jac": sparse.csc_matrix(matrix)}):
        result = solve_ivp(lambda t, y: matrix @ y, (0, 1), y0, method="BDF", rtol=1e-7, atol=1e-9, **options)
        assert result.success and np.abs(result.y[:, -1] - exact).max() < 1e-4
