"""How much of the mass that an earthquake shakes the chosen modes of the tower carry."""

from __future__ import annotations

from dataclasses import dataclass
from math import isinf
from typing import TYPE_CHECKING

import numpy as np

from modal.beams.beam import Beam

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.cranes.tower.modes.parameters import TowerCrane

    Floats = NDArray[np.float64]

ENOUGH = 0.9
"""Share that codes ask for."""

LOOKED_AT = 30
"""Modes that are looked at for it."""

NAMED = 3
"""Missing modes that are named at most."""


@dataclass(frozen=True, eq=False)
class EffectiveMass:
    """Shares of the modes of a tower, with what turns on its end, in the mass that moves sideways.

    Parameters
    ----------
    shares : ndarray, shape (n,)
        ``(int m phi + m_r phi(top))^2`` of each mode of unit modal mass over that mass [1].
    frequencies : ndarray, shape (n,)
        [Hz]
    """

    shares: Floats
    frequencies: Floats

    def carried(self, count: int) -> float:
        """Share of the first modes together [1]."""
        return float(self.shares[:count].sum())

    def enough(self) -> int | None:
        """How many modes carry `ENOUGH`; None if all that were looked at do not."""
        reached = np.flatnonzero(np.cumsum(self.shares) >= ENOUGH)
        return int(reached[0]) + 1 if len(reached) else None

    def notice(self, count: int) -> str:
        """What so many modes leave out, in a sentence; empty where they carry enough."""
        if self.carried(count) >= ENOUGH:
            return ""
        enough, left = self.enough(), self.shares[count:]
        most = [count + int(k) for k in np.argsort(-left)[:NAMED] if left[k] > 0.01]
        missing = ", ".join(f"mode {k + 1} ({self.frequencies[k]:.3g} Hz) {self.shares[k]:.0%}" for k in most)
        asked = f"{enough} would carry {self.carried(enough):.0%}" if enough else f"{LOOKED_AT} would not do either"
        return (
            f"earthquake: {count} tower modes carry {self.carried(count):.0%} of the mass that it shakes, "
            f"{ENOUGH:.0%} are usual; {asked}; missing most: {missing}; forces on base and collars lack their part"
        )


def effective_mass(crane: TowerCrane) -> EffectiveMass:
    """Shares of the modes of a crane's tower; a block on a foot that is held does not count."""
    modes = crane.tower_modes(LOOKED_AT)
    tower, body = crane.tower, crane.end_body
    total = crane.tower_mass + body.mass
    if not isinstance(tower, Beam) and isinf(tower.foundation.translation_stiffness) and 0 in tower.bodies:
        total -= tower.bodies[0].mass
    moved = modes.mass_moments()[0] + body.mass * (modes(tower.length) + body.offset * modes.rotation(tower.length))
    return EffectiveMass(moved**2 / total, modes.frequencies_hz)
