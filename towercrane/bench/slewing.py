"""Benchmark of the slewing cranes' right-hand sides."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from towercrane.bench.clock import interleaved
from towercrane.bench.scenes import lumped_scene
from towercrane.integrate import evaluate
from towercrane.models import SLEWING


def right_hand_sides(repeats: int) -> dict[str, Any]:
    """One evaluation of each slewing model's right-hand side."""
    count = 20_000
    scenes = {kind: lumped_scene(kind) for kind in SLEWING}
    contestants = {
        kind: partial(evaluate, s.system, s.cut, np.full(count, 0.1), np.repeat(s.start[None], count, axis=0))
        for kind, s in scenes.items()
    }
    _, timings = interleaved(contestants, repeats)
    nanoseconds = {kind: 1e9 * timings[kind].cpu / count for kind in SLEWING}
    return {
        "name": "slewing-rhs",
        "title": "Right-hand side of the slewing cranes",
        "columns": ["model", "states", "median [ns]"],
        "rows": [[kind, str(scenes[kind].system.size), f"{nanoseconds[kind]:.0f}"] for kind in SLEWING],
        "records": [{"model": kind, "nanoseconds": nanoseconds[kind]} for kind in SLEWING],
        "notes": [f"{count} evaluations in one compiled loop"],
    }
