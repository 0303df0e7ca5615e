"""A rope that stretches goes slack and is caught: a switch of its crane's equations."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from towercrane.kernels.elastic_rope import SLACK_MODE, TAUT
from towercrane.simulation.outcomes import ROPE_CAUGHT, ROPE_SLACK

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from towercrane.simulation.system import Switch

    Floats = NDArray[np.float64]

GUARDS = (ROPE_SLACK, ROPE_CAUGHT, "rope energy")
"""Guards of an elastic rope, behind all others: strains to where it slackens and to where it is caught, and its
energy [J], which is only recorded."""

SLACKENS, CATCHES, STORED = -3, -2, -1
"""Their places."""


@dataclass(frozen=True, slots=True)
class Slackening:
    """A rope that goes slack and is caught, beside whatever else of a crane switches.

    A rope that slackens while it retracts leaves some strain to its own damping: what that stores is lost, and is
    there again if the rope is caught before it is gone.

    Parameters
    ----------
    mode : int
        Where the numbers have the rope's mode.
    other : Switch or None
        Of the crane.
    """

    mode: int
    other: Switch | None

    @property
    def changes_equations(self) -> bool:
        """Always."""
        return True

    def begin(self, state: Floats, numbers: Floats, floors: Floats, guards_at: Callable[[], Floats]) -> None:
        """Set the rope's mode from the state, then the others."""
        taut = float(guards_at()[SLACKENS]) > 0.0
        if numbers[self.mode] in (SLACK_MODE, TAUT) and taut != (numbers[self.mode] == TAUT):
            # The winch's speed has jumped.
            self._turn(taut, state, numbers, floors, guards_at)
        self._set(taut, numbers, floors)
        if self.other is not None:
            self.other.begin(state, numbers, floors, guards_at)

    def cross(
        self, guard: int, state: Floats, numbers: Floats, floors: Floats, guards_at: Callable[[], Floats]
    ) -> bool:
        """Set what holds after a guard."""
        if guard - len(floors) in (SLACKENS, CATCHES):
            self._turn(guard - len(floors) == CATCHES, state, numbers, floors, guards_at)
            return True
        return self.other is not None and self.other.cross(guard, state, numbers, floors, guards_at)

    def _turn(
        self, taut: bool, state: Floats, numbers: Floats, floors: Floats, guards_at: Callable[[], Floats]
    ) -> None:
        self._set(True, numbers, floors)
        state[-1] += guards_at()[STORED] * (1.0 if taut else -1.0)
        self._set(taut, numbers, floors)

    def _set(self, taut: bool, numbers: Floats, floors: Floats) -> None:
        numbers[self.mode] = TAUT if taut else SLACK_MODE
        floors[SLACKENS], floors[CATCHES] = (0.0, -np.inf) if taut else (-np.inf, 0.0)
