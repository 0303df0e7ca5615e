"""Crane and case files of jib cranes."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from towercrane.cranes.parts.tables import CaseTable, CraneTable, StartTable
from towercrane.schema.fields import (
    AngleIfAny,
    EitherTurning,
    Inertia,
    Length,
    MassPerLength,
    Reach,
    Table,
)
from towercrane.schema.motions import HoistMotion, JointMotion  # noqa: TC001 - pydantic reads annotations


class Post(Table):
    """Post of a jib crane."""

    height: Reach = 0.0
    inertia: Inertia


class Boom(Table):
    """Rigid uniform boom."""

    length: Length
    mass_per_length: MassPerLength


class JibCrane(CraneTable):
    """Jib crane: a post that slews, a boom that luffs and a boom that folds."""

    kind: Literal["jib"]
    post: Post
    primary_boom: Boom
    secondary_boom: Boom


class JibMotions(Table):
    """What the joints and the winch of a jib crane do; the fold counts from the primary boom's line."""

    slew: JointMotion | None = None
    luff: JointMotion
    fold: JointMotion
    hoist: HoistMotion | None = None


class JibStart(StartTable):
    """Initial state of a jib crane, whose booms go where their joints do."""

    state: Literal["equilibrium"] = "equilibrium"
    sway_in_plane: AngleIfAny = None
    sway_lateral: AngleIfAny = None
    sway_in_plane_rate: EitherTurning = 0.0
    sway_lateral_rate: EitherTurning = 0.0


class JibCase(CaseTable):
    """Case of a jib crane."""

    crane: JibCrane
    motion: JibMotions
    start: JibStart = Field(default_factory=JibStart)
