"""Outputs whose error can be asked for: their units, how large they get, and how far two runs are apart in them."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.results.recording import Result

    Floats = NDArray[np.float64]

RADIAL = {"tower_tip_displacement": "m", "jib_tip_deflection": "m", "swing_angle": "rad", "rope_tension": "N"}
"""Outputs of a run in the plane, and their units."""

MOTIONS = {
    "payload_position": "m",
    "sway_radial": "rad",
    "sway_tangential": "rad",
    "tower_tip_displacement": "m",
    "tower_tip_displacement_sideways": "m",
    "tower_tip_twist": "rad",
    "jib_tip_deflection": "m",
    "jib_tip_deflection_sideways": "m",
}
"""Outputs of a run in space that are motions."""

SPACE = MOTIONS | {
    "rope_tension": "N",
    "trolley_force": "N",
    "slewing_torque": "N m",
    "jib_root_moment": "N m",
    "jib_root_moment_sideways": "N m",
    "base_moment_x": "N m",
    "base_moment_y": "N m",
    "base_torque": "N m",
}
"""Outputs of a run in space."""

PLACE = "payload_position"

DIGITS = 9
"""Of a time in seconds: looks at two runs that differ by less are at the same time."""


class Tolerance(NamedTuple):
    """Error that is wanted of an output: over its peak, or in its unit."""

    value: float
    relative: bool


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
    trolley, rope = result["trolley_position"].values, result["rope_length"].values
    heading = result["slewing_angle"].values if "slewing_angle" in result else np.zeros_like(trolley)
    hung = np.stack([trolley * np.cos(heading), trolley * np.sin(heading), -rope], axis=1)
    return np.asarray(result["payload_position"].values - hung)


def picked_in(result: Result) -> dict[str, Any]:
    """Setting that was chosen for a run by the error asked for; empty where the case stated it."""
    return dict(json.loads(result.attrs["accuracy"])["setting"]) if "accuracy" in result.attrs else {}
