"""Continuo simulates continuous systems: SciPy's interface to its integrators, models as text, and rigid bodies."""

from ._continuo import __version__
from .boundary_values import BVPResult, CubicSolution, solve_bvp
from .dense import DenseOutput, OdeSolution
from .errors import Interrupted
from .events import Event
from .ivp import solve_ivp
from .result import OdeResult
from .solvers import BDF, DOP853, LSODA, OdeSolver, RK23, RK45, Radau

__all__ = [
    "BDF",
    "BVPResult",
    "CubicSolution",
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
    "solve_bvp",
    "solve_ivp",
from .errors import CommandError, ContinuoError, Interrupted, ModelError, ModelWarning, RunError
from .magic import load_ipython_extension, unload_ipython_extension
from .model import Model

__all__ = [
    "CommandError",
    "ContinuoError",
    "Interrupted",
    "Model",
    "ModelError",
    "ModelWarning",
    "RunError",
    "__version__",
    "load_ipython_extension",
    "unload_ipython_extension",
from .expressions import TraceError, maximum, minimum, where
from .right_hand_side import RightHandSide, expression
from .tracing import Traced, trace

__all__ = [
    "RightHandSide",
    "TraceError",
    "Traced",
    "__version__",
    "expression",
    "maximum",
    "minimum",
    "trace",
    "where",
]
