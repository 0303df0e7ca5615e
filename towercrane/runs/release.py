"""What a load that lets go does to its crane: how far forces swing back, and whether the crane tips the other way."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cranes.parts.hoisting.letting_go import CHANNEL
from towercrane.motions.motion import SAME_INSTANT
from towercrane.runs.extremes import highest
from towercrane.runs.loads import static

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.cases.case import Case
    from towercrane.runs.extremes import Extremes
    from towercrane.simulation.run import Run

    Floats = NDArray[np.float64]

ALONG = "base_moment_along_jib"
"""Base moment that tips the crane towards its jib [N m]."""

SWINGS_BACK = ("jib_root_moment", "hoist_rope_force")
"""Outputs that are told beside it."""


def release_report(case: Case, run: Run, found: Extremes) -> dict[str, Any] | None:
    """Backward swing after a load has let go, ready for JSON; None where none does, or the run ended before.

    Returns
    -------
    dict
        ``time_s``; ``mass_kg`` that goes, ``fraction`` of the load; ``swings_back``: for the base moment towards the
        jib, the jib's root and the rope the values ``before``, ``after`` (at rest, drives as they are then) and the
        ``minimum`` and ``maximum`` from then to the run's end with their times, ``units``, and ``one_plus_beta``,
        (before - minimum) / (before - after). ``standard``: name, ``beta_slow``, ``beta_rapid`` and what phi_3 they
        give. ``stability``: the least ``eccentricity_m`` of the resultant at the base, moment over weight, positive
        towards the jib, with ``time_s``; ``half_width_m`` of the base or None, ``used`` of it (the crane tips
        beyond 1).
    """
    released = getattr(case.checked, "release", None)
    if released is None or run.attrs["end_time"] <= released.time:
        return None
    load = run.model.load  # type: ignore[attr-defined]
    times, series = found.times, {**found.values, ALONG: along_jib(run, found.values)}
    earlier, later = times < released.time - SAME_INSTANT, times >= released.time - SAME_INSTANT
    places = [float(run.motions[channel](released.time)) for channel in run.model.channels]
    places[run.model.channels.index(CHANNEL)] = 1.0
    at_rest = static(run.model, run.motions, places)
    if at_rest:
        at_rest[ALONG] = float(along_jib(run, {name: np.array([own]) for name, own in at_rest.items()})[0])
    told = {}
    # A jib that pivots has no moment at its foot.
    for name in (ALONG, *(name for name in SWINGS_BACK if name in series)):
        before = float(series[name][earlier][-1])
        most, least = (highest(times[later], series[name][later], sign) for sign in (1.0, -1.0))
        after = at_rest.get(name)
        fell = before - after if after is not None else 0.0
        told[name] = {
            "before": before,
            "after": after,
            "minimum": least.value,
            "minimum_time_s": least.time,
            "maximum": most.value,
            "maximum_time_s": most.time,
            "one_plus_beta": (before - least.value) / fell if fell > 0.0 else None,
            "units": "N" if name == "hoist_rope_force" else "N m",
        }
    share = load.release.mass / load.mass
    betas = {"slow": released.slow_beta, "rapid": released.rapid_beta}
    return {
        "time_s": released.time,
        "duration_s": released.duration,
        "mass_kg": load.release.mass,
        "fraction": share,
        "swings_back": told,
        "standard": {
            "name": released.standard,
            **{f"beta_{how}": beta for how, beta in betas.items()},
            **{f"phi_3_{how}": 1.0 - share * (1.0 + beta) for how, beta in betas.items()},
        },
        "stability": _stability(
            released.base_half_width, times[later], series[ALONG][later], -series["base_force_z"][later]
        ),
    }


def along_jib(run: Run, values: dict[str, Floats]) -> Floats:
    """Base moment that tips a crane towards where its jib's root points [N m]; of its outputs over time."""
    heading = values.get("slewing_angle", getattr(run.model, "heading", 0.0))
    # In a plane along an axis there is one of them.
    x, y = (values.get(f"base_moment_{axis}", 0.0) for axis in "xy")
    return np.asarray(y * np.cos(heading) - x * np.sin(heading))


def _stability(half: float | None, times: Floats, moment: Floats, weight: Floats) -> dict[str, Any]:
    """How near the resultant comes to the edge on the ballast's side."""
    least = highest(times, moment / weight, -1.0)
    used = max(-least.value, 0.0) / half if half else None
    return {
        "eccentricity_m": least.value,
        "time_s": least.time,
        "half_width_m": half,
        "used": used,
        "tips": used is not None and used > 1.0,
    }
