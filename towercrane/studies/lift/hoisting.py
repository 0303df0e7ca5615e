"""How a load is hoisted off the ground: slack, a ramp to a speed, creep before it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from towercrane.motions.motion import Motion

if TYPE_CHECKING:
    from towercrane.cases.case import Case

SLACK = 0.05
"""Of the rope of a load on the ground, where a case states none [m]."""

ACCELERATION = 1.0
"""Of a hoist whose case does not haul in [m/s^2]."""

SETTLES = 1.0
"""How long a load that hangs is still crept with [s]."""

STEADY = 1e-6
"""Part of a speed by which one that is held may change."""


@dataclass(frozen=True)
class Hoisting:
    """A way to lift off.

    Parameters
    ----------
    slack : float
        Of the rope at the start [m].
    acceleration : float
        Of the hoist [m/s^2].
    creep : float
        Speed until the load hangs, where it is below that of hoisting [m/s]; 0 for none.
    """

    slack: float = SLACK
    acceleration: float = ACCELERATION
    creep: float = 0.0

    def at_lift_off(self, speed: float) -> float:
        """Speed that a load is lifted off with [m/s]."""
        return min(speed, self.creep or speed)

    def time(self, way: float, speed: float) -> float:
        """Time after which so much rope is hauled in before any speed beyond that of lift-off [s]."""
        steady = self.at_lift_off(speed)
        return way / steady + 0.5 * steady / self.acceleration

    def motion(self, length: float, sag: float, speed: float) -> Motion:
        """Length of the rope: a ramp, creep until slack and sag are hauled in and a little longer, a ramp, the speed.

        Parameters
        ----------
        length : float
            At the start [m].
        sag : float
            By which the load's weight stretches the rope and bends the crane [m].
        speed : float
            [m/s]
        """
        first = self.at_lift_off(speed)
        spans, rates = [first / self.acceleration], [0.0, first]
        if first < speed:
            creeps = self.time(self.slack + sag, speed) + SETTLES - spans[0]
            spans += [max(creeps, 0.0), (speed - first) / self.acceleration]
            rates += [first, speed]
        pieces, places = [], [length]
        for span, begin, end in zip(spans, rates[:-1], rates[1:], strict=True):
            pieces.append([places[-1], -begin, -0.5 * (end - begin) / span if span else 0.0])
            places.append(places[-1] - 0.5 * (begin + end) * span)
        return Motion(np.r_[0.0, np.cumsum(spans)], np.array(pieces), -speed)


def hoisting_of(case: Case) -> tuple[Hoisting, float]:
    """How a case hoists, and its largest speed [m/s], 0 where it does not haul in.

    It creeps where a speed that is held comes before a larger one.
    """
    slack = getattr(case.start, "slack", None)
    motion = case.plans["rope"].commanded
    begins = -motion(motion.switch_times[:-1], 1)
    # A moment before the next piece: at a switch a motion has its right limit.
    bends = np.abs(motion(motion.switch_times[:-1], 2))
    fastest = max(-motion.range(1)[0], 0.0)
    if not fastest:
        return Hoisting(SLACK if slack is None else slack), 0.0
    held = begins[(bends <= STEADY * fastest) & (begins > 0.0)]
    creep = float(held[0]) if len(held) and held[0] < (1.0 - STEADY) * fastest else 0.0
    found = max(-motion.range(2)[0], 0.0)
    return Hoisting(SLACK if slack is None else slack, float(found or ACCELERATION), creep), float(fastest)
