"""Modes and tolerance for an error where no small motions tell it: a ladder of runs, each of a richer model.

On every rung a run in ever more modes of all kinds is set beside that of the next rung, which has more of each and a
tolerance that the errors need. Their differences are the errors of the lower one, but for what the next rung itself
may lack: as much less as the rungs have come nearer to each other.
"""

from __future__ import annotations

import time
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from towercrane.accuracy.estimate import Choice, Estimate, check_targets, limits
from towercrane.accuracy.mode_choice import (
    ABSOLUTE,
    LOOSEST,
    MOST,
    doubts_of,
    peaks_of,
    ratios,
    run_of,
    stepping,
    tolerances,
)
from towercrane.accuracy.setting import Setting
from towercrane.cranes.tower.crane_model import MODE_KINDS, moving
from towercrane.results.measures import gap
from towercrane.simulation.outcomes import FINISHED

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from towercrane.accuracy.scene import Scene
    from towercrane.schema.targets import Tolerance
    from towercrane.simulation.run import Run
    from towercrane.simulation.trajectory import Progress

    Floats = NDArray[np.float64]

RUNG = {
    "tower_modes": 1, "torsion_modes": 1, "jib_lateral_modes": 2, "jib_vertical_modes": 2,
    "counter_jib_lateral_modes": 1, "counter_jib_vertical_modes": 1,
}  # fmt: skip
"""Modes of each kind that the next rung has more."""

SAFETY = 2.0
"""Least factor on what the next rung finds."""

STALLED = 0.9
"""Two rungs' differences that shrink less than this count as if they shrank so."""

HELPS = 0.8
"""Where the expected errors over the allowed ones fall by less than this, the next rung is of no help."""


def laddered_choice(
    scene: Scene,
    targets: Mapping[str, Tolerance],
    stated: Mapping[str, Any] | None = None,
    progress: Progress | None = None,
) -> tuple[Choice, Run]:
    """The lowest rung that is expected to keep all targets, or else the last that helped, and its run.

    Parameters
    ----------
    scene : Scene
    targets : dict of str to Tolerance
        By output, some of the scene's.
    stated : dict, optional
        Fields of :class:`towercrane.accuracy.setting.Setting` that are not to be chosen.
    progress : callable, optional
        As in :func:`towercrane.simulation.integrate.integrate`, for each run.

    Raises
    ------
    ValueError
        If an output is unknown, or none is given.
    NoEquilibrium
        If the crane cannot stand.
    KeyboardInterrupt
        If a run was interrupted.
    """
    check_targets(scene.outputs, targets)
    began, stated = time.process_time(), dict(stated or {})
    kinds = [kind for kind in moving(scene.planar) if kind in scene.described]
    free = [kind for kind in kinds if kind not in stated]
    plain = Setting(planar=scene.planar, rtol=LOOSEST, atol=ABSOLUTE * LOOSEST).with_counts(lowest(scene, kinds))
    more = {kind: RUNG[kind] for kind in kinds}
    rungs: list[_Rung] = []
    setting, tried = replace(plain, **stated), 0
    known: Run | None = None
    while True:
        result = known or run_of(scene, setting, progress)
        peaks = peaks_of(scene, result)
        allowed = limits(scene.outputs, targets, peaks)
        higher = replace(setting, **tolerances(scene, allowed / peaks)).with_more(more)
        richer = run_of(scene, higher, progress)
        tried += 1 + (known is None)
        found = np.array([gap(result, richer, name) for name in scene.outputs])
        # Kinds that are stated do not near each other from rung to rung.
        before = rungs[-1].found if rungs and known is not None else None
        estimate = Estimate(_factors(found, before) * found, stepping(scene, setting))
        excess = float(ratios(estimate.errors(peaks), allowed).max())
        early = [run.attrs["outcome"] for run in (result, richer) if run.attrs["outcome"] != FINISHED]
        if rungs and not early and excess > max(HELPS * rungs[-1].excess, 1.0):
            break
        rungs.append(_Rung(setting, higher, result, estimate, found, excess, early))
        if excess <= 1.0 or early or all(higher.counts[kind] > MOST[kind] for kind in free):
            break
        setting = replace(higher, **stated)
        # What the case states is not what the richer one had.
        known = richer if setting == higher else None
    best = rungs[-1]
    peaks = peaks_of(scene, best.result)
    allowed = limits(scene.outputs, targets, peaks)
    doubts = (
        *(f"a model on the ladder ends early: {outcome}" for outcome in best.early[-1:]),
        *doubts_of(scene, allowed / peaks),
    )
    left_out = tuple(_left_out(scene, best, np.where(np.isfinite(allowed), best.found / peaks, 0.0)))
    spent = time.process_time() - began - best.result.attrs["solver_cpu_seconds"]
    choice = Choice(best.setting, best.estimate, peaks, best.excess <= 1.0, doubts, tried, spent, left_out)
    return choice, best.result


class _Rung(NamedTuple):
    """A setting beside the next: its run, expected errors, differences and how far the first are over the allowed."""

    setting: Setting
    higher: Setting
    result: Run
    estimate: Estimate
    found: Floats
    excess: float
    early: list[str]


def lowest(scene: Scene, kinds: list[str]) -> dict[str, int]:
    """One mode of each kind; none up and down of a counter-jib that ties bend without such."""
    tied = scene.crane.tie_bars is not None
    return {kind: 0 if tied and kind == "counter_jib_vertical_modes" else 1 for kind in kinds}


def _factors(found: Floats, before: Floats | None) -> Floats:
    """On the differences of two rungs, by how much smaller they are than those before; shape (outputs,)."""
    if before is None:
        return np.full(len(found), SAFETY)
    shrunk = found / np.maximum(before, 1e-300)
    return np.maximum(SAFETY, 1.0 / (1.0 - np.minimum(shrunk, STALLED)))


def _left_out(scene: Scene, rung: _Rung, shares: Floats) -> list[str]:
    """What the setting has not, and what a run with more of it changed, in sentences."""
    had = rung.setting.counts
    more = [f"{count} of {MODE_KINDS[kind]}" for kind, count in rung.higher.counts.items() if count > had[kind]]
    worst = int(shares.argmax())
    changed = f"{list(scene.outputs)[worst].replace('_', ' ')} by {shares[worst]:.2g} of its peak"
    found = [f"further modes: a run with more, {', '.join(more)}, changed {changed}"]
    if scene.crane.tie_bars is not None:
        found.append("waves along ties beyond the first half-wave, and bending of the cat-head under its own inertia")
    if scene.planar:
        found.append("motion out of the jib's plane: nothing drives the crane or its load out of it")
    return found
