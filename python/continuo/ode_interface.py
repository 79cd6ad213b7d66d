"""The classes ode and complex_ode of SciPy: a run that is continued from one time to the next."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple, TypeVar
from warnings import warn

import numpy as np
import numpy.typing as npt

from . import _continuo
from .options import Method, begin_run, method_of, whole_matrix

Array = npt.NDArray[Any]
Own = TypeVar("Own", bound="ode")

_VODE_MESSAGES = {
    2: "Integration successful.",
    -1: "Excess work done on this call. (Perhaps wrong MF.)",
    -2: "Excess accuracy requested. (Tolerances too small.)",
    -3: "Illegal input detected. (See printed message.)",
    -4: "Repeated error test failures. (Check all input.)",
    -5: "Repeated convergence failures. (Perhaps bad Jacobian supplied or wrong choice of MF or tolerances.)",
    -6: "Error weight became zero during problem. (Solution component i vanished, and ATOL or ATOL(i) = 0.)",
}
_DOP_MESSAGES = {
    1: "computation successful",
    2: "computation successful (interrupted by solout)",
    -1: "input is not consistent",
    -2: "larger nsteps is needed",
    -3: "step size becomes too small",
    -4: "problem is probably stiff (interrupted)",
}
# The endings of a run as return codes: of vode, zvode, lsoda, then of dopri5, dop853.
_CODES = {
    "too many steps": (-1, -2),
    "step too small": (-4, -3),
    "too many rejects": (-4, -3),
    "nonlinear solve failed": (-5, -3),
    "stiff": (-1, -4),
    "invalid input": (-3, -1),
}
_OTHER = (-4, -3)

_VODE_OPTIONS: dict[str, Any] = {
    "method": "adams", "with_jacobian": False, "rtol": 1e-6, "atol": 1e-12, "lband": None, "uband": None, "order": 12,
    "nsteps": 500, "max_step": 0.0, "min_step": 0.0, "first_step": 0.0}
_LSODA_OPTIONS: dict[str, Any] = {
    "method": None, "with_jacobian": False, "rtol": 1e-6, "atol": 1e-12, "lband": None, "uband": None, "nsteps": 500,
    "max_step": 0.0, "min_step": 0.0, "first_step": 0.0, "ixpr": 0, "max_hnil": 0, "max_order_ns": 12,
    "max_order_s": 5}
_DOP_OPTIONS: dict[str, Any] = {
    "method": None, "rtol": 1e-6, "atol": 1e-12, "nsteps": 500, "max_step": 0.0, "first_step": 0.0, "safety": 0.9,
    "ifactor": 10.0, "dfactor": 0.2, "beta": 0.0, "verbosity": -1}
_DOP853_OPTIONS: dict[str, Any] = {**_DOP_OPTIONS, "ifactor": 6.0, "dfactor": 0.3}

_SCIPY_OPTIONS = {"vode": _VODE_OPTIONS, "zvode": _VODE_OPTIONS, "lsoda": _LSODA_OPTIONS, "dopri5": _DOP_OPTIONS,
                  "dop853": _DOP853_OPTIONS}
_SCIPY_METHODS = {"lsoda": "auto", "dopri5": "RK45", "dop853": "DOP853"}
_WITHOUT_EFFECT = frozenset({"order", "safety", "ifactor", "dfactor", "beta", "ixpr", "max_order_ns", "max_order_s"})


class _Integrator(NamedTuple):
    """A method by one of SciPy's names or by one of ours, and its options in the words of solve_ivp."""

    name: str
    method: Method
    options: dict[str, Any]
    nsteps: int
    is_complex: bool
    is_dop: bool  # return codes, and what SciPy's integrator supports, are those of dopri5 and dop853
    stops_at_steps: bool
    takes_solout: bool


def _given(options: dict[str, Any]) -> dict[str, Any]:
    """Options of ode, where 0 means that there is none, as those of solve_ivp."""
    return {name: value for name, value in options.items()
            if value is not None and (value or name not in ("max_step", "min_step", "first_step"))}


def _scipy_integrator(name: str, given: dict[str, Any]) -> _Integrator:
    known = _SCIPY_OPTIONS[name]
    for option in given:
        if option not in known:
            raise TypeError(f"{name} has no option {option!r}; it has {', '.join(known)}")
    options = {**known, **given}
    idle = [option for option in given if option in _WITHOUT_EFFECT and given[option] != known[option]]
    if idle:
        warn("The following options have no effect: " + ", ".join(f"`{option}`" for option in idle) + ".",
             stacklevel=4)
    formula = _SCIPY_METHODS.get(name)
    if formula is None:
        words = str(options["method"]).lower()
        if words not in ("adams", "bdf"):
            raise ValueError(f"Unknown integration method {options['method']}")
        formula = "adams" if words == "adams" else "BDF"
    method = method_of(formula)
    is_dop = name in ("dopri5", "dop853")
    names = ["rtol", "atol", "max_step", "min_step", "first_step"]
    if "jac" in method.options:
        names += ["lband", "uband"]
    kept = _given({option: options[option] for option in names if option in options})
    return _Integrator(name, method, kept, int(options["nsteps"]), name == "zvode", is_dop, not is_dop, is_dop)


def _integrator(name: str, given: dict[str, Any]) -> _Integrator | None:
    """None where there is none of this name."""
    if not isinstance(name, str):
        raise TypeError(f"an integrator is taken by its name, such as 'dop853', and not by a {type(name).__name__}")
    scipy_name = name.lower() or "vode"
    if scipy_name in _SCIPY_OPTIONS:
        return _scipy_integrator(scipy_name, given)
    try:
        method = method_of(name)
    except ValueError:
        return None
    options = {"rtol": 1e-6, "atol": 1e-12, **given}
    nsteps = int(options.pop("nsteps", 10**9))
    for option in options:
        if option not in method.options:
            raise TypeError(f"{name} has no option {option!r}; it has nsteps, {', '.join(sorted(method.options))}")
    return _Integrator(name, method, _given(options), nsteps, False, False, True, True)


class ode:  # noqa: N801  # SciPy's name
    """A solution of y' = f(t, y) that is continued from one time to the next, with the interface of `scipy.integrate.ode`.

    Parameters
    ----------
    f : callable or compiled function
        ``f(t, y, *f_args)`` gives dy/dt, shape (n,), or a number where n is 1. Or whatever `solve_ivp` takes.
    jac : callable, optional
        ``jac(t, y, *jac_args)`` gives df/dy, shape (n, n), or packed, shape (lband + uband + 1, n), where
        `lband` and `uband` are set.

    Attributes
    ----------
    t : float
        The present time.
    y : ndarray, shape (n,)
        The present state.

    Notes
    -----
    The run is kept from call to call: it goes on from the step in which the last call has found its state.
    Each call first looks whether y, or f at (t, y), is still what it was at the end of the last one; if not, or
    after `set_f_params`, it begins anew from (t, y). So f is called twice a call for this alone.

    Examples
    --------
    >>> import continuo
    >>> r = continuo.ode(lambda t, y: [y[1], -y[0]]).set_integrator("dop853", rtol=1e-9)
    >>> r = r.set_initial_value([1.0, 0.0], 0.0)
    >>> while r.successful() and r.t < 3:
    ...     y = r.integrate(r.t + 0.5)
    >>> round(float(y[0]), 6)
    -0.989992
    """

    _is_complex = False

    def __init__(self, f: Any, jac: Callable[..., Any] | None = None) -> None:
        self.f = f
        self.jac = jac
        self.f_params: tuple[Any, ...] = ()
        self.jac_params: tuple[Any, ...] = ()
        self.t = 0.0
        self._y: Array = np.empty(0)
        self._solout: Callable[..., Any] | None = None
        self._set: _Integrator | None = None
        self._code = 1
        self._success = True
        self._forget()

    def _forget(self) -> None:
        """The next call begins a run anew, from (t, y)."""
        self._run: _continuo.Run | None = None
        self._continued: _continuo.ContinuedRun | None = None
        self._lands = False

    @property
    def y(self) -> Array:
        """The present state, shape (n,)."""
        return self._y

    def _integrator(self) -> _Integrator:
        if self._set is None:
            self.set_integrator("")
        assert self._set is not None
        return self._set

    def _as_state(self, y: npt.ArrayLike) -> Array:
        is_complex = self._is_complex or self._integrator().is_complex
        given = np.asarray(y)
        if given.dtype.kind == "c" and not is_complex:
            raise TypeError("`y` is complex: take complex_ode, or the integrator 'zvode'")
        state: Array = np.array(given, dtype=complex if is_complex else float, ndmin=1)
        if state.ndim != 1:
            raise ValueError("`y` must be 1-dimensional.")
        return state

    def set_initial_value(self: Own, y: npt.ArrayLike, t: float = 0.0) -> Own:
        """Set y(t) = y.

        Parameters
        ----------
        y : array_like, shape (n,), or a number
            The state.
        t : float, optional
            Its time.
        """
        self._y = self._as_state(y)
        if not isinstance(t, (int, float, np.number)) and np.ndim(t) == 0:
            raise TypeError(f"the time of the initial value must be a number, and is {t!r}")
        self.t = t
        self._reset()
        return self

    def _reset(self) -> None:
        self._success = True
        self._code = 1
        self._forget()

    def set_integrator(self: Own, name: str, **integrator_params: Any) -> Own:
        """Set the method.

        Parameters
        ----------
        name : str
            'vode', 'zvode', 'lsoda', 'dopri5', 'dop853' with SciPy's options, or a method of `solve_ivp` by its
            name, with the options of `solve_ivp` and `nsteps`.
        **integrator_params
            The options. Those that belong to the inner workings of SciPy's codes alone are accepted and have
            no effect, of which a warning tells: order, safety, ifactor, dfactor, beta, ixpr, max_order_ns,
            max_order_s.
        """
        found = _integrator(name, integrator_params)
        if found is None:
            warn(f"No integrator name match with {name!r} or is not available.", stacklevel=2)
            return self
        self._set = found
        if len(self._y) == 0:
            self.t, self._y = 0.0, self._as_state([0.0])
        elif (self._y.dtype.kind == "c") != (self._is_complex or found.is_complex):
            self._y = self._as_state(self._y)
        self._reset()
        return self

    def set_f_params(self: Own, *args: Any) -> Own:
        """Set the further arguments of f."""
        self.f_params = args
        return self

    def set_jac_params(self: Own, *args: Any) -> Own:
        """Set the further arguments of jac."""
        self.jac_params = args
        return self

    def set_solout(self, solout: Callable[..., Any] | None) -> None:
        """Set a function to be called after every step.

        Parameters
        ----------
        solout : callable
            ``solout(t, y)`` is called at the beginning of each `integrate` and after each step of the method,
            and returns -1 to end the call there; otherwise None or 0.
        """
        if not self._integrator().takes_solout:
            raise ValueError("selected integrator does not support solout, choose another one")
        self._solout = solout
        self._reset()

    def successful(self) -> bool:
        """Tell whether no call of `integrate` has failed since the initial value was set."""
        self._integrator()
        return self._success

    def get_return_code(self) -> int:
        """Give the return code of the last call, as SciPy's: above 0 where it succeeded."""
        self._integrator()
        return self._code

    def integrate(self, t: float, step: bool = False, relax: bool = False) -> Array:
        """Continue to the time t.

        Parameters
        ----------
        t : float
            The time; before the present one it runs backwards.
        step : bool, optional
            Take one step of the method, wherever it ends. Without effect for 'dopri5' and 'dop853', as in SciPy.
        relax : bool, optional
            End where the step ends that passes t. Likewise.

        Returns
        -------
        y : ndarray, shape (n,)
            The state, `y`. Where the run has failed, that of the last step, whose time is `t`.
        """
        integrator = self._set if self._set is not None else self._integrator()
        t = float(t)
        if self._continued is not None and self._solout is None and not step and not relax:
            y = self._continued.go_on(t, self._y, self._functions(), integrator.nsteps)
            if y is not None:
                self._y, self.t, self._code = y, t, 1 if integrator.is_dop else 2
                return y
        if not np.isfinite(t):
            raise ValueError(f"the time to integrate to must be finite, and is {t}")
        if self._solout is not None:
            return self._with_solout(t, self._solout)
        if t == self.t or self._y.size == 0:
            self.t = t
            self._succeed()
            return self._y
        to_step_end = (step or relax) and integrator.stops_at_steps
        self._prepare(t)
        why = self._advance(t, step and integrator.stops_at_steps)
        if why == 0:
            assert self._run is not None and self._continued is not None
            self.t = self._run.t if to_step_end else t
            self._y = self._continued.stop_at(self.t)
            self._succeed()
        return self._y

    def _succeed(self) -> None:
        self._code = 1 if self._integrator().is_dop else 2

    def _functions(self) -> tuple[Any, ...]:
        return self.f, self.jac, self.f_params, self.jac_params

    def _prepare(self, t: float) -> None:
        """Have a run that leads from (t, y) to t and somewhat beyond."""
        if self._continued is not None and not self._continued.leads_to(t, self._y, self._functions()):
            self._take_error_of_probe()
            self._forget()
        if self._continued is None:
            self._begin(t if self._lands else t + _continuo.ContinuedRun.beyond * (t - self.t))

    def _take_error_of_probe(self) -> None:
        error = None if self._run is None else self._run.take_error()
        if error is not None and not isinstance(error, Exception):
            self._forget()
            raise error

    def _begin(self, end: float) -> None:
        integrator = self._integrator()
        options = dict(integrator.options)
        if self.jac is not None and "jac" in integrator.method.options:
            options["jac"] = self._jacobian(options)
        elif self._y.dtype.kind == "c":
            options.pop("lband", None)
            options.pop("uband", None)
        if "first_step" in options:
            options["first_step"] = min(options["first_step"], abs(end - self.t))
        self._run = begin_run(self.f, self.t, end, self._y, integrator.method, options, args=self.f_params or None)
        self._continued = _continuo.ContinuedRun(self._run, self.t, end, self._lands, self._functions())

    def _jacobian(self, options: dict[str, Any]) -> Callable[..., Any]:
        assert self.jac is not None
        jac: Callable[..., Any] = self.jac
        params = self.jac_params
        if self._y.dtype.kind != "c" or ("lband" not in options and "uband" not in options):
            return lambda t, y, *_: jac(t, y, *params)
        # A complex component is two real ones in the run, where the bands are other ones.
        lower, upper = int(options.pop("lband", None) or 0), int(options.pop("uband", None) or 0)
        return whole_matrix(lambda t, y, *_: jac(t, y, *params), len(self._y), lower, upper)

    def _advance(self, t: float, one_step: bool) -> int:
        """Until t lies in the last step; 0 where it does."""
        assert self._run is not None and self._continued is not None
        integrator = self._integrator()
        if one_step:
            why = 0
            if self._run.t == self.t and not self._run.step() and self._run.t == self.t:
                why = 1
        else:
            why = self._continued.advance_to(t, integrator.nsteps)
        error = self._run.take_error()
        if error is None and why == 0:
            return 0
        # Beyond t the function may have no value, which is no reason to fail before it: once more, as far as t alone.
        if self._continued.goes_beyond(t) and why != 2 and (error is None or isinstance(error, Exception)):
            self.t, self._y = self._run.t, self._run.y
            self._forget()
            self._lands = True
            self._begin(t)
            return self._advance(t, one_step)
        self._fail(error, why)
        return 1

    def _fail(self, error: BaseException | None, why: int) -> None:
        assert self._run is not None
        self.t, self._y = self._run.t, self._run.y
        integrator = self._integrator()
        *_, ending, _, _ = self._run.summary()
        outcome = self._run.summary()[2]
        self._success = False
        codes = _CODES.get("too many steps" if why == 2 else ending, _OTHER)
        self._code = codes[1] if integrator.is_dop else codes[0]
        if error is not None:
            self._forget()
            raise error
        if why == 2:
            outcome = f"{integrator.nsteps} steps, as many as nsteps, have led to t = {self.t:.8g}"
            self._continued = None
        self._forget()
        messages = _DOP_MESSAGES if integrator.is_dop else _VODE_MESSAGES
        warn(f"{integrator.name}: {messages[self._code]} ({outcome})", stacklevel=4)

    def _with_solout(self, t: float, solout: Callable[..., Any]) -> Array:
        """Step by step, and no further than t."""
        self._forget()
        code = 1
        stopped = solout(self.t, self._y.copy()) == -1
        if not stopped and t != self.t and self._y.size > 0:
            self._lands = True
            self._begin(t)
            assert self._run is not None
            steps = 0
            while self.t != t and not stopped:
                goes_on = steps < self._integrator().nsteps and self._run.step()
                error = self._run.take_error()
                if error is not None or (not goes_on and self._run.t != t):
                    self._fail(error, 2 if steps == self._integrator().nsteps else 1)
                    return self._y
                steps += 1
                self.t, self._y = self._run.t, self._run.y
                stopped = solout(self.t, self._y.copy()) == -1
        self._code = 2 if stopped or not self._integrator().is_dop else code
        return self._y


class complex_ode(ode):  # noqa: N801  # SciPy's name
    """The same for a complex y, and complex f and jac; see `ode`.

    Parameters
    ----------
    f : callable
        ``f(t, y, *f_args)`` gives dy/dt, complex, shape (n,).
    jac : callable, optional
        ``jac(t, y, *jac_args)`` gives df/dy, complex, shape (n, n), or packed.
    """

    _is_complex = True

    def set_integrator(self: Own, name: str, **integrator_params: Any) -> Own:
        """Set the method, as that of `ode`; 'zvode' is for `ode`."""
        if name == "zvode":
            raise ValueError("zvode must be used with ode, not complex_ode")
        super().set_integrator(name, **integrator_params)
        return self
