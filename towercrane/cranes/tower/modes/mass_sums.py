"""Mass of what turns on a tower, summed once: all that the equations of the flexible crane need to know of it."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import numpy as np

from modal.structures.part_shapes import gauss

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from modal import Chain
    from modal.structures.chain_modes import ChainModes

    Floats = NDArray[np.float64]


class Basis(Protocol):
    """Shapes of bending of a member clamped at position 0, such as :class:`modal.beams.shapes.Modes`."""

    @property
    def count(self) -> int:
        """Number of shapes."""

    @property
    def angular_frequencies(self) -> Floats:
        """Square roots of the stiffness of each shape by itself."""

    def __call__(self, position: ArrayLike, derivative: int = 0) -> Floats:
        """Shapes or derivatives, shape (count, *shape of position)."""

    def rotation(self, position: ArrayLike) -> Floats:
        """Rotation of the section, which with shear strain is not the slope."""

    def mass_matrix(self) -> Floats:
        """Products of shapes over the member's own mass."""

    def mass_moments(self) -> tuple[Floats, Floats]:
        """Sums of shapes over the member's own mass, and with the position as weight."""

    def rotary_moments(self) -> Floats:
        """Sums of the sections' and bodies' own rotary inertia over the rotation of each shape."""

    def rotary_matrix(self) -> Floats:
        """Products of rotations over that inertia."""

    def slope_matrix(self) -> Floats:
        """Products of slopes over the length."""

    def stiffness_matrix(self) -> Floats:
        """Stiffness in these coordinates."""

    def weight_matrix(self) -> Floats:
        """What the member's own weight takes from the stiffness under unit gravity."""

    def deflection_integrals(self) -> Floats:
        """Integrals of the shapes over the length."""


class Straight(NamedTuple):
    """What a distribution of mass is while nothing bends: :class:`MassSums` has the same."""

    mass: Any
    moment: Any
    roll: Any
    pitch: Any
    yaw: Any


@dataclass(frozen=True, eq=False)
class MassSums:
    """Sums over mass along the axis e1 of a head, and over shapes of bending across it.

    The shapes are those to the left, then those up. Sums of distributions add up; the same sums of a drag per
    length instead of a mass per length state what the wind presses on.

    Parameters
    ----------
    mass : float
        Sum of m [kg].
    moment : float
        Sum of m x [kg m].
    roll, pitch, yaw : float
        Moments of inertia about e1, e2 and e3 [kg m^2]; mass on the axis has no first and equal others.
    first, second : ndarray, shape (n,)
        Sums of m phi_i and m x phi_i.
    products : ndarray, shape (n, n)
        Sums of m phi_i phi_j, of either direction with either.
    turned : ndarray, shape (n,)
        Sums of the sections' own rotary inertia times the rotation of each shape, as it turns along +e1.
    turned_products : ndarray, shape (n, n)
        Of that inertia times the rotations of two shapes.
    """

    mass: float
    moment: float
    roll: float
    pitch: float
    yaw: float
    first: Floats
    second: Floats
    products: Floats
    turned: Floats
    turned_products: Floats

    @property
    def straight(self) -> Straight:
        """The sums without shapes."""
        return Straight(self.mass, self.moment, self.roll, self.pitch, self.yaw)

    def __add__(self, other: MassSums) -> MassSums:
        return MassSums(*(getattr(self, own.name) + getattr(other, own.name) for own in fields(self)))

    def scaled(self, factor: float) -> MassSums:
        """The same distribution, ``factor`` times as heavy."""
        return MassSums(*(factor * getattr(self, own.name) for own in fields(self)))

    def among(self, shapes: NDArray[np.int64], count: int) -> MassSums:
        """The same sums where the shapes are some of more, in which the distribution does not move."""
        at, rows, squares = np.ix_(shapes, shapes), np.zeros((3, count)), np.zeros((2, count, count))
        rows[:, shapes] = self.first, self.second, self.turned
        squares[0][at], squares[1][at] = self.products, self.turned_products
        return MassSums(*self.straight, rows[0], rows[1], squares[0], rows[2], squares[1])


def point_sums(
    positions: ArrayLike, masses: ArrayLike, lateral: Basis, vertical: Basis, side: float = 1.0
) -> MassSums:
    """Sums over points of mass that move with the shapes: lumped masses, and others by quadrature.

    Parameters
    ----------
    positions, masses : array_like, shape (p,)
        Distances from the root of the shapes [m], and [kg].
    lateral, vertical : Basis
    side : float
        1 for a member along e1, -1 for one to the other side.
    """
    distance, m = np.atleast_1d(np.asarray(positions, dtype=float)), np.atleast_1d(np.asarray(masses, dtype=float))
    shapes, x = np.concatenate([lateral(distance), vertical(distance)]), side * distance
    inertia = float(m @ x**2)
    straight = float(m.sum()), float(m @ x), 0.0, inertia, inertia
    none, square = np.zeros(len(shapes)), np.zeros((len(shapes), len(shapes)))
    return MassSums(*straight, shapes @ m, shapes @ (m * x), (shapes * m) @ shapes.T, none, square)


def chain_sums(
    vertical: Chain, lateral: Chain | None, up: ChainModes, left: ChainModes, side: float = 1.0
) -> MassSums:
    """Sums over a member of segments and bodies, which are the same in both directions but for rotary inertia.

    Parameters
    ----------
    vertical, lateral : Chain
        As it bends up and to its left.
    up, left : ChainModes
        Their shapes.
    side : float
        As in :func:`point_sums`.
    """
    ends = np.union1d(up.shapes.ends, left.shapes.ends)
    points, weights = gauss()
    distance = (ends[:-1, None] + np.diff(ends)[:, None] * points).ravel()
    mass = vertical.section(distance, "mass_per_length") * (np.diff(ends)[:, None] * weights).ravel()
    places = [vertical.nodes[node] for node in vertical.bodies]
    weighing = [body.mass for body in vertical.bodies.values()]
    found = point_sums(np.append(distance, places), np.append(mass, weighing), left, up, side)
    pitch, yaw = (0.0 if member is None else member.inertia[3] for member in (vertical, lateral))
    turned = np.zeros_like(found.products)
    turned[: left.count, : left.count], turned[left.count :, left.count :] = left.rotary_matrix(), up.rotary_matrix()
    return replace(
        found,
        roll=found.roll + pitch + yaw,
        pitch=found.pitch + pitch,
        yaw=found.yaw + yaw,
        turned=side * np.concatenate([left.rotary_moments(), up.rotary_moments()]),
        turned_products=turned,
    )


def rigid_sums(
    mass: float, moment: float, inertia: float, shapes: int, *, roll: float = 0.0, yaw: float = 0.0
) -> MassSums:
    """Sums of a rigid part on the axis: counter-jib, counterweight, slewing platform.

    Parameters
    ----------
    mass, moment, inertia : float
        Sums of m, m x and m x^2 [kg, kg m, kg m^2].
    shapes : int
        Number of the jib's shapes, in which the part does not move.
    roll, yaw : float
        Moments of inertia about e1 and e3 beside those of mass on the axis [kg m^2].
    """
    none, square = np.zeros(shapes), np.zeros((shapes, shapes))
    return MassSums(mass, moment, roll, inertia, inertia + yaw, none, none, square, none, square)


def uniform_sums(length: float, mass_per_length: float, shapes: Basis, lateral: int, vertical: int) -> MassSums:
    """Sums over a uniform jib whose two directions have the same shapes, in closed form.

    Parameters
    ----------
    length, mass_per_length : float
        [m, kg/m]
    shapes : Basis
        At least as many as either direction uses.
    lateral, vertical : int
        How many of them each direction uses.
    """
    mass = length * mass_per_length
    used = np.concatenate([np.arange(lateral), np.arange(vertical)])
    first, second = shapes.mass_moments()
    inertia = mass * length**2 / 3.0
    straight = mass, 0.5 * mass * length, 0.0, inertia, inertia
    products, none = shapes.mass_matrix()[np.ix_(used, used)], np.zeros(len(used))
    return MassSums(*straight, first[used], second[used], products, none, np.zeros_like(products))
