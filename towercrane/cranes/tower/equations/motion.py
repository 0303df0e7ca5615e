"""Equations of motion of the flexible crane: its structure, its drives, and the load on its rope."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from towercrane.cranes.parts.friction import held as held_at
from towercrane.cranes.parts.friction import holding
from towercrane.cranes.tower.equations.actions.collars import sides
from towercrane.cranes.tower.equations.constants import ROPE, SLEWING
from towercrane.cranes.tower.equations.jib import Section
from towercrane.cranes.tower.equations.structure import slewing_torque, structure
from towercrane.kernels.algebra import dot
from towercrane.kernels.hanging import hang_load
from towercrane.kernels.payload import Rope, slopes, state_of
from towercrane.kernels.polynomial import polynomial

if TYPE_CHECKING:
    from towercrane.cranes.tower.equations.constants import Constants

TENSION, INNER_END, OUTER_END, TILT, INSIDE, OUTSIDE, SLEWING_TORQUE, TROLLEY_FORCE, GUARDS = range(9)
"""Guards, and how many: rope tension [N], way to either end of the jib [m], way to the tilt limit [rad], way to the
corner of the drive's coupling from inside and from outside [rad]. Outputs beside them: torque of the slewing drive
[N m] and force of the trolley's [N]; of a jib with joints the trolley's section follows, of a head that is free the
three of its brake, then of each collar with play the way to its corner from inside and from outside [m], then
tensions of ties."""


def motion(crane: Constants, t: Any, y: Any, inputs: Any) -> tuple[list[Any], list[Any]]:
    """Slopes of the state (q, n, q', p, work), and guards.

    One row of inputs more than there are channels says on which section of the jib the trolley is, as in
    :mod:`towercrane.cranes.tower.equations.joints`.
    """
    state, axes = state_of(y, crane.coordinates, crane.axes), range(crane.axes)
    drives = [polynomial(channel, t) for channel in inputs[: crane.channels]]
    section = Section(*inputs[crane.channels][:3]) if len(inputs) > crane.channels else None
    found, rope = structure(crane, state, drives, section), Rope(*drives[ROPE])
    hanging, brake = found.hanging, found.drive if crane.slewing == "free" else None
    if brake is not None:
        (turned,) = crane.part("slewing")
        hanging = held_at(hanging, turned, brake.sticks)
    hung = hang_load(hanging, state, rope, crane.load.now(drives[crane.release]), crane.gravity)
    power, torque, beyond = found.power, 0.0, 0.0
    held_by: tuple[Any, ...] = ()
    if brake is not None and crane.drive is not None:
        sliding, limit = brake.way * state.rates[turned], crane.drive.friction_torque
        held_by = holding(found.hanging, turned, hung, brake.sticks, sliding, limit)
        torque = brake.friction + held_by[-1]
    elif found.drive is not None:
        torque, beyond = found.drive.torque, found.drive.beyond
    elif crane.axes == 3:
        torque = slewing_torque(found.share, found.projected, hung.accelerations, [hung.pull(k) for k in axes])
        if crane.slewing == "prescribed":
            _, turning, _ = drives[SLEWING]
            power = power + torque * turning
    # The trolley's drive acts along the deflected jib.
    rises = [*hung.suspension[:-1], hung.suspension[-1] + crane.gravity]
    held = [
        crane.trolley_mass * rises[k] - hung.tension * hung.direction[k] + hung.hinge[k] for k in axes
    ]  # fmt: skip
    force = dot([found.path[k] for k in crane.fixed_axes], held)
    slope = slopes(state, hung, hung.power + (power + force * found.trolley.rate))
    margins = [hung.tension, found.trolley.x, crane.jib_length - found.trolley.x, crane.tilt_limit - found.tilt]
    section_too = found.trolley.section if crane.jointed else ()
    tensions = found.taut.tensions if found.taut is not None else ()
    recorded, contacts = (torque, force, *section_too, *held_by), sides(found.beyond)
    return slope, [*margins, -beyond, beyond, *recorded, *contacts, *tensions, *hung.guards]
