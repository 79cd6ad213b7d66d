"""Right-hand sides in the language of models: evaluated and differentiated in compiled code."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, MutableMapping, Sequence
from typing import Any, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _continuo

__all__ = ["RightHandSide", "expression"]

Parameters = Mapping[str, Union[float, ArrayLike]]


class ParameterValues(MutableMapping[str, Any]):
    """The parameters of a right-hand side by name; setting one takes effect in runs that begin after it."""

    def __init__(self, owner: RightHandSide) -> None:
        self._owner = owner

    def __getitem__(self, name: str) -> Any:
        return self._owner._parameter(name)

    def __setitem__(self, name: str, value: Any) -> None:
        self._owner._set_parameters({name: value})

    def __delitem__(self, name: str) -> None:
        raise TypeError(f"the equations need the parameter {name!r}")

    def __iter__(self) -> Iterator[str]:
        return iter(self._owner._parameter_names())

    def __len__(self) -> int:
        return len(self._owner._parameter_names())

    def __repr__(self) -> str:
        return repr(dict(self))


class RightHandSide:
    """The function f of y' = f(t, y), given by equations in the language of models.

    It is called as a Python function is, and solvers run it in compiled code: without the interpreter, from
    any number of threads, with exact Jacobians. Made by :func:`continuo.expression`, :func:`continuo.trace`
    or from a model.

    Parameters
    ----------
    text : str
        A model of plain ordinary differential equations. Initial values that it does not state are zero.
    name : str
        What messages call the text.
    native : {'auto', 'always', 'fused', 'never'}
        When the equations become machine code: as soon as that pays, at once, or not at all. The results are
        the same to the bit.

    Attributes
    ----------
    n : int
        The number of states.
    states : list of str
        What they are called in the text, in the order of y.
    parameters : mapping
        The parameters by name. They can be set: ``f.parameters["k"] = 5``.
    model : str
        The text.

    Raises
    ------
    ValueError
        Where the text is no model, with the messages that the command shows, or is more than equations: where
        it has events, modes, algebraic equations, bodies.
    """

    def __init__(self, text: str, name: str = "equations", native: str = "auto") -> None:
        self._compiled = _continuo.RightHandSide(text, name, native)
        self._base = self._compiled
        self._native: _continuo.Native | None = None  # of the present values, once it was asked for
        self._settings: dict[str, float] = {}
        self._name, self._use = name, native

    # ---- the equations ----

    @property
    def n(self) -> int:
        """The number of states."""
        return self._compiled.n

    @property
    def states(self) -> list[str]:
        """What the states are called, in the order of y."""
        return self._compiled.states

    @property
    def parameters(self) -> ParameterValues:
        """The parameters by name; setting one takes effect in runs that begin after it."""
        return ParameterValues(self)

    @property
    def model(self) -> str:
        """The equations as a text of the language of models: what ``continuo run`` takes as a file."""
        return self._compiled.text

    @property
    def native(self) -> dict[str, Any]:
        """How many functions were `compiled` or `loaded` as machine code, and the `trouble` there was."""
        return self._compiled.native

    @property
    def initial_state(self) -> NDArray[np.float64]:
        """The initial values that the text states, for the present parameters; shape (n,)."""
        return np.array(self._compiled.initial)

    def c(self) -> str:
        """The equations, their Jacobian and so on as a file of C11, whose comment explains the calls."""
        return self._compiled.c()

    # ---- values ----

    def __call__(self, t: float, y: ArrayLike, *args: Any) -> NDArray[np.float64]:
        """dy/dt.

        Parameters
        ----------
        t : float
        y : array_like, shape (n,) or (n, k)
            One state, or k of them as columns.
        *args : float or array
            All parameters in their order, in place of the present values.

        Returns
        -------
        ndarray, shape of y
        """
        compiled, states = self._with(args), _real(y)
        if states.ndim != 2:
            return compiled(float(t), states)
        result = np.empty_like(states)
        for k in range(states.shape[1]):
            result[:, k] = compiled(float(t), states[:, k])
        return result

    def jacobian(self, t: float, y: ArrayLike, *args: Any) -> NDArray[np.float64]:
        """The exact df/dy: entry (i, j) is the derivative of component i of f by y[j].

        Where it is not finite, as the slope of a root at 0, it is a central difference.

        Parameters
        ----------
        t : float
        y : array_like, shape (n,)
        *args : float or array
            All parameters in their order, in place of the present values.

        Returns
        -------
        ndarray, shape (n, n)
        """
        return self._with(args).jacobian(float(t), _real(y))

    def jacobian_pattern(self) -> tuple[NDArray[np.uint32], NDArray[np.uint32]]:
        """Where df/dy may differ from zero: rows and columns, column by column; the diagonal is among them."""
        return self._compiled.jacobian_pattern()

    def __continuo_native__(self, args: Sequence[Any] = ()) -> _continuo.Native:
        """The compiled functions for the solvers, with the parameters as they are now, or with these."""
        if args:
            return _native_of(self._with(self._in_order(tuple(args), {})))
        if self._native is None:
            self._native = _native_of(self._compiled)
        return self._native

    # ---- parameters ----

    def _parameter_names(self) -> list[str]:
        return list(self._compiled.parameters)

    def _parameter(self, name: str) -> Any:
        return self._compiled.parameters[name]

    def _flat(self, values: Parameters) -> dict[str, float]:
        """The parameters of the text that these are."""
        for name, value in values.items():
            if name not in self._base.parameters:
                known = ", ".join(self._base.parameters) or "none at all"
                raise KeyError(f"there is no parameter {name!r}; there are: {known}")
            if np.ndim(value) != 0:
                raise ValueError(
                    f"the parameter {name!r} is a number, not an array of shape {np.shape(value)}"
                )
        return {name: float(value) for name, value in values.items()}  # type: ignore[arg-type]  # see above

    def _set_parameters(self, values: Parameters) -> None:
        settings = {**self._settings, **self._flat(values)}
        self._compiled = self._base.with_parameters(settings)
        self._native = None
        self._settings = settings

    def _in_order(self, args: tuple[Any, ...], options: Mapping[str, Any]) -> tuple[Any, ...]:
        """Arguments of a call as values of all parameters."""
        return args

    def _with(self, args: tuple[Any, ...]) -> _continuo.RightHandSide:
        if not args:
            return self._compiled
        names = self._parameter_names()
        if len(args) != len(names):
            raise TypeError(f"{len(args)} values for the {len(names)} parameters {', '.join(names)}")
        return self._base.with_parameters({**self._settings, **self._flat(dict(zip(names, args)))})

    # ---- Python's own ----

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (type(self), self._state_for_pickle())

    def _state_for_pickle(self) -> dict[str, Any]:
        compiled = ("_compiled", "_base", "_native")
        state = {key: value for key, value in self.__dict__.items() if key not in compiled}
        return {**state, "text": self._base.text}

    def __repr__(self) -> str:
        shown = [f"{name}={value:.6g}" for name, value in list(self._compiled.parameters.items())[:6]]
        more = ", ..." if len(self._compiled.parameters) > 6 else ""
        parameters = f", {', '.join(shown)}{more}" if shown else ""
        return f"<continuo.{type(self).__name__} {self._compiled.name}: n={self.n}{parameters}>"


def _restored(kind: type[RightHandSide], state: dict[str, Any]) -> RightHandSide:
    """What __reduce__ makes again."""
    self = kind.__new__(kind)
    text = state.pop("text")
    self.__dict__.update(state)
    self._native = None
    self._base = _continuo.RightHandSide(text, self._name, self._use)
    self._compiled = self._base.with_parameters(self._settings) if self._settings else self._base
    return self


def _native_of(compiled: _continuo.RightHandSide) -> _continuo.Native:
    return _continuo.Native(
        compiled.derivative_address,
        jacobian=compiled.jacobian_address,
        entries=compiled.jacobian_entries_address,
        user=compiled.user,
        size=compiled.n,
        owner=compiled,
    )


def _real(y: ArrayLike) -> NDArray[np.float64]:
    values = np.asarray(y)
    if values.dtype.kind == "c":
        raise TypeError("y is complex; write real and imaginary parts as two states")
    if values.dtype.kind not in "fiub":
        raise TypeError(f"y is an array of {values.dtype}; it must be numbers")
    return np.ascontiguousarray(values, dtype=np.float64)


def expression(equations: str | Sequence[str], native: str = "auto", **parameters: float) -> RightHandSide:
    """A right-hand side written in the language of models.

    Parameters
    ----------
    equations : str or sequence of str
        Either equations for named states, separated by semicolons or lines, ``"x'' = -k/m*x"``: y has the
        states in their order, here x and x'. Or a sequence of expressions, one for each component, which read
        the components as ``y[0]``, ``y[1]``, ...: ``["y[1]", "-k*y[0]"]``. A name may be defined before:
        ``"let r = hypot(x, y); ..."``.
    native : {'auto', 'always', 'fused', 'never'}
        When the equations become machine code.
    **parameters : float
        Parameters that the equations use, and the values they begin with.

    Returns
    -------
    RightHandSide
        To be handed to the solvers, or called.

    Raises
    ------
    ValueError
        With the messages of the language, which point to the place.

    Examples
    --------
    >>> f = continuo.expression("x'' = -k/m*x", k=4, m=1)
    >>> f(0, [1, 0])
    array([ 0., -4.])
    >>> f.states
    ['x', "x'"]
    """
    if isinstance(equations, str):
        lines = [equations]
    else:
        lines = [f"y[{i}]' = {text}" for i, text in enumerate(equations)]
        if not lines:
            raise ValueError("there are no expressions")
        lines += [f"y[{i}](0) = 0" for i in range(len(lines))]
    stated = [f"param {name} = {_number(name, value)}" for name, value in parameters.items()]
    if not re.search(r"(?m)(^|;)\s*run\b", "\n".join(lines)):
        lines.append("run 0..1")
    return RightHandSide("\n".join(stated + lines) + "\n", "expression", native)


def with_equations(fun: Any) -> Any:
    """`fun` of a solver, where it is equations as text; all else as it is."""
    if callable(fun) or isinstance(fun, _continuo.Native):  # as most are: a call of a few steps takes little longer
        return fun
    if isinstance(fun, (str, list, tuple)) and not hasattr(fun, "signature"):  # a LowLevelCallable is a tuple
        return expression(fun)
    return fun


def _number(name: str, value: Any) -> str:
    try:
        number = float(value)
    except TypeError:
        raise TypeError(f"the parameter {name!r} must be a number, not a {type(value).__name__}") from None
    if not np.isfinite(number):
        raise ValueError(f"the parameter {name!r} is {number}; it must be finite")
    return repr(number)
