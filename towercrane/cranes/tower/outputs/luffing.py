"""What an engineer reads off a run of a crane whose jib pivots, beside what tower cranes have in common."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cranes.tower.equations.constants import ROPE
from towercrane.cranes.tower.equations.luffing.hinge import Hinged, hinge, jib_part, luffing_of, pivot_of
from towercrane.cranes.tower.equations.luffing.motion import COMMANDED, HOLDING, TENSION
from towercrane.cranes.tower.equations.luffing.pivot import Pivot, foot_of, pivot_at
from towercrane.cranes.tower.equations.luffing.ropes import Held, hold, tied_at, way_to
from towercrane.cranes.tower.equations.luffing.wind import Blown, blow
from towercrane.cranes.tower.modes.mass_sums import Straight
from towercrane.cranes.tower.outputs import energy, tied
from towercrane.cranes.tower.outputs.observed import ORIGIN, OUTPUTS, TURNING_AXES, Outputs, Sight
from towercrane.cranes.tower.outputs.sections import Sections
from towercrane.kernels.algebra import Vector, cross, dot, form
from towercrane.simulation.observed import About

if TYPE_CHECKING:
    from collections.abc import Callable, Collection

    from towercrane.cranes.tower.equations.body import Body, Carried
    from towercrane.cranes.tower.equations.luffing.constants import Luffing
    from towercrane.cranes.tower.equations.luffing.pivot import Coupled
    from towercrane.cranes.tower.outputs.cut_sums import JibCut
    from towercrane.cranes.tower.outputs.kinematics import Pair
    from towercrane.cranes.tower.outputs.seen import Seen
    from towercrane.simulation.observed import Instant


class LuffingSight(Sight):
    """What outputs are read off."""

    @cached_property
    def own(self) -> Luffing:
        """What is known of the jib's pivot."""
        return luffing_of(self.seen.crane)

    @cached_property
    def pivot(self) -> Pivot:
        """The jib as its coordinate has it."""
        return pivot_of(self.seen.crane, self.state)

    @cached_property
    def hinged(self) -> Hinged:
        """Jib and head."""
        return hinge(self.seen.crane, self.head, self.state)

    @cached_property
    def end(self) -> Carried:
        """The sheave that the rope hangs from, in the head's axes."""
        return self.hinged.end

    @cached_property
    def below(self) -> Pair:
        """Length of the rope to the load and its rate."""
        (length, hauling, _), own = self.instant.drives[ROPE], self.own
        way = way_to(own, own.winch, tied_at(own, *jib_part(self.seen.crane, self.state), 0.0), self.pivot)
        return length - (way.length - own.reference_way) / own.falls, hauling - way.rate / own.falls

    @cached_property
    def commanded(self) -> Vector:
        """Where the load would hang if the jib stood straight as its winch is told and the crane did not give."""
        own, (angle, _, _), (length, _, _) = self.own, self.instant.drives[COMMANDED], self.instant.drives[ROPE]
        x, _, z = pivot_at(angle).to_head((own.length, 0.0, 0.0))
        x, z = own.foot[0] + x, own.foot[1] + z
        way = np.sqrt((x - own.winch[0]) ** 2 + (z - own.winch[1]) ** 2)
        return x, 0.0 * x, z - length + (way - own.reference_way) / own.falls

    @cached_property
    def held(self) -> Held:
        """The luffing rope."""
        own, (q, qd) = self.own, jib_part(self.seen.crane, self.state)
        way = way_to(own, own.frame_head, tied_at(own, q, qd, own.attachment), self.pivot)
        return hold(own, way, self.pivot, self.instant.drives[COMMANDED])

    @cached_property
    def sections(self) -> LuffingSections:
        """What sections carry."""
        return LuffingSections(self)

    @cached_property
    def energies(self) -> Any:
        """Kinetic and potential energy, zero level at the undeformed tower top [J]."""
        crane, own, q = self.seen.crane, self.own, self.state.coordinates
        frame, foot = foot_of(self.head, self.pivot, own.foot)
        mass, moment, inertia = own.jib
        kinetic = energy.turning_energy(self, frame, Straight(mass, moment, 0.0, inertia, inertia))
        (x, z), (ixx, iyy, izz, ixz), (wx, wy, wz) = own.rest_first, own.rest_inertia, self.head.spin
        swept = cross(self.head.spin, (x, 0.0, z))
        kinetic = kinetic + 0.5 * own.rest_mass * dot(self.head.top, self.head.top) + dot(self.head.top, swept)
        kinetic = kinetic + 0.5 * (ixx * wx * wx + iyy * wy * wy + izz * wz * wz) + ixz * wx * wz
        kinetic = kinetic + energy.own_energy(self)
        for own_mass, (_, velocity) in self.hung:
            kinetic = kinetic + 0.5 * own_mass * dot(velocity, velocity)

        modes, _ = jib_part(crane, self.state)
        bent = moment, *self.deflection(crane.jib_mass[crane.movers :], q)
        first = [mass * own + more for own, more in zip(foot.place, self.pivot.to_head(bent), strict=True)]
        first = [first[0] + x, first[1], first[2] + z]
        sagged = 0.5 * self.pivot.s * form(modes, own.weighted, modes)
        weight = dot(self.head.rows[2], first) - sagged
        potential = crane.self_gravity * weight
        for own_mass, (place, _) in self.hung:
            potential = potential + crane.gravity * own_mass * place[2]
        return kinetic + potential + energy.elastic_energy(self) + self.held.energy


class LuffingSections(Sections):
    """What sections of a crane carry whose jib pivots."""

    at: LuffingSight

    @cached_property
    def hinged(self) -> Hinged:
        """Jib and head, the head with its whole angular acceleration."""
        return hinge(self.at.seen.crane, self.head, self.at.state)

    @cached_property
    def top_acceleration(self) -> Vector:
        """That of the tower's top, in the head's axes."""
        along_x, along_y, *_ = self.top
        return self.head.to_head((along_x, along_y, 0.0))

    @cached_property
    def tower_top(self) -> Body:
        """What is beyond the top of the tower: all that turns, and the load."""
        body = self._moving(self.hinged.body, self.hinged.rows, self.top_acceleration)
        pull, couple = self.hung
        body = body.pushed(pull, sum_of(cross(self.hinged.end.place, pull), couple))
        return body if self.blown_on is None else body.pushed(*self.blown_on.turning)

    @cached_property
    def blown_on(self) -> Blown | None:
        """Forces of the wind, where one blows."""
        at = self.at
        return blow(at.seen.crane, at.state, at.head, at.winds) if at.seen.crane.wind else None

    @cached_property
    def foot(self) -> Body:
        """What is beyond the jib's foot, with both ropes: about the foot along the jib's axes."""
        return self._held(self.hinged)

    def beyond(self, cut: JibCut) -> tuple[Vector, Vector]:
        """Force and moment of all that is beyond a section of the jib, about its foot along its axes."""
        crane, sums = self.at.seen.crane, cut.beyond
        own, rest = self.at.own, [0.0] * crane.movers
        straight: Any = sums.mass, sums.moment, sums.pitch
        # The equations' own sums, of less of the jib.
        less: dict[str, Any] = {
            "jib_mass": [*rest, *sums.first, 0.0],
            "jib_moment": [*rest, *sums.second, 0.0],
            "own_mass": [*(rest for _ in rest), *([*rest, *row, 0.0] for row in sums.products)],
            "luffing": replace(own, jib=straight),
        }
        body = self._held(hinge(replace(crane, **less), self.head, self.at.state))
        return body.force, body.moment

    def _held(self, hinged: Hinged) -> Body:
        """A jib on its hinge, or what of it is beyond a section, with all ropes at its head."""
        at, own, pivot = self.at, self.at.own, self.at.pivot
        jib = self._moving(hinged.jib, hinged.jib_rows, pivot.to_jib(self.top_acceleration))
        q, qd = jib_part(at.seen.crane, at.state)
        pull, couple = self.hung
        held = [(tied_at(own, q, qd, 0.0).place, pivot.to_jib(pull))]
        for anchor, above, tension in (
            (own.winch, 0.0, at.instant.guards[TENSION] / own.falls),
            (own.frame_head, own.attachment, at.instant.guards[HOLDING]),
        ):
            tied = tied_at(own, q, qd, above)
            x, y, z = way_to(own, anchor, tied, pivot).direction
            held.append((tied.place, (-tension * x, -tension * y, -tension * z)))
        for place, force in held:
            jib = jib.pushed(force, cross(place, force))
        jib = jib.pushed((0.0, 0.0, 0.0), pivot.to_jib(couple))
        return jib if self.blown_on is None else jib.pushed(*self.blown_on.jib)

    def _moving(self, body: Body, rows: list[Coupled], top: Vector) -> Body:
        """A body with the inertia of all accelerations, that of the tower's top along its own axes."""
        moved = self.accelerations[self.at.seen.crane.movers : self.at.seen.crane.coordinates]
        (x, y, z), (u, v, w) = (
            (dot([row[k][0] for row in rows], moved), dot([row[k][1] for row in rows], moved),
             dot([row[k][2] for row in rows], moved))
            for k in (0, 1)
        )  # fmt: skip
        arm, mass = cross(body.first, top), body.mass
        force = -(x + mass * top[0]), -(y + mass * top[1]), -(z + mass * top[2])
        return body.pushed(force, (-(u + arm[0]), -(v + arm[1]), -(w + arm[2])))


def sum_of(one: Vector, other: Vector) -> Vector:
    """Sum of two vectors."""
    return one[0] + other[0], one[1] + other[1], one[2] + other[2]


Read = dict[str, tuple["Callable[[Any], Any]", About]]

OWN: Read = {
    "luffing_angle": (lambda at: at.state.coordinates[-1], About("rad", "angle of the jib's chord over the head")),
    "luffing_speed": (lambda at: at.state.rates[-1], About("rad/s", "rate of that angle")),
    "luffing_command": (
        lambda at: at.instant.drives[COMMANDED][0],
        About("rad", "angle at which the jib would stand, straight, if the luffing rope did not stretch"),
    ),
    "luffing_rope_force": (
        lambda at: at.instant.guards[HOLDING], About("N", "tension of the luffing rope, all its falls together"),
    ),
    "rope_length": (lambda at: at.below[0], About("m", "length of rope below the jib's head")),
    "hoist_rope_force": (
        lambda at: at.instant.guards[TENSION],
        About("N", "tension of the hoist's falls together; the winch feels that of one"),
    ),
    "jib_deflection": (
        lambda at: at.deflection(at.own.middle, at.state.coordinates)[1],
        About("m", "deflection of the jib's middle from the chord, positive up"),
    ),
    "jib_compression": (
        lambda at: -at.sections.foot.force[0],
        About("N", "force along the chord by which the jib presses on its foot"),
    ),
    "jib_root_moment_sideways": (
        lambda at: -at.sections.foot.moment[2],
        About("N m", "bending moment at the jib's foot, positive where it speeds the jib up in the turning sense"),
    ),
    "commanded_place": (
        lambda at: at.commanded,
        About(
            "m", f"where the load would hang on a rigid crane at rest, from {ORIGIN}: {TURNING_AXES}", ("axis",), 3
        ),
    ),
    "total_energy": (lambda at: at.energies, About("J", "kinetic and potential energy")),
}  # fmt: skip

LEFT_OUT = (
    "trolley_position", "trolley_speed", "trolley_force", "jib_tip_deflection", "jib_root_moment",
)  # fmt: skip
"""Outputs of cranes with a trolley that these have not."""

READ: Read = {**OWN, **{name: read for name, read in OUTPUTS.items() if name not in (*OWN, *LEFT_OUT)}}
"""How each output is read off and what it is."""


def outputs(seen: Seen, instant: Instant) -> Outputs:
    """Outputs at an instant."""
    return Outputs(LuffingSight(seen, instant), READ)


def names() -> Collection[str]:
    """Names of all outputs that runs of tower cranes may have."""
    return {**OUTPUTS, **OWN, **tied.OWN}.keys()
