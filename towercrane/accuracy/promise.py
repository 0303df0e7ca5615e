"""What a run promises of its errors, beside what was asked for, in words and numbers."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.accuracy.choice import choose
from towercrane.accuracy.estimate import Choice, Estimate, limits
from towercrane.accuracy.foretold import Indicators
from towercrane.accuracy.instants import BEYOND
from towercrane.accuracy.ladder import RUNG, laddered_choice
from towercrane.accuracy.mode_choice import measured_choice
from towercrane.accuracy.scene import Scene, scene_of, setting_of
from towercrane.accuracy.setting import Setting, setting_from
from towercrane.cases.models import targets_of
from towercrane.cranes.tower.crane_model import MODE_KINDS, moving
from towercrane.cranes.tower.file.case_tables import TowerCase
from towercrane.cranes.tower.file.effects import softened
from towercrane.cranes.tower.targets import FORETOLD
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


def stated(case: Case, scene: Scene) -> dict[str, Any]:
    """Fields of the setting that the case's author wrote: they are not chosen, only checked.

    Modes that leave the plane are nothing to a scene that does not.
    """
    tables = case.tables(TowerCase)
    written = {key: getattr(table, key) for table in (tables.model, tables.solver) for key in table.model_fields_set}
    if tables.accuracy.frequency is not None:
        written["weight_softening"] = softened(tables)
    still = set(MODE_KINDS) - set(moving(scene.planar))
    return {key: value for key, value in written.items() if key in Setting.__dataclass_fields__ and key not in still}


def chosen(case: Case, progress: Progress | None = None) -> tuple[Choice, Run]:
    """Setting for the error that a case asks for, and the run in it.

    Raises
    ------
    NoEquilibrium
        If the tower buckles.
    KeyboardInterrupt
        If one of the runs that a choice may need was interrupted.
    """
    scene, targets = scene_of(case), targets_of(case)
    if scene.laddered:
        return laddered_choice(scene, targets, stated(case, scene), progress)
    if not scene.foretells(targets):
        return measured_choice(scene, targets, stated(case, scene), progress)
    choice = choose(scene, targets, stated(case, scene))
    return choice, scene.run(choice.setting, progress=progress)


def promise(case: Case, choice: Choice, result: Run) -> dict[str, Any]:
    """What was asked for, chosen and is expected, ready for JSON.

    Returns
    -------
    dict
        ``outcome`` ("promised", "out of reach", "cannot be promised"; later that of :func:`settle`), ``reasons`` of
        it, ``outputs`` (by output: ``allowed``, ``estimated``, ``peak`` in ``units``), ``setting``, ``stated``,
        ``left_out`` in sentences, ``tried``, ``choice_cpu_seconds``.
    """
    scene, targets = scene_of(case, result), targets_of(case)
    estimated, allowed, peaks = _figures(_outputs(scene, targets), choice.estimate, targets, result)
    over = [name for name in targets if not estimated[name] <= allowed[name]]
    reasons = list(choice.doubts)
    if result.attrs["outcome"] != FINISHED:
        reasons.append(f"the run ended early: {result.attrs['outcome']}")
    outcome = CANNOT_BE_PROMISED if reasons else OUT_OF_REACH if over else KEPT
    given = stated(case, scene)
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
        "setting": choice.setting.provenance(),
        "stated": sorted(given),
        "left_out": list(choice.left_out),
        "tried": choice.tried,
        "choice_cpu_seconds": choice.cpu_seconds,
    }


def finer(setting: Setting, scene: Scene, *, foretold: bool, rungs: int = 1) -> Setting:
    """The next richer model, or one so many rungs richer, with a tighter tolerance.

    It leaves the plane where the scene does. Small motions foretell what the modes beyond `BEYOND` matter.
    """
    kinds = [kind for kind in moving(scene.planar) if kind in scene.described]
    more = BEYOND if foretold else {kind: rungs * RUNG[kind] for kind in kinds}
    # Fast modes that only it has need a tolerance of their own.
    tighter = min(FINER, FINE / setting.rtol)
    return replace(setting.with_more(more).tightened(tighter), planar=scene.planar, cap=np.inf)


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
    scene, picked = scene_of(case, result), picked_in(result)
    setting = setting_from(picked) if picked else setting_of(case)
    foretold = scene.foretells(targets_of(case))
    units = _outputs(scene, targets_of(case))
    doubts: tuple[str, ...] = ()
    # The next rung has told what is expected of a run on a ladder: another is asked.
    better = finer(setting, scene, foretold=foretold, rungs=2 if scene.laddered and picked else 1)
    if scene.laddered:
        estimate = _told(result, list(units))
    elif foretold:
        indicators = Indicators(scene, setting.tower_modes, setting.jib_vertical_modes)
        estimate, doubts = indicators.estimate(setting), indicators.doubts(setting.weight_softening)
    else:
        anything = dict.fromkeys(scene.outputs, Tolerance(1e-3, relative=True))
        checked, _ = measured_choice(scene, anything, vars(setting), known=result)
        estimate, doubts = checked.estimate, checked.doubts
    richer = scene.run(better)
    if richer.attrs["outcome"] == INTERRUPTED:
        raise KeyboardInterrupt
    estimated, _, peaks = _figures(units, estimate, {}, result)
    return {
        "setting": setting.provenance(),
        "finer": better.provenance(),
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


def _told(result: Run, names: list[str]) -> Estimate:
    """What a run itself says of its errors, unknown without a promise."""
    said = json.loads(result.attrs.get("accuracy", '{"outputs": {}}'))["outputs"]
    found = [said.get(name, {}).get("estimated") for name in names]
    return Estimate(np.array([np.inf if error is None else error for error in found]), np.zeros(len(names)))


def _outputs(scene: Scene, targets: Targets) -> dict[str, str]:
    """Outputs whose error is estimated, in the estimate's order, and their units."""
    return FORETOLD if scene.foretells(targets) else scene.outputs


def _figures(
    units: dict[str, str], estimate: Estimate, targets: Mapping[str, Tolerance], result: Recording
) -> tuple[dict[str, float], dict[str, float], dict[str, float]]:
    """Estimated and allowed errors and the run's peaks, by output, in the output's unit."""
    peaks = np.array([peak(result, name) for name in units])
    found = (estimate.errors(peaks), limits(units, targets, peaks), peaks)
    estimated, allowed, largest = (dict(zip(units, values.tolist(), strict=True)) for values in found)
    return estimated, allowed, largest
