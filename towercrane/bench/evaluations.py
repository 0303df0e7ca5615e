"""Benchmark of right-hand sides: one evaluation of each of several models."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from towercrane.bench.clock import interleaved
from towercrane.simulation.integrate import evaluate

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from towercrane.motions.motion import Phases
    from towercrane.simulation.system import System

COUNT = 20_000
"""Evaluations in one compiled loop."""


class Instant(NamedTuple):
    """A model at a state and a time [s] of its motions."""

    system: System
    cut: Phases
    state: NDArray[np.float64]
    time: float


def evaluations(name: str, title: str, models: Mapping[str, Instant], repeats: int) -> dict[str, Any]:
    """Time of one evaluation of each model's right-hand side, as a subject of the benchmark."""
    contestants = {
        model: partial(evaluate, at.system, at.cut, np.full(COUNT, at.time), np.repeat(at.state[None], COUNT, axis=0))
        for model, at in models.items()
    }
    _, timings = interleaved(contestants, repeats)
    nanoseconds = {model: 1e9 * timings[model].cpu / COUNT for model in models}
    first = next(iter(nanoseconds.values()))
    records: list[dict[str, Any]] = [
        {
            "model": model,
            "states": at.system.size,
            "nanoseconds": nanoseconds[model],
            "ratio": nanoseconds[model] / first,
        }
        for model, at in models.items()
    ]
    return {
        "name": name,
        "title": title,
        "columns": ["model", "states", "median [ns]", "of the first"],
        "rows": [[r["model"], str(r["states"]), f"{r['nanoseconds']:.0f}", f"{r['ratio']:.2f}"] for r in records],
        "records": records,
        "notes": [f"{COUNT} evaluations in one compiled loop; exact to rounding, see the equations' tests"],
    }
