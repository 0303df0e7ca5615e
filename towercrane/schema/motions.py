"""Motions as case files describe them: lengths and positions in metres, turns in radians."""

from __future__ import annotations

from functools import cache
from typing import Annotated, Any, Literal

from pydantic import Field, TypeAdapter

from towercrane.schema.fields import (
    MODEL,
    Acceleration,
    Angle,
    AngularAcceleration,
    AngularJerk,
    EitherSpeed,
    EitherTurning,
    Frequencies,
    Jerk,
    Position,
    Speed,
    Table,
    Time,
    TorqueOrNone,
    Turning,
    Wait,
)


class Begin(Table):
    """Where a motion begins."""

    start: Position


class Delayed(Table):
    """Wait before a motion begins."""

    delay: Wait = 0.0


class Rest(Delayed):
    """No motion."""

    shape: Literal["rest"]
    duration: Wait = 0.0


class Trapezoid(Delayed):
    """Constant acceleration, speed, deceleration."""

    shape: Literal["trapezoid"]
    end: Position
    speed: Speed
    acceleration: Acceleration


class SCurve(Delayed):
    """Limited jerk."""

    shape: Literal["s-curve"]
    end: Position
    speed: Speed
    acceleration: Acceleration
    jerk: Jerk


class AtSpeed(Delayed):
    """Motion that may begin at speed, and end at speed, at which it then goes on."""

    start_speed: EitherSpeed = 0.0
    end_speed: EitherSpeed = 0.0


class SpeedTrapezoid(AtSpeed):
    """Speed that rises linearly, holds and falls; its sign is the direction."""

    shape: Literal["speed-trapezoid"]
    speed: EitherSpeed
    ramp: Time
    hold: Wait


class SmoothRamps(AtSpeed):
    """Speed that rises smoothly, holds and falls; its sign is the direction."""

    shape: Literal["smooth"]
    speed: EitherSpeed
    ramp: Time
    hold: Wait


class Shaped(Delayed):
    """Trapezoid whose ramps are spread so that they cancel the load's sway."""

    shape: Literal["zv", "zvd", "ei", "boxes"]
    end: Position
    speed: Speed
    acceleration: Acceleration
    frequencies: Frequencies = MODEL


class MinimumJerk(Delayed):
    """Smoothest motion within a time."""

    shape: Literal["minimum-jerk"]
    end: Position
    duration: Time


Step = Annotated[
    Trapezoid | SCurve | SpeedTrapezoid | SmoothRamps | Shaped | MinimumJerk | Rest, Field(discriminator="shape")
]


class Sequence(Delayed):
    """Steps, each from where the one before ends."""

    shape: Literal["sequence"]
    steps: Annotated[tuple[Step, ...], Field(min_length=1)]


class Points(AtSpeed):
    """Smooth motion through the points of a CSV file."""

    shape: Literal["table"]
    file: str


class TrolleyRest(Begin, Rest):
    """Trolley at rest."""


class TrolleyTrapezoid(Begin, Trapezoid):
    """Trolley on a trapezoid."""


class TrolleySCurve(Begin, SCurve):
    """Trolley on an s-curve."""


class TrolleySpeedTrapezoid(Begin, SpeedTrapezoid):
    """Trolley on a trapezoid of speed."""


class TrolleySmoothRamps(Begin, SmoothRamps):
    """Trolley on smooth ramps."""


class TrolleyShaped(Begin, Shaped):
    """Trolley on a shaped trapezoid."""


class TrolleyMinimumJerk(Begin, MinimumJerk):
    """Trolley on the smoothest motion."""


class TrolleySequence(Begin, Sequence):
    """Trolley in steps."""


class Turned(Table):
    """Where a turn begins."""

    start: Angle = 0.0


class Turn(Trapezoid):
    """Turn on a trapezoid."""

    end: Angle
    speed: Turning
    acceleration: AngularAcceleration


class TurnSCurve(SCurve):
    """Turn with limited jerk."""

    end: Angle
    speed: Turning
    acceleration: AngularAcceleration
    jerk: AngularJerk


class TurnSpeedTrapezoid(SpeedTrapezoid):
    """Turn on a trapezoid of speed."""

    speed: EitherTurning
    start_speed: EitherTurning = 0.0
    end_speed: EitherTurning = 0.0


class TurnSmoothRamps(SmoothRamps):
    """Turn on smooth ramps."""

    speed: EitherTurning
    start_speed: EitherTurning = 0.0
    end_speed: EitherTurning = 0.0


class TurnPoints(Points):
    """Smooth turn through the points of a CSV file."""

    start_speed: EitherTurning = 0.0
    end_speed: EitherTurning = 0.0


class TurnShaped(Shaped):
    """Turn on a shaped trapezoid."""

    end: Angle
    speed: Turning
    acceleration: AngularAcceleration


class TurnMinimumJerk(MinimumJerk):
    """Turn on the smoothest motion."""

    end: Angle


TurnStep = Annotated[
    Turn | TurnSCurve | TurnSpeedTrapezoid | TurnSmoothRamps | TurnShaped | TurnMinimumJerk | Rest,
    Field(discriminator="shape"),
]


class JointRest(Turned, Rest):
    """Joint at rest."""


class JointTrapezoid(Turned, Turn):
    """Joint on a trapezoid."""


class JointSCurve(Turned, TurnSCurve):
    """Joint with limited jerk."""


class JointSpeedTrapezoid(Turned, TurnSpeedTrapezoid):
    """Joint on a trapezoid of speed."""


class JointSmoothRamps(Turned, TurnSmoothRamps):
    """Joint on smooth ramps."""


class JointShaped(Turned, TurnShaped):
    """Joint on a shaped trapezoid."""


class JointMinimumJerk(Turned, TurnMinimumJerk):
    """Joint on the smoothest motion."""


class JointSequence(Turned, Sequence):
    """Joint in steps."""

    steps: Annotated[tuple[TurnStep, ...], Field(min_length=1)]


class FreeTurn(Turned):
    """Turn that nothing prescribes, against a brake's torque."""

    shape: Literal["free"]
    brake_torque: TorqueOrNone


AnyMotion = Rest | Trapezoid | SCurve | SpeedTrapezoid | SmoothRamps | Shaped | MinimumJerk | Sequence | Points
HoistMotion = Annotated[AnyMotion, Field(discriminator="shape")]
TrolleyMotion = Annotated[
    TrolleyRest
    | TrolleyTrapezoid
    | TrolleySCurve
    | TrolleySpeedTrapezoid
    | TrolleySmoothRamps
    | TrolleyShaped
    | TrolleyMinimumJerk
    | TrolleySequence
    | Points,
    Field(discriminator="shape"),
]
_Joint = (
    JointRest
    | JointTrapezoid
    | JointSCurve
    | JointSpeedTrapezoid
    | JointSmoothRamps
    | JointShaped
    | JointMinimumJerk
    | JointSequence
    | TurnPoints
)

JointMotion = Annotated[_Joint, Field(discriminator="shape")]

SlewingMotion = Annotated[_Joint | FreeTurn, Field(discriminator="shape")]


@cache
def reader(described: Any) -> TypeAdapter[Any]:
    """What reads one of these; making it takes as long as reading the rest of a case."""
    return TypeAdapter(described)
