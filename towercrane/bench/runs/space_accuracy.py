"""Benchmark of error-controlled runs in space: expected against actual error, cost of choosing against running."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.accuracy.estimate import SMALLEST_PEAK
from towercrane.accuracy.mode_choice import measured_choice
from towercrane.accuracy.promise import KEPT, OUT_OF_REACH, finer
from towercrane.bench.runs.accuracy import promises
from towercrane.bench.scenes.drawn import space_scenes
from towercrane.cranes.tower.targets import MOTIONS
from towercrane.results.measures import gap, peak
from towercrane.schema.targets import Tolerance
from towercrane.simulation.outcomes import FINISHED
from towercrane.simulation.system import NoEquilibrium

if TYPE_CHECKING:
    from towercrane.accuracy.scene import Scene

TARGETS = (1e-1, 3e-2, 1e-2, 3e-3)
"""Errors over peaks that are asked for."""

FORCES = ("slewing_torque", "base_moment_y", "jib_root_moment")
"""Outputs that are asked for besides motions in some of the scenes."""

QUICK, FULL, SEED = 2, 60, 9205
"""Scenes drawn, and the seed that the factors were not set on."""


def error_controlled_in_space(quick: bool) -> dict[str, Any]:
    """Error-controlled runs of drawn scenes in space."""
    notes = [
        f"scenes: cranes, loads, ropes, slewing, trolley, hoist and wind drawn with seed {SEED}; outputs: all "
        "motions, or two and three forces",
        "reference: 1 tower, 1 torsion, 2 lateral and 2 vertical modes more, a hundredth of rtol or 1e-8",
        "choice / run: CPU time of the whole choice over that of the chosen run",
    ]
    records = measured(QUICK if quick else FULL, SEED)
    return promises("space-accuracy", "Error-controlled runs in space", records, notes, "choice / run")


def measured(count: int, seed: int, first: int = 0) -> list[dict[str, Any]]:
    """One record per scene from the first that is wanted, see :func:`measured_scene`."""
    rng = np.random.default_rng(seed + 1)
    found = []
    for number, scene in enumerate(space_scenes(count, seed)):
        target = float(rng.choice(TARGETS))
        outputs = tuple(MOTIONS) if rng.random() < 0.5 else ("payload_position", "sway_tangential", *FORCES)
        if number < first:
            continue
        found.append({"scene": number, "target": target, **measured_scene(scene, target, outputs)})
    return found


def measured_scene(scene: Scene, target: float, outputs: tuple[str, ...]) -> dict[str, Any]:
    """Choose, run, and compare with a richer model.

    Returns
    -------
    dict
        ``outcome`` ("promised", or why not), ``error`` (largest over the peak), ``estimate``, ``output`` (the worst),
        ``setting``, ``tried``, ``cost`` (of choosing over that of running), ``choice_seconds``.
    """
    nothing: dict[str, Any] = {"error": None, "estimate": None, "output": "", "setting": "", "cost": None}
    try:
        choice, result = measured_choice(scene, {name: Tolerance(target, relative=True) for name in outputs})
    except NoEquilibrium as failure:
        return {"outcome": failure.outcome, **nothing}
    setting = choice.setting
    began = time.process_time()
    scene.run(setting)
    seconds = time.process_time() - began
    counts = setting.counts.values()
    record = {
        **nothing,
        "setting": " + ".join(map(str, counts)) + f" modes, rtol {setting.rtol:.0e}",
        "tried": choice.tried,
        "cost": choice.cpu_seconds / seconds,
        "choice_seconds": choice.cpu_seconds,
    }
    reference = scene.run(finer(setting, scene, foretold=False))
    if result.attrs["outcome"] != FINISHED or reference.attrs["outcome"] != FINISHED:
        return {**record, "outcome": f"ended early: {result.attrs['outcome']}"}
    peaks = {name: max(peak(reference, name), SMALLEST_PEAK) for name in outputs}
    errors = {name: gap(result, reference, name) / peaks[name] for name in outputs}
    estimates = dict(zip(scene.outputs, choice.estimate.errors(choice.peaks) / choice.peaks, strict=True))
    worst = max(errors, key=lambda name: errors[name])
    return {
        **record,
        "outcome": "may not hold" if choice.doubts else KEPT if choice.kept else OUT_OF_REACH,
        "error": errors[worst],
        "estimate": max(float(estimates[name]) for name in outputs),
        "errors": errors,
        "estimates": {name: float(estimates[name]) for name in outputs},
        "output": worst,
    }
