"""Rigid bodies and joints: added by arrays, moved exactly or in steps, seen through NumPy views."""

from __future__ import annotations

import weakref
from collections.abc import Iterable, Sequence
from dataclasses import astuple, dataclass
from typing import Any, Literal, NamedTuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _continuo, shapes
from .joints import Joint, Motor, Spring, numbers
from .vehicles import Vehicle, Wheel, make

__all__ = ["Character", "Contacts", "Near", "RayHit", "RayHits", "Touched", "World"]

Floats = NDArray[np.float64]
_Inner = Union[_continuo.World2, _continuo.World3]
_CHANGES = np.array(["impact", "begin", "end"])


class RayHit(NamedTuple):
    """Where a ray, or a shape that moves, meets a body, a wall or a mesh."""

    body: int | None
    wall: int | None
    distance: float
    point: Floats
    normal: Floats
    mesh: int | None = None


class RayHits(NamedTuple):
    """The first hit of each of N rays, as arrays; what was not hit is -1, and the distance infinite."""

    body: NDArray[np.int64]
    wall: NDArray[np.int64]
    distance: Floats
    point: Floats
    normal: Floats
    mesh: NDArray[np.int64]


class Touched(NamedTuple):
    """What a shape touches."""

    bodies: list[int]
    walls: list[int]
    meshes: list[int]


class Near(NamedTuple):
    """A surface near a shape, by the points of both that are closest."""

    body: int | None
    wall: int | None
    distance: float  # of both surfaces, below 0 where they overlap
    point: Floats  # in the middle between them
    normal: Floats  # of the other surface, towards the shape
    mesh: int | None


@dataclass(frozen=True)
class Character:
    """An upright capsule that walks, see :meth:`World.walk`.

    Parameters
    ----------
    position : array_like, shape (d,)
        Of its lowest point.
    rise : float
        Its speed upwards; a greater one than 0 makes it jump.
    """

    position: ArrayLike
    rise: float = 0.0
    on_ground: bool = False
    normal: Floats | None = None  # of the ground on which it stands
    ground: int | None = None  # the body on which it stands, unless that is a wall or a mesh
    local_foot: Floats | None = None
    foot: Floats | None = None


class Contacts(NamedTuple):
    """The contacts of the last move, as arrays with an entry for each."""

    time: Floats
    change: NDArray[np.str_]  # 'impact'; of contacts that last 'begin' and 'end'
    a: NDArray[np.int64]  # a body
    b: NDArray[np.int64]  # the other one; -1 where it is a wall
    wall: NDArray[np.int64]  # -1 where it is a body
    point: Floats
    normal: Floats  # from a to b, or into the wall
    impulse: Floats  # along the normal
    lost: int  # how many there were beside, which were not recorded


class World:
    """Bodies, walls and forces, and the motion that moves them.

    The units are yours, as long as they belong together. `positions`, `velocities`, `spins` and
    `orientations` are views without copies: what is written there is true from the next move on. When bodies
    are added or removed, views that were taken before keep their numbers, and can no longer be written; the
    attribute gives the new one.

    Parameters
    ----------
    dimension : {2, 3}
        In the plane or in space.
    gravity : array_like, shape (dimension,), or float, optional
        The acceleration of every body; a number is its size, downwards. Without it there is none.
    motion : {'exact', 'fast'}
        Exactly from collision to collision, or in steps with soft contacts, for heaps and games.
    step : float
        The time of a step of the fast motion.
    substeps : int
        Of the fast motion: more make contacts stiffer, at proportional cost.
    threads : int
        Of the fast motion: at most so many; the results are the same for any number.
    sleep_after : float
        Of the fast motion: bodies at rest for so long are not moved until they are hit. 0: never.
    tolerance : float
        Of the exact motion under other forces than gravity: relative, and in units of a radius.
    contact_time : float, optional
        Of the exact motion: a body that would rebound for less rests.
    contact_events : int
        At most so many contacts of a move are recorded.

    Examples
    --------
    >>> world = continuo.World(3, gravity=9.81)
    >>> world.add_wall([0, 0, 1])
    0
    >>> ball = world.add([0, 0, 10], restitution=1)
    >>> world.advance_to(2 * np.sqrt(2 * 9.5 / 9.81))
    >>> round(float(world.positions[0, 2]), 9)
    10.0
    """

    def __init__(
        self,
        dimension: Literal[2, 3] = 3,
        gravity: ArrayLike | None = None,
        motion: Literal["exact", "fast"] = "exact",
        *,
        step: float = 1 / 60,
        substeps: int = 4,
        threads: int = 1,
        sleep_after: float = 0.0,
        tolerance: float = 1e-10,
        contact_time: float | None = None,
        contact_events: int = 100_000,
    ) -> None:
        if dimension not in (2, 3):
            raise ValueError(f"dimension is {dimension!r}; bodies move in 2 or 3 dimensions")
        self._dimension = dimension
        self._settings: dict[str, Any] = {
            "motion": motion,
            "step": step,
            "substeps": substeps,
            "threads": threads,
            "sleep_after": sleep_after,
            "tolerance": tolerance,
            "contact_time": contact_time,
            "contact_events": contact_events,
        }
        make = _continuo.World2 if dimension == 2 else _continuo.World3
        self._inner: _Inner = make(_motion_settings(self._settings))
        self._views: list[weakref.ref[Any]] = []
        if gravity is not None:
            self.gravity = _numbers("gravity", gravity)

    # ---- bodies ----

    def add(
        self,
        position: ArrayLike,
        radius: ArrayLike = 0.5,
        *,
        shape: shapes.Shape | None = None,
        orientation: ArrayLike | None = None,
        velocity: ArrayLike = 0.0,
        spin: ArrayLike = 0.0,
        mass: ArrayLike | None = None,
        density: ArrayLike = 1.0,
        restitution: ArrayLike = 0.0,
        friction: ArrayLike = 0.5,
        rolling_resistance: ArrayLike = 0.0,
        fixed: ArrayLike = False,
        driven: ArrayLike = False,
        sensor: ArrayLike = False,
        locked: str | Iterable[str] = (),
        gravity_scale: ArrayLike = 1.0,
        damping: ArrayLike = 0.0,
        spin_damping: ArrayLike = 0.0,
        group: ArrayLike = 0,
        category: int = 1,
        mask: int = (1 << 64) - 1,
    ) -> Any:
        """Adds a body, or many by arrays: balls, or bodies of one shape.

        Parameters
        ----------
        position : array_like, shape (d,) or (N, d)
            Of the centre of a ball, of the origin of another shape, or of N of them; `positions` has centres of
            mass. Of the others each is one value for all, or one for each body.
        radius : float or array_like, shape (N,)
            Of balls.
        shape : Sphere, Capsule, Box, Hull or Compound, optional
            Of all these bodies, in place of a radius.
        orientation : float or array_like, shape (N,) in the plane, shape (4,) or (N, 4) in space, optional
            Angles, or quaternions (w, x, y, z); upright without it.
        mass, density : float or array_like, shape (N,)
            Without `mass` it is density times volume (area in the plane); the moments of inertia follow.
        velocity : array_like, shape (d,) or (N, d)
        spin : float, or array_like, shape (3,) or (N, 3) in space, (N,) in the plane
            The angular velocity in radians per time.
        restitution : float or array_like, shape (N,)
            0 (no bounce) to 1 (no loss).
        friction, rolling_resistance : float or array_like, shape (N,)
        fixed, driven, sensor : bool or array_like, shape (N,)
            Bodies that never move; that move with their velocity and spin, whatever they meet; that have
            contacts, but push nothing.
        locked : iterable of 'x', 'y', 'z', 'turn', 'turn_x', 'turn_y', 'turn_z'
            Directions in which all these bodies are held; 'turn' is all turns.
        gravity_scale, damping, spin_damping : float or array_like, shape (N,)
            Of gravity; of the velocity and of the spin, per time.
        group : int or array_like, shape (N,)
            Below 32; see :meth:`ignore`.
        category, mask : int
            64 bits. Two bodies collide where each has a bit of the other's mask.

        Returns
        -------
        int, or ndarray of int64, shape (N,)
            What names the body, whatever is added or removed; :meth:`index` gives its row.

        Raises
        ------
        ValueError
            For a radius or a mass that is not positive, a number that is not finite, a wrong shape. Nothing
            is added then.
        """
        d = self._dimension
        centres = _numbers("position", position)
        if centres.ndim not in (1, 2) or centres.shape[-1] != d:
            raise ValueError(f"position has the shape {centres.shape}; it must be ({d},) or (N, {d})")
        one = centres.ndim == 1
        n = 1 if one else len(centres)
        spins = 1 if d == 2 else 3

        turns = 1 if d == 2 else 4
        upright = (0.0 if d == 2 else shapes.turn(None, d)) if orientation is None else orientation
        values = {
            "position": centres,
            "velocity": velocity,
            "spin": spin,
            "orientation": _unit(_columns("orientation", upright, n, turns)),
            "radius": radius,
            "mass": 1.0 if mass is None else mass,
            "density": density,
            "restitution": restitution,
            "friction": friction,
            "rolling_resistance": rolling_resistance,
            "gravity_scale": gravity_scale,
            "damping": damping,
            "spin_damping": spin_damping,
            "group": group,
        }
        widths = {"position": d, "velocity": d, "spin": spins, "orientation": turns}
        rows = np.empty((n, 2 * d + spins + turns + 10))
        place = 0
        for name, value in values.items():
            width = widths.get(name, 1)
            rows[:, place : place + width] = _columns(name, value, n, width)
            place += width
        groups = [int(number) for number in rows[:, -1] if number in range(32)]
        if len(groups) < n:
            raise ValueError("groups are whole numbers from 0 to 31")
        is_driven = _flags("driven", driven, n)
        kinds = np.where(_flags("fixed", fixed, n) | is_driven, 1, 0) + 2 * is_driven
        kinds = kinds + 4 * _flags("sensor", sensor, n) + 256 * _locked(locked, d)
        form = None if shape is None else shapes.form_of(shape, d, shapes.SHAPES)
        self._retire()
        handles = self._inner.add(
            np.ascontiguousarray(rows[:, :-1]),
            form,
            mass is not None,
            [int(kind) for kind in kinds],
            groups,
            _bits("category", category),
            _bits("mask", mask),
        )
        return handles[0] if one else np.array(handles, dtype=np.int64)

    def remove(self, body: int) -> None:
        """Removes a body and the springs at it. The last body takes its row. KeyError where there is no such
        body."""
        self._retire()
        self._inner.remove(_handle(body))

    def __contains__(self, body: object) -> bool:
        return isinstance(body, (int, np.integer)) and int(body) >= 0 and self._inner.contains(int(body))

    def __len__(self) -> int:
        return len(self._inner)

    def index(self, body: int) -> int:
        """The row of a body in the arrays. KeyError where there is no such body."""
        return self._inner.index(_handle(body))

    @property
    def bodies(self) -> NDArray[np.int64]:
        """What names the bodies, in the order of the rows."""
        return np.array(self._inner.handles(), dtype=np.int64)

    def _retire(self) -> None:
        """Views of before keep their numbers, and are not written any more."""
        for reference in self._views:
            view = reference()
            if view is not None:
                view.flags.writeable = False
        self._views.clear()

    def _view(self, array: Floats) -> Floats:
        self._views = [reference for reference in self._views if reference() is not None]
        self._views.append(weakref.ref(array))
        return array

    @property
    def positions(self) -> Floats:
        """The centres: a view that can be written, shape (N, d)."""
        return self._view(self._inner.positions())

    @positions.setter
    def positions(self, values: ArrayLike) -> None:
        self.positions[...] = values

    @property
    def velocities(self) -> Floats:
        """The velocities of the centres: a view that can be written, shape (N, d)."""
        return self._view(self._inner.velocities())

    @velocities.setter
    def velocities(self, values: ArrayLike) -> None:
        self.velocities[...] = values

    @property
    def spins(self) -> Floats:
        """The angular velocities in radians per time: a view that can be written, shape (N, 3), in the plane
        (N,)."""
        return self._view(self._inner.spins())

    @spins.setter
    def spins(self, values: ArrayLike) -> None:
        self.spins[...] = values

    @property
    def orientations(self) -> Floats:
        """Unit quaternions (w, x, y, z), shape (N, 4), in the plane angles, shape (N,): a view that can be
        written."""
        return self._view(self._inner.orientations())

    @orientations.setter
    def orientations(self, values: ArrayLike) -> None:
        self.orientations[...] = values

    @property
    def radii(self) -> Floats:
        """The radii, shape (N,): read only."""
        return self._inner.radii()

    @property
    def masses(self) -> Floats:
        """The masses, shape (N,): read only."""
        return self._inner.masses()

    @property
    def fixed(self) -> NDArray[np.bool_]:
        """Which bodies never move, shape (N,)."""
        return np.array(self._inner.fixed(), dtype=np.bool_)

    @property
    def origins(self) -> Floats:
        """Where the origins of the shapes are, shape (N, d): of balls the centres. A copy."""
        return self._inner.origins()

    # ---- joints ----

    def add_joint(
        self,
        kind: str,
        b: int,
        anchor: ArrayLike | None = None,
        *,
        a: int | None = None,
        anchor_b: ArrayLike | None = None,
        axis: ArrayLike | None = None,
        axle: ArrayLike | None = None,
        limits: tuple[float, float] | None = None,
        spring: Spring | None = None,
        motor: Motor | tuple[float, float] | None = None,
        target: ArrayLike | None = None,
        ratio: float = 1.0,
        breaks_at: float = np.inf,
        breaks_at_torque: float = np.inf,
        collide: bool = False,
    ) -> Joint:
        """Joins body b with body a, or with the world, where they are now.

        Parameters
        ----------
        kind : str
            What is free: of a 'hinge' the rotation about the axis, of a 'ball' all rotations, of a 'slider' the
            way along the axis, of a 'weld' nothing, of a 'distance' all but that (with an upper limit alone it is
            a rope), of a 'wheel' the way along the axis and the rotation about the axle, of a 'universal' joint
            the rotations about both. A 'gear' binds two rotations; a 'pull' draws b to `target`, as a mouse does.
        b : int
            The body whose coordinate is limited, driven and drawn.
        anchor : array_like, shape (d,), optional
            Where they are joined; by default at the centre of b.
        a : int, optional
            The other body; without it, the world.
        anchor_b : array_like, shape (d,), optional
            The end at b, where that differs.
        axis, axle : array_like, shape (d,), optional
            Of any length but 0; the axis is the last one by default.
        limits : Limits or (lower, upper), optional
        spring : Spring or (hertz, damping, rest), optional
        motor : Motor or (speed, most), optional
        target : array_like, shape (d,), optional
            Of a 'pull'; by default the anchor.
        ratio : float
            Of gears: the angle of b and `ratio` times that of a have a constant sum.
        breaks_at, breaks_at_torque : float
            The force and the torque beyond which it acts no more; of a 'pull', `breaks_at` is its greatest force.
        collide : bool
            Whether the two bodies collide with each other.

        Returns
        -------
        Joint
            What it bears can be read from it, and limits, spring, motor, target and strength be set.

        Examples
        --------
        >>> world = continuo.World(2, gravity=9.81, motion="fast")
        >>> door = world.add([0.5, 0], shape=continuo.Box([1, 0.1]))
        >>> hinge = world.add_joint("hinge", door, [0, 0], limits=(-1, 1), motor=(2, 5))
        >>> world.step(count=240)
        >>> round(hinge.coordinate, 3)
        1.0
        """
        given: dict[str, Any] = {
            "ratio": _number("ratio", ratio),
            "breaks_at": _number("breaks_at", breaks_at),
            "breaks_at_torque": _number("breaks_at_torque", breaks_at_torque),
            "collide": bool(collide),
        }
        place = self.positions[self.index(b)] if anchor is None else anchor
        for name, point in {"anchor": place, "anchor_b": anchor_b, "axis": axis, "axle": axle}.items():
            if point is not None:
                given[name] = _numbers(name, point)
        if a is not None:
            given["a"] = _handle(a)
        for name, value, count in (("limits", limits, 2), ("motor", motor, 2)):
            if value is not None:
                given[name] = numbers(name, value, count)
        if spring is not None:
            given["spring"] = numbers("spring", Spring(*spring), 3)
        number = self._inner.add_joint(str(kind), _handle(b), given)
        joint = Joint(self, number)
        if kind == "pull":
            joint.target = _numbers("target", place if target is None else target)
        return joint

    def remove_joint(self, joint: Joint) -> None:
        """Removes a joint. Joints go with their bodies. KeyError where there is no such joint."""
        self._inner.remove_joint(joint._number)

    @property
    def joints(self) -> list[Joint]:
        """All joints."""
        return [Joint(self, number) for number in self._inner.joints()]

    # ---- walls and forces ----

    @property
    def dimension(self) -> int:
        """2 or 3."""
        return self._dimension

    @property
    def gravity(self) -> Floats:
        """The acceleration of every body, shape (d,)."""
        return self._inner.gravity()

    @gravity.setter
    def gravity(self, value: ArrayLike) -> None:
        numbers = _numbers("gravity", value)
        if numbers.ndim == 0:
            down = np.zeros(self._dimension)
            down[-1] = -numbers
            numbers = down
        self._inner.set_gravity(numbers)

    def add_wall(
        self,
        normal: ArrayLike,
        offset: float = 0.0,
        *,
        thin: bool = False,
        restitution: float = 0.0,
        friction: float = 0.5,
        rolling_resistance: float = 0.0,
    ) -> int:
        """Adds a wall: the points x with normal . x >= offset are free, of a `thin` one those on both sides.

        Returns
        -------
        int
            Its number.
        """
        return self._inner.add_wall(
            _numbers("normal", normal), float(offset), bool(thin), [restitution, friction, rolling_resistance]
        )

    def add_container(
        self,
        lower: ArrayLike,
        upper: ArrayLike,
        *,
        restitution: float = 0.0,
        friction: float = 0.5,
        rolling_resistance: float = 0.0,
    ) -> None:
        """Adds the walls of a box, of which the bodies are inside."""
        material = [restitution, friction, rolling_resistance]
        self._inner.add_container(_numbers("lower", lower), _numbers("upper", upper), material)

    def add_mesh(
        self,
        mesh: shapes.Mesh,
        *,
        restitution: float = 0.0,
        friction: float = 0.5,
        rolling_resistance: float = 0.0,
        category: int = 1,
        mask: int = (1 << 64) - 1,
    ) -> int:
        """Adds ground that never moves: a Chain in the plane, a TriangleMesh in space, a HeightField in both.

        Returns
        -------
        int
            What names it, for :meth:`remove_mesh`.
        """
        form = shapes.form_of(mesh, self._dimension, shapes.MESHES, "mesh")
        material = [restitution, friction, rolling_resistance]
        return self._inner.add_mesh(form, material, _bits("category", category), _bits("mask", mask))

    def remove_mesh(self, mesh: int) -> None:
        """Removes a mesh. KeyError where there is no such mesh."""
        self._inner.remove_mesh(_handle(mesh))

    @property
    def walls(self) -> list[tuple[Floats, float, bool]]:
        """Of each wall the normal, the offset, and whether it is thin."""
        return self._inner.walls()

    def add_spring(
        self,
        a: int,
        b: int | Sequence[float] | Floats,
        *,
        rest_length: float = 0.0,
        stiffness: float = 1.0,
        damping: float = 0.0,
    ) -> None:
        """A spring from body `a` to body `b`, or to a point: stiffness*(distance - rest_length) + damping*its
        rate."""
        if isinstance(b, (int, np.integer)):
            if a == b:
                raise ValueError(f"a spring joins two bodies, and both are {a}")
            self._inner.add_spring(_handle(a), _handle(b), None, rest_length, stiffness, damping)
        else:
            self._inner.add_spring(_handle(a), None, _numbers("b", b), rest_length, stiffness, damping)

    def set_drag(self, linear: float = 0.0, quadratic: float = 0.0) -> None:
        """A force on every body against its velocity: linear*v + quadratic*|v|*v."""
        self._inner.set_drag(_not_negative("linear", linear), _not_negative("quadratic", quadratic))

    def set_attraction(self, constant: float, softening: float = 0.0, opening: float = 0.0) -> None:
        """Every two bodies attract each other: constant*m1*m2*r/(r^2 + softening^2)^(3/2).

        `opening` 0 sums up all pairs; 0.5 is usual for many bodies.
        """
        if not np.isfinite(constant):
            raise ValueError(f"constant is {constant}; it must be finite")
        self._inner.set_attraction(
            constant, _not_negative("softening", softening), _not_negative("opening", opening)
        )

    def ignore(self, a: int, b: int) -> None:
        """Bodies of the groups `a` and `b` do not collide from now on."""
        if not (0 <= a < 32 and 0 <= b < 32):
            raise ValueError("groups are whole numbers from 0 to 31")
        self._inner.ignore(a, b)

    # ---- moves ----

    @property
    def time(self) -> float:
        """Of the present state."""
        return self._inner.time()

    @property
    def motion(self) -> str:
        """'exact' or 'fast'. Another one may be set: it goes on from the present state."""
        return str(self._settings["motion"])

    @motion.setter
    def motion(self, value: str) -> None:
        self._change(motion=value)

    def _change(self, **settings: Any) -> None:
        changed = {**self._settings, **settings}
        self._inner.set(_motion_settings(changed))
        self._settings = changed

    def advance_to(self, t: float) -> None:
        """Moves all bodies to the time t: exactly, or by whole steps until it is not before t.

        Other Python threads run meanwhile. After Ctrl-C the world is at the time of the last event or step.

        Raises
        ------
        ValueError
            Where t is before the present time, or a number that was written into a view is not finite.
        RuntimeError
            Where the motion cannot go on.
        """
        t = _number("t", t)
        if not np.isfinite(t) or t < self.time:
            raise ValueError(f"the world is at the time {self.time} and cannot move to {t}")
        self._inner.advance_to(t)

    def step(self, h: float | None = None, count: int = 1) -> None:
        """`count` steps of the time h each; without h of that of the fast motion."""
        if not isinstance(count, (int, np.integer)):
            raise TypeError(f"count is a whole number, not {count!r}")
        if count < 0:
            raise ValueError(f"count is {count}; steps go forwards")
        size = self._settings["step"] if h is None else float(h)
        if not (np.isfinite(size) and size > 0):
            raise ValueError(f"h is {size}; it must be positive")
        if self.motion == "exact":
            self._inner.advance_to(self.time + size * count)
            return
        if size != self._settings["step"]:
            self._change(step=size)
        self._inner.advance(count)

    @property
    def contacts(self) -> Contacts:
        """The contacts of the last move."""
        fields = self._inner.events()
        change = _CHANGES[fields.pop("change")]
        return Contacts(change=change, lost=self._inner.lost_events(), **fields)

    @property
    def asleep(self) -> int:
        """How many bodies slept in the last step of the fast motion, see `sleep_after`."""
        return self._inner.asleep()

    # ---- sums over all bodies ----

    @property
    def kinetic_energy(self) -> float:
        """Of all bodies that move, with their spins."""
        return self._inner.kinetic_energy()

    @property
    def potential_energy(self) -> float:
        """Of gravity, springs and attraction."""
        return self._inner.potential_energy()

    @property
    def energy(self) -> float:
        """Kinetic and potential energy."""
        return self.kinetic_energy + self.potential_energy

    @property
    def momentum(self) -> Floats:
        """The sum of mass times velocity, shape (d,)."""
        return self._inner.momentum()

    @property
    def angular_momentum(self) -> Floats:
        """About the origin, with the spins; shape (3,), in the plane (1,)."""
        return self._inner.angular_momentum()

    # ---- questions ----

    def ray(self, origin: ArrayLike, direction: ArrayLike, reach: float = np.inf) -> RayHit | None:
        """The first body or wall that a ray meets, None where it meets nothing."""
        hits = self._inner.ray(_numbers("origin", origin), _numbers("direction", direction), reach, False)
        return RayHit(*hits[0]) if hits else None

    def rays(self, origin: ArrayLike, direction: ArrayLike, reach: float = np.inf) -> list[RayHit]:
        """All bodies and walls that a ray meets, the nearest first."""
        hits = self._inner.ray(_numbers("origin", origin), _numbers("direction", direction), reach, True)
        return [RayHit(*hit) for hit in hits]

    def first_hits(
        self, origins: ArrayLike, directions: ArrayLike, reach: float = np.inf, threads: int = 1
    ) -> RayHits:
        """What each of many rays meets first.

        Parameters
        ----------
        origins, directions : array_like, shape (N, d) or (d,)
            One for each ray, or one for all.
        """
        first, second = np.broadcast_arrays(
            np.atleast_2d(_numbers("origins", origins)), np.atleast_2d(_numbers("directions", directions))
        )
        return RayHits(*self._inner.first_hits(first.copy(), second.copy(), reach, int(threads)))

    def in_shape(
        self, shape: shapes.Shape, position: ArrayLike, orientation: ArrayLike | None = None
    ) -> Touched:
        """What a shape at a place touches."""
        return Touched(*self._inner.in_shape(*self._placed(shape, position, orientation)))

    def first_contact(
        self, shape: shapes.Shape, position: ArrayLike, way: ArrayLike, orientation: ArrayLike | None = None
    ) -> RayHit | None:
        """What a shape meets first that moves straight by `way`; None where that is nothing."""
        placed = self._placed(shape, position, orientation)
        hits = self._inner.first_contact(*placed, _numbers("way", way))
        return RayHit(*hits[0]) if hits else None

    def near_shape(
        self, shape: shapes.Shape, position: ArrayLike, reach: float, orientation: ArrayLike | None = None
    ) -> list[Near]:
        """The surfaces that are not farther from a shape than `reach`, the nearest first."""
        placed = self._placed(shape, position, orientation)
        return [Near(*one) for one in self._inner.near_shape(*placed, _number("reach", reach))]

    def _placed(
        self, shape: shapes.Shape, position: ArrayLike, orientation: ArrayLike | None
    ) -> tuple[tuple[Any, ...], Floats, Floats]:
        form = shapes.form_of(shape, self._dimension, shapes.SHAPES)
        return form, _numbers("position", position), shapes.turn(orientation, self._dimension)

    def walk(
        self,
        character: Character,
        velocity: ArrayLike,
        duration: float,
        *,
        radius: float = 0.3,
        height: float = 1.8,
        steepest: float = 0.8,
        highest_step: float = 0.3,
        skin: float = 0.005,
        fall_acceleration: float = 9.81,
    ) -> Character:
        """The character after a time: it walks, goes up steps, slides along walls, falls, and is carried by what it
        stands on. It does not act on the world.

        Parameters
        ----------
        velocity : array_like, shape (d,)
            Of which the horizontal part counts.
        radius, height : float
            Of the capsule.
        steepest : float
            The slope on which it stands, in radians.
        highest_step : float
            That it goes up, and down without falling.
        skin : float
            The distance that it keeps from surfaces.
        fall_acceleration : float
            Where there is no ground.
        """
        fields = astuple(character)
        inner = self._inner.walk(
            (_numbers("position", character.position), *fields[1:]),
            _numbers("velocity", velocity),
            _number("duration", duration),
            [radius, height, steepest, highest_step, skin, fall_acceleration],
        )
        return Character(*inner)

    def add_vehicle(self, chassis: int, wheels: Sequence[Wheel]) -> Vehicle:
        """Puts a body on wheels, which are found on the ground by rays. It is driven before each step.

        Parameters
        ----------
        chassis : int
            A body that is not fixed.
        wheels : sequence of Wheel
            At most 64.

        Examples
        --------
        >>> world = continuo.World(3, gravity=9.81, motion="fast")
        >>> world.add_wall([0, 0, 1])
        >>> body = world.add([0, 0, 0.8], shape=continuo.Box([4, 1.8, 0.6]), mass=1200)
        >>> hubs = [[x, y, -0.5] for x in (1.3, -1.3) for y in (0.8, -0.8)]
        >>> car = world.add_vehicle(body, [continuo.Wheel(hub, greatest_drive=300) for hub in hubs])
        >>> for _ in range(180):
        ...     car.drive(throttle=1)
        ...     world.step()
        >>> world.velocities[0, 0] > 5
        True
        """
        return make(self, chassis, wheels, self._dimension)

    def in_sphere(self, centre: ArrayLike, radius: float) -> tuple[list[int], list[int]]:
        """The bodies and the walls that a ball touches."""
        return self._inner.in_sphere(_numbers("centre", centre), radius)

    def in_box(self, lower: ArrayLike, upper: ArrayLike) -> tuple[list[int], list[int]]:
        """The bodies and the walls that a box with its faces along the axes touches."""
        return self._inner.in_box(_numbers("lower", lower), _numbers("upper", upper))

    def nearest(self, point: ArrayLike, count: int = 1) -> list[tuple[int, float]]:
        """The bodies whose surfaces are nearest to a point, each with its distance, below 0 inside."""
        if count < 0:
            raise ValueError(f"count is {count}")
        return self._inner.nearest(_numbers("point", point), count)

    # ---- Python's own ----

    def snapshot(self) -> bytes:
        """The state as bytes, with that of the motion: a restored world goes on to the same bits."""
        return self._inner.save()

    def restore(self, state: bytes) -> None:
        """Takes over the state of a snapshot. ValueError or RuntimeError where the bytes are none; nothing
        changes then."""
        self._retire()
        self._inner.restore(bytes(state))

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (self._dimension, self._settings, self.snapshot())

    def copy(self) -> World:
        """Another world in the same state."""
        return _restored(self._dimension, self._settings, self.snapshot())

    def plot(self, ax: Any = None) -> Any:
        """The bodies, in space seen along y, by matplotlib. Returns the axes."""
        try:
            from matplotlib import pyplot
            from matplotlib.collections import PolyCollection
        except ImportError as error:
            raise ImportError("World.plot needs matplotlib: apt install python3-matplotlib") from error
        if ax is None:
            _, ax = pyplot.subplots()
        places = self.positions[:, [0, -1]]
        angles = np.linspace(0, 2 * np.pi, 72, endpoint=False)
        circle = np.column_stack([np.cos(angles), np.sin(angles)])
        outlines: list[Floats] = []
        colors: list[str] = []
        for i, (place, radius, fixed) in enumerate(zip(places, self.radii, self.fixed)):
            made = self._inner.outlines(i) or [place + radius * circle]
            outlines += made
            colors += ["tab:gray" if fixed else f"C{i % 10}"] * len(made)
        ax.add_collection(PolyCollection(outlines, facecolors=colors, alpha=0.7))
        for normal, offset, _ in self.walls:
            across = np.array([normal[0], normal[-1]])
            if np.linalg.norm(across) > 0.5:
                through = across * offset / (across @ across)
                ax.axline(through, through + np.array([-across[1], across[0]]), color="black", linewidth=1)
        ax.set_aspect("equal")
        ax.set_xlabel("x")
        ax.set_ylabel("y" if self._dimension == 2 else "z")
        ax.set_title(f"t = {self.time:.6g}")
        ax.autoscale_view()
        return ax

    def __repr__(self) -> str:
        bodies = f"{len(self)} bodies in {self._dimension} dimensions"
        return f"<continuo.World: {bodies}, {self.motion}, t={self.time:.6g}>"


def _restored(dimension: Literal[2, 3], settings: dict[str, Any], state: bytes) -> World:
    world = World(dimension, **settings)
    world.restore(state)
    return world


def _motion_settings(settings: dict[str, Any]) -> _continuo.MotionSettings:
    if settings["motion"] not in ("exact", "fast"):
        raise ValueError(f"motion is {settings['motion']!r}; it can be 'exact' or 'fast'")
    result = _continuo.MotionSettings()
    result.exact = settings["motion"] == "exact"
    for name in ("step", "tolerance"):
        if not (np.isfinite(settings[name]) and settings[name] > 0):
            raise ValueError(f"{name} is {settings[name]}; it must be positive")
    for name in ("substeps", "threads"):
        if int(settings[name]) != settings[name] or not 1 <= settings[name] <= 10_000:
            raise ValueError(f"{name} is {settings[name]}; it must be a whole number from 1 on")
    contact_time = settings["contact_time"]
    result.step, result.tolerance = float(settings["step"]), float(settings["tolerance"])
    result.substeps, result.threads = int(settings["substeps"]), int(settings["threads"])
    result.sleep_after = _not_negative("sleep_after", settings["sleep_after"])
    result.contact_time = None if contact_time is None else _not_negative("contact_time", contact_time)
    result.contact_events = int(_not_negative("contact_events", settings["contact_events"]))
    return result


def _handle(body: Any) -> int:
    if not isinstance(body, (int, np.integer)) or isinstance(body, bool):
        raise TypeError(f"a body is named by the int that add returned, not by a {type(body).__name__}")
    if body < 0:
        raise KeyError(f"there is no body {body}")
    return int(body)


def _not_negative(name: str, value: float) -> float:
    number = _number(name, value)
    if not (np.isfinite(number) and number >= 0):
        raise ValueError(f"{name} is {value}; it must be 0 or more, and finite")
    return number


def _number(name: str, value: Any) -> float:
    try:
        return float(value)
    except (TypeError, ValueError):
        raise TypeError(f"{name} is one number, not {value!r}") from None


def _columns(name: str, value: ArrayLike, n: int, width: int) -> Floats:
    """The numbers of n bodies: one value for all, or one for each."""
    values = _numbers(name, value)
    shape = values.shape
    if width > 1:
        allowed: tuple[tuple[int, ...], ...] = ((), (width,), (n, width))
    else:
        allowed = ((), (n,), (n, 1))
    if shape not in allowed:
        raise ValueError(
            f"{name} has the shape {shape}; it must be {' or '.join(map(str, allowed))} for {n} bodies"
        )
    return values[:, None] if width == 1 and values.ndim == 1 else values


def _flags(name: str, value: ArrayLike, n: int) -> NDArray[np.bool_]:
    flags = np.asarray(value)
    if flags.dtype.kind != "b" or flags.shape not in ((), (n,)):
        raise ValueError(f"{name} must be True, False or an array of them of the shape ({n},)")
    return np.broadcast_to(flags, (n,))


def _locked(value: str | Iterable[str], dimension: int) -> int:
    bits = {"x": 1, "y": 2, "z": 4, "turn": 56, "turn_x": 8, "turn_y": 16, "turn_z": 32}
    if dimension == 2:
        bits = {name: bits[name] for name in ("x", "y", "turn")}
    locked = 0
    for name in (value,) if isinstance(value, str) else tuple(value):
        if name not in bits:
            raise ValueError(f"locked has {name!r}; it can have {', '.join(map(repr, bits))}")
        locked |= bits[name]
    return locked


def _bits(name: str, value: int) -> int:
    if not isinstance(value, (int, np.integer)) or not 0 <= value < 1 << 64:
        raise ValueError(f"{name} is {value!r}; it must be a whole number of 64 bits")
    return int(value)


def _unit(turns: Floats) -> Floats:
    """Quaternions of length 1; angles as they are."""
    if turns.ndim == 0 or turns.shape[-1] != 4:
        return turns
    size = np.linalg.norm(turns, axis=-1, keepdims=True)
    if not np.all(np.isfinite(size) & (size > 0)):
        raise ValueError("orientation has a quaternion without length")
    return np.asarray(turns / size)


def _numbers(name: str, value: ArrayLike) -> Floats:
    array = np.asarray(value)
    if array.dtype.kind not in "fiub":
        raise TypeError(f"{name} is an array of {array.dtype}; it must be numbers")
    return array.astype(np.float64)
