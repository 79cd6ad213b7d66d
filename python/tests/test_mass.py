"""Mass matrices: M y' = f(t, y), with M regular or of a differential-algebraic system of index 1."""

from typing import Any

import numpy as np
import pytest

from continuo import solve_ivp

linalg = pytest.importorskip("scipy.linalg")

METHODS = ["Radau", "BDF", "LSODA", "rodas5p", "radau", None]


def _robertson(t: float, y: Any) -> list[float]:
    return [
        -0.04 * y[0] + 1e4 * y[1] * y[2],
        0.04 * y[0] - 1e4 * y[1] * y[2] - 3e7 * y[1] ** 2,
        y[0] + y[1] + y[2] - 1,
    ]


@pytest.mark.parametrize("method", METHODS)
def test_robertson_as_algebraic_system(method: str | None) -> None:
    # At t = 40, from the reference solutions of E. Hairer's and of the CVODE examples.
    reference = [7.158270687193941e-01, 9.185534764557338e-06, 2.841637457458413e-01]
    for mass in ([1, 1, 0], np.diag([1.0, 1.0, 0.0])):
        result = solve_ivp(_robertson, (0, 40), [1, 0, 0], method=method, mass=mass, rtol=1e-8, atol=1e-12)
        assert result.success
        assert np.abs(result.y[:, -1] / reference - 1).max() < 1e-6
        assert np.abs(result.y.sum(axis=0) - 1).max() < 1e-12


def test_the_unknown_of_y0_is_solved_for() -> None:
    result = solve_ivp(_robertson, (0, 1), [0.7, 0.0, 5.0], method="Radau", mass=[1, 1, 0])
    assert abs(result.y[2, 0] - 0.3) < 1e-12


@pytest.mark.parametrize("method", ["Radau", "BDF", "radau", "rodas5p", None])
def test_full_matrices(method: str | None) -> None:
    random = np.random.default_rng(4)
    for _ in range(3):
        mass = random.normal(size=(3, 3)) + 4 * np.eye(3)
        matrix = random.normal(size=(3, 3))
        y0 = random.normal(size=3)
        result = solve_ivp(lambda t, y: matrix @ y, (0, 2), y0, method=method, mass=mass, rtol=1e-8, atol=1e-10)
        exact = linalg.expm(np.linalg.solve(mass, matrix) * 2) @ y0
        assert np.abs(result.y[:, -1] - exact).max() < 1e-5


def test_a_singular_full_matrix() -> None:
    # (x + z)' = -x, 0 = z - 2 x: x' = -x / 3.
    mass = np.array([[1.0, 1.0], [0.0, 0.0]])
    for method in ("Radau", "BDF", "rodas5p"):
        result = solve_ivp(
            lambda t, y: [-y[0], y[1] - 2 * y[0]], (0, 3), [1.0, 2.0], method=method, mass=mass, rtol=1e-8, atol=1e-10
        )
        assert result.success
        assert np.abs(result.y[:, -1] - np.exp(-1) * np.array([1, 2])).max() < 1e-5


def test_regular_diagonals_of_complex_states() -> None:
    result = solve_ivp(
        lambda t, y: -y, (0, 1), [1 + 1j, 2.0], method="Radau", mass=[2.0, 4.0], rtol=1e-8, atol=1e-10
    )
    assert np.abs(result.y[:, -1] - [(1 + 1j) * np.exp(-0.5), 2 * np.exp(-0.25)]).max() < 1e-6


def test_wrong_masses() -> None:
    with pytest.raises(ValueError, match="implicit method"):
        solve_ivp(_robertson, (0, 1), [1, 0, 0], mass=[1, 1, 0])
    with pytest.raises(ValueError, match="full matrix"):
        solve_ivp(_robertson, (0, 1), [1, 0, 0], method="kvaerno5", mass=np.ones((3, 3)))
    with pytest.raises(ValueError, match="shape"):
        solve_ivp(_robertson, (0, 1), [1, 0, 0], method="BDF", mass=[1, 1])
    with pytest.raises(ValueError, match="finite"):
        solve_ivp(_robertson, (0, 1), [1, 0, 0], method="BDF", mass=[1, 1, np.nan])
