"""Natural frequencies and lengths that a report sets beside a tower crane's run."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from towercrane.cranes.kind import Natural
from towercrane.cranes.tower.equations.small_motions import natural_modes

if TYPE_CHECKING:
    from collections.abc import Mapping

    from towercrane.cranes.tower.model import FlexibleModel
    from towercrane.cranes.tower.planar import RadialModel

SWAYS = {"sway_radial": "radial sway", "sway_tangential": "lateral sway"}
"""Mode that each output of a run in space shows."""


def natural_in_plane(model: RadialModel, drives: Mapping[str, float]) -> Natural:
    """Natural frequencies in the plane with the drives somewhere, those that a cap slows as the crane has them.

    Raises
    ------
    NoEquilibrium
        If the tower buckles.
    """
    frequencies, swing = model.without_cap().natural_modes(drives["trolley"], drives["rope"])
    return Natural((frequencies / (2 * np.pi)).tolist(), [], {"swing_angle": swing})


def natural_in_space(model: FlexibleModel, drives: Mapping[str, float]) -> Natural:
    """Natural frequencies in space, as :func:`natural_in_plane`."""
    if model.axes == 2:
        # A load that only swings along the jib may swing across it.
        model = replace(model, crane=replace(model.crane, planes=2), slewing="prescribed", axes=3)
    angle = drives["shaft" if "shaft" in drives else "slewing"]
    modes = natural_modes(model, drives["trolley"], drives["rope"], angle)
    kinds = [mode.kind for mode in modes]
    swings = {signal: kinds.index(kind) for signal, kind in SWAYS.items() if kind in kinds}
    return Natural([mode.frequency_hz for mode in modes], kinds, swings)


def lengths_in_plane(model: RadialModel) -> dict[str, float]:
    """Length of the member that each deflection is of [m]."""
    crane = model.crane
    return {"tower_tip_displacement": crane.tower.length, "jib_tip_deflection": crane.jib.length}


def lengths_in_space(model: FlexibleModel) -> dict[str, float]:
    """Length of the member that each deflection is of [m]."""
    crane = model.crane
    found = {"tower_tip_displacement": crane.tower_height, "jib_tip_deflection": crane.jib_length}
    return found | {f"{name}_sideways": length for name, length in found.items()}
