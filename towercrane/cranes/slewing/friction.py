"""Where a lumped crane's equations change: corners of the coupling, and friction that sticks or slips."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from towercrane.cranes.parts.corner import Corner
from towercrane.cranes.slewing import kernel

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]


REST = 1e-12
"""Rate [rad/s] that counts as none: after a breakaway rounding decides the sign of the first, far smaller ones."""


@dataclass(frozen=True, slots=True)
class Transitions:
    """Restarts at corners and the states of set-valued friction.

    A corner only restarts the step control, see :class:`towercrane.cranes.parts.corner.Corner`. Friction sticks while
    less than its limit is needed to hold the coordinate, and slips against the motion otherwise.

    Parameters
    ----------
    driven : int
        Coordinate that drive and friction act on.
    rates : int
        Where the rates begin in the state.
    changes_equations : bool
        Whether friction is set-valued. Otherwise only the coupling's corner is watched.
    """

    driven: int
    rates: int
    changes_equations: bool

    def begin(self, state: Floats, numbers: Floats, floors: Floats, guards_at: Callable[[], Floats]) -> None:
        """Set corner and friction from the state."""
        if numbers[kernel.FRICTION_LAW] == kernel.STICK_SLIP:
            rate = state[self.rates + self.driven]
            if abs(rate) <= REST:
                state[self.rates + self.driven] = 0.0
                self._settle(numbers, floors, guards_at)
            else:
                self._slip(float(np.sign(rate)), numbers, floors)
        self._corner(numbers).begin(state, numbers, floors, guards_at)

    def cross(
        self, guard: int, state: Floats, numbers: Floats, floors: Floats, guards_at: Callable[[], Floats]
    ) -> bool:
        """Set what holds after a guard; a slack rope ends the run."""
        if self._corner(numbers).cross(guard, state, numbers, floors, guards_at):
            return True
        if guard == kernel.SLIDING:
            state[self.rates + self.driven] = 0.0
            self._settle(numbers, floors, guards_at)
        elif guard == kernel.HOLDING:
            self._settle(numbers, floors, guards_at)
        else:
            return False
        return True

    @staticmethod
    def _corner(numbers: Floats) -> Corner:
        return Corner(kernel.INSIDE, kernel.OUTSIDE, bool(numbers[kernel.SOFT] != numbers[kernel.STIFF]))

    def _settle(self, numbers: Floats, floors: Floats, guards_at: Callable[[], Floats]) -> None:
        """At rest: stick if friction can hold, else give way to the side that pushes."""
        numbers[kernel.FRICTION_STATE] = kernel.STICK
        guards = guards_at()
        floors[kernel.SLIDING], floors[kernel.HOLDING] = -np.inf, 0.0
        if guards[kernel.HOLDING] < 0.0:
            self._slip(-float(np.sign(guards[kernel.NEEDED])), numbers, floors)

    def _slip(self, direction: float, numbers: Floats, floors: Floats) -> None:
        numbers[kernel.FRICTION_STATE] = direction
        floors[kernel.SLIDING], floors[kernel.HOLDING] = -REST, -np.inf
