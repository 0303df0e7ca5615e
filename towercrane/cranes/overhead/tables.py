"""Crane and case files of overhead cranes."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from towercrane.schema.fields import (
    Acceleration,
    Angle,
    Expect,
    Length,
    Mass,
    MassOrNone,
    MassPerLength,
    Modulus,
    Payload,
    Ratio,
    Rope,
    Run,
    SecondMoment,
    Solver,
    Table,
)
from towercrane.schema.motions import HoistMotion, TrolleyMotion  # noqa: TC001 - pydantic reads annotations


class Runway(Table):
    """Two rails at one height above the floor."""

    height: Length
    length: Length


class Bridge(Table):
    """The bridge's girders together, on simple supports; the damping is that of the bare girders."""

    span: Length
    mass_per_length: MassPerLength
    youngs_modulus: Modulus
    second_moment_of_area: SecondMoment
    damping_ratio: Ratio = 0.0
    end_carriage_mass: MassOrNone = 0.0


class Trolley(Table):
    """Trolley with its hoist."""

    mass: Mass


class OverheadCrane(Table):
    """Overhead crane: a bridge on a runway, a trolley on the bridge."""

    name: str
    source: str = ""
    kind: Literal["overhead"]
    gravity: Acceleration = 9.81
    runway: Runway
    bridge: Bridge
    trolley: Trolley


class OverheadMotions(Table):
    """What bridge, trolley and winch do."""

    bridge: TrolleyMotion
    trolley: TrolleyMotion
    hoist: HoistMotion | None = None


class OverheadStart(Table):
    """Initial state of an overhead crane; the angle is the rope's from the vertical, positive along the runway."""

    state: Literal["equilibrium", "zero"] = "equilibrium"
    swing_angle: Angle = 0.0


class OverheadCase(Table):
    """Case of an overhead crane."""

    title: str = ""
    crane: OverheadCrane
    payload: Payload
    rope: Rope
    motion: OverheadMotions
    start: OverheadStart = Field(default_factory=OverheadStart)
    run: Run
    solver: Solver = Field(default_factory=Solver)
    allow_implausible: tuple[str, ...] = ()
    expect: Expect | None = None
