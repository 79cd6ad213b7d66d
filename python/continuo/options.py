"""What solve_ivp and the solver classes are given, checked and brought into the form of a run."""

from __future__ import annotations

import math
from typing import Any, Callable, NamedTuple
from warnings import warn

import numpy as np
import numpy.typing as npt

from . import _continuo
from .events import event_fields
from .progress_bar import progress_function
from .right_hand_side import RightHandSide, with_equations

Array = npt.NDArray[Any]

EPS = float(np.finfo(float).eps)
LEAST_RTOL = 100 * EPS
_FLOAT = np.dtype(float)
# From here on a sparse Jacobian is kept sparse; below, a dense one is solved faster.
LEAST_SPARSE_SIZE = 20
# A run without an end goes on to here: far enough, and the difference of two such times is finite.
FAR = 1e300


class Method(NamedTuple):
    """A method, and the options that have an effect on it."""

    name: str  # in the catalogue; empty where it is chosen by the problem
    options: frozenset[str]
    second_order: bool  # only for x'' = a(t, x)
    tightened: float = 1.0  # strict tolerances are multiplied by it


_COMMON = frozenset(
    "first_step max_step step max_steps rtol atol state mass second_order pairs names progress min_step".split()
)
_TOLERANCES = frozenset(("rtol", "atol"))
_IMPLICIT = _COMMON | {"jac", "jac_sparsity", "lband", "uband"}
_SCIPY = {
    "RK23": "bogacki_shampine3",
    "RK45": "dormand_prince5",
    "DOP853": "dop853",
    "Radau": "radau5",
    "BDF": "bdf",
    "LSODA": "tsitouras5_bdf",
}
# SciPy's Radau stays far below a strict tolerance, and its dense output with it. That of radau5 is less accurate than
# its steps: at the same strict tolerance it would not be as accurate as users of SciPy expect.
_TIGHTENED_RADAU = 0.4
_STRICT_RTOL = 1e-6


def _catalogue() -> dict[str, Method]:
    methods = {
        name: Method(name, _IMPLICIT if implicit else _COMMON, second_order)
        for name, _, _, second_order, implicit in _continuo.methods()
    }
    for name in methods:
        if "_" in name and name.split("_")[-1] in ("rodas5p", "radau", "bdf"):
            methods[name] = methods[name]._replace(options=_IMPLICIT)
    chosen = Method("", _IMPLICIT, False)
    scipy_names = {scipy: methods[ours] for scipy, ours in _SCIPY.items()}
    scipy_names["Radau"] = scipy_names["Radau"]._replace(tightened=_TIGHTENED_RADAU)
    return {**methods, **scipy_names, "auto": chosen}


METHODS = _catalogue()


def method_of(method: Any) -> Method:
    """Give the method of this name, or of one of the solver classes; None chooses by the problem."""
    if method is None:
        return METHODS["auto"]
    if isinstance(method, type):
        name: str = method.__name__
        is_scipys = method.__module__.startswith("scipy.") and name in _SCIPY
        method = name if is_scipys else getattr(method, "_method", name)
    if isinstance(method, str):
        found = METHODS.get(method) or METHODS.get(_continuo.canonical_name(method))
        if found is not None:
            return found
    raise ValueError(
        f"`method` must be one of {list(_SCIPY)}, a name of continuo's own methods ({', '.join(_own_names())}), "
        f"None, or one of the solver classes, and is {method!r}"
    )


def _own_names() -> list[str]:
    return [name for name in METHODS if name not in _SCIPY]


def warn_extraneous(options: dict[str, Any], method: Method, stacklevel: int = 3) -> None:
    """Warn of options without effect, as SciPy does."""
    without = [name for name in options if name not in method.options]
    if without:
        names = ", ".join(f"`{name}`" for name in without)
        warn(f"The following arguments have no effect for a chosen solver: {names}.", stacklevel=stacklevel + 1)


def state_of(y0: Any) -> Array:
    """Give y0 as an array of one dimension, of float64 or complex128."""
    y = np.asarray(y0)
    if y.ndim != 1:
        raise ValueError("`y0` must be 1-dimensional.")
    if y.dtype is _FLOAT and y.flags.c_contiguous:  # as most are: a call of a few steps takes little longer
        return y
    if y.dtype.kind not in "biufcO":
        raise TypeError(f"`y0` must consist of numbers, and is an array of {y.dtype}")
    return np.ascontiguousarray(y, dtype=complex if y.dtype.kind == "c" else float)


def numbers(name: str, value: Any) -> Array:
    """Give what is meant as an array of real numbers as one."""
    try:
        return np.asarray(value, dtype=float)
    except (TypeError, ValueError) as error:
        raise type(error)(f"`{name}` must be numbers, and is {value!r}: {error}") from None


def _number(name: str, value: Any) -> float:
    try:
        return float(value)
    except (TypeError, ValueError) as error:
        raise type(error)(f"`{name}` must be a number, and is {value!r}") from None


def _tolerance(name: str, value: Any) -> Array:
    tolerance = numbers(name, value)
    if np.any(np.isnan(tolerance)):
        raise ValueError(f"`{name}` must be numbers, and is {value!r}")
    return tolerance


def tolerances(rtol: Any, atol: Any, n: int, stacklevel: int = 3) -> tuple[Any, Any]:
    """Check the tolerances as SciPy does; each is a number, or one for each component."""
    if type(rtol) is not float or not rtol >= LEAST_RTOL:
        rtol = _tolerance("rtol", rtol)
        if np.any(rtol < LEAST_RTOL):
            warn(
                f"At least one element of `rtol` is too small. Setting `rtol = np.maximum(rtol, {LEAST_RTOL})`.",
                stacklevel=stacklevel + 1,
            )
            rtol = np.maximum(rtol, LEAST_RTOL)
        if rtol.ndim > 0 and rtol.shape != (n,):
            raise ValueError("`rtol` has wrong shape.")
        if rtol.ndim == 0:
            rtol = float(rtol)
    if type(atol) is not float or not atol >= 0:
        atol = _tolerance("atol", atol)
        if atol.ndim > 0 and atol.shape != (n,):
            raise ValueError("`atol` has wrong shape.")
        if np.any(atol < 0):
            raise ValueError("`atol` must be positive.")
        if atol.ndim == 0:
            atol = float(atol)
    return rtol, atol


def _steps(options: dict[str, Any], t0: float, t1: float, extras: dict[str, Any]) -> float:
    first_step = options.get("first_step")
    if first_step is not None:
        first_step = _number("first_step", first_step)
        if not first_step > 0:
            raise ValueError("`first_step` must be positive.")
        if first_step > abs(t1 - t0):
            raise ValueError("`first_step` exceeds bounds.")
        extras["first_step"] = first_step
    max_step = _number("max_step", options.get("max_step", np.inf))
    if not max_step > 0:
        raise ValueError("`max_step` must be positive.")
    min_step = options.get("min_step")
    if min_step is not None:
        extras["min_step"] = _number("min_step", min_step)
        if not extras["min_step"] >= 0:
            raise ValueError("`min_step` must be nonnegative.")
    for name in ("step", "max_steps"):
        value = options.get(name)
        if value is not None:
            extras[name] = _number(name, value)
            if not extras[name] > 0:
                raise ValueError(f"`{name}` must be positive.")
    return max_step


def _is_sparse(matrix: Any) -> bool:
    return hasattr(matrix, "tocoo") and hasattr(matrix, "toarray")


def _check_shape(matrix: Any, n: int, name: str) -> None:
    if tuple(matrix.shape) != (n, n):
        raise ValueError(f"`{name}` is expected to have shape {(n, n)}, but actually has {tuple(matrix.shape)}.")


def _as_real(matrix: Array) -> Array:
    """Give the real matrix that acts on (re, im, re, im, ...) as a complex one does on the numbers."""
    n = matrix.shape[0]
    real = np.empty((2 * n, 2 * n))
    real[0::2, 0::2] = real[1::2, 1::2] = matrix.real
    real[1::2, 0::2] = matrix.imag
    real[0::2, 1::2] = -matrix.imag
    return real


class PatternGrew(Exception):
    """A sparse Jacobian has an entry where the pattern has none."""

    def __init__(self, rows: Array, columns: Array) -> None:
        super().__init__(
            "`jac` gave an entry that was not stored in the first matrix: give `jac_sparsity` with all that may differ "
            "from zero"
        )
        self.places = rows, columns


class SparseJacobian:
    """A function that gives sparse matrices, as one that gives the entries of a pattern.

    The pattern is ordered by columns, then by rows, and contains the diagonal.
    """

    def __init__(self, jac: Callable[..., Any] | None, n: int, rows: Array, columns: Array) -> None:
        self._jac = jac
        self._n = n
        diagonal = np.arange(n)
        keys = np.concatenate([columns.astype(np.int64) * n + rows, diagonal * n + diagonal])
        self._keys = np.unique(keys)

    @property
    def pattern(self) -> tuple[Array, Array]:
        """The rows and the columns of the entries."""
        return (self._keys % self._n).astype(np.uint32), (self._keys // self._n).astype(np.uint32)

    def entries(self, matrix: Any) -> Array:
        """Give the entries of this matrix in the order of the pattern."""
        _check_shape(matrix, self._n, "jac")
        coo = matrix.tocoo()
        keys = coo.col.astype(np.int64) * self._n + coo.row
        places = np.searchsorted(self._keys, keys)
        places[places == len(self._keys)] = 0
        if np.any(self._keys[places] != keys):
            raise PatternGrew(coo.row, coo.col)
        values = np.zeros(len(self._keys))
        np.add.at(values, places, coo.data)
        return values

    def __call__(self, t: float, y: Array, *args: Any) -> Array:
        """Give the entries at (t, y)."""
        assert self._jac is not None
        matrix = self._jac(t, y, *args)
        if not _is_sparse(matrix):
            raise TypeError(f"`jac` gave a sparse matrix first, and now a {type(matrix).__name__}")
        return self.entries(matrix)


def _places(sparsity: Any, n: int) -> tuple[Array, Array]:
    matrix = sparsity if _is_sparse(sparsity) else np.asarray(sparsity)
    _check_shape(matrix, n, "jac_sparsity")
    if _is_sparse(matrix):
        coo = matrix.tocoo()
        return coo.row, coo.col
    rows, columns = np.nonzero(matrix)
    return rows, columns


def _band_places(n: int, lband: int, uband: int) -> tuple[Array, Array]:
    rows = np.concatenate([np.arange(max(0, j - uband), min(n, j + lband + 1)) for j in range(n)])
    counts = [min(n, j + lband + 1) - max(0, j - uband) for j in range(n)]
    return rows, np.repeat(np.arange(n), counts)


def whole_matrix(jac: Callable[..., Any], n: int, lband: int, uband: int) -> Callable[..., Array]:
    """Give the whole matrix of a Jacobian that LSODA takes packed: packed[i - j + uband, j] is entry (i, j)."""
    rows, columns = _band_places(n, lband, uband)

    def whole(t: float, y: Array, *args: Any) -> Array:
        packed = np.asarray(jac(t, y, *args))
        if packed.ndim != 2 or packed.shape[0] < lband + uband + 1 or packed.shape[1] != n:
            raise ValueError(
                f"`jac` gave a packed matrix of shape {packed.shape}, and must give {(lband + uband + 1, n)}"
            )
        matrix = np.zeros((n, n), packed.dtype)
        matrix[rows, columns] = packed[rows - columns + uband, columns]
        return matrix

    return whole


def _band(options: dict[str, Any], n: int, keeps_sparse: bool, extras: dict[str, Any]) -> Any:
    """Read the band of LSODA: its pattern, and `jac`, which is then packed, as one that gives whole matrices."""
    jac = options.get("jac")
    if options.get("lband") is None and options.get("uband") is None:
        return jac
    lower, upper = int(options.get("lband") or 0), int(options.get("uband") or 0)
    if lower < 0 or upper < 0:
        raise ValueError("`lband` and `uband` must not be negative.")
    if keeps_sparse and options.get("jac_sparsity") is None:
        extras["pattern"] = SparseJacobian(None, n, *_band_places(n, lower, upper)).pattern
    return whole_matrix(jac, n, lower, upper) if callable(jac) else jac


def _constant_jacobian(jac: Any, n: int, is_complex: bool, keeps_sparse: bool, extras: dict[str, Any]) -> None:
    matrix = jac if _is_sparse(jac) else np.asarray(jac, dtype=complex) if is_complex else numbers("jac", jac)
    _check_shape(matrix, n, "jac")
    if not np.all(np.isfinite(matrix.tocoo().data if _is_sparse(matrix) else matrix)):
        raise ValueError("`jac` must be finite.")
    if _is_sparse(matrix) and keeps_sparse:
        coo = matrix.tocoo()
        entries = SparseJacobian(None, n, coo.row, coo.col)
        extras.update(pattern=entries.pattern, jac_constant=entries.entries(matrix), jac_is_values=True)
    else:
        dense = np.asarray(matrix.toarray() if _is_sparse(matrix) else matrix)
        extras["jac_constant"] = _as_real(dense) if is_complex else np.ascontiguousarray(dense, dtype=float)


def _jacobian_function(jac: Any, first: Any, n: int, more: list[Any], extras: dict[str, Any]) -> None:
    """Read a function whose first matrix is sparse; `more` are the places of further entries that are known."""
    coo = first.tocoo()
    rows = np.concatenate([coo.row] + [places[0] for places in more])
    columns = np.concatenate([coo.col] + [places[1] for places in more])
    entries = SparseJacobian(jac, n, rows, columns)
    extras.update(pattern=entries.pattern, jac=entries, jac_is_values=True)


def _jacobian(options: dict[str, Any], t0: float, y: Array, args: Any, grown: Any, extras: dict[str, Any]) -> None:
    n = len(y)
    is_complex = y.dtype.kind == "c"
    keeps_sparse = n >= LEAST_SPARSE_SIZE and not is_complex
    jac = _band(options, n, keeps_sparse, extras)
    sparsity = options.get("jac_sparsity")
    places = None if sparsity is None else _places(sparsity, n)
    if places is not None and jac is None and keeps_sparse:
        extras["pattern"] = SparseJacobian(None, n, *places).pattern
    if jac is None or n == 0:
        return
    if not callable(jac):
        return _constant_jacobian(jac, n, is_complex, keeps_sparse, extras)
    first = jac(t0, y.copy(), *(args or ()))
    if first is not None and n > 1:
        _check_shape(first if _is_sparse(first) else np.asarray(first), n, "jac")
    if _is_sparse(first) and keeps_sparse:
        _jacobian_function(jac, first, n, [one for one in (grown, places) if one is not None], extras)
    else:
        extras["jac"] = jac


def _mass(mass: Any, n: int, is_complex: bool) -> Array | None:
    matrix = numbers("mass", mass.toarray() if _is_sparse(mass) else mass)
    if matrix.shape not in ((n,), (n, n)):
        raise ValueError(f"`mass` must have shape {(n, n)}, or {(n,)} for a diagonal, and has {matrix.shape}.")
    if not np.all(np.isfinite(matrix)):
        raise ValueError("`mass` must be finite.")
    if matrix.ndim == 2 and np.count_nonzero(matrix - np.diag(np.diagonal(matrix))) == 0:
        matrix = np.diagonal(matrix)
    if matrix.ndim == 1 and np.all(matrix == 1):
        return None
    if is_complex:
        matrix = np.repeat(matrix, 2) if matrix.ndim == 1 else np.kron(matrix, np.eye(2))
    return np.ascontiguousarray(matrix)


def _choose(n: int, rtol: Any, extras: dict[str, Any]) -> str:
    pattern = extras.get("pattern")
    sparse = pattern is not None and 10 * len(pattern[0]) < n * n
    least = rtol if type(rtol) is float else float(np.min(rtol))
    mass = extras.get("mass")
    if mass is not None and mass.ndim == 2:
        return "rodas5p" if least >= 1e-6 else "radau"
    algebraic = mass is not None
    return _continuo.choose_method(n, least, algebraic, "second_order" in extras, sparse, sparse)


def _names(given: Any, n: int) -> list[str]:
    names = list(given) if np.iterable(given) and not isinstance(given, str) else [None]
    if len(names) != n or not all(isinstance(name, str) for name in names):
        raise ValueError(f"`names` must be a list of {n} strings, one for each component of y0, and is {given!r}")
    return names


def _pairs(given: Any, n: int) -> list[tuple[int, int]]:
    pairs = np.asarray(given)
    if pairs.dtype.kind not in "iu" or pairs.ndim != 2 or pairs.shape[1] != 2 or np.any((pairs < 0) | (pairs >= n)):
        raise ValueError(
            f"`pairs` must be pairs of a position and its velocity, by numbers from 0 to {n - 1}, and is {given!r}"
        )
    return [(int(position), int(velocity)) for position, velocity in pairs]


def _extras(
    method: Method, options: dict[str, Any], t0: float, y: Array, args: Any, grown: Any, extras: dict[str, Any]
) -> None:
    """Read the options that few runs have."""
    state = options.get("state", "auto")
    if state not in ("auto", "array", "list"):
        raise ValueError(f"`state` must be 'auto', 'array' or 'list', and is {state!r}")
    extras["state"] = state
    progress = progress_function(options.get("progress"))
    if progress is not None:
        extras["progress"] = progress
    if options.get("names") is not None:
        extras["names"] = _names(options["names"], len(y))
    if options.get("second_order"):
        extras["second_order"] = True
    if options.get("pairs") is not None:
        extras["pairs"] = _pairs(options["pairs"], len(y))
    if options.get("mass") is not None:
        mass = _mass(options["mass"], len(y), y.dtype.kind == "c")
        if mass is not None:
            extras["mass"] = mass
    if "jac" in method.options:
        _jacobian(options, t0, y, args, grown, extras)


def _own_pattern(fun: RightHandSide, n: int, y: Array, extras: dict[str, Any]) -> None:
    """Take the places of the exact Jacobian that the equations have, unless another one is given."""
    if fun.n == n and y.dtype.kind != "c" and not {"jac", "jac_constant", "second_order"} & extras.keys():
        extras.update(pattern=fun.jacobian_pattern(), pattern_is_native=True)


def run_settings(
    fun: Any,
    t0: float,
    t1: float,
    y: Array,
    method: Method,
    options: dict[str, Any],
    times: Array | None = None,
    dense: bool = False,
    events: Any = None,
    vectorized: bool = False,
    args: Any = None,
    grown: tuple[Array, Array] | None = None,
) -> tuple[Any, ...]:
    """What `_continuo.Run` begins with, all of it checked."""
    fun = with_equations(fun)
    n = len(y)
    extras: dict[str, Any] = {}
    max_step = math.inf
    rtol, atol = options.get("rtol", 1e-3), options.get("atol", 1e-6)
    if not (type(rtol) is type(atol) is float and rtol >= LEAST_RTOL and atol >= 0):
        rtol, atol = tolerances(rtol, atol, n, 4)
    if method.tightened != 1 and np.min(rtol) < _STRICT_RTOL:
        rtol, atol = rtol * method.tightened, atol * method.tightened
    if not _TOLERANCES.issuperset(options):
        max_step = _steps(options, t0, t1, extras)
        _extras(method, options, t0, y, args, grown, extras)
    if events is not None:
        extras["events"] = event_fields(events)
    if vectorized:
        extras["vectorized"] = True
    if n >= LEAST_SPARSE_SIZE and "jac" in method.options and isinstance(fun, RightHandSide):
        _own_pattern(fun, n, y, extras)
    name = method.name or _choose(n, rtol, extras)
    if method.second_order and not ("second_order" in extras or "pairs" in extras):
        raise ValueError(
            f"`method`: {name} is for x'' = a(t, x): give `second_order=True` with a `fun` that returns accelerations, "
            "or `pairs` of a position and its velocity"
        )
    if math.isinf(t1):
        t1 = math.copysign(FAR, t1)
    return fun, t0, t1, y, name, rtol, atol, max_step, times, dense, args, extras


def begin_run(*settings: Any, **more: Any) -> _continuo.Run:
    """Begin a run of the settings that `run_settings` takes."""
    return _continuo.Run(*run_settings(*settings, **more))
