"""Continuo simulates continuous systems: SciPy's interface to its integrators, models as text, and rigid bodies."""

from ._continuo import __version__
from .dense import DenseOutput, OdeSolution
from .errors import Interrupted
from .events import Event
from .ivp import solve_ivp
from .result import OdeResult
from .solvers import BDF, DOP853, LSODA, RK23, RK45, OdeSolver, Radau

__all__ = [
    "BDF",
    "DOP853",
    "DenseOutput",
    "Event",
    "Interrupted",
    "LSODA",
    "OdeResult",
    "OdeSolution",
    "OdeSolver",
    "RK23",
    "RK45",
    "Radau",
    "__version__",
    "solve_ivp",
]
