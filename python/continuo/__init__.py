"""Continuo simulates continuous systems: SciPy's interface to its integrators, models as text, and rigid bodies."""

from ._continuo import __version__
from .boundary_values import BVPResult, CubicSolution, solve_bvp
from .dense import DenseOutput, OdeSolution
from .errors import CommandError, ContinuoError, Interrupted, ModelError, ModelWarning, RunError
from .events import Event
from .expressions import TraceError, maximum, minimum, where
from .ivp import solve_ivp
from .joints import Joint, Limits, Motor, Spring
from .magic import load_ipython_extension, unload_ipython_extension
from .model import Model
from .ode_interface import complex_ode, ode
from .odeint_interface import ODEintWarning, odeint
from .result import OdeResult
from .right_hand_side import RightHandSide, expression
from .shapes import Box, Capsule, Chain, Compound, HeightField, Hull, Part, Sphere, TriangleMesh
from .solvers import BDF, DOP853, LSODA, OdeSolver, RK23, RK45, Radau
from .tracing import Traced, trace
from .vehicles import Vehicle, Wheel
from .world import Character, World

__all__ = [
    "BDF",
    "BVPResult",
    "Box",
    "Capsule",
    "Chain",
    "Character",
    "CommandError",
    "Compound",
    "ContinuoError",
    "CubicSolution",
    "DOP853",
    "DenseOutput",
    "Event",
    "HeightField",
    "Hull",
    "Interrupted",
    "Joint",
    "LSODA",
    "Limits",
    "Model",
    "ModelError",
    "ModelWarning",
    "Motor",
    "ODEintWarning",
    "OdeResult",
    "OdeSolution",
    "OdeSolver",
    "Part",
    "RK23",
    "RK45",
    "Radau",
    "RightHandSide",
    "RunError",
    "Sphere",
    "Spring",
    "TraceError",
    "Traced",
    "TriangleMesh",
    "Vehicle",
    "Wheel",
    "World",
    "__version__",
    "complex_ode",
    "expression",
    "load_ipython_extension",
    "maximum",
    "minimum",
    "ode",
    "odeint",
    "solve_bvp",
    "solve_ivp",
    "trace",
    "unload_ipython_extension",
    "where",
]
