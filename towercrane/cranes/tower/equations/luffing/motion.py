"""Equations of motion of a tower crane whose jib pivots at its foot, held by a rope of elastic length.

The hoist rope runs from its winch over the jib's head to several falls: the length below the head is
l = (L_h - d) / n with the way d from winch to head, so that it pulls the jib towards the winch as it holds the load.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from towercrane.cranes.parts.air import load_force
from towercrane.cranes.tower.equations.actions.collars import sides
from towercrane.cranes.tower.equations.actions.drive import Driven, drive
from towercrane.cranes.tower.equations.actions.wind import winds_of
from towercrane.cranes.tower.equations.constants import ROPE, SLEWING
from towercrane.cranes.tower.equations.head import head_of
from towercrane.cranes.tower.equations.luffing.hinge import Hinged, hinge, jib_part, luffing_of, pivot_of
from towercrane.cranes.tower.equations.luffing.ropes import Held, hold, tied_at, way_to
from towercrane.cranes.tower.equations.luffing.wind import blow
from towercrane.cranes.tower.equations.projection import (
    Projected,
    Share,
    mass_matrix,
    project_mover,
    project_row,
    share_of,
)
from towercrane.cranes.tower.equations.structure import place_of, resist, slewing_torque
from towercrane.kernels.algebra import dot
from towercrane.kernels.hanging import hang_load
from towercrane.kernels.payload import Rope, State, Structure, slopes, state_of
from towercrane.kernels.polynomial import polynomial

if TYPE_CHECKING:
    from towercrane.cranes.tower.equations.constants import Constants, Drives

TENSION, HOLDING, STOP, TILT, INSIDE, OUTSIDE, SLEWING_TORQUE, GUARDS = range(8)
"""Guards, and how many: tension of the hoist's falls and of the luffing rope [N], way to the jib's stop [rad]; then
as :mod:`towercrane.cranes.tower.equations.motion` has them, and last what watches the collars."""

COMMANDED = 0
"""Motion of the luffing winch: the angle at which a straight jib would stand on a rope that does not stretch."""


class LuffingStructure(NamedTuple):
    """Structure that the load hangs on, and what else is asked of it.

    Parameters
    ----------
    hanging : Structure
    rope : Rope
        Below the jib's head.
    held : Held
        The luffing rope.
    tilt : number
        Of the head [rad].
    power : number
        Of damping, luffing winch and drive [W].
    share : Share
        What turns.
    projected : list of Projected
        The coordinates.
    hinged : Hinged
    driven : Driven or None
    beyond : list
        As :class:`towercrane.cranes.tower.equations.structure.CraneStructure` has it.
    """

    hanging: Structure
    rope: Rope
    held: Held
    tilt: Any
    power: Any
    share: Share
    projected: list[Projected]
    hinged: Hinged
    driven: Driven | None
    beyond: list[Any]


def structure(crane: Constants, state: State, drives: Drives) -> LuffingStructure:
    """The crane in a state, driven so."""
    own, pivot, movers = luffing_of(crane), pivot_of(crane, state), crane.movers
    head, tilt = head_of(crane, state, drives)
    hinged = hinge(crane, head, state)
    q, qd = jib_part(crane, state)
    tied = tied_at(own, q, qd, own.attachment)
    held = hold(own, way_to(own, own.frame_head, tied, pivot), pivot, drives[COMMANDED])
    hauled = way_to(own, own.winch, tied_at(own, q, qd, 0.0), pivot)
    length, rate, acceleration = drives[ROPE]
    paid = [0.0] * movers + [-moved / own.falls for moved in hauled.moved]
    rope = Rope(
        length - (hauled.length - own.reference_way) / own.falls, rate, acceleration - hauled.bias / own.falls,
        paid, length,
    )  # fmt: skip

    # The bent jib's head is nearer to its foot, and lower: its weight there has the chord's inclination alone.
    lowered, weight = [dot(row, q) for row in own.weighted], crane.self_gravity
    sagging = [weight * pivot.s * along for along in lowered] + [0.5 * weight * pivot.c * dot(q, lowered)]
    on_jib = [a + b + c for a, b, c in zip(hinged.forces, held.forces, sagging, strict=True)]
    forces, power, beyond = resist(crane, state, drives, [0.0] * movers + on_jib, held.power)

    winds, body = winds_of(crane, drives), hinged.body
    if crane.wind:
        blown = blow(crane, state, head, winds)
        body, power = body.pushed(*blown.turning), power + blown.power
        forces = [force + own for force, own in zip(forces, blown.forces, strict=True)]
    share = share_of(head, body, hinged.end.place)
    projected = [project_mover(crane, i, share) for i in range(movers)]
    projected += [project_row(head, row, end) for row, end in zip(hinged.rows, hinged.ends, strict=True)]
    forces = [force + own.force for force, own in zip(forces, projected, strict=True)]
    driven = drive(crane, state, drives) if crane.drive is not None else None
    if driven is not None:
        (turned,) = crane.part("slewing")
        forces[turned] = forces[turned] + (driven.torque + driven.friction)
        power = power + driven.power

    axes, end = crane.fixed_axes, hinged.end
    mass = mass_matrix(crane, projected, [0.0] * len(hinged.rows))
    mass[-1][movers:] = hinged.pitching
    velocity, bias, place = head.to_fixed(end.velocity), head.to_fixed(end.bias), place_of(crane, head, end, state)
    hanging = Structure(
        mass=mass,
        force=forces,
        place=[place[k] for k in axes],
        velocity=[velocity[k] for k in axes],
        bias=[bias[k] for k in axes],
        jacobian=[[own.end[k] for own in projected] for k in axes],
        wind=[winds[-1][k] for k in axes],
    )
    return LuffingStructure(hanging, rope, held, tilt, power, share, projected, hinged, driven, beyond)


def motion(crane: Constants, t: Any, y: Any, inputs: Any) -> tuple[list[Any], list[Any]]:
    """Slopes of the state (q, n, q', p, work), and guards."""
    state, axes = state_of(y, crane.coordinates, crane.axes), range(crane.axes)
    drives = [polynomial(channel, t) for channel in inputs]
    found = structure(crane, state, drives)
    hung = hang_load(found.hanging, state, found.rope, crane.load.now(drives[crane.release]), crane.gravity)
    power, torque, beyond = found.power, 0.0, 0.0
    if found.driven is not None:
        torque, beyond = found.driven.torque, found.driven.beyond
    elif crane.axes == 3:
        torque = slewing_torque(found.share, found.projected, hung.accelerations, [hung.pull(k) for k in axes])
        if crane.slewing == "prescribed":
            _, turning, _ = drives[SLEWING]
            power = power + torque * turning
    slope = slopes(state, hung, hung.power + power)
    stop = luffing_of(crane).highest_angle - state.coordinates[-1]
    margins = [hung.tension, found.held.tension, stop, crane.tilt_limit - found.tilt]
    return slope, [*margins, -beyond, beyond, torque, *sides(found.beyond), *hung.guards]


def static_force(crane: Constants, _t: Any, y: Any, inputs: Any) -> tuple[list[Any], list[Any]]:
    """Forces on the coordinates y at rest, with the load that hangs at rest in the wind; inputs at their values."""
    state = State(y, (), [0.0] * crane.coordinates, ())
    drives = [(value, 0.0, 0.0) for value in inputs[:, 0]]
    found = structure(crane, state, drives)
    pull, columns = (
        load_force(crane.load.now(drives[crane.release]), crane.gravity, found.hanging.wind),
        zip(*found.hanging.jacobian, strict=True),
    )
    tension = np.sqrt(dot(pull, pull))
    parts = zip(found.hanging.force, columns, found.rope.paid, strict=True)
    return [own + dot(column, pull) + tension * paid for own, column, paid in parts], []
