"""Uniform beam and the rigid body at its end, in SI units."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

from modal.checks import check_fields, number_in


@dataclass(frozen=True, slots=True)
class Beam:
    """Uniform Euler-Bernoulli beam.

    Parameters
    ----------
    length : float
        Length [m].
    mass_per_length : float
        Mass per unit length [kg/m].
    youngs_modulus : float
        Young's modulus [Pa].
    second_moment_of_area : float
        Second moment of area in the plane of bending [m^4].

    Raises
    ------
    ValueError
        If a value is not a positive finite number.
    """

    length: float
    mass_per_length: float
    youngs_modulus: float
    second_moment_of_area: float

    def __post_init__(self) -> None:
        check_fields(self, positive=self.__slots__)

    @property
    def mass(self) -> float:
        """Total mass [kg]."""
        return self.mass_per_length * self.length

    @property
    def bending_stiffness(self) -> float:
        """Bending stiffness E I [N m^2]."""
        return self.youngs_modulus * self.second_moment_of_area


@dataclass(frozen=True, slots=True)
class EndBody:
    """Rigid body on the free end of a beam.

    Parameters
    ----------
    mass : float
        Mass [kg]; ``inf`` pins the end.
    rotary_inertia : float
        Moment of inertia about the body's own centre of mass [kg m^2]; ``inf`` keeps the end from rotating.
    offset : float
        Distance of the centre of mass beyond the end of the beam, along its axis [m]; negative: short of it.

    Raises
    ------
    ValueError
        If mass or inertia is negative or not a number, or the offset is not finite.
    """

    mass: float = 0.0
    rotary_inertia: float = 0.0
    offset: float = 0.0

    def __post_init__(self) -> None:
        for name in ("mass", "rotary_inertia"):
            number_in(f"EndBody.{name}", getattr(self, name), "zero or more", least=0.0, most=inf)
        number_in("EndBody.offset", self.offset, "a finite number")
