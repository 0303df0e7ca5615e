"""Benchmark of the radial crane: right-hand side, solvers, modes left out."""

from __future__ import annotations

import dataclasses
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.bench.clock import difference, differences, interleaved, short, whole
from towercrane.case import load_case
from towercrane.integrate import evaluate, integrate
from towercrane.models import radial_model
from towercrane.motion import phases

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from towercrane.cranes.radial import RadialModel
    from towercrane.integrate import Trajectory

    Floats = NDArray[np.float64]

CASE = "qtz5613/condition-3"

CONTESTANTS: tuple[tuple[str, float, bool], ...] = (
    ("dop853", 1e-3, True),
    ("dop853", 1e-4, True),
    ("dop853", 1e-6, True),
    ("dop853", 1e-8, True),
    ("dop853", 1e-10, True),
    ("dopri5", 1e-4, True),
    ("dopri5", 1e-6, True),
    ("scipy-dop853", 1e-4, True),
    ("scipy-dop853", 1e-6, True),
    ("scipy-dop853", 1e-6, False),
    ("scipy-lsoda", 1e-6, True),
    ("scipy-lsoda", 1e-8, False),
)
"""Method, rtol, whether it restarts at the switch points of the motion."""


def right_hand_side(repeats: int) -> dict[str, Any]:
    """One evaluation of the radial right-hand side."""
    count = 20_000
    contestants: dict[str, Callable[[], Any]] = {}
    models: dict[str, int] = {}
    for modes in ((0, 0), (2, 2), (2, 3), (4, 4)):
        model = radial_model(load_case(CASE), tower_modes=modes[0], jib_modes=modes[1])
        cut, start = _scene(model)
        times, states = np.full(count, 10.0), np.repeat(start[None], count, axis=0)
        name = f"{modes[0]} tower + {modes[1]} jib modes"
        models[name] = model.size
        contestants[name] = partial(evaluate, model.system, cut, times, states)
    _, _, cpu = interleaved(contestants, repeats)
    records = [
        {"model": name, "states": size, "nanoseconds": 1e9 * cpu[name] / count} for name, size in models.items()
    ]
    return {
        "title": "Right-hand side of the radial crane",
        "columns": ["model", "states", "median [ns]"],
        "rows": [[r["model"], str(r["states"]), f"{r['nanoseconds']:.0f}"] for r in records],
        "records": records,
        "notes": [f"{count} evaluations in one compiled loop; exact to rounding, see the equations' tests"],
    }


def radial_run(repeats: int) -> dict[str, Any]:
    """120 s of condition 3, 2 tower and 3 jib modes, from equilibrium."""
    model = radial_model(load_case(CASE), tower_modes=2, jib_modes=3)
    cut, start = _scene(model)
    # SciPy would evaluate every watched guard at every step; nothing is watched here, for either side.
    system = dataclasses.replace(model.system, floors=np.full(len(model.system.floors), -np.inf))
    grid = np.linspace(0.0, 120.0, 2401)

    def solve(method: str, rtol: float, split: bool) -> Trajectory:
        return whole(integrate(system, cut, start, grid, method=method, rtol=rtol, atol=1e-2 * rtol, split=split))

    reference = _outputs(model, solve("dop853", 1e-12, True))
    second = _outputs(model, solve("scipy-lsoda", 1e-12, True))
    contestants = {
        _name(method, rtol, split): partial(solve, method, rtol, split) for method, rtol, split in CONTESTANTS
    }
    values, _, cpu = interleaved(contestants, repeats)
    records = [
        {
            "method": name,
            "error": difference(_outputs(model, run), reference),
            "cpu_seconds": cpu[name],
            "evaluations": run.evaluations,
        }
        for name, run in values.items()
    ]
    ours = min((r for r in records if r["error"] <= 1e-6), key=lambda r: r["cpu_seconds"])
    return {
        "title": "120 s of condition 3 (2+3 modes, from equilibrium): error of the worst output against CPU time",
        "columns": ["method", "error", "median CPU [ms]", "evaluations"],
        "rows": [
            [r["method"], short(r["error"]), f"{1e3 * r['cpu_seconds']:.1f}", str(r["evaluations"])] for r in records
        ],
        "records": records,
        "notes": [
            "error: largest difference over largest value, worst of tower top, jib tip and swing, 2401 samples",
            f"reference: dop853 at rtol 1e-12, which LSODA at 1e-12 meets within {difference(second, reference):.0e}",
            "every method runs the same compiled right-hand side; 'split' restarts at the motion's switch points",
            f"cheapest within 1e-6: {ours['method']}, {1e3 * ours['cpu_seconds']:.1f} ms",
            "solver error only: the modes left out cost more, see the next table",
        ],
    }


def modes_left_out(repeats: int) -> dict[str, Any]:
    """The same run with fewer and more modes: what leaving modes out costs."""
    grid = np.linspace(0.0, 120.0, 2401)

    def scene(modes: tuple[int, int]) -> tuple[RadialModel, Callable[[float], Trajectory]]:
        model = radial_model(load_case(CASE), tower_modes=modes[0], jib_modes=modes[1])
        cut, start = _scene(model)

        def solve(rtol: float) -> Trajectory:
            return whole(integrate(model.system, cut, start, grid, rtol=rtol, atol=1e-2 * rtol))

        return model, solve

    def outputs(modes: tuple[int, int]) -> Floats:
        model, solve = scene(modes)
        return _outputs(model, solve(1e-8))

    most, second = (8, 12), (7, 10)
    reference = outputs(most)
    floor = differences(outputs(second), reference)
    models: dict[str, RadialModel] = {}
    contestants: dict[str, Callable[[], Trajectory]] = {}
    for modes in ((1, 1), (2, 2), (2, 3), (4, 4), (4, 6)):
        name = f"{modes[0]} tower + {modes[1]} jib modes"
        models[name], solve = scene(modes)
        contestants[name] = partial(solve, 1e-6)
    runs, _, cpu = interleaved(contestants, min(repeats, 3))
    records, rows = [], []
    for name, run in runs.items():
        errors = differences(_outputs(models[name], run), reference)
        records.append({"model": name, "errors": errors, "cpu_seconds": cpu[name]})
        rows.append([name, *(short(e) for e in errors), f"{1e3 * cpu[name]:.1f}"])
    return {
        "title": "Modes left out: error of the same run at rtol 1e-6, relative to each output's peak",
        "columns": ["model", "tower top", "jib tip", "swing", "median CPU [ms]"],
        "rows": rows,
        "records": records,
        "notes": [
            f"reference: {most[0]} + {most[1]} modes; {second[0]} + {second[1]} differ from it by "
            + ", ".join(short(e) for e in floor)
        ],
    }


def _scene(model: RadialModel) -> tuple[Any, Floats]:
    case = load_case(CASE)
    cut = phases((case.trolley_motion(), case.rope_motion()), case.run.duration)
    return cut, model.start(cut.inputs[0])


def _outputs(model: RadialModel, run: Trajectory) -> Floats:
    """Tower top, jib tip and swing over time; shape (p, 3)."""
    n, tower = model.coordinates, model.tower_modes
    q = run.states[:, :n]
    top = q[:, :tower] @ model.tower(model.crane.tower.length)
    tip = q[:, tower:] @ model.jib(model.crane.jib.length)
    return np.stack([top, tip, np.arctan2(run.states[:, n], -run.states[:, n + 1])], axis=1)


def _name(method: str, rtol: float, split: bool) -> str:
    return f"{method} {rtol:.0e}" + (" split" if split else "")
