"""What an elastic rope went through in a run: when it was slack, and how hard it was caught."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from towercrane.runs.extremes import Extremes
    from towercrane.simulation.run import Run

FORCE, GROUND = "hoist_rope_force", "load_ground_force"


def rope_report(run: Run) -> dict[str, Any] | None:
    """Phases in which the rope was slack, ready for JSON; None of a rope that does not stretch.

    Returns
    -------
    dict
        ``slack_phases``, ``slack_from_s``, ``slack_to_s`` (the last of which may be the run's end); over ground
        ``lifted_off_s`` and ``landed_s``.
    """
    if "rope_stretch" not in run:
        return None
    times, forces = run.times[:1], run[FORCE].values[:1]
    if run.switches is not None:
        times, forces = np.append(times, run.switches.times), np.append(forces, run.switches[FORCE].values)
    taut = np.concatenate([[True], forces > 0.0])
    begins, ends = times[taut[:-1] & ~taut[1:]].tolist(), times[~taut[:-1] & taut[1:]].tolist()
    if len(ends) < len(begins):
        ends.append(float(run.times[-1]))
    return {"slack_phases": len(begins), "slack_from_s": begins, "slack_to_s": ends, **_on_ground(run)}


def _on_ground(run: Run) -> dict[str, list[float]]:
    """When the load was lifted off the ground and when it landed, if there is ground."""
    if GROUND not in run:
        return {}
    times, forces = run.times[:1], run[GROUND].values[:1]
    if run.switches is not None:
        times, forces = np.append(times, run.switches.times), np.append(forces, run.switches[GROUND].values)
    stands = forces > 0.0
    turned = np.flatnonzero(stands[1:] != stands[:-1]) + 1
    return {
        "lifted_off_s": times[turned[~stands[turned]]].tolist(),
        "landed_s": times[turned[stands[turned]]].tolist(),
    }


def rope_notice(run: Run, found: Extremes) -> list[str]:
    """The same in a sentence, if it was slack at all, and how hard it was caught."""
    told, peak = rope_report(run), found.highest[FORCE]
    if not told or not told["slack_phases"]:
        return []
    weight = run.attrs["payload_mass"] * run.attrs["gravity"]
    often = "once" if told["slack_phases"] == 1 else f"{told['slack_phases']} times"
    times = f" ({peak.value / weight:.3g} times the load's weight)" if weight else ""
    return [
        f"the rope was slack {often}, first from {told['slack_from_s'][0]:.4g} to {told['slack_to_s'][0]:.4g} s; "
        f"its largest force is {peak.value:.4g} N{times} at {peak.time:.4g} s"
    ]
