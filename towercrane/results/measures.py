"""Outputs whose error can be asked for: their units, how large they get, and how far two runs are apart in them."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.results.recording import Result

    Floats = NDArray[np.float64]


PLACE = "payload_position"

DIGITS = 9
"""Of a time in seconds: looks at two runs that differ by less are at the same time."""


def peak(result: Result, name: str) -> float:
    """Largest magnitude of an output; of the load's place, its largest way from where it would hang at rest."""
    if name == PLACE:
        return float(np.linalg.norm(departures(result), axis=1).max())
    return float(abs(result[name].values).max())


def gap(one: Result, other: Result, name: str) -> float:
    """Largest difference of an output over the times that both runs have."""
    first, second = (np.round(run["time"].values, DIGITS) for run in (one, other))
    both, mine, others = np.intersect1d(first, second, return_indices=True)
    apart = one[name].values[mine] - other[name].values[others]
    return float(np.linalg.norm(apart.reshape(len(both), -1), axis=1).max())


def departures(result: Result) -> Floats:
    """Way of the load from where it would hang on a rigid crane at rest [m], shape (times, 3)."""
    if "commanded_place" in result:
        outward, _, up = result["commanded_place"].values.T
    else:
        outward, up = result["trolley_position"].values, -result["rope_length"].values
    heading = result["slewing_angle"].values if "slewing_angle" in result else np.zeros_like(outward)
    hung = np.stack([outward * np.cos(heading), outward * np.sin(heading), up], axis=1)
    return np.asarray(result["payload_position"].values - hung)


def picked_in(result: Result) -> dict[str, Any]:
    """Setting that was chosen for a run by the error asked for; empty where the case stated it."""
    return dict(json.loads(result.attrs["accuracy"])["setting"]) if "accuracy" in result.attrs else {}
