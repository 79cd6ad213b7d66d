"""odeint: random linear systems against their closed form, its options, and bad calls."""

import ctypes
import os
import signal
import threading
import warnings

import numpy as np
import pytest

from continuo import ODEintWarning, odeint


def linear(seed: int):
    """y' = A y with real A whose eigenvalues are -2^k, up to stiff ones; y0, and y(t)."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 6))
    values = -(10.0 ** rng.uniform(-1, 4, n))
    vectors = np.linalg.qr(rng.normal(size=(n, n)))[0]
    a = (vectors * values) @ vectors.T
    y0 = rng.normal(size=n)
    return a, y0, lambda t: np.array([vectors @ (np.exp(values * s) * (vectors.T @ y0)) for s in t])


@pytest.mark.parametrize("options", [{}, {"full_output": True}, {"tcrit": [0.3, 0.9, 7.0]}, {"mxstep": 10000}])
@pytest.mark.parametrize("seed", range(8))
def test_random_linear_systems(seed: int, options) -> None:
    """Decaying systems damp errors: those at the end are a small multiple of the tolerance."""
    a, y0, exact = linear(seed)
    rng = np.random.default_rng(seed + 100)
    t = np.sort(np.concatenate(([0.0, 1.0], rng.uniform(0, 1, 20), [0.5, 0.5])))
    for jac in (None, lambda y, t: a):
        found = odeint(lambda y, t: a @ y, y0, t, Dfun=jac, **options)
        y = found[0] if "full_output" in options else found
        assert y.shape == (len(t), len(y0))
        assert np.abs(y - exact(t)).max() < 1e-5


def test_backwards_and_repeated_times() -> None:
    t = np.array([2.0, 2.0, 1.0, 1.0, 0.0])
    for full in (False, True):
        y = odeint(lambda y, t: y, [np.exp(2), 2 * np.exp(2)], t, full_output=full)
        y = y[0] if full else y
        np.testing.assert_allclose(y, np.exp(t)[:, None] * [1, 2], rtol=1e-6)


def test_arguments_and_the_order_of_time() -> None:
    t = np.linspace(0, 1, 5)
    usual = odeint(lambda y, t, a, b: a * y + b * t, 1.0, t, args=(-1.0, 2.0))
    first = odeint(lambda t, y, a, b: a * y + b * t, 1.0, t, args=(-1.0, 2.0), tfirst=True)
    np.testing.assert_array_equal(usual, first)
    np.testing.assert_allclose(usual[:, 0], 3 * np.exp(-t) + 2 * t - 2, rtol=1e-7)
    np.testing.assert_allclose(odeint(lambda y, t, a: a * y, 1.0, t, args=-1.0)[:, 0], np.exp(-t), rtol=1e-7)


def test_critical_times_are_not_stepped_over() -> None:
    """A pulse so short that steps miss it, between two critical times: its area is 1."""
    width = 1e-4

    def pulse(y, t):
        return [1 / width if 0.5 <= t <= 0.5 + width else 0.0]

    y, info = odeint(pulse, [0.0], [0.0, 0.4, 1.0], tcrit=[0.5, 0.5 + width], full_output=True)
    assert abs(y[-1, 0] - 1) < 1e-2
    assert np.all(np.diff(info["nst"]) > 0) and np.all(info["tcur"] <= 1.0)


def test_dictionary() -> None:
    t = np.linspace(0, 1, 11)
    _, info = odeint(lambda y, t: -y, [1.0], t, full_output=True)
    names = {"hu", "tcur", "tolsf", "tsw", "nst", "nfe", "nje", "nqu", "imxer", "lenrw", "leniw", "mused", "message"}
    assert names <= info.keys()
    for name in ("hu", "tcur", "nst", "nfe", "nje", "mused"):
        assert info[name].shape == (10,)
    assert np.all(info["tcur"] >= t[1:]) and np.all(np.diff(info["nfe"]) >= 0) and info["nfe"][-1] > 0
    assert info["message"] == "Integration successful."


def test_steps_are_limited() -> None:
    sizes = []

    def f(y, t):
        sizes.append(t)
        return [0.0]

    odeint(f, [1.0], [0, 1], hmax=0.01)
    assert np.max(np.diff(np.unique(sizes))) <= 0.01 + 1e-12
    with pytest.warns(ODEintWarning, match="Excess work done"):
        y, info = odeint(lambda y, t: [y[1], -1e6 * y[0]], [1.0, 0.0], [0, 1e-3, 10], mxstep=20, full_output=True)
    assert info["message"].startswith("Excess work") and np.all(y[2] == 0) and np.any(y[1] != 0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        odeint(lambda y, t: [y[1], -1e6 * y[0]], [1.0, 0.0], [0, 1], rtol=1e-4)  # more than SciPy's 500 steps


def test_failures_warn() -> None:
    with pytest.warns(ODEintWarning, match="Run with full_output"):
        y = odeint(lambda y, t: y**2, [1.0], [0.0, 0.5, 2.0, 3.0])
    assert abs(y[1, 0] - 2) < 1e-6 and np.all(y[2:] == 0)
    with pytest.warns(ODEintWarning):
        odeint(lambda y, t: np.nan * y, [1.0], [0.0, 1.0])
    with pytest.warns(ODEintWarning, match="Integration successful"):
        odeint(lambda y, t: -y, [1.0], [0.0, 1.0], printmessg=True)


@pytest.mark.parametrize(("changes", "error"), [
    ({"t": [0, np.nan]}, ValueError), ({"t": [0, np.inf]}, ValueError), ({"t": [0, 2, 1]}, ValueError),
    ({"y0": [[1.0]]}, ValueError), ({"y0": [1j]}, TypeError), ({"y0": "y"}, ValueError), ({"rtol": [1e-3] * 3}, ValueError),
    ({"atol": -1.0}, ValueError), ({"ml": -1}, ValueError), ({"hmax": -1.0}, ValueError),
    ({"func": lambda y, t: [1.0, 2.0]}, RuntimeError), ({"func": lambda y, t: None}, ValueError),
    ({"func": lambda y: y}, TypeError), ({"func": lambda y, t: {}["no"]}, KeyError), ({"func": 3}, TypeError),
    ({"Dfun": lambda y, t: [[1.0, 2.0]]}, RuntimeError), ({"Dfun": lambda y: y}, TypeError)])
def test_bad_calls(changes, error) -> None:
    with pytest.raises(error):
        odeint(**{"func": lambda y, t: -y, "y0": [1.0], "t": [0.0, 1.0], **changes})


def test_compiled_functions_run_without_the_interpreter() -> None:
    signature = ctypes.CFUNCTYPE(None, ctypes.c_double, ctypes.POINTER(ctypes.c_double), ctypes.POINTER(ctypes.c_double))

    @signature
    def f(t, y, dydt):
        dydt[0] = -2 * y[0]

    t = np.linspace(0, 2, 9)
    np.testing.assert_allclose(odeint(f, [1.0], t)[:, 0], np.exp(-2 * t), rtol=1e-6)
    np.testing.assert_allclose(odeint(f, [1.0], t, full_output=True)[0][:, 0], np.exp(-2 * t), rtol=1e-6)


def test_empty() -> None:
    assert odeint(lambda y, t: y, [], [0.0, 1.0]).shape == (2, 0)
    assert odeint(lambda y, t: y, [1.0], []).shape == (0, 1)
    np.testing.assert_array_equal(odeint(lambda y, t: y, [1.0], [3.0]), [[1.0]])


def test_interrupt_at_once() -> None:
    threading.Timer(0.2, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        odeint(lambda y, t: [y[1], -1e8 * y[0]], [1.0, 0.0], [0, 1e6])
