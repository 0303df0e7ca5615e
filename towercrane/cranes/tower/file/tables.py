"""Crane files of tower cranes."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from towercrane.cranes.parts.tables import CraneTable, Drive, Friction
from towercrane.cranes.tower.file.jib_tables import CounterJib, Jib  # noqa: TC001 - pydantic reads annotations
from towercrane.cranes.tower.file.luffing_tables import Head
from towercrane.cranes.tower.file.tie_tables import TowerHead  # noqa: TC001
from towercrane.cranes.tower.file.tower_tables import Foundation, Tower
from towercrane.schema.fields import (
    AreaOrNone,
    InertiaOrNone,
    MassOrNone,
    PressedLength,
    Table,
)


class Trolley(Table):
    """Trolley."""

    mass: MassOrNone


class WindAreas(Table):
    """Drag areas of the structure, drag coefficients included; of tower and jibs per unit length."""

    tower: PressedLength = 0.0
    jib: PressedLength = 0.0
    counter_jib: PressedLength = 0.0
    counterweight: AreaOrNone = 0.0


class SlewingDrive(Drive):
    """Drive of a tower crane's head; its inertia turns with the head and does not tilt."""

    inertia: InertiaOrNone = 0.0


class SmoothFriction(Friction):
    """Friction of a tower crane's slewing bearing."""

    law: Literal["tanh", "none"]


class Crane(CraneTable):
    """Tower crane.

    Scenes in the jib's plane use neither torsion of the tower, bending of the jib to its sides, drive, friction nor
    roll inertia, and only those with a wind its areas.
    """

    kind: Literal["tower"] = "tower"
    tower: Tower
    foundation: Foundation = Field(default_factory=Foundation)
    jib: Jib
    tower_head: TowerHead | None = None
    head: Head = Field(default_factory=Head)
    counter_jib: CounterJib
    trolley: Trolley
    roll_inertia: InertiaOrNone = 0.0
    wind_areas: WindAreas = Field(default_factory=WindAreas)
    drive: SlewingDrive | None = None
    friction: SmoothFriction = SmoothFriction(law="none")
