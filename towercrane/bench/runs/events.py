"""Random short runs full of events against a second method and the balance of energy."""

from __future__ import annotations

import time
import warnings
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.bench.clock import short
from towercrane.bench.scenes.drawn_events import SCENE_KINDS, TICK, event_scenes
from towercrane.runs.summary import energy_balance
from towercrane.simulation.outcomes import FINISHED, INTERRUPTED, SLACK_ROPE
from towercrane.simulation.simulate import record

if TYPE_CHECKING:
    from towercrane.bench.scenes.drawn_events import EventScene
    from towercrane.results.recording import Recording

RUNS, QUICK_RUNS, SEED = 10_000, 70, 7

RTOL = 1e-8

SECOND = ("dopri5", 1e-9)
"""Method that checks the run, and its tolerance."""

PHYSICAL = (FINISHED, SLACK_ROPE, "tower buckled", "trolley off the jib", "no stable equilibrium")
"""How a run may end; all else is the solver's failure."""

LARGEST_GAP, LARGEST_DIFFERENCE = 1e-4, 1e-3
"""What a run may leave of its energy, and be off the second method's."""


def event_runs(quick: bool) -> dict[str, Any]:
    """Runs of all kinds: how they ended, how far energy and second method are off.

    Returns
    -------
    dict
        A subject as in :func:`towercrane.bench.measure`; a record for each run that failed, with its number and
        ``why``.
    """
    count = QUICK_RUNS if quick else RUNS
    found: dict[str, list[dict[str, Any]]] = {kind: [] for kind in SCENE_KINDS}
    began = time.process_time()
    for number, scene in enumerate(event_scenes(count, SEED)):
        found[scene.kind].append({"number": number, "kind": scene.kind, **judged(scene)})
    failures = [record for records in found.values() for record in records if record["why"]]
    return {
        "name": "events",
        "title": "Random short runs: friction, stiff drives, starts away from zero, switches on rows, slack ropes",
        "columns": ["kind", "runs", "slack", "worst energy gap", "worst difference", "failed"],
        "rows": [_row(kind, records) for kind, records in found.items()],
        "records": failures,
        "notes": [
            f"rtol {RTOL:g}; difference: load's position and rope's tension from {SECOND[0]} at {SECOND[1]:g}, "
            "relative to their range",
            f"failed: a named failure of the solver, energy off by {LARGEST_GAP:g} or more, a difference of "
            f"{LARGEST_DIFFERENCE:g} or more; {len(failures)} of {count}",
            *(f"run {f['number']}, {f['kind']}: {f['why']}" for f in failures[:10]),
            f"{time.process_time() - began:.0f} s of CPU time",
        ],
    }


def judged(scene: EventScene) -> dict[str, Any]:
    """How a scene ended, ``gap`` of its energy, ``difference`` from the second method, and ``why`` it failed."""
    run, second = _run(scene, "dop853", RTOL), _run(scene, *SECOND)
    outcome, end = run.attrs["outcome"], run.attrs["end_time"]
    gap = energy_balance(run)["relative_gap"]
    difference = _difference(run, second)
    why = ""
    if outcome not in PHYSICAL:
        why = f"ended at {end:.6g} s: {outcome}"
    elif outcome != second.attrs["outcome"]:
        other = f"{SECOND[0]} at {second.attrs['end_time']:.6g} s: {second.attrs['outcome']}"
        why = f"ended at {end:.6g} s: {outcome}, by {other}"
    elif not gap < LARGEST_GAP:
        why = f"energy off by {gap:.1e}"
    elif not difference < LARGEST_DIFFERENCE:
        why = f"{difference:.1e} off {SECOND[0]}"
    return {"outcome": outcome, "end_time": end, "gap": gap, "difference": difference, "why": why}


def _run(scene: EventScene, method: str, rtol: float) -> Recording:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = record(
            scene.model, scene.motions, scene.duration, output_step=TICK, start=scene.start,
            method=method, rtol=rtol, atol=1e-2 * rtol,
        )  # fmt: skip
    if found.attrs["outcome"] == INTERRUPTED:
        raise KeyboardInterrupt
    return found


def _difference(run: Recording, second: Recording) -> float:
    """Largest difference of position and tension over the rows that both have, relative to their ranges."""
    rows = min(len(run.times), len(second.times), int(np.searchsorted(run.times, run.attrs["end_time"])) + 1)
    if run.attrs["outcome"] != FINISHED:
        # The row in which a rope goes slack has its own time.
        rows = min(rows, max(len(run.times) - 1, 1))
    errors = []
    for name in ("payload_position", "hoist_rope_force"):
        values, exact = (found[name].values.reshape(len(found.times), -1)[:rows] for found in (run, second))
        scale = np.ptp(second[name].values, axis=0).max() + 1e-3 * abs(exact).max()
        errors.append(float(abs(values - exact).max() / scale))
    return max(errors)


def _row(kind: str, records: list[dict[str, Any]]) -> list[str]:
    slack = sum(record["outcome"] == SLACK_ROPE for record in records)
    worst = [max((record[key] for record in records), default=None) for key in ("gap", "difference")]
    failed = sum(bool(record["why"]) for record in records)
    return [kind, str(len(records)), str(slack), *(short(value) for value in worst), str(failed)]
