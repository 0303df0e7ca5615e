"""The flexible crane without its load: tower, slewing head, jib and trolley.

Coordinates are amplitudes of tower modes along the fixed axes x and y, of torsion modes, the slewing angle where a
drive turns it, and amplitudes of jib modes to the left and up; any of them may be absent. A planar scene has the
x modes of the tower and the vertical modes of the jib. Everything that hangs on the tower's top is seen in the
head's axes of :mod:`towercrane.cranes.tower.equations.head`: a point of the jib is at s = (x, W_y(x), W_z(x)) there,
and

    a = R^T u'' + w' x s + w x (w x s) + 2 w x s' + s''

is its acceleration. Summed over the mass of the jib this leaves products of the mass sums of
:mod:`towercrane.cranes.tower.modes.mass_sums` with the coordinates, nothing to be integrated. Gao et al. (2023) set
the coordinates up; the equations are derived anew.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from towercrane.cranes.parts.air import load_force
from towercrane.cranes.tower.equations.actions.collars import held_back, meet
from towercrane.cranes.tower.equations.actions.drive import Driven, drive
from towercrane.cranes.tower.equations.actions.ground import ground_of, shake
from towercrane.cranes.tower.equations.actions.wind import press_wind, winds_of
from towercrane.cranes.tower.equations.body import Carried, body_of, carried
from towercrane.cranes.tower.equations.constants import SLEWING, SLIDE_X, SLIDE_Y
from towercrane.cranes.tower.equations.head import Head, head_of
from towercrane.cranes.tower.equations.jib import bend, path_of, trolley_of
from towercrane.cranes.tower.equations.projection import (
    Projected,
    Share,
    mass_matrix,
    project_bending,
    project_carrier,
    project_mover,
    share_of,
)
from towercrane.cranes.tower.equations.tied.fields import move_fields
from towercrane.cranes.tower.equations.tied.ties import Taut, pull_ties
from towercrane.kernels.algebra import Vector, dot
from towercrane.kernels.payload import State, Structure

if TYPE_CHECKING:
    from towercrane.cranes.tower.equations.constants import Constants, Drives
    from towercrane.cranes.tower.equations.jib import Section, Trolley


HELD = 1e9
"""Stiffness by which a head that is free stands for its states at rest where it begins [N m/rad]."""


class CraneStructure(NamedTuple):
    """Structure that the load hangs on, and what else is asked of it.

    Parameters
    ----------
    hanging : Structure
    trolley : Trolley
    tilt : number
        Of the head [rad].
    power : number
        Of damping, wind, ground and drive [W].
    path : tuple of 3
        Direction of the trolley's path, per way along the jib, in fixed axes.
    share : Share
        What turns.
    projected : list of Projected
        The coordinates.
    drive : Driven or None
    taut : Taut or None
        Tie bars.
    beyond : list
        How far the tower is beyond the play of each collar that has some [m].
    """

    hanging: Structure
    trolley: Trolley
    tilt: Any
    power: Any
    path: Vector
    share: Share
    projected: list[Projected]
    drive: Driven | None
    taut: Taut | None
    beyond: list[Any]


class Resisted(NamedTuple):
    """Forces on the coordinates with those of springs, dampers and collars with play, and :class:`CraneStructure`'s
    power and ways beyond play."""

    forces: list[Any]
    power: Any
    beyond: list[Any]


def resist(crane: Constants, state: State, drives: Drives, acting: list[Any], power: Any) -> Resisted:
    """What springs and dampers of the coordinates, and collars with play, add to forces and power."""
    forces = []
    for i in range(crane.coordinates):
        loss = crane.damping[i] * state.rates[i]
        power = power - loss * state.rates[i]
        force = acting[i] - loss
        for m in range(crane.coordinates):
            force = force - crane.stiffness[i, m] * state.coordinates[m]
        forces.append(force)
    met = meet(crane, state.coordinates, drives)
    if met:
        back, fed = held_back(crane, drives, met)
        forces, power = [force + own for force, own in zip(forces, back, strict=True)], power + fed
    return Resisted(forces, power, [own.beyond for own in met])


def structure(crane: Constants, state: State, drives: Drives, section: Section | None = None) -> CraneStructure:
    """The crane in a state, driven so, its trolley on a section of the jib, see `trolley_of`."""
    (head, tilt), trolley = head_of(crane, state, drives), trolley_of(crane, drives, section)
    ground = ground_of(crane, drives)
    shaken = head.to_head(ground.acceleration)
    # Acceleration against gravity, of the structure and of the trolley; with the ground's own.
    felt, falls = (
        tuple(gravity * down + own for down, own in zip(head.rows[2], shaken, strict=True))
        for gravity in (crane.self_gravity, crane.gravity)
    )
    across, rise = (path_of(crane, modes, trolley, state) for modes in (crane.lateral, crane.vertical))
    end = carried(head, trolley, across, rise)
    pull = tuple(-crane.trolley_mass * (own + fall) for own, fall in zip(end.bias, falls, strict=True))
    taut, tied = None, crane.tied
    if tied is None:
        left, up = bend(crane, head, felt, state)
        turning, own_forces = body_of(crane.straight, head, felt, left.sums, up.sums), left.forces + up.forces
        drift = 0.0, left.sums.first_rate, up.sums.first_rate
    else:
        q, rates = state.coordinates[crane.movers :], state.rates[crane.movers :]
        turning, own_forces, rows, drift = move_fields(tied.fields, head, felt, q, rates)
        taut = pull_ties(tied, q)
        own_forces = [own + pulled for own, pulled in zip(own_forces, taut.forces, strict=True)]
    body = turning.with_trolley(crane.trolley_mass, end.place, pull)

    forces, power, beyond = resist(crane, state, drives, [0.0] * crane.movers + own_forces, 0.0)
    winds = winds_of(crane, drives)
    if crane.wind:
        blown = press_wind(crane, state, head, winds)
        power = power + blown.power
        forces = [force + own for force, own in zip(forces, blown.forces, strict=True)]
        body = body.pushed((0.0, blown.side, 0.0), (blown.rolling, 0.0, blown.turning))

    if crane.ground:
        moved = shake(crane, state, head, turning, drift, end, ground, drives)
        power = power + moved.power
        forces = [force + own for force, own in zip(forces, moved.forces, strict=True)]

    share = share_of(head, body, end.place)
    projected = [project_mover(crane, i, share) for i in range(crane.movers)]
    shapes = across.shapes + rise.shapes
    if tied is None:
        for modes, axis, crossed, own_shapes in (
            (crane.lateral, 1, left.across, across.shapes), (crane.vertical, 2, up.across, rise.shapes),
        ):  # fmt: skip
            projected += project_bending(crane, modes, axis, crossed, own_shapes, head, end.place, pull)
    else:
        shapes += [0.0] * (len(rows) - len(shapes))
        axes_of = [1] * len(crane.lateral) + [2] * (len(rows) - len(crane.lateral))
        for row, shape, axis in zip(rows, shapes, axes_of, strict=True):
            projected.append(project_carrier(crane, row, axis, shape, head, end.place, pull))
    forces = [force + own.force for force, own in zip(forces, projected, strict=True)]
    driven = drive(crane, state, drives) if crane.drive is not None else None
    if driven is not None:
        (turned,) = crane.part("slewing")
        forces[turned] = forces[turned] + (driven.torque + driven.friction)
        power = power + driven.power

    axes = crane.fixed_axes
    velocity, bias, place = head.to_fixed(end.velocity), head.to_fixed(end.bias), place_of(crane, head, end, state)
    hanging = Structure(
        mass=mass_matrix(crane, projected, shapes),
        force=forces,
        place=[place[k] for k in axes],
        velocity=[velocity[k] for k in axes],
        bias=[bias[k] for k in axes],
        jacobian=[[own.end[k] for own in projected] for k in axes],
        wind=[winds[-1][k] - ground.velocity[k] for k in axes],
        ground=[ground.acceleration[k] for k in axes],
    )
    path = tuple(row[0] + row[1] * across.slope + row[2] * rise.slope for row in head.rows)
    return CraneStructure(hanging, trolley, tilt, power, path, share, projected, driven, taut, beyond)


def place_of(crane: Constants, head: Head, end: Carried, state: State) -> Vector:
    """Where a point of the head is, from the undeformed tower top along the axes of the coordinates [m]."""
    q = state.coordinates[: crane.movers]
    x, y, z = head.to_fixed(end.place)
    return x + dot(crane.motions[SLIDE_X][: crane.movers], q), y + dot(crane.motions[SLIDE_Y][: crane.movers], q), z


def static_force(crane: Constants, _t: Any, y: Any, inputs: Any) -> tuple[list[Any], list[Any]]:
    """Forces on the coordinates y at rest, with the load that hangs at rest in the wind; inputs at their values."""
    state = State(y, (), [0.0] * crane.coordinates, ())
    drives = [(value, 0.0, 0.0) for value in inputs[:, 0]]
    hanging = structure(crane, state, drives).hanging
    pull = load_force(crane.load.now(drives[crane.release]), crane.gravity, hanging.wind)
    columns = zip(*hanging.jacobian, strict=True)
    forces = [own + dot(column, pull) for own, column in zip(hanging.force, columns, strict=True)]
    if crane.slewing == "free":
        # The brake holds it where it begins.
        (turned,) = crane.part("slewing")
        forces[turned] = HELD * (inputs[SLEWING, 0] - y[turned])
    return forces, []


def slewing_torque(share: Share, projected: list[Projected], accelerations: list[Any], pull: list[Any]) -> Any:
    """Torque that a prescribed slewing takes: the equation of the coordinate that is not free."""
    column, _ = share.turning
    torque = -share.forces[4]
    for own, acceleration in zip(projected, accelerations, strict=True):
        torque = torque + own.row[4] * acceleration
    return torque - dot(column, pull)
