"""Forces and moments in sections of a flexible crane: root of the jib, top of the tower.

They follow from the acceleration of every mass beyond the section (d'Alembert), not from curvatures, which need many
more modes for the same accuracy. Weights act where the deflected crane carries them.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from itertools import chain
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

from towercrane.cranes.parts.base import rope_on_crane
from towercrane.cranes.parts.points import rope_seen
from towercrane.cranes.tower.equations.actions.wind import pressures
from towercrane.cranes.tower.equations.body import Body, body_of
from towercrane.cranes.tower.equations.jib import Sums
from towercrane.cranes.tower.equations.motion import TENSION
from towercrane.kernels.algebra import Row, Vector, dot, form
from towercrane.kernels.choices import below, choose

if TYPE_CHECKING:
    from collections.abc import Sequence

    from towercrane.cranes.tower.equations.head import Head
    from towercrane.cranes.tower.modes.mass_sums import MassSums
    from towercrane.cranes.tower.outputs.cut_sums import JibCut
    from towercrane.cranes.tower.outputs.kinematics import Kinematics

NONE = 0.0, 0.0, 0.0


class Swept(NamedTuple):
    """What modes of one direction move of a part of the jib.

    Sums of m, of m x, of m times the deflection this way, and of m times that the other way; of the sections' own
    rotary inertia times their turning.
    """

    zeroth: Any
    first: Any
    own: Any
    other: Any
    turned: Any


@dataclass(frozen=True, eq=False)
class Sections:
    """What sections carry: force and moment by the part beyond, in the head's axes, moments about the tower's top.

    Parameters
    ----------
    at : Kinematics
        With the slopes and guards of its instant.
    """

    at: Kinematics

    @cached_property
    def accelerations(self) -> Row:
        """Second derivatives of the structural coordinates."""
        return self.at.parts(self.at.instant.slopes).rates

    @cached_property
    def top(self) -> list[Any]:
        """Those of the tower's top."""
        return self.at.top(self.accelerations)

    @cached_property
    def head(self) -> Head:
        """The head, with its whole angular acceleration as bias."""
        head = self.at.head
        *_, tilt_x, tilt_y, turn = self.top
        turned = zip(head.spin_bias, head.turn_x, head.turn_y, (0.0, 0.0, turn), strict=True)
        x, y, z = (bias + tilt_x * along_x + tilt_y * along_y + own for bias, along_x, along_y, own in turned)
        return head._replace(spin_bias=(x, y, z))

    def felt(self, gravity: Any) -> Vector:
        """Acceleration of the tower's top against gravity, with that of the ground."""
        (along_x, along_y, *_), (x, y, z) = self.top, self.at.ground.acceleration
        own = self.head.to_head((along_x + x, along_y + y, z))
        x, y, z = (a + gravity * down for a, down in zip(own, self.head.rows[2], strict=True))
        return x, y, z

    def swept(self, part: MassSums, values: Row) -> tuple[Swept, Swept]:
        """Sums with coordinates or their derivatives, to the left and up."""
        (left, up), (q_left, q_up) = self.at.of_jib(values), self.at.of_jib(self.at.state.coordinates)
        sides, rise = (slice(len(left)), slice(len(left), None))

        def of(moved: Row, own: slice, q: Row, other: slice, q_other: Row) -> Swept:
            rows = part.products[own]
            crossed = form(moved, rows[:, own], q), form(moved, rows[:, other], q_other)
            along, turned = (dot(moved, sums[own]) for sums in (part.second, part.turned))
            return Swept(dot(moved, part.first[own]), along, *crossed, turned)

        return of(left, sides, q_left, rise, q_up), of(up, rise, q_up, sides, q_left)

    def turning(self, part: MassSums) -> Body:
        """A part of what turns, without wind."""
        crane, state = self.at.seen.crane, self.at.state
        places, rates, (left, up) = (
            self.swept(part, values) for values in (state.coordinates, state.rates, self.accelerations)
        )
        sums = (Sums(*chain(*zip(*pair, strict=True))) for pair in zip(places, rates, strict=True))
        body = body_of(part.straight, self.head, self.felt(crane.self_gravity), *sums)
        turned = left.other - up.other, up.first + up.turned, -left.first - left.turned
        return body.pushed((0.0, -left.zeroth, -up.zeroth), turned)

    def blown(self, body: Body, *members: Literal["jib", "counter"]) -> Body:
        """A body with the wind on these members."""
        exposure = self.at.seen.exposure
        parts = exposure.head if exposure is not None else ()
        for member in members:
            body = self.pressed(body, [getattr(part, member) for part in parts])
        return body

    def pressed(self, body: Body, exposed: Sequence[MassSums]) -> Body:
        """A body with the wind on what each place of all that turns sees, nothing where there is no wind."""
        if not exposed:
            return body
        pressing = pressures(self.at.seen.crane, self.at.head, self.at.winds)
        for sums, press in zip(exposed, pressing, strict=True):
            _, rise = self.at.deflection(sums.first, self.at.state.coordinates)
            body = body.pushed((0.0, sums.mass * press, 0.0), (-rise * press, 0.0, sums.moment * press))
        return body

    def cut_off(self, cut: JibCut) -> Body:
        """What is beyond a section of the jib, without trolley and load."""
        return self.pressed(self.turning(cut.beyond), cut.exposed)

    def beyond(self, cut: JibCut) -> tuple[Vector, Vector]:
        """Force and moment of all that is beyond a section of the jib, the moment about the tower's top."""
        alone = self.cut_off(cut)
        carrying = self.loaded(alone)
        # A trolley right on the section is beyond it.
        short = below(self.at.trolley.x, cut.position)

        def chosen(one: Vector, other: Vector) -> Vector:
            x, y, z = (choose(short, without, beside) for without, beside in zip(one, other, strict=True))
            return x, y, z

        return chosen(alone.force, carrying.force), chosen(alone.moment, carrying.moment)

    @cached_property
    def hung(self) -> tuple[Vector, Vector]:
        """Force of the rope on what it hangs from, and couple of its damper, which turns the jib."""
        at, load = self.at, self.at.load
        rope: Any = load.rope_damping, at.below[0], at.rope, at.swing
        if load.elasticity is not None:
            _, rope = rope_seen(load, at.rope, at.swing, at.instant.guards)
        force, couple = rope_on_crane(at.instant.guards[TENSION], *rope)
        return self.head.to_head(force), self.head.to_head(couple)

    def loaded(self, body: Body) -> Body:
        """A part of what turns with trolley and load."""
        at, head, crane = self.at, self.head, self.at.seen.crane
        (left, up), end = at.paths, at.carry(head)
        moved = 0.0, *at.deflection(left.shapes + up.shapes, self.accelerations)
        hung, couple = self.hung
        inertia = zip(self.felt(crane.gravity), end.bias, moved, hung, strict=True)
        pull = tuple(force - crane.trolley_mass * (top + bias + own) for top, bias, own, force in inertia)
        return body.with_trolley(crane.trolley_mass, end.place, pull).pushed(NONE, couple)

    @cached_property
    def jib_root(self) -> Body:
        """What is beyond the root of the jib: jib, trolley and load."""
        return self.loaded(self.blown(self.turning(self.at.seen.jib), "jib"))

    @cached_property
    def counter_root(self) -> Body:
        """What is beyond the root of a counter-jib that bends; that of a rigid one has the head's own inertia too."""
        seen = self.at.seen
        alone = replace(seen.counter, roll=seen.counter.roll - seen.counter_roll)
        return self.blown(self.turning(alone), "counter")

    @cached_property
    def tower_top(self) -> Body:
        """What is beyond the top of the tower."""
        jib, counter = self.jib_root, self.blown(self.turning(self.at.seen.counter), "counter")
        return counter.pushed(jib.force, jib.moment)
