"""Shapes of a jib between its foot and its head, seen from the chord that joins them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from modal.checks import whole_number

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from modal.beams.beam import Beam

    Floats = NDArray[np.float64]

POINTS = 100
"""Of the quadrature over a jib: exact to rounding for as many shapes as a model can have."""


def quadrature(length: float) -> tuple[Floats, Floats]:
    """Gauss points along a jib and their weights [m]."""
    points, weights = np.polynomial.legendre.leggauss(POINTS)
    return 0.5 * length * (points + 1.0), 0.5 * length * weights


@dataclass(frozen=True, eq=False)
class ChordShapes:
    """Shapes of a uniform beam that vanish at both ends, orthonormal in its mass and its bending stiffness.

    They span sin(pi x/L), then x^3/L^2 - x, then the sines of higher order. The polynomial is the deflection under a
    couple at the head, as a rope brings that is tied above the chord: sines alone would converge slowly to it.

    Parameters
    ----------
    beam : Beam
    count : int
        Number of shapes, n.
    """

    beam: Beam
    count: int

    def __post_init__(self) -> None:
        whole_number("ChordShapes.count", self.count)

    @cached_property
    def _solved(self) -> tuple[Floats, Floats]:
        """Squared angular frequencies, and what each shape is of the functions; shapes (n,) and (n, n)."""
        from scipy.linalg import eigh

        if not self.count:
            return np.zeros(0), np.zeros((0, 0))
        x, weights = quadrature(self.beam.length)
        bent, curved = self._functions(x, 0), self._functions(x, 2)
        mass = self.beam.mass_per_length * (bent * weights) @ bent.T
        stiffness = self.beam.bending_stiffness * (curved * weights) @ curved.T
        squared, vectors = eigh(stiffness, mass)
        # Positive is up at the foot.
        return squared, vectors.T * np.sign(vectors.T @ self._functions(np.zeros(1), 1))

    @property
    def angular_frequencies(self) -> Floats:
        """Of each shape by itself on a beam that both ends hold [rad/s], shape (n,)."""
        return np.sqrt(self._solved[0])

    def __call__(self, position: ArrayLike, derivative: int = 0) -> Floats:
        """Shapes [kg^-1/2] or their derivatives at positions from 0 to L, shape (n, *shape of position)."""
        where = np.asarray(position, dtype=float)
        values = self._solved[1] @ self._functions(where.ravel(), derivative)
        return np.asarray(values.reshape(self.count, *where.shape))

    def rotation(self, position: ArrayLike) -> Floats:
        """Rotation of the section: the slope, as there is no shear strain."""
        return self(position, 1)

    def mass_matrix(self) -> Floats:
        """Products of shapes over the beam's mass [1], shape (n, n)."""
        return np.eye(self.count)

    def stiffness_matrix(self) -> Floats:
        """Stiffness [1/s^2], shape (n, n)."""
        return np.diag(self._solved[0])

    def mass_moments(self) -> tuple[Floats, Floats]:
        """First moments ``int m phi dx`` [kg^1/2] and ``int m x phi dx`` [kg^1/2 m], of shape (n,) each."""
        x, weights = quadrature(self.beam.length)
        rows = self(x) * (self.beam.mass_per_length * weights)
        return rows.sum(axis=1), rows @ x

    def rotary_moments(self) -> Floats:
        """Moment of momentum of the sections' own rotary inertia, shape (n,): none here."""
        return np.zeros(self.count)

    def rotary_matrix(self) -> Floats:
        """What that adds to the mass matrix, shape (n, n)."""
        return np.zeros((self.count, self.count))

    def deflection_integrals(self) -> Floats:
        """Integrals ``int phi dx`` [m kg^-1/2], shape (n,)."""
        return self.mass_moments()[0] / self.beam.mass_per_length

    def slope_matrix(self) -> Floats:
        """Products of slopes, ``int phi_i' phi_j' dx`` [1/(kg m)], shape (n, n)."""
        x, weights = quadrature(self.beam.length)
        slopes = self(x, 1)
        return np.asarray((slopes * weights) @ slopes.T)

    def weight_matrix(self) -> Floats:
        """Products of slopes with the beam's mass beyond, ``int m (L - x) phi_i' phi_j' dx`` [1/m], shape (n, n)."""
        x, weights = quadrature(self.beam.length)
        slopes = self(x, 1)
        return np.asarray((slopes * (weights * self.beam.mass_per_length * (self.beam.length - x))) @ slopes.T)

    def _functions(self, x: Floats, derivative: int) -> Floats:
        """The functions that the shapes are made of, or their derivatives; shape (n, p)."""
        length = self.beam.length
        # Of two shapes and more one is the polynomial.
        waves = np.arange(1, max(self.count, 2))[:, None] * pi / length
        rows = (waves**derivative * np.sin(waves * x + 0.5 * pi * derivative))[: self.count]
        if self.count < 2:
            return np.asarray(rows)
        powers = np.polynomial.Polynomial([0.0, -1.0, 0.0, 1.0 / length**2]).deriv(derivative)
        return np.asarray(np.insert(rows, 1, powers(x), axis=0))
