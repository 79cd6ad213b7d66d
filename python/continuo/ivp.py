"""solve_ivp with SciPy's signature and results."""

from __future__ import annotations

from typing import Any, Callable, NoReturn

import numpy as np
import numpy.typing as npt

from . import _continuo
from .dense import OdeSolution
from .errors import Interrupted
from .options import PatternGrew, method_of, numbers, run_settings, state_of, warn_extraneous
from .result import OdeResult

Array = npt.NDArray[Any]


def _interval(t_span: Any) -> tuple[float, float]:
    try:
        t0, t1 = t_span
        return float(t0), float(t1)
    except (TypeError, ValueError) as error:
        raise type(error)(f"`t_span` must be two numbers, the beginning and the end, and is {t_span!r}") from None


def _times(t_eval: Any, t0: float, t1: float) -> Array:
    times = numbers("t_eval", t_eval)
    if times.ndim != 1:
        raise ValueError("`t_eval` must be 1-dimensional.")
    if np.any(times < min(t0, t1)) or np.any(times > max(t0, t1)) or np.any(np.isnan(times)):
        raise ValueError("Values in `t_eval` are not within `t_span`.")
    differences = np.diff(times)
    if (t1 > t0 and np.any(differences <= 0)) or (t1 < t0 and np.any(differences >= 0)):
        raise ValueError("Values in `t_eval` are not properly sorted.")
    return times


def _result(ended: tuple[Any, ...], dense: bool, with_events: bool) -> OdeResult:
    """Give what `_continuo.run_to_end` has computed."""
    run, _, (status, message, outcome, nfev, njev, nlu, ending, _, _), times, states = ended
    if ending == "invalid input":
        raise ValueError(outcome)
    result = OdeResult(
        t=times,
        y=states,
        sol=OdeSolution._of(run.dense()) if dense else None,
        t_events=None,
        y_events=None,
        nfev=nfev,
        njev=njev,
        nlu=nlu,
        status=status,
        message=message,
        success=status >= 0,
        outcome=outcome,
    )
    if with_events:
        found = run.events()
        result["t_events"] = [t for t, _, _ in found]
        # SciPy gives an array of shape (0,) where there was no event.
        result["y_events"] = [before if len(t) else np.array([]) for t, before, _ in found]
        if any(not np.array_equal(before, after) for _, before, after in found):
            result["y_after_events"] = [after if len(t) else np.array([]) for t, _, after in found]
    return result


def _raise(ended: tuple[Any, ...], dense: bool, with_events: bool) -> NoReturn:
    run, error, *_ = ended
    result = _result(ended, dense, with_events)
    result.update(status=-1, success=False)
    if isinstance(error, KeyboardInterrupt):
        result["message"] = result["outcome"] = f"interrupted at t = {run.t:.6g}"
        raise Interrupted(result["message"], result) from error
    result["message"] = result["outcome"] = f"{type(error).__name__} at t = {run.t:.6g}: {error}"
    try:
        error.result = result  # an attribute that is not declared
    except AttributeError:
        pass  # an exception with slots
    raise error


def _unpacked(args: Any) -> tuple[Any, ...]:
    try:
        return (*args,)
    except TypeError as error:
        raise TypeError(
            f"Supplied 'args' cannot be unpacked. Please supply `args` as a tuple (e.g. `args=({args},)`)"
        ) from error


def _run_with_pattern(
    grown: PatternGrew, run: Callable[[tuple[Array, Array]], tuple[Any, ...]]
) -> tuple[Any, ...]:
    """Run once more from the beginning, with the entries that a sparse Jacobian turned out to have, until it has all."""
    rows, columns = grown.places
    while True:
        ended = run((rows, columns))
        if not isinstance(ended[1], PatternGrew):
            return ended
        rows = np.concatenate([rows, ended[1].places[0]])
        columns = np.concatenate([columns, ended[1].places[1]])


def solve_ivp(
    fun: Any,
    t_span: Any,
    y0: npt.ArrayLike,
    method: Any = "RK45",
    t_eval: npt.ArrayLike | None = None,
    dense_output: bool = False,
    events: Any = None,
    vectorized: bool = False,
    args: Any = None,
    **options: Any,
) -> OdeResult:
    """Solve an initial value problem, dy/dt = fun(t, y), y(t0) = y0.

    The signature, the options, the result and the messages are those of ``scipy.integrate.solve_ivp``.

    Parameters
    ----------
    fun : callable or compiled function
        ``fun(t, y, *args)`` gives dy/dt, shape (n,), as an array, a list or a tuple. Or a function that is compiled and
        runs without the interpreter: a cfunc of numba, a ``scipy.LowLevelCallable``, a ctypes function of signature
        ``void (double t, double *y, double *dydt, void *user)``, with or without `user`, or an object with a method
        ``__continuo_native__``.
    t_span : 2-tuple of float
        The times of the beginning and of the end; backwards where the second is the smaller one.
    y0 : array_like, shape (n,)
        The initial state; complex for a complex solution.
    method : str, class or None, default 'RK45'
        'RK23', 'RK45', 'DOP853', 'Radau', 'BDF', 'LSODA', any of continuo's own methods by its name, or a solver class.
        None, 'auto' and 'LSODA' choose by the problem a method that switches to a stiff one where needed.
    t_eval : array_like, optional
        The times at which the solution is kept; otherwise every step.
    dense_output : bool, default False
        Whether the result has the solution as a function, `sol`.
    events : callable, Event, or list of them, optional
        Functions ``event(t, y, *args)`` whose zeros are located, with the attributes `terminal` and `direction` of
        SciPy; or `continuo.Event`, whose action may change the state.
    vectorized : bool, default False
        Whether `fun` takes states as columns, shape (n, 1).
    args : tuple, optional
        Further arguments of `fun`, `jac` and `events`.
    **options
        first_step, max_step : float
            The first and the longest step.
        rtol, atol : float or array_like, default 1e-3, 1e-6
            The error of a step stays below ``atol + rtol * abs(y)``.
        jac : array_like, sparse matrix, callable
            The Jacobian df/dy for implicit methods, constant or as ``jac(t, y, *args)``. By differences if missing.
        jac_sparsity : array_like or sparse matrix
            Where df/dy may differ from zero.
        lband, uband, min_step
            As in SciPy's LSODA.
        mass : array_like, shape (n, n) or (n,)
            M of ``M dy/dt = fun(t, y)``, which may be singular (differential-algebraic equations of index 1), for
            implicit methods and for ``method=None``. Of a diagonal M the algebraic components of y0 are solved for.
        second_order : bool
            ``fun(t, x, *args)`` gets the positions and gives the accelerations of ``x'' = a(t, x)``; `y0` and the result
            are positions, then velocities.
        pairs : list of (int, int)
            Which components of `y` are a position and its velocity, for methods that need it.
        step : float
            Steps of this size, for methods without an error estimate.
        max_steps : int
            The run fails after as many steps.
        state : {'auto', 'array', 'list'}
            In what form a Python `fun` gets the state. 'auto' hands over a sequence that has all of an array but is
            cheaper, where there are few components, and an array where `fun` computes with arrays. A call that fails
            with the sequence is tried once with an array.
        progress : True or callable
            A bar on stderr, or ``progress(t, part)``, called ten times a second.
        names : list of str
            Of the components, in messages.

    Returns
    -------
    OdeResult
        With t, y, sol, t_events, y_events, nfev, njev, nlu, status, message, success, outcome.

    Raises
    ------
    ValueError, TypeError
        For what cannot be meant, and for a result of a callback of the wrong shape or type.
    Interrupted
        After Ctrl-C; its `result` has what was computed.
    Exception
        What a callback raises, with `result` as an attribute.
    """
    t0, t1 = _interval(t_span)
    chosen = method_of(method)
    if options and not chosen.options.issuperset(options):
        warn_extraneous(options, chosen)
    y = state_of(y0)
    if args is not None:
        args = _unpacked(args)
    times = None if t_eval is None else _times(t_eval, t0, t1)
    settings = (fun, t0, t1, y, chosen, options, times, dense_output, events, vectorized, args)
    ended: tuple[Any, ...] = _continuo.run_to_end(*run_settings(*settings))
    if ended[1] is not None:
        if isinstance(ended[1], PatternGrew):
            ended = _run_with_pattern(
                ended[1], lambda places: _continuo.run_to_end(*run_settings(*settings, places))
            )
        if ended[1] is not None:
            _raise(ended, dense_output, events is not None)
    return _result(ended, dense_output, events is not None)
