"""Natural frequencies and lengths that a report sets beside a tower crane's run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cranes.kind import Natural
from towercrane.cranes.tower.equations.small_motions import natural_modes
from towercrane.cranes.tower.file.build import radial_crane, radial_model, space_crane, space_model
from towercrane.cranes.tower.space import KINDS

if TYPE_CHECKING:
    from collections.abc import Mapping

    from towercrane.cranes.tower.file.case_tables import RadialCase, SpaceCase

SWAYS = {"sway_radial": "radial sway", "sway_tangential": "lateral sway"}
"""Mode that each output of a run in space shows."""


def natural_in_plane(tables: RadialCase, drives: Mapping[str, float], picked: Mapping[str, Any]) -> Natural:
    """Natural frequencies in the plane with the drives somewhere, of the model that was picked for a run.

    Raises
    ------
    NoEquilibrium
        If the tower buckles.
    """
    chosen = {key: picked[key] for key in ("tower_modes", "jib_modes", "weight_softening") if key in picked}
    frequencies, swing = radial_model(tables, **chosen).natural_modes(drives["trolley"], drives["rope"])
    return Natural((frequencies / (2 * np.pi)).tolist(), [], {"swing_angle": swing})


def natural_in_space(tables: SpaceCase, drives: Mapping[str, float], picked: Mapping[str, Any]) -> Natural:
    """Natural frequencies in space, as :func:`natural_in_plane`."""
    # A load that only swings along the jib may swing across it.
    model = space_model(tables, **{key: picked[key] for key in (*KINDS, "weight_softening") if key in picked})
    angle = drives["shaft" if "shaft" in drives else "slewing"]
    modes = natural_modes(model, drives["trolley"], drives["rope"], angle)
    kinds = [mode.kind for mode in modes]
    swings = {signal: kinds.index(kind) for signal, kind in SWAYS.items() if kind in kinds}
    return Natural([mode.frequency_hz for mode in modes], kinds, swings)


def lengths_in_plane(tables: RadialCase) -> dict[str, float]:
    """Length of the member that each deflection is of [m]."""
    crane = radial_crane(tables)
    return {"tower_tip_displacement": crane.tower.length, "jib_tip_deflection": crane.jib.length}


def lengths_in_space(tables: SpaceCase) -> dict[str, float]:
    """Length of the member that each deflection is of [m]."""
    crane = space_crane(tables.crane)
    found = {"tower_tip_displacement": crane.tower.length, "jib_tip_deflection": crane.jib.length}
    return found | {f"{name}_sideways": length for name, length in found.items()}
