"""Python functions made into equations, by calling them once with symbolic arguments."""

from __future__ import annotations

import functools
import inspect
import re
import warnings
from collections.abc import Callable, Mapping, Sequence
from typing import Any, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _continuo
from .expression_text import Writer
from .expressions import Expression, TraceError, constant, expression_array
from .right_hand_side import Parameters, RightHandSide

__all__ = ["Traced", "trace"]

Function = Callable[..., Any]
_LARGEST_ARRAY = 10_000  # numbers of a parameter that is an array: each becomes a parameter of the model


@overload
def trace(
    f: Function,
    n: int | None = ...,
    *,
    args: Sequence[Any] | Mapping[str, Any] = ...,
    y0: ArrayLike | None = ...,
    native: str = ...,
    check: bool = ...,
) -> Traced: ...
@overload
def trace(
    f: None = ...,
    n: int | None = ...,
    *,
    args: Sequence[Any] | Mapping[str, Any] = ...,
    y0: ArrayLike | None = ...,
    native: str = ...,
    check: bool = ...,
) -> Callable[[Function], Traced]: ...
def trace(
    f: Function | None = None,
    n: int | None = None,
    *,
    args: Sequence[Any] | Mapping[str, Any] = (),
    y0: ArrayLike | None = None,
    native: str = "auto",
    check: bool = True,
) -> Traced | Callable[[Function], Traced]:
    """Calls `f` once with symbolic arguments, and makes equations of what it computes.

    The result takes the place of `f`: solvers run it in compiled code, without the interpreter, and with the
    exact Jacobian. Loops, indexing and NumPy's elementwise functions work; a branch that depends on values of
    t, y or a parameter is written ``continuo.where(condition, a, b)``. What cannot be traced is a
    :class:`TraceError` that says what to write.

    Parameters
    ----------
    f : callable
        ``f(t, y, *args)``, which returns dy/dt: n numbers. Left out, `trace` is a decorator.
    n : int
        The number of components of y. It may be left out where `y0` is given.
    args : sequence or mapping, optional
        Further arguments of `f`, or keyword arguments. Floats and arrays of floats become parameters, whose
        values can be changed without tracing again; all else (integers, strings, functions) is handed over as
        it is.
    y0 : array_like, shape (n,), optional
        A state near which `f` is compared with its equations; the initial values of ``.model``.
    native : {'auto', 'always', 'fused', 'never'}
        When the equations become machine code.
    check : bool
        Whether `f` is compared with its equations at random points. A function whose result depends on more
        than its arguments, or on values in a way that tracing does not see, is found so.

    Returns
    -------
    Traced

    Raises
    ------
    TraceError
        Where `f` needs a value that is not known, calls a function that has no counterpart, returns anything
        but n numbers, or differs from its equations.

    Examples
    --------
    >>> @continuo.trace(n=2, args=(4.0,))
    ... def spring(t, y, k):
    ...     return [y[1], -k * y[0]]
    >>> spring.jacobian(0, [1, 0])
    array([[ 0.,  1.],
           [-4.,  0.]])
    """
    if f is None:
        return functools.partial(trace, n=n, args=args, y0=y0, native=native, check=check)
    if not callable(f):
        raise TypeError(f"trace takes a function f(t, y), not a {type(f).__name__}")
    start = None if y0 is None else np.atleast_1d(np.asarray(y0, dtype=np.float64))
    if n is None and start is not None:
        n = start.size
    if n is None:
        raise TypeError("trace needs n, the number of components of y: trace(f, n)")
    if isinstance(n, bool) or not isinstance(n, (int, np.integer)):
        raise TypeError(
            f"n is {n!r}; it must be the number of components of y (y0 is given by its name, y0=...)"
        )
    if n < 1:
        raise ValueError(f"n is {n}; there must be a component")
    if start is not None and start.shape != (n,):
        raise ValueError(f"y0 has the shape {start.shape}; it must be ({n},)")
    return Traced(f, int(n), args, start, native, check)


class Traced(RightHandSide):
    """A Python function as equations, made by :func:`continuo.trace`.

    Attributes
    ----------
    function : callable or None
        The Python function; None after it was pickled.
    n, states, parameters, model
        As of :class:`RightHandSide`; parameters have the names of the arguments of f.
    """

    def __init__(
        self,
        f: Function,
        n: int,
        args: Sequence[Any] | Mapping[str, Any],
        y0: NDArray[np.float64] | None,
        native: str,
        check: bool,
    ) -> None:
        self.function: Function | None = f
        self._y0 = np.zeros(n) if y0 is None else y0
        call = _Call(f, args)
        self._places, self._fixed, self._arguments = call.places, call.fixed, call.names
        results = _results(call.symbolic(n), n)
        text = _text(call, results, n, self._y0)
        super().__init__(text, call.name, native)
        if check:
            _compare(self, call, self._y0 if y0 is not None else None)

    @property
    def model(self) -> str:
        """The equations as a text of the language of models, with the present values of the parameters."""
        text = self._base.text
        for name, value in self._settings.items():
            text = re.sub(rf"(?m)^(param {re.escape(name)} = ).*$", rf"\g<1>{value!r}", text, count=1)
        return text

    def __call__(self, t: float, y: ArrayLike, *args: Any, **options: Any) -> NDArray[np.float64]:
        """dy/dt, as the Python function gives it; see :meth:`RightHandSide.__call__`."""
        return super().__call__(t, y, *self._in_order(args, options))

    def _in_order(self, args: tuple[Any, ...], options: Mapping[str, Any]) -> tuple[Any, ...]:
        """Arguments as those that f was traced with, some perhaps by name, as values of all parameters."""
        if not args and not options:
            return ()
        order = self._arguments
        if len(args) > len(order):
            raise TypeError(
                f"{len(args)} arguments; f was traced with {len(order)}: {', '.join(order) or 'none'}"
            )
        given = {**dict(zip(order, args)), **options}
        for name, value in given.items():
            if name in self._fixed and not _equal(value, self._fixed[name]):
                raise TypeError(
                    f"{name} is {value!r}, but f was traced with {self._fixed[name]!r}, which is "
                    "no float: trace it again"
                )
            if name not in order:
                raise TypeError(f"f was traced without an argument {name!r}")
        return tuple(given.get(name, self._parameter(name)) for name in self._places)

    def _parameter_names(self) -> list[str]:
        return list(self._places)

    def _parameter(self, name: str) -> Any:
        if name not in self._places:
            raise KeyError(
                f"there is no parameter {name!r}; there are: {', '.join(self._places) or 'none at all'}"
            )
        shape, names = self._places[name]
        values = self._compiled.parameters
        return values[names[0]] if shape is None else np.array([values[n] for n in names]).reshape(shape)

    def _flat(self, values: Parameters) -> dict[str, float]:
        flat: dict[str, float] = {}
        for name, value in values.items():
            if name not in self._places:
                known = ", ".join(self._places) or "none at all"
                raise KeyError(f"there is no parameter {name!r}; there are: {known}")
            shape, names = self._places[name]
            numbers = np.asarray(value, dtype=np.float64)
            if numbers.shape != (shape or ()):
                raise ValueError(f"the parameter {name!r} has the shape {shape or ()}, not {numbers.shape}")
            flat.update(zip(names, numbers.ravel().tolist()))
        return flat

    def _state_for_pickle(self) -> dict[str, Any]:
        return {**super()._state_for_pickle(), "function": None}

    def check(self, t: float, y: ArrayLike) -> None:
        """Compares the Python function with its equations at one point.

        Raises
        ------
        TraceError
            Where they differ by more than rounding.
        """
        if self.function is None:
            raise RuntimeError("the Python function was left behind when this was pickled")
        values = {name: self._parameter(name) for name in self._places}
        call = _Call.again(self.function, self._arguments, values, self._fixed)
        _compare_at(self, call, t, np.asarray(y, float))


class _Call:
    """How f is called: by which names, which of its arguments are parameters, and which stay."""

    def __init__(self, f: Function, args: Sequence[Any] | Mapping[str, Any]) -> None:
        self.f = f
        self.name = _model_name(f)
        self.by_name = isinstance(args, Mapping)
        state, others = _argument_names(f)
        if isinstance(args, Mapping):
            given = dict(args)
        else:
            values = list(args) if isinstance(args, (Sequence, np.ndarray)) else [args]
            names = others + [f"p{i + 1}" for i in range(len(others), len(values))]
            given = dict(zip(names, values))
        self.state_name = _free_name(state, set())
        self.names = list(given)
        self.values: dict[str, Any] = {}  # of the parameters
        self.fixed: dict[str, Any] = {}
        self.places: dict[str, tuple[tuple[int, ...] | None, list[str]]] = {}  # shape and names in the text
        taken = {self.state_name, "t"}
        for name, value in given.items():
            if not _is_parameter(name, value):
                self.fixed[name] = value
                continue
            self.values[name] = value
            base = _free_name(name, taken)
            taken.add(base)
            shape = None if np.ndim(value) == 0 else np.shape(value)
            names = [base] if shape is None else [_indexed(base, index) for index in np.ndindex(*shape)]
            self.places[name] = shape, names

    @classmethod
    def again(cls, f: Function, names: list[str], values: dict[str, Any], fixed: dict[str, Any]) -> _Call:
        """The call of a function that was traced, with these values."""
        call = cls.__new__(cls)
        call.f, call.names, call.values, call.fixed, call.by_name = f, names, values, fixed, False
        return call

    def __call__(self, t: Any, y: Any, values: Mapping[str, Any]) -> Any:
        arguments = {name: values[name] if name in values else self.fixed[name] for name in self.names}
        return self.f(t, y, **arguments) if self.by_name else self.f(t, y, *arguments.values())

    def symbolic(self, n: int) -> Any:
        """What f makes of symbols."""
        y = expression_array([Expression("name", value=f"{self.state_name}[{i}]") for i in range(n)])
        values: dict[str, Any] = {}
        for name, (shape, names) in self.places.items():
            symbols = [Expression("name", value=each) for each in names]
            values[name] = symbols[0] if shape is None else expression_array(symbols).reshape(shape)
        return self(Expression("name", value="t"), y, values)


def _is_parameter(name: str, value: Any) -> bool:
    if isinstance(value, (float, np.floating)):
        size = 1
    elif isinstance(value, np.ndarray) and value.dtype.kind == "f":
        size = value.size
    else:
        return False
    if size > _LARGEST_ARRAY:
        raise ValueError(
            f"the argument {name} has {size} numbers, each of which would be a parameter; let f "
            "read it from outside "
            "of its arguments, so that they are constants"
        )
    if not np.all(np.isfinite(value)):
        raise ValueError(f"the argument {name} is not finite: {value}")
    return True


def _indexed(base: str, index: tuple[int, ...]) -> str:
    return f"{base}_{'_'.join(map(str, index))}"


def _argument_names(f: Function) -> tuple[str, list[str]]:
    """What f calls its state, and its further arguments."""
    try:
        parameters = list(inspect.signature(f).parameters.values())
    except (TypeError, ValueError):
        return "y", []
    names = [p.name for p in parameters if p.kind in (p.POSITIONAL_ONLY, p.POSITIONAL_OR_KEYWORD)]
    return (names[1] if len(names) > 1 else "y"), names[2:]


def _free_name(name: str, taken: set[str]) -> str:
    """A name that the language takes and that is not taken."""
    name = name.strip("_") or "p"
    while _continuo.is_reserved_word(name) or name in taken:
        name += "_"
    return name


def _model_name(f: Function) -> str:
    name = re.sub(r"\W", "", getattr(f, "__name__", type(f).__name__), flags=re.ASCII).strip("_0123456789")
    return _free_name(name or "traced", set())


def _results(value: Any, n: int) -> list[Expression]:
    """The n expressions that f returned."""
    if isinstance(value, Expression):
        value = [value]
    if value is None:
        raise TraceError("f returned None; it must return dy/dt" + _writing_hint())
    try:
        array = value.view(np.ndarray) if isinstance(value, np.ndarray) else np.array(value, dtype=object)
    except ValueError as error:
        raise TraceError(f"f returned parts of different lengths, not {n} numbers ({error})") from None
    if array.ndim == 0:
        array = array.reshape(1)
    if array.shape != (n,):
        raise TraceError(
            f"f returned an array of the shape {array.shape}; dy/dt of {n} components has the shape ({n},)"
        )
    for i, entry in enumerate(array):
        if entry is None:
            raise TraceError(f"f returned an array whose entry {i} was never set")
    return [_entry(i, entry) for i, entry in enumerate(array)]


def _writing_hint() -> str:
    return "; of a function f(t, y, dydt) that writes to an array, make it by np.empty_like(y) and return it"


def _entry(i: int, value: Any) -> Expression:
    if isinstance(value, (Expression, int, float, np.number, np.bool_)):
        return constant(value)
    raise TraceError(f"component {i} of dy/dt is a {type(value).__name__}, not a number")


def _text(call: _Call, results: list[Expression], n: int, y0: NDArray[np.float64]) -> str:
    """The model: parameters, names for what is used twice, equations, initial values."""
    taken = {call.state_name, *(name for _, names in call.places.values() for name in names)}
    prefix = "a"
    while any(re.fullmatch(rf"{prefix}\d+", name) for name in taken):
        prefix += "a"
    writer = Writer(results, prefix)
    lines = [f"model {call.name}"]
    for name, (_, names) in call.places.items():
        numbers = np.ravel(np.asarray(call.values[name], dtype=np.float64)).tolist()
        lines += [f"param {each} = {number!r}" for each, number in zip(names, numbers)]
    lines += [f"let {name} = {text}" for name, text in writer.definitions]
    y = call.state_name
    lines += [f"{y}[{i}]' = {writer.text(result)}" for i, result in enumerate(results)]
    lines += [f"{y}[{i}](0) = {value!r}" for i, value in enumerate(y0.tolist())]
    return "\n".join([*lines, "run 0..1", ""])


# ---- comparison with f -------------------------------------------------------------------------------------

_POINTS = 12
_ROUNDING = 1e-12  # by this part y is moved, to see how much of a difference rounding may make
_CLEAR = 1e-7  # a difference of this part of the values is looked at


def _compare(traced: Traced, call: _Call, y0: NDArray[np.float64] | None) -> None:
    """At random points of several sizes and signs; those where f is not defined say nothing."""
    random = np.random.default_rng(20)
    compared = 0
    for k in range(_POINTS):
        y = random.standard_normal(traced.n) * (0.1, 1.0, 10.0)[k % 3]
        if k % 2:
            y = np.abs(y)
        if y0 is not None and k < _POINTS // 2:
            y = y0 * (1 + 0.1 * y) + (0.01 * y if k else 0.0)
        t = 0.0 if k == 0 else float(random.uniform(0, 2))
        compared += _compare_at(traced, call, t, y)
    if compared == 0:
        warnings.warn(
            f"{call.name} gave no finite numbers at any of {_POINTS} random points, so that it "
            "was not compared with its "
            "equations; give a state where it is defined: trace(f, y0=...)",
            stacklevel=4,
        )


def _compare_at(traced: Traced, call: _Call, t: float, y: NDArray[np.float64]) -> bool:
    """Whether f is defined there; raises where the equations are not what it gives."""
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        try:
            values = {name: value for name, value in call.values.items()}
            expected = np.asarray(call(t, y.copy(), values), dtype=np.float64).reshape(traced.n)
        except (ArithmeticError, ValueError, TypeError):  # outside of its domain; complex: a TypeError
            return False
        if not np.all(np.isfinite(expected)):
            return False
        found = traced(t, y)
        size = np.maximum(np.abs(expected), np.abs(found))
        moved = np.max([np.abs(traced(t, y * (1 + s * _ROUNDING)) - found) for s in (-1, 1)], axis=0)
        wrong = ~(np.abs(found - expected) <= np.maximum(_CLEAR * size, 1e3 * np.nan_to_num(moved)) + 1e-14)
    if np.any(wrong):
        i = int(np.argmax(wrong))
        raise TraceError(
            f"component {i} of f is {expected[i]:.17g} at t = {t:.17g}, y = {y.tolist()}, but "
            "its equations give "
            f"{found[i]:.17g}: f depends on more than its arguments, or on values in a way that "
            "tracing does not see "
            "(a value that was kept from an earlier call, `try` around a comparison, a random number)"
        )
    return True


def _equal(a: Any, b: Any) -> bool:
    try:
        return bool(
            np.all(a == b)) if isinstance(a, np.ndarray) or isinstance(b, np.ndarray) else bool(a == b
        )
    except (TypeError, ValueError):
        return a is b
