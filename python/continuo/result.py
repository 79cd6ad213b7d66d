"""What the solvers return: a dictionary whose entries are attributes as well, printed as SciPy's."""

from __future__ import annotations

from typing import Any

import numpy as np


def _number(x: Any) -> str:
    if np.isposinf(x):
        return "       inf"
    if np.isneginf(x):
        return "      -inf"
    if np.isnan(x):
        return "       nan"
    return np.format_float_scientific(x, precision=3, pad_left=2, unique=False)


class Result(dict[str, Any]):
    """A dictionary with its entries as attributes, as the results of SciPy are.

    Examples
    --------
    >>> Result(status=0, success=True).success
    True
    """

    def __getattr__(self, name: str) -> Any:
        try:
            return self[name]
        except KeyError:
            raise AttributeError(f"a {type(self).__name__} has no entry {name!r}: {', '.join(self)}") from None

    def __setattr__(self, name: str, value: Any) -> None:
        self[name] = value

    def __delattr__(self, name: str) -> None:
        try:
            del self[name]
        except KeyError:
            raise AttributeError(name) from None

    def __dir__(self) -> list[str]:
        return list(self.keys())

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (), None, None, iter(self.items())

    def __repr__(self) -> str:
        if not self:
            return type(self).__name__ + "()"
        order = ("message", "outcome", "success", "status", "t", "y", "sol", "t_events", "y_events")
        keys = [key for key in order if key in self] + [key for key in self if key not in order]
        width = max(map(len, keys)) + 1
        lines = []
        for key in keys:
            with np.printoptions(
                linewidth=76 - width, edgeitems=2, threshold=12, formatter={"float_kind": _number}
            ):
                text = str(self[key])
            lines.append(key.rjust(width) + ": " + text.replace("\n", "\n" + " " * (width + 2)))
        return "\n".join(lines)


class OdeResult(Result):
    """The result of a run.

    Attributes
    ----------
    t : ndarray, shape (n_points,)
        The times of the states: every step, or those of `t_eval`.
    y : ndarray, shape (n, n_points)
        The states at these times. Where an action changes the state, its time is there twice.
    sol : OdeSolution or None
        The solution as a function of time, with ``dense_output=True``.
    t_events : list of ndarray or None
        For each event its times.
    y_events : list of ndarray or None
        For each event the states at its times, before its action; shape (k, n).
    y_after_events : list of ndarray or None
        The same after its action. Only where an event has one.
    nfev, njev, nlu : int
        Evaluations of the right-hand side (without those for differences), of the Jacobian, LU decompositions.
    status : int
        0: the end was reached; 1: an event ended the run; -1: the run failed.
    message : str
        The reason in SciPy's words where there are any.
    outcome : str
        The reason, its place and a remedy.
    success : bool
        Whether ``status >= 0``.
    """
