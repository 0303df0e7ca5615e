"""Bending of jib and counter-jib in one direction, seen in the axes of the head that they are clamped to."""

from __future__ import annotations

from operator import add
from typing import TYPE_CHECKING, Any, NamedTuple

from towercrane.cranes.tower.equations.constants import TROLLEY
from towercrane.kernels.algebra import Vector, dot
from towercrane.kernels.choices import below, choose, nth
from towercrane.kernels.polynomial import polynomial

if TYPE_CHECKING:
    from towercrane.cranes.tower.equations.constants import Constants, Drives
    from towercrane.cranes.tower.equations.head import Head
    from towercrane.kernels.payload import State


class Section(NamedTuple):
    """A section of the jib: its first cell in the table of shapes, where it begins, and the width of its cells."""

    first: Any
    start: Any
    width: Any


class Trolley(NamedTuple):
    """Place of the trolley along the jib, its rate and acceleration; its section; its cell of the table of shapes and
    where in the cell it is."""

    x: Any
    rate: Any
    acceleration: Any
    section: Section
    cell: Any
    xi: Any


class Path(NamedTuple):
    """Bending in one direction at the trolley.

    Deflection, its rate, its acceleration without q'', its slope; shapes of the modes.
    """

    deflection: Any
    rate: Any
    bias: Any
    slope: Any
    shapes: list[Any]


class Sums(NamedTuple):
    """What the modes of one direction add up to.

    A = a.q and its rate, B = b.q and its rate; q.N q, q'.N q, and the same with the other direction's second q; with
    the sections' own rotary inertia int rho I theta.q and its rate.
    """

    first: Any = 0.0
    first_rate: Any = 0.0
    second: Any = 0.0
    second_rate: Any = 0.0
    own: Any = 0.0
    own_rate: Any = 0.0
    other: Any = 0.0
    other_rate: Any = 0.0
    turned: Any = 0.0
    turned_rate: Any = 0.0


class Bending(NamedTuple):
    """Sums over one direction; per mode its force, and N q with the other direction."""

    sums: Sums
    forces: list[Any]
    across: list[Any]


def trolley_of(crane: Constants, drives: Drives, section: Section | None = None) -> Trolley:
    """The trolley as its motion has it, on a section of the jib, without one on that where it is."""
    x, rate, acceleration = drives[TROLLEY]
    total = crane.shapes.shape[0]
    cells = total // (len(crane.sections) - 1)
    first, start, width = section = section or section_at(crane, x, cells)
    inside = nth((x - start) / width, cells)
    # Of a jib without joints the first cell is known.
    cell = nth(first + inside, total) if crane.jointed else inside
    return Trolley(x, rate, acceleration, section, cell, x - start - (inside + 0.5) * width)


def section_at(crane: Constants, x: Any, cells: int) -> Section:
    """Section of the jib at a position, each with so many cells; at a joint the outer one."""
    first, start, end = 0.0, 0.0, crane.sections[1]
    for number in range(1, len(crane.sections) - 1):
        joint, beyond = crane.sections[number : number + 2]
        inner = below(x, joint)
        first = choose(inner, first, float(number * cells))
        start, end = choose(inner, start, joint), choose(inner, end, beyond)
    return Section(first, start, (end - start) / cells)


def path_of(crane: Constants, modes: range, trolley: Trolley, state: State) -> Path:
    """Bending at the trolley in the direction of these modes."""
    xd, xdd, table = trolley.rate, trolley.acceleration, crane.shapes
    deflection, rate, bias, slope, shapes = 0.0, 0.0, 0.0, 0.0, []
    for i in modes:
        row = crane.row_of(i)
        if row is None:
            shapes.append(0.0)
            continue
        q, qd = state.coordinates[i], state.rates[i]
        terms = [table[trolley.cell, row, c] for c in range(table.shape[2])]
        shape, tangent, second = polynomial(terms, trolley.xi)
        deflection = deflection + shape * q
        rate = rate + (shape * qd + xd * tangent * q)
        bias = bias + (2.0 * xd * tangent * qd + (xdd * tangent + xd * xd * second) * q)
        slope = slope + tangent * q
        shapes.append(shape)
    return Path(deflection, rate, bias, slope, shapes)


def bend_jib(
    crane: Constants, own: range, other: range, side: float, spin: Vector, turning: tuple[Any, Any], weight: Any,
    state: State,
) -> Bending:  # fmt: skip
    """Bending in one direction.

    Parameters
    ----------
    own, other : range
        Coordinates of this direction and of the other.
    side : float
        -1 for the modes to the left, 1 for those up: their cross products differ by this sign.
    spin, turning : tuples of 3 and 2
        Angular velocity of the head about e1, about the axis along this direction and about the other; its angular
        acceleration while all rates are constant about e1 and, counted as it moves the jib this way, the other.
    weight : number
        Gravity along this direction [m/s^2].
    """
    (wx, own_spin, other_spin), (roll, turn) = spin, turning
    square_spin = wx * wx + own_spin * own_spin + other_spin * other_spin
    q, qd, sums, found = state.coordinates, state.rates, Sums(), Bending(Sums(), [], [])
    for i in own:
        mass = crane.own_mass[i]
        carried = dot([mass[m] for m in own], [q[m] for m in own])
        crossed, crossed_rate = (dot([mass[m] for m in other], [values[m] for m in other]) for values in (q, qd))
        a, b, turned = crane.jib_mass[i], crane.jib_moment[i], crane.jib_turning[i]
        parts = (
            a * q[i], a * qd[i], b * q[i], b * qd[i],
            carried * q[i], carried * qd[i], crossed * q[i], crossed * qd[i], turned * q[i], turned * qd[i],
        )  # fmt: skip
        sums = Sums(*map(add, sums, parts))
        along = wx * b + own_spin * carried + other_spin * crossed
        inertia = turn * (b + turned) + own_spin * along - square_spin * carried
        inertia = inertia + side * (roll * crossed + 2.0 * wx * crossed_rate)
        found.forces.append(-inertia - a * weight)
        found.across.append(crossed)
    return found._replace(sums=sums)


def bend(crane: Constants, head: Head, felt: Vector, state: State) -> tuple[Bending, Bending]:
    """Bending to the left and up; felt is the acceleration against gravity of the tower's top."""
    (wx, wy, wz), (roll, pitch, turn), (_, left, up) = head.spin, head.spin_bias, felt
    lateral, vertical = crane.lateral, crane.vertical
    return (
        bend_jib(crane, lateral, vertical, -1.0, (wx, wy, wz), (roll, turn), left, state),
        bend_jib(crane, vertical, lateral, 1.0, (wx, wz, wy), (roll, -pitch), up, state),
    )
