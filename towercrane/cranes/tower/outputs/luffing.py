"""What an engineer reads off a run of a crane whose jib pivots, beside what tower cranes have in common."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

from towercrane.cranes.tower.equations.constants import ROPE
from towercrane.cranes.tower.equations.luffing.hinge import Hinged, hinge, jib_part, luffing_of, pivot_of
from towercrane.cranes.tower.equations.luffing.motion import COMMANDED, HOLDING, TENSION
from towercrane.cranes.tower.equations.luffing.pivot import Pivot, foot_of
from towercrane.cranes.tower.equations.luffing.ropes import Held, hold, tied_at, way_to
from towercrane.cranes.tower.modes.mass_sums import Straight
from towercrane.cranes.tower.outputs import energy
from towercrane.cranes.tower.outputs.observed import OUTPUTS, Outputs, Sight
from towercrane.cranes.tower.outputs.sections import Sections
from towercrane.kernels.algebra import cross, dot, form
from towercrane.simulation.observed import About

if TYPE_CHECKING:
    from collections.abc import Callable, Collection

    from towercrane.cranes.tower.equations.body import Body, Carried
    from towercrane.cranes.tower.equations.luffing.constants import Luffing
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
        place, velocity = self.load_in_space
        kinetic = kinetic + energy.own_energy(self) + 0.5 * crane.load.mass * dot(velocity, velocity)

        modes, _ = jib_part(crane, self.state)
        bent = moment, *self.deflection(crane.jib_mass[crane.movers :], q)
        first = [mass * own + more for own, more in zip(foot.place, self.pivot.to_head(bent), strict=True)]
        first = [first[0] + x, first[1], first[2] + z]
        sagged = 0.5 * self.pivot.s * form(modes, own.weighted, modes)
        weight = dot(self.head.rows[2], first) - sagged
        potential = crane.self_gravity * weight + crane.gravity * crane.load.mass * place[2]
        return kinetic + potential + energy.elastic_energy(self) + self.held.energy


class LuffingSections(Sections):
    """What sections of a crane carry whose jib pivots."""

    at: LuffingSight

    @cached_property
    def tower_top(self) -> Body:
        """What is beyond the top of the tower: all that turns, and the load."""
        at, crane = self.at, self.at.seen.crane
        hinged = hinge(crane, self.head, at.state)
        body, place = hinged.body, hinged.end.place
        along_x, along_y, *_ = self.top
        top = self.head.to_head((along_x, along_y, 0.0))
        force = tuple(own - body.mass * a for own, a in zip(body.force, top, strict=True))
        moment = tuple(own - arm for own, arm in zip(body.moment, cross(body.first, top), strict=True))
        pull, couple = self.hung
        moved = self.accelerations[crane.movers :]
        momentum = (dot([row.momentum[k] for row in hinged.rows], moved) for k in range(3))
        moment_of_it = (dot([row.moment[k] for row in hinged.rows], moved) for k in range(3))
        x, y, z = (own + more - a for own, more, a in zip(force, pull, momentum, strict=True))
        turns = zip(moment, couple, cross(place, pull), moment_of_it, strict=True)
        rolling, pitching, turning = (own + more + arm - a for own, more, arm, a in turns)
        return body._replace(force=(x, y, z), moment=(rolling, pitching, turning))


Read = dict[str, tuple["Callable[[Any], Any]", About]]

OWN: Read = {
    "luffing_angle": (lambda at: at.state.coordinates[-1], About("rad", "angle of the jib's chord over the head")),
    "luffing_speed": (lambda at: at.state.rates[-1], About("rad/s", "rate of that angle")),
    "luffing_command": (
        lambda at: at.instant.drives[COMMANDED][0],
        About("rad", "angle at which the jib would stand, straight, if the luffing rope did not stretch"),
    ),
    "luffing_rope_tension": (
        lambda at: at.instant.guards[HOLDING], About("N", "tension of the luffing rope, all its falls together"),
    ),
    "rope_length": (lambda at: at.below[0], About("m", "length of rope below the jib's head")),
    "rope_tension": (
        lambda at: at.instant.guards[TENSION],
        About("N", "tension of the hoist's falls together; the winch feels that of one"),
    ),
    "jib_deflection": (
        lambda at: at.deflection(at.own.middle, at.state.coordinates)[1],
        About("m", "deflection of the jib's middle from the chord, positive up"),
    ),
    "total_energy": (lambda at: at.energies, About("J", "kinetic and potential energy")),
}  # fmt: skip

LEFT_OUT = (
    "trolley_position", "trolley_speed", "trolley_force", "jib_tip_deflection", "jib_root_moment",
    "jib_root_moment_sideways", "wind_x", "wind_y", "wind_z",
)  # fmt: skip
"""Outputs of cranes with a trolley that these have not."""

READ: Read = {**OWN, **{name: read for name, read in OUTPUTS.items() if name not in (*OWN, *LEFT_OUT)}}
"""How each output is read off and what it is."""


def outputs(seen: Seen, instant: Instant) -> Outputs:
    """Outputs at an instant."""
    return Outputs(LuffingSight(seen, instant), READ)


def names() -> Collection[str]:
    """Names of all outputs that runs of tower cranes may have."""
    return {**OUTPUTS, **OWN}.keys()
