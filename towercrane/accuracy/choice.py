"""Ask for an error, get the cheapest run that keeps it: the choice of modes, cap and tolerance for a scene."""

from __future__ import annotations

import time
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.accuracy.estimate import SMALLEST_PEAK, Choice, check_targets, limits
from towercrane.accuracy.foretold import MEASURED, Indicators
from towercrane.accuracy.instants import OUTPUTS, TENSION
from towercrane.accuracy.setting import Setting
from towercrane.cranes.tower.modes.frequency_cap import FREE_MODES
from towercrane.simulation.system import NoEquilibrium

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from towercrane.accuracy.scene import Scene
    from towercrane.schema.targets import Tolerance

    Floats = NDArray[np.float64]

SHARES = (0.3, 0.01)
"""Parts of the target that the solver may use up: as a rule, and where it would damp what rings fastest."""

LOOSEST, TIGHTEST = 2e-3, 1e-9
"""Range of rtol."""

TRIED_COUNTS = (
    (0, 0), (1, 0), (0, 1), (1, 1), (1, 2), (2, 2), (2, 3),
    (2, 4), (3, 4), (3, 6), (4, 8), (5, 11), (8, 11),
)  # fmt: skip
"""Numbers of tower and jib modes that are tried."""

CAPS = (1.0, 2.0, 5.0, 12.0)
"""Caps that are tried, over the fastest of the modes that are never capped, besides none."""


def choose(scene: Scene, targets: Mapping[str, Tolerance], stated: Mapping[str, Any] | None = None) -> Choice:
    """The cheapest setting that is expected to keep all targets, or where none does the one that comes nearest.

    Parameters
    ----------
    scene : Scene
    targets : dict of str to Tolerance
        By output, some of :data:`towercrane.accuracy.instants.OUTPUTS`.
    stated : dict, optional
        Fields of :class:`towercrane.accuracy.setting.Setting` that are not to be chosen.

    Raises
    ------
    ValueError
        If an output is unknown, or none is given.
    NoEquilibrium
        If the tower buckles.
    """
    check_targets(OUTPUTS, targets)
    began, stated = time.process_time(), dict(stated or {})
    indicators = Indicators(scene, stated.get("tower_modes", 0), stated.get("jib_vertical_modes", 0))
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


def _solver(
    indicators: Indicators, setting: Setting, allowed: Floats, peaks: Floats, share: float
) -> dict[str, float]:
    """Tolerances of the solver for a share of the allowed errors."""
    wanted = np.isfinite(allowed)
    per_rtol = indicators.per_rtol(replace(setting, method=MEASURED))
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
    for a, b in TRIED_COUNTS:
        counts = {"planar": True, "tower_modes": a, "jib_vertical_modes": b, **stated}
        a, b = counts["tower_modes"], counts["jib_vertical_modes"]
        rigid = (OUTPUTS[0] in outputs and not a) or (OUTPUTS[1] in outputs and not b)
        if rigid and stated.keys().isdisjoint({"tower_modes", "jib_vertical_modes"}):
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
    rigid = [
        part for part, count in (("tower", setting.tower_modes), ("jib", setting.jib_vertical_modes)) if not count
    ]
    found = [f"bending of the {part}: what is asked for hardly feels it" for part in rigid]
    found.append(
        f"modes beyond {setting.tower_modes} of the tower and {setting.jib_vertical_modes} of the jib: "
        "their flexibility and ringing are in the estimate"
    )
    if np.isfinite(setting.cap):
        found.append(f"vibration above {setting.cap:.3g} Hz: faster modes are slowed to it and keep their stiffness")
    found.append("motion out of the jib's plane: nothing drives the crane or its load out of it")
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
