"""Boundary-value problems with SciPy's interface: solve_bvp and the cubic spline that it returns."""

import warnings
from collections.abc import Callable
from math import inf, isfinite
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _continuo
from .result import Result
from .right_hand_side import with_equations

__all__ = ["BVPResult", "CubicSolution", "solve_bvp"]

_EPS = float(np.finfo(float).eps)

_MESSAGES = {
    0: "The algorithm converged to the desired accuracy.",
    1: "The maximum number of mesh nodes is exceeded.",
    2: "A singular Jacobian encountered when solving the collocation system.",
    3: "The solver was unable to satisfy boundary conditions tolerance on iteration 10.",
    4: "{quantity} is infinite or not a number{where}.",
    5: "The mesh cannot be refined near x = {x:.17g}: its nodes would be equal.",
    6: "The conditions do not determine a solution: its estimated error is as large as itself.",
}

_REPORTS = {
    0: "Solved in {iteration} iterations, number of nodes {nodes}. ",
    1: "Number of nodes is exceeded after iteration {iteration}. ",
    2: "Singular Jacobian encountered when solving the collocation system on iteration {iteration}. ",
    3: "The solver was unable to satisfy boundary conditions tolerance on iteration {iteration}. ",
    4: "A value that is infinite or not a number was encountered on iteration {iteration}. ",
    5: "The mesh cannot be refined further after iteration {iteration}. ",
    6: "No solution is determined, after iteration {iteration}. ",
}


class BVPResult(Result):
    """The result of `solve_bvp`: a dictionary whose entries are attributes as well."""


class CubicSolution:
    """A solution as a continuously differentiable cubic spline, with the interface of `scipy.interpolate.PPoly`.

    Attributes
    ----------
    x : ndarray, shape (m,)
        The nodes.
    c : ndarray, shape (4, m - 1, n)
        The coefficients: ``sum(c[k, j] * (x - x[j])**(3 - k) for k in range(4))`` in interval j.
    axis : int
        1: the axis of the values that belongs to x.
    extrapolate : bool
        True: outside the nodes the first and the last cubic are used.
    """

    axis = 1
    extrapolate = True

    def __init__(self, x: NDArray[Any], c: NDArray[Any]) -> None:
        self.x = x
        self.c = c

    def __call__(self, x: ArrayLike, nu: int = 0, extrapolate: bool | str | None = None) -> NDArray[Any]:
        """Evaluate the solution or a derivative of it.

        Parameters
        ----------
        x : array_like
            Points.
        nu : int, optional
            Order of the derivative, not negative.
        extrapolate : bool or 'periodic', optional
            What points outside the nodes give: True (default) the continuation of the cubic, False NaN,
            'periodic' the value at the point moved by periods.

        Returns
        -------
        y : ndarray, shape (n,) + shape of x
            The values.
        """
        points = np.asarray(x, dtype=float)
        if nu < 0:
            raise ValueError("`nu`, the order of the derivative, must not be negative.")
        if extrapolate is None:
            extrapolate = self.extrapolate
        if extrapolate == "periodic":
            points = self.x[0] + (points - self.x[0]) % (self.x[-1] - self.x[0])
            extrapolate = False
        values = _continuo.evaluate_cubics(self.x, self.c, points.ravel(), int(nu), bool(extrapolate))
        return values.reshape(values.shape[:1] + points.shape)

    def ppoly(self) -> Any:
        """Return the same as a `scipy.interpolate.PPoly`.

        Returns
        -------
        spline : scipy.interpolate.PPoly
            SciPy must be installed.
        """
        try:
            from scipy.interpolate import PPoly
        except ImportError as missing:
            raise ImportError("a scipy.interpolate.PPoly needs SciPy: python3 -m pip install scipy") from missing
        return PPoly.construct_fast(self.c, self.x, extrapolate=self.extrapolate, axis=self.axis)

    def derivative(self, nu: int = 1) -> Any:
        """Return the derivative of order `nu` as a `scipy.interpolate.PPoly`."""
        return self.ppoly().derivative(nu)

    def antiderivative(self, nu: int = 1) -> Any:
        """Return the antiderivative of order `nu` as a `scipy.interpolate.PPoly`."""
        return self.ppoly().antiderivative(nu)

    def integrate(self, a: float, b: float, extrapolate: bool | str | None = None) -> Any:
        """Return the integral from `a` to `b`, shape (n,), by `scipy.interpolate.PPoly.integrate`."""
        return self.ppoly().integrate(a, b, extrapolate)

    def solve(self, y: float = 0.0, discontinuity: bool = True, extrapolate: bool | str | None = None) -> Any:
        """Return where each component is `y`, by `scipy.interpolate.PPoly.solve`."""
        return self.ppoly().solve(y, discontinuity, extrapolate)

    def roots(self, discontinuity: bool = True, extrapolate: bool | str | None = None) -> Any:
        """Return the zeros of each component, by `scipy.interpolate.PPoly.roots`."""
        return self.ppoly().roots(discontinuity, extrapolate)


def _checked_mesh(x: ArrayLike) -> NDArray[Any]:
    mesh = np.array(x, dtype=float, order="C")
    if mesh.ndim != 1:
        raise ValueError("`x` must be 1 dimensional.")
    if mesh.shape[0] < 2:
        raise ValueError("`x` must contain at least two nodes: the ends of the interval.")
    if not (mesh[1:] > mesh[:-1]).all():
        raise ValueError("`x` must be strictly increasing.")
    if not (isfinite(mesh[0]) and isfinite(mesh[-1])):
        raise ValueError("`x` must be finite.")
    return mesh


def _checked_guess(y: ArrayLike, columns: int) -> NDArray[Any]:
    given = np.asarray(y)
    dtype = complex if given.dtype.kind == "c" else float
    guess: NDArray[Any] = np.array(given, dtype=dtype, order="C")
    if guess.ndim != 2:
        raise ValueError("`y` must be 2 dimensional.")
    if guess.shape[1] != columns:
        raise ValueError(f"`y` is expected to have {columns} columns, but actually has {guess.shape[1]}.")
    if guess.shape[0] == 0:
        raise ValueError("`y` must have at least one row: a component of the solution.")
    if not np.isfinite(guess).all():
        raise ValueError("`y`, where the iteration begins, must be finite.")
    return guess


def _checked_parameters(p: ArrayLike | None, dtype: Any) -> NDArray[Any]:
    if p is None:
        return np.empty(0, dtype)
    parameters: NDArray[Any] = np.array(p, dtype=dtype, order="C")
    if parameters.ndim != 1:
        raise ValueError("`p` must be 1 dimensional.")
    if not np.isfinite(parameters).all():
        raise ValueError("`p`, where the iteration begins, must be finite.")
    return parameters


def _checked_singular_term(S: ArrayLike | None, n: int, dtype: Any) -> NDArray[Any]:
    if S is None:
        return np.empty((0, 0), dtype)
    matrix: NDArray[Any] = np.array(S, dtype=dtype, order="C")
    if matrix.shape != (n, n):
        raise ValueError(f"`S` is expected to have shape {(n, n)}, but actually has {matrix.shape}")
    if not np.isfinite(matrix).all():
        raise ValueError("`S` must be finite.")
    return matrix


def _checked_tolerance(name: str, value: float) -> float:
    if not isinstance(value, (int, float, np.number, np.ndarray)):
        raise TypeError(f"`{name}` must be a number, and is {value!r}")
    value = float(value)
    if not 0 < value < inf:
        raise ValueError(f"`{name}` must be positive and finite, and is {value}")
    return value


def _check_functions(**functions: Any) -> None:
    for name, function in functions.items():
        if not callable(function) and not isinstance(function, (_continuo.Native, tuple)):
            raise TypeError(f"`{name}` must be a function, and is {function!r}")


def _print_progress(iteration: int, residual: float, condition: float, nodes: int, added: int, exceeds: bool) -> None:
    print(f"{iteration:^15}{residual:^15.2e}{condition:^15.2e}{nodes:^15}{f'({added})' if exceeds else added:^15}")


def _message(found: dict[str, Any]) -> str:
    i, x = found["component"], found["where"]
    quantity, where = {
        0: (f"Component {i} of `fun`", f" at x = {x:.8g}"),
        1: (f"Component {i} of `bc`", ""),
        2: ("A derivative of `fun` or `bc`", ", in the solution as far as found"),
    }[found["quantity"]]
    return _MESSAGES[found["ending"]].format(quantity=quantity, where=where, x=x)


def solve_bvp(
    fun: Any,
    bc: Callable[..., ArrayLike],
    x: ArrayLike,
    y: ArrayLike,
    p: ArrayLike | None = None,
    S: ArrayLike | None = None,
    fun_jac: Callable[..., Any] | None = None,
    bc_jac: Callable[..., Any] | None = None,
    tol: float = 1e-3,
    max_nodes: int = 1000,
    verbose: int = 0,
    bc_tol: float | None = None,
) -> BVPResult:
    """Solve a boundary-value problem with conditions at two points, as `scipy.integrate.solve_bvp` does.

    The problem is::

        dy / dx = f(x, y, p) + S y / (x - a),  a <= x <= b
        bc(y(a), y(b), p) = 0

    with n components of y, k unknown parameters p and n + k conditions. The method is collocation of fourth
    order with control of the residual; meshes and iterations are those of SciPy, until a mesh is accepted:
    residuals near the tolerance are then found by more points.

    Parameters
    ----------
    fun : callable
        ``fun(x, y)``, or ``fun(x, y, p)`` where there are parameters: the right-hand side at many points at
        once. x has shape (m,), y shape (n, m), p shape (k,); it returns an array of shape (n, m). Column q
        must depend on ``x[q]`` and ``y[:, q]`` only. For derivatives by differences it is called with
        points that repeat; a function that cannot take these is called component by component instead.
        Or a compiled function, as `solve_ivp` takes it: traced, an expression, a cfunc of numba, a
        ``scipy.LowLevelCallable``, a ctypes function. It gets one point at a time, y followed by p as its
        components, of which those of p have the derivative 0; its own Jacobian is taken where it has one.
    bc : callable
        ``bc(ya, yb)`` or ``bc(ya, yb, p)``: the residuals of the conditions, shape (n + k,).
    x : array_like, shape (m,)
        The first mesh, strictly increasing from a to b; at least two nodes.
    y : array_like, shape (n, m)
        The solution's guess at its nodes. Where it is complex the problem is: f and bc must then be
        differentiable as complex functions.
    p : array_like, shape (k,), optional
        The guess of the parameters.
    S : array_like, shape (n, n), optional
        The singular term. The solution must satisfy S y(a) = 0, which is forced in the iteration.
    fun_jac : callable, optional
        ``fun_jac(x, y)`` returns df_dy of shape (n, n, m): df_i/dy_j at point q; ``fun_jac(x, y, p)``
        returns df_dy and df_dp of shape (n, k, m). By forward differences if None.
    bc_jac : callable, optional
        ``bc_jac(ya, yb)`` returns dbc_dya and dbc_dyb of shape (n + k, n); ``bc_jac(ya, yb, p)`` in addition
        dbc_dp of shape (n + k, k). By forward differences if None.
    tol : float, optional
        Of the residual ``r = y' - f(x, y)`` of the spline: the root mean square over each interval of the
        norm of ``r / (1 + abs(f))`` must be below it.
    max_nodes : int, optional
        The most nodes a mesh may have.
    verbose : {0, 1, 2}, optional
        0: silent; 1: a report at the end; 2: a line for each mesh as well.
    bc_tol : float, optional
        Of each ``abs(bc)``; `tol` if None.

    Returns
    -------
    result : BVPResult
        With the entries

        sol : CubicSolution
            y(x) as a spline: ``sol(x)`` of shape (n,) + x.shape, ``sol(x, 1)`` its derivative.
        p : ndarray, shape (k,), or None
            The parameters.
        x : ndarray, shape (m,)
            The nodes of the last mesh.
        y, yp : ndarray, shape (n, m)
            The solution and its derivative at the nodes.
        rms_residuals : ndarray, shape (m - 1,)
            The residual of each interval.
        niter : int
            The number of meshes.
        status : int
            0: solved; 1: more than `max_nodes` needed; 2: a singular Jacobian; 3: `bc_tol` not reached;
            4: `fun`, `bc` or a derivative is infinite or not a number; 5: nodes would be equal; 6: the
            residuals are small but may make all of the solution, as where there is none or there are many.
        message : str
            The same in words.
        success : bool
            Whether it is solved: status 0.

    Raises
    ------
    ValueError
        Arguments, or arrays returned by the functions, of a wrong shape.
    TypeError
        A function returned something that is no array of numbers.

    Notes
    -----
    Exceptions of the functions pass through, Ctrl-C ends the run at once. The collocation equations are
    solved without the lock of the interpreter, which is taken for calls of the functions.

    References
    ----------
    .. [1] J. Kierzenka, L. F. Shampine, "A BVP solver based on residual control and the MATLAB PSE", ACM
       Trans. Math. Softw. 27 (2001) 299-316.

    Examples
    --------
    Bratu's equation y'' + exp(y) = 0 with y(0) = y(1) = 0:

    >>> import numpy as np
    >>> from continuo import solve_bvp
    >>> def fun(x, y):
    ...     return np.vstack((y[1], -np.exp(y[0])))
    >>> def bc(ya, yb):
    ...     return np.array([ya[0], yb[0]])
    >>> result = solve_bvp(fun, bc, np.linspace(0, 1, 5), np.zeros((2, 5)))
    >>> bool(abs(result.sol(0.5)[0] - 0.1405) < 1e-4)
    True
    """
    fun = with_equations(fun)
    _check_functions(fun=fun, bc=bc)
    _check_functions(fun_jac=fun if fun_jac is None else fun_jac, bc_jac=bc if bc_jac is None else bc_jac)
    mesh = _checked_mesh(x)
    guess = _checked_guess(y, mesh.shape[0])
    parameters = _checked_parameters(p, guess.dtype)
    tol = _checked_tolerance("tol", tol)
    if tol < 100 * _EPS:
        warnings.warn(f"`tol` is too low, setting to {100 * _EPS:.2e}", stacklevel=2)
        tol = 100 * _EPS
    if not isinstance(max_nodes, (int, float, np.number)) or not max_nodes >= 0:
        raise ValueError(f"`max_nodes` must be a number that is not negative, and is {max_nodes!r}")
    if verbose not in [0, 1, 2]:
        raise ValueError("`verbose` must be in [0, 1, 2].")
    if verbose == 2:
        print("".join(f"{title:^15}" for title in (
            "Iteration", "Max residual", "Max BC residual", "Total nodes", "Nodes added")))
    found = _continuo.solve_bvp(
        fun, bc, mesh, guess, parameters, _checked_singular_term(S, guess.shape[0], guess.dtype), fun_jac, bc_jac,
        tol, tol if bc_tol is None else _checked_tolerance("bc_tol", bc_tol), int(max_nodes),
        _print_progress if verbose == 2 else None)
    status = found["ending"]
    if verbose > 0:
        print(_REPORTS[status].format(iteration=found["niter"], nodes=found["x"].shape[0]))
        print(f"Maximum relative residual: {found['residual']:.2e} ")
        print(f"Maximum boundary residual: {found['condition']:.2e}")
    return BVPResult(
        sol=CubicSolution(found["x"], found["c"]), p=found["p"] if parameters.size > 0 else None, x=found["x"],
        y=found["y"], yp=found["yp"], rms_residuals=found["rms_residuals"], niter=found["niter"], status=status,
        message=_message(found), success=status == 0)
