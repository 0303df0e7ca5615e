"""A crane with its trolley at a place and its load on the ground there."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.kernels.ground import Ground
from towercrane.motions.motion import rest
from towercrane.runs.loads import static
from towercrane.studies.lift.hand import Yielding

if TYPE_CHECKING:
    from towercrane.cases.case import Case
    from towercrane.motions.motion import Motion

NEARBY = 0.01
"""Part of the load that is laid on and taken off to see how the crane yields."""


@dataclass(frozen=True, eq=False)
class Place:
    """A crane whose trolley stands somewhere.

    Parameters
    ----------
    position : float
        [m]
    model : Model
        With its load on the ground.
    drives : dict of str to Motion
        All at rest.
    yielding : Yielding
    hanging : dict of str to float
        Outputs of the crane at rest under the load.
    """

    position: float
    model: Any
    drives: dict[str, Motion]
    yielding: Yielding
    hanging: dict[str, float]


def stand(case: Case, model: Any, position: float, slack: float) -> Place:
    """The crane with its trolley somewhere, at rest under the load."""
    load = model.load
    friction = load.ground.friction if load.ground is not None else 0.0
    hangs = model.with_load(replace(load, ground=None))
    at_first = {name: rest(float(plan.commanded(0.0))) for name, plan in case.plans.items()}
    drives = at_first | {"trolley": rest(position)}
    values = [drives[channel].end for channel in model.channels]
    inputs = np.zeros((len(values), 3))
    inputs[:, 0] = values

    def height(mass: float) -> float:
        other = model.with_load(replace(load, mass=mass, ground=None))
        return float(other.suspended(other.start(inputs), inputs).place[-1])

    weight = load.mass * model.crane.gravity
    sinks = height((1.0 - NEARBY) * load.mass) - height((1.0 + NEARBY) * load.mass)
    spring = load.elasticity.spring(case.rope.length)
    yielding = Yielding(load.mass, spring, sinks / (2.0 * NEARBY * weight), model.crane.gravity)
    stands = model.with_load(replace(load, ground=Ground(slack=slack, friction=friction)))
    return Place(position, stands.standing(inputs), drives, yielding, static(hangs, drives, values))
