"""Natural frequencies and lengths that a report sets beside a tower crane's run."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from towercrane.cranes.kind import Natural
from towercrane.cranes.parts.hoisting.letting_go import CHANNEL
from towercrane.cranes.tower.equations.small_motions import natural_modes, plane_modes, unloaded_frequencies

if TYPE_CHECKING:
    from collections.abc import Mapping

    from towercrane.cranes.tower.model import FlexibleModel

SWAYS = {"sway_radial": "radial sway", "sway_tangential": "lateral sway"}
"""Mode that each output of a run shows."""


def natural(model: FlexibleModel, drives: Mapping[str, float]) -> Natural:
    """Natural frequencies with the drives somewhere, those that a cap slows as the crane has them.

    Raises
    ------
    NoEquilibrium
        If the tower buckles.
    """
    model = model if np.isinf(model.cap) else replace(model, cap=np.inf)
    place, rope, turn = drives[model.channels[0]], drives["rope"], drives.get("shaft", drives.get("slewing", 0.0))
    gone = drives.get(CHANNEL, 0.0)
    if not model.load.now((gone, 0.0)).mass > 0.0:
        return Natural((unloaded_frequencies(model, place, rope, turn) / (2 * np.pi)).tolist(), [], {})
    if model.axes == 2:
        frequencies, swing = plane_modes(model, place, rope, gone)
        return Natural((frequencies / (2 * np.pi)).tolist(), [], {"sway_radial": swing})
    modes = natural_modes(model, place, rope, turn, gone)
    kinds = [mode.kind for mode in modes]
    swings = {signal: kinds.index(kind) for signal, kind in SWAYS.items() if kind in kinds}
    return Natural([mode.frequency_hz for mode in modes], kinds, swings)


def lengths(model: FlexibleModel) -> dict[str, float]:
    """Length of the member that each deflection is of [m]."""
    crane = model.crane
    found = {"tower_tip_displacement": crane.tower_height, "jib_tip_deflection": crane.jib_length}
    if crane.counter_bends and crane.written is not None:
        found["counter_jib_tip_deflection"] = crane.written.counter_jib_length
    found |= {f"{name}_sideways": length for name, length in found.items()} if model.axes == 3 else {}
    if crane.luffing is not None:
        found["jib_deflection"] = found.pop("jib_tip_deflection")
    return found
