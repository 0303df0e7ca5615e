"""A jib on its hinge in the head, without the forces of its ropes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from towercrane.cranes.tower.equations.body import Body, Carried, body_of
from towercrane.cranes.tower.equations.jib import bend_jib
from towercrane.cranes.tower.equations.luffing.pivot import (
    Coupled,
    Pivot,
    foot_of,
    joined,
    pivot_at,
    raised,
    rigid_body,
    seen_from_head,
)
from towercrane.cranes.tower.equations.luffing.ropes import Tied, tied_at
from towercrane.cranes.tower.modes.mass_sums import Straight
from towercrane.kernels.algebra import Row, Vector, cross

if TYPE_CHECKING:
    from towercrane.cranes.tower.equations.constants import Constants
    from towercrane.cranes.tower.equations.head import Head
    from towercrane.cranes.tower.equations.luffing.constants import Luffing
    from towercrane.kernels.payload import State


def luffing_of(crane: Constants) -> Luffing:
    """What is known of the jib's pivot."""
    assert crane.luffing is not None, "the crane's jib pivots"
    return crane.luffing


def pivot_of(crane: Constants, state: State) -> Pivot:
    """The jib as its coordinate has it."""
    return pivot_at(state.coordinates[-1], state.rates[-1])


def jib_part(crane: Constants, state: State) -> tuple[Row, Row]:
    """Coordinates of the jib's modes and their rates."""
    part = slice(crane.movers, crane.vertical.stop)
    return state.coordinates[part], state.rates[part]


class Hinged(NamedTuple):
    """The jib on its hinge, and the head with it.

    Parameters
    ----------
    body : Body
        All that turns, about the tower's top along the head's axes.
    end : Carried
        The sheave at the jib's head, where the rope hangs from; in the head's axes.
    jib : Body
        The jib alone, about its foot along its axes.
    rows, jib_rows : list of Coupled
        Of the jib's modes and of its angle, as the body and as the jib.
    ends : list of tuple of 3
        What each of them moves the sheave.
    forces : list
        On each of them.
    pitching : list
        Inertia of the angle with each of them.
    """

    body: Body
    end: Carried
    jib: Body
    rows: list[Coupled]
    jib_rows: list[Coupled]
    ends: list[Vector]
    forces: list[Any]
    pitching: list[Any]


def hinge(crane: Constants, head: Head, state: State) -> Hinged:
    """Jib and head, without the ropes' forces."""
    own, pivot = luffing_of(crane), pivot_of(crane, state)
    frame, foot = foot_of(head, pivot, own.foot)
    weight = crane.self_gravity
    down_x, down_y, down_z = (weight * along for along in head.rows[2])
    felt_x, felt_y, felt_z = (a + weight * down for a, down in zip(foot.bias, frame.rows[2], strict=True))
    (wx, wy, wz), (roll, pitch, turn) = frame.spin, frame.spin_bias
    left = bend_jib(crane, crane.lateral, crane.vertical, -1.0, (wx, wy, wz), (roll, turn), felt_y, state)
    up = bend_jib(crane, crane.vertical, crane.lateral, 1.0, (wx, wz, wy), (roll, -pitch), felt_z, state)
    mass, moment, inertia = own.jib
    jib = body_of(
        Straight(mass, moment, 0.0, inertia, inertia), frame, (felt_x, felt_y, felt_z), left.sums, up.sums
    )  # fmt: skip

    a, b = crane.jib_mass, crane.jib_moment
    rows = [Coupled((0.0, a[i], 0.0), (-c, 0.0, b[i])) for i, c in zip(crane.lateral, left.across, strict=True)]
    rows += [Coupled((0.0, 0.0, a[i]), (c, -b[i], 0.0)) for i, c in zip(crane.vertical, up.across, strict=True)]
    pitching = [0.0] * len(left.across) + [b[i] for i in crane.vertical] + [jib.inertia[3]]
    rows.append(Coupled(raised(jib.first), (-jib.inertia[1], -jib.inertia[3], -jib.inertia[4])))
    q, qd = jib_part(crane, state)
    sheave = tied_at(own, q, qd, 0.0)
    (x, z), (ixx, iyy, izz, ixz) = own.rest_first, own.rest_inertia
    inertia_of_rest = ixx, 0.0, ixz, iyy, 0.0, izz
    rest = rigid_body(own.rest_mass, (x, 0.0, z), inertia_of_rest, head, (down_x, down_y, down_z))
    return Hinged(
        body=joined(rest, seen_from_head(jib, pivot, foot.place)),
        end=carried_at(head, frame, pivot, foot.place, foot.bias, sheave),
        jib=jib,
        jib_rows=rows,
        rows=[row.seen_from_head(pivot, foot.place) for row in rows],
        ends=[pivot.to_head(moved) for moved in (*sheave.moved, raised(sheave.place))],
        forces=[*left.forces, *up.forces, -jib.moment[1]],
        pitching=pitching,
    )


def carried_at(head: Head, frame: Head, pivot: Pivot, foot: Vector, bias: Vector, tied: Tied) -> Carried:
    """Motion of a point of the jib's head, in the head's axes."""
    spin, place, rate = frame.spin, tied.place, tied.rate
    swept, twice = cross(spin, place), cross(spin, rate)
    velocity = tuple(top + turned + own for top, turned, own in zip(frame.top, swept, rate, strict=True))
    parts = zip(bias, cross(frame.spin_bias, place), cross(spin, swept), twice, tied.bias, strict=True)
    acceleration = tuple(own + al + w + 2.0 * two + bent for own, al, w, two, bent in parts)
    x, y, z = pivot.to_head(place)
    return Carried(
        (foot[0] + x, y, foot[2] + z),
        pivot.to_head((velocity[0], velocity[1], velocity[2])),
        pivot.to_head((acceleration[0], acceleration[1], acceleration[2])),
    )
