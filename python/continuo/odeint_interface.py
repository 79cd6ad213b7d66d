"""The function odeint of SciPy."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any
from warnings import warn

import numpy as np
import numpy.typing as npt

from . import _continuo
from .options import begin_run, method_of

__all__ = ["ODEintWarning", "odeint"]

Array = npt.NDArray[Any]


class ODEintWarning(Warning):
    """A run of odeint has failed: what it returns is not all of the solution."""


_MESSAGES = {
    2: "Integration successful.",
    1: "Nothing was done; the integration time was 0.",
    -1: "Excess work done on this call (perhaps wrong Dfun type).",
    -2: "Excess accuracy requested (tolerances too small).",
    -3: "Illegal input detected (internal error).",
    -4: "Repeated error test failures (internal error).",
    -5: "Repeated convergence failures (perhaps bad Jacobian or tolerances).",
    -8: "Run terminated (internal error).",
}
_CODES = {"too many steps": -1, "stiff": -1, "nonlinear solve failed": -5, "invalid input": -3}
_OTHER = -4

# LSODA's tolerances where none are given.
_TOLERANCE = 1.49012e-8


def _right_hand_side(func: Any, args: tuple[Any, ...], tfirst: bool) -> Any:
    """func as a function of (t, y) alone."""
    if (tfirst and not args) or _continuo.is_native(func):
        return func
    if tfirst:
        return lambda t, y: func(t, y, *args)
    if not args:
        return lambda t, y: func(y, t)
    return lambda t, y: func(y, t, *args)


def _jacobian(
    dfun: Callable[..., Any], args: tuple[Any, ...], tfirst: bool, col_deriv: bool, shape: tuple[int, int]
) -> Callable[[float, Array], Array]:
    """Dfun as a function of (t, y) alone that gives a matrix of this shape, packed or not."""

    def jac(t: float, y: Array) -> Array:
        matrix = np.asarray(dfun(t, y, *args) if tfirst else dfun(y, t, *args), dtype=float)
        if matrix.size == 1 and shape == (1, 1):
            matrix = matrix.reshape(1, 1)
        if col_deriv:
            matrix = matrix.T
        if matrix.shape != shape and not (matrix.ndim == 2 and matrix.shape[0] > shape[0] and shape[0] != shape[1]):
            raise RuntimeError(
                f"The array returned by Dfun must have shape {shape[::-1] if col_deriv else shape}, and has "
                f"{matrix.T.shape if col_deriv else matrix.shape}.")
        return matrix

    return jac


def _state(y0: Any) -> Array:
    given = np.asarray(y0)
    if given.ndim > 1:
        raise ValueError("Initial condition y0 must be one-dimensional.")
    if given.dtype.kind == "c":
        raise TypeError("y0 is complex, which odeint cannot integrate: take solve_ivp or complex_ode")
    return np.array(given, dtype=float, ndmin=1)


def _times(t: Any) -> Array:
    times = np.array(t, dtype=float, order="C")
    if times.ndim > 1:
        raise ValueError("Output times t must be one-dimensional.")
    times = np.atleast_1d(times)
    if not np.isfinite(times).all():
        raise ValueError("The values in t must be finite.")
    steps = np.diff(times)
    if not ((steps >= 0).all() or (steps <= 0).all()):
        raise ValueError(
            "The values in t must be monotonically increasing or monotonically decreasing; repeated values are allowed.")
    return times


def _raise(error: BaseException) -> None:
    """Errors of what func returned are of SciPy's types; its own exceptions pass through."""
    if error.__traceback__ is None and isinstance(error, TypeError):
        raise ValueError(str(error).replace("fun gave", "func gave")) from None
    if error.__traceback__ is None and isinstance(error, ValueError):
        raise RuntimeError(str(error).replace("fun gave", "func gave")) from None
    raise error


class _Parts:
    """The solution part by part, between critical times, each by a run of its own."""

    def __init__(self, times: Array, y0: Array, begin: Callable[..., _continuo.Run], most_steps: int) -> None:
        self.states: Array = np.zeros((len(times), len(y0)))
        self.states[:1] = y0
        self.costs = {name: np.zeros(max(len(times) - 1, 0), float if name in ("hu", "tcur") else np.int32)
                      for name in ("hu", "tcur", "nst", "nfe", "nje")}
        self.code = 2
        self.outcome = ""
        self._begin, self._most_steps = begin, most_steps
        self._y = y0
        self._before = {"nst": 0, "nfe": 0, "nje": 0}

    def add(self, first: int, times: Array, end: float) -> bool:
        """Run from times[0] to `end`; the other times are those from number `first` on. False where it fails."""
        inner = np.append(times, end)
        run = self._begin(float(times[0]), end, self._y)
        states, costs, reached, why = _continuo.through_times(run, inner, self._most_steps)
        error = run.take_error()
        if error is not None:
            _raise(error)
        count = min(reached, len(times)) - 1
        self.states[first : first + count] = states[1 : 1 + count]
        for name, all_numbers in self.costs.items():
            all_numbers[first - 1 : first - 1 + count] = costs[name][:count] + self._before.get(name, 0)
        for name in self._before:
            if len(costs[name]):
                self._before[name] += int(costs[name][-1])
        if why != 0:
            _, _, outcome, *_, ending, _, _ = run.summary()
            self.code = -1 if why == 2 else _CODES.get(ending, _OTHER)
            self.outcome = f"at t = {run.t:.8g}" if why == 2 else outcome
            return False
        self._y = states[-1]
        return True


def _through_parts(parts: _Parts, times: Array, critical: Array) -> None:
    """From each critical time within to the next one, and at last to the end."""
    forward = 1.0 if times[-1] >= times[0] else -1.0
    within = np.unique(critical[(forward * (critical - times[0]) > 0) & (forward * (times[-1] - critical) > 0)])
    start = float(times[0])
    done = 1
    for end in [*(within if forward > 0 else within[::-1]), times[-1]]:
        last = int(np.searchsorted(forward * times, forward * end, side="right"))
        if not parts.add(done, np.append(start, times[done:last]), float(end)):
            return
        start, done = float(end), last


def _infodict(parts: _Parts, times: Array, n: int, method: str) -> dict[str, Any]:
    count = max(len(times) - 1, 0)
    implicit = parts.costs["nje"] > 0
    return {
        **parts.costs,
        "tolsf": np.zeros(count),
        "tsw": np.zeros(count),
        "nqu": np.zeros(count, np.int32),
        "imxer": -1,
        "lenrw": 0,
        "leniw": 0,
        "mused": np.where(implicit, 2, 1).astype(np.int32),
        "method": method,
        "message": _MESSAGES[parts.code],
    }


def odeint(
    func: Any,
    y0: npt.ArrayLike,
    t: npt.ArrayLike,
    args: Any = (),
    Dfun: Callable[..., Any] | None = None,
    col_deriv: int | bool = 0,
    full_output: int | bool = 0,
    ml: int | None = None,
    mu: int | None = None,
    rtol: npt.ArrayLike | None = None,
    atol: npt.ArrayLike | None = None,
    tcrit: npt.ArrayLike | None = None,
    h0: float = 0.0,
    hmax: float = 0.0,
    hmin: float = 0.0,
    ixpr: int | bool = 0,
    mxstep: int = 0,
    mxhnil: int = 0,
    mxordn: int = 12,
    mxords: int = 5,
    printmessg: int | bool = 0,
    tfirst: bool = False,
) -> Any:
    """Integrate dy/dt = func(y, t, ...) to given times, as `scipy.integrate.odeint` does.

    The method is chosen by the problem and switches to a stiff one where needed, as LSODA does.

    Parameters
    ----------
    func : callable or compiled function
        ``func(y, t, *args)``, or ``func(t, y, *args)`` with ``tfirst=True``, gives dy/dt, shape (n,). Or a
        compiled function as `solve_ivp` takes, whose time comes first.
    y0 : array_like, shape (n,), or a number
        The state at t[0].
    t : array_like, shape (m,)
        The times of the result, in one direction; they may repeat.
    args : tuple, optional
        Further arguments of func and Dfun.
    Dfun : callable, optional
        ``Dfun(y, t, *args)`` gives df/dy, shape (n, n): df_i/dy_j in row i, in column i with `col_deriv`. With
        `ml` or `mu` packed, shape (ml + mu + 1, n).
    col_deriv : bool, optional
        Whether Dfun gives the transposed matrix.
    full_output : bool, optional
        Whether the dictionary is returned as well.
    ml, mu : int, optional
        The Jacobian has so many diagonals below and above its main one.
    rtol, atol : float or array_like, shape (n,), optional
        Tolerances, 1.49012e-8 where not given.
    tcrit : array_like, optional
        Times at which func may jump: steps end there.
    h0, hmax, hmin : float, optional
        The first, the longest and the shortest step; 0: by the solver.
    mxstep : int, optional
        The most steps between two times; 0: as many as needed. (SciPy's 0 means 500.)
    ixpr, mxhnil, mxordn, mxords : int, optional
        Of LSODA's inner workings; without effect.
    printmessg : bool, optional
        Whether a successful end is a warning as well.
    tfirst : bool, optional
        Whether the time is the first argument of func and Dfun.

    Returns
    -------
    y : ndarray, shape (m, n)
        The states. Where the run fails, which is an ODEintWarning, the rows it has not reached are zero.
    infodict : dict
        With ``full_output``: 'hu' (last step), 'tcur' (time reached), 'nst', 'nfe', 'nje' (steps, evaluations
        of func and Dfun so far) for each time but the first, 'mused' (1 explicit, 2 implicit as far as Jacobians tell),
        'message', 'method'. 'tolsf', 'tsw', 'nqu', 'imxer', 'lenrw', 'leniw' belong to LSODA and tell nothing here.

    Raises
    ------
    ValueError
        Times in no order, a state of more than one dimension, or func gave what is no number.
    RuntimeError
        func or Dfun gave an array of a wrong shape.
    """
    arguments = args if isinstance(args, tuple) else (args,)
    times, y = _times(t), _state(y0)
    n = len(y)
    options: dict[str, Any] = {
        "rtol": _TOLERANCE if rtol is None else rtol, "atol": _TOLERANCE if atol is None else atol}
    for name, value in (("first_step", h0), ("max_step", hmax), ("min_step", hmin)):
        if value:
            options[name] = value
    banded = ml is not None or mu is not None
    if banded:
        options.update(lband=ml or 0, uband=mu or 0)
    if Dfun is not None:
        shape = (int(ml or 0) + int(mu or 0) + 1, n) if banded else (n, n)
        options["jac"] = _jacobian(Dfun, arguments, tfirst, bool(col_deriv), shape)
    method = method_of(None)
    fun = _right_hand_side(func, arguments, tfirst)

    def begin(start: float, end: float, state: Array, wanted: Array | None = None) -> _continuo.Run:
        here = options
        if "first_step" in options:
            here = {**options, "first_step": min(float(h0), abs(end - start))}
        return begin_run(fun, start, end, state, method, here, times=wanted)

    if len(times) < 2 or times[0] == times[-1] or n == 0:
        parts = _Parts(times, y, begin, 0)
        parts.states[:] = y
    elif full_output or mxstep or tcrit is not None:
        parts = _Parts(times, y, begin, int(mxstep) or 10**9)
        _through_parts(parts, times, np.atleast_1d(np.asarray([] if tcrit is None else tcrit, dtype=float)))
    else:
        parts = _all_at_once(begin, times, y)
    if parts.code < 0:
        warn(f"{_MESSAGES[parts.code]} Run with full_output = 1 to get quantitative information. ({parts.outcome})",
             ODEintWarning, stacklevel=2)
    elif printmessg:
        warn(_MESSAGES[parts.code], ODEintWarning, stacklevel=2)
    return (parts.states, _infodict(parts, times, n, "auto")) if full_output else parts.states


def _all_at_once(begin: Callable[..., _continuo.Run], times: Array, y: Array) -> _Parts:
    """One run whose record has the states at the times."""
    parts = _Parts(times, y, begin, 0)
    moves = times[1:] != times[:-1]
    repeats = not moves.all()
    distinct = times[np.concatenate(([True], moves))] if repeats else times
    run = begin(float(times[0]), float(times[-1]), y, distinct)
    error = run.run()
    if error is not None:
        _raise(error)
    found = run.states().T
    status, _, outcome, *_, ending, _, _ = run.summary()
    if status < 0:
        parts.code, parts.outcome = _CODES.get(ending, _OTHER), outcome
    if not repeats:
        parts.states[: len(found)] = found
        return parts
    places = np.concatenate(([0], np.cumsum(moves)))
    reached = places < len(found)
    parts.states[reached] = found[places[reached]]
    return parts
