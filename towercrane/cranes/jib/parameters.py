"""Parameters of a jib crane."""

from __future__ import annotations

from dataclasses import dataclass

from modal.checks import check_fields


@dataclass(frozen=True, slots=True)
class JibCrane:
    """Parameters of a jib crane with two straight, uniform booms in one vertical plane.

    Parameters
    ----------
    name : str
    post_height : float
        Height a_1 of the luffing hinge above the post's foot [m].
    post_inertia : float
        Moment of inertia J_1 of all that only slews, about the post [kg m^2].
    primary_length, secondary_length : float
        Lengths a_2 and a_3 of the booms [m].
    primary_mass_per_length, secondary_mass_per_length : float
        Masses per length rho_2 and rho_3 of the booms [kg/m].
    gravity : float
        Acceleration of gravity [m/s^2].

    Raises
    ------
    ValueError
        If a length, a mass per length or gravity is not positive, or height or inertia is negative.
    """

    name: str
    post_height: float
    post_inertia: float
    primary_length: float
    primary_mass_per_length: float
    secondary_length: float
    secondary_mass_per_length: float
    gravity: float = 9.81

    def __post_init__(self) -> None:
        booms = [f"{boom}_{what}" for boom in ("primary", "secondary") for what in ("length", "mass_per_length")]
        check_fields(self, positive=(*booms, "gravity"), not_negative=("post_height", "post_inertia"))

    @property
    def primary_mass(self) -> float:
        """Of the primary boom [kg]."""
        return self.primary_mass_per_length * self.primary_length

    @property
    def secondary_mass(self) -> float:
        """Of the secondary boom [kg]."""
        return self.secondary_mass_per_length * self.secondary_length
