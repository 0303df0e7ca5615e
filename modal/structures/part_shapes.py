"""Mode shapes along one part of a structure: polynomials between its pieces' ends, and their integrals."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]

DEFLECTION, ROTATION, FORCE, MOMENT, SLOPE = range(5)
"""What a shape is made of; the slope is the deflection's derivative, the rotation that of the section."""

_GAUSS_POINTS = 24


@dataclass(frozen=True, eq=False)
class PartShapes:
    """Shapes of n modes along one part of a structure: tower, jib or counter-jib.

    Parameters
    ----------
    ends : ndarray, shape (p + 1,)
        Distances from the part's foot between which the shapes are polynomials [m].
    coefficients : ndarray, shape (n, p, terms, 5)
        Taylor coefficients of deflection, rotation, transverse force, moment and slope in the fraction of a piece.
    mass_per_length, rotary_inertia, bending_stiffness, shear_flexibility, mass_flexibility : ndarray, shape (p, g)
        Properties at the Gauss points of every piece [kg/m], [kg m], [N m^2], [1/N], [m^2/N].
    """

    ends: Floats
    coefficients: Floats
    mass_per_length: Floats
    rotary_inertia: Floats
    bending_stiffness: Floats
    shear_flexibility: Floats
    mass_flexibility: Floats

    def evaluate(self, position: ArrayLike, quantity: int = DEFLECTION, derivative: int = 0) -> Floats:
        """A quantity of all modes, or its derivative, at positions along the part [m]; shape (n, *positions).

        Raises
        ------
        ValueError
            If a position is off the part or not a number, or the order is negative or no integer.
        """
        where, length = np.asarray(position, dtype=float), float(self.ends[-1])
        # A position that was added up from parts may pass the end by rounding.
        on_part = (where >= -1e-12 * length) & (where <= (1 + 1e-12) * length)
        if not on_part.all():
            raise ValueError(f"position: wanted 0 to {length!r} m, got {float(where[~on_part].flat[0])!r}")
        if derivative != int(derivative) or derivative < 0:
            raise ValueError(f"derivative: wanted an integer, zero or more, got {derivative!r}")
        flat = where.ravel()
        piece = np.clip(np.searchsorted(self.ends, flat, side="right") - 1, 0, self.ends.size - 2)
        width = np.diff(self.ends)[piece]
        fraction = (flat - self.ends[piece]) / width
        powers = np.polynomial.polynomial.polyder(self.coefficients[..., quantity], int(derivative), axis=2)
        values = np.zeros((len(powers), flat.size))
        for k in range(powers.shape[2] - 1, -1, -1):
            values = values * fraction + powers[:, piece, k]
        return (values / width ** int(derivative)).reshape(len(values), *where.shape)

    @cached_property
    def points(self) -> Floats:
        """Positions of the Gauss points [m], shape (p, g)."""
        return self.ends[:-1, None] + np.diff(self.ends)[:, None] * gauss()[0]

    @cached_property
    def weights(self) -> Floats:
        """Weights of the Gauss points [m], shape (p, g)."""
        return np.diff(self.ends)[:, None] * gauss()[1]

    def at_points(self, quantity: int) -> Floats:
        """A quantity of all modes at the Gauss points, shape (n, p, g)."""
        powers = gauss()[0] ** np.arange(self.coefficients.shape[2])[:, None]
        values: Floats = self.coefficients[..., quantity] @ powers
        return values

    @cached_property
    def inertia(self) -> Floats:
        """Inertia force per length of all modes at the Gauss points, ``-V'``, shape (n, p, g)."""
        order = np.arange(1, self.coefficients.shape[2])
        powers = order[:, None] * gauss()[0] ** (order - 1)[:, None]
        slopes: Floats = self.coefficients[:, :, 1:, FORCE] @ powers
        return -slopes / np.diff(self.ends)[:, None]

    @cached_property
    def motion(self) -> Floats:
        """Motion of the mass of all modes at the Gauss points, which its flexibility moves beyond the axis."""
        return self.at_points(DEFLECTION) + self.mass_flexibility * self.inertia

    def product(self, density: Floats | float, left: int, right: int) -> Floats:
        """Integrals of density times two quantities of all pairs of modes, shape (n, n)."""
        weighted = self.at_points(left) * (density * self.weights)
        return np.tensordot(weighted, self.at_points(right), ((1, 2), (1, 2)))

    def energies(self, density: Floats | float, quantity: int) -> Floats:
        """Integrals of density times the square of a quantity of each mode, shape (n,)."""
        return np.tensordot(self.at_points(quantity) ** 2, density * self.weights, 2)

    def mass_matrix(self) -> Floats:
        """Mass along the part, ``int m u u + rho I theta theta dx`` with the mass's motion u, shape (n, n)."""
        along = np.tensordot(self.motion * (self.mass_per_length * self.weights), self.motion, ((1, 2), (1, 2)))
        return along + self.product(self.rotary_inertia, ROTATION, ROTATION)

    def strain_matrix(self) -> Floats:
        """Stiffness along the part, shape (n, n).

        ``int EI theta' theta' + S (v' - theta) (v' - theta) + c V' V' dx`` with the flexibility c of the mass.
        """
        # From moments and shear strains, not from differences: with S infinite there is no strain.
        with np.errstate(divide="ignore"):
            stiff = np.where(self.shear_flexibility > 0.0, 1.0 / self.shear_flexibility, 0.0)
        strain = self.at_points(SLOPE) - self.at_points(ROTATION)
        shear = np.tensordot(strain * (stiff * self.weights), strain, ((1, 2), (1, 2)))
        moved = np.tensordot(self.inertia * (self.mass_flexibility * self.weights), self.inertia, ((1, 2), (1, 2)))
        return self.product(1.0 / self.bending_stiffness, MOMENT, MOMENT) + shear + moved

    def softening_matrix(self, compression: Floats | float, shear_theory: str = "haringx") -> Floats:
        """What an axial force takes from the stiffness, ``int P (v' theta + theta v' - theta theta) dx`` (Haringx).

        Parameters
        ----------
        compression : ndarray or float
            The force at the Gauss points, shape (p, g), or a number.
        shear_theory : {"haringx", "engesser"}
            With Engesser the integral is ``int P v' v' dx``.
        """
        if shear_theory == "engesser":
            return self.product(compression, SLOPE, SLOPE)
        mixed = self.product(compression, SLOPE, ROTATION)
        return mixed + mixed.T - self.product(compression, ROTATION, ROTATION)


@cache
def gauss() -> tuple[Floats, Floats]:
    """Gauss-Legendre points and weights on (0, 1), enough for products of two shapes."""
    points, weights = np.polynomial.legendre.leggauss(_GAUSS_POINTS)
    return 0.5 * (points + 1.0), 0.5 * weights
