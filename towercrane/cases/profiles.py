"""Motions as case files describe them, and the CSV tables they may come from."""

from __future__ import annotations

from typing import TYPE_CHECKING

from towercrane.schema.csv_table import TIME, Column, read_table
from towercrane.schema.fields import MODEL
from towercrane.schema.motions import (
    MinimumJerk,
    Points,
    Rest,
    SCurve,
    Sequence,
    Shaped,
    SmoothRamps,
    SpeedTrapezoid,
    Trapezoid,
)

if TYPE_CHECKING:
    from pathlib import Path

    import numpy as np
    from numpy.typing import NDArray

    from towercrane.motions.plans import Move, Plan
    from towercrane.schema.motions import AnyMotion

    Floats = NDArray[np.float64]


def plan(described: AnyMotion, start: float, folder: Path, unit: str = "m") -> Plan:
    """What a case tells a drive to do.

    Parameters
    ----------
    described : table of the case
    start : float
        Value at which the motion begins [m or rad]; a CSV table brings its own.
    folder : Path
        Where a CSV file's name is relative to.
    unit : str
        "m", or "rad" for a turn.

    Raises
    ------
    CaseError
        If a CSV table cannot be used.
    """
    from towercrane.motions.motion import rest
    from towercrane.motions.plans import Move, Shaping
    from towercrane.motions.profiles import s_curve, smooth_ramps, speed_trapezoid, table, trapezoid
    from towercrane.motions.shaping import DESIGNS, minimum_jerk

    shaping = None
    match described:
        case Points():
            points = read_points(folder / described.file, unit)
            motion = table(*points, described.start_speed, described.end_speed)
            start = float(motion(0.0))
        case Sequence():
            steps: list[Move] = []
            now = start
            for step in described.steps:
                steps += plan(step, now, folder, unit).moves
                now = steps[-1].commanded.end
            return _delayed(steps, start, described.delay)
        case Rest():
            motion = rest(start, described.duration)
        case Shaped():
            motion = trapezoid(start, described.end, described.speed, described.acceleration)
            known = described.frequencies
            shaping = Shaping(DESIGNS[described.shape], None if known == MODEL else tuple(map(float, known)))
        case MinimumJerk():
            motion = minimum_jerk(start, described.end, described.duration)
        case Trapezoid():
            motion = trapezoid(start, described.end, described.speed, described.acceleration)
        case SCurve():
            d = described
            motion = s_curve(start, d.end, d.speed, d.acceleration, d.jerk)
        case SpeedTrapezoid():
            own = described
            motion = speed_trapezoid(start, own.speed, own.ramp, own.hold, own.start_speed, own.end_speed)
        case SmoothRamps():
            ramps = described
            motion = smooth_ramps(start, ramps.speed, ramps.ramp, ramps.hold, ramps.start_speed, ramps.end_speed)
    return _delayed([Move(motion, shaping)], start, described.delay)


def _delayed(moves: list[Move], start: float, delay: float) -> Plan:
    """Moves after a wait."""
    from towercrane.motions.motion import rest
    from towercrane.motions.plans import Move, Plan

    return Plan((Move(rest(start, delay)), *moves) if delay else tuple(moves))


def read_points(path: Path, unit: str = "m") -> tuple[Floats, Floats]:
    """Times [s] and values [m or rad] of a CSV file, see :func:`towercrane.schema.csv_table.read_table`.

    Raises
    ------
    CaseError
        If it is no such table.
    """
    table = read_table(path, (TIME, Column("value", unit)))
    return table.values[:, 0], table.values[:, 1]
