"""Parameters of an overhead crane, and its bridge as one degree of freedom."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from modal.checks import check_fields


@dataclass(frozen=True, slots=True, kw_only=True)
class OverheadCrane:
    """Parameters of an overhead crane; each is named by its table and its key.

    Parameters
    ----------
    name : str
    runway_height, runway_length : float
        Height of the rails above the floor, and their length [m].
    bridge_span : float
        Distance of the rails [m].
    bridge_mass_per_length, bridge_youngs_modulus, bridge_second_moment_of_area : float
        Of all girders together [kg/m, Pa, m^4].
    bridge_damping_ratio : float
        Of the bare girder's first mode.
    bridge_end_carriage_mass : float
        What travels with the bridge without bending, on both rails together [kg].
    trolley_mass : float
        [kg]
    gravity : float
        [m/s^2]

    Raises
    ------
    ValueError
        If a number is not finite, a length, a mass, a stiffness or gravity is not positive, or the damping or the
        end carriages' mass is negative.
    """

    name: str
    runway_height: float
    runway_length: float
    bridge_span: float
    bridge_mass_per_length: float
    bridge_youngs_modulus: float
    bridge_second_moment_of_area: float
    trolley_mass: float
    bridge_damping_ratio: float = 0.0
    bridge_end_carriage_mass: float = 0.0
    gravity: float = 9.81

    def __post_init__(self) -> None:
        may_be_zero = ("bridge_damping_ratio", "bridge_end_carriage_mass")
        positive = (name for name in self.__slots__ if name not in ("name", *may_be_zero))
        check_fields(self, positive=tuple(positive), not_negative=may_be_zero)

    @property
    def girder_mass(self) -> float:
        """Mass of the girders [kg], half of which moves with the uplift at mid-span."""
        return self.bridge_mass_per_length * self.bridge_span

    @property
    def stiffness(self) -> float:
        """Of the uplift at mid-span, pi^4 E I / (2 S^3) [N/m], see :mod:`towercrane.cranes.overhead.equations`."""
        bending = self.bridge_youngs_modulus * self.bridge_second_moment_of_area
        return float(0.5 * np.pi**4 * bending / self.bridge_span**3)

    @property
    def damping(self) -> float:
        """Of the uplift at mid-span [N s/m]."""
        return float(2.0 * self.bridge_damping_ratio * np.sqrt(self.stiffness * 0.5 * self.girder_mass))

    @property
    def frequency(self) -> float:
        """Angular frequency of the bare girder [rad/s]."""
        return float(np.sqrt(self.stiffness / (0.5 * self.girder_mass)))

    def uplift_at_rest(self, place: float, load_mass: float) -> float:
        """Uplift at mid-span under all weights, with trolley and load at a place on the bridge; negative [m]."""
        carried = (self.trolley_mass + load_mass) * np.sin(np.pi * place / self.bridge_span)
        return float(-self.gravity * (2.0 / np.pi * self.girder_mass + carried) / self.stiffness)
