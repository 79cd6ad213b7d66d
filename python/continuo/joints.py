"""Joints of a world: what they bear, and what of them can be changed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

if TYPE_CHECKING:
    from .world import World

__all__ = ["Joint", "Limits", "Motor", "Spring"]

Floats = NDArray[np.float64]


class Limits(NamedTuple):
    """The range of a joint's coordinate, an angle in radians or a length."""

    lower: float = -np.inf
    upper: float = np.inf


class Spring(NamedTuple):
    """A spring towards a value of the coordinate."""

    hertz: float  # the undamped frequency, with the masses that the joint connects
    damping: float = 1.0  # the ratio: 1 is critical
    rest: float = 0.0  # the value of the coordinate; of distances and wheels, beyond that of the beginning


class Motor(NamedTuple):
    """A motor that drives the coordinate at a speed; a speed of 0 is a brake."""

    speed: float  # in radians or length per time
    most: float = np.inf  # the greatest force or torque


class Joint:
    """A joint of a world, by :meth:`World.joint`. What is read is that of the present state of the world."""

    def __init__(self, world: World, number: int) -> None:
        self._world = world
        self._number = number

    def _facts(self) -> dict[str, Any]:
        return self._world._inner.joint(self._number)

    @property
    def kind(self) -> str:
        """'hinge', 'ball', 'slider', 'weld', 'distance', 'wheel', 'universal', 'gear' or 'pull'."""
        return str(self._facts()["kind"])

    @property
    def bodies(self) -> tuple[int | None, int]:
        """Bodies a and b; a is None where it is the world."""
        facts = self._facts()
        return facts["a"], facts["b"]

    @property
    def coordinate(self) -> float:
        """The angle of a hinge in radians, the way of a slider or a wheel, a distance; 0 of other joints."""
        return float(self._facts()["coordinate"])

    @property
    def force(self) -> Floats:
        """On body b in the last step, shape (d,)."""
        force: Floats = self._facts()["force"]
        return force

    @property
    def torque(self) -> Floats:
        """On body b about its anchor in the last step, shape (3,), in the plane (1,)."""
        torque: Floats = self._facts()["torque"]
        return torque

    @property
    def motor_effort(self) -> float:
        """The force or torque of the motor in the last step."""
        return float(self._facts()["motor_effort"])

    @property
    def broken(self) -> bool:
        """Whether its strength was exceeded: then it acts no more."""
        return bool(self._facts()["broken"])

    @property
    def limits(self) -> Limits | None:
        """Of the coordinate; they can be set, also to None."""
        limits = self._facts()["limits"]
        return None if limits is None else Limits(*limits)

    @limits.setter
    def limits(self, value: tuple[float, float] | None) -> None:
        self._world._inner.set_limits(self._number, None if value is None else numbers("limits", value, 2))

    @property
    def spring(self) -> Spring | None:
        """Of the coordinate; it can be set, also to None."""
        spring = self._facts()["spring"]
        return None if spring is None else Spring(*spring)

    @spring.setter
    def spring(self, value: Spring | None) -> None:
        self._world._inner.set_spring(self._number, None if value is None else numbers("spring", value, 3))

    @property
    def motor(self) -> Motor | None:
        """Of the coordinate, of a wheel about the axle; it can be set, also to None."""
        motor = self._facts()["motor"]
        return None if motor is None else Motor(*motor)

    @motor.setter
    def motor(self, value: Motor | tuple[float, float] | None) -> None:
        self._world._inner.set_motor(self._number, None if value is None else numbers("motor", value, 2))

    @property
    def breaks_at(self) -> float:
        """The force beyond which it breaks; of a 'pull' the greatest. It can be set."""
        return float(self._facts()["breaks_at"])

    @breaks_at.setter
    def breaks_at(self, value: float) -> None:
        self._world._inner.set_breaks_at(self._number, float(value))

    @property
    def target(self) -> Floats:
        """Of a 'pull': where the anchor of b is drawn to. It can be set."""
        target: Floats = self._facts()["target"]
        return target

    @target.setter
    def target(self, value: ArrayLike) -> None:
        self._world._inner.set_target(self._number, np.asarray(value, dtype=float))

    def __repr__(self) -> str:
        return f"<continuo.Joint: {self.kind} {self._number}>"


def numbers(name: str, value: Any, count: int) -> list[float]:
    """So many numbers, of a tuple that may be one of the above."""
    try:
        made = [float(number) for number in value]
    except (TypeError, ValueError):
        raise TypeError(f"{name} is {value!r}; it must be {count} numbers") from None
    if len(made) != count:
        raise ValueError(f"{name} has {len(made)} numbers; it must have {count}")
    return made
