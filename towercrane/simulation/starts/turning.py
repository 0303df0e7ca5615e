"""What a turn of a whole scene about the vertical does to a state."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Turning:
    """Which states turn with a scene: it goes on alike when they and the drive of the turn have been turned.

    Parameters
    ----------
    vectors : iterable of pairs of int
        States that are the components of horizontal vectors along fixed axes, places and rates.
    angles : iterable of int
        States that are angles about the vertical.
    channel : int
        The motion that is such an angle.
    """

    vectors: Iterable[tuple[int, int]]
    angles: Iterable[int]
    channel: int

    def turned(self, state: Floats, angle: float) -> Floats:
        """The state after a turn by an angle [rad]."""
        found, c, s = np.array(state), np.cos(angle), np.sin(angle)
        for x, y in self.vectors:
            found[x], found[y] = c * state[x] - s * state[y], s * state[x] + c * state[y]
        found[list(self.angles)] += angle
        return found

    def per_angle(self, state: Floats) -> Floats:
        """Derivative of the same, per angle of turn."""
        found = np.zeros_like(state)
        for x, y in self.vectors:
            found[x], found[y] = -state[y], state[x]
        found[list(self.angles)] = 1.0
        return found
