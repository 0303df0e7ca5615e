"""What an elastic rope went through in a run: when it was slack, and how hard it was caught."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cranes.parts.hoisting.letting_go import CHANNEL

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.kernels.load import Load
    from towercrane.runs.extremes import Extremes
    from towercrane.simulation.run import Run

    Floats = NDArray[np.float64]

FORCE, GROUND = "hoist_rope_force", "load_ground_force"


def rope_report(run: Run) -> dict[str, Any] | None:
    """Phases in which the rope was slack, ready for JSON; None of a rope that does not stretch.

    Returns
    -------
    dict
        ``slack_phases``, ``slack_from_s``, ``slack_to_s`` (the last of which may be the run's end), without load
        none; over ground ``lifted_off_s`` and ``landed_s``.
    """
    if "rope_stretch" not in run:
        return None
    times, forces = run.times[:1], run[FORCE].values[:1]
    if run.switches is not None:
        times, forces = np.append(times, run.switches.times), np.append(forces, run.switches[FORCE].values)
    hung = _hangs(run, times)
    times, forces = times[hung], forces[hung]
    taut = np.concatenate([[True], forces > 0.0])
    begins, ends = times[taut[:-1] & ~taut[1:]].tolist(), times[~taut[:-1] & taut[1:]].tolist()
    if len(ends) < len(begins):
        ends.append(float(run.times[_hangs(run, run.times)][-1]))
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


def _hangs(run: Run, times: Floats) -> NDArray[np.bool_]:
    """At which times anything hangs on the rope."""
    if CHANNEL not in run.motions:
        return np.ones(len(times), dtype=bool)
    load: Load = run.model.load  # type: ignore[attr-defined]
    return np.asarray(load.now((run.motions[CHANNEL](times), 0.0)).mass > 0.0)


def rope_notice(run: Run, found: Extremes) -> list[str]:
    """The same in sentences, of what happened after the start, and how hard the rope was caught."""
    told, peak = rope_report(run), found.highest.get(FORCE)
    if not told or peak is None or len(run.times) < 2:
        return []
    said = []
    if told["slack_phases"]:
        weight = run.attrs["payload_mass"] * run.attrs["gravity"]
        often = "once" if told["slack_phases"] == 1 else f"{told['slack_phases']} times"
        times = f" ({peak.value / weight:.3g} times the load's weight)" if weight else ""
        said.append(
            f"the rope was slack {often}, first from {told['slack_from_s'][0]:.4g} to {told['slack_to_s'][0]:.4g} s; "
            f"its largest force is {peak.value:.4g} N{times} at {peak.time:.4g} s"
        )
    for what, when in (("was lifted off", told.get("lifted_off_s")), ("landed", told.get("landed_s"))):
        if when:
            again = f", the first of {len(when)} times" if len(when) > 1 else ""
            said.append(f"the load {what} at {when[0]:.4g} s{again}")
    return said
