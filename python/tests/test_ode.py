"""ode, complex_ode: runs continued call by call against closed forms, and every way in which a call can be bad."""

import os
import pickle
import signal
import threading
import warnings

import numpy as np
import pytest

import continuo
from continuo import complex_ode, ode

INTEGRATORS = ["vode", "lsoda", "dopri5", "dop853", "verner9", "radau", "bdf", "adams"]


def turn(t, y, w=1.0):
    return [w * y[1], -w * y[0]]


def begun(integrator: str, f=turn, y=(1.0, 0.0), **options) -> ode:
    return ode(f).set_integrator(integrator, **{"rtol": 1e-9, "atol": 1e-12, "nsteps": 5000, **options}).set_initial_value(y, 0.0)


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("seed", range(3))
def test_random_times_against_the_closed_form(integrator: str, seed: int) -> None:
    """Any times, near and far, forwards, with turns: the error is that of one run, some hundred tolerances."""
    rng = np.random.default_rng(seed)
    r = begun(integrator)
    for _ in range(40):
        t = r.t + rng.choice([1e-6, 0.01, 0.3, 2.0, -0.05]) * rng.random()
        y = r.integrate(t)
        assert r.successful() and r.t == t and y is r.y
        assert np.abs(y - [np.cos(t), -np.sin(t)]).max() < 1e-6


def test_calls_are_cheap() -> None:
    """A loop of a thousand calls takes a step for many of them, and two calls of f each to see whether f is the same."""
    calls = 0

    def counted(t, y):
        nonlocal calls
        calls += 1
        return turn(t, y)

    r = begun("dop853", counted)
    while r.t < 9.995:
        r.integrate(r.t + 0.01)
    assert calls < 2 * 1000 + 2500
    assert np.abs(r.y - [np.cos(r.t), -np.sin(r.t)]).max() < 1e-8


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_changed_parameters_and_states_take_effect(integrator: str) -> None:
    """By set_f_params, by a variable that f reads, by assignment to y: from that time on, as in a new run."""
    w = 1.0
    r = begun(integrator, lambda t, y, scale: turn(t, y, w * scale))
    r.set_f_params(1.0)
    phase = 0.0
    for part in (1.0, 3.0, 0.5):
        w = part
        for scale in (1.0, 2.0):
            r.set_f_params(scale)
            r.integrate(r.t + 0.25)
            r.integrate(r.t + 0.25)
            phase += 0.5 * part * scale
            assert np.abs(r.y - [np.cos(phase), -np.sin(phase)]).max() < 1e-7
    for w in (1.0, 5.0, 2.0):  # by the variable alone
        for _ in range(3):
            r.integrate(r.t + 0.1)
            phase += 0.1 * w * 2.0
            assert np.abs(r.y - [np.cos(phase), -np.sin(phase)]).max() < 1e-7
    r.y[:] = [0.0, 1.0]
    w = 0.5
    r.integrate(r.t + 0.5)
    assert np.abs(r.y - [np.sin(0.5), np.cos(0.5)]).max() < 1e-7


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_no_value_beyond_the_time_asked_for(integrator: str) -> None:
    """y' = -t / y on a circle that ends at t = 1, where f raises: until then each time is reached."""
    def f(t, y):
        if t > 1:
            raise ValueError("beyond")
        return [-t]

    r = begun(integrator, f, [0.5])
    for t in (0.5, 0.9, 0.99, 1.0):
        assert abs(r.integrate(t)[0] - (1 - t * t) / 2) < 1e-8
    with pytest.raises(ValueError, match="beyond"):
        r.integrate(1.5)
    assert not r.successful()


@pytest.mark.parametrize("integrator", ["vode", "lsoda", "verner9"])
def test_steps_and_relax(integrator: str) -> None:
    r = begun(integrator)
    times = []
    while r.t < 3:
        y = r.integrate(3.0, step=True)
        times.append(r.t)
        assert np.abs(y - [np.cos(r.t), -np.sin(r.t)]).max() < 1e-6
    assert len(times) > 3 and np.all(np.diff(times) > 0)
    r.integrate(r.t + 1, relax=True)
    assert np.abs(r.y - [np.cos(r.t), -np.sin(r.t)]).max() < 1e-6


def test_step_is_without_effect_for_dop853() -> None:
    r = begun("dop853")
    r.integrate(3.0, step=True)
    assert r.t == 3.0 and r.get_return_code() == 1


def test_failures_warn_and_stay() -> None:
    r = begun("dop853", nsteps=2)
    with pytest.warns(UserWarning, match="larger nsteps is needed"):
        y = r.integrate(100.0)
    assert not r.successful() and r.get_return_code() == -2
    assert 0 < r.t < 100 and np.abs(y - [np.cos(r.t), -np.sin(r.t)]).max() < 1e-6
    r.integrate(r.t + 0.1)
    assert not r.successful()
    r.set_initial_value([1.0, 0.0], 0.0)
    assert r.successful()
    blowing = begun("dopri5", lambda t, y: [y[0]**2], [1.0])
    with pytest.warns(UserWarning, match="dopri5"):
        blowing.integrate(2.0)
    assert not blowing.successful() and blowing.get_return_code() < 0 and blowing.t <= 1.0001
    nan = begun("vode", lambda t, y: [float("nan")], [1.0])
    with pytest.warns(UserWarning, match="vode"):
        nan.integrate(1.0)
    assert not nan.successful() and nan.get_return_code() < 0


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_exceptions_pass_through(integrator: str) -> None:
    class Own(Exception):
        pass

    def f(t, y):
        if t > 0.5:
            raise Own(t)
        return [1.0]

    r = begun(integrator, f, [0.0])
    with pytest.raises(Own) as caught:
        r.integrate(1.0)
    assert any(entry.name == "f" for entry in caught.traceback)
    assert r.t <= 0.5 and abs(r.y[0] - r.t) < 1e-12


@pytest.mark.parametrize(("f", "error"), [
    (lambda t, y: None, TypeError), (lambda t, y: [1.0, 2.0, 3.0], ValueError), (lambda t, y: "y", TypeError),
    (lambda t, y: [1j, 0], TypeError), (lambda t: [0.0, 0.0], TypeError)])
def test_bad_functions(f, error) -> None:
    with pytest.raises(error):
        begun("dop853", f).integrate(1.0)


def test_bad_types_of_arguments() -> None:
    with pytest.raises(TypeError, match="by its name"):
        ode(lambda t, y: y).set_integrator(5)
    for time in ("a", None):
        with pytest.raises(TypeError, match="time of the initial value"):
            ode(lambda t, y: y).set_initial_value([1.0], time)


def test_bad_arguments() -> None:
    with pytest.raises(TypeError, match="no option"):
        ode(turn).set_integrator("dopri5", lband=1)
    with pytest.raises(TypeError, match="no option"):
        ode(turn).set_integrator("verner9", jac_sparsity=1)
    with pytest.raises(ValueError, match="Unknown integration method"):
        ode(turn).set_integrator("vode", method="euler")
    with pytest.warns(UserWarning, match="No integrator name match"):
        ode(turn).set_integrator("rk")
    with pytest.warns(UserWarning, match="no effect: `safety`"):
        ode(turn).set_integrator("dopri5", safety=0.5)
    with pytest.raises(TypeError, match="complex"):
        ode(turn).set_integrator("vode").set_initial_value([1j, 0])
    with pytest.raises(ValueError, match="1-dimensional"):
        ode(turn).set_initial_value([[1.0]])
    with pytest.raises(ValueError, match="finite"):
        begun("dop853").integrate(np.nan)
    with pytest.raises(ValueError, match="zvode must be used with ode"):
        complex_ode(turn).set_integrator("zvode")
    with pytest.raises(ValueError, match="does not support solout"):
        begun("vode").set_solout(print)


def test_without_an_integrator_it_is_vode() -> None:
    r = ode(turn).set_initial_value([1.0, 0.0])
    assert np.abs(r.integrate(1.0) - [np.cos(1), -np.sin(1)]).max() < 1e-4
    assert r.get_return_code() == 2
    scalar = ode(lambda t, y: -y).set_integrator("dop853").set_initial_value(1.0)
    assert abs(scalar.integrate(1.0)[0] - np.exp(-1)) < 1e-6
    assert np.array_equal(scalar.integrate(scalar.t), scalar.y)


@pytest.mark.parametrize("integrator", ["vode", "lsoda", "dopri5", "radau"])
def test_complex_states(integrator: str) -> None:
    """y' = A y with random complex A that turns: of its eigenvectors each turns by itself."""
    rng = np.random.default_rng(5)
    vectors = rng.normal(size=(3, 3)) + 1j * rng.normal(size=(3, 3))
    values = 1j * rng.normal(size=3) - 0.1
    a = (vectors * values) @ np.linalg.inv(vectors)
    y0 = vectors.sum(axis=1)
    r = complex_ode(lambda t, y: a @ y, lambda t, y: a)
    r.set_integrator(integrator, rtol=1e-9, atol=1e-11, nsteps=5000).set_initial_value(y0)
    for t in (0.1, 1.0, 1.5, 4.0):
        assert np.abs(r.integrate(t) - vectors @ np.exp(values * t)).max() < 1e-6
    assert r.y.dtype == complex


def test_solout_at_every_step_of_every_call() -> None:
    seen = []
    r = begun("dop853")
    r.set_solout(lambda t, y: seen.append((t, y.copy())))
    r.integrate(1.0)
    r.integrate(2.0)
    assert [t for t, _ in seen].count(1.0) == 2 and seen[0][0] == 0.0 and seen[-1][0] == 2.0
    for t, y in seen:
        assert np.abs(y - [np.cos(t), -np.sin(t)]).max() < 1e-7
    r.set_solout(lambda t, y: -1 if t > 2.1 else 0)
    r.integrate(9.0)
    assert 2.1 < r.t < 9 and r.successful() and r.get_return_code() == 2


def test_interrupt_at_once() -> None:
    r = begun("dop853", lambda t, y: [y[1], -1e8 * y[0]], nsteps=10**9)
    threading.Timer(0.2, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        r.integrate(1e6)
    assert r.t > 0


def test_functions_that_are_not_pure_begin_anew() -> None:
    """A control that is held between calls: y' = u with u = -sign(y), set anew at each call."""
    u = 0.0
    r = begun("dopri5", lambda t, y: [u], [1.05])
    y = 1.05
    for _ in range(50):
        u = -np.sign(y)
        y += 0.1 * u
        assert abs(r.integrate(r.t + 0.1)[0] - y) < 1e-9


def test_nothing_leaks() -> None:
    resource = pytest.importorskip("resource")

    def used() -> int:
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

    def some() -> None:
        for _ in range(300):
            r = begun("dop853")
            r.integrate(0.1)
            r.integrate(0.2)
            try:
                begun("dop853", lambda t, y: 1 / 0).integrate(1.0)
            except ZeroDivisionError:
                pass

    some()
    before = used()
    some()
    assert used() - before < 1024  # kB


def test_many_at_a_time() -> None:
    runs = [begun(integrator) for integrator in INTEGRATORS]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for step in range(1, 20):
            for r in runs:
                assert abs(r.integrate(0.1 * step)[0] - np.cos(0.1 * step)) < 1e-7


def test_results_are_pickled() -> None:
    found = continuo.solve_bvp(lambda x, y: np.vstack((y[1], -y[0])), lambda a, b: np.array([a[0], b[0] - 1]),
                               [0, 0.5, 1], np.zeros((2, 3)))
    again = pickle.loads(pickle.dumps(found))
    np.testing.assert_array_equal(again.sol([0.1, 0.7]), found.sol([0.1, 0.7]))
