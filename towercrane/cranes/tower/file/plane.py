"""Whether a scene stays in the jib's vertical plane: it follows from what the case drives and what blows on it."""

from __future__ import annotations

from math import inf, pi, sin
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pydantic import ValidationError

from towercrane.results.result_file import saved_axes
from towercrane.schema.motions import (
    FreeTurn,
    JointMotion,
    Points,
    Rest,
    Sequence,
    SmoothRamps,
    SpeedTrapezoid,
    reader,
)
from towercrane.schema.ranges import at, si_at

if TYPE_CHECKING:
    from collections.abc import Iterable

    from towercrane.cranes.tower.file.case_tables import TowerCase
    from towercrane.schema.motions import TurnStep

ACROSS = 1e-12
"""Sine of the angle between wind and jib that is none but for rounding."""

HORIZONTAL = {"x": 0.0, "y": 0.5 * pi}
"""Angles of the axes of an earthquake that may leave a plane."""


def stays_in_plane(tables: TowerCase) -> bool:
    """Whether nothing drives or blows crane and load out of the vertical plane in which the jib stands."""
    return heading_of(tables) is not None


def heading_of(tables: TowerCase) -> float | None:
    """Angle from the fixed x axis at which the jib stands all through a run [rad].

    None where crane and load leave the jib's plane: where the head turns within the run, the load swings across the
    jib at the start, a wind blows across it, or the ground moves across it. What a CSV file holds is not known here:
    its turn or its gusts leave the plane, as turbulence across the wind does, and so does each axis of an earthquake
    that acts.
    """
    if tables.start.from_ and saved_axes(Path(tables.start.from_)) > 2:
        return None
    turn, wind = tables.motion.slewing or tables.motion.shaft, tables.wind
    if tables.start.sway_tangential or tables.start.sway_tangential_rate:
        return None
    blows = wind is not None and bool(wind.series or wind.speed)
    pushed = [wind.direction if wind is not None and wind.one_way else None] if blows else []
    shaken = tables.earthquake.axes if tables.earthquake is not None else ()
    return _heading(turn, tables.run.duration, [*pushed, *_directions(shaken)])


def heading_written(tree: dict[str, Any]) -> float | None:
    """The same of a case as written; what cannot be read leaves the plane."""
    written = at(tree, "motion.slewing") or at(tree, "motion.shaft")
    try:
        turn = reader(JointMotion).validate_python(written) if isinstance(written, dict) else None
    except ValidationError:
        return None
    if any(si_at(tree, f"start.sway_tangential{end}", unit, 0.0) for end, unit in (("", "rad"), ("_rate", "rad/s"))):
        return None
    series = at(tree, "wind.series")
    blows = bool(series) or si_at(tree, "wind.speed", "m/s", 0.0) != 0.0
    turbulence = at(tree, "wind.turbulence")
    one_way = not series and (not isinstance(turbulence, dict) or turbulence.get("across") is False)
    pushed = [si_at(tree, "wind.direction", "rad", 0.0) if one_way else None] if blows else []
    axes = at(tree, "earthquake.axes")
    shaken = (axes if isinstance(axes, list) else "xyz") if isinstance(at(tree, "earthquake"), dict) else ()
    return _heading(turn, si_at(tree, "run.duration", "s") or inf, [*pushed, *_directions(shaken)])


def _directions(axes: Iterable[str]) -> list[float]:
    """Angles of those axes of an earthquake that are horizontal."""
    return [HORIZONTAL[axis] for axis in axes if axis in HORIZONTAL]


def _heading(turn: JointMotion | FreeTurn | None, duration: float, pushed: list[float | None]) -> float | None:
    """Of a turn and the directions in which something pushes or shakes, not known where they vary."""
    heading = float(getattr(turn, "start", 0.0))
    if turn is not None and _departure(turn, heading) < duration:
        return None
    if any(direction is None or abs(sin(direction - heading)) > ACROSS for direction in pushed):
        return None
    return heading


def _departure(turn: JointMotion | FreeTurn | TurnStep, start: float) -> float:
    """When a turn leaves the angle at which it begins [s]; infinite if it never does."""
    match turn:
        case Points() | FreeTurn():
            return 0.0
        case Rest():
            return inf
        case Sequence():
            now = turn.delay
            for step in turn.steps:
                if (departure := _departure(step, start)) < inf:
                    return now + departure
                now += step.delay + _pause(step)
            return inf
        case SpeedTrapezoid() | SmoothRamps():
            goes = (turn.speed, turn.start_speed, turn.end_speed) != (0.0, 0.0, 0.0)
        case _:
            goes = turn.end != start
    return turn.delay if goes else inf


def _pause(step: TurnStep) -> float:
    """How long a step that goes nowhere takes after its delay [s]."""
    if isinstance(step, SpeedTrapezoid | SmoothRamps):
        return 2.0 * step.ramp + step.hold
    return float(getattr(step, "duration", 0.0))
