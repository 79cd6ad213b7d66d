"""Vehicles: bodies of a world on wheels with springs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

if TYPE_CHECKING:
    from .world import World

__all__ = ["Vehicle", "Wheel", "WheelState"]

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Wheel:
    """A disc on a spring. Its mass belongs to the body.

    Parameters
    ----------
    hub : array_like, shape (d,)
        Its centre with the spring at its full length, in the frame of the body's shape, which looks along its first
        axis; upwards is along its last one.
    radius : float
    travel : float
        By which the spring can be compressed; a stop ends it.
    stiffness, damping : float
        Of the spring, force per length and per speed.
    friction : float
        Of the tyre, combined with that of the ground.
    inertia : float
        The moment about the axle of all that turns.
    greatest_drive, greatest_brake : float
        The torques of motor and brake at their most.
    greatest_steer : float
        The angle at full steer, in radians to the left.
    top_spin : float
        That the motor reaches, in radians per time.
    """

    hub: ArrayLike
    radius: float = 0.35
    travel: float = 0.3
    stiffness: float = 30_000.0
    damping: float = 3_000.0
    friction: float = 1.0
    inertia: float = 1.2
    greatest_drive: float = 0.0
    greatest_brake: float = 1_500.0
    greatest_steer: float = 0.0
    top_spin: float = np.inf


class WheelState(NamedTuple):
    """How a wheel moves, and what it bears."""

    spin: float  # in radians per time, forwards positive; the turn of the body is a part of it
    turn: float  # against the body so far, in radians
    steer: float  # in radians to the left
    compression: float  # of the spring
    stiffness: float  # of the spring, as far as the step allows
    on_ground: bool
    centre: Floats
    point: Floats  # of the contact
    normal: Floats  # of the ground there
    ground: int | None  # the body that it touches, unless that is a wall or a mesh
    load: float  # force along the normal
    along: float  # force of friction forwards
    aside: float  # force of friction to the left, in space


class Vehicle:
    """A body on wheels, made by :meth:`World.add_vehicle`."""

    def __init__(self, world: World, inner: Any) -> None:
        self._world = world
        self._inner = inner

    @property
    def chassis(self) -> int:
        """The body on the wheels."""
        return int(self._inner.chassis())

    @property
    def wheels(self) -> list[WheelState]:
        """The wheels as they were when it was driven last; an empty list before."""
        return [WheelState(*state) for state in self._inner.states()]

    def drive(self, throttle: float = 0.0, brake: float = 0.0, steer: float = 0.0, h: float | None = None) -> None:
        """Finds the forces of the wheels for the next step. To be called before each.

        Parameters
        ----------
        throttle : float
            From -1, full backwards, to 1.
        brake : float
            From 0 to 1; who brakes does not drive.
        steer : float
            From -1, full to the right, to 1.
        h : float, optional
            The time of the step; by default that of the fast motion.

        Raises
        ------
        ValueError
            For controls out of these ranges, wheels that make no sense, or a chassis that was removed or is fixed.
        """
        duration = self._world._settings["step"] if h is None else float(h)
        self._world._inner.drive(self._inner, throttle, brake, steer, duration)

    def release(self) -> None:
        """Takes the forces of the wheels away, as before the chassis is removed."""
        self._world._inner.release(self._inner)

    def copy(self, world: World) -> Vehicle:
        """The same vehicle in a copy of its world, where it goes on to the same bits."""
        return Vehicle(world, self._inner.copy())

    def __repr__(self) -> str:
        return f"<continuo.Vehicle on body {self.chassis}>"


def wheel_fields(wheel: Wheel, dimension: int) -> tuple[Any, ...]:
    """For the module, which wants an array and numbers."""
    if not isinstance(wheel, Wheel):
        raise TypeError(f"{wheel!r} is no Wheel")
    hub = np.asarray(wheel.hub, dtype=float)
    if hub.shape != (dimension,):
        raise ValueError(f"the hub of a wheel has the shape {hub.shape}; it must be ({dimension},)")
    names = ("radius", "travel", "stiffness", "damping", "friction", "inertia", "greatest_drive", "greatest_brake")
    return (hub, *(float(getattr(wheel, name)) for name in (*names, "greatest_steer", "top_spin")))


def make(world: World, chassis: int, wheels: Sequence[Wheel], dimension: int) -> Vehicle:
    """What World.add_vehicle does."""
    return Vehicle(world, world._inner.vehicle(chassis, [wheel_fields(wheel, dimension) for wheel in wheels]))
