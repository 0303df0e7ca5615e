"""What every method does in the long run: energy of free vibration, growth of the error, and where it fails."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.bench.clock import short, signed
from towercrane.bench.runs.one_hour import one_hour
from towercrane.bench.scenes.free_vibration import CASE, SWING, TROLLEY, FreeVibration
from towercrane.bench.scenes.prepared import radial_outputs
from towercrane.simulation.methods.method import ATOL_SHARE, NAMED, SPAN
from towercrane.simulation.methods.registry import METHODS

if TYPE_CHECKING:
    from collections.abc import Callable

TOLERANCES = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6)

DRIFT_MODES = ((1, 1), (2, 3))

GROWTH_RUNS = (("dop853", 1e-4), ("dop853", 1e-6), ("dop853", 1e-8), ("dopri5", 1e-4), ("dopri5", 1e-6))

MAP_SPAN = 60.0
"""Span of the failure map [s]."""

MAP_MODES = ((1, 1), (2, 2), (2, 3), (4, 4), (6, 8))

AGREE = 3.0
"""Factor within which a measured drift has to agree with the one stated, or else both be too small to name."""


def stability(*, quick: bool = False, say: Callable[[str], None] = print) -> dict[str, Any]:
    """Energy drift, over an hour too, error growth and failure map.

    Parameters
    ----------
    quick : bool
        SciPy's methods on the smallest model only.

    Returns
    -------
    dict
        ``subjects`` as in :func:`towercrane.bench.measure`: drift, one hour, error growth, failure map;
        ``met``: whether the drift that runs warn of is the one measured.
    """
    subjects = []
    for subject in (drift, one_hour, error_growth, failure_map):
        say(f"measuring: {subject.__doc__.splitlines()[0] if subject.__doc__ else subject.__name__}")
        subjects.append(subject(quick))
    return {"subjects": subjects, "met": subjects[0]["met"]}


def drift(quick: bool) -> dict[str, Any]:
    """Energy after 600 s of free vibration, beside the figure that runs warn with."""
    scenes = [(modes, FreeVibration(*modes)) for modes in DRIFT_MODES]
    records = []
    for method in METHODS:
        compiled = METHODS[method].compiled
        for rtol in TOLERANCES:
            if quick and not compiled and (method == "scipy-radau" or rtol < 1e-4):
                continue
            changes = {}
            for modes, scene in scenes:
                minutes = method == "scipy-radau" and rtol < 1e-4
                if compiled or modes == DRIFT_MODES[0] or not (quick or minutes):
                    changes[f"{modes[0]}+{modes[1]}"] = scene.energy_change(scene.run(method, rtol, SPAN))
            worst = max(changes.values(), key=abs)
            records.append(_drift_record(method, rtol, changes, worst, complete=len(changes) == len(scenes)))
    return {
        "name": "drift",
        "title": f"Energy of undamped free vibration after {SPAN:g} s, relative change",
        "columns": ["method", "rtol", *(f"{t}+{j} modes" for t, j in DRIFT_MODES), "stated", "a run says"],
        "rows": [
            [
                r["method"], f"{r['rtol']:.0e}",
                *(signed(r["changes"].get(f"{tower}+{jib}")) for tower, jib in DRIFT_MODES),
                signed(r["stated"]), r["verdict"],
            ]
            for r in records
        ],
        "records": records,
        "met": all(record["met"] for record in records),
        "notes": [
            f"{CASE}, trolley parked at {TROLLEY:g} m, weights switched on at once, load let go at {SWING:g} rad; "
            f"atol is rtol / {1.0 / ATOL_SHARE:g}",
            f"a change beyond {NAMED:.0%} is named by every run at that tolerance; '!': the figure has changed",
            *(["quick: SciPy's methods with 1+1 modes only, without Radau"] if quick else []),
        ],
    }  # fmt: skip


def _drift_record(
    method: str, rtol: float, changes: dict[str, float], worst: float, *, complete: bool
) -> dict[str, Any]:
    atol = ATOL_SHARE * rtol
    known = METHODS[method]
    refused = bool(known.refusal(rtol, atol))
    stated = None if refused else known.energy_change(rtol, atol)
    verdict = "refused" if refused else "warning" if known.notice(rtol, atol) else "nothing"
    met = agrees(worst, stated) if complete else True
    return {
        "method": method, "rtol": rtol, "changes": changes, "worst": worst, "stated": stated,
        "verdict": verdict + ("" if met else " !"), "met": met,
    }  # fmt: skip


def agrees(measured: float, stated: float | None) -> bool:
    """Whether a measured drift bears out the stated one; None stands for a method that is refused."""
    if stated is None:
        return measured > 1.0
    if abs(measured) < NAMED and abs(stated) < NAMED:
        return True
    return stated / AGREE < measured < stated * AGREE if stated > 0.0 else stated * AGREE < measured < stated / AGREE


def error_growth(quick: bool) -> dict[str, Any]:
    """Error of tower top, jib tip and swing as free vibration goes on."""
    scene = FreeVibration(2, 3)
    span, step = (60.0 if quick else SPAN), 0.1
    outputs = partial(radial_outputs, scene.model)
    reference = outputs(scene.run("dop853", 1e-12, span, step).states)
    size = abs(reference).max(axis=0)
    marks = np.array([m for m in (1.0, 10.0, 60.0, 600.0) if m <= span])
    times = np.linspace(0.0, span, len(reference))
    records: list[dict[str, Any]] = []
    for method, rtol in GROWTH_RUNS:
        error = (abs(outputs(scene.run(method, rtol, span, step).states) - reference) / size).max(axis=1)
        grown = np.maximum.accumulate(error)
        late = times >= 0.1 * span
        slope = np.polyfit(np.log(times[late]), np.log(grown[late]), 1)[0]
        at = {f"{mark:g}": float(grown[np.searchsorted(times, mark - 1e-9)]) for mark in marks}
        every = slice(1, None, max(1, len(times) // 400))
        curve = {"time_s": times[every].tolist(), "error": grown[every].tolist()}
        records.append({"method": method, "rtol": rtol, "errors": at, "exponent": float(slope), "curve": curve})
    return {
        "name": "error-growth",
        "title": "Growth of the error in free vibration, 2+3 modes: largest so far, of each output's peak",
        "columns": ["method", "rtol", *(f"{mark:g} s" for mark in marks), "~ time^"],
        "rows": [
            [r["method"], f"{r['rtol']:.0e}", *(short(e) for e in r["errors"].values()), f"{r['exponent']:.2f}"]
            for r in records
        ],
        "records": records,
        "notes": [
            "reference: dop853 at rtol 1e-12; worst of tower top, jib tip and swing; exponent of the last 90 %"
        ],
    }


def failure_map(quick: bool) -> dict[str, Any]:
    """Energy after one minute, tolerance against the model's highest frequency."""
    records: list[dict[str, Any]] = []
    for modes in MAP_MODES:
        scene = FreeVibration(*modes)
        for method in METHODS:
            for rtol in TOLERANCES:
                change = None
                if _mapped(method, modes, quick):
                    change = scene.energy_change(scene.run(method, rtol, MAP_SPAN))
                records.append(
                    {
                        "method": method, "rtol": rtol, "modes": f"{modes[0]}+{modes[1]}",
                        "frequency_hz": scene.frequency, "change": change,
                    }
                )  # fmt: skip
    rows = []
    for method in METHODS:
        for rtol in TOLERANCES:
            cells = [r for r in records if r["method"] == method and r["rtol"] == rtol]
            rows.append([method, f"{rtol:.0e}", *(signed(r["change"]) for r in cells)])
    highest = dict.fromkeys((r["modes"], r["frequency_hz"]) for r in records)
    return {
        "name": "failure-map",
        "title": f"Failure map: relative change of the energy after {MAP_SPAN:g} s, against the highest frequency",
        "columns": ["method", "rtol", *(f"{modes}, {frequency:.3g} Hz" for modes, frequency in highest)],
        "rows": rows,
        "records": records,
        "notes": [
            "'failed': the step size collapsed or the state was not finite; '-': not measured, it would take minutes",
        ],
    }


def _mapped(method: str, modes: tuple[int, int], quick: bool) -> bool:
    """Whether a cell of the map is measured: SciPy's methods take minutes on stiff models."""
    if METHODS[method].compiled:
        return modes != MAP_MODES[-1] or not quick
    if quick:
        return modes == MAP_MODES[0] and method != "scipy-radau"
    return sum(modes) <= (4 if method == "scipy-radau" else 8)
