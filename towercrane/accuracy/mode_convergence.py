"""What a coarser model of a scene gets wrong, measured, with ladders of models in one kind of modes each.

Slewing couples what the small motions of a crane at rest keep apart, and wind and a drive may do anything. So here
the crane is run in one mode of each kind, and again with one mode more or none of a single kind. The errors of the
kinds add up, but for products of them: a setting is chosen from single rungs, and not run in all combinations. What
the products matter, a run with one more mode of every kind than the chosen tells.
"""

from __future__ import annotations

import time
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.accuracy.estimate import SMALLEST_PEAK, Choice, Estimate, limits
from towercrane.accuracy.setting import Setting
from towercrane.cranes.tower.crane_model import MODE_KINDS, moving
from towercrane.cranes.tower.targets import MOTIONS
from towercrane.results.measures import gap, peak
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

MOST = {"tower_modes": 4, "torsion_modes": 3, "jib_lateral_modes": 7, "jib_vertical_modes": 7}
"""Modes of each kind that are chosen at most."""

REST = 2.0
"""What all modes beyond a rung matter, over what the next one does."""

MODELLED, SOLVED = 0.5, 0.2
"""Parts of an allowed error: for what the model leaves out, kind by kind, and for the solver. What kinds matter
together may take what the solver does not."""

PROBING = {"motions": 0.02, "forces": 2e-4}
"""Rtol of the runs that are compared, over the smallest relative error that is wanted: forces see accelerations."""

LOOSEST, TIGHTEST = 1e-5, 1e-9
"""Range of rtol."""

STALLED = 0.7
"""More modes of a kind that leave more than this of what one mode less left tell of the solver, not of the model."""

TIGHTER = 0.1
"""Rtol of a run, over that of the run which tells its error."""

GAIN = 0.5
"""Error of the tighter of two such runs, over their difference, at most."""


@dataclass(frozen=True, eq=False)
class ModeConvergence:
    """Runs of a scene with one mode of each kind, and from there up or down in one kind.

    Parameters
    ----------
    scene : Scene
    base : Setting
        Of the run from which all ladders lead.
    """

    scene: Scene
    base: Setting
    runs: dict[Setting, Run] = field(default_factory=dict)
    differences: dict[tuple[Setting, Setting], Floats] = field(default_factory=dict)

    def run(self, setting: Setting, progress: Progress | None = None) -> Run:
        """The scene in a setting, from an earlier run if there was one.

        Raises
        ------
        NoEquilibrium
            If it has no start.
        KeyboardInterrupt
            If the run was interrupted.
        """
        if setting not in self.runs:
            found = self.runs[setting] = self.scene.run(setting, progress=progress)
            if found.attrs["outcome"] == INTERRUPTED:
                raise KeyboardInterrupt
            if found.attrs["end_time"] == 0.0:
                raise NoEquilibrium(found.attrs["outcome"], found.attrs["message"])
        return self.runs[setting]

    def apart(self, one: Setting, other: Setting) -> Floats:
        """Largest differences between two settings, shape (outputs,)."""
        if (one, other) not in self.differences:
            pair = self.run(one), self.run(other)
            self.differences[one, other] = np.array([gap(*pair, name) for name in self.scene.outputs])
        return self.differences[one, other]

    def step(self, kind: str, count: int) -> Floats:
        """What one mode more of a kind changes, shape (outputs,)."""
        lower, upper = (self.base.with_counts({kind: c}) for c in (count, count + 1))
        return self.apart(lower, upper)

    def left(self, kind: str, count: int) -> Floats:
        """What all modes of a kind beyond so many would change, shape (outputs,)."""
        first = self.step(kind, count)
        return first + self.left(kind, 1) if count == 0 else REST * first

    def peaks(self, setting: Setting) -> Floats:
        """Largest magnitudes of the outputs in a run, shape (outputs,)."""
        found = self.run(setting)
        return np.maximum([peak(found, name) for name in self.scene.outputs], SMALLEST_PEAK)

    def ended_early(self) -> list[str]:
        """Outcomes other than the usual one, each once."""
        return sorted({run.attrs["outcome"] for run in self.runs.values()} - {FINISHED})


def measured_choice(
    scene: Scene,
    targets: Mapping[str, Tolerance],
    stated: Mapping[str, Any] | None = None,
    progress: Progress | None = None,
) -> tuple[Choice, Run]:
    """The setting with the fewest modes that is expected to keep all targets, and the run in it.

    Parameters
    ----------
    scene : Scene
    targets : dict of str to Tolerance
        By output, some of the scene's.
    stated : dict, optional
        Fields of :class:`towercrane.accuracy.setting.Setting` that are not to be chosen.
    progress : callable, optional
        As in :func:`towercrane.simulation.integrate.integrate`, for the run in the setting.

    Raises
    ------
    ValueError
        If an output is unknown, or none is given.
    NoEquilibrium
        If the tower buckles.
    KeyboardInterrupt
        If a run was interrupted.
    """
    if not targets or not set(targets) <= set(scene.outputs):
        raise ValueError(f"targets: wanted some of {', '.join(scene.outputs)}, got {', '.join(targets) or 'none'}")
    began, stated, tried = time.process_time(), dict(stated or {}), 0
    ladders = ModeConvergence(scene, _base(scene, targets, stated))
    kinds = [kind for kind in moving(ladders.base.planar) if kind in scene.described]
    free = [kind for kind in kinds if kind not in stated]
    patient, before = not {"rtol", "atol"}.isdisjoint(stated), np.inf
    while True:
        allowed = limits(scene.outputs, targets, ladders.peaks(ladders.base))
        counts, truncation = _counts(ladders, kinds, free, allowed, patient)
        excess = _excess(truncation, MODELLED * allowed)
        if patient or excess <= 1.0:
            break
        patient = excess > STALLED * before or ladders.base.rtol <= 10.0 * TIGHTEST
        before = excess
        if not patient:
            tried += len(ladders.runs)
            ladders = ModeConvergence(scene, ladders.base.tightened(TIGHTER))
    setting = ladders.base.with_counts(counts)
    together = _together(ladders, setting, kinds)
    while excess <= 1.0 < _excess(together, (1.0 - SOLVED) * allowed):
        higher = {k: _lost(ladders, setting, allowed, k) for k in free if getattr(setting, k) < MOST[k]}
        if not higher:
            break
        raised = [kind for kind, lost in higher.items() if lost >= 0.5 * max(higher.values())]
        setting = setting.with_more(dict.fromkeys(raised, 1))
        together = _together(ladders, setting, kinds)
    setting, result, stepping = _solved(ladders, setting, allowed, stated, progress)
    truncation = np.maximum(truncation, together)
    peaks = np.maximum([peak(result, name) for name in scene.outputs], SMALLEST_PEAK)
    estimate = Estimate(truncation, stepping / peaks)
    tried += len(ladders.runs)
    excess = _excess(estimate.errors(peaks), limits(scene.outputs, targets, peaks))
    doubts = [f"a model beside it ends early: {outcome}" for outcome in ladders.ended_early()]
    spent = time.process_time() - began - result.attrs["solver_cpu_seconds"]
    final = {kind: getattr(setting, kind) for kind in kinds}
    left_out = tuple(_left_out(ladders, kinds, free, final, np.isfinite(allowed)))
    choice = Choice(
        setting, estimate, peaks, excess <= 1.0, tuple(doubts), tried, spent, left_out
    )  # fmt: skip
    return choice, result


def _base(scene: Scene, targets: Mapping[str, Tolerance], stated: dict[str, Any]) -> Setting:
    """One mode of each kind that is described and moves, unless something else is stated."""
    counts = {kind: int(kind in scene.described) for kind in moving(scene.planar)}
    relative = min((value for value, relative in targets.values() if relative), default=1e-3)
    share = PROBING["motions" if set(targets) <= set(MOTIONS) else "forces"]
    rtol = float(np.clip(share * relative, 10.0 * TIGHTEST, LOOSEST))
    plain = Setting(planar=scene.planar, rtol=rtol, atol=1e-2 * rtol)
    return replace(plain.with_counts(counts), **stated)


def _counts(
    ladders: ModeConvergence, kinds: list[str], free: list[str], allowed: Floats, patient: bool
) -> tuple[dict[str, int], Floats]:
    """Fewest modes whose errors add up to no more than the model's part, and these errors.

    Without patience it ends where more modes do not help: then the solver's tolerances may be too loose to tell.
    """
    counts, before = {kind: getattr(ladders.base, kind) for kind in kinds}, dict[str, float]()

    def lost() -> dict[str, Floats]:
        return {kind: ladders.left(kind, count) for kind, count in counts.items()}

    while True:
        by_kind = lost()
        higher = [kind for kind in free if counts[kind] < MOST[kind]]
        if _excess(sum(by_kind.values()), MODELLED * allowed) <= 1.0 or not higher:
            break
        worst = max(higher, key=lambda kind: _excess(by_kind[kind], allowed))
        now = _excess(by_kind[worst], allowed)
        if now < 0.1 * MODELLED / len(kinds) or not (patient or now <= STALLED * before.get(worst, np.inf)):
            break
        before[worst] = now
        counts[worst] += 1
    dearest = sorted(
        free, key=lambda kind: -ladders.run(ladders.base.with_counts({kind: counts[kind]})).attrs["evaluations"]
    )
    for kind in dearest:
        kept = counts[kind]
        counts[kind] = 0
        if _excess(sum(lost().values()), MODELLED * allowed) > 1.0:
            counts[kind] = kept
    return counts, np.asarray(sum(lost().values()))


def _together(ladders: ModeConvergence, setting: Setting, kinds: list[str]) -> Floats:
    """What all modes beyond a setting would change: more together than kind by kind, maybe; shape (outputs,)."""
    return REST * ladders.apart(setting, setting.with_more(dict.fromkeys(kinds, 1)))


def _lost(ladders: ModeConvergence, setting: Setting, allowed: Floats, kind: str) -> float:
    """What one mode more of a kind changes beside all others, over what is allowed."""
    return _excess(ladders.apart(setting, setting.with_more({kind: 1})), allowed)


def _solved(
    ladders: ModeConvergence, setting: Setting, allowed: Floats, stated: dict[str, Any], progress: Progress | None
) -> tuple[Setting, Run, Floats]:
    """A setting with tolerances for the solver's part, the run, and what its steps cost; shape (outputs,)."""
    if "rtol" in stated or "atol" in stated:
        tighter = setting.tightened(TIGHTER)
        return setting, ladders.run(setting, progress), ladders.apart(setting, tighter)
    while True:
        tighter = setting.tightened(TIGHTER)
        result = ladders.run(tighter, progress)
        lost = GAIN * ladders.apart(setting, tighter)
        if _excess(lost, SOLVED * allowed) <= 1.0 or tighter.rtol <= TIGHTEST:
            return tighter, result, lost
        setting = tighter


def _excess(errors: Any, allowed: Floats) -> float:
    """Largest error over the allowed one, of what has a target."""
    wanted = np.isfinite(allowed)
    return float(np.max(np.asarray(errors)[wanted] / allowed[wanted]))


def _left_out(
    ladders: ModeConvergence, kinds: list[str], free: list[str], counts: dict[str, int], wanted: NDArray[np.bool_]
) -> list[str]:
    """What the setting has not, what that is expected to change, and what the rest is good for, in sentences."""
    found = []
    if ladders.base.planar:
        found.append("motion out of the jib's plane: nothing drives the crane or its load out of it")
    for kind in moving(ladders.base.planar):
        what = MODE_KINDS[kind]
        if kind not in ladders.scene.described:
            found.append(f"{what}: the crane file does not describe it")
        elif kind in counts:
            count = counts[kind]
            change = _change(ladders, ladders.left(kind, count), wanted)
            said = f"{what} beyond {count} mode{'s' if count > 1 else ''}" if count else what
            found.append(f"{said}: it may change {change}")
            if count and kind in free:
                found[-1] += (
                    f"; without any such mode it would change {_change(ladders, ladders.left(kind, 0), wanted)}"
                )
    if not ladders.base.weight_softening:
        softened = ladders.apart(ladders.base, replace(ladders.base, weight_softening=True))
        said = _change(ladders, softened, wanted)
        found.append(f"the weight's softening of the tower, as the case states: it may change {said}")
    return found


def _change(ladders: ModeConvergence, change: Floats, wanted: NDArray[np.bool_]) -> str:
    """The largest change of the outputs with a target, in words."""
    shares = np.where(wanted, change / ladders.peaks(ladders.base), 0.0)
    worst = int(shares.argmax())
    return f"{list(ladders.scene.outputs)[worst].replace('_', ' ')} by {shares[worst]:.2g} of its peak"
