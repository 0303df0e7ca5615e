"""Projection of what turns on a tower onto the coordinates that move it.

The head has five motions of its own: u_x and u_y of the tower's top, th_x and th_y of its tilt, and its turning.
A tower mode along x moves u_x and th_y, one along y moves u_y and -th_x, torsion and slewing turn. In those motions
and the jib's modes the mass matrix is that of a rigid body with deflections.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from towercrane.kernels.algebra import Vector, cross, dot

if TYPE_CHECKING:
    from towercrane.cranes.tower.equations.body import Body
    from towercrane.cranes.tower.equations.constants import Constants
    from towercrane.cranes.tower.equations.head import Head

Momenta = tuple[Vector, Vector]
"""Sums of a coordinate's motion over mass: momentum, and moment of momentum about an origin."""

Motions = tuple[Any, Any, Any, Any, Any]
"""A number for each of the head's own motions u_x, u_y, th_x, th_y and turning."""


class Share(NamedTuple):
    """What turns, in the head's own motions.

    Mass; its couplings of u_x and of u_y with th_x, th_y and turning; inertia of these three; forces; and what these
    three do to the rope's upper end, in fixed axes (x, y, z by row).
    """

    mass: Any
    slid: tuple[Vector, Vector]
    turned: tuple[Vector, Vector, Vector]
    forces: Motions
    ends: tuple[Vector, Vector, Vector]

    @property
    def turning(self) -> tuple[Vector, Motions]:
        """Motion of the rope's upper end with a turn, in fixed axes; and the turn's row of the mass matrix."""
        end_x, end_y, end_z = self.ends
        return (end_x[2], end_y[2], end_z[2]), (self.slid[0][2], self.slid[1][2], *self.turned[2])


class Projected(NamedTuple):
    """One coordinate: share in the momenta of the head's motions, force, and what it moves the rope's upper end."""

    row: Motions
    force: Any
    end: Vector


def share_of(head: Head, body: Body, place: Vector) -> Share:
    """What turns, with the rope's upper end at this place in the head's axes, in the head's own motions."""
    fixed, turn_x, turn_y = head.rows, head.turn_x, head.turn_y
    (ixx, ixy, ixz, iyy, iyz, izz), moment = body.inertia, body.moment
    inertia = (ixx, ixy, ixz), (ixy, iyy, iyz), (ixz, iyz, izz)
    momentum_x, momentum_y = ([dot(row, turn) for row in inertia] for turn in (turn_x, turn_y))
    across = dot(turn_x, momentum_y)
    turned = (
        (dot(turn_x, momentum_x), across, momentum_x[2]),
        (across, dot(turn_y, momentum_y), momentum_y[2]),
        (momentum_x[2], momentum_y[2], izz),
    )
    arms = cross(body.first, fixed[0]), cross(body.first, fixed[1])
    slid_x, slid_y = ((dot(turn_x, arm), dot(turn_y, arm), arm[2]) for arm in arms)
    pushed = dot(fixed[0], body.force), dot(fixed[1], body.force)
    forces = *pushed, dot(turn_x, moment), dot(turn_y, moment), moment[2]
    swept_x, swept_y = cross(turn_x, place), cross(turn_y, place)
    end_x, end_y, end_z = (
        (dot(along, swept_x), dot(along, swept_y), along[1] * place[0] - along[0] * place[1]) for along in fixed
    )
    return Share(body.mass, (slid_x, slid_y), turned, forces, (end_x, end_y, end_z))


def project_mover(crane: Constants, i: int, share: Share) -> Projected:
    """A coordinate of tower or slewing."""
    (slid_x, slid_y), (end_x, end_y, end_z) = share.slid, share.ends
    x, y, *turns = crane.motions[:, i]
    rolled, pitched, twisted = (slid_x[k] * x + slid_y[k] * y + dot(share.turned[k], turns) for k in range(3))
    row = share.mass * x + dot(slid_x, turns), share.mass * y + dot(slid_y, turns), rolled, pitched, twisted
    end = x + dot(end_x, turns), y + dot(end_y, turns), dot(end_z, turns)
    return Projected(row, dot(share.forces, (x, y, *turns)), end)


def project_bending(
    crane: Constants, modes: range, axis: int, crossed: list[Any], shapes: list[Any], head: Head, place: Vector,
    pull: Vector,
) -> list[Projected]:  # fmt: skip
    """Jib modes along an axis of the head, 1 or 2, with a trolley at this place and this force on it.

    For each mode N q with the other direction and the shape at the trolley are given.

    A mode along e2 turns about b e3 - c e1, one along e3 about c e1 - b e2, with b and c its first moments along the
    jib, the sections' own turning included, and with the deflection across it.
    """
    along, other, found = [row[axis] for row in head.rows], place[3 - axis], []
    for i, shape, across in zip(modes, shapes, crossed, strict=True):
        carried = crane.trolley_mass * shape
        mass, c = crane.jib_mass[i] + carried, across + carried * other
        b = crane.jib_moment[i] + crane.jib_turning[i] + carried * place[0]
        turns = head.turn_x, head.turn_y
        if axis == 1:
            rolled, pitched, twisted = *(b * turn[2] - c * turn[0] for turn in turns), b
        else:
            rolled, pitched, twisted = *(c * turn[0] - b * turn[1] for turn in turns), 0.0
        end = shape * along[0], shape * along[1], shape * along[2]
        row = mass * along[0], mass * along[1], rolled, pitched, twisted
        found.append(Projected(row, shape * pull[axis], end))
    return found


def project_row(head: Head, row: Momenta, end: Vector) -> Projected:
    """A coordinate of what turns, with what it moves the rope's upper end along the head's axes."""
    x, y, _ = head.rows
    momentum, moment = row
    shared = (
        dot(x, momentum), dot(y, momentum), dot(head.turn_x, moment), dot(head.turn_y, moment), moment[2],
    )  # fmt: skip
    return Projected(shared, 0.0, head.to_fixed(end))


def project_carrier(
    crane: Constants, row: Momenta, axis: int, shape: Any, head: Head, place: Vector, pull: Vector
) -> Projected:
    """The same, with a trolley at this place and this force on it, which it moves by ``shape`` along an axis."""
    end = (0.0, shape, 0.0) if axis == 1 else (0.0, 0.0, shape)
    (px, py, pz), (mx, my, mz) = row
    mass, (x, y, z) = crane.trolley_mass, cross(place, end)
    carried = (px, py + mass * end[1], pz + mass * end[2]), (mx + mass * x, my + mass * y, mz + mass * z)
    return project_row(head, carried, end)._replace(force=shape * pull[axis])


def mass_matrix(crane: Constants, projected: list[Projected], shapes: list[Any]) -> list[list[Any]]:
    """Rows of the lower triangle of the mass matrix; ``shapes`` are those of the jib's modes at the trolley."""
    movers = crane.movers
    rows = []
    for i, own in enumerate(projected):
        # Tower, slewing and jib see each other through the head; what moves to the left and what does not do not.
        row = [
            crane.own_mass[i][m] + dot(own.row, crane.motions[:, m]) for m in range(min(i + 1, movers))
        ]  # fmt: skip
        for m in range(movers, i + 1):
            if crane.across(i) == crane.across(m):
                own_mass = crane.own_mass[i][m] + crane.rotary_mass[i][m]
                row.append(own_mass + crane.trolley_mass * shapes[i - movers] * shapes[m - movers])
            else:
                row.append(0.0)
        row[i] = row[i] + crane.cap[i]
        rows.append(row)
    return rows
