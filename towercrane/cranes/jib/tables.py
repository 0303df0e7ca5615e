"""Crane and case files of jib cranes."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from towercrane.schema.fields import (
    Acceleration,
    Angle,
    Expect,
    Inertia,
    Length,
    MassPerLength,
    Payload,
    Reach,
    Rope,
    Run,
    Solver,
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


class JibCrane(Table):
    """Jib crane: a post that slews, a boom that luffs and a boom that folds."""

    name: str
    source: str = ""
    kind: Literal["jib"]
    gravity: Acceleration = 9.81
    post: Post
    primary_boom: Boom
    secondary_boom: Boom


class JibMotions(Table):
    """What the joints and the winch of a jib crane do; the fold counts from the primary boom's line."""

    slew: JointMotion | None = None
    luff: JointMotion
    fold: JointMotion
    hoist: HoistMotion | None = None


class JibStart(Table):
    """Initial state of a jib crane, whose booms go where their joints do."""

    state: Literal["equilibrium"] = "equilibrium"
    swing_angle: Angle = 0.0


class JibCase(Table):
    """Case of a jib crane."""

    title: str = ""
    crane: JibCrane
    payload: Payload
    rope: Rope
    motion: JibMotions
    start: JibStart = Field(default_factory=JibStart)
    run: Run
    solver: Solver = Field(default_factory=Solver)
    allow_implausible: tuple[str, ...] = ()
    expect: Expect | None = None
