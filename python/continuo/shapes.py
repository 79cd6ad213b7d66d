"""Shapes of bodies, and of ground that never moves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Union

import numpy as np
from numpy.typing import ArrayLike

__all__ = ["Box", "Capsule", "Chain", "Compound", "HeightField", "Hull", "Part", "Sphere", "TriangleMesh"]


@dataclass(frozen=True)
class Sphere:
    """A ball in space, a disc in the plane.

    Parameters
    ----------
    radius : float
    """

    radius: float = 0.5

    def _form(self, dimension: int) -> tuple[Any, ...]:
        return ("sphere", float(self.radius))


@dataclass(frozen=True)
class Capsule:
    """All points within a radius of a segment along the last axis.

    Parameters
    ----------
    length : float
        Of the segment, between the centres of the round ends.
    radius : float
    """

    length: float = 1.0
    radius: float = 0.5

    def _form(self, dimension: int) -> tuple[Any, ...]:
        return ("capsule", float(self.length), float(self.radius))


@dataclass(frozen=True)
class Box:
    """A box with sides along the axes, in the plane a rectangle.

    Parameters
    ----------
    size : array_like, shape (d,)
        From side to opposite side, what is rounded included.
    rounding : float
        The radius of its edges and corners.
    """

    size: ArrayLike
    rounding: float = 0.0

    def _form(self, dimension: int) -> tuple[Any, ...]:
        return ("box", np.asarray(self.size, dtype=float), float(self.rounding))


@dataclass(frozen=True)
class Hull:
    """The convex hull of points, in the plane a convex polygon: at most 64 corners.

    Parameters
    ----------
    points : array_like, shape (N, d)
        In any order; those within the hull of the others do not matter.
    rounding : float
        All points within this distance of the hull belong to the body.
    """

    points: ArrayLike
    rounding: float = 0.0

    def _form(self, dimension: int) -> tuple[Any, ...]:
        return ("hull", np.asarray(self.points, dtype=float), float(self.rounding))


_Convex = Union[Sphere, Capsule, Box, Hull]


@dataclass(frozen=True)
class Part:
    """A convex part of a compound.

    Parameters
    ----------
    shape : Sphere, Capsule, Box or Hull
    position : array_like, shape (d,)
        Of its origin, in the frame of the compound.
    orientation : float, or array_like, shape (4,)
        An angle in the plane, a quaternion (w, x, y, z) in space; without it, upright.
    """

    shape: _Convex
    position: ArrayLike = 0.0
    orientation: ArrayLike | None = None

    def _form(self, dimension: int) -> tuple[Any, ...]:
        place = np.broadcast_to(np.asarray(self.position, dtype=float), (dimension,))
        return (self.shape._form(dimension), place, turn(self.orientation, dimension))


@dataclass(frozen=True)
class Compound:
    """Convex parts that are rigidly joined. Where parts overlap, the mass there counts as often.

    Parameters
    ----------
    parts : sequence of Part
    """

    parts: Sequence[Part]

    def _form(self, dimension: int) -> tuple[Any, ...]:
        return ("compound", [part._form(dimension) for part in self.parts])


@dataclass(frozen=True)
class Chain:
    """Ground in the plane: segments from point to point, free to the right of their way.

    Parameters
    ----------
    points : array_like, shape (N, 2)
        At least two.
    loop : bool
        Whether a further segment leads from the last point to the first.
    two_sided : bool
        Whether both sides are free.
    before, after : array_like, shape (2,), optional
        Corners of the chains that it continues, so that bodies pass smoothly.
    """

    points: ArrayLike
    loop: bool = False
    two_sided: bool = False
    before: ArrayLike | None = None
    after: ArrayLike | None = None

    def _form(self, dimension: int) -> tuple[Any, ...]:
        ends = [None if end is None else np.asarray(end, dtype=float) for end in (self.before, self.after)]
        return ("chain", np.asarray(self.points, dtype=float), bool(self.loop), bool(self.two_sided), *ends)


@dataclass(frozen=True)
class TriangleMesh:
    """Ground in space: triangles, free where their corners go counter-clockwise.

    Parameters
    ----------
    corners : array_like, shape (N, 3)
    triangles : array_like of int, shape (M, 3)
        The numbers of their corners.
    two_sided : bool
        Whether both sides are free.
    """

    corners: ArrayLike
    triangles: ArrayLike
    two_sided: bool = False

    def _form(self, dimension: int) -> tuple[Any, ...]:
        numbers = np.asarray(self.triangles)
        if numbers.dtype.kind not in "iu" or (numbers.size > 0 and numbers.min() < 0):
            raise ValueError("triangles are the numbers of corners, from 0 on")
        return ("triangles", np.asarray(self.corners, dtype=float), numbers.astype(np.uint32), bool(self.two_sided))


@dataclass(frozen=True)
class HeightField:
    """Ground by heights over a grid, in the plane or in space.

    Parameters
    ----------
    heights : array_like, shape (N,) in the plane, (N, M) in space
        Along the first axis N points, along the second M; at least two each.
    spacing : float, or array_like, shape (d - 1,)
        Of the grid.
    origin : array_like, shape (d,), optional
        The first point of the grid, from which heights are measured.
    """

    heights: ArrayLike
    spacing: ArrayLike = 1.0
    origin: ArrayLike = field(default=0.0)

    def _form(self, dimension: int) -> tuple[Any, ...]:
        place = np.broadcast_to(np.asarray(self.origin, dtype=float), (dimension,))
        spacing = np.broadcast_to(np.asarray(self.spacing, dtype=float), (dimension - 1,))
        return ("height_field", place, spacing, np.asarray(self.heights, dtype=float))


Shape = Union[Sphere, Capsule, Box, Hull, Compound]
Mesh = Union[Chain, TriangleMesh, HeightField]


def turn(orientation: ArrayLike | None, dimension: int) -> Any:
    """The numbers of one orientation; upright without it."""
    if orientation is None:
        return np.zeros(1) if dimension == 2 else np.array([1.0, 0.0, 0.0, 0.0])
    return np.atleast_1d(np.asarray(orientation, dtype=float))


def form_of(shape: Any, dimension: int, kinds: tuple[type, ...], name: str = "shape") -> tuple[Any, ...]:
    """A shape as the module _continuo reads it."""
    if not isinstance(shape, kinds):
        raise TypeError(f"{name} is {shape!r}; it must be one of {', '.join(kind.__name__ for kind in kinds)}")
    form: tuple[Any, ...] = shape._form(dimension)
    return form


SHAPES: tuple[type, ...] = (Sphere, Capsule, Box, Hull, Compound)
MESHES: tuple[type, ...] = (Chain, TriangleMesh, HeightField)
