"""Benchmark of the crane in its jib's plane: right-hand side, modes left out."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.bench.clock import differences, interleaved, short, whole
from towercrane.bench.evaluations import Instant, evaluations
from towercrane.bench.scenes.prepared import radial_outputs
from towercrane.cases.case import load_case
from towercrane.cases.models import motions_of
from towercrane.cranes.tower.file.build import tower_model
from towercrane.cranes.tower.file.case_tables import TowerCase
from towercrane.motions.motion import phases
from towercrane.simulation.integrate import integrate

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from towercrane.cranes.tower.model import FlexibleModel
    from towercrane.simulation.trajectory import Trajectory

    Floats = NDArray[np.float64]

CASE = "qtz5613/condition-3"


def right_hand_side(repeats: int) -> dict[str, Any]:
    """One evaluation of the radial right-hand side."""
    models = {}
    for modes in ((0, 0), (2, 2), (2, 3), (4, 4)):
        model = tower_model(load_case(CASE).tables(TowerCase), tower_modes=modes[0], jib_vertical_modes=modes[1])
        cut, start = _scene(model)
        models[f"{modes[0]} tower + {modes[1]} jib modes"] = Instant(model.system, cut, start, 10.0)
    return evaluations("radial-rhs", "Right-hand side of the crane in its jib's plane", models, repeats)


def modes_left_out(repeats: int) -> dict[str, Any]:
    """The same run with fewer and more modes: what leaving modes out costs."""
    grid = np.linspace(0.0, 120.0, 2401)

    def scene(modes: tuple[int, int]) -> tuple[FlexibleModel, Callable[[float], Trajectory]]:
        model = tower_model(load_case(CASE).tables(TowerCase), tower_modes=modes[0], jib_vertical_modes=modes[1])
        cut, start = _scene(model)

        def solve(rtol: float) -> Trajectory:
            return whole(integrate(model.system, cut, start, grid, rtol=rtol, atol=1e-2 * rtol))

        return model, solve

    def outputs(modes: tuple[int, int]) -> Floats:
        model, solve = scene(modes)
        return radial_outputs(model, solve(1e-8).states)

    most, second = (8, 12), (7, 10)
    reference = outputs(most)
    floor = differences(outputs(second), reference)
    models: dict[str, FlexibleModel] = {}
    contestants: dict[str, Callable[[], Trajectory]] = {}
    for modes in ((1, 1), (2, 2), (2, 3), (4, 4), (4, 6)):
        name = f"{modes[0]} tower + {modes[1]} jib modes"
        models[name], solve = scene(modes)
        contestants[name] = partial(solve, 1e-6)
    runs, timings = interleaved(contestants, min(repeats, 3))
    records, rows = [], []
    for name, run in runs.items():
        errors = differences(radial_outputs(models[name], run.states), reference)
        records.append({"model": name, "errors": errors, "cpu_seconds": timings[name].cpu})
        rows.append([name, *(short(e) for e in errors), f"{1e3 * timings[name].cpu:.1f}"])
    return {
        "name": "radial-modes",
        "title": "Modes left out: error of the same run at rtol 1e-6, relative to each output's peak",
        "columns": ["model", "tower top", "jib tip", "swing", "median CPU [ms]"],
        "rows": rows,
        "records": records,
        "notes": [
            f"reference: {most[0]} + {most[1]} modes; {second[0]} + {second[1]} differ from it by "
            + ", ".join(short(e) for e in floor)
        ],
    }


def _scene(model: FlexibleModel) -> tuple[Any, Floats]:
    case = load_case(CASE)
    motions = motions_of(case)
    cut = phases((motions["trolley"], motions["rope"]), case.run.duration)
    return cut, model.start(cut.inputs[0])
