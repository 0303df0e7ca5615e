"""Benchmark of the exact structures: cost and error by the number of a tower's segments, all different."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from modal import Chain, EndBody, Segment, chain_frequencies, chain_structure
from modal.structures.structure_modes import structure_modes
from towercrane.bench.clock import interleaved, short
from towercrane.bench.structures.structure import transfer_matrices

if TYPE_CHECKING:
    from collections.abc import Callable

NUMBERS = 5, 20, 80
MODES = 4


def tower_of(number: int) -> Chain:
    """A tower of 80 m, lighter and softer upward by a third, no two of its segments alike, with a body on its top."""
    segments = []
    for i in range(number):
        size = 1.0 - i / (3.0 * number) + 0.02 * np.sin(7.0 * i)
        segments.append(Segment(80.0 / number, 800.0 * size, 8e9 * size, 3e8 * size, 700.0 * size))
    return Chain(tuple(segments), {number: EndBody(3e4, 2e6, 1.5)})


def segments(repeats: int, numbers: tuple[int, ...] = NUMBERS) -> dict[str, Any]:
    """Four frequencies of a tower, and its modes, by the number of its segments."""
    towers = {number: tower_of(number) for number in numbers}
    contestants: dict[str, Callable[[], Any]] = {}
    for number, tower in towers.items():
        contestants[f"{number} frequencies"] = partial(chain_frequencies, tower, MODES)
        contestants[f"{number} modes"] = partial(structure_modes, chain_structure(tower), MODES)
    values, timings = interleaved(contestants, repeats)
    records: list[dict[str, Any]] = []
    notes: list[str] = []
    for number, tower in towers.items():
        found = values[f"{number} frequencies"]
        reference, note = transfer_matrices(tower, found)
        milliseconds = {what: 1e3 * timings[f"{number} {what}"].wall for what in ("frequencies", "modes")}
        error = None if reference is None else float(np.max(abs(found / reference - 1.0)))
        records.append({"segments": number, "error": error, "milliseconds": milliseconds})
        notes = [note]
    return {
        "name": "segments",
        "title": "Four frequencies of a tower by the number of its segments: relative error of the worst",
        "columns": ["segments", "error", "frequencies [ms]", "modes [ms]"],
        "rows": [
            [str(r["segments"]), short(r["error"]), *[f"{value:.2f}" for value in r["milliseconds"].values()]]
            for r in records
        ],
        "records": records,
        "notes": notes,
    }
