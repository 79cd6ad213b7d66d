"""Solutions as functions of time, with the names and shapes of SciPy's."""

from __future__ import annotations

from typing import Any, Sequence

import numpy as np
import numpy.typing as npt

from ._continuo import DenseSolution

Array = npt.NDArray[Any]


class DenseOutput:
    """The solution over one step.

    Attributes
    ----------
    t_old, t : float
        The ends of the step in the direction of time.
    t_min, t_max : float
        The same in ascending order.
    """

    def __init__(self, t_old: float, t: float) -> None:
        self.t_old = t_old
        self.t = t
        self.t_min = min(t, t_old)
        self.t_max = max(t, t_old)

    def __call__(self, t: npt.ArrayLike) -> Array:
        """Give the state: shape (n,) for a number, (n, n_points) for an array of times of shape (n_points,)."""
        times = np.asarray(t)
        if times.ndim > 1:
            raise ValueError("`t` must be a float or a 1-D array.")
        return self._call_impl(times)

    def _call_impl(self, t: Array) -> Array:
        raise NotImplementedError


class ConstantDenseOutput(DenseOutput):
    """A state that stays: of a run of no length, or of no components."""

    def __init__(self, t_old: float, t: float, value: Array) -> None:
        super().__init__(t_old, t)
        self.value = value

    def _call_impl(self, t: Array) -> Array:
        if t.ndim == 0:
            return self.value
        return np.repeat(self.value[:, None], t.shape[0], axis=1)


class StepDenseOutput(DenseOutput):
    """The polynomial of a step."""

    def __init__(self, t_old: float, t: float, piece: DenseSolution) -> None:
        super().__init__(t_old, t)
        self._piece = piece

    def _call_impl(self, t: Array) -> Array:
        return self._piece(t)


class OdeSolution:
    """A solution of several steps, continued beyond its ends by the first and the last one.

    Parameters
    ----------
    ts : array_like, shape (n_segments + 1,)
        The ends of the steps, ascending or descending.
    interpolants : list of DenseOutput
        One for each step.

    Attributes
    ----------
    ts : ndarray
        As given.
    interpolants : list of DenseOutput
        As given.
    t_min, t_max : float
        The first and the last time in ascending order.
    n_segments : int
        The number of steps.

    Notes
    -----
    At the end of a step the value is that of this step, not of the next: where the action of an event changes the
    state, it is the state before.
    """

    def __init__(self, ts: npt.ArrayLike, interpolants: Sequence[DenseOutput]) -> None:
        self.ts = np.asarray(ts)
        differences = np.diff(self.ts)
        if not (np.all(differences >= 0) or np.all(differences <= 0)):
            raise ValueError("`ts` must be in ascending or descending order.")
        self.n_segments = len(interpolants)
        if self.ts.shape != (self.n_segments + 1,):
            raise ValueError("Numbers of time stamps and interpolants don't match.")
        self._dense: DenseSolution | None = None
        self._interpolants: list[DenseOutput] | None = list(interpolants)
        self._set_bounds()

    @classmethod
    def _of(cls, dense: DenseSolution) -> OdeSolution:
        solution = cls.__new__(cls)
        solution._dense = dense
        solution._interpolants = None
        solution.ts = dense.ts
        solution.n_segments = len(dense)
        solution._set_bounds()
        return solution

    def _set_bounds(self) -> None:
        self.ascending = bool(self.ts[-1] >= self.ts[0])
        self.t_min = self.ts[0] if self.ascending else self.ts[-1]
        self.t_max = self.ts[-1] if self.ascending else self.ts[0]

    @property
    def interpolants(self) -> list[DenseOutput]:
        """The steps one by one."""
        if self._interpolants is None:
            assert self._dense is not None
            self._interpolants = [
                StepDenseOutput(self.ts[i], self.ts[i + 1], self._dense.piece(i)) for i in range(self.n_segments)
            ]
        return self._interpolants

    def __call__(self, t: npt.ArrayLike) -> Array:
        """Give the state at t.

        Parameters
        ----------
        t : float or array_like, shape (n_points,)
            The time, in any order, within the run or beyond it.

        Returns
        -------
        ndarray, shape (n,) or (n, n_points)
        """
        if self._dense is not None:
            return self._dense(t)
        times = np.asarray(t)
        if times.ndim > 1:
            raise ValueError("`t` must be a float or a 1-D array.")
        if times.ndim == 0:
            return self.interpolants[int(self._segments(times[None])[0])](t)
        segments = self._segments(times)
        columns = [self.interpolants[int(k)](time) for k, time in zip(segments, times)]
        return np.array(columns).T

    def _segments(self, t: Array) -> Array:
        ts = self.ts if self.ascending else self.ts[::-1]
        found = np.searchsorted(ts, t, side="left" if self.ascending else "right") - 1
        found = np.clip(found, 0, self.n_segments - 1)
        return found if self.ascending else self.n_segments - 1 - found
