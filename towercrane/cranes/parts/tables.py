"""Tables that files of several families have, and what every crane file and every case has."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from towercrane.schema.fields import (
    Acceleration,
    AngleIfAny,
    Corner,
    EitherTurning,
    Expect,
    HingeDamping,
    Hook,
    Payload,
    PositionIfAny,
    Ratio,
    ReachIfAny,
    Rope,
    RotaryStiffness,
    Run,
    Slings,
    Solver,
    Table,
    TorqueOrNone,
    TurningOrNone,
)


class CraneTable(Table):
    """What every crane file has."""

    name: str
    source: str = ""
    kind: str
    gravity: Acceleration = 9.81


class StartTable(Table):
    """Initial state; sways and their rates are named as the outputs are, as which they begin.

    With slack in its rope the load stands on the ground. A run that goes on from the end of another names its result
    alone.
    """

    state: str = "equilibrium"
    slack: ReachIfAny = None
    from_: str = Field(default="", alias="from")


class SwayStart(StartTable):
    """Initial state of a crane with a jib; what is not stated of the sway is as it hangs."""

    sway_radial: AngleIfAny = None
    sway_tangential: AngleIfAny = None
    sway_radial_rate: EitherTurning = 0.0
    sway_tangential_rate: EitherTurning = 0.0


class Start(SwayStart):
    """Initial state of a crane that hangs still, whose load swings, or that is let go undeformed."""

    state: Literal["equilibrium", "quiet", "zero"] = "equilibrium"


class GroundTable(Table):
    """Level ground under the load; its height is over the crane's foot, unless the load stands on it at the start."""

    height: PositionIfAny = None
    friction: Ratio = 0.0


class CaseTable(Table):
    """What every case has; each kind has its own crane and motions."""

    title: str = ""
    crane: CraneTable
    payload: Payload
    rope: Rope
    ground: GroundTable | None = None
    hook: Hook | None = None
    slings: Slings | None = None
    motion: Table
    start: StartTable = Field(default_factory=StartTable)
    run: Run
    solver: Solver = Field(default_factory=Solver)
    allow_implausible: tuple[str, ...] = ()
    expect: Expect | None = None


class Drive(Table):
    """Coupling of shaft and platform: soft up to the corner, stiff beyond it."""

    soft_stiffness: RotaryStiffness
    stiff_stiffness: RotaryStiffness
    corner: Corner
    damping: HingeDamping = 0.0


class Friction(Table):
    """Friction of the slewing bearing; the rate is the platform's at which tanh bends."""

    law: Literal["tanh", "stick-slip", "none"]
    torque: TorqueOrNone = 0.0
    rate: TurningOrNone = 0.0
