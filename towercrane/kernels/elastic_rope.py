"""A rope that stretches, goes slack and is caught: what it pulls with.

Falls of stiffness c together carry the load on an unstretched length l below the point D; the rope between D and
its drum, a per fall, never changes. Stretched to the distance d, the rope has the strain eps = (d - l) / (l + a).
With the relaxation time tau it pulls with T = c (eps + tau eps') while it is taut, which is while

    min(eps, eps + tau eps') > 0,

and not at all otherwise. That function is the same in both modes and zero where they meet, so neither holds on.
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
    from towercrane.kernels.algebra import Row

SLACK_MODE, TAUT, BY_STRAIN = 0.0, 1.0, 2.0
"""Modes: slack, taut, or whichever the strain says."""

SHORT = 0.5
"""Part of its length within which the load is so near to D that its rope has no direction and no tension."""


@dataclass(frozen=True, slots=True)
class Elasticity:
    """How a rope stretches.

    Parameters
    ----------
    stiffness : float
        Force per strain of all falls together, c = n E A [N].
    extra_length : float
        Rope between drum and falls, per fall, a [m].
    relaxation_time : float
        Of the rope's material, tau [s]: a load m on it is damped by tau w / 2, w^2 = c / (m (l + a)).
    mode : float
        `TAUT` of a rope that is a rod, and pushes too. Else a switch sets it during a run.

    Raises
    ------
    ValueError
        If the stiffness is not positive or another value is negative.
    """

    stiffness: float
    extra_length: float = 0.0
    relaxation_time: float = 0.0
    mode: float = field(default=BY_STRAIN, metadata=CHANGING)

    def __post_init__(self) -> None:
        check_fields(self, positive=("stiffness",), not_negative=("extra_length", "relaxation_time"))

    @classmethod
    def of_spring(cls, stiffness: float, damping: float, length: float) -> Elasticity:
        """A rope that is a spring with a damper beside it [N/m, N s/m] at a length [m]."""
        return cls(stiffness * length, 0.0, damping / stiffness)

    def spring(self, length: float) -> float:
        """Stiffness with so much rope below D [N/m]."""
        return self.stiffness / (length + self.extra_length)


class Pull(NamedTuple):
    """What an elastic rope does.

    Parameters
    ----------
    tension : number
        [N]
    direction, hinge : list of d
        Unit vector from D to the load; force of the hinge's damping on the load.
    margin : number
        Above zero where the rope is taut, as a strain.
    stored : number
        Energy in its strain while it is taut [J].
    power : number
        Of its winch less what rope and hinge take [W].
    """

    tension: Any
    direction: list[Any]
    hinge: list[Any]
    margin: Any
    stored: Any
    power: Any


def stretch(
    rope: Elasticity,
    length: Any,
    wound: Any,
    rate: Any,
    paid: Any,
    apart: Row,
    parting: Row,
    hinge_damping: Any,
    hangs: Any = None,
) -> Pull:
    """Pull of an elastic rope.

    Parameters
    ----------
    rope : Elasticity
    length : number
        Of the unstretched rope below D [m].
    wound, rate : number
        Length that its winch gives it, and the rate of that [m, m/s].
    paid : number
        Rate at which the crane's motion pays out rope beside the winch [m/s].
    apart, parting : sequence of d
        From D to the load, and its rate.
    hinge_damping : number
        [N m s/rad]
    hangs : number, optional
        1 while something hangs on it, else 0: then it is slack.

    Notes
    -----
    What the crane's motion pays out comes from the rope beyond D, so that the length which stretches is the winch's
    own with a. With T_e = c eps and T_d = T - T_e the winch puts in -(T_e (1 + eps / 2) + T_d (1 + eps)) l' and the
    rope loses T_d (l + a) eps'. A slack rope stores nothing: what is left of its strain dies within tau.
    """
    whole = wound + rope.extra_length
    distance = np.sqrt(dot(apart, apart))
    # Nothing is divided by a distance that may be zero; a rope that is taut is never so short.
    safe = choose(below(distance, SHORT * length), 1.0, distance)
    direction = [component / safe for component in apart]
    along = dot(direction, parting)
    across = [v - along * n for v, n in zip(parting, direction, strict=True)]
    strain = (distance - length) / whole
    straining = (along - paid - (1.0 + strain) * rate) / whole
    late = rope.relaxation_time * straining
    margin = strain + choose(below(late, 0.0), late, 0.0)
    taut = choose(below(rope.mode, BY_STRAIN), rope.mode, below(0.0, margin))
    if hangs is not None:
        margin, taut = choose(hangs, margin, -1.0), hangs * taut
    elastic, viscous = taut * rope.stiffness * strain, taut * rope.stiffness * late
    torque = taut * hinge_damping / (safe * safe)
    return Pull(
        tension=elastic + viscous,
        direction=direction,
        hinge=[-torque * v for v in across],
        margin=margin,
        stored=0.5 * elastic * strain * whole,
        power=-(elastic * (1.0 + 0.5 * strain) + viscous * (1.0 + strain)) * rate
        - viscous * whole * straining
        - torque * dot(across, across),
    )
