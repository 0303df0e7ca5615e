"""A load that lets go, all or in part, at an instant that is known beforehand."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cranes.parts.hoisting.slackening import STORED
from towercrane.motions.motion import Motion

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.motions.motion import Phases
    from towercrane.simulation.system import Crossings

    Floats = NDArray[np.float64]

CHANNEL = "release"
"""Channel of the part of what lets go that is gone, 0 to 1."""


def letting_go(time: float, duration: float = 0.0) -> Motion:
    """The channel's motion: at once, or evenly over a duration [s]."""
    if not duration > 0.0:
        return Motion(np.array([0.0, time, time]), np.array([[0.0], [1.0]]))
    return Motion(np.array([0.0, time, time + duration]), np.array([[0.0, 0.0], [0.0, 1.0 / duration]]))


@dataclass(frozen=True, eq=False)
class LettingGo:
    """The instant of it, as :class:`towercrane.simulation.system.Crossings` has it.

    Places and velocities go on as they were. The energy of what goes leaves the balance, where nothing stays with
    that of the stretched rope.

    Parameters
    ----------
    model : OnRope
    """

    model: Any

    @property
    def _row(self) -> int:
        return int(self.model.channels.index(CHANNEL))

    def cut(self, phases: Phases) -> Phases:
        """The phases as they are: one begins there."""
        return phases

    def crosses(self, phases: Phases) -> bool:
        """Whether it is among the phases."""
        return any(map(self.crossed, phases.inputs[:-1], phases.inputs[1:]))

    def crossed(self, before: Floats, after: Floats) -> bool:
        """Whether it is between phases with these inputs."""
        (was, rate), now = before[self._row, :2], after[self._row, 0]
        return bool(rate == 0.0 and was != now)

    def leap(self, state: Floats, before: Floats, time: float, after: Floats) -> Floats:
        """State right after it."""
        model, found = self.model, state.copy()
        went = model.load.release.mass * (after[self._row, 0] - before[self._row, 0])
        place, velocity = carried_in(model, state, after[: len(model.channels)])
        found[-1] -= went * (0.5 * velocity @ velocity + model.crane.gravity * place[-1])
        if model.carried.elasticity is not None:
            stored = [model.system.slope(at, state, rows)[1][STORED] for at, rows in ((time, before), (0.0, after))]
            found[-1] += stored[1] - stored[0]
        return found


def carried_in(model: Any, state: Floats, inputs: Floats) -> tuple[Floats, Floats]:
    """Place and velocity of a load in a state, drives as their polynomials are at time zero [m, m/s]."""
    first, moved, count = model.rope, len(state) // 2 + model.rope, model.axes
    along, swing = state[first : first + count], state[moved : moved + count]
    if model.carried.elasticity is not None:
        return along, swing
    crane, (length, _, hauled) = model.suspended(state, inputs), model.below(state, inputs)
    place, velocity = np.array(crane.place, dtype=float), np.array(crane.velocity, dtype=float)
    hauled += model.paid_out(state, inputs)
    return place + length * along, velocity + hauled * along + length * swing


@dataclass(frozen=True, eq=False)
class Together:
    """Several kinds of such instants in one run.

    Parameters
    ----------
    parts : tuple of Crossings
    """

    parts: tuple[Crossings, ...]

    def cut(self, phases: Phases) -> Phases:
        """The phases cut at all of them."""
        for part in self.parts:
            phases = part.cut(phases)
        return phases

    def crosses(self, phases: Phases) -> bool:
        """Whether there is any."""
        return any(part.crosses(phases) for part in self.parts)

    def crossed(self, before: Floats, after: Floats) -> bool:
        """Whether there is any between phases with these inputs."""
        return any(part.crossed(before, after) for part in self.parts)

    def leap(self, state: Floats, before: Floats, time: float, after: Floats) -> Floats:
        """State right after them."""
        for part in self.parts:
            if part.crossed(before, after):
                state = part.leap(state, before, time, after)
        return state


def crossings_of(*parts: Crossings | None) -> Crossings | None:
    """Those that there are, as one; None without any."""
    found = tuple(part for part in parts if part is not None)
    return None if not found else found[0] if len(found) == 1 else Together(found)
