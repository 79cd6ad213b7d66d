"""Events: SciPy's, and those with actions."""

from typing import Any

import numpy as np
import pytest

from continuo import Event, solve_ivp

GRAVITY = 9.81


def _ball(t: float, y: Any) -> list[float]:
    return [y[1], -GRAVITY]


def _floor(bounce: float, **options: Any) -> Event:
    return Event(lambda t, y: y[0], lambda t, y: [0.0, -bounce * y[1]], direction=-1, name="floor", **options)


def _landings(height: float, bounce: float, count: int) -> np.ndarray:
    first = np.sqrt(2 * height / GRAVITY)
    flights = 2 * GRAVITY * first * bounce ** np.arange(1, count) / GRAVITY
    return first + np.concatenate([[0], np.cumsum(flights)])


@pytest.mark.parametrize("method", ["RK45", "DOP853", "Radau", "BDF", "LSODA", None])
def test_thirty_bounces_in_one_call(method: str | None) -> None:
    random = np.random.default_rng(1)
    for _ in range(3):
        bounce, height = random.uniform(0.85, 0.95), random.uniform(0.5, 3)
        result = solve_ivp(
            _ball, (0, 100), [height, 0.0], method=method, events=_floor(bounce, terminal=30), dense_output=True
        )
        assert result.status == 1
        landings = _landings(height, bounce, 30)
        # All but BDF, which begins with order 1 after each bounce, solve the parabola to rounding, which the landings
        # before carry on.
        assert np.abs(result.t_events[0] - landings).max() < (0.05 if method == "BDF" else 1e-12 * landings[-1])
        assert np.all(result.y_after_events[0][:, 0] == 0)
        assert np.allclose(result.y_after_events[0][:, 1], -bounce * result.y_events[0][:, 1], rtol=1e-14)
        # Where the state jumps, its time is there twice.
        assert np.count_nonzero(np.diff(result.t) == 0) >= 29
        assert np.all(result.sol(np.linspace(0, landings[-1], 500))[0] > (-1e-3 if method == "BDF" else -1e-9))


def test_accumulation_is_reported() -> None:
    result = solve_ivp(_ball, (0, 100), [1.0, 0.0], events=_floor(0.8))
    first = np.sqrt(2 / GRAVITY)
    assert not result.success and "accumulate" in result.message
    assert abs(result.t[-1] - first * 1.8 / 0.2) < 1e-6

    moving = [True]

    def f(t: float, y: Any) -> list[float]:
        return [y[1], -GRAVITY] if moving[0] else [0.0, 0.0]

    def rest(t: float, y: Any) -> list[float]:
        moving[0] = False
        return [0.0, 0.0]

    result = solve_ivp(f, (0, 100), [1.0, 0.0], events=_floor(0.8, at_limit=rest))
    assert result.success and result.t[-1] == 100
    assert np.all(result.y[:, -1] == 0)


def test_three_roots_of_a_cubic_in_one_step() -> None:
    result = solve_ivp(lambda x, y: 3 * x**2 + 12 * x - 4, (-8, 4), np.array([-120.0]), events=lambda x, y: y)
    assert np.abs(result.t_events[0] - [-6, -2, 2]).max() < 1e-12


def test_roots_of_random_polynomials() -> None:
    random = np.random.default_rng(2)
    for _ in range(50):
        roots = np.sort(random.uniform(0.5, 9.5, random.integers(1, 6)))
        if np.any(np.diff(roots) < 0.1):
            continue
        polynomial = np.poly1d(roots, r=True)
        for direction in (-1, 0, 1):
            event = Event(lambda t, y: polynomial(y[0]), direction=direction)
            result = solve_ivp(lambda t, y: [1.0], (0, 10), [0.0], events=event)
            rises = polynomial.deriv()(roots) > 0
            expected = roots if direction == 0 else roots[rises == (direction > 0)]
            assert len(result.t_events[0]) == len(expected)
            assert np.allclose(result.t_events[0], expected, rtol=0, atol=1e-9)


def test_terminal_counts_and_times_that_are_exact() -> None:
    def f(t: float, y: Any) -> list[float]:
        return [y[1], -y[0]]

    def event(t: float, y: Any) -> float:
        return float(y[0])

    for terminal, count in ((True, 1), (3, 3), (False, 6)):
        event.terminal = terminal  # type: ignore[attr-defined]  # as SciPy has it
        result = solve_ivp(f, (0, 20), [1.0, 0.0], events=event, rtol=1e-9, atol=1e-12)
        assert len(result.t_events[0]) == count
        assert result.status == (1 if terminal else 0)
        if terminal:
            assert result.t[-1] == result.t_events[0][-1]
    result = solve_ivp(f, (0, 20), [1.0, 0.0], events=[lambda t, y: t - 7, lambda t, y: 3 - t])
    assert result.t_events[0][0] == 7 and result.t_events[1][0] == 3
    with pytest.raises(ValueError, match="terminal"):
        solve_ivp(f, (0, 1), [1.0, 0.0], events=Event(event, terminal=-2))


def test_t_eval_at_an_event_gives_the_state_after_it() -> None:
    event = Event(lambda t, y: t - 0.5, lambda t, y: y + 1)
    result = solve_ivp(lambda t, y: [1.0], (0, 1), [0.0], events=event, t_eval=[0.25, 0.75, 1.0])
    assert np.allclose(result.y[0], [0.25, 1.75, 2.0], atol=1e-12)


def test_backwards_with_jumps() -> None:
    event = Event(lambda t, y: t - 0.5, lambda t, y: [y[0] + 1])
    result = solve_ivp(lambda t, y: [1.0], (1, 0), [1.0], events=event, dense_output=True)
    assert abs(result.y[0, -1] - 1) < 1e-12
    assert abs(result.sol(0.75)[0] - 0.75) < 1e-12 and abs(result.sol(0.25)[0] - 1.25) < 1e-12


def test_further_arguments_reach_guards_and_actions() -> None:
    seen = []

    def action(t: float, y: Any, a: float, b: float) -> None:
        seen.append((a, b))

    event = Event(lambda t, y, a, b: y[0] - a, action)
    result = solve_ivp(lambda t, y, a, b: [b], (0, 1), [0.0], args=(0.5, 1.0), events=event)
    assert seen == [(0.5, 1.0)] and abs(result.t_events[0][0] - 0.5) < 1e-12
