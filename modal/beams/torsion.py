"""Uniform shaft clamped at one end, with a rigid body at the other: natural modes of torsion."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, sqrt
from typing import TYPE_CHECKING

import numpy as np

from modal.checks import check_fields, number_in, whole_number

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Shaft:
    """Uniform shaft in torsion.

    Parameters
    ----------
    length : float
        Length [m].
    inertia_per_length : float
        Moment of inertia about the axis per unit length [kg m].
    torsional_stiffness : float
        Torque per twist per length, G J [N m^2].

    Raises
    ------
    ValueError
        If a value is not a positive finite number.
    """

    length: float
    inertia_per_length: float
    torsional_stiffness: float

    def __post_init__(self) -> None:
        check_fields(self, positive=self.__slots__)

    @property
    def inertia(self) -> float:
        """Moment of inertia about the axis [kg m^2]."""
        return self.inertia_per_length * self.length


@dataclass(frozen=True, eq=False)
class TorsionModes:
    """Natural modes of torsion, phi_i = A_i sin(y_i z / L), clamped at position 0.

    Made by `torsion_modes`. They are orthonormal in the inertia of shaft and body together, so phi is in
    (kg m^2)^-1/2.

    Parameters
    ----------
    shaft : Shaft
    end_inertia : float
        Of the body at position L [kg m^2].
    roots : ndarray, shape (n,)
        y_i, ascending [rad].
    amplitudes : ndarray, shape (n,)
        A_i [(kg m^2)^-1/2].
    """

    shaft: Shaft
    end_inertia: float
    roots: Floats
    amplitudes: Floats

    @property
    def count(self) -> int:
        """Number of modes, n."""
        return int(self.roots.size)

    @property
    def angular_frequencies(self) -> Floats:
        """Natural angular frequencies [rad/s], shape (n,)."""
        return self.roots / self.shaft.length * sqrt(self.shaft.torsional_stiffness / self.shaft.inertia_per_length)

    def __call__(self, position: ArrayLike) -> Floats:
        """Twist at positions along the shaft [(kg m^2)^-1/2], shape (n, *shape of position)."""
        z = np.asarray(position, dtype=float) / self.shaft.length
        return np.multiply.outer(self.amplitudes, np.ones_like(z)) * np.sin(np.multiply.outer(self.roots, z))

    def mass_matrix(self) -> Floats:
        """Inertia of the shaft alone, int j phi_i phi_j dz [1], shape (n, n)."""
        difference = np.subtract.outer(self.roots, self.roots)
        # numpy's sinc is sin(pi x) / (pi x).
        products = 0.5 * (np.sinc(difference / pi) - np.sinc(np.add.outer(self.roots, self.roots) / pi))
        return self.shaft.inertia * products * np.outer(self.amplitudes, self.amplitudes)

    def mass_moment(self) -> Floats:
        """First sum int j phi dz [(kg m^2)^1/2], shape (n,)."""
        return self.shaft.inertia * self.amplitudes * (1.0 - np.cos(self.roots)) / self.roots


def torsion_modes(shaft: Shaft, count: int, end_inertia: float = 0.0) -> TorsionModes:
    """Natural modes of torsion of a uniform shaft with a rigid body at its end.

    Parameters
    ----------
    shaft : Shaft
    count : int
        Number of modes, zero or more.
    end_inertia : float
        Moment of inertia of the body about the axis [kg m^2], zero or more.

    Raises
    ------
    ValueError
        If the count or the inertia is negative or not finite.

    Notes
    -----
    With a = end_inertia / (shaft's inertia) the roots solve cos y = a y sin y, one from each i pi to (i + 1/2) pi.
    """
    whole_number("count", count)
    number_in("end_inertia", end_inertia, "zero or more", least=0.0)
    ratio = end_inertia / shaft.inertia

    roots = np.array([_root(i, ratio) for i in range(count)])
    # The square of the norm over the shaft, int sin^2 = 1/2 - sin(2 y) / 4 y, and the body's share.
    share = 0.5 * (1.0 - np.sinc(2.0 * roots / pi)) + ratio * np.sin(roots) ** 2
    # Signs turn the end to the positive side.
    amplitudes = np.sign(np.sin(roots)) / np.sqrt(shaft.inertia * share)
    roots.setflags(write=False)
    amplitudes.setflags(write=False)
    return TorsionModes(shaft, end_inertia, roots, amplitudes)


def _root(index: int, ratio: float) -> float:
    """Root of cos y = ratio y sin y above index pi."""
    # Here, since most cranes keep no torsion: scipy.optimize takes a quarter of a second to import.
    from scipy.optimize import brentq

    def excess(y: float) -> float:
        return float(np.cos(y) - ratio * y * np.sin(y))

    return float(brentq(excess, index * pi, (index + 0.75) * pi, xtol=1e-300, rtol=1e-15))
