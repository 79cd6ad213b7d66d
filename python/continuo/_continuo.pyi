"""What the package calls in C++."""

from typing import Any

import numpy.typing as npt

Array = npt.NDArray[Any]

__version__: str

class DenseSolution:
    """The dense output of a run, called with a time or an array of times."""

    def __call__(self, t: npt.ArrayLike) -> Array: ...
    def __len__(self) -> int: ...
    def piece(self, number: int) -> DenseSolution: ...
    @property
    def ts(self) -> Array: ...
    @property
    def n(self) -> int: ...

class Native:
    """A compiled right-hand side, which a run calls without the interpreter."""

    def __init__(
        self, address: int, jacobian: int = 0, user: int = 0, size: int | None = None, owner: object = None
    ) -> None: ...
    @property
    def address(self) -> int: ...
    @property
    def jacobian(self) -> int: ...
    @property
    def user(self) -> int: ...
    @property
    def size(self) -> int | None: ...
    @property
    def owner(self) -> object: ...

class Run:
    """A run of one right-hand side."""

    def __init__(
        self,
        fun: object,
        t0: float,
        t1: float,
        y0: Array,
        method: str,
        rtol: float | Array,
        atol: float | Array,
        max_step: float,
        times: Array | None,
        dense: bool,
        args: tuple[Any, ...] | None,
        extras: dict[str, Any],
    ) -> None: ...
    def run(self) -> None: ...
    def check(self) -> None: ...
    def step(self) -> bool: ...
    def take_error(self) -> BaseException | None: ...
    def times(self) -> Array: ...
    def states(self) -> Array: ...
    def dense(self) -> DenseSolution: ...
    def events(self) -> tuple[tuple[Array, Array, Array], ...]: ...
    def summary(self) -> tuple[int, str, str, int, int, int, str, int, int]: ...
    def y_at(self, t: float) -> Array: ...
    def last_piece(self, t_old: float) -> DenseSolution: ...
    def set_state(self, y: Array) -> None: ...
    def restart(self) -> None: ...
    def extend_to(self, t1: float) -> None: ...
    @property
    def t(self) -> float: ...
    @property
    def y(self) -> Array: ...
    @property
    def native(self) -> bool: ...

class State:
    """The state in a call of a function: a sequence of numbers that does what an array does."""

def methods() -> list[tuple[str, int, int, bool, bool]]: ...
def canonical_name(name: str) -> str: ...
def choose_method(
    size: int,
    rtol: float,
    algebraic: bool = False,
    accelerations: bool = False,
    sparse: bool = False,
    banded: bool = False,
) -> str: ...
from collections.abc import Callable
from typing import Any

from numpy.typing import ArrayLike, NDArray

__version__: str

def solve_bvp(
    fun: Callable[..., ArrayLike],
    bc: Callable[..., ArrayLike],
    x: NDArray[Any],
    y: NDArray[Any],
    p: NDArray[Any],
    S: NDArray[Any],
    first_value: NDArray[Any],
    first_derivative: NDArray[Any],
    fun_jac: Callable[..., Any] | None,
    bc_jac: Callable[..., Any] | None,
    tol: float,
    bc_tol: float,
    max_nodes: int,
    progress: Callable[[int, float, float, int, int, bool], None] | None,
) -> dict[str, Any]: ...
def evaluate_cubics(
    x: NDArray[Any], c: NDArray[Any], points: NDArray[Any], nu: int, extrapolate: bool
) -> NDArray[Any]: ...
