"""Parameters of the lumped slewing cranes, one frozen table per model.

Sources: Marinovic, Sprecic, Jerman 2012 (multi-mass); Jerman 2006 (basic, enhanced). Springs and dampers of one
name differ in kind between the models: the basic model's jib shifts sideways [N/m], the others' jib turns [N m/rad].
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Literal

from modal.checks import check_fields

FrictionLaw = Literal["tanh", "stick-slip", "none"]

MAY_BE_ZERO = ("damping_", "drag_", "drive_damping", "friction_", "geometry_top_height", "mass_tower_top",
               "mass_counter_moment")  # fmt: skip
"""Beginnings of the names whose value may be zero."""


@dataclass(frozen=True, kw_only=True)
class SlewingParameters:
    """What all lumped slewing cranes share.

    Parameters
    ----------
    name : str
        Name of the crane.
    gravity : float
        Gravity [m/s^2].
    geometry_tower_height, geometry_top_height, geometry_jib_radius : float
        Lever of the tower's tilt H0, piece on its top T0, and distance of the jib's tip R0 [m].
    mass_jib_tip : float
        Mass at the jib's tip [kg].
    inertia_platform : float
        Moment of inertia of the platform J1 [kg m^2].
    stiffness_jib_lateral, stiffness_jib_vertical : float
        Springs of the jib: sideways [N m/rad; basic: N/m] and vertical [N/m].
    damping_jib_lateral, damping_jib_vertical : float
        Dampers beside them [N m s/rad; basic: N s/m] and [N s/m].
    drive_soft_stiffness, drive_stiff_stiffness, drive_corner, drive_damping : float
        Coupling of shaft and platform: stiffness up to the corner and beyond it [N m/rad], corner [rad],
        damping [N m s/rad].
    friction_law : {"tanh", "stick-slip", "none"}
        Law of the bearing's friction.
    friction_torque, friction_rate : float
        Torque [N m] and, for tanh, the platform's rate at which the law bends [rad/s].
    drag_jib_tip : float
        Air drag of the jib's tip per squared speed [kg/m].

    Raises
    ------
    ValueError
        If a number is negative or not finite, or zero where that leaves no crane.
    """

    name: str
    gravity: float
    geometry_tower_height: float
    geometry_top_height: float
    geometry_jib_radius: float
    mass_jib_tip: float
    inertia_platform: float
    stiffness_jib_lateral: float
    stiffness_jib_vertical: float
    damping_jib_lateral: float
    damping_jib_vertical: float
    drive_soft_stiffness: float
    drive_stiff_stiffness: float
    drive_corner: float
    drive_damping: float
    friction_law: FrictionLaw
    friction_torque: float
    friction_rate: float
    drag_jib_tip: float

    def __post_init__(self) -> None:
        for field in fields(self):
            if field.name not in ("name", "friction_law"):
                way = "not_negative" if field.name.startswith(MAY_BE_ZERO) else "positive"
                check_fields(self, **{way: (field.name,)})
        if self.friction_law not in ("tanh", "stick-slip", "none"):
            wanted = "'tanh', 'stick-slip' or 'none'"
            raise ValueError(f"{type(self).__name__}.friction_law: wanted {wanted}, got {self.friction_law!r}")
        if self.friction_law == "tanh" and self.friction_rate == 0.0:
            raise ValueError(f"{type(self).__name__}.friction_rate: wanted a positive number for 'tanh', got 0.0")

    @property
    def suspension_height(self) -> float:
        """Height of the undeformed jib, H0 + T0 [m]."""
        return self.geometry_tower_height + self.geometry_top_height


@dataclass(frozen=True, kw_only=True)
class BasicParameters(SlewingParameters):
    """Basic model: the jib's tip on springs that turn with the platform, and a rope that stretches.

    Parameters
    ----------
    stiffness_jib_radial, stiffness_rope : float
        Springs along the jib and of the rope [N/m].
    damping_jib_radial, damping_rope : float
        Dampers beside them [N s/m].
    """

    stiffness_jib_radial: float
    stiffness_rope: float
    damping_jib_radial: float
    damping_rope: float


@dataclass(frozen=True, kw_only=True)
class TowerParameters(SlewingParameters):
    """What the models with a tower share.

    Parameters
    ----------
    mass_tower_top : float
        Mass at the tower's top [kg].
    inertia_tower_top : float
        Moment of inertia of the tower's top J2 [kg m^2].
    stiffness_tower_x, stiffness_tower_y, stiffness_tower_torsion : float
        Springs of the tower's top along the jib and across it [N/m], and in torsion [N m/rad].
    damping_tower_x, damping_tower_y, damping_tower_torsion : float
        Dampers beside them [N s/m, N m s/rad].
    drag_tower_top : float
        Air drag of the tower's top per squared speed [kg/m].
    """

    mass_tower_top: float
    inertia_tower_top: float
    stiffness_tower_x: float
    stiffness_tower_y: float
    stiffness_tower_torsion: float
    damping_tower_x: float
    damping_tower_y: float
    damping_tower_torsion: float
    drag_tower_top: float


@dataclass(frozen=True, kw_only=True)
class EnhancedParameters(TowerParameters):
    """Enhanced model: the counterweight enters by its moment alone.

    Parameters
    ----------
    mass_counter_moment : float
        Counterweight times its radius [kg m].
    """

    mass_counter_moment: float


@dataclass(frozen=True, kw_only=True)
class MultiMassParameters(TowerParameters):
    """Multi-mass model: the counterweight moves on springs of its own.

    Parameters
    ----------
    geometry_counterweight_radius : float
        Distance of the counterweight S0 [m].
    mass_counterweight : float
        Counterweight [kg].
    stiffness_counter_jib_vertical, stiffness_counter_jib_lateral : float
        Springs of the counter-jib [N/m] and [N m/rad].
    damping_counter_jib_vertical, damping_counter_jib_lateral : float
        Dampers beside them [N s/m] and [N m s/rad].
    drag_counterweight : float
        Air drag of the counterweight per squared speed [kg/m].
    """

    geometry_counterweight_radius: float
    mass_counterweight: float
    stiffness_counter_jib_vertical: float
    stiffness_counter_jib_lateral: float
    damping_counter_jib_vertical: float
    damping_counter_jib_lateral: float
    drag_counterweight: float


PARAMETERS: dict[str, type[SlewingParameters]] = {
    "multi-mass": MultiMassParameters,
    "basic": BasicParameters,
    "enhanced": EnhancedParameters,
}
"""Parameters of each kind of slewing crane."""
