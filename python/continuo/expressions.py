"""Symbolic numbers: what a traced Python function computes with instead of floats.

An :class:`Expression` is a number that is not known yet, an :class:`ExpressionArray` a NumPy array of them.
NumPy's functions on them build expressions of the language of models; what would need the value itself raises
a :class:`TraceError` that says what to write instead.
"""

from __future__ import annotations

import linecache
import math
import re
import sys
from collections.abc import Callable
from typing import Any, Union

import numpy as np

from .expression_text import text_of

__all__ = ["Expression", "ExpressionArray", "TraceError", "maximum", "minimum", "where"]

Operand = Union["Expression", float]


class TraceError(TypeError):
    """A function cannot be traced as it is written: the message says where, why, and what to write."""


# Functions of `math` and of Python whose counterpart in NumPy has another name.
_NUMPY_NAMES = {
    "acos": "arccos", "asin": "arcsin", "atan": "arctan", "atan2": "arctan2", "acosh": "arccosh",
    "asinh": "arcsinh", "atanh": "arctanh", "pow": "power", "dist": "hypot", "abs": "abs", "max": "maximum",
    "min": "minimum",
}  # fmt: skip
_MATH_CALL = re.compile(r"\b(?:c?math\.)(\w+)\s*\(")


def _place() -> str:
    """The line of the traced function that is at work, with its text: the first outside of this file and of
    NumPy."""
    frame = sys._getframe(1)
    while frame is not None:
        name = frame.f_code.co_filename
        if name != __file__ and not name.startswith(("<__array", np.__path__[0])):
            line = linecache.getline(name, frame.f_lineno).strip()
            return f"{name}, line {frame.f_lineno}: {line}" if line else f"{name}, line {frame.f_lineno}"
        frame = frame.f_back  # type: ignore[assignment]  # None ends the loop
    return "the traced function"


def _refuse(why: str, instead: str) -> TraceError:
    return TraceError(f"{_place()}\n  {why}; {instead}")


class Expression:
    """A number that is not known yet: a state, a parameter, the time, or what was computed from them.

    Not made by hand: :func:`continuo.trace` hands them to the function that it traces.
    """

    __slots__ = ("operation", "arguments", "value")

    def __init__(
        self, operation: str, arguments: tuple[Expression, ...] = (), value: float | str = 0.0
    ) -> None:
        self.operation = operation  # "number", "name", an operator, or the name of a function of the language
        self.arguments = arguments
        self.value = value  # of a number; the text of a name

    # ---- arithmetic, as Python writes it ----

    def __add__(self, other: Any) -> Any:
        return _binary("+", self, other)

    def __radd__(self, other: Any) -> Any:
        return _binary("+", other, self)

    def __sub__(self, other: Any) -> Any:
        return _binary("-", self, other)

    def __rsub__(self, other: Any) -> Any:
        return _binary("-", other, self)

    def __mul__(self, other: Any) -> Any:
        return _binary("*", self, other)

    def __rmul__(self, other: Any) -> Any:
        return _binary("*", other, self)

    def __truediv__(self, other: Any) -> Any:
        return _binary("/", self, other)

    def __rtruediv__(self, other: Any) -> Any:
        return _binary("/", other, self)

    def __pow__(self, other: Any) -> Any:
        return _binary("^", self, other)

    def __rpow__(self, other: Any) -> Any:
        return _binary("^", other, self)

    def __mod__(self, other: Any) -> Any:
        return _binary("mod", self, other)

    def __rmod__(self, other: Any) -> Any:
        return _binary("mod", other, self)

    def __floordiv__(self, other: Any) -> Any:
        return _call("floor", self / other)

    def __rfloordiv__(self, other: Any) -> Any:
        return _call("floor", other / self)

    def __divmod__(self, other: Any) -> Any:
        return self // other, self % other

    def __rdivmod__(self, other: Any) -> Any:
        return other // self, other % self

    def __neg__(self) -> Expression:
        return Expression("negate", (self,))

    def __pos__(self) -> Expression:
        return self

    def __abs__(self) -> Expression:
        return _call("abs", self)

    def __floor__(self) -> Expression:
        return _call("floor", self)

    def __ceil__(self) -> Expression:
        return _call("ceil", self)

    def __trunc__(self) -> Any:
        return _truncated(self)

    def __round__(self, digits: int | None = None) -> Expression:
        if digits:
            raise _refuse("round to decimal digits is no function of a model", "scale: round(1000*x)/1000")
        return _rounded(self)

    # ---- comparisons give conditions, whose truth is not known ----

    def __lt__(self, other: Any) -> Any:
        return _binary("<", self, other)

    def __le__(self, other: Any) -> Any:
        return _binary("<=", self, other)

    def __gt__(self, other: Any) -> Any:
        return _binary(">", self, other)

    def __ge__(self, other: Any) -> Any:
        return _binary(">=", self, other)

    def __eq__(self, other: Any) -> Any:
        return NotImplemented if other is None or isinstance(other, str) else _binary("==", self, other)

    def __ne__(self, other: Any) -> Any:
        return NotImplemented if other is None or isinstance(other, str) else _binary("!=", self, other)

    __hash__ = object.__hash__

    def __and__(self, other: Any) -> Any:
        return _logical("and", self, other)

    def __rand__(self, other: Any) -> Any:
        return _logical("and", other, self)

    def __or__(self, other: Any) -> Any:
        return _logical("or", self, other)

    def __ror__(self, other: Any) -> Any:
        return _logical("or", other, self)

    def __invert__(self) -> Expression:
        return _negated(self)

    # ---- what needs the value ----

    def __bool__(self) -> bool:
        raise _refuse(
            f"whether `{self}` holds is not known while the function is traced",
            "write continuo.where(condition, a, b) for a choice (`if`, `and`, `or`, `not`), "
            "np.maximum and np.minimum "
            "for max and min",
        )

    def __float__(self) -> float:
        call = _MATH_CALL.search(_place())
        if call:
            name = _NUMPY_NAMES.get(call[1], call[1])
            raise _refuse(f"math.{call[1]} takes floats only", f"write np.{name}")
        raise _refuse(
            f"the value of `{self}` is not known while the function is traced",
            "leave float() out; an array that is to hold it must be made from y: "
            "np.zeros_like(y), np.empty_like(y), "
            "np.array([...]); of a function of math write that of np",
        )

    def __complex__(self) -> complex:
        raise _refuse("a model has no complex numbers", "write real and imaginary parts as two states")

    def __int__(self) -> int:
        raise _refuse(f"the value of `{self}` is not known while the function is traced", "write np.floor")

    def __index__(self) -> int:
        raise _refuse(
            f"the value of `{self}` is not known while the function is traced",
            "an index or the length of a loop must be an int that does not depend on t, y or a "
            "float parameter",
        )

    def __repr__(self) -> str:
        text = text_of(self)
        return text if len(text) <= 60 else text[:57] + "..."

    # ---- NumPy: on scalars by these two, on object arrays by the methods it looks for ----

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **options: Any) -> Any:
        return _ufunc(ufunc, method, inputs, options)

    def __array_function__(self, function: Any, types: Any, args: Any, options: Any) -> Any:
        return _array_function(function, args, options)

    def __getattr__(self, name: str) -> Any:
        # NumPy calls x.sin() for the elements of an object array; it looks at the type for nothing else.
        handler = UFUNCS.get(name)
        if handler is None:
            raise AttributeError(f"a symbolic number has no attribute {name!r}")
        return lambda *others: handler(self, *others)


# ---- building ----------------------------------------------------------------------------------------------


def constant(value: Any) -> Expression:
    """The expression of a number.

    Raises
    ------
    TraceError
        Where it is complex or not finite.
    """
    if isinstance(value, Expression):
        return value
    if isinstance(value, (complex, np.complexfloating)):
        raise _refuse(f"{value} is complex", "write real and imaginary parts as two states")
    number = float(value)
    if not math.isfinite(number):
        raise _refuse(
            f"{number} is no number that a model can contain", "leave it out, or take a large finite one"
        )
    return Expression("number", value=number)


def _is_scalar(value: Any) -> bool:
    return isinstance(value, (Expression, int, float, complex, np.number, np.bool_)) or (
        isinstance(value, np.ndarray) and value.ndim == 0 and value.dtype != object
    )


def _binary(operation: str, a: Any, b: Any) -> Any:
    if not _is_scalar(a) or not _is_scalar(b):
        return NotImplemented
    return Expression(operation, (constant(a), constant(b)))


_LOGICAL = {"<", "<=", ">", ">=", "==", "!=", "and", "or", "not"}


def _condition(value: Any) -> Expression:
    """What the language takes behind `if`: a number is true where it is not zero."""
    expression = constant(value)
    return expression if expression.operation in _LOGICAL else Expression("!=", (expression, constant(0.0)))


def _logical(operation: str, a: Any, b: Any) -> Any:
    if not _is_scalar(a) or not _is_scalar(b):
        return NotImplemented
    for value in (a, b):
        is_condition = value.operation in _LOGICAL if isinstance(value, Expression) else value in (0, 1)
        if not is_condition:  # ~ of a Python bool is -1 or -2
            raise _refuse(
                f"& and | of `{value}`, which is no condition", "compare it: (y[0] > 0) & (y[1] < 1)"
            )
    return Expression(operation, (_condition(a), _condition(b)))


def _negated(a: Any) -> Expression:
    return Expression("not", (_condition(a),))


def _call(name: str, *arguments: Any) -> Expression:
    return Expression(name, tuple(constant(argument) for argument in arguments))


def _choice(condition: Any, a: Any, b: Any) -> Any:
    if not isinstance(condition, Expression):
        return a if condition else b
    return Expression("if", (_condition(condition), constant(a), constant(b)))


def _truncated(x: Any) -> Any:
    return _call("sign", x) * _call("floor", _call("abs", x))


def _rounded(x: Any) -> Expression:
    """To the nearest whole number, of two to the even one: as NumPy and Python round."""
    nearest = _call("floor", x + 0.5)
    is_odd_tie = Expression("and", (nearest == x + 0.5, nearest % 2 != 0))
    result: Expression = _choice(is_odd_tie, nearest - 1, nearest)
    return result


def _float_power(a: Any, b: Any) -> Expression:
    return Expression("^", (constant(a), constant(b)))


def _remainder_of_c(a: Any, b: Any) -> Expression:
    result: Expression = a - b * _truncated(constant(a) / b)
    return result


def _exponential_minus_one(x: Any) -> Any:
    half = constant(x) / 2  # exp(x) - 1 = 2 exp(x/2) sinh(x/2), where nothing cancels
    return 2 * _call("exp", half) * _call("sinh", half)


def _clip(x: Any, low: Any, high: Any) -> Any:
    if low is not None:
        x = _call("max", x, low)
    return x if high is None else _call("min", x, high)


def _one(name: str) -> Callable[..., Any]:
    return lambda x: _call(name, x)


def _two(name: str) -> Callable[..., Any]:
    return lambda a, b: _call(name, a, b)


def _operator(operation: str) -> Callable[..., Any]:
    return lambda a, b: Expression(operation, (constant(a), constant(b)))


# NumPy's elementwise functions by name, for scalars.
UFUNCS: dict[str, Callable[..., Any]] = {
    **{name: _one(name) for name in ("sin", "cos", "tan", "sinh", "cosh", "tanh", "exp", "log")},
    **{name: _one(name) for name in ("log2", "log10", "sqrt", "cbrt", "floor", "ceil", "sign")},
    **{"arc" + name: _one("a" + name) for name in ("sin", "cos", "tan", "sinh", "cosh", "tanh")},
    "absolute": _one("abs"), "fabs": _one("abs"), "negative": lambda x: -constant(x), "positive": lambda x: x,
    "rint": _rounded, "trunc": _truncated, "square": lambda x: constant(x) ** 2,
    "reciprocal": lambda x: 1 / constant(x), "expm1": _exponential_minus_one,
    "exp2": lambda x: _float_power(2.0, x), "conjugate": lambda x: x,
    "deg2rad": lambda x: constant(x) * (math.pi / 180), "radians": lambda x: constant(x) * (math.pi / 180),
    "rad2deg": lambda x: constant(x) * (180 / math.pi), "degrees": lambda x: constant(x) * (180 / math.pi),
    **{name: _operator(text) for name, text in {
        "add": "+", "subtract": "-", "multiply": "*", "divide": "/", "true_divide": "/", "power": "^",
        "less": "<", "less_equal": "<=", "greater": ">", "greater_equal": ">=", "equal": "==",
        "not_equal": "!="}.items()},
    "float_power": _float_power, "remainder": _two("mod"), "mod": _two("mod"), "fmod": _remainder_of_c,
    "floor_divide": lambda a, b: constant(a) // b, "divmod": lambda a, b: (constant(a) // b, constant(a) % b),
    "maximum": _two("max"), "minimum": _two("min"), "fmax": _two("max"), "fmin": _two("min"),
    "hypot": _two("hypot"), "arctan2": _two("atan2"),
    "heaviside": lambda x, at_zero: _choice(constant(x) < 0, 0.0, _choice(constant(x) == 0, at_zero, 1.0)),
    "logical_and": lambda a, b: Expression("and", (_condition(a), _condition(b))),
    "logical_or": lambda a, b: Expression("or", (_condition(a), _condition(b))),
    "logical_not": _negated, "bitwise_and": lambda a, b: _logical("and", a, b),
    "bitwise_or": lambda a, b: _logical("or", a, b), "invert": _negated,
}  # fmt: skip

_INSTEAD = {
    "log1p": "write np.log(1 + x), if its rounding near x = 0 does no harm",
    "copysign": "write continuo.where(y < 0, -abs(x), abs(x))",
    "isfinite": "leave it out: a step to a value that is not finite is rejected",
    "isnan": "leave it out: a step to a value that is not finite is rejected",
}


# ---- arrays ------------------------------------------------------------------------------------------------


class ExpressionArray(np.ndarray[Any, np.dtype[Any]]):
    """A NumPy array of symbolic numbers: what a traced function gets as `y`."""

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **options: Any) -> Any:
        return _ufunc(ufunc, method, inputs, options)

    def __array_function__(self, function: Any, types: Any, args: Any, options: Any) -> Any:
        return _array_function(function, args, options)

    def dot(self, other: Any, out: Any = None) -> Any:
        """The product of matrices, as np.dot."""
        return _matmul(self, other)

    def sum(self, *args: Any, **options: Any) -> Any:
        """The sum, as np.sum."""
        return _array(np.sum(self.view(np.ndarray), *args, **options))

    def clip(self, low: Any = None, high: Any = None) -> Any:  # type: ignore[override]  # without `out`
        """Each number, but no less than `low` and no more than `high`."""
        return _elementwise(_clip, self, low, high)


def expression_array(values: Any) -> ExpressionArray:
    """The array of these numbers and expressions."""
    array = np.empty(len(values), dtype=object)
    array[:] = values
    return array.view(ExpressionArray)


def _plain(value: Any) -> Any:
    """An object array that NumPy treats as any other; what is a number or None stays."""
    if isinstance(value, Expression):
        array = np.empty((), dtype=object)
        array[()] = value
        return array
    if isinstance(value, np.ndarray):
        return value.view(np.ndarray).astype(object)
    return np.asarray(value, dtype=object) if isinstance(value, (list, tuple)) else value


def _array(value: Any) -> Any:
    if isinstance(value, tuple):
        return tuple(_array(part) for part in value)
    if not isinstance(value, np.ndarray) or value.dtype != object:
        return value
    return value.view(ExpressionArray) if value.ndim else value[()]


def _elementwise(handler: Callable[..., Any], *operands: Any) -> Any:
    if all(operand is None or _is_scalar(operand) for operand in operands):
        return handler(*operands)
    outputs = 2 if handler is UFUNCS["divmod"] else 1
    return _array(np.frompyfunc(handler, len(operands), outputs)(*map(_plain, operands)))


def _ufunc(ufunc: np.ufunc, method: str, inputs: tuple[Any, ...], options: dict[str, Any]) -> Any:
    name = ufunc.__name__
    if name == "matmul":
        return _matmul(*inputs)
    handler = UFUNCS.get(name)
    if handler is None:
        raise _refuse(
            f"np.{name} has no counterpart in a model", _INSTEAD.get(name, "write it by other functions")
        )
    if method != "__call__":
        plain = tuple(_plain(operand) for operand in inputs)
        if method == "at":
            raise _refuse(f"np.{name}.at", "write a loop")
        if name in ("add", "multiply"):
            return _array(getattr(ufunc, method)(*plain, **options))
        options.pop("initial", None)
        return _array(getattr(np.frompyfunc(handler, 2, 1), method)(*plain, **options))
    out = options.pop("out", (None,))[0]
    options.pop("dtype", None)
    if options:
        raise _refuse(f"np.{name} with {', '.join(options)}", "write it without")
    result = _elementwise(handler, *inputs)
    if out is None:
        return result
    if out.dtype != object:
        raise _refuse(
            f"an array of {out.dtype} cannot hold what depends on t, y or a parameter",
            "make it from y: np.zeros_like(y), np.empty_like(y), or by an expression, a = a + b",
        )
    out[...] = result
    return out


def _is_zero(value: Any) -> bool:
    return isinstance(value, (int, float)) and value == 0


def _sum_of_products(a: Any, b: Any) -> Any:
    total: Any = 0.0
    for left, right in zip(a, b):
        # Of a sparse matrix that is written as a full one, the zeros are left out.
        if not (_is_zero(left) or _is_zero(right)):
            product = left * right
            total = product if isinstance(total, float) and total == 0 else total + product
    return total


def _matmul(a: Any, b: Any) -> Any:
    left, right = np.asarray(_plain(a), dtype=object), np.asarray(_plain(b), dtype=object)
    if left.ndim == 0 or right.ndim == 0:
        return _array(np.asarray(left * right, dtype=object))
    if left.ndim > 2 or right.ndim > 2:
        return _array(np.matmul(left, right))
    if left.shape[-1] != right.shape[0]:
        raise ValueError(f"a matrix of the shape {left.shape} cannot be multiplied with one of {right.shape}")
    rows, columns = np.atleast_2d(left), (right if right.ndim == 2 else right[:, None])
    product = np.empty((len(rows), columns.shape[1]), dtype=object)
    for i, row in enumerate(rows):
        for j in range(columns.shape[1]):
            product[i, j] = _sum_of_products(row, columns[:, j])
    return _array(product.reshape(left.shape[:-1] + right.shape[1:]))


def _array_function(function: Any, args: tuple[Any, ...], options: dict[str, Any]) -> Any:
    name = function.__name__
    if name == "where" and len(args) == 3:
        return _elementwise(_choice, *args)
    if name == "clip" and len(args) == 3:
        return _elementwise(_clip, *args)
    if name in ("dot", "inner") and len(args) == 2 and np.ndim(_plain(args[1])) < 2:
        return _matmul(*args)
    if name == "dot":
        return _matmul(*args)
    if name.startswith(("fft", "ifft")) or function.__module__.startswith("numpy.fft"):
        raise _refuse(f"np.{name} has no counterpart in a model", "multiply with the matrix of the transform")
    implementation = getattr(function, "__wrapped__", None) or getattr(function, "_implementation", function)
    try:
        return _array(implementation(*_unwrapped(args), **_unwrapped(options)))
    except TraceError:
        raise
    except TypeError as error:
        raise _refuse(
            f"np.{name} cannot be traced ({error})", "write it by elementwise functions and loops"
        ) from error


def _unwrapped(value: Any) -> Any:
    """With arrays in place of single symbolic numbers, so that NumPy does its own work on them."""
    if isinstance(value, Expression):
        return _plain(value).view(ExpressionArray)
    if isinstance(value, (list, tuple)):
        return type(value)(part if isinstance(part, Expression) else _unwrapped(part) for part in value)
    if isinstance(value, dict):
        return {key: _unwrapped(part) for key, part in value.items()}
    return value


# ---- functions for those who write f -----------------------------------------------------------------------


def _of_numbers_or_expressions(
    handler: Callable[..., Any], numpy_function: Callable[..., Any], *args: Any
) -> Any:
    def is_symbolic(value: Any) -> bool:
        return isinstance(value, Expression) or (getattr(np.asarray(value), "dtype", None) == object)

    return _elementwise(handler, *args) if any(map(is_symbolic, args)) else numpy_function(*args)


def where(condition: Any, a: Any, b: Any) -> Any:
    """`a` where the condition holds, else `b`: ``if`` for functions that are traced.

    Parameters
    ----------
    condition, a, b : number, symbolic number, or array of them
        With numbers it is ``np.where``, so that the function gives the same without being traced.

    Returns
    -------
    number, symbolic number or array
        A symbolic one is ``if condition then a else b`` of a model.

    Examples
    --------
    >>> continuo.where(1.0 > 0.5, 2.0, 3.0)
    array(2.)
    """
    return _of_numbers_or_expressions(_choice, np.where, condition, a, b)


def maximum(a: Any, b: Any) -> Any:
    """The larger of two numbers, as ``np.maximum``, also of arrays made by ``np.array`` from symbolic
    numbers."""
    return _of_numbers_or_expressions(UFUNCS["maximum"], np.maximum, a, b)


def minimum(a: Any, b: Any) -> Any:
    """The smaller of two numbers, as ``np.minimum``, also of arrays made by ``np.array`` from symbolic
    numbers."""
    return _of_numbers_or_expressions(UFUNCS["minimum"], np.minimum, a, b)
