"""Equations of lumped cranes: point masses on chains of turned arms, springs, a drive and friction.

The horizontal position of a point is a sum of arms, each of which turns about the vertical with one of the
coordinates: in complex notation W = sum exp(i phi) (a + i b) with a and b linear in the coordinates. Its height is
linear in them. With e = exp(i phi) an arm r = a + i b gives the columns e dr/dq and i e r, and the bias acceleration
e (2 i phi' r' - phi'^2 r). Marinovic, Sprecic and Jerman (2012), Eq. 2-13, are of this kind.

The load is not in this file: :func:`towercrane.kernels.hanging.hang_load` adds it.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from towercrane.cranes.parts.air import air_at, load_force
from towercrane.cranes.parts.coupling import coupling_torque
from towercrane.cranes.parts.friction import BY_RATE, held, holding, slip
from towercrane.kernels.algebra import Row, Vector, dot
from towercrane.kernels.hanging import hang_load
from towercrane.kernels.payload import Rope, Structure, slopes, state_of
from towercrane.kernels.polynomial import polynomial
from towercrane.kernels.straight.leaves import CHANGING

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from towercrane.cranes.slewing.description import Drive
    from towercrane.kernels.load import Load

    Floats = NDArray[np.float64]
    Pair = tuple[Any, Any]

SHAFT, ROPE = range(2)
"""Rows of ``inputs``."""

TENSION, INSIDE, OUTSIDE, SLIDING, HOLDING, NEEDED = range(6)
"""Guards: rope tension [N]; way to the drive's corner from inside and from outside [rad]; rate in the direction of
slip [rad/s]; torque that friction can still take, and the torque that holds the coordinate at rest [N m]."""

AXES = 3


@dataclass(frozen=True, eq=False, slots=True)
class Arm:
    """Linear forms of the coordinates along an arm and to its left, their constants last; what turns it, if any."""

    turned_by: int | None
    ahead: Floats
    across: Floats


@dataclass(frozen=True, eq=False, slots=True)
class Body:
    """A point mass: drag per squared speed along its last arm, across it and up; height as a linear form."""

    mass: float
    drag: Floats
    arms: tuple[Arm, ...]
    height: Floats


@dataclass(frozen=True, eq=False, slots=True)
class Constants:
    """Matrices and vectors are those of the n coordinates; ``driven`` is the one that drive and friction act on.

    ``wind`` is the number of places that see a wind of their own: one for all, or every point and the load.
    """

    bodies: tuple[Body, ...]
    suspension: int
    inertia: Floats
    steady_force: Floats
    stiffness: Floats
    damping: Floats
    driven: int
    drive: Drive
    gravity: float
    load: Load
    wind: int
    friction_state: float = field(default=BY_RATE, metadata=CHANGING)


class Motion(NamedTuple):
    """Of a point: velocity, bias acceleration, what a rate of each coordinate moves it, direction of its last arm."""

    velocity: Sequence[Any]
    bias: Sequence[Any]
    columns: list[tuple[Any, ...]]
    unit: Pair


def turned(unit: Pair, ahead: Any, across: Any) -> Pair:
    """Product of two complex numbers."""
    return unit[0] * ahead - unit[1] * across, unit[1] * ahead + unit[0] * across


def motion_of(body: Body, q: Any, rates: Any) -> Motion:
    """How a point moves."""
    unit, total = (1.0, 0.0), [(0.0, 0.0)] * (2 + len(q))
    for arm in body.arms:
        angle, turning = (0.0, 0.0) if arm.turned_by is None else (q[arm.turned_by], rates[arm.turned_by])
        unit = np.cos(angle), np.sin(angle)
        a, b = dot(arm.ahead, (*q, 1.0)), dot(arm.across, (*q, 1.0))
        da, db = dot(arm.ahead, rates), dot(arm.across, rates)
        parts = [
            (da - turning * b, db + turning * a),
            (-2.0 * turning * db - turning * turning * a, 2.0 * turning * da - turning * turning * b),
        ]
        for i, (ahead, across) in enumerate(zip(arm.ahead[:-1], arm.across[:-1], strict=True)):
            parts.append((ahead - b, across + a) if i == arm.turned_by else (ahead, across))
        total = [
            (x + ahead, y + across)
            for (x, y), (ahead, across) in zip(total, (turned(unit, *part) for part in parts), strict=True)
        ]
    velocity, bias, *columns = total
    return Motion(
        (*velocity, dot(body.height, rates)),
        (*bias, 0.0),
        [(*column, up) for column, up in zip(columns, body.height, strict=False)],
        unit,
    )


def winds_of(crane: Constants, drives: Row) -> list[Vector]:
    """Velocity of the air at every point, and at the load."""
    found = air_at(crane.wind, drives)
    return found if len(found) > 1 else found * (len(crane.bodies) + 1)


def place_of(body: Body, q: Any) -> list[Any]:
    """Where a point is."""
    x, y = 0.0, 0.0
    for arm in body.arms:
        unit = (1.0, 0.0) if arm.turned_by is None else (np.cos(q[arm.turned_by]), np.sin(q[arm.turned_by]))
        ahead, across = turned(unit, dot(arm.ahead, (*q, 1.0)), dot(arm.across, (*q, 1.0)))
        x, y = x + ahead, y + across
    return [x, y, dot(body.height, (*q, 1.0))]


def drag_on(body: Body, motion: Motion, wind: Vector) -> Sequence[Any]:
    """Force of the air on a point."""
    cosine, sine = motion.unit
    through = vx, vy, vz = [own - air for own, air in zip(motion.velocity, wind, strict=True)]
    speed = np.sqrt(dot(through, through))
    ahead, aside, up = (-drag * speed for drag in body.drag)
    along, across = turned((cosine, -sine), vx, vy)
    return *turned(motion.unit, ahead * along, aside * across), up * vz


def structure(
    crane: Constants, q: Any, rates: Any, shaft: Pair, winds: Sequence[Vector], friction: Any = 0.0
) -> tuple[Structure, Any]:
    """Crane without its load, the shaft at an angle and a rate; power of shaft, dampers, air and friction [W]."""
    force, power = list(crane.steady_force), 0.0
    for i, (springs, dampers) in enumerate(zip(crane.stiffness, crane.damping, strict=True)):
        for spring, damper, own, rate in zip(springs, dampers, q, rates, strict=True):
            force[i] = force[i] - (spring * own + damper * rate)
            power = power - rates[i] * damper * rate
    mass = [[0.0] * i + [inertia] for i, inertia in enumerate(crane.inertia)]
    motions = [motion_of(body, q, rates) for body in crane.bodies]
    for body, motion, wind in zip(crane.bodies, motions, winds[:-1], strict=True):
        air, gravity = drag_on(body, motion, wind), (0.0, 0.0, crane.gravity)
        power = power + dot(air, motion.velocity)
        pull = [f - body.mass * (b + g) for f, b, g in zip(air, motion.bias, gravity, strict=True)]
        for i, column in enumerate(motion.columns):
            force[i] = force[i] + dot(column, pull)
            carried = [body.mass * moved for moved in column]
            mass[i] = [own + dot(carried, other) for own, other in zip(mass[i], motion.columns, strict=False)]

    drive, driven = crane.drive, crane.driven
    twist, slip = q[driven] - shaft[0], rates[driven] - shaft[1]
    torque = -coupling_torque(twist, drive.soft, drive.stiff, drive.corner) - drive.damping * slip
    force[driven] = force[driven] + torque + friction
    # What the shaft puts in is stored in the coupling, turns the platform or is lost between them and in its bearing.
    power = power + torque * shaft[1] - drive.damping * slip * slip + friction * rates[driven]
    tip = motions[crane.suspension]
    place, jacobian = place_of(crane.bodies[crane.suspension], q), list(zip(*tip.columns, strict=True))
    return Structure(mass, force, place, tip.velocity, tip.bias, jacobian, winds[-1]), power


def forces_at_rest(crane: Constants, _t: Any, q: Any, inputs: Any) -> tuple[list[Any], list[Any]]:
    """Forces on the coordinates while nothing moves, friction apart, the load hanging at rest; no guards."""
    winds = winds_of(crane, inputs)
    bare, _ = structure(crane, q, [0.0] * len(q), (inputs[SHAFT][0], 0.0), winds)
    pull, columns = load_force(crane.load, crane.gravity, winds[-1]), zip(*bare.jacobian, strict=True)
    return [force + dot(column, pull) for force, column in zip(bare.force, columns, strict=True)], []


def equations(crane: Constants, t: Any, y: Any, inputs: Any) -> tuple[list[Any], list[Any]]:
    """Slopes of the state (q, n, q', p, work), and guards."""
    state = state_of(y, len(crane.inertia), AXES)
    rope = Rope(*polynomial(inputs[ROPE], t))
    angle, shaft_rate, _ = polynomial(inputs[SHAFT], t)
    drive, driven = crane.drive, crane.driven
    rate, limit = state.rates[driven], drive.friction_torque
    way, sticks, set_valued = 0.0, 0.0, drive.friction == "stick-slip"
    if drive.friction == "tanh":
        way = np.tanh(rate / drive.friction_rate)
    elif set_valued:
        way, sticks = slip(crane.friction_state, rate)
    winds = winds_of(crane, [polynomial(channel, t) for channel in inputs])
    bare, power = structure(crane, state.coordinates, state.rates, (angle, shaft_rate), winds, -limit * way)
    hung = hang_load(held(bare, driven, sticks), state, rope, crane.load, crane.gravity)
    beyond = abs(state.coordinates[driven] - angle) - drive.corner
    return slopes(state, hung, hung.power + power), [
        hung.tension, -beyond, beyond,
        *(holding(bare, driven, hung, sticks, way * rate, limit) if set_valued else (np.inf, np.inf, 0.0)),
        *hung.guards,
    ]  # fmt: skip
