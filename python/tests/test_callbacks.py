"""Functions that a run calls: the state they get, the results they give, and every fault in them."""

import ctypes
import fractions
import math
import sys
from typing import Any, Callable

import numpy as np
import pytest

import continuo
from continuo import Event, solve_ivp


def _oscillator(t: float, y: Any) -> list[float]:
    return [y[1], -y[0]]


# The same right-hand side in the ways in which people write it.
FORMS: dict[str, Callable[[float, Any], Any]] = {
    "items": _oscillator,
    "unpacked": lambda t, y: (lambda a, b: (b, -a))(*y),
    "array": lambda t, y: np.array([y[1], -y[0]]),
    "slices": lambda t, y: np.concatenate([y[1:], -y[:1]]),
    "reversed": lambda t, y: y[::-1] * [1, -1],
    "matrix": lambda t, y: np.array([[0, 1], [-1, 0]]) @ y,
    "attributes": lambda t, y: np.array([y.max() if y[1] == y.max() else y.min(), -y[0]]).reshape(y.shape),
    "left number": lambda t, y: (1.0 * y)[::-1] * np.array([1, -1]),
    "right number": lambda t, y: (y * 1)[::-1] * np.array([1, -1]),
    "numpy number": lambda t, y: (np.float64(1) * y)[::-1] * np.array([1, -1]),
    "array first": lambda t, y: (np.ones(2) * y)[::-1] * np.array([1, -1]),
    "in place": lambda t, y: _in_place(y),
    "ufunc": lambda t, y: np.multiply(y, 1)[::-1] * [1, -1],
    "asarray": lambda t, y: np.asarray(y)[[1, 0]] * [1, -1],
    "list of the state": lambda t, y: [list(y)[1], -sum(list(y)[:1])],
    "fractions": lambda t, y: [fractions.Fraction(y[1]), -fractions.Fraction(y[0])],
    "zeros like": lambda t, y: np.zeros_like(y) + np.array([y[1], -y[0]]),
    "isinstance": lambda t, y: [y[1], -y[0]] if isinstance(y, np.ndarray) else None,
    "numbers of an array": lambda t, y: [y[1].item(), -y[0].item()],
    "column": lambda t, y: [y[-1], -y[-2]],
    "dot": lambda t, y: [y.dot([0, 1]), -y.dot([1, 0])],
    "float32": lambda t, y: [np.float32(0) + y[1], -y[0]],
}


def _in_place(y: Any) -> Any:
    y *= 1
    y[0], y[1] = y[1], -y[0]
    return y


@pytest.mark.parametrize("form", FORMS)
def test_the_state_serves_however_it_is_used(form: str) -> None:
    reference = solve_ivp(_oscillator, (0, 3), [1.0, 0.5], rtol=1e-8, atol=1e-10, state="array")
    for state in ("auto", "array"):
        result = solve_ivp(FORMS[form], (0, 3), [1.0, 0.5], rtol=1e-8, atol=1e-10, state=state)
        assert np.allclose(result.y, reference.y, rtol=1e-12, atol=1e-13)


def test_what_python_numbers_do_otherwise_than_arrays() -> None:
    # A division by zero, a power of a negative number, a large power: as with arrays, whose warnings are shown.
    for f in (lambda t, y: [1 / (y[0] * 0 + 1e-400)], lambda t, y: [(y[0] - 2) ** 0.5], lambda t, y: [(y[0] + 1e200) ** 2]):
        with pytest.warns(RuntimeWarning):
            result = solve_ivp(f, (0, 1), [1.0])
        assert not result.success and "not finite" in result.message


def test_a_list_is_a_list_where_it_is_asked_for() -> None:
    def f(t: float, y: Any) -> list[float]:
        assert type(y) is list
        return [-one for one in y]

    assert solve_ivp(f, (0, 1), [1.0, 2.0], state="list").success


def test_states_that_are_kept_are_not_overwritten() -> None:
    for state in ("auto", "array", "list"):
        kept: list[tuple[float, Any]] = []

        def f(t: float, y: Any) -> list[float]:
            kept.append((t, y))
            return [1.0]

        solve_ivp(f, (0, 1), [0.0], state=state)
        assert all(abs(y[0] - t) < 1e-12 for t, y in kept)


def test_a_state_that_is_changed_changes_nothing_else() -> None:
    def f(t: float, y: Any) -> list[float]:
        value = y[0]
        y[0] = 99.0
        return [-value]

    for state in ("auto", "array", "list"):
        result = solve_ivp(f, (0, 1), [1.0], rtol=1e-9, atol=1e-12, state=state)
        assert abs(result.y[0, -1] - math.exp(-1)) < 1e-8


def test_arrays_that_are_made_strange_are_not_used_again() -> None:
    def f(t: float, y: Any) -> Any:
        result = -y
        y.shape = (2, 1)
        y.flags.writeable = False
        return result

    result = solve_ivp(f, (0, 1), [1.0, 2.0], rtol=1e-9, atol=1e-12, state="array")
    assert abs(result.y[0, -1] - math.exp(-1)) < 1e-8


WRONG: list[tuple[Any, type[Exception], str]] = [
    (None, TypeError, "fun gave None"),
    ([1.0], ValueError, r"fun gave an array of shape \(1,\), and must give \(2,\)"),
    ([1.0, 2.0, 3.0], ValueError, r"\(3,\)"),
    (0.0, ValueError, r"shape \(\)"),
    (np.zeros((2, 1)), ValueError, r"\(2, 1\)"),
    ("ab", TypeError, "fun gave 'ab'"),
    ([None, 1], TypeError, "NoneType"),
    (["a", "b"], TypeError, "without numbers"),
    ([1j, 0], TypeError, "complex"),
    (np.array([1j, 0]), TypeError, "complex"),
    ({"a": 1}, TypeError, "fun gave a dict"),
    ([[1.0], 2.0], ValueError, "fun gave"),
    (object(), TypeError, "fun gave a object"),
]


@pytest.mark.parametrize("method", ["RK45", "BDF", "rodas5p", "LSODA"])
def test_wrong_results_name_the_function(method: str) -> None:
    for wrong, error, match in WRONG:
        for state in ("auto", "array"):
            with pytest.raises(error, match=match) as info:
                solve_ivp(lambda t, y: wrong if t > 0.5 else [0.0, 1.0], (0, 1), [1.0, 0.0], method=method, state=state)
            result = info.value.result  # type: ignore[attr-defined]  # what was computed until then
            assert result.status == -1 and 0 <= result.t[-1] <= 0.5 and np.all(np.isfinite(result.y))


def test_right_results_of_other_types() -> None:
    for right in ((1.0, 2), [True, 1], np.float32([1, 2]), np.array([1, 2]), np.arange(4.0)[1::2], [np.array(1.0), 2]):
        assert solve_ivp(lambda t, y: right, (0, 1), [1.0, 0.0]).success
    assert solve_ivp(lambda t, y: -y[0], (0, 1), [1.0]).success  # one component, one number


def _raiser(error: BaseException) -> Callable[..., Any]:
    def f(t: float, *rest: Any) -> Any:
        raise error

    return f


@pytest.mark.parametrize("error", [KeyError("boom"), SystemExit(3), MemoryError(), RecursionError(), StopIteration()])
def test_exceptions_pass_through(error: BaseException) -> None:
    def late(t: float, y: Any) -> list[float]:
        if t > 0.5:
            raise error
        return [y[1], -y[0]]

    raiser = _raiser(error)
    calls: list[tuple[str, Callable[[], Any]]] = [
        ("fun", lambda: solve_ivp(late, (0, 1), [1.0, 0.0])),
        ("fun", lambda: solve_ivp(late, (0, 1), [1.0, 0.0], method="Radau")),
        ("the event", lambda: solve_ivp(_oscillator, (0, 1), [1.0, 0.0], events=raiser)),
        (
            "the action of the event",
            lambda: solve_ivp(_oscillator, (0, 1), [1.0, 0.0], events=Event(lambda t, y: t - 0.5, raiser)),
        ),
        ("progress", lambda: solve_ivp(_oscillator, (0, 1), [1.0, 0.0], progress=raiser)),
    ]
    for name, call in calls:
        with pytest.raises(type(error)) as info:
            call()
        assert info.value is error
        frames = []
        traceback = info.tb
        while traceback is not None:
            frames.append(traceback.tb_frame.f_code.co_name)
            traceback = traceback.tb_next  # type: ignore[assignment]  # ends with None
        assert frames[-1] in ("late", "f")  # the traceback of the callback
        if sys.version_info >= (3, 11):
            assert name in error.__notes__[-1]
        assert info.value.result.status == -1  # type: ignore[attr-defined]


def test_faults_of_the_jacobian() -> None:
    good = np.array([[0.0, 1.0], [-1.0, 0.0]])
    for wrong, error in ((None, TypeError), (np.eye(3), ValueError), ("a", TypeError), (good * 1j, TypeError)):
        calls = 0

        def jac(t: float, y: Any) -> Any:
            nonlocal calls
            calls += 1
            return good if calls < 2 else wrong

        with pytest.raises(error, match="jac"):
            solve_ivp(_oscillator, (0, 1), [1.0, 0.0], method="rodas5p", jac=jac)
    with pytest.raises(ZeroDivisionError):
        solve_ivp(_oscillator, (0, 1), [1.0, 0.0], method="BDF", jac=lambda t, y: 1 / 0)
    result = solve_ivp(_oscillator, (0, 1), [1.0, 0.0], method="BDF", jac=lambda t, y: good * np.nan)
    assert not result.success and "not finite" in result.message


def test_faults_of_guards_and_actions() -> None:
    for wrong, error in ((None, TypeError), ([1, 2], ValueError), ("a", TypeError), (1j, TypeError), (np.nan, ValueError)):
        with pytest.raises(error, match="the event"):
            solve_ivp(_oscillator, (0, 1), [1.0, 0.0], events=lambda t, y: wrong if t > 0.2 else 1.0)
    for wrong, error in (("a", TypeError), ([1.0], ValueError), ([1j, 0], TypeError), ([np.nan, 0], ValueError)):
        with pytest.raises(error, match="the action of the event `jump`"):
            solve_ivp(_oscillator, (0, 1), [1.0, 0.0], events=Event(lambda t, y: t - 0.5, lambda t, y: wrong, name="jump"))
    with pytest.raises(TypeError, match="must be a function"):
        Event(3)  # type: ignore[arg-type]  # what is wrong with it
    with pytest.raises(TypeError, match=r"events\[0\]"):
        solve_ivp(_oscillator, (0, 1), [1.0, 0.0], events=[3])


def test_not_a_number_of_fun_ends_the_run_at_its_edge() -> None:
    for method in ("RK45", "DOP853", "Radau", "BDF", "LSODA", "rodas5p"):
        result = solve_ivp(lambda t, y: [np.nan if t > 0.5 else 1.0], (0, 1), [0.0], method=method)
        assert not result.success and result.status == -1
        assert "not finite" in result.message and result.t[-1] <= 0.5
        assert np.all(np.isfinite(result.y))


def test_what_is_no_function() -> None:
    for f in (3, None):
        with pytest.raises(TypeError):
            solve_ivp(f, (0, 1), [1.0])


def test_a_run_within_a_run() -> None:
    def f(t: float, y: Any) -> Any:
        return -solve_ivp(lambda s, z: [1.0], (0, 1), y).y[:, -1] + 1

    result = solve_ivp(f, (0, 1), [1.0], rtol=1e-8, atol=1e-10)
    assert abs(result.y[0, -1] - math.exp(-1)) < 1e-7


def test_errors_of_solver_classes() -> None:
    with pytest.raises(ValueError, match="fun gave"):
        continuo.RK45(lambda t, y: [1.0, 2.0], 0, [1.0], 1)
    solver = continuo.RK45(lambda t, y: 1 / 0 if t > 0.5 else [1.0], 0, [1.0], 1)
    with pytest.raises(ZeroDivisionError):
        while solver.status == "running":
            solver.step()
    assert solver.status == "failed" and solver.t <= 0.5


def test_a_run_is_not_advanced_from_within() -> None:
    solvers: list[continuo.RK45] = []

    def f(t: float, y: Any) -> list[float]:
        for solver in solvers:
            solver.step()
        return [1.0]

    solvers.append(continuo.RK45(f, 0, [0.0], 1))
    with pytest.raises(RuntimeError, match="is taking a step"):
        solvers[0].step()


def test_a_callback_of_ctypes_that_raises_gives_no_number(monkeypatch: pytest.MonkeyPatch) -> None:
    numbers = ctypes.POINTER(ctypes.c_double)
    raised = []
    monkeypatch.setattr(sys, "unraisablehook", raised.append)

    @ctypes.CFUNCTYPE(None, ctypes.c_double, numbers, numbers, ctypes.c_void_p)
    def f(t: float, y: Any, dydt: Any, user: int) -> None:
        if t > 0.5:
            raise ValueError("no")
        dydt[0] = 1.0

    result = solve_ivp(f, (0, 1), [0.0])
    assert raised and not result.success and result.t[-1] <= 0.5
