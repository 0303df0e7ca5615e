"""What an engineer reads off a lumped crane: sway, moments, torques and energy."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cranes.parts.base import Reaction, added, base_about, base_outputs, rope_on_crane, together
from towercrane.cranes.parts.coupling import coupling_energy, coupling_torque
from towercrane.cranes.parts.points import Point, load_places, load_places_about, rope_about, turned_back
from towercrane.cranes.slewing.equations import AXES, ROPE, SHAFT, TENSION, drag_on, motion_of, turned, winds_of
from towercrane.kernels.algebra import dot
from towercrane.kernels.payload import state_of
from towercrane.simulation.observed import About

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from towercrane.cranes.parts.points import Carried
    from towercrane.cranes.slewing.description import LumpedCrane
    from towercrane.cranes.slewing.equations import Body, Constants
    from towercrane.kernels.algebra import Row
    from towercrane.kernels.load import Load
    from towercrane.simulation.observed import Instant

    Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False, slots=True)
class Linear:
    """Output that is linear in coordinates and rates."""

    name: str
    of: Floats
    of_rates: Floats


@dataclass(frozen=True, eq=False, slots=True)
class Spring:
    """Stiffness, and stretch as a linear form of the coordinates."""

    stiffness: float
    stretch: Floats


@dataclass(frozen=True, eq=False, slots=True)
class Seen:
    """The crane as its equations know it, its springs, names of its coordinates, which turns with the jib, and its
    counter moments by coordinate."""

    crane: Constants
    springs: tuple[Spring, ...]
    coordinates: tuple[str, ...]
    jib_angle: int
    linear: tuple[Linear, ...]
    counter_moments: Floats


def seen_of(crane: LumpedCrane, constants: Constants) -> Seen:
    """What outputs are told beside the instant."""
    springs = (Spring(spring.stiffness, crane.row(spring.stretch)[:-1]) for spring in crane.springs)
    linear = (
        Linear(name, crane.row(output.of)[:-1], crane.row(output.of_rates)[:-1])
        for name, output in crane.linear_outputs.items()
    )
    names, jib = crane.coordinates, crane.coordinates.index(crane.jib_angle)
    counter = crane.row(crane.counter_moments)[:-1]
    return Seen(constants, tuple(springs), names, jib, tuple(linear), counter)


WINDS = {f"wind_{axis}": About("m/s", f"wind along {axis}, at the load") for axis in "xyz"}


ORIGIN = "the slewing axis"

SWAYS = {
    "sway_tangential": About("rad", "sway across the jib, atan2(across, down), positive in the turning sense"),
    "sway_radial": About("rad", "sway along the jib, atan2(along, down), positive outward"),
}


def about_of(crane: LumpedCrane, load: Load, *, wind: bool = False) -> dict[str, About]:
    """What the outputs of a crane and its load are, and of a wind where one blows."""
    return {
        **SWAYS,
        "shaft_angle": About("rad", "angle of the drive's shaft, referred to the platform"),
        "shaft_speed": About("rad/s", "speed of the drive's shaft, referred to the platform"),
        "drive_torque": About("N m", "torque through the coupling with its damper, positive driving"),
        "drive_torque_elastic": About("N m", "torque of the coupling's spring alone, positive driving"),
        "rope_length": About("m", "length of the unstretched rope"),
        "hoist_rope_force": About("N", "rope tension"),
        **rope_about(load, ORIGIN, SWAYS),
        **{name: About(output.units, output.long_name) for name, output in crane.linear_outputs.items()},
        **{
            name: About("rad" if name in crane.angles else "m", f"coordinate: {name.replace('_', ' ')}")
            for name in crane.coordinates
        },
        **(WINDS if wind else {}),
        **base_about(),
        **load_places_about(ORIGIN),
        "total_energy": About("J", "kinetic and potential energy"),
        "input_work": About(
            "J", "work of shaft, winch and wind less what dampers, friction and drag took, since the start"
        ),
    }


def lumped_outputs(seen: Seen, instant: Instant) -> dict[str, Any]:
    """Outputs at an instant, see :func:`about_of`."""
    crane, drive = seen.crane, seen.crane.drive
    state = state_of(instant.state, len(seen.coordinates), AXES)
    (shaft, shaft_rate, _), (length, hauling, _) = instant.drives[SHAFT], instant.drives[ROPE]
    q, rates = state.coordinates, state.rates
    twist, heading = q[crane.driven] - shaft, q[seen.jib_angle]
    elastic = -coupling_torque(twist, drive.soft, drive.stiff, drive.corner)
    points = [point_of(body, q, rates) for body in crane.bodies]
    carried = points[crane.suspension].carry(crane.load, state, length, hauling, instant.guards)
    load = carried.load

    def sways(along: Row) -> dict[str, Any]:
        outward, sideways = turned_back(heading, along)
        return {
            "sway_tangential": np.arctan2(sideways, -along[2]),
            "sway_radial": np.arctan2(outward, -along[2]),
        }

    # What is in the coupling and the rope, and what the load has.
    energy = coupling_energy(twist, drive.soft, drive.stiff, drive.corner)
    energy = energy + carried.stored + carried.energy(crane.load, crane.gravity)
    return {
        **sways(carried.along),
        **carried.sling_sways(state, sways),
        "shaft_angle": shaft,
        "shaft_speed": shaft_rate,
        "drive_torque": elastic - drive.damping * (rates[crane.driven] - shaft_rate),
        "drive_torque_elastic": elastic,
        "rope_length": length,
        "hoist_rope_force": instant.guards[TENSION],
        **carried.shown,
        **{output.name: dot(output.of, q) + dot(output.of_rates, rates) for output in seen.linear},
        **dict(zip(seen.coordinates, q, strict=True)),
        **dict(zip(WINDS, winds_of(crane, instant.drives)[-1], strict=True)),
        **base_outputs(base_of(seen, instant, carried)),
        **load_places(load.place, heading),
        "total_energy": energy + structure_energy(seen, q, rates, points),
        "input_work": instant.state[-1],
    }


def base_of(seen: Seen, instant: Instant, carried: Carried) -> Reaction:
    """What the crane does to its base, the moment about the tower's foot: by the motion of every mass."""
    crane, count = seen.crane, len(seen.coordinates)
    state, moved = (state_of(rows, count, AXES) for rows in (instant.state, instant.slopes))
    q, rates, accelerations = state.coordinates, state.rates, moved.rates
    pushed = []
    for body, wind in zip(crane.bodies, winds_of(crane, instant.drives)[:-1], strict=True):
        motion = motion_of(body, q, rates)
        felt = [
            bias + dot([column[k] for column in motion.columns], accelerations)
            for k, bias in enumerate(motion.bias)
        ]  # fmt: skip
        air, weight = drag_on(body, motion, wind), (0.0, 0.0, crane.gravity)
        x, y, z = (f - body.mass * (a + g) for f, a, g in zip(air, felt, weight, strict=True))
        at = point_of(body, q, rates).place
        pushed.append(((at[0], at[1], at[2]), (x, y, z)))
    pull, couple = rope_on_crane(instant.guards[TENSION], *carried.rope)
    pushed.append((pushed[crane.suspension][0], pull))
    force, moment = together(pushed)
    moment = added(moment, couple, (0.0, 0.0, -dot(crane.inertia, accelerations)))
    for weight, angle in zip(seen.counter_moments, q, strict=True):
        # A weight behind the tower's axis tips it backward.
        moment = added(moment, (np.sin(angle) * weight, np.cos(angle) * -weight, 0.0))
    return Reaction(force, moment)


def structure_energy(seen: Seen, q: Any, rates: Any, points: Sequence[Point]) -> Any:
    """Kinetic and potential energy of the crane without coupling, rope and load [J]."""
    crane, energy = seen.crane, -dot(seen.crane.steady_force, q)
    for inertia, rate in zip(crane.inertia, rates, strict=True):
        energy = energy + 0.5 * inertia * rate * rate
    for spring in seen.springs:
        # A sum over the matrix of stiffness would cancel where the whole crane has turned.
        stretch = dot(spring.stretch, q)
        energy = energy + 0.5 * spring.stiffness * stretch * stretch
    for body, point in zip(crane.bodies, points, strict=True):
        energy = energy + point.energy(body.mass, crane.gravity)
    return energy


def point_of(body: Body, q: Any, rates: Any) -> Point:
    """Where a point mass is and how it moves."""
    x, y, vx, vy = 0.0, 0.0, 0.0, 0.0
    for arm in body.arms:
        angle, turning = (0.0, 0.0) if arm.turned_by is None else (q[arm.turned_by], rates[arm.turned_by])
        unit = np.cos(angle), np.sin(angle)
        ahead, across = turned(unit, dot(arm.ahead, (*q, 1.0)), dot(arm.across, (*q, 1.0)))
        growing = turned(unit, dot(arm.ahead, rates), dot(arm.across, rates))
        x, y = x + ahead, y + across
        vx, vy = vx + growing[0] - turning * across, vy + growing[1] + turning * ahead
    return Point([x, y, dot(body.height, (*q, 1.0))], [vx, vy, dot(body.height, rates)])
