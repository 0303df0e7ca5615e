"""What a section of a lattice is made of: chords at points, and walls of lacing between two of them."""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot, sqrt
from typing import TYPE_CHECKING, Literal, get_args

import numpy as np

from modal.checks import check_fields, number_in

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

Lacing = Literal["zigzag", "X", "N"]


@dataclass(frozen=True, slots=True)
class Chord:
    """Chord of a lattice where a section cuts it.

    Parameters
    ----------
    y, z : float
        Its place in the section, from the reference line, z upward [m].
    area : float
        Cross-sectional area [m^2].
    slope_y, slope_z : float
        Changes of y and z per length along the reference line [1].
    further_mass : float
        Mass per length that it bears, besides its own [kg/m].
    """

    y: float
    z: float
    area: float
    slope_y: float = 0.0
    slope_z: float = 0.0
    further_mass: float = 0.0

    def __post_init__(self) -> None:
        check_fields(self, positive=("area",), not_negative=("further_mass",))
        for name in ("y", "z", "slope_y", "slope_z"):
            number_in(f"Chord.{name}", getattr(self, name), "a finite number")

    @property
    def stretch(self) -> float:
        """Its length per length of the reference line [1]."""
        return sqrt(1.0 + self.slope_y**2 + self.slope_z**2)

    def strain(self) -> Floats:
        """Its change of length per length of the reference line by the section's strains, shape (6,)."""
        y, z, y_x, z_x = self.y, self.z, self.slope_y, self.slope_z
        return np.array([1.0, y_x, z_x, y * z_x - z * y_x, z, -y])


@dataclass(frozen=True, slots=True)
class Wall:
    """Lacing between two chords, the same from panel to panel.

    Parameters
    ----------
    first, second : int
        Which chords.
    lacing : {"zigzag", "X", "N"}
        One diagonal a panel, alternating; two that cross; or one, all parallel, with a post at each node. A zigzag
        starts from the first chord; parallel diagonals lead outward from the first chord to the second.
    panel : float
        Length along the reference line that one diagonal spans [m].
    diagonal_area : float
        Cross-sectional area of one diagonal [m^2].
    post_area : float
        Cross-sectional area of one post between opposite nodes [m^2]; 0: there are none. "N" needs them.
    """

    first: int
    second: int
    lacing: Lacing
    panel: float
    diagonal_area: float
    post_area: float = 0.0

    def __post_init__(self) -> None:
        check_fields(self, positive=("panel", "diagonal_area"), not_negative=("post_area",))
        if self.lacing not in get_args(Lacing):
            raise ValueError(f"Wall.lacing: wanted one of {get_args(Lacing)}, got {self.lacing!r}")
        if self.lacing == "N" and self.post_area == 0.0:
            raise ValueError("Wall.post_area: N lacing carries shear through its posts, got 0")

    def shear_flexibility(self, depth: float, youngs_modulus: float) -> float:
        """Shear strain per shear force of the wall with this distance of its chords, 1/S without sawtooth [1/N]."""
        diagonals = (2.0 if self.lacing == "X" else 1.0) * self.diagonal_area
        found = hypot(self.panel, depth) ** 3 / (youngs_modulus * diagonals * self.panel * depth**2)
        if self.lacing == "N":
            found += depth / (youngs_modulus * self.post_area * self.panel)
        return found

    def chord_area(self, depth: float) -> float:
        """Area of the chord at mid wall that crossed diagonals are worth, as far as posts keep the chords apart."""
        if self.lacing != "X":
            return 0.0
        d = hypot(self.panel, depth)
        c, s = self.panel / d, depth / d
        # Strain of the posts per unit strain of the chords, from their balance with the diagonals.
        e_h = -2.0 * self.diagonal_area * s * c**2 / (self.post_area + 2.0 * self.diagonal_area * s**3)
        return 2.0 * self.diagonal_area * c * (c**2 + e_h * s**2)

    def volume(self, depth: float) -> float:
        """Volume of diagonals and posts per length of the reference line [m^2]."""
        count = 2.0 if self.lacing == "X" else 1.0
        return (count * self.diagonal_area * hypot(self.panel, depth) + self.post_area * depth) / self.panel
