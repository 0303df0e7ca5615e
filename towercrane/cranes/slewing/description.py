"""What a lumped crane is made of: points on arms, springs, a drive, and what is read off them.

A new crane from a paper is one such description; nothing of it is code.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

import numpy as np

from modal.checks import check_fields

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.kernels.elastic_rope import Elasticity

    Floats = NDArray[np.float64]

Row = Mapping[str, float]
"""Linear form: coefficient per coordinate; the key "" is the constant."""


@dataclass(frozen=True)
class Link:
    """Arm of a point's horizontal position.

    Parameters
    ----------
    turns_with : str
        Coordinate that turns it about the vertical; empty for fixed axes.
    ahead, across : Row
        Along the arm and to its left [m].
    """

    turns_with: str
    ahead: Row
    across: Row = field(default_factory=dict)


@dataclass(frozen=True)
class Point:
    """Point mass.

    Parameters
    ----------
    mass : float
        [kg]
    links : tuple of Link
        Their sum is the horizontal position.
    height : Row
        [m]
    drag : float or tuple of 3 floats
        Drag per squared speed [kg/m]; three values: along the last link's arm, across it and up.
    """

    mass: float
    links: tuple[Link, ...]
    height: Row
    drag: float | tuple[float, float, float] = 0.0

    def __post_init__(self) -> None:
        check_fields(self, not_negative=("mass",))


@dataclass(frozen=True)
class Spring:
    """Spring with a damper beside it.

    Parameters
    ----------
    name : str
        What it stands for, such as "jib_lateral".
    stretch : Row
        Linear form whose value is the stretch [m or rad].
    stiffness, damping : float
        [N/m, N s/m or N m/rad, N m s/rad]
    """

    name: str
    stretch: Row
    stiffness: float
    damping: float = 0.0

    def __post_init__(self) -> None:
        check_fields(self, not_negative=("stiffness", "damping"))


@dataclass(frozen=True)
class Drive:
    """Coupling of three straight lines between the shaft and a coordinate, and friction on that coordinate.

    Parameters
    ----------
    on : str
        Coordinate.
    soft, stiff, corner : float
        Stiffness up to the corner and beyond it [N m/rad], and the corner [rad].
    damping : float
        Between shaft and coordinate [N m s/rad].
    friction : {"none", "tanh", "stick-slip"}
    friction_torque, friction_rate : float
        Limit [N m], and the rate at which tanh reaches 76 % of it [rad/s].

    Raises
    ------
    ValueError
        If a number is negative or not finite, the corner zero, or the law another.
    """

    on: str
    soft: float
    stiff: float
    corner: float
    damping: float
    friction: Literal["none", "tanh", "stick-slip"] = "tanh"
    friction_torque: float = 0.0
    friction_rate: float = 0.01

    @property
    def free(self) -> bool:
        """Whether its coupling holds nothing, so that its friction alone is left."""
        return not (self.soft or self.stiff or self.damping)

    def __post_init__(self) -> None:
        check_fields(self, positive=("corner",), not_negative=("soft", "stiff", "damping", "friction_torque"))
        if self.friction not in ("none", "tanh", "stick-slip"):
            raise ValueError(f"Drive.friction: wanted 'none', 'tanh' or 'stick-slip', got {self.friction!r}")
        if self.friction == "tanh":
            check_fields(self, positive=("friction_rate",))


@dataclass(frozen=True)
class LinearOutput:
    """Output that is linear in coordinates and rates.

    Parameters
    ----------
    units, long_name : str
    of : Row
        On the coordinates.
    of_rates : Row
        On their rates.
    """

    units: str
    long_name: str
    of: Row = field(default_factory=dict)
    of_rates: Row = field(default_factory=dict)


@dataclass(frozen=True)
class LumpedCrane:
    """Crane of point masses and springs.

    Parameters
    ----------
    name : str
    coordinates : tuple of str
    points : mapping of str to Point
    springs : tuple of Spring
    drive : Drive
    inertias : Row
        Moments of inertia of coordinates that are angles [kg m^2].
    steady_force : Row
        Constant generalised forces.
    counter_moments : Row
        Weights times radius [N m] that no point has, opposite to the arms that a coordinate turns.
    suspension : str
        Point that the rope hangs from.
    jib_angle : str
        Coordinate that turns with the jib: sway is measured along and across it.
    linear_outputs : mapping of str to LinearOutput
    rope : Elasticity or None
        Of a rope that belongs to the crane and stretches.
    gravity : float
        [m/s^2]
    """

    name: str
    coordinates: tuple[str, ...]
    points: Mapping[str, Point]
    springs: tuple[Spring, ...]
    drive: Drive
    inertias: Row
    suspension: str
    jib_angle: str
    linear_outputs: Mapping[str, LinearOutput]
    steady_force: Row = field(default_factory=dict)
    counter_moments: Row = field(default_factory=dict)
    rope: Elasticity | None = None
    gravity: float = 9.81

    @property
    def angles(self) -> frozenset[str]:
        """Coordinates that are angles: arms turn with them, or they have moments of inertia."""
        return frozenset(link.turns_with for p in self.points.values() for link in p.links) | frozenset(self.inertias)

    def row(self, form: Row) -> Floats:
        """A linear form as a vector over the coordinates, its constant last; shape (n + 1,).

        Raises
        ------
        ValueError
            If it names an unknown coordinate.
        """
        if unknown := set(form) - {*self.coordinates, ""}:
            raise ValueError(f"{self.name}: wanted coordinates {', '.join(self.coordinates)}, got {min(unknown)!r}")
        return np.array([form.get(name, 0.0) for name in (*self.coordinates, "")])
