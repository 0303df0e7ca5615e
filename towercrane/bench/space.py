"""Benchmark of the crane in space: its right-hand side with more and more modes."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.bench.clock import interleaved
from towercrane.bench.scenes import SPACE
from towercrane.case import load_case
from towercrane.cranes.flexible import FlexibleModel
from towercrane.cranes.flexible_crane import ModeCounts, flexible_crane
from towercrane.integrate import evaluate
from towercrane.motion import phases

if TYPE_CHECKING:
    from collections.abc import Callable

EVALUATIONS = 20_000
"""Right-hand sides in one measurement."""

AT = 6.0
"""Time at which they are taken [s]: slewing drive and trolley at speed, the hoist accelerates."""

MODELS = (
    ("0+0+0 / 0+0", ModeCounts(0, 0, 0, 0), 2),
    ("2+0+0 / 0+3, not slewing", ModeCounts(2, 0, 0, 3), 1),
    ("1+1+1 / 1+1", ModeCounts(1, 1, 1, 1), 2),
    ("2+2+1 / 3+3", ModeCounts(2, 1, 3, 3), 2),
)
"""Name, modes, and planes in which the tower bends; a tower that bends in one carries a jib that does not slew."""


def space_right_hand_sides(repeats: int) -> dict[str, Any]:
    """One evaluation of the right-hand side in space."""
    case = load_case(SPACE)
    motions = case.motions
    contestants: dict[str, Callable[[], Any]] = {}
    sizes: dict[str, int] = {}
    for name, counts, planes in MODELS:
        crane = flexible_crane(case.space_crane(), counts, planes=planes)
        model = FlexibleModel(crane, case.load(), slewing="prescribed" if planes == 2 else "fixed")
        cut = phases(tuple(motions[channel] for channel in model.channels), case.run.duration)
        states = np.repeat(model.start(cut.inputs[0])[None], EVALUATIONS, axis=0)
        contestants[name] = partial(evaluate, model.system, cut, np.full(EVALUATIONS, AT), states)
        sizes[name] = model.size
    _, timings = interleaved(contestants, repeats)
    records = [
        {"model": name, "states": size, "nanoseconds": 1e9 * timings[name].cpu / EVALUATIONS}
        for name, size in sizes.items()
    ]
    return {
        "name": "space-rhs",
        "title": "Right-hand side of the crane in space",
        "columns": ["modes: tower x+y+torsion / jib lateral+vertical", "states", "median [ns]"],
        "rows": [[r["model"], str(r["states"]), f"{r['nanoseconds']:.0f}"] for r in records],
        "records": records,
        "notes": [f"{EVALUATIONS} evaluations in one compiled loop; exact to rounding, see the equations' tests"],
    }
