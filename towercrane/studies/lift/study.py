"""Lift-off over hoisting speeds and places of the trolley: dynamic factors beside formulas and classes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cases.models import model_of
from towercrane.motions.motion import phases
from towercrane.simulation.lanes.many import integrate_many
from towercrane.simulation.lanes.run import LaneRun
from towercrane.simulation.observed import scalars
from towercrane.simulation.outcomes import INTERRUPTED
from towercrane.studies.lift.hand import Classes
from towercrane.studies.lift.hoisting import Hoisting, hoisting_of
from towercrane.studies.lift.place import Place, stand
from towercrane.studies.lift.report import report

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from numpy.typing import NDArray

    from towercrane.cases.case import Case
    from towercrane.motions.motion import Motion

    Floats = NDArray[np.float64]

WINDOW = 10.0
"""After lift-off [s]."""

LOOK = 5e-3
"""Time between two looks [s]."""

PLACES = (0.2, 0.5, 0.9)
"""Parts of the jib where a trolley stands unless something else is said."""

SPEEDS = 4
"""Number of speeds up to the case's."""

SHORTEST = 1.0
"""Rope that is left at the end [m]."""

LATE = 1.5
"""How much later than by statics a load may be lifted off, ..."""

LATER = 1.0
"""... and so much more [s]."""

UNLIKE = {
    "wind": "still air over ground at rest",
    "earthquake": "still air over ground at rest",
    "hook": "a load on the rope itself",
    "slings": "a load on the rope itself",
    "release": "a load that stays whole",
}
"""Tables of cases whose load cannot be lifted off so, and what is wanted instead."""

ROPE, CARRIED = "hoist_rope_force", "load_ground_force"

OUTPUTS = {
    "hoist_rope_force": "rope",
    "overturning_moment": "base",
    "jib_root_moment": "jib_root",
}
"""What has a dynamic factor, and its short name; the overturning moment is that in the jib's plane, positive where it
tips the crane forward."""

WATCHED = ROPE, CARRIED, "base_moment_x", "base_moment_y", "jib_root_moment"


def lift(
    case: Case,
    speeds: Sequence[float] | None = None,
    positions: Sequence[float] | None = None,
    *,
    window: float = WINDOW,
    hoisting: Hoisting | None = None,
    classes: Classes | None = None,
    progress: Callable[[int], None] | None = None,
) -> dict[str, Any]:
    """Dynamic factors of a load that is lifted off the ground.

    Parameters
    ----------
    case : Case
        A crane with a trolley in still air, on a rope that stretches.
    speeds : sequence of float, optional
        Of hoisting [m/s]; by default four up to the case's.
    positions : sequence of float, optional
        Of the trolley [m]; by default at 0.2, 0.5 and 0.9 of the jib.
    window : float
        After lift-off, in which the largest values are sought [s].
    hoisting : Hoisting, optional
        By default the case's.
    classes : Classes, optional
    progress : callable, optional
        Called with the number of runs that have ended.

    Returns
    -------
    dict
        Ready for JSON. The factor of the rope is max T / (m g), that of a moment (max M - M_0) / (M_st - M_0) with
        M_0 without and M_st under the load at rest.

    Raises
    ------
    ValueError
        If a number is out of its range, or the case is not of such a crane.
    KeyboardInterrupt
        If it was interrupted: a part of a study is none.
    """
    told = classes or Classes()
    own, fastest = hoisting_of(case)
    way = hoisting or own
    check(case)
    model: Any = model_of(case)
    span = float(model.crane.jib_length)
    speeds = _given("speeds", speeds, "m/s", [fastest * (i + 1) / SPEEDS for i in range(SPEEDS)] if fastest else [])
    positions = _given("positions", positions, "m", [round(part * span) or part * span for part in PLACES])
    if beyond := [own for own in positions if own > span]:
        raise ValueError(f"positions: wanted places on the jib, up to {span:g} m, got {beyond[0]:g} m")
    for name, value, zero in (
        ("window", window, False), ("slack", way.slack, True),
        ("acceleration", way.acceleration, False), ("creep", way.creep, True),
    ):  # fmt: skip
        if not (value >= 0.0 if zero else value > 0.0) or not value < np.inf:
            raise ValueError(f"{name}: wanted a number {'from' if zero else 'above'} 0, got {value:g}")
    places = [stand(case, model, position, way.slack) for position in positions]
    runs, ends = _runs(case, places, speeds, way, window)
    shown = scalars(runs[0].model)
    names = [name for name in WATCHED if name in shown]
    times = np.arange(0.0, max(ends) + LOOK, LOOK)
    lanes = [LaneRun(run.model, phases(run.motions, float(times[-1]))) for run in runs]
    answers = integrate_many(
        lanes, times, outputs=names, series=True,
        method=case.solver.method, rtol=case.solver.rtol, atol=case.solver.atol, progress=progress,
    )  # fmt: skip
    if INTERRUPTED in answers.outcomes:
        raise KeyboardInterrupt
    found = []
    for number, run in enumerate(runs):
        looked = dict(zip(names, answers.series[number].T, strict=True))
        outcome = answers.outcomes[number]
        found.append(_factors(run, times, looked, window, told, way) | {"outcome": outcome})
    return report(case, model, places, speeds, found, way, window, told)


def check(case: Case) -> None:
    """Refuse a case whose load cannot be lifted off so.

    Raises
    ------
    ValueError
        With the key that is in the way.
    """
    if not case.rope.stretches or case.rope.slack == "rod":
        raise ValueError(
            "rope.stiffness: wanted a rope that stretches and goes slack, got another; one that does not stretch has "
            'no force to tell when it lifts a load off; try --set rope.stiffness="14 MN"'
        )
    for key, wanted in UNLIKE.items():
        if getattr(case.checked, key, None) is not None:
            raise ValueError(f"{key}: wanted {wanted}, got [{key}]")


def _given(name: str, given: Sequence[float] | None, unit: str, default: list[float]) -> list[float]:
    """Positive values, ascending, each once."""
    if given is None and not default:
        raise ValueError(f"{name}: wanted some, for the case's hoist does not haul in, got none")
    values = default if given is None else list(given)
    if not values:
        raise ValueError(f"{name}: wanted one or more, got none")
    for value in values:
        if not 0.0 < value < np.inf:
            raise ValueError(f"{name}: wanted values above 0 {unit}, got {value:g} {unit}")
    return sorted(set(values))


@dataclass(frozen=True, eq=False)
class _Run:
    """A run of the study."""

    place: Place
    speed: float
    model: Any
    motions: tuple[Motion, ...]


def _runs(
    case: Case, places: list[Place], speeds: Sequence[float], way: Hoisting, window: float
) -> tuple[list[_Run], list[float]]:
    """All runs, those of a place together, and when the window of each has surely passed."""
    runs, ends, length = [], [], case.rope.length
    for place in places:
        sag = place.yielding.sag
        for speed in speeds:
            rope = way.motion(length, sag, speed)
            end = LATE * way.time(way.slack + sag, speed) + LATER + window
            if (left := float(rope(end))) < SHORTEST:
                raise ValueError(
                    f"window: wanted one within which {length:g} m of rope are not hauled in, got {window:g} s at "
                    f"{speed:g} m/s, which leaves {max(left, 0.0):.3g} m; try a shorter one, or a longer rope.length"
                )
            drives = place.drives | {"rope": rope}
            runs.append(_Run(place, speed, place.model, tuple(drives[channel] for channel in place.model.channels)))
            ends.append(end)
    return runs, ends


def _in_the_plane(place: Place, looked: Mapping[str, Any]) -> dict[str, Any]:
    """Outputs by name, the overturning moment as that in the jib's plane."""
    turned = next((place.drives[name].end for name in ("slewing", "shaft") if name in place.drives), 0.0)
    forward = np.cos(turned) * looked["base_moment_y"] - np.sin(turned) * looked.get("base_moment_x", 0.0)
    return {name: looked[name] for name in OUTPUTS if name in looked} | {"overturning_moment": forward}


def _factors(
    run: _Run, times: Floats, looked: dict[str, Floats], window: float, told: Classes, way: Hoisting
) -> dict[str, Any]:
    """What a run comes to."""
    slow, hand = way.at_lift_off(run.speed), run.place.yielding
    row: dict[str, Any] = {
        "trolley_position_m": run.place.position,
        "speed_m_s": run.speed,
        "lift_off_s": None,
        "lift_off_speed_m_s": None,
        "dynamic_factor": {},
        "by_hand": hand.factors(slow),
        "classes": {name: own.factor(slow) for name, own in told.by_name.items()},
        "class_that_covers_the_rope": None,
    }
    (off,) = np.nonzero(looked[CARRIED] == 0.0)
    if not len(off):
        return row
    inside = slice(off[0], off[0] + round(window / LOOK) + 1)
    rope = run.motions[run.model.channels.index("rope")]
    row |= {"lift_off_s": float(times[off[0]]), "lift_off_speed_m_s": -float(rope(times[off[0]], 1))}
    values, hanging = _in_the_plane(run.place, looked), _in_the_plane(run.place, run.place.hanging)
    for name, own in values.items():
        before = 0.0 if name == ROPE else float(own[0])
        peak, time = _peak(times[inside], own[inside])
        factor = (peak - before) / (hanging[name] - before)
        row["dynamic_factor"][OUTPUTS[name]] = {"value": float(factor), "time_s": time}
    row["class_that_covers_the_rope"] = told.covering(row["dynamic_factor"]["rope"]["value"], slow)
    return row


def _peak(times: Floats, values: Floats) -> tuple[float, float]:
    """Largest of the values, by the parabola through its neighbours, and its time."""
    at = int(np.nanargmax(values))
    if not 0 < at < len(values) - 1:
        return float(values[at]), float(times[at])
    left, right = values[at] - values[at - 1], values[at] - values[at + 1]
    turn = 0.5 * (left - right) / (left + right) if left + right > 0.0 else 0.0
    rise = 0.25 * (left - right) * turn
    return float(values[at] + rise), float(times[at] + turn * (times[at + 1] - times[at]))
