"""Crane and case files of overhead cranes."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from towercrane.cranes.parts.tables import CaseTable, CraneTable, StartTable
from towercrane.schema.fields import (
    AngleIfAny,
    EitherTurning,
    Length,
    Mass,
    MassOrNone,
    MassPerLength,
    Modulus,
    Ratio,
    SecondMoment,
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


class OverheadCrane(CraneTable):
    """Overhead crane: a bridge on a runway, a trolley on the bridge."""

    kind: Literal["overhead"]
    runway: Runway
    bridge: Bridge
    trolley: Trolley


class OverheadMotions(Table):
    """What bridge, trolley and winch do."""

    bridge: TrolleyMotion
    trolley: TrolleyMotion
    hoist: HoistMotion | None = None


class OverheadStart(StartTable):
    """Initial state of an overhead crane."""

    state: Literal["equilibrium", "quiet", "zero"] = "equilibrium"
    sway_along_runway: AngleIfAny = None
    sway_along_bridge: AngleIfAny = None
    sway_along_runway_rate: EitherTurning = 0.0
    sway_along_bridge_rate: EitherTurning = 0.0


class OverheadCase(CaseTable):
    """Case of an overhead crane, whose outward is along the runway."""

    crane: OverheadCrane
    motion: OverheadMotions
    start: OverheadStart = Field(default_factory=OverheadStart)
