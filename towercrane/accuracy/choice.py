"""Ask for an error, get the cheapest run that keeps it: the choice of modes, cap and tolerance for a scene."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Generic

import numpy as np

from towercrane.accuracy.indicators import drift, vibration
from towercrane.accuracy.instants import BEYOND, OUTPUTS, RICHEST, SWING, TENSION, nodes_of
from towercrane.accuracy.scene import AnySetting, Setting
from towercrane.cranes.tower.modes.frequency_cap import FREE_MODES
from towercrane.simulation.system import NoEquilibrium

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from numpy.typing import NDArray

    from towercrane.accuracy.indicators import Vibration
    from towercrane.accuracy.scene import RadialScene
    from towercrane.schema.targets import Tolerance

    Floats = NDArray[np.float64]

SAFETY = np.array([3.2, 3.2, 3.2, 3.2])
"""Factor on what the indicators expect of vibration, per output: what the drawn scenes of the benchmark needed."""

LAST = 4
"""Tower modes of the richest model whose effect stands for that of all beyond it."""

STATIC_SAFETY = 1.1
"""Factor on the static part, which is all but exact."""

STEPPING = 5.0
"""Largest error of dop853 over rtol and over the output's peak, for outputs that are positions; commonly a tenth."""

SHARES = (0.3, 0.01)
"""Parts of the target that the solver may use up: as a rule, and where it would damp what rings fastest."""

STEPS_PER_CYCLE = 3.0
"""Steps of dop853 in a cycle of the fastest mode."""

FASTEST = 0.3
"""Modes above this part of the highest frequency lose up to rtol of their amplitude in every step."""

LOOSEST, TIGHTEST = 2e-3, 1e-9
"""Range of rtol."""

SMALLEST_PEAK = 1e-4
"""Peaks below this [m, rad or N] count as this."""

WIDE, LEANING = 0.5, 0.1
"""Swing [rad], and deflection of the tower over its height, beyond which small motions say little."""

GROWTH = 0.3
"""Exponent of a parametric resonance's growth over a run, beyond which nothing is promised."""

MODES = ((0, 0), (1, 0), (0, 1), (1, 1), (1, 2), (2, 2), (2, 3), (2, 4), (3, 4), (3, 6), (4, 8), (5, 11), (8, 11))
"""Numbers of tower and jib modes that are tried."""

CAPS = (1.0, 2.0, 5.0, 12.0)
"""Caps that are tried, over the fastest of the modes that are never capped, besides none."""


@dataclass(frozen=True, eq=False)
class Estimate:
    """Expected largest error of every output of a run, all arrays of shape (outputs,).

    Parameters
    ----------
    truncation : ndarray
        By what the model leaves out and the solver damps, in the output's unit.
    stepping : ndarray
        By the solver's steps, over the output's peak; infinite for methods that were not measured.
    """

    truncation: Floats
    stepping: Floats

    def errors(self, peaks: Floats) -> Floats:
        """Errors in the outputs' units, given their peaks."""
        return np.asarray(self.truncation + self.stepping * np.maximum(peaks, SMALLEST_PEAK))


@dataclass(frozen=True, eq=False)
class Choice(Generic[AnySetting]):
    """A setting and what is expected of it.

    Parameters
    ----------
    setting : Setting or SpaceSetting
    estimate : Estimate
    peaks : ndarray, shape (outputs,)
        Expected.
    kept : bool
        Whether the estimate keeps the targets.
    doubts : tuple of str
        Why no error can be promised in this scene; empty where it can.
    tried : int
        Settings that were looked at.
    cpu_seconds : float
        What the choice took.
    left_out : tuple of str
        What the richest model has and this has not, and why, in sentences.
    """

    setting: AnySetting
    estimate: Estimate
    peaks: Floats
    kept: bool
    doubts: tuple[str, ...]
    tried: int
    cpu_seconds: float
    left_out: tuple[str, ...]


class Indicators:
    """Estimates for settings of one scene.

    Parameters
    ----------
    scene : RadialScene
    tower_modes, jib_modes : int
        Most that a setting will have; the richest model always has more.
    """

    def __init__(self, scene: RadialScene, tower_modes: int = 0, jib_modes: int = 0) -> None:
        most = (max(RICHEST.tower_modes, tower_modes + BEYOND[0]), max(RICHEST.jib_modes, jib_modes + BEYOND[1]))
        self.scene, self.richest = scene, Setting(*most)
        self.nodes = nodes_of(scene, self.richest)
        self._rich: dict[bool, Vibration] = {}
        self._lacking: dict[bool, Floats] = {}
        self._last: tuple[tuple[object, ...], Vibration, Floats] | None = None

    def rich(self, weight_softening: bool) -> Vibration:
        """The richest model, with or without the weight's softening.

        Raises
        ------
        NoEquilibrium
            If the weight leaves the tower no stiffness.
        """
        if weight_softening not in self._rich:
            try:
                found = vibration(self.nodes, replace(self.richest, weight_softening=weight_softening))
            except np.linalg.LinAlgError:
                message = self.scene.model(self.richest).scene.buckling_message()
                raise NoEquilibrium("tower buckled", message) from None
            self._rich[weight_softening] = found
        return self._rich[weight_softening]

    def lacking(self, weight_softening: bool) -> Floats:
        """What the richest model itself may lack: as much as its last tower modes bring; shape (outputs,).

        Tower modes converge slowly where shear and the ground yield: their flexibility falls with the count alone.
        """
        if weight_softening not in self._lacking:
            less = replace(
                self.richest, tower_modes=self.richest.tower_modes - LAST, weight_softening=weight_softening
            )
            change = drift(self.rich(weight_softening), vibration(self.nodes, less))
            self._lacking[weight_softening] = np.asarray(sum(change))
        return self._lacking[weight_softening]

    def truncation(self, setting: Setting) -> Floats:
        """Largest error of every output by what the model leaves out, with its safety; shape (outputs,)."""
        return self._compared(setting)[1]

    def of(self, setting: Setting) -> Vibration:
        """Modes of a setting's model."""
        return self._compared(setting)[0]

    def _compared(self, setting: Setting) -> tuple[Vibration, Floats]:
        """Modes of a setting's model, and its truncation; the last ones asked for are kept."""
        key = (setting.tower_modes, setting.jib_modes, setting.cap, setting.weight_softening)
        if self._last is None or self._last[0] != key:
            rich, poor = self.rich(setting.weight_softening), vibration(self.nodes, setting)
            static, ringing = drift(rich, poor)
            lost = SAFETY * ringing + STATIC_SAFETY * static + self.lacking(setting.weight_softening)
            swing = rich.peaks[SWING]
            # A pendulum is slower by a sixteenth of its squared swing: an error in that becomes one in its phase.
            lost[SWING] *= 1.0 + 0.125 * swing**2 * rich.phase[-1, rich.pendulum]
            # The rope's force follows the square of the swing.
            lost[TENSION] += 3.0 * self.scene.load.mass * self.scene.crane.gravity * swing * lost[SWING]
            self._last = key, poor, lost
        return self._last[1:]

    def per_rtol(self, setting: Setting) -> Floats:
        """Largest error of the solver over its rtol and over the output's peak, shape (outputs,).

        The tension sees accelerations: an error in the position of the fastest mode, as a part of the jib's
        deflection, times its squared frequency over gravity.
        """
        found = np.full(len(OUTPUTS), STEPPING)
        if setting.method != "dop853":
            return np.full(len(OUTPUTS), np.inf)
        fastest = self.of(setting).frequencies.max()
        deflection = self.rich(setting.weight_softening).peaks[1]
        found[TENSION] = max(STEPPING, fastest**2 * deflection / self.scene.crane.gravity)
        return found

    def damped(self, setting: Setting) -> Floats:
        """What the solver takes from the fastest modes, in the outputs' units; shape (outputs,)."""
        found = self.of(setting)
        fast = found.frequencies.max(axis=0)
        steps = STEPS_PER_CYCLE * self.scene.duration * fast.max() / (2.0 * np.pi)
        ringing = abs(found.left[:, :, fast > FASTEST * fast.max()]).sum(axis=(2, 3)).max(axis=0)
        return np.asarray(ringing * min(1.0, steps * setting.rtol))

    def estimate(self, setting: Setting) -> Estimate:
        """Expected error of a setting."""
        lost = self.truncation(setting) + self.damped(setting)
        return Estimate(lost, self.per_rtol(setting) * setting.rtol)

    def softening(self) -> Floats:
        """What the weight's softening changes, in the outputs' units; shape (outputs,)."""
        return np.asarray(sum(drift(self.rich(True), self.rich(False))))

    def doubts(self, weight_softening: bool) -> tuple[str, ...]:
        """Why small motions cannot tell the error of this scene."""
        rich = self.rich(weight_softening)
        swing, found = rich.peaks[SWING], []
        if swing > WIDE:
            found.append(f"the load swings {swing:.2g} rad: small motions say little about it")
        crane = self.scene.crane
        leaning = rich.peaks[0] / crane.tower.length
        if leaning > LEANING:
            found.append(f"the tower bends by {leaning:.0%} of its height: small motions say little about its head")
        weight = self.scene.load.mass * crane.gravity
        pumping = abs(rich.ringing(np.arange(len(self.nodes.times)))[:, TENSION]).sum(axis=2) / weight + swing**2
        pendulum = rich.pendulum
        own = rich.frequencies[:, [pendulum]]
        # Mathieu's equation: a point that shakes at nearly twice the swing's frequency makes it grow.
        off = abs(rich.frequencies / (2.0 * own) - 1.0)
        rate = 0.25 * own * np.maximum(pumping - 4.0 * off, 0.0)
        rate[:, pendulum] = 0.0
        growth = np.diff(self.nodes.times) @ np.maximum(rate[1:], rate[:-1])
        if growth.max() > GROWTH:
            tuned = rich.frequencies[0, growth.argmax()] / (2.0 * np.pi)
            found.append(
                f"the structure at {tuned:.3f} Hz vibrates near twice the swing's {own[0, 0] / (2 * np.pi):.3f} Hz "
                f"and may pump it: small errors can grow {np.exp(min(growth.max(), 50.0)):.2g} times"
            )
        return tuple(found)


def choose(
    scene: RadialScene, targets: Mapping[str, Tolerance], stated: Mapping[str, Any] | None = None
) -> Choice[Setting]:
    """The cheapest setting that is expected to keep all targets, or where none does the one that comes nearest.

    Parameters
    ----------
    scene : RadialScene
    targets : dict of str to Tolerance
        By output, some of :data:`towercrane.accuracy.instants.OUTPUTS`.
    stated : dict, optional
        Fields of :class:`towercrane.accuracy.scene.Setting` that are not to be chosen.

    Raises
    ------
    ValueError
        If an output is unknown, or none is given.
    NoEquilibrium
        If the tower buckles.
    """
    if not targets or not set(targets) <= set(OUTPUTS):
        raise ValueError(f"targets: wanted some of {', '.join(OUTPUTS)}, got {', '.join(targets) or 'none'}")
    began, stated = time.process_time(), dict(stated or {})
    indicators = Indicators(scene, stated.get("tower_modes", 0), stated.get("jib_modes", 0))
    softening = stated.get("weight_softening", True)
    peaks = np.maximum(indicators.rich(softening).peaks, SMALLEST_PEAK)
    allowed = limits(OUTPUTS, targets, peaks)
    wanted = np.isfinite(allowed)
    best, nearest, tried = None, np.inf, 0
    for candidate in candidates(indicators, set(targets), {"weight_softening": softening, **stated}):
        tried += 1
        for share in SHARES:
            setting = replace(candidate, **{**_solver(indicators, candidate, allowed, peaks, share), **stated})
            estimate = indicators.estimate(setting)
            excess = float(np.max(estimate.errors(peaks)[wanted] / allowed[wanted]))
            if best is None or excess < nearest:
                best, nearest = (setting, estimate), excess
            if excess <= 1.0 or not np.any(indicators.damped(setting) > 0.1 * allowed):
                break
        if excess <= 1.0:
            break
    assert best is not None
    doubts = indicators.doubts(softening)
    spent = time.process_time() - began
    return Choice(*best, peaks, nearest <= 1.0, doubts, tried, spent, tuple(_left_out(indicators, best[0])))


def limits(outputs: Iterable[str], targets: Mapping[str, Tolerance], peaks: Floats) -> Floats:
    """Largest allowed errors in the outputs' units, infinite where none is set; shape (outputs,)."""
    found, names = np.full(len(peaks), np.inf), list(outputs)
    for name, (value, relative) in targets.items():
        index = names.index(name)
        found[index] = value * max(peaks[index], SMALLEST_PEAK) if relative else value
    return found


def _solver(
    indicators: Indicators, setting: Setting, allowed: Floats, peaks: Floats, share: float
) -> dict[str, float]:
    """Tolerances of the solver for a share of the allowed errors."""
    wanted = np.isfinite(allowed)
    per_rtol = indicators.per_rtol(replace(setting, method="dop853"))
    rtol = float(np.clip(np.min(share * allowed / (per_rtol * peaks)), TIGHTEST, LOOSEST))
    # A centimetre or a centiradian, or the smallest motion that matters, has the relative tolerance.
    moving = peaks[:TENSION][wanted[:TENSION]]
    return {"rtol": rtol, "atol": rtol * float(np.clip(moving.min(initial=1e-2), 1e-5, 1e-2))}


def candidates(indicators: Indicators, outputs: set[str], stated: dict[str, Any]) -> list[Setting]:
    """Models to be tried, the cheapest first."""
    own = indicators.nodes.frequencies / (2.0 * np.pi)
    tower, jib = np.split(own[:-1], [indicators.richest.tower_modes])
    free = free_frequency(indicators)
    found: dict[Setting, float] = {}
    for a, b in MODES:
        counts = {"tower_modes": a, "jib_modes": b, **stated}
        a, b = counts["tower_modes"], counts["jib_modes"]
        rigid = (OUTPUTS[0] in outputs and not a) or (OUTPUTS[1] in outputs and not b)
        if rigid and stated.keys().isdisjoint({"tower_modes", "jib_modes"}):
            continue
        highest = max([*tower[:a], *jib[:b]], default=0.0)
        for cap in (np.inf, *(free * factor for factor in CAPS)):
            if cap == np.inf or cap < highest:
                found[Setting(**{"cap": cap, **counts})] = cost(a + b, min(highest, cap))
    return sorted(found, key=found.__getitem__)


def free_frequency(indicators: Indicators) -> float:
    """Highest frequency of the modes that a cap never slows [Hz]."""
    own = indicators.nodes.frequencies
    return float(max(own[FREE_MODES - 1], own[indicators.richest.tower_modes + FREE_MODES - 1]) / (2.0 * np.pi))


def cost(n: int, highest: float) -> float:
    """Time for a run, up to a factor, with n modes up to a frequency [Hz]; steps follow the fastest mode."""
    return (highest + 1.0) * (0.45 + 0.09 * n + 0.0035 * n**2)


def _left_out(indicators: Indicators, setting: Setting) -> list[str]:
    """What a setting has not that the richest model has, and why not, in sentences."""
    rigid = [part for part, count in (("tower", setting.tower_modes), ("jib", setting.jib_modes)) if not count]
    found = [f"bending of the {part}: what is asked for hardly feels it" for part in rigid]
    found.append(
        f"modes beyond {setting.tower_modes} of the tower and {setting.jib_modes} of the jib: "
        "their flexibility and ringing are in the estimate"
    )
    if np.isfinite(setting.cap):
        found.append(f"vibration above {setting.cap:.3g} Hz: faster modes are slowed to it and keep their stiffness")
    found.append("motion out of the jib's plane: nothing drives the load out of it")
    if not setting.weight_softening:
        found.append(f"the weight's softening of the tower, as the case states: {_softening(indicators)}")
    return found


def _softening(indicators: Indicators) -> str:
    """What the weight's softening would do, in words."""
    try:
        changes = indicators.softening() / np.maximum(indicators.rich(True).peaks, SMALLEST_PEAK)
    except NoEquilibrium:
        return "with it the tower buckles"
    # Two models that have lost each other's phase differ by twice the peak at most.
    shares = zip(OUTPUTS, np.minimum(changes, 2.0), strict=True)
    return "it would change " + ", ".join(f"{n.replace('_', ' ')} by {s:.1%}" for n, s in shares) + " of the peak"
