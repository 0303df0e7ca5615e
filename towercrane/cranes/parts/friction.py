"""Set-valued friction on one coordinate: it slips against the motion, or sticks and holds whatever is needed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.kernels.choices import below, choose

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from towercrane.cranes.parts.corner import Corners
    from towercrane.kernels.payload import Hung, Structure

    Floats = NDArray[np.float64]

SLIP_BACK, STICK, SLIP_AHEAD, BY_RATE = -1.0, 0.0, 1.0, 2.0
"""States of set-valued friction; BY_RATE reads it off the rate, which is exactly zero while it sticks."""

REST = 1e-12
"""Rate [rad/s] that counts as none: after a breakaway rounding decides the sign of the first, far smaller ones."""


def slip(state: Any, rate: Any) -> tuple[Any, Any]:
    """Direction of slip, zero while it sticks, and whether it does, of a state of friction and a rate."""
    way = choose(below(SLIP_AHEAD, state), np.sign(rate), state)
    return way, below(abs(way), SLIP_AHEAD)


def holding(crane: Structure, i: int, hung: Hung, sticks: Any, sliding: Any, limit: Any) -> tuple[Any, Any, Any]:
    """Guards of friction on coordinate i: rate in the direction of slip [rad/s]; torque that friction can still take,
    and the torque that holds the coordinate at rest [N m].

    Parameters
    ----------
    crane : Structure
        Without what holds it.
    hung : Hung
        With it.
    sticks, sliding, limit
        Whether it sticks, the rate, and the largest torque.
    """
    needed = needed_at_rest(crane, i, hung)
    return sliding, choose(sticks, limit - abs(needed), np.inf), choose(sticks, needed, 0.0)


def held(crane: Structure, i: int, sticks: Any) -> Structure:
    """A crane whose coordinate i is at rest where it sticks: its row is taken out of the equations."""

    def out(value: Any, instead: float = 0.0) -> Any:
        return choose(sticks, instead, value)

    return crane._replace(
        mass=[
            [out(own, float(j == k)) if i in (j, k) else own for k, own in enumerate(row)]
            for j, row in enumerate(crane.mass)
        ],
        force=[out(own) if j == i else own for j, own in enumerate(crane.force)],
        jacobian=[[out(own) if j == i else own for j, own in enumerate(row)] for row in crane.jacobian],
    )


def needed_at_rest(crane: Structure, i: int, hung: Hung) -> Any:
    """Torque on coordinate i without which the crane would not accelerate as it does."""
    needed = -crane.force[i]
    for j, acceleration in enumerate(hung.accelerations):
        needed = needed + crane.mass[max(i, j)][min(i, j)] * acceleration
    for axis, row in enumerate(crane.jacobian):
        needed = needed - row[i] * hung.pull(axis)
    return needed


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
        Of forces.
    guards : tuple of 3 int
        Guards that :func:`towercrane.cranes.parts.friction.holding` gives.
    changes_equations : bool
        Whether friction is set-valued. Otherwise only the coupling's corner is watched.
    """

    rate: int
    friction_state: int
    corner: Corners | None
    guards: tuple[int, int, int]
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
        sliding, holding, _ = self.guards
        if guard not in (sliding, holding):
            return False
        if guard == sliding:
            state[self.rate] = 0.0
        self._settle(numbers, floors, guards_at)
        return True

    def _settle(self, numbers: Floats, floors: Floats, guards_at: Callable[[], Floats]) -> None:
        """At rest: stick if friction can hold, else give way to the side that pushes."""
        numbers[self.friction_state] = STICK
        sliding, holding, needed = self.guards
        found = guards_at()
        floors[sliding], floors[holding] = -np.inf, 0.0
        if found[holding] < 0.0:
            self._slip(-float(np.sign(found[needed])), numbers, floors)

    def _slip(self, direction: float, numbers: Floats, floors: Floats) -> None:
        numbers[self.friction_state] = direction
        sliding, holding, _ = self.guards
        floors[sliding], floors[holding] = -REST, -np.inf
