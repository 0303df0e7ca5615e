"""What a run promises of its errors, beside what was asked for, in words and numbers."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.accuracy import SMALLEST_PEAK, Choice, Estimate, Indicators, choose, limits
from towercrane.integrate import FINISHED
from towercrane.nodes import OUTPUTS, RICHEST
from towercrane.scene import Setting, provenance, scene_of, setting_of
from towercrane.system import NoEquilibrium

if TYPE_CHECKING:
    import xarray as xr

    from towercrane.accuracy import Tolerance
    from towercrane.case import Case
    from towercrane.scene import RadialScene

KEPT = "promised"
OUT_OF_REACH = "out of reach"
CANNOT_BE_PROMISED = "cannot be promised"

FINER = 1e-2
"""Rtol of the run that verifies, over that of the run."""


def stated(case: Case) -> dict[str, Any]:
    """Fields of the setting that the case's author wrote: they are not chosen, only checked."""
    written = {
        **{key: getattr(case.model, key) for key in case.model.model_fields_set},
        **{key: getattr(case.solver, key) for key in case.solver.model_fields_set},
    }
    return {key: value for key, value in written.items() if key in Setting.__dataclass_fields__}


def chosen(case: Case, scene: RadialScene) -> Choice:
    """Setting for the error that a case asks for."""
    return choose(scene, case.accuracy.targets, stated(case))


def judged(scene: RadialScene, setting: Setting) -> tuple[Estimate, tuple[str, ...]]:
    """Estimate of a setting that nobody chose by its error, and why it may not hold."""
    indicators = Indicators(scene)
    return indicators.estimate(setting), indicators.doubts(setting.weight_softening)


def promise(case: Case, choice: Choice, result: xr.Dataset) -> dict[str, Any]:
    """What was asked for, chosen and is expected, ready for JSON.

    Returns
    -------
    dict
        ``outcome`` ("promised", "out of reach", "cannot be promised"), ``reasons`` of it, ``outputs`` (by output:
        ``allowed``, ``estimated``, ``peak`` in ``units``), ``setting``, ``stated``, ``left_out`` in sentences,
        ``tried``, ``choice_cpu_seconds``.
    """
    names, targets = list(case.accuracy.targets), case.accuracy.targets
    estimated, allowed, peaks = _figures(choice.estimate, targets, result)
    over = [name for name in names if not estimated[name] <= allowed[name]]
    reasons = list(choice.doubts)
    if result.attrs["outcome"] != FINISHED:
        reasons.append(f"the run ended early: {result.attrs['outcome']}")
    outcome = CANNOT_BE_PROMISED if reasons else OUT_OF_REACH if over else KEPT
    given = stated(case)
    for name in over:
        whose = " with what the case states" if given else ""
        reasons.append(
            f"{name.replace('_', ' ')}: {estimated[name]:.2g} {result[name].attrs['units']} expected{whose}, "
            f"{allowed[name]:.2g} wanted"
        )
    return {
        "outcome": outcome,
        "reasons": reasons,
        "outputs": {
            name: {
                "allowed": allowed[name],
                "estimated": estimated[name] if np.isfinite(estimated[name]) else None,
                "peak": peaks[name],
                "units": result[name].attrs["units"],
            }
            for name in names
        },
        "setting": provenance(choice.setting),
        "stated": sorted(given),
        "left_out": left_out(case, choice.setting),
        "tried": choice.tried,
        "choice_cpu_seconds": choice.cpu_seconds,
    }


def left_out(case: Case, setting: Setting) -> list[str]:
    """What a setting has not that the richest model has, and why not, in sentences."""
    rigid = [part for part, count in (("tower", setting.tower_modes), ("jib", setting.jib_modes)) if not count]
    found = [f"bending of the {part}: what is asked for hardly feels it" for part in rigid]
    if setting.tower_modes < RICHEST.tower_modes or setting.jib_modes < RICHEST.jib_modes:
        found.append(
            f"modes beyond {setting.tower_modes} of the tower and {setting.jib_modes} of the jib: "
            "their flexibility and ringing are in the estimate"
        )
    if np.isfinite(setting.cap):
        found.append(f"vibration above {setting.cap:.3g} Hz: faster modes are slowed to it and keep their stiffness")
    found.append("motion out of the jib's plane: nothing drives the load out of it")
    if not setting.weight_softening:
        found.append(f"the weight's softening of the tower, as the case states: {_softening(scene_of(case))}")
    return found


def _softening(scene: RadialScene) -> str:
    """What the weight's softening would do, in words."""
    indicators = Indicators(scene)
    try:
        changes = indicators.softening() / np.maximum(indicators.rich(True).peaks, SMALLEST_PEAK)
    except NoEquilibrium:
        return "with it the tower buckles"
    # Two models that have lost each other's phase differ by twice the peak at most.
    shares = zip(OUTPUTS, np.minimum(changes, 2.0), strict=True)
    return "it would change " + ", ".join(f"{n.replace('_', ' ')} by {s:.1%}" for n, s in shares) + " of the peak"


def finer(setting: Setting) -> Setting:
    """The next richer model with a tighter tolerance."""
    return replace(
        setting,
        tower_modes=min(setting.tower_modes + 2, RICHEST.tower_modes),
        jib_modes=min(setting.jib_modes + 4, RICHEST.jib_modes),
        cap=np.inf,
        rtol=max(FINER * setting.rtol, 1e-12),
        atol=max(FINER * setting.atol, 1e-14),
    )


def verification(case: Case, result: xr.Dataset) -> dict[str, Any]:
    """Estimated errors of a run beside its differences from a richer model's.

    Returns
    -------
    dict
        ``setting``, ``finer`` (the richer one), ``outcome`` of its run, ``doubts``, ``outputs`` (by output:
        ``estimated``, ``actual``, ``peak``, ``units``), over the time that both runs reached.
    """
    import json

    scene = scene_of(case)
    picked = json.loads(result.attrs["accuracy"])["setting"] if "accuracy" in result.attrs else None
    setting = setting_of(case) if picked is None else Setting(**{**picked, "cap": picked["cap"] or np.inf})
    estimate, doubts = judged(scene, setting)
    richer = scene.run(finer(setting))
    estimated, _, peaks = _figures(estimate, {}, result)
    rows = min(result.sizes["time"], richer.sizes["time"])
    return {
        "setting": provenance(setting),
        "finer": provenance(finer(setting)),
        "outcome": richer.attrs["outcome"],
        "doubts": list(doubts),
        "outputs": {
            name: {
                "estimated": estimated[name] if np.isfinite(estimated[name]) else None,
                "actual": float(abs(result[name].values[:rows] - richer[name].values[:rows]).max()),
                "peak": peaks[name],
                "units": result[name].attrs["units"],
            }
            for name in OUTPUTS
        },
    }


def _figures(
    estimate: Estimate, targets: dict[str, Tolerance], result: xr.Dataset
) -> tuple[dict[str, float], dict[str, float], dict[str, float]]:
    """Estimated and allowed errors and the run's peaks, by output, in the output's unit."""
    peaks = np.array([float(abs(result[name].values).max()) for name in OUTPUTS])
    found = (estimate.errors(peaks), limits(targets, peaks), peaks)
    estimated, allowed, largest = (dict(zip(OUTPUTS, values.tolist(), strict=True)) for values in found)
    return estimated, allowed, largest
