"""Benchmark of many runs at once: a plain loop, vector lanes, lanes and threads."""

from __future__ import annotations

import dataclasses
import time
from typing import TYPE_CHECKING, Any

import numpy as np

from modal.compiler.lanes import LANES
from towercrane.bench.clock import short, whole
from towercrane.cases.case import load_case
from towercrane.cases.models import motions_of
from towercrane.cranes.tower.file.build import tower_model
from towercrane.cranes.tower.file.case_tables import TowerCase
from towercrane.motions.motion import Motion, phases
from towercrane.simulation.integrate import evaluate, integrate
from towercrane.simulation.lanes.many import available_cores, integrate_many
from towercrane.simulation.lanes.run import LaneRun
from towercrane.simulation.observed import observe
from towercrane.simulation.outcomes import INTERRUPTED
from towercrane.simulation.simulate import rows_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.simulation.lanes.many import LaneAnswers

    Floats = NDArray[np.float64]

CASE = "qtz5613/condition-3"

MANY, FEW = 10_000, 128
"""Variations with all repeats, and with few."""

MANY_ALONE, FEW_ALONE = 200, 12
"""Runs of the plain loop, spread over the variations."""

RTOL, TIGHT = 1e-4, 1e-11

OUTPUTS = "tower_tip_displacement", "jib_tip_deflection", "sway_radial", "hoist_rope_force"
"""What is looked at."""


def many_runs(repeats: int) -> dict[str, Any]:
    """Variations of load and rope in condition 3 (2+3 modes, rtol 1e-4): runs per second."""
    count, number_alone = (MANY, MANY_ALONE) if repeats > 3 else (FEW, FEW_ALONE)
    case = load_case(CASE)
    runs, grid = _variations(count, case.run.duration), rows_of(case.run.duration, case.run.output_step)
    cores = available_cores()
    some = list(range(0, count, count // number_alone))[:number_alone]
    _lanes(runs[:LANES], grid, RTOL, 1)
    records: list[dict[str, Any]] = []

    def measured(name: str, number: int, cores_used: int, call: Any) -> Any:
        began, began_cpu = time.perf_counter(), time.process_time()
        found = call()
        wall, cpu = time.perf_counter() - began, time.process_time() - began_cpu
        records.append(
            {"way": name, "runs": number, "runs_per_second": number / wall, "runs_per_cpu_second": number / cpu,
             "threads": cores_used}
        )  # fmt: skip
        return found

    # The loop is measured before and after, for a clock that drifts.
    alone = measured("plain loop, before", len(some), 1, lambda: _loop([runs[i] for i in some], grid, RTOL))
    lanes = measured("lanes, one thread", count, 1, lambda: _lanes(runs, grid, RTOL, 1))
    threaded = measured(f"lanes, {cores} threads", count, cores, lambda: _lanes(runs, grid, RTOL, cores))
    measured("plain loop, after", len(some), 1, lambda: _loop([runs[i] for i in some], grid, RTOL))
    measured("lanes, half the simulated time", count, 1, lambda: _halved(count, case.run.duration))
    reference = _lanes([runs[i] for i in some], grid, TIGHT, cores).extremes
    same = max(np.max(_gaps(found.extremes[some], alone)) for found in (lanes, threaded))
    errors = _gaps(lanes.extremes[some], reference)
    loop = np.mean([r["runs_per_cpu_second"] for r in records if r["way"].startswith("plain")])
    return {
        "name": "many",
        "title": f"{count} variations of load and rope, 120 s of condition 3, 2+3 modes, rtol 1e-4",
        "columns": ["way", "runs", "runs per second", "runs per CPU second", "of the plain loop"],
        "rows": [
            [r["way"], str(r["runs"]), f"{r['runs_per_second']:.0f}", f"{r['runs_per_cpu_second']:.0f}",
             f"{r['runs_per_cpu_second'] / loop:.1f}"]
            for r in records
        ],
        "records": records,
        "notes": [
            f"{LANES} lanes; every way finds the extremes of four outputs among 2401 rows, start included",
            f"lanes beside the loop: extremes differ by {same:.0e} of the largest",
            "off runs at rtol 1e-11, lanes as loop: " + ", ".join(
                f"{name.replace('_', ' ')} {short(error)}" for name, error in zip(OUTPUTS, errors, strict=True)
            ),
        ],
    }  # fmt: skip


def _variations(count: int, duration: float) -> list[LaneRun]:
    """Loads from 100 to 2000 kg, ropes from 5 to 23 m, drawn without order."""
    case = load_case(CASE)
    model = tower_model(case.tables(TowerCase), tower_modes=2, jib_vertical_modes=3)
    motions = motions_of(case)
    cut = phases((motions["trolley"], motions["rope"]), duration)
    random = np.random.default_rng(0)
    runs = []
    for mass, length in zip(random.uniform(100.0, 2000.0, count), random.uniform(5.0, 23.0, count), strict=True):
        loaded = model.with_load(dataclasses.replace(model.load, mass=float(mass)))
        runs.append(LaneRun(loaded, cut.moved(1, length)))
    return runs


def _lanes(runs: list[LaneRun], grid: Floats, rtol: float, threads: int) -> LaneAnswers:
    found = integrate_many(runs, grid, outputs=OUTPUTS, rtol=rtol, atol=1e-2 * rtol, threads=threads)
    if INTERRUPTED in found.outcomes:
        raise KeyboardInterrupt
    return found


def _halved(count: int, duration: float) -> LaneAnswers:
    return _lanes(_variations(count, 0.5 * duration), rows_of(0.5 * duration, 0.05), RTOL, 1)


def _loop(runs: list[LaneRun], grid: Floats, rtol: float) -> Floats:
    """Extremes of single runs; shape (runs, outputs, 4)."""
    extremes = []
    for run in runs:
        model: Any = run.model
        start = model.start(run.phases.inputs[0])
        found = whole(integrate(model.system, run.phases, start, grid, rtol=rtol, atol=1e-2 * rtol))
        evaluated = evaluate(model.system, run.phases, found.times, found.states)
        motions = {
            name: Motion(run.phases.times, run.phases.inputs[:, row]) for row, name in enumerate(model.channels)
        }
        seen = observe(model, motions, found.times, found.states, *evaluated, OUTPUTS)
        values = np.column_stack([seen[name].values for name in OUTPUTS])
        high, low = values.argmax(axis=0), values.argmin(axis=0)
        extremes.append(np.stack([values.max(axis=0), grid[high], values.min(axis=0), grid[low]], axis=1))
    return np.array(extremes)


def _gaps(found: Floats, reference: Floats) -> Floats:
    """Largest difference of each output's extremes, of its largest extreme; shape (outputs,)."""
    values, exact = found[..., ::2], reference[..., ::2]
    return np.asarray(np.max(abs(values - exact), axis=(0, 2)) / np.max(abs(exact), axis=(0, 2)))
