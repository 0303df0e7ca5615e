"""The constants of collars that leave a tower some play."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.cranes.tower.equations.coordinates import Coordinates

    Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Play:
    """What the equations know of c collars with play.

    Parameters
    ----------
    numbers : tuple of c int
        Their places among all collars.
    stiffness, gaps : ndarray, shape (c,)
        [N/m], [m]
    bends : ndarray, shape (c, tower modes)
        Deflection of the tower at their heights.
    """

    numbers: tuple[int, ...]
    stiffness: Floats
    gaps: Floats
    bends: Floats


def play_of(model: Coordinates) -> Play | None:
    """Collars with play of a crane; None where it has none."""
    found = [(k, collar) for k, collar in enumerate(model.crane.collars) if collar.gap]
    if not found:
        return None
    return Play(
        numbers=tuple(k for k, _ in found),
        stiffness=np.array([collar.stiffness for _, collar in found]),
        gaps=np.array([collar.gap for _, collar in found]),
        bends=model.crane.tower([collar.height for _, collar in found]).T,
    )


def contact_stiffness(model: Coordinates) -> Floats:
    """Stiffness of all collars with play where the tower presses on them; shape (n, n)."""
    found = np.zeros((model.coordinates, model.coordinates))
    for collar in model.crane.collars:
        bend = model.crane.tower(collar.height)
        for plane in ("tower_x", "tower_y"):
            if collar.gap and model.counts[plane]:
                found[model.parts[plane], model.parts[plane]] += collar.stiffness * np.outer(bend, bend)
    return found
