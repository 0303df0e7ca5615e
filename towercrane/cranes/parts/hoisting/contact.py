"""A load that lands on the ground, stands there, slides or sticks, and is lifted off."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from towercrane.cranes.parts.hoisting.slackening import STORED
from towercrane.kernels.ground import AIR, STANDS, STICKS
from towercrane.simulation.outcomes import LANDS, LIFTS_OFF

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from towercrane.cranes.parts.hoisting.slackening import Slackening
    from towercrane.kernels.load import Load

    Floats = NDArray[np.float64]

GUARDS = (LANDS, LIFTS_OFF, "load stops", "load slips", "push", "ground force")
"""Guards of ground, before those of the rope: see :class:`towercrane.kernels.ground.Standing`."""

GAP, PRESS, SLIDING, LEFT, PUSHED, REACTION = range(-9, -3)
"""Their places."""

SUNK = -1e-12
"""Height at which a load has landed [m]: rounding decides the sign of that of one that has just been lifted off."""

REST = 1e-12
"""Speed that is none [m/s]."""


@dataclass(frozen=True, slots=True)
class Contact:
    """Landing and lift-off, sticking and sliding, beside what the rope does.

    Parameters
    ----------
    rope : Slackening
    load : Load
    gravity : float
        [m/s^2]
    contact, sliding : int
        Where the numbers have what holds.
    place, rate : slice
        Where the state has the load's place, and its velocity.
    """

    rope: Slackening
    load: Load
    gravity: float
    contact: int
    sliding: int
    place: slice
    rate: slice

    @property
    def changes_equations(self) -> bool:
        """Always."""
        return True

    def begin(self, state: Floats, numbers: Floats, floors: Floats, guards_at: Callable[[], Floats]) -> None:
        """Set what holds from the state."""
        self.rope.begin(state, numbers, floors, guards_at)
        gap, rising = float(guards_at()[GAP]), float(state[self.rate][-1])
        if gap <= 0.0 and rising <= 0.0:
            self._land(state, numbers, floors, guards_at)
        else:
            self._fly(numbers, floors)

    def cross(
        self, guard: int, state: Floats, numbers: Floats, floors: Floats, guards_at: Callable[[], Floats]
    ) -> bool:
        """Set what holds after a guard."""
        met = guard - len(floors)
        if met == GAP:
            self._land(state, numbers, floors, guards_at)
        elif met == PRESS:
            self._fly(numbers, floors)
        elif met in (SLIDING, LEFT):
            if met == SLIDING:
                state[self.rate][0] = 0.0
            self._rub(state, numbers, floors, guards_at)
        else:
            return self.rope.cross(guard, state, numbers, floors, guards_at)
        return True

    def _land(self, state: Floats, numbers: Floats, floors: Floats, guards_at: Callable[[], Floats]) -> None:
        """Put the load on the ground: its speed downward is lost, and some of that along the ground with it."""
        ground = self.load.ground
        assert ground is not None
        # What guards are told is written over by the next.
        velocity, place, (gap, stored) = state[self.rate], state[self.place], guards_at()[[GAP, STORED]].tolist()
        energy, fallen = float(velocity @ velocity), -float(velocity[-1])
        speed = float(np.linalg.norm(velocity[:-1]))
        if speed and fallen:
            velocity[:-1] *= max(0.0, 1.0 - ground.friction * fallen / speed)
        velocity[-1] = 0.0
        place[-1] -= gap
        lost = 0.5 * self.load.mass * (energy - float(velocity @ velocity))
        state[-1] -= lost + self.load.mass * self.gravity * gap
        numbers[self.contact] = STANDS
        state[-1] += float(guards_at()[STORED]) - stored
        # The rope's rate has jumped with the load's.
        self.rope.begin(state, numbers, floors, guards_at)
        if guards_at()[PRESS] < 0.0:
            self._fly(numbers, floors)
        else:
            floors[GAP], floors[PRESS] = -np.inf, 0.0
            self._rub(state, numbers, floors, guards_at)

    def _fly(self, numbers: Floats, floors: Floats) -> None:
        numbers[self.contact] = AIR
        floors[GAP], floors[PRESS], floors[SLIDING], floors[LEFT] = SUNK, -np.inf, -np.inf, -np.inf

    def _rub(self, state: Floats, numbers: Floats, floors: Floats, guards_at: Callable[[], Floats]) -> None:
        """In a plane: let friction hold a load at rest if it can, else pull against it."""
        ground, velocity = self.load.ground, state[self.rate]
        if ground is None or len(velocity) > 2 or not ground.friction:
            return
        way = float(np.sign(velocity[0])) if abs(velocity[0]) > REST else STICKS
        if way == STICKS:
            velocity[0], numbers[self.sliding] = 0.0, STICKS
            left, pushed = guards_at()[[LEFT, PUSHED]].tolist()
            if left < 0.0:
                way = float(np.sign(pushed))
        numbers[self.sliding] = way
        floors[SLIDING], floors[LEFT] = (-np.inf, 0.0) if way == STICKS else (-REST, -np.inf)
