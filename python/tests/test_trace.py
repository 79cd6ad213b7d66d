"""Traced functions and expressions: their values and Jacobians against NumPy, and what is refused.

The class that tracing claims: functions of t, y and parameters made by Python's arithmetic, NumPy's
elementwise functions, products of matrices, slices and loops, with choices by continuo.where.
"""

import math
import pickle
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import continuo

# Functions of one argument: how they are called, their slope, and the rounding errors within, in units of
# 2^-53*(1 + |value|): the language makes some of others.
ONE: dict[str, tuple[Callable[[Any], Any], Callable[[Any], Any], float]] = {
    "sin": (np.sin, np.cos, 0),
    "cos": (np.cos, np.sin, 0),
    "tan": (lambda x: np.tan(np.tanh(x)), lambda x: 4.0, 4),
    "arcsin": (lambda x: np.arcsin(0.9 * np.tanh(x)), lambda x: 2.5, 4),
    "arccos": (lambda x: np.arccos(0.9 * np.tanh(x)), lambda x: 2.5, 4),
    "arctan": (np.arctan, lambda x: 1.0, 0),
    "sinh": (lambda x: np.sinh(np.tanh(x)), lambda x: 1.6, 4),
    "cosh": (lambda x: np.cosh(np.tanh(x)), lambda x: 1.2, 4),
    "tanh": (np.tanh, lambda x: 1.0, 0),
    "arcsinh": (np.arcsinh, lambda x: 1.0, 4),
    "arccosh": (lambda x: np.arccosh(1.5 + x * x), lambda x: 2.0, 8),
    "arctanh": (lambda x: np.arctanh(0.9 * np.tanh(x)), lambda x: 5.0, 8),
    "exp": (lambda x: np.exp(-np.abs(x)), lambda x: 1.0, 2),
    "expm1": (lambda x: np.expm1(np.tanh(x)), lambda x: 2.8, 8),
    "exp2": (lambda x: np.exp2(np.tanh(x)), lambda x: 1.4, 4),
    "log": (lambda x: np.log(np.abs(x) + 0.5), lambda x: 2.0, 4),
    "log2": (lambda x: np.log2(np.abs(x) + 0.5), lambda x: 3.0, 8),
    "log10": (lambda x: np.log10(np.abs(x) + 0.5), lambda x: 1.0, 4),
    "sqrt": (lambda x: np.sqrt(np.abs(x) + 0.1), lambda x: 2.0, 2),
    "cbrt": (lambda x: np.cbrt(np.abs(x) + 0.1), lambda x: 2.0, 8),
    "abs": (np.abs, lambda x: 1.0, 0),
    "negative": (lambda x: -x, lambda x: 1.0, 0),
    "square": (np.square, lambda x: 2 * np.abs(x), 0),
    "cube": (lambda x: x**3, lambda x: 3 * x * x, 4),
    "root": (lambda x: (np.abs(x) + 0.1) ** 1.7, lambda x: 1.7 * (np.abs(x) + 0.1) ** 0.7, 8),
    "power": (lambda x: 0.7 ** np.tanh(x), lambda x: 0.6, 8),
    "reciprocal": (lambda x: 1 / (1 + x * x), lambda x: 1.0, 4),
}
TWO: dict[str, tuple[Callable[[Any, Any], Any], Callable[[Any, Any], tuple[Any, Any]], float]] = {
    "add": (lambda a, b: a + b, lambda a, b: (1, 1), 1),
    "subtract": (lambda a, b: a - b, lambda a, b: (1, 1), 1),
    "multiply": (lambda a, b: a * b, lambda a, b: (abs(b), abs(a)), 1),
    "divide": (lambda a, b: a / (1 + b * b), lambda a, b: (1 / (1 + b * b), abs(a)), 4),
    "maximum": (continuo.maximum, lambda a, b: (1, 1), 0),
    "minimum": (continuo.minimum, lambda a, b: (1, 1), 0),
    "hypot": (np.hypot, lambda a, b: (1, 1), 4),
    "arctan2": (lambda a, b: np.arctan2(a, np.abs(b) + 0.5), lambda a, b: (2, 2), 4),
    "where": (lambda a, b: continuo.where(a < b, a * 2, b - 1), lambda a, b: (2, 1), 1),
    "both": (lambda a, b: continuo.where((a > 0) & np.logical_not(b >= 1), a, 3 * b), lambda a, b: (1, 3), 1),
    "either": (lambda a, b: continuo.where((a > 0) | (b > 1), b, a), lambda a, b: (1, 1), 0),
    "clip": (lambda a, b: np.clip(a, -0.5, 0.75) + b, lambda a, b: (1, 1), 1),
}
# These jump: close to a whole number both sides are right.
JUMPS: dict[str, Callable[[Any], Any]] = {
    "floor": np.floor,
    "ceil": np.ceil,
    "rint": np.rint,
    "trunc": np.trunc,
    "sign": np.sign,
    "mod": lambda x: x % 3.0,
    "negative mod": lambda x: x % -0.7,
    "fmod": lambda x: np.fmod(x, 0.7),
    "floor divide": lambda x: x // 0.3,
    "heaviside": lambda x: np.heaviside(x, 0.5),
}

Tree = tuple[Any, ...]


def random_tree(random: np.random.Generator, depth: int, n: int) -> Tree:
    kind = random.integers(10)
    if depth == 0 or kind == 0:
        leaf = random.integers(n + 2)
        if leaf == n + 1:
            return ("constant", float(random.normal()))
        return ("t",) if leaf == n else ("y", int(leaf))
    if kind < 5:
        return (str(random.choice(list(ONE))), random_tree(random, depth - 1, n))
    left, right = (random_tree(random, depth - 1, n) for _ in range(2))
    return (str(random.choice(list(TWO))), left, right)


def value_of(tree: Tree, t: Any, y: Any) -> Any:
    if tree[0] == "constant":
        return tree[1]
    if tree[0] == "t":
        return t
    if tree[0] == "y":
        return y[tree[1]]
    arguments = [value_of(part, t, y) for part in tree[1:]]
    return ONE[tree[0]][0](*arguments) if len(arguments) == 1 else TWO[tree[0]][0](*arguments)


def value_and_rounding(tree: Tree, t: float, y: Any) -> tuple[float, float]:
    """The value, and by how much rounding may move it, to first order."""
    unit = 2.0**-52
    if len(tree) == 1 or tree[0] in ("constant", "y"):
        return float(value_of(tree, t, y)), 0.0
    parts = [value_and_rounding(part, t, y) for part in tree[1:]]
    values = [part[0] for part in parts]
    if len(values) == 1:
        f, slope, rounded = ONE[tree[0]]
        slopes: tuple[Any, ...] = (slope(values[0]),)
    else:
        g, slopes_of, rounded = TWO[tree[0]]
        slopes = slopes_of(*values)
        value = float(g(*values))
    if len(values) == 1:
        value = float(f(values[0]))
    moved = sum(abs(s) * part[1] for s, part in zip(slopes, parts))
    return value, float(moved + unit * (2 * abs(value) + rounded * (1 + abs(value) + max(map(abs, values)))))


@pytest.mark.parametrize("seed", range(20))
def test_values_are_those_of_numpy_to_rounding(seed: int) -> None:
    random = np.random.default_rng(seed)
    n = 4
    trees = [random_tree(random, 5, n) for _ in range(n)]
    f = continuo.trace(lambda t, y: [value_of(tree, t, y) for tree in trees], n, native="never")
    for _ in range(10):
        t, y = float(random.normal()), random.normal(size=n)
        for tree, found in zip(trees, f(t, y)):
            value, rounding = value_and_rounding(tree, t, y)
            assert abs(found - value) <= 2 * rounding, (tree, t, y)


@pytest.mark.parametrize("name", JUMPS)
def test_functions_with_jumps(name: str) -> None:
    f = continuo.trace(lambda t, y: JUMPS[name](y), 1, native="never")
    for x in [*np.random.default_rng(1).normal(scale=3, size=50), 0.0, 1.0, -2.0, 0.5, 1.5, 2.5, -0.5, -1.5]:
        if name in ("negative mod", "fmod", "floor divide") and abs(x * 10 - round(x * 10)) < 1e-9:
            continue  # a multiple of a number that is no binary fraction: rounding decides
        expected = JUMPS[name](np.float64(x))
        assert abs(f(0, [x])[0] - expected) <= 4e-16 * (1 + abs(x)), x


def test_not() -> None:
    f = continuo.trace(lambda t, y: [continuo.where(~(y[0] > 1) | (y[0] > 2), 5.0, 6.0)], 1)
    assert [f(0, [x])[0] for x in (0.0, 1.5, 3.0)] == [5, 6, 5]


@pytest.mark.parametrize("seed", range(10))
def test_jacobian_is_the_derivative(seed: int) -> None:
    random = np.random.default_rng(100 + seed)
    n = 3
    trees = [random_tree(random, 4, n) for _ in range(n)]
    f = continuo.trace(lambda t, y: [value_of(tree, t, y) for tree in trees], n, native="never")
    # Central differences of order 6 in extended precision: off by about 140 h^6 f^(7)/7! and 2^-63/h.
    h, weights = np.longdouble(1e-3), [np.longdouble(w) / 60 for w in (-1, 9, -45, 45, -9, 1)]
    for _ in range(5):
        t, y = float(random.normal()), random.normal(size=n)
        found = f.jacobian(t, y)
        for j in range(n):
            moved = [y.astype(np.longdouble) + k * h * np.eye(n)[j] for k in (-3, -2, -1, 1, 2, 3)]
            for i, tree in enumerate(trees):
                values = [np.longdouble(value_of(tree, np.longdouble(t), x)) for x in moved]
                expected = sum(w * v for w, v in zip(weights, values)) / h
                halves = (values[3] - values[2]) / (2 * h)
                if abs(halves - expected) > 1e-3 * (1 + abs(expected)):
                    continue  # a corner lies among the points
                assert abs(found[i, j] - expected) <= 1e-5 * (1 + abs(expected)), (tree, t, y)


def lorenz(t: float, y: Any, s: float, r: float, b: float) -> list[Any]:
    return [s * (y[1] - y[0]), y[0] * (r - y[2]) - y[1], y[0] * y[1] - b * y[2]]


def test_machine_code_gives_the_same_bits() -> None:
    tape = continuo.trace(lorenz, 3, args=(10.0, 28.0, 8 / 3), native="never")
    code = continuo.trace(lorenz, 3, args=(10.0, 28.0, 8 / 3), native="always")
    if code.native["trouble"]:
        pytest.skip(code.native["trouble"])
    assert code.native["compiled"] + code.native["loaded"] > 0
    for y in np.random.default_rng(0).normal(size=(100, 3)):
        assert np.array_equal(tape(0, y), code(0, y))
        assert np.array_equal(tape.jacobian(0, y), code.jacobian(0, y))


def test_parameters_are_changed_without_tracing_again() -> None:
    calls = []

    def f(t: float, y: Any, k: float, m: Any, steps: int) -> Any:
        calls.append(t)
        for _ in range(steps):
            y = y * k
        return m @ y

    m = np.array([[0.0, 1.0], [-2.0, -0.5]])
    traced = continuo.trace(f, 2, args=(3.0, m, 2))
    after_tracing = len(calls)
    y = [1.0, 2.0]
    assert np.allclose(traced(0, y), 9 * m @ y, rtol=1e-15)
    traced.parameters["k"] = 5.0
    traced.parameters["m"] = 2 * m
    assert np.allclose(traced(0, y), 50 * m @ y, rtol=1e-15)
    assert np.allclose(traced(0, y, 1.0, m, 2), m @ y, rtol=1e-15)
    assert np.allclose(traced(0, y, k=2.0), 8 * m @ y, rtol=1e-15)
    assert np.allclose(pickle.loads(pickle.dumps(traced))(0, y), 50 * m @ y, rtol=1e-15)
    assert len(calls) == after_tracing
    assert set(traced.parameters) == {"k", "m"}
    assert traced.parameters["m"].shape == (2, 2)
    with pytest.raises(TypeError, match="trace it again"):
        traced(0, y, steps=3)
    with pytest.raises(KeyError, match="there are: k, m"):
        traced.parameters["q"] = 1
    with pytest.raises(ValueError, match=r"\(2, 2\)"):
        traced.parameters["m"] = np.eye(3)
    with pytest.raises(KeyError):
        traced.parameters["steps"]


def test_the_model_is_a_text_that_gives_the_same() -> None:
    traced = continuo.trace(lorenz, 3, args=(10.0, 28.0, 8 / 3), y0=[1.0, 2.0, 3.0])
    traced.parameters["r"] = 1e-30
    again = continuo.RightHandSide(traced.model)
    y = np.array([1.0, -2.0, 0.5])
    assert np.array_equal(again(0, y), traced(0, y))
    assert again.parameters["r"] == 1e-30
    assert np.array_equal(again.initial_state, [1, 2, 3])
    assert "lorenz_rates(" in traced.c()


def test_names_that_the_language_has_for_itself() -> None:
    traced = continuo.trace(
        lambda t, run, t_, when, σ: [when * run[0] + σ * t_, t * run[1]], 2, args=(1.0, 2.0, 3.0)
    )
    assert np.array_equal(traced(2, [5, 7]), [13, 14])
    assert list(traced.parameters) == ["t_", "when", "σ"]


def test_arrays_as_numpy_has_them() -> None:
    a = np.random.default_rng(3).normal(size=(5, 5))

    def f(t: float, y: Any) -> Any:
        d = np.zeros_like(y)
        d[1:-1] = y[:-2] - 2 * y[1:-1] + y[2:]
        d[0] = np.sum(y) - np.max(y) + np.prod(y[:2])
        d[-1] = np.linalg.norm(y) + np.dot(y, y)
        d += a @ y + np.roll(y, 1) + np.where(y > 0, y, 0.5 * y) + np.outer(y, y)[2]
        first, *_, last = y
        return np.concatenate([d[:-1], [d[-1] + first * last]])

    traced = continuo.trace(f, 5, native="never")
    for y in np.random.default_rng(4).normal(size=(20, 5)):
        assert np.allclose(traced(0, y), f(0, y), rtol=1e-13, atol=1e-13)


def test_long_computations() -> None:
    def f(t: float, y: Any) -> Any:
        total = y[0]
        for k in range(3000):
            total = total + np.sin(k * y[0]) / (k + 1)
        x = y[0]
        for _ in range(2000):
            x = 0.5 * (x + np.cos(x))
        return [total, x]

    traced = continuo.trace(f, 2, native="never")
    assert np.allclose(traced(0, [0.3, 0.1]), f(0, np.array([0.3, 0.1])), rtol=1e-12)


def refuse(f: Callable[..., Any], match: str, n: int = 2, **options: Any) -> None:
    with pytest.raises(continuo.TraceError, match=match):
        continuo.trace(f, n, **options)


def test_what_cannot_be_traced_says_what_to_write() -> None:
    def branch(t: float, y: Any) -> Any:
        return [1.0 if y[0] > 0 else 2.0, y[1]]

    def in_floats(t: float, y: Any) -> Any:
        d = np.zeros(2)
        d[0] = y[1]
        return d

    def adds_to_floats(t: float, y: Any) -> Any:
        d = np.ones(2)
        d += y
        return d

    refuse(branch, r"test_trace.py, line \d+: return \[1.0 if (.|\n)*continuo.where\(condition, a, b\)")
    refuse(in_floats, r"np.zeros_like\(y\)")
    refuse(adds_to_floats, r"np.zeros_like\(y\)")
    refuse(lambda t, y: [math.sin(y[0]), 0.0], "write np.sin")
    refuse(lambda t, y: [math.atan2(y[0], y[1]), 0.0], "write np.arctan2")
    refuse(lambda t, y: [max(y), 0.0], "np.maximum")
    refuse(lambda t, y: [y[int(y[0])], 0.0], "np.floor")
    refuse(lambda t, y: [[1, 2][y[0]], 0.0], "index")
    refuse(lambda t, y: [continuo.where((y[0] > 0) & ~True, 1.0, 0.0), 0.0], "no condition")
    refuse(lambda t, y: np.log1p(y), r"np.log\(1 \+ x\)")
    refuse(lambda t, y: np.fft.fft(y), "np.fft")
    refuse(lambda t, y: np.linalg.solve(np.eye(2), y), "np.solve cannot be traced")
    refuse(lambda t, y: 1j * y, "complex")
    refuse(lambda t, y: y * np.inf, "inf")
    refuse(lambda t, y: [y[0]], r"shape \(1,\)")
    refuse(lambda t, y: [y, y], r"shape \(2, 2\)")
    refuse(lambda t, y: [y[0], "a"], "component 1 of dy/dt is a str")
    refuse(lambda t, y: None, "returned None")
    refuse(lambda t, y: np.empty_like(y), "never set")


def test_a_function_that_is_not_its_equations_is_found() -> None:
    def swallows(t: float, y: Any) -> Any:
        try:
            k = 1.0 if y[0] > 0 else 2.0
        except TypeError:
            k = 3.0
        return [k, y[1]]

    values = iter(range(1000))
    refuse(swallows, "more than its arguments")
    refuse(lambda t, y: [next(values), y[0]], "more than its arguments")
    refuse(lambda t, y: [np.random.default_rng().random(), y[0]], "more than its arguments")
    with pytest.warns(UserWarning, match="y0="):
        continuo.trace(lambda t, y: np.sqrt(y - 1e6), 2)


def test_exceptions_of_f_pass_through() -> None:
    def f(t: float, y: Any) -> Any:
        raise LookupError("mine")

    with pytest.raises(LookupError, match="mine"):
        continuo.trace(f, 2)


def test_wrong_arguments() -> None:
    f = continuo.trace(lorenz, 3, args=(10.0, 28.0, 8 / 3))
    for y in ([1, 2], [[1], [2]], 1.0, []):
        with pytest.raises(ValueError, match="shape"):
            f(0, y)
    with pytest.raises(TypeError, match="complex"):
        f(0, [1j, 2, 3])
    with pytest.raises(TypeError):
        f(0, ["a", "b", "c"])
    with pytest.raises(TypeError, match="needs n"):
        continuo.trace(lorenz)  # type: ignore[call-overload, unused-ignore]
    with pytest.raises(TypeError, match="y0 is given by its name"):
        continuo.trace(lorenz, [1.0, 2.0, 3.0])  # type: ignore[call-overload, unused-ignore]
    with pytest.raises(ValueError, match="not finite"):
        continuo.trace(lorenz, 3, args=(math.nan, 1.0, 1.0))
    with pytest.raises(ValueError, match="'always'"):
        continuo.trace(lorenz, 3, args=(1.0, 1.0, 1.0), native="maybe")


def test_columns() -> None:
    f = continuo.trace(lorenz, 3, args=(10.0, 28.0, 8 / 3))
    y = np.random.default_rng(0).normal(size=(3, 4))
    assert np.array_equal(f(0, y), np.column_stack([f(0, column) for column in y.T]))


def test_expressions_of_the_language() -> None:
    f = continuo.expression("x'' = -k/m*x; let r = x + 1; z' = r", k=4, m=2)
    assert f.states == ["x", "x'", "z"]
    assert np.array_equal(f(0, [1, 2, 3]), [2, -2, 2])
    assert np.array_equal(f.jacobian(0, [1, 2, 3]), [[0, 1, 0], [-2, 0, 0], [1, 0, 0]])
    f.parameters["k"] = 6
    assert np.array_equal(f(0, [1, 2, 3]), [2, -3, 2])
    assert np.array_equal(f(0, [1, 2, 3], 2, 1), [2, -2, 2])
    g = continuo.expression(["y[1]", "-w^2*y[0]"], w=3)
    assert np.array_equal(g(0, [1, 2]), [2, -9])
    h = continuo.expression("param N = 4\nfor i in 1..N { u[i]' = -i*u[i] }")
    assert np.array_equal(h(0, np.ones(4)), [-1, -2, -3, -4])
    with pytest.raises(ValueError, match="decides how many"):
        h.parameters["N"] = 5


def test_texts_that_are_no_right_hand_side() -> None:
    with pytest.raises(ValueError, match="E210"):
        continuo.expression("x' = q")
    with pytest.raises(ValueError, match="it has events"):
        continuo.RightHandSide("x' = 1; x(0) = 0; when x rises through 3 { x := 0 }\nrun 0..1")
    with pytest.raises(ValueError, match="algebraic"):
        continuo.RightHandSide("unknown v = 1; x' = v; 0 = v^3 - x; x(0) = 1\nrun 0..1")
    with pytest.raises(ValueError):
        continuo.expression("")
    with pytest.raises(ValueError):
        continuo.expression([])
    with pytest.raises(ValueError, match="finite"):
        continuo.expression("x' = k", k=math.inf)
    with pytest.raises(TypeError, match="must be a number"):
        continuo.expression("x' = k", k=[1])  # type: ignore[arg-type]


def test_threads_share_a_right_hand_side() -> None:
    from concurrent.futures import ThreadPoolExecutor

    f = continuo.trace(lorenz, 3, args=(10.0, 28.0, 8 / 3))
    points = np.random.default_rng(0).normal(size=(400, 3))
    expected = [f(0, y) for y in points]

    def work(_: int) -> bool:
        return all(np.array_equal(f(0, y), e) for y, e in zip(points, expected))

    with ThreadPoolExecutor(8) as pool:
        assert all(pool.map(work, range(16)))


def test_solvers_take_them_with_arguments() -> None:
    def spring(t: float, y: Any, k: float) -> list[Any]:
        return [y[1], -k * y[0]]

    traced = continuo.trace(spring, 2, args=(1.0,))
    end = continuo.solve_ivp(traced, (0, 1), [1, 0], rtol=1e-10, atol=1e-12).y[:, -1]
    assert np.allclose(end, [math.cos(1), -math.sin(1)], atol=1e-8)
    rising: Any = lambda t, y, k: y[0] - 0.5  # noqa: E731
    result = continuo.solve_ivp(
        traced, (0, 1), [1, 0], "Radau", rtol=1e-8, atol=1e-10, args=(4.0,), events=rising
    )
    assert np.allclose(result.y[:, -1], [math.cos(2), -2 * math.sin(2)], atol=1e-6)
    assert abs(result.t_events[0][0] - math.pi / 6) < 1e-6
    assert traced.parameters["k"] == 1
    for f in ("x' = v; v' = -x", ["y[1]", "-y[0]"], continuo.expression("x'' = -x")):
        end = continuo.solve_ivp(f, (0, 1), [1, 0], rtol=1e-10, atol=1e-12).y[:, -1]
        assert np.allclose(end, [math.cos(1), -math.sin(1)], atol=1e-8)
    with pytest.raises(TypeError, match="2 arguments"):
        continuo.solve_ivp(traced, (0, 1), [1, 0], args=(1.0, 2.0))
    with pytest.raises(ValueError, match="3 components|one of 2"):
        continuo.solve_ivp(traced, (0, 1), [1, 0, 0])
    with pytest.raises(ValueError, match="E210"):
        continuo.solve_ivp("x' = q", (0, 1), [1])


def test_models_of_equations_are_functions(tmp_path: Any) -> None:
    (tmp_path / "pull.csv").write_text("x,y\n0,0\n1,2\n2,2\n")
    file = tmp_path / "spring.sim"
    equations = "x'' = -k*interp(pull, x)\nx(0) = 1; x'(0) = 0\nrun 0..1\n"
    file.write_text('table pull from "pull.csv"\nparam k = 1\n' + equations)
    model = continuo.Model(file)
    model.k = 3
    f = model.right_hand_side()
    model.k = 4
    assert f.states == ["x", "x'"] and f.parameters["k"] == 3
    assert np.array_equal(f(0, [0.5, 7]), [7, -3])
    end = continuo.solve_ivp(model, (0, 0.1), [0.5, 0], rtol=1e-10, atol=1e-12).y[:, -1]
    assert np.allclose(
        end, [0.5 * math.cos(math.sqrt(8) * 0.1), -0.5 * math.sqrt(8) * math.sin(math.sqrt(8) * 0.1)]
    )
    assert np.array_equal(f.initial_state, [1, 0])
    bouncing = continuo.Model(text="h' = -1; h(0) = 1\nwhen h falls through 0 { h := 1 }\nrun 0..1")
    with pytest.raises(continuo.ModelError, match="it has events"):
        bouncing.right_hand_side()


@pytest.mark.parametrize("seed", range(8))
def test_the_pattern_of_the_jacobian(seed: int) -> None:
    """Random sparse systems, linear and not: the pattern has all that differs from zero, and the solvers take it."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(20, 40))
    matrix = np.where(rng.random((n, n)) < 0.08, rng.normal(size=(n, n)), 0)
    kinds = rng.integers(0, 3, n)

    def f(t: Any, y: Any, k: Any) -> Any:
        rows = matrix @ y
        return [(rows[i], np.sin(rows[i]), rows[i] * y[i])[kinds[i]] - k * y[i] for i in range(n)]

    traced = continuo.trace(f, n, args=(100.0,))
    y = rng.normal(size=n)
    dense = traced.jacobian(0.3, y, 50.0)
    rows, columns = traced.jacobian_pattern()
    known = np.zeros((n, n), bool)
    known[rows, columns] = True
    assert not np.any(dense[~known]) and np.all(np.diagonal(known)) and len(rows) < n * n / 4
    mass = np.eye(n) + 0.1 * np.eye(n, k=1)
    for options in ({}, {"args": (50.0,)}, {"mass": mass}, {"mass": np.linspace(1, 2, n)}):
        k = options.get("args", (100.0,))[0]

        def by_rows(t: float, y: Any, *_: Any, k: float = k) -> Any:
            return traced.jacobian(t, y, k)

        for method in ("Radau", "BDF", "rodas5p", None):
            sparse, rows_given = (
                continuo.solve_ivp(traced, (0, 1), y, method=method, rtol=1e-6, atol=1e-9, jac=jac, **options)
                for jac in (None, by_rows)
            )
            # Both are within the tolerance, as errors are damped by exp(-k/2 t).
            assert sparse.success and np.abs(sparse.y[:, -1] - rows_given.y[:, -1]).max() < 2e-5
            assert sparse.nfev < 3 * rows_given.nfev  # no differences of columns
