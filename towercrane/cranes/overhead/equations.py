"""Equations of the overhead crane: a bridge that bends, a trolley on it.

The bridge is a girder on two simple supports that bends in its first natural shape, y from the first rail and S the
span: uplift q sin(pi y / S). With E I and the mass per length mu its energies give q the stiffness pi^4 E I / (2 S^3)
and the mass mu S / 2, and the bare girder its first natural frequency exactly (S. Timoshenko, Vibration Problems in
Engineering, on lateral vibration of bars with hinged ends; loads that move along a bridge are treated there in the
same way). For a force at mid-span that is 48.70 E I / S^3 beside the static 48; the static shape has 17/35 = 0.486 of
the girder's mass beside this 0.5. A trolley away from mid-span finds the girder stiffer than it is: at a quarter of
the span by 14 %.

Bridge and trolley follow their motions; what their drives must do for it is read off. The load is not in this file:
:func:`towercrane.kernels.hanging.hang_load` adds it. Axes are fixed: x along the runway, y along the bridge, z up.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.kernels.hanging import hang_load
from towercrane.kernels.payload import Rope, Structure, slopes, state_of
from towercrane.kernels.polynomial import polynomial

if TYPE_CHECKING:
    from towercrane.kernels.load import Load

BRIDGE, TROLLEY, ROPE = range(3)
"""Rows of ``inputs``."""

TENSION, BRIDGE_FORCE, TROLLEY_FORCE, FIRST_RAIL, SECOND_RAIL = range(5)
"""Guards: rope tension; forces of both drives and of the bridge on each rail, only recorded [N]."""

UPLIFT, ROPE_DIRECTION, RATE, SWAY, WORK, SIZE = 0, 1, 4, 5, 8, 9
"""Where the parts of a state without slings begin, and its size."""

AXES = 3


@dataclass(frozen=True, slots=True)
class Constants:
    """Stiffness and damping are those of the uplift at mid-span, masses those of whole parts."""

    span: float
    stiffness: float
    damping: float
    girder_mass: float
    carriage_mass: float
    trolley_mass: float
    gravity: float
    runway_height: float
    load: Load


def structure(crane: Constants, q: Any, rate: Any, bridge: Any, trolley: Any) -> Structure:
    """Bridge and trolley without the load.

    Parameters
    ----------
    crane : Constants
    q, rate : number
        Uplift at mid-span and its rate [m, m/s].
    bridge, trolley : sequence of 3 numbers
        Places with their rates and accelerations [m, m/s, m/s^2].
    """
    (place, across, across_more), (along, along_rate, along_more) = trolley, bridge
    wave, mass, girder = np.pi / crane.span, crane.trolley_mass, crane.girder_mass
    shape, tilt = np.sin(wave * place), wave * np.cos(wave * place)
    heave = 2.0 * tilt * across * rate + (tilt * across_more - wave * wave * shape * across * across) * q
    return Structure(
        mass=[[0.5 * girder + mass * shape * shape]],
        force=[
            -crane.stiffness * q
            - crane.damping * rate
            - 2.0 / np.pi * girder * crane.gravity
            - mass * shape * (crane.gravity + heave)
        ],
        place=[along, place, crane.runway_height + shape * q],
        velocity=[along_rate, across, shape * rate + tilt * across * q],
        bias=[along_more, across_more, heave],
        jacobian=[[0.0], [0.0], [shape]],
    )


def equations(crane: Constants, t: Any, y: Any, inputs: Any) -> tuple[list[Any], list[Any]]:
    """Slopes of the state (q, n, q', p, work), and guards."""
    state, rope = state_of(y, 1, AXES), Rope(*polynomial(inputs[ROPE], t))
    bridge, trolley_motion = polynomial(inputs[BRIDGE], t), polynomial(inputs[TROLLEY], t)
    _, along, _ = bridge
    place, across, _ = trolley_motion
    (q,), (rate,) = state.coordinates, state.rates
    trolley, girder, gravity = crane.trolley_mass, crane.girder_mass, crane.gravity
    wave = np.pi / crane.span
    tilt = wave * np.cos(wave * place)
    hung = hang_load(structure(crane, q, rate, bridge, trolley_motion), state, rope, crane.load, gravity)

    # What bridge and trolley must push with: inertia less the pull of rope and hinge.
    ahead, aside, up = hung.suspension
    down = trolley * (up + gravity) - hung.pull(2)
    along_force = trolley * ahead - hung.pull(0) + (girder + crane.carriage_mass) * ahead
    across_force = trolley * aside - hung.pull(1) + tilt * q * down
    power = hung.power + (along_force * along + across_force * across - crane.damping * rate * rate)
    # By moments about the rails; the girder's inertia and weight are even about mid-span.
    end = 0.5 * (girder + crane.carriage_mass) * gravity + girder * hung.accelerations[0] / np.pi
    share = place / crane.span
    rails = end + (1.0 - share) * down, end + share * down
    return slopes(state, hung, power), [
        hung.tension, along_force, across_force, *rails, *hung.guards,
    ]  # fmt: skip
