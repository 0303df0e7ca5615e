"""Where a lumped crane's equations change: corners of the coupling, and friction that sticks or slips."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from towercrane.cranes.slewing.equations import HOLDING, NEEDED, SLIDING, STICK

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from towercrane.cranes.parts.corner import Corners

    Floats = NDArray[np.float64]


REST = 1e-12
"""Rate [rad/s] that counts as none: after a breakaway rounding decides the sign of the first, far smaller ones."""


@dataclass(frozen=True, slots=True)
class Transitions:
    """Restarts at corners and the states of set-valued friction.

    A corner only restarts the step control, see :class:`towercrane.cranes.parts.corner.Corners`. Friction sticks
    while less than its limit is needed to hold the coordinate, and slips against the motion otherwise.

    Parameters
    ----------
    rate : int
        Where the state has the rate of the coordinate that drive and friction act on.
    friction_state : int
        Where the numbers have the state of friction.
    corner : Corners or None
        Of a coupling whose two lines differ.
    changes_equations : bool
        Whether friction is set-valued. Otherwise only the coupling's corner is watched.
    """

    rate: int
    friction_state: int
    corner: Corners | None
    changes_equations: bool

    def begin(self, state: Floats, numbers: Floats, floors: Floats, guards_at: Callable[[], Floats]) -> None:
        """Set corner and friction from the state."""
        if self.changes_equations:
            rate = state[self.rate]
            if abs(rate) <= REST:
                state[self.rate] = 0.0
                self._settle(numbers, floors, guards_at)
            else:
                self._slip(float(np.sign(rate)), numbers, floors)
        if self.corner is not None:
            self.corner.begin(state, numbers, floors, guards_at)

    def cross(
        self, guard: int, state: Floats, numbers: Floats, floors: Floats, guards_at: Callable[[], Floats]
    ) -> bool:
        """Set what holds after a guard; a slack rope ends the run."""
        if self.corner is not None and self.corner.cross(guard, state, numbers, floors, guards_at):
            return True
        if guard not in (SLIDING, HOLDING):
            return False
        if guard == SLIDING:
            state[self.rate] = 0.0
        self._settle(numbers, floors, guards_at)
        return True

    def _settle(self, numbers: Floats, floors: Floats, guards_at: Callable[[], Floats]) -> None:
        """At rest: stick if friction can hold, else give way to the side that pushes."""
        numbers[self.friction_state] = STICK
        guards = guards_at()
        floors[SLIDING], floors[HOLDING] = -np.inf, 0.0
        if guards[HOLDING] < 0.0:
            self._slip(-float(np.sign(guards[NEEDED])), numbers, floors)

    def _slip(self, direction: float, numbers: Floats, floors: Floats) -> None:
        numbers[self.friction_state] = direction
        floors[SLIDING], floors[HOLDING] = -REST, -np.inf
