"""How well the chosen modes of a tower on collars carry a moment at its top down to its base."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from modal.beams.beam import Beam

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.cranes.tower.modes.parameters import TowerCrane

    Floats = NDArray[np.float64]

LOOKED_AT = 30
"""Modes that are looked at."""

CLOSE, LITTLE = 0.1, 1e-3
"""Error of the moment on the base that goes unsaid: over its own, or over that at the top where that is larger."""


def base_moments(crane: TowerCrane) -> Floats:
    """Moment on the base by so many modes under a unit moment at the tower's top, from one mode on; empty without
    collars; shape (`LOOKED_AT`,).

    What collars take is their stiffness times the motion in the modes, ``q = theta(top) / omega^2``.
    """
    tower = crane.tower
    if isinstance(tower, Beam) or not tower.collars:
        return np.zeros(0)
    modes = crane.tower_modes(LOOKED_AT)
    bent = modes.rotation(tower.length) / modes.angular_frequencies**2
    found = np.zeros(LOOKED_AT)
    for node, collar in tower.collars.items():
        height = tower.nodes[node]
        moved, turned = float(height) * modes(height), modes.rotation(height)
        found += bent * (collar.stiffness * moved + collar.rotation_stiffness * turned)
    return np.asarray(1.0 - np.cumsum(found))


def notice(crane: TowerCrane, count: int) -> str:
    """What so many modes leave of the forces on base and collars, in a sentence; empty where they are close."""
    moments = base_moments(crane)
    if not len(moments) or count >= LOOKED_AT:
        return ""
    limit = CLOSE * max(abs(float(moments[-1])), LITTLE)
    off = abs(moments - moments[-1])
    if count and off[count - 1] <= limit:
        return ""
    enough = int(np.flatnonzero(off > limit)[-1]) + 2
    found = float(moments[count - 1]) if count else 1.0
    return (
        f"collars: {count} tower modes bring {found:.2g} of a moment at the top down to the base where many bring "
        f"{moments[-1]:.2g}; forces on base and collars need model.tower_modes = {enough}"
    )
