"""What an engineer reads off a jib crane: sway, torques, tension and energy."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cranes.jib.equations import AXES, JOINTS, PLAN, ROPE, TENSION, TORQUE, Constants, structure
from towercrane.cranes.parts.base import (
    NONE,
    Reaction,
    added,
    base_about,
    base_outputs,
    rope_on_crane,
    together,
)
from towercrane.cranes.parts.points import Point, load_places, load_places_about, turned_back
from towercrane.kernels.algebra import Row, Vector, cross, dot
from towercrane.kernels.payload import state_of
from towercrane.simulation.observed import About

if TYPE_CHECKING:
    from towercrane.cranes.jib.parameters import JibCrane
    from towercrane.kernels.payload import State
    from towercrane.simulation.observed import Instant

ORIGIN = "the post's foot"

SWAYS = {
    "sway_in_plane": About(
        "rad",
        "swing in the booms' vertical plane, positive outward: atan2(n.e_r, -n_z) of the rope's direction n, "
        "e_r the horizontal direction of the booms",
    ),
    "sway_lateral": About(
        "rad",
        "swing out of the booms' vertical plane, positive towards growing slew: atan2(n.e_t, hypot(n.e_r, n_z)) of "
        "the rope's direction n, e_t the horizontal normal of that plane",
    ),
}

ABOUT = {
    "joint_angle": About(
        "rad",
        "slew about the vertical; elevation of the primary boom; the secondary boom's elevation from it",
        ("joint",),
        JOINTS,
    ),
    "rope_length": About("m", "rope length"),
    **SWAYS,
    "joint_torque": About("N m", "torque of each joint's drive; at a jump the right limit", ("joint",), JOINTS),
    "hoist_rope_force": About("N", "rope tension"),
    **base_about(),
    **load_places_about(ORIGIN),
    "total_energy": About("J", "kinetic and potential energy, zero level at the post's foot"),
    "input_work": About("J", "work of joints and winch less what damping and drag took, since the start"),
}
"""What the outputs are."""

TRACKING_ABOUT = {
    **ABOUT,
    "joint_error": About("rad", "joint angles less those of the plan", ("joint",), JOINTS),
}
"""What the outputs of a crane that follows a plan are."""

SWAY_ABOUT = {
    "sway_in_plane": About("rad", "small swing in the booms' plane, outward"),
    "sway_lateral": About("rad", "small swing towards growing slew"),
}
"""What the outputs of linear sway are."""


@dataclass(frozen=True, slots=True)
class Seen:
    """The crane as its equations know it."""

    crane: Constants


def planned_outputs(seen: Seen, instant: Instant) -> dict[str, Any]:
    """Outputs of a crane on its plan, see :data:`ABOUT`."""
    angles, rates, accelerations = zip(*instant.drives[:JOINTS], strict=True)
    state = state_of(instant.state, 0, AXES)._replace(coordinates=angles, rates=rates)
    return _outputs(seen.crane, instant, state, accelerations, instant.state[-1])


def driven_outputs(seen: Seen, instant: Instant) -> dict[str, Any]:
    """Outputs of a crane under torques, see :data:`ABOUT`."""
    own = instant.state[:PLAN]
    moved = state_of(instant.slopes[:PLAN], JOINTS, AXES).rates
    return _outputs(seen.crane, instant, state_of(own, JOINTS, AXES), moved, own[-1])


def tracking_outputs(seen: Seen, instant: Instant) -> dict[str, Any]:
    """Outputs of a crane under the torques of its plan, see :data:`TRACKING_ABOUT`."""
    found = driven_outputs(seen, instant)
    late = [own - plan for own, (plan, _, _) in zip(found["joint_angle"], instant.drives[:JOINTS], strict=True)]
    return {**found, "joint_error": late}


def sway_outputs(_seen: Seen, instant: Instant) -> dict[str, Any]:
    """Outputs of linear sway, see :data:`SWAY_ABOUT`."""
    return dict(zip(SWAY_ABOUT, turned_back(instant.drives[0][0], instant.state), strict=True))


def _outputs(own: Constants, instant: Instant, state: State, accelerations: Any, work: Any) -> dict[str, Any]:
    """Outputs of joints and rope in a state, with the joints' accelerations and the work put in."""
    crane, angles, (length, hauling, _) = own.crane, state.coordinates, instant.drives[ROPE]
    suspension, energy = survey(crane, angles, state.rates)
    carried = suspension.carry(own.load, state, length, hauling, instant.guards)
    tension = instant.guards[TENSION]

    def sways(along: Row) -> dict[str, Any]:
        (outward, sideways), down = turned_back(angles[0], along), -along[2]
        return {
            "sway_in_plane": np.arctan2(outward, down),
            "sway_lateral": np.arctan2(sideways, np.sqrt(outward * outward + down * down)),
        }

    pull, couple = rope_on_crane(tension, *carried.rope)
    base = base_of(crane, state, accelerations, pull)
    return {
        "joint_angle": [*angles],
        "rope_length": length,
        **sways(carried.along),
        **carried.sling_sways(state, sways),
        "joint_torque": [*instant.guards[TORQUE : TORQUE + JOINTS]],
        "hoist_rope_force": tension,
        **carried.shown,
        **base_outputs(base._replace(moment=added(base.moment, couple))),
        **load_places(carried.load.place, angles[0]),
        "total_energy": energy + carried.energy(own.load, crane.gravity) + carried.stored,
        "input_work": work,
    }


def base_of(crane: JibCrane, state: State, accelerations: Any, pull: Vector) -> Reaction:
    """What booms and a force at their end do to the base, the moment about the post's foot; the post has no weight.

    Parameters
    ----------
    crane : JibCrane
    state : State
        Of the joints.
    accelerations : sequence of 3
        Of the joints [rad/s^2].
    pull : sequence of 3
        Force at the end of the booms [N].
    """
    (slew, luff, fold), (turning, luffing, folding), (slewed, luffed, folded) = (
        state.coordinates, state.rates, accelerations,
    )  # fmt: skip
    c, s = np.cos(slew), np.sin(slew)
    place, felt, pushed, moment = (0.0, 0.0, crane.post_height), (0.0, 0.0, crane.gravity), [], NONE
    for mass, length, angle, rate, acceleration in (
        (crane.primary_mass, crane.primary_length, luff, luffing, luffed),
        (crane.secondary_mass, crane.secondary_length, luff + fold, luffing + folding, luffed + folded),
    ):
        # A boom's points are at p + x d and feel p'' + g + x d'': outward, to the left, up.
        flat, rise = np.cos(angle), np.sin(angle)
        outward = -flat * (rate * rate + turning * turning) - rise * acceleration
        left = flat * slewed - 2.0 * rise * rate * turning
        along = length * flat * c, length * flat * s, length * rise
        moved = (
            length * (outward * c - left * s), length * (outward * s + left * c),
            length * (flat * acceleration - rise * rate * rate),
        )  # fmt: skip
        middle, at_middle = (
            added(own, (0.5 * x, 0.5 * y, 0.5 * z)) for own, (x, y, z) in ((place, along), (felt, moved))
        )
        x, y, z = at_middle
        pushed.append((middle, (-mass * x, -mass * y, -mass * z)))
        x, y, z = cross(along, moved)
        own = mass / 12.0
        moment = added(moment, (-own * x, -own * y, -own * z))
        place, felt = added(place, along), added(felt, moved)
    base = together([*pushed, (place, pull)])
    return Reaction(base.force, added(base.moment, moment, (0.0, 0.0, -crane.post_inertia * slewed)))


def survey(crane: JibCrane, angles: Any, rates: Any) -> tuple[Point, Any]:
    """Suspension point, and kinetic and potential energy of post and booms [J]; zero is at the post's foot.

    Parameters
    ----------
    crane : JibCrane
    angles, rates : sequence of 3
        Joint angles [rad] and rates [rad/s].
    """
    booms = structure(crane, angles, rates)
    primary = crane.primary_length * np.sin(angles[1])
    secondary = crane.secondary_length * np.sin(angles[1] + angles[2])
    middles = crane.post_height + 0.5 * primary, crane.post_height + primary + 0.5 * secondary
    energy = crane.gravity * dot((crane.primary_mass, crane.secondary_mass), middles)
    for i, row in enumerate(booms.mass):
        energy = energy + rates[i] * (dot(row, rates) - 0.5 * row[i] * rates[i])
    # A rate of slewing moves the point across where it is.
    place = [booms.jacobian[1][0], -booms.jacobian[0][0], crane.post_height + primary + secondary]
    return Point(place, booms.velocity), energy
