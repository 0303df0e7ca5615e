"""What a run promises of its errors, beside what was asked for, in words and numbers."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.accuracy.choice import Choice, Estimate, Indicators, choose, limits
from towercrane.accuracy.instants import BEYOND
from towercrane.accuracy.mode_convergence import measured_choice
from towercrane.accuracy.scene import Setting, provenance, scene_of, setting_of
from towercrane.accuracy.space_scene import SpaceSetting, space_scene_of, space_setting_of
from towercrane.cranes.registry import KINDS
from towercrane.cranes.tower.file.case_tables import RadialCase, SpaceCase
from towercrane.cranes.tower.file.effects import softened
from towercrane.results.measures import gap, peak, picked_in
from towercrane.schema.targets import Targets, Tolerance
from towercrane.simulation.outcomes import FINISHED, INTERRUPTED

if TYPE_CHECKING:
    from collections.abc import Mapping

    from towercrane.cases.case import Case
    from towercrane.results.recording import Recording
    from towercrane.simulation.run import Run
    from towercrane.simulation.trajectory import Progress

KEPT = "promised"
OUT_OF_REACH = "out of reach"
CANNOT_BE_PROMISED = "cannot be promised"
VERIFIED = "verified"
BROKEN = "promise broken"

AS_ASKED = (KEPT, VERIFIED)
"""Outcomes of a run with the error that was asked for."""

FINER, FINE = 1e-2, 1e-8
"""Rtol of the run that verifies: over that of the run, and at most; fast modes that only it has need the latter."""

MORE = {"tower_modes": 1, "torsion_modes": 1, "jib_lateral_modes": 2, "jib_vertical_modes": 2}
"""Modes that the model of such a run in space has more."""


def targets_of(case: Case) -> Targets:
    """Errors that a case asks for, by output; none for kinds of crane whose errors cannot be asked for."""
    asked = getattr(case.checked, "accuracy", None)
    return asked.targets if asked else {}


def outputs_of(case: Case) -> dict[str, str]:
    """Outputs of a case whose error can be asked for, and their units."""
    return dict(KINDS[case.kind].targets)


def stated(case: Case) -> dict[str, Any]:
    """Fields of the setting that the case's author wrote: they are not chosen, only checked."""
    tables = case.checked
    assert isinstance(tables, RadialCase | SpaceCase), "only these ask for errors"
    written = {key: getattr(table, key) for table in (tables.model, tables.solver) for key in table.model_fields_set}
    if isinstance(tables, RadialCase) and tables.accuracy.frequency is not None:
        written["weight_softening"] = softened(tables)
    fields = (Setting if isinstance(tables, RadialCase) else SpaceSetting).__dataclass_fields__
    return {key: value for key, value in written.items() if key in fields}


def chosen(case: Case, progress: Progress | None = None) -> tuple[Choice[Any], Run]:
    """Setting for the error that a case asks for, and the run in it.

    Raises
    ------
    NoEquilibrium
        If the tower buckles.
    KeyboardInterrupt
        If one of the runs that a choice in space needs was interrupted.
    """
    targets = targets_of(case)
    if isinstance(case.checked, SpaceCase):
        return measured_choice(space_scene_of(case), targets, stated(case), progress)
    scene = scene_of(case)
    choice = choose(scene, targets, stated(case))
    return choice, scene.run(choice.setting, progress=progress)


def promise(case: Case, choice: Choice[Any], result: Recording) -> dict[str, Any]:
    """What was asked for, chosen and is expected, ready for JSON.

    Returns
    -------
    dict
        ``outcome`` ("promised", "out of reach", "cannot be promised"; later that of :func:`settle`), ``reasons`` of
        it, ``outputs`` (by output: ``allowed``, ``estimated``, ``peak`` in ``units``), ``setting``, ``stated``,
        ``left_out`` in sentences, ``tried``, ``choice_cpu_seconds``.
    """
    targets = targets_of(case)
    estimated, allowed, peaks = _figures(outputs_of(case), choice.estimate, targets, result)
    over = [name for name in targets if not estimated[name] <= allowed[name]]
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
            for name in targets
        },
        "setting": provenance(choice.setting),
        "stated": sorted(given),
        "left_out": list(choice.left_out),
        "tried": choice.tried,
        "choice_cpu_seconds": choice.cpu_seconds,
    }


def finer(setting: Setting) -> Setting:
    """The next richer model with a tighter tolerance."""
    return replace(
        setting,
        tower_modes=setting.tower_modes + BEYOND[0],
        jib_modes=setting.jib_modes + BEYOND[1],
        cap=np.inf,
        rtol=max(_fine(setting.rtol) * setting.rtol, 1e-12),
        atol=max(_fine(setting.rtol) * setting.atol, 1e-14),
    )


def _fine(rtol: float) -> float:
    """Tolerances of a run that verifies, over those of the run."""
    return min(FINER, FINE / rtol)


def finer_in_space(setting: SpaceSetting, described: tuple[str, ...]) -> SpaceSetting:
    """The next richer model of a crane with data for these kinds of modes, with a tighter tolerance."""
    counts = {kind: getattr(setting, kind) + MORE[kind] for kind in described}
    return replace(setting.with_counts(counts).tightened(_fine(setting.rtol)), planar=False)


def verification(case: Case, result: Run) -> dict[str, Any]:
    """Estimated errors of a run beside its differences from a richer model's.

    Returns
    -------
    dict
        ``setting``, ``finer`` (the richer one), ``outcome`` of its run, ``doubts``, ``outputs`` (by output:
        ``estimated``, ``actual``, ``peak``, ``units``), over the time that both runs reached.

    Raises
    ------
    KeyboardInterrupt
        If one of its runs was interrupted.
    """
    units = outputs_of(case)
    setting, better, estimate, doubts, richer = (_in_space if isinstance(case.checked, SpaceCase) else _in_plane)(
        case, result
    )
    if richer.attrs["outcome"] == INTERRUPTED:
        raise KeyboardInterrupt
    estimated, _, peaks = _figures(units, estimate, {}, result)
    return {
        "setting": provenance(setting),
        "finer": provenance(better),
        "outcome": richer.attrs["outcome"],
        "doubts": list(doubts),
        "outputs": {
            name: {
                "estimated": estimated[name] if np.isfinite(estimated[name]) else None,
                "actual": gap(result, richer, name),
                "peak": peaks[name],
                "units": unit,
            }
            for name, unit in units.items()
        },
    }


def settle(result: Recording, report: dict[str, Any]) -> None:
    """Let what a verification found be the outcome of a run's promise; nothing for a run that promises nothing.

    Parameters
    ----------
    result : Recording
        Of a run that finished.
    report : dict
        From :func:`verification`.
    """
    if "accuracy" not in result.attrs:
        return
    promised = json.loads(result.attrs["accuracy"])
    reasons = [
        f"{name.replace('_', ' ')}: {report['outputs'][name]['actual']:.2g} {asked['units']} found beside a richer "
        f"model, {asked['allowed']:.2g} wanted"
        for name, asked in promised["outputs"].items()
        if not report["outputs"][name]["actual"] <= asked["allowed"]
    ]
    outcome = promised["outcome"]
    if reasons:
        outcome = BROKEN if outcome == KEPT else outcome
        reasons = [*promised["reasons"], *reasons]
    elif report["outcome"] != FINISHED:
        outcome = CANNOT_BE_PROMISED
        reasons = [*promised["reasons"], f"a richer model ended early: {report['outcome']}"]
    elif outcome == OUT_OF_REACH:
        outcome = VERIFIED
    else:
        reasons = promised["reasons"]
    result.attrs["accuracy"] = json.dumps({**promised, "outcome": outcome, "reasons": reasons})


Verified = tuple[Any, Any, Estimate, tuple[str, ...], "Recording"]
"""Setting of a run and a finer one, estimate of the first and doubts of it, run of the second."""


def _in_plane(case: Case, result: Run) -> Verified:
    scene, picked = scene_of(case, result), picked_in(result)
    setting = Setting(**{**picked, "cap": picked["cap"] or np.inf}) if picked else setting_of(case)
    indicators, better = Indicators(scene, setting.tower_modes, setting.jib_modes), finer(setting)
    return (
        setting,
        better,
        indicators.estimate(setting),
        indicators.doubts(setting.weight_softening),
        scene.run(better),
    )


def _in_space(case: Case, result: Run) -> Verified:
    scene, picked = space_scene_of(case, result), picked_in(result)
    setting = SpaceSetting(**picked) if picked else space_setting_of(case)
    anything = dict.fromkeys(scene.outputs, Tolerance(1e-3, relative=True))
    checked, _ = measured_choice(scene, anything, vars(setting))
    better = finer_in_space(setting, scene.described)
    return setting, better, checked.estimate, checked.doubts, scene.run(better)


def _figures(
    units: dict[str, str], estimate: Estimate, targets: Mapping[str, Tolerance], result: Recording
) -> tuple[dict[str, float], dict[str, float], dict[str, float]]:
    """Estimated and allowed errors and the run's peaks, by output, in the output's unit."""
    peaks = np.array([peak(result, name) for name in units])
    found = (estimate.errors(peaks), limits(units, targets, peaks), peaks)
    estimated, allowed, largest = (dict(zip(units, values.tolist(), strict=True)) for values in found)
    return estimated, allowed, largest
