"""A tower of another torsional stiffness: the same shapes at other frequencies."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from towercrane.cranes.tower.modes.modal_crane import TorsionBasis

    Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class ScaledTorsion:
    """Shapes of torsion with their stiffness scaled; they depend on the ratios of inertias alone.

    Parameters
    ----------
    basis : TorsionBasis
    factor : float
        Of the stiffness, positive.
    """

    basis: TorsionBasis
    factor: float

    @property
    def count(self) -> int:
        """Number of shapes."""
        return self.basis.count

    @property
    def angular_frequencies(self) -> Floats:
        """Square roots of the stiffness of each shape by itself [rad/s]."""
        return np.asarray(np.sqrt(self.factor) * self.basis.angular_frequencies)

    def __call__(self, position: ArrayLike) -> Floats:
        """Twist, shape (count, *shape of position)."""
        return self.basis(position)

    def mass_matrix(self) -> Floats:
        """Products of shapes over the tower's own inertia."""
        return self.basis.mass_matrix()

    def mass_moment(self) -> Floats:
        """Sums of shapes over the tower's own inertia."""
        return self.basis.mass_moment()
