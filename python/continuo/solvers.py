"""The solver classes of SciPy: a run that is advanced step by step."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from .dense import ConstantDenseOutput, DenseOutput, StepDenseOutput
from .options import begin_run, method_of, state_of, warn_extraneous

Array = npt.NDArray[Any]


class OdeSolver:
    """A run by one method, step by step.

    Parameters
    ----------
    fun, t0, y0, t_bound, vectorized
        As in `solve_ivp`; the run goes from t0 to t_bound, which may be infinite.
    args : tuple, optional
        Further arguments of `fun` and `jac`.
    **options
        Those of `solve_ivp`.

    Attributes
    ----------
    n : int
        The number of components.
    status : str
        'running', 'finished' or 'failed'.
    t_bound, direction : float
        The end, and +1 or -1.
    t, t_old : float
        The present time, and that before the last step; `t_old` is None before the first.
    y : ndarray, shape (n,)
        The present state.
    step_size : float
        The size of the last step; None before the first.
    nfev, njev, nlu : int
        As in the result of `solve_ivp`.
    """

    TOO_SMALL_STEP = "Required step size is less than spacing between numbers."
    _method: str | None = None
    _checks_at_start = True

    def __init__(
        self,
        fun: Any,
        t0: float,
        y0: npt.ArrayLike,
        t_bound: float,
        max_step: float = np.inf,
        rtol: npt.ArrayLike = 1e-3,
        atol: npt.ArrayLike = 1e-6,
        vectorized: bool = False,
        first_step: float | None = None,
        method: Any = None,
        args: tuple[Any, ...] | None = None,
        **options: Any,
    ) -> None:
        chosen = method_of(self._method if self._method is not None else method)
        if not chosen.options.issuperset(options):
            warn_extraneous(options, chosen)
        options.update(max_step=max_step, rtol=rtol, atol=atol, first_step=first_step)
        self._arguments = (fun, t_bound, vectorized, method, args, options)
        self.t_old: float | None = None
        self.t = t0
        self.t_bound = t_bound
        self.vectorized = vectorized
        self.direction = float(np.sign(t_bound - t0)) if t_bound != t0 else 1
        self.status = "running"
        y = state_of(y0)
        self.n = len(y)
        self._run = begin_run(fun, t0, t_bound, y, chosen, options, vectorized=vectorized, args=args)
        self.y: Array = self._run.y if self.n else y
        self._earlier = (0, 0, 0)
        if self._checks_at_start:
            self._run.check()
            self._raise_error()

    def _raise_error(self) -> None:
        error = self._run.take_error()
        if error is not None:
            self.status = "failed"
            raise error

    def _cost(self, which: int) -> int:
        return int(self._run.summary()[3 + which]) + self._earlier[which]

    @property
    def nfev(self) -> int:
        """Evaluations of the right-hand side."""
        return self._cost(0)

    @property
    def njev(self) -> int:
        """Evaluations of the Jacobian."""
        return self._cost(1)

    @property
    def nlu(self) -> int:
        """LU decompositions."""
        return self._cost(2)

    @property
    def step_size(self) -> float | None:
        """The size of the last step."""
        return None if self.t_old is None else abs(self.t - self.t_old)

    def step(self) -> str | None:
        """Take one step.

        Returns
        -------
        str or None
            Why the run has failed; None where it has not.

        Raises
        ------
        RuntimeError
            Where the run is finished or has failed already.
        """
        if self.status != "running":
            raise RuntimeError("Attempt to step on a failed or finished solver.")
        if self.n == 0 or self.t == self.t_bound:
            self.t_old, self.t = self.t, self.t_bound
            self.status = "finished"
            return None
        t_old = self.t
        goes_on = self._run.step()
        self._raise_error()
        if not goes_on:
            status, message, outcome, *_, ending, _, _ = self._run.summary()
            if ending == "invalid input":
                self.status = "failed"
                raise ValueError(outcome)
            if status < 0:
                self.status = "failed"
                return str(message)
            self.status = "finished"
        self.t_old, self.t, self.y = t_old, self._run.t, self._run.y
        return None

    def dense_output(self) -> DenseOutput:
        """Give the solution over the last step.

        Raises
        ------
        RuntimeError
            Before the first step.
        """
        if self.t_old is None:
            raise RuntimeError("Dense output is available after a successful step was made.")
        if self.n == 0 or self.t == self.t_old:
            return ConstantDenseOutput(self.t_old, self.t, self.y)
        return StepDenseOutput(self.t_old, self.t, self._run.last_piece(self.t_old))

    def __getstate__(self) -> dict[str, Any]:
        state = self.__dict__.copy()
        del state["_run"]
        state["_earlier"] = tuple(self._cost(which) for which in range(3))
        return state

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Begin anew where the pickled run was: with its step size, without the history of a multistep method."""
        self.__dict__.update(state)
        fun, t_bound, vectorized, method, args, options = self._arguments
        options = dict(options)
        if self.step_size and self.status == "running":
            options["first_step"] = min(self.step_size, abs(t_bound - self.t))
        chosen = method_of(self._method if self._method is not None else method)
        self._run = begin_run(fun, self.t, t_bound, self.y, chosen, options, vectorized=vectorized, args=args)


class RK23(OdeSolver):
    """The method of Bogacki and Shampine of order 3."""

    _method = "RK23"


class RK45(OdeSolver):
    """The method of Dormand and Prince of order 5."""

    _method = "RK45"


class DOP853(OdeSolver):
    """The method of Dormand and Prince of order 8."""

    _method = "DOP853"


class Radau(OdeSolver):
    """The implicit method Radau IIA of order 5."""

    _method = "Radau"


class BDF(OdeSolver):
    """Backward differentiation formulae of orders 1 to 5."""

    _method = "BDF"


class LSODA(OdeSolver):
    """An explicit method of order 5 that switches to BDF where the system is stiff."""

    _method = "LSODA"
    _checks_at_start = False
