"""Modes and tolerance for an error where small motions of a crane at rest do not foretell it.

Slewing couples what the small motions of a crane at rest keep apart, and wind and a drive may do anything. So a run
in one mode of each kind tells how far everything swings, and small motions about it what more modes would change. The
run in the setting that is chosen tells whether they were right: how far it is from the first was foretold as well.
"""

from __future__ import annotations

import time
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.accuracy.choice import cost
from towercrane.accuracy.departures import LAST, Departures
from towercrane.accuracy.estimate import SMALLEST_PEAK, Choice, Estimate, check_targets, limits
from towercrane.accuracy.foretold import MEASURED
from towercrane.accuracy.readings import ROUNDING
from towercrane.accuracy.setting import Setting
from towercrane.cranes.tower.crane_model import MODE_KINDS, moving
from towercrane.cranes.tower.targets import ANY_MOTION
from towercrane.results.measures import PLACE, gap, peak
from towercrane.simulation.outcomes import FINISHED, INTERRUPTED
from towercrane.simulation.system import NoEquilibrium

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from towercrane.accuracy.scene import Scene
    from towercrane.schema.targets import Tolerance
    from towercrane.simulation.run import Run
    from towercrane.simulation.trajectory import Progress

    Floats = NDArray[np.float64]

MOST = {
    "tower_modes": 4, "torsion_modes": 3, "jib_lateral_modes": 7, "jib_vertical_modes": 7,
    "counter_jib_lateral_modes": 3, "counter_jib_vertical_modes": 3,
}  # fmt: skip
"""Modes of each kind that are chosen at most."""

SAFETY = np.array([[4.0], [2.0]])
"""Factors on what small motions expect of ringing and of bending: what the drawn scenes of the benchmark needed."""

FORCES = 1e-2
"""Smallest part of its peak to which a force or moment is promised: to less it hangs on high modes and on phases that
run apart over the whole run, of which small motions tell too little."""

NOTHING = 1e-6
"""Part of a peak below which small motions know nothing of a change: what couples at larger ones is not in them."""

LOAD, SPILL = (PLACE, "sway_radial", "sway_tangential"), 0.3
"""Outputs that tell where the load is, and the part of their relative errors that every output has at least: what is
not linear carries it over."""

MODELLED, SOLVED = 0.9, 0.02
"""Parts of an allowed error: for what the model leaves out, and for the solver."""

STEPPING = {"motions": 10.0, "forces": 500.0}
"""Largest error of dop853 over rtol and over the output's peak: forces see accelerations."""

LOOSEST, TIGHTEST, ABSOLUTE = 1e-5, 1e-9, 1e-2
"""Range of rtol, the first also of the coarse run; and atol over it."""

HELPS = 0.98
"""One mode more helps if it leaves at most this part of the squared errors."""

NEAREST = 1.05
"""Where no setting keeps the targets: how much worse than the best fewer modes may be."""


def measured_choice(
    scene: Scene,
    targets: Mapping[str, Tolerance],
    stated: Mapping[str, Any] | None = None,
    progress: Progress | None = None,
    known: Run | None = None,
) -> tuple[Choice, Run]:
    """The cheapest setting that is expected to keep all targets, and the run in it.

    Parameters
    ----------
    scene : Scene
    targets : dict of str to Tolerance
        By output, some of the scene's.
    stated : dict, optional
        Fields of :class:`towercrane.accuracy.setting.Setting` that are not to be chosen.
    progress : callable, optional
        As in :func:`towercrane.simulation.integrate.integrate`, for the run in the setting.
    known : Run, optional
        The run in the setting, where all of it is stated.

    Raises
    ------
    ValueError
        If an output is unknown, or none is given.
    NoEquilibrium
        If the tower buckles.
    KeyboardInterrupt
        If a run was interrupted.
    """
    check_targets(scene.outputs, targets)
    began, stated = time.process_time(), dict(stated or {})
    kinds = [kind for kind in moving(scene.planar) if kind in scene.described]
    free = [kind for kind in kinds if kind not in stated]
    plain = Setting(planar=scene.planar, weight_softening=stated.get("weight_softening", True))
    single = replace(plain, rtol=LOOSEST, atol=ABSOLUTE * LOOSEST).with_counts(dict.fromkeys(kinds, 1))
    coarse = run_of(scene, single)
    most = {kind: max(MOST[kind], stated.get(kind, 0)) + LAST[kind] for kind in kinds}
    departures = Departures(scene, coarse, single.with_counts(most))
    peaks, surprise = peaks_of(scene, coarse), np.ones(len(scene.outputs))
    allowed = limits(scene.outputs, targets, peaks)
    setting = replace(single, **(tolerances(scene, allowed / peaks) | stated))
    counts = _counts(departures, setting.counts, free, MODELLED * allowed)
    while True:
        setting = setting.with_counts(counts)
        result = known or (coarse if setting == single else run_of(scene, setting, progress))
        peaks = peaks_of(scene, result)
        allowed = limits(scene.outputs, targets, peaks)
        surprise = np.maximum(surprise, _surprise(departures, single.counts, counts, result))
        estimate = Estimate(surprise * _expected(departures, counts), stepping(scene, setting))
        kept = ratios(estimate.errors(peaks), allowed).max() <= 1.0
        higher = counts if kept else _counts(departures, counts, free, MODELLED * allowed / surprise)
        if higher == counts or ratios(surprise * _expected(departures, higher), allowed).max() > 1.0:
            break
        counts = higher
    early = coarse.attrs["outcome"]
    doubts: tuple[str, ...] = () if early == FINISHED else (f"a model beside it ends early: {early}",)
    doubts += doubts_of(scene, allowed / peaks)
    left_out = tuple(_left_out(departures, kinds, free, setting, np.where(np.isfinite(allowed), peaks, np.inf)))
    spent = time.process_time() - began - (0.0 if known else result.attrs["solver_cpu_seconds"])
    return Choice(setting, estimate, peaks, bool(kept), doubts, departures.looked, spent, left_out), result


def doubts_of(scene: Scene, relative: Floats) -> tuple[str, ...]:
    """Why no error can be promised, of what is allowed over the peaks."""
    exact = [name for name, part in zip(scene.outputs, relative, strict=True) if part < FORCES]
    doubts: tuple[str, ...] = ()
    if forces := [name.replace("_", " ") for name in exact if name not in ANY_MOTION]:
        doubts += (f"too little is known of {forces[0]} for less than {FORCES:g} of its peak",)
    if scene.ground:
        doubts += ("it is not known how an earthquake rings modes that are left out",)
    return doubts


def run_of(scene: Scene, setting: Setting, progress: Progress | None = None) -> Run:
    """The scene in a setting."""
    found = scene.run(setting, progress=progress)
    if found.attrs["outcome"] == INTERRUPTED:
        raise KeyboardInterrupt
    if found.attrs["end_time"] == 0.0:
        raise NoEquilibrium(found.attrs["outcome"], found.attrs["message"])
    return found


def peaks_of(scene: Scene, run: Run) -> Floats:
    """Largest magnitudes of the outputs in a run, shape (outputs,)."""
    return np.maximum([peak(run, name) for name in scene.outputs], SMALLEST_PEAK)


def tolerances(scene: Scene, relative: Floats) -> dict[str, Any]:
    """Tolerances of the solver for relative errors of the outputs."""
    per_rtol = stepping(scene, Setting(rtol=1.0))
    rtol = float(np.clip(np.min(SOLVED * relative / per_rtol), TIGHTEST, LOOSEST))
    return {"rtol": rtol, "atol": ABSOLUTE * rtol}


def stepping(scene: Scene, setting: Setting) -> Floats:
    """Largest error of the solver over the output's peak; infinite for methods that were not measured."""
    if setting.method != MEASURED:
        return np.full(len(scene.outputs), np.inf)
    return setting.rtol * np.array([STEPPING["motions" if n in ANY_MOTION else "forces"] for n in scene.outputs])


def _surprise(departures: Departures, few: dict[str, int], more: dict[str, int], result: Run) -> Floats:
    """Factor on what is expected of a model, given its run: 1 where it is as far from the coarse one as was foretold.

    As much more is expected as the two are further apart, but no more than by how much they are; shape (outputs,).
    """
    scene, foretold = departures.scene, departures.between(few, more).sum(axis=0)
    found = np.array([gap(departures.path.run, result, name) for name in scene.outputs])
    smallest = ROUNDING * peaks_of(scene, result)
    further = np.maximum(found - foretold, 0.0)
    parts = further / np.maximum(foretold, smallest), further / np.maximum(_expected(departures, more), smallest)
    return np.asarray(1.0 + np.minimum(*parts))


def _expected(departures: Departures, counts: dict[str, int]) -> Floats:
    """Errors of a model by what it leaves out; shape (outputs,)."""
    scene = departures.scene
    likely = (SAFETY * departures.beyond(counts)).sum(axis=0)
    peaks = peaks_of(scene, departures.path.run)
    of_load = [number for number, name in enumerate(scene.outputs) if name in LOAD]
    return np.asarray(np.maximum(likely, SPILL * (likely / peaks)[of_load].max() * peaks))


def ratios(errors: Floats, allowed: Floats) -> Floats:
    """Errors over the allowed ones, of what has a target."""
    wanted = np.isfinite(allowed)
    return np.asarray(errors[wanted] / allowed[wanted])


def _counts(departures: Departures, start: dict[str, int], free: list[str], allowed: Floats) -> dict[str, int]:
    """Fewest modes that are expected to keep within allowed errors, or where none do those that come nearest."""

    def over(counts: dict[str, int]) -> Floats:
        return ratios(_expected(departures, counts), allowed)

    counts, now = dict(start), over(start)
    while now.max() > 1.0 and (short := [kind for kind in free if counts[kind] < MOST[kind]]):
        found = {kind: over({**counts, kind: counts[kind] + 1}) for kind in short}
        best = min(short, key=lambda kind: float(found[kind] @ found[kind]))
        # Some kinds help only together.
        raised = [best] if found[best] @ found[best] < HELPS * (now @ now) else short
        counts |= {kind: counts[kind] + 1 for kind in raised}
        now = over(counts)
    limit = max(1.0, NEAREST * float(now.max()))
    while True:
        fewer = [{**counts, kind: counts[kind] - 1} for kind in free if counts[kind]]
        enough = [one for one in fewer if over(one).max() <= limit]
        if not enough:
            return counts
        counts = min(enough, key=lambda one: cost(*departures.fastest(one)))


def _left_out(
    departures: Departures, kinds: list[str], free: list[str], setting: Setting, peaks: Floats
) -> list[str]:
    """What the setting has not, what that is expected to change, and what the rest is good for, in sentences."""
    scene, counts, found = departures.scene, setting.counts, []

    def change(changes: Floats) -> str:
        shares = changes.sum(axis=0) / peaks
        worst = int(shares.argmax())
        if shares[worst] < NOTHING:
            return "small motions say nothing of what it changes"
        return f"it may change {list(scene.outputs)[worst].replace('_', ' ')} by {shares[worst]:.2g} of its peak"

    if scene.planar:
        found.append("motion out of the jib's plane: nothing drives the crane or its load out of it")
    for kind in moving(scene.planar):
        what, count = MODE_KINDS[kind], counts[kind]
        if kind not in kinds and kind.startswith("counter_jib"):
            # As a rule it is rigid.
            continue
        if kind not in kinds:
            found.append(f"{what}: the crane file does not describe it")
            continue
        all_of_it = {**counts, kind: departures.rich.counts[kind]}
        said = f"{what} beyond {count} mode{'s' if count > 1 else ''}" if count else what
        found.append(f"{said}: {change(departures.between(counts, all_of_it))}")
        if count and kind in free:
            without = departures.between({**counts, kind: 0}, counts)
            found[-1] += f"; without any such mode: {change(without)}"
    if not setting.weight_softening:
        said = change(departures.softening())
        found.append(f"the weight's softening of the tower, as the case states: {said}")
    return found
