"""Level ground under the load: where it stands, what it presses with, how it rubs.

The load is a point, its hook. On the ground it does not move up or down, and presses with N > 0; the rope is then
elastic, so that its force is known and no force of contact has to be solved for.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from modal.checks import check_fields
from towercrane.kernels.algebra import dot
from towercrane.kernels.choices import below, choose
from towercrane.kernels.straight.leaves import CHANGING

if TYPE_CHECKING:
    from collections.abc import Sequence

    from towercrane.kernels.algebra import Row

AIR, STANDS, BY_PLACE = 0.0, 1.0, 2.0
"""Contact: none, the load stands, or whichever its place and force say."""

STICKS, BY_SPEED = 0.0, 2.0
"""Friction in a plane: none moves, or whichever the speed says; else the way that the load slides, -1 or 1."""

NEARLY = 1e-9
"""Height over the ground at which a load that is pressed down stands on it [m]."""

CREEPING = 1e-3
"""Speed in space below which friction is viscous [m/s]: it has a direction there, and nothing sticks."""


@dataclass(frozen=True, slots=True)
class Ground:
    """Level ground.

    Parameters
    ----------
    height : float
        [m]; not a number where the load stands on it at the start, with its crane at rest as if without a load.
    slack : float
        Of the rope of a load that stands on the ground at the start [m]; not a number of one that hangs.
    friction : float
        Coulomb's coefficient.
    contact, sliding : float
        What holds, which a switch sets during a run.

    Raises
    ------
    ValueError
        If the friction is negative, or neither height nor slack is known.
    """

    height: float = np.nan
    slack: float = np.nan
    friction: float = 0.0
    contact: float = field(default=BY_PLACE, metadata=CHANGING)
    sliding: float = field(default=BY_SPEED, metadata=CHANGING)

    def __post_init__(self) -> None:
        check_fields(self, not_negative=("friction",))
        if np.isnan(self.height) and not self.slack >= 0.0:
            raise ValueError(f"Ground.slack: wanted a length where no height is stated, got {self.slack!r}")

    @property
    def carries(self) -> bool:
        """Whether the load stands on it at the start."""
        return not np.isnan(self.slack)


class Standing(NamedTuple):
    """What the ground does to a load.

    Parameters
    ----------
    accelerations : list of d
        Of the load.
    power : number
        Of friction [W].
    guards : tuple
        Height of the load over the ground; force that it would press with; its speed the way it slides; force that is
        left until it slips, and force that pushes it; force that it presses with.
    """

    accelerations: list[Any]
    power: Any
    guards: tuple[Any, ...]


def stand(ground: Ground, place: Row, velocity: Row, pushed: Sequence[Any], mass: Any, gravity: Any) -> Standing:
    """A load over ground, or on it.

    Parameters
    ----------
    ground : Ground
    place, velocity : sequence of d
        Of the load.
    pushed : sequence of d
        Force on it, but for its weight and what the ground does.
    mass, gravity : number

    Notes
    -----
    In a plane friction holds a load at rest with what is needed, up to its limit, and pulls with the limit against
    one that slides. In space it always pulls against the motion, below `CREEPING` in proportion to it.
    """
    rates, gap, press = velocity[:-1], place[-1] - ground.height, mass * gravity - pushed[-1]
    lies = below(gap, NEARLY) * below(0.0, press)
    stands = choose(below(ground.contact, BY_PLACE), ground.contact, lies)
    reaction = stands * press
    limit = ground.friction * reaction
    if len(rates) == 1:
        way = choose(below(abs(ground.sliding), BY_SPEED), ground.sliding, np.sign(rates[0]))
        rubbing, sticks = [-limit * way], stands * below(abs(way), 0.5) * below(0.0, ground.friction)
        sliding, left = way * rates[0], ground.friction * press - abs(pushed[0])
    else:
        speed = np.sqrt(dot(rates, rates))
        fast = choose(below(speed, CREEPING), CREEPING, speed)
        rubbing, sticks, sliding, left = [-limit * rate / fast for rate in rates], 0.0, 0.0, 0.0
    accelerations = [
        choose(sticks, 0.0, (own + against) / mass) for own, against in zip(pushed[:-1], rubbing, strict=True)
    ]
    accelerations.append(choose(stands, 0.0, pushed[-1] / mass - gravity))
    guards = gap, press, sliding, left, pushed[0], reaction
    return Standing(accelerations, dot(rubbing, rates), guards)
