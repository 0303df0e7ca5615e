"""Segment: a straight piece of a beam, uniform or tapered, in SI units."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, sqrt
from typing import TYPE_CHECKING

import numpy as np

from modal.checks import SMALLEST, check_fields, number_in

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Segment:
    """Straight piece of a beam, uniform or with a breadth that changes linearly along it.

    With the ratio r of the breadth at the far end to that at the near end, every property p of the section is
    ``p (1 + (r - 1) z / length)^power`` at the distance z from the near end.

    Parameters
    ----------
    length : float
        Length [m].
    mass_per_length : float
        Mass per unit length at the near end [kg/m].
    bending_stiffness : float
        Bending stiffness E I at the near end [N m^2].
    shear_stiffness : float
        Shear stiffness S at the near end, including any shear factor [N]; ``inf``: no shear strain.
    rotary_inertia : float
        Moment of inertia of the section per unit length, rho I, at the near end [kg m].
    end_ratio : float
        Breadth at the far end over that at the near end [1]; 1 is uniform.
    mass_power, bending_power, shear_power : float
        Powers of the breadth [1]: 1 and 3 for a wedge, 2 and 4 for a cone, 0 and 2 for four legs that draw
        together. The rotary inertia goes with the bending stiffness. That of the shear stiffness may be negative.
    inclined_chords : bool
        Whether the moment is carried by chords the breadth apart. Where they draw together they carry a part of the
        shear as well: the shear stiffness S strains under ``V + M b'/b`` with the breadth b.
    mass_flexibility : float
        How far the mass is moved from the axis per inertia force per length on it, c at the near end [m^2/N]; it goes
        with the breadth. With the frequency w the mass m moves as the deflection does, times ``1 / (1 - c m w^2)``.
    coupling : float
        Of bending and shear, g, the same all along [1/m]: ``M = EI (th' - g gam)``, ``S gam = V + g M``, with the
        section's rotation th and the shear strain gam. That of parallel diagonals; inclined chords add b'/b.

    Raises
    ------
    ValueError
        If a value is out of range or not a number.
    """

    length: float
    mass_per_length: float
    bending_stiffness: float
    shear_stiffness: float = inf
    rotary_inertia: float = 0.0
    end_ratio: float = 1.0
    mass_power: float = 0.0
    bending_power: float = 2.0
    shear_power: float = 0.0
    inclined_chords: bool = False
    mass_flexibility: float = 0.0
    coupling: float = 0.0

    def __post_init__(self) -> None:
        check_fields(
            self,
            positive=("length", "mass_per_length", "bending_stiffness", "end_ratio"),
            not_negative=("rotary_inertia", "mass_power", "bending_power", "mass_flexibility"),
        )
        number_in("Segment.shear_stiffness", self.shear_stiffness, "a positive number", least=SMALLEST, most=inf)
        for name in ("shear_power", "coupling"):
            number_in(f"Segment.{name}", getattr(self, name), "a finite number")

    @property
    def mass(self) -> float:
        """Total mass [kg]."""
        return float(self.mass_within(np.asarray(self.length)))

    @property
    def mass_frequency(self) -> float:
        """Angular frequency of the mass on its flexibility alone [rad/s], the lowest; no mode of bending has more."""
        if self.mass_flexibility == 0.0:
            return inf
        broadest = max(1.0, self.end_ratio) ** (1.0 + self.mass_power)
        return 1.0 / sqrt(self.mass_flexibility * self.mass_per_length * broadest)

    def breadth(self, distance: Floats) -> Floats:
        """Breadth at distances from the near end over that at the near end [1]."""
        return 1.0 + (self.end_ratio - 1.0) * distance / self.length

    def section(self, name: str, distance: Floats) -> Floats:
        """A property of the section, by the name of its field, at distances from the near end."""
        powers = {"mass_per_length": self.mass_power, "shear_stiffness": self.shear_power, "mass_flexibility": 1.0}
        value: Floats = getattr(self, name) * self.breadth(distance) ** powers.get(name, self.bending_power)
        return value

    def mass_within(self, distance: Floats) -> Floats:
        """Mass between the near end and distances from it [kg]."""
        if self.end_ratio == 1.0 or self.mass_power == 0.0:
            return self.mass_per_length * distance
        change, power = self.end_ratio - 1.0, self.mass_power + 1.0
        # By way of logarithms, so that a taper as small as rounding loses nothing; a thin end may round to nothing.
        part = np.log1p(np.maximum(change * distance / self.length, -1.0 + 1e-16))
        return self.mass_per_length * self.length * np.expm1(power * part) / (change * power)

    def split(self, distance: float) -> tuple[Segment, Segment]:
        """The same piece as two, cut at a distance from its near end [m].

        Raises
        ------
        ValueError
            If the distance is not inside the segment.
        """
        if not 0.0 < distance < self.length:
            raise ValueError(f"distance: wanted a cut inside 0 to {self.length!r} m, got {distance!r}")
        breadth = float(self.breadth(np.asarray(distance)))
        powers = self.mass_power, self.bending_power, self.shear_power, self.inclined_chords
        near = Segment(
            distance, self.mass_per_length, self.bending_stiffness, self.shear_stiffness, self.rotary_inertia,
            breadth, *powers, self.mass_flexibility, self.coupling,
        )  # fmt: skip
        far = Segment(
            self.length - distance,
            self.mass_per_length * breadth**self.mass_power,
            self.bending_stiffness * breadth**self.bending_power,
            self.shear_stiffness * breadth**self.shear_power,
            self.rotary_inertia * breadth**self.bending_power,
            self.end_ratio / breadth,
            *powers,
            self.mass_flexibility * breadth,
            self.coupling,
        )
        return near, far
