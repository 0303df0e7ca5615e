"""Mass of what turns on a tower, summed once: all that the equations of the flexible crane need to know of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

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
    """

    mass: float
    moment: float
    roll: float
    pitch: float
    yaw: float
    first: Floats
    second: Floats
    products: Floats

    @property
    def straight(self) -> Straight:
        """The sums without shapes."""
        return Straight(self.mass, self.moment, self.roll, self.pitch, self.yaw)

    def __add__(self, other: MassSums) -> MassSums:
        return MassSums(
            self.mass + other.mass,
            self.moment + other.moment,
            self.roll + other.roll,
            self.pitch + other.pitch,
            self.yaw + other.yaw,
            self.first + other.first,
            self.second + other.second,
            self.products + other.products,
        )

    def scaled(self, factor: float) -> MassSums:
        """The same distribution, ``factor`` times as heavy."""
        return MassSums(
            factor * self.mass,
            factor * self.moment,
            factor * self.roll,
            factor * self.pitch,
            factor * self.yaw,
            factor * self.first,
            factor * self.second,
            factor * self.products,
        )


def point_sums(positions: ArrayLike, masses: ArrayLike, lateral: Basis, vertical: Basis) -> MassSums:
    """Sums over points of mass that move with the shapes: a lumped tip, a tapered jib by quadrature.

    Parameters
    ----------
    positions, masses : array_like, shape (p,)
        Along the jib [m], and [kg].
    lateral, vertical : Basis
    """
    x, m = np.atleast_1d(np.asarray(positions, dtype=float)), np.atleast_1d(np.asarray(masses, dtype=float))
    shapes = np.concatenate([lateral(x), vertical(x)])
    inertia = float(m @ x**2)
    return MassSums(
        float(m.sum()), float(m @ x), 0.0, inertia, inertia, shapes @ m, shapes @ (m * x), (shapes * m) @ shapes.T
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
    none = np.zeros(shapes)
    return MassSums(mass, moment, roll, inertia, inertia + yaw, none, none, np.zeros((shapes, shapes)))


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
    return MassSums(
        mass,
        0.5 * mass * length,
        0.0,
        inertia,
        inertia,
        first[used],
        second[used],
        shapes.mass_matrix()[np.ix_(used, used)],
    )
