"""Benchmark of the slewing cranes: one right-hand side, and Example 1 against the same model in SciPy."""

from __future__ import annotations

import dataclasses
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.bench.clock import differences, interleaved, short, whole
from towercrane.case import load_case
from towercrane.integrate import evaluate, integrate
from towercrane.models import slewing_builder
from towercrane.motion import phases

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from towercrane.integrate import Trajectory
    from towercrane.motion import Phases
    from towercrane.system import System

    Floats = NDArray[np.float64]

CASES = tuple(f"slewing/{kind}/example-1" for kind in ("multi-mass", "enhanced", "basic"))

SOLVERS = (("dop853", 1e-6), ("dop853", 1e-8), ("scipy-dop853", 1e-6), ("scipy-lsoda", 1e-6))

STEP = 0.01
"""Between two samples [s]."""


@dataclasses.dataclass(frozen=True, eq=False)
class Scene:
    """A case made ready to be solved many times."""

    system: System
    cut: Phases
    start: Floats
    grid: Floats
    rope: int

    def solve(self, method: str, rtol: float) -> Trajectory:
        """One run; nothing is watched for, on either side."""
        system = dataclasses.replace(self.system, floors=np.full(len(self.system.floors), -np.inf))
        return whole(integrate(system, self.cut, self.start, self.grid, method=method, rtol=rtol, atol=1e-2 * rtol))

    def direction(self, run: Trajectory) -> Floats:
        """Horizontal components of the rope's direction over time; shape (p, 2)."""
        return run.states[:, self.rope : self.rope + 2]


def _scene(name: str) -> Scene:
    case = load_case(name)
    model = slewing_builder(case)(case.lumped_parameters())
    cut = phases(tuple(case.motions[channel] for channel in model.channels), case.run.duration)
    grid = np.arange(0.0, case.run.duration, STEP)
    return Scene(model.system, cut, model.start(cut.inputs[0]), grid, model.rope)


def right_hand_sides(repeats: int) -> dict[str, Any]:
    """One evaluation of each slewing model's right-hand side."""
    count = 20_000
    scenes = {name: _scene(name) for name in CASES}
    contestants = {
        name: partial(evaluate, s.system, s.cut, np.full(count, 0.1), np.repeat(s.start[None], count, axis=0))
        for name, s in scenes.items()
    }
    _, _, cpu = interleaved(contestants, repeats)
    nanoseconds = {name: 1e9 * cpu[name] / count for name in CASES}
    return {
        "title": "Right-hand side of the slewing cranes",
        "columns": ["model", "states", "median [ns]"],
        "rows": [[name, str(scenes[name].system.size), f"{nanoseconds[name]:.0f}"] for name in CASES],
        "records": [{"model": name, "nanoseconds": nanoseconds[name]} for name in CASES],
        "notes": [f"{count} evaluations in one compiled loop"],
    }


def example_runs(repeats: int) -> dict[str, Any]:
    """Example 1 of each slewing model, sway against a reference solved far tighter."""
    scenes = {name: _scene(name) for name in CASES}
    references = {name: scene.direction(scene.solve("dop853", 1e-12)) for name, scene in scenes.items()}
    jobs = {f"{name}, {method} {rtol:.0e}": (name, method, rtol) for name in CASES for method, rtol in SOLVERS}
    contestants: dict[str, Callable[[], Trajectory]] = {
        label: partial(scenes[name].solve, method, rtol) for label, (name, method, rtol) in jobs.items()
    }
    runs, _, cpu = interleaved(contestants, min(repeats, 3))
    records, rows = [], []
    for label, run in runs.items():
        name = jobs[label][0]
        error = max(differences(scenes[name].direction(run), references[name]))
        records.append({"run": label, "error": error, "cpu_seconds": cpu[label], "evaluations": run.evaluations})
        rows.append([label, short(error), f"{1e3 * cpu[label]:.1f}", str(run.evaluations)])
    return {
        "title": "Example 1 of the slewing cranes: error of the rope's direction against CPU time",
        "columns": ["run", "error", "median CPU [ms]", "evaluations"],
        "rows": rows,
        "records": records,
        "notes": ["reference: dop853 at rtol 1e-12; every method runs the same compiled right-hand side"],
    }
