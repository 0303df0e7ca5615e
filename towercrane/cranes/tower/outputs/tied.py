"""What an engineer reads off a run of a crane whose jibs hang on ties, beside what tower cranes have in common."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

from towercrane.cranes.parts.hoisting.elastic import guards_of
from towercrane.cranes.tower.equations.tied.fields import kinetic_energy, move_fields
from towercrane.cranes.tower.equations.tied.ties import Taut, pull_ties, stored
from towercrane.cranes.tower.modes.tied.bars import MOST_TIES
from towercrane.cranes.tower.outputs import energy
from towercrane.cranes.tower.outputs.observed import OUTPUTS, Outputs, Sight
from towercrane.cranes.tower.outputs.sections import Sections
from towercrane.kernels.algebra import Row, cross, dot, form
from towercrane.simulation.observed import About

if TYPE_CHECKING:
    from collections.abc import Callable

    from towercrane.cranes.tower.equations.body import Body
    from towercrane.cranes.tower.equations.tied.constants import Tied
    from towercrane.cranes.tower.outputs.cut_sums import JibCut
    from towercrane.cranes.tower.outputs.seen import Seen
    from towercrane.simulation.observed import Instant


class TiedSight(Sight):
    """What outputs are read off."""

    @cached_property
    def own(self) -> Tied:
        """What is known of the ties."""
        tied = self.seen.crane.tied
        assert tied is not None, "the crane has ties"
        return tied

    def on_head(self, values: Row) -> Row:
        """Coordinates of what is on the head, or derivatives of them."""
        return values[self.seen.crane.movers :]

    @cached_property
    def taut(self) -> Taut:
        """The ties."""
        return pull_ties(self.own, self.on_head(self.state.coordinates))

    @cached_property
    def sections(self) -> TiedSections:
        """What sections carry."""
        return TiedSections(self)

    @cached_property
    def energies(self) -> Any:
        """Kinetic and potential energy, zero level at the undeformed tower top [J]."""
        crane, fields, carried = self.seen.crane, self.own.fields, slice(self.seen.crane.movers, None)
        q, rates = self.on_head(self.state.coordinates), self.on_head(self.state.rates)
        kinetic = energy.own_energy(self) + kinetic_energy(fields, self.head, q, rates)
        kinetic = kinetic + 0.5 * form(rates, crane.rotary_mass[carried, carried], rates)
        first = [fields.first[k] + dot(fields.momentum[:, k], q) for k in range(3)]
        potential = energy.elastic_energy(self) + stored(self.own, self.taut)
        potential = potential + crane.self_gravity * dot(self.head.rows[2], first)
        for mass, (place, speed) in (
            (crane.trolley_mass, self.trolley_in_space), *self.hung,
        ):  # fmt: skip
            kinetic = kinetic + 0.5 * mass * dot(speed, speed)
            potential = potential + crane.gravity * mass * place[2]
        return kinetic + potential


class TiedSections(Sections):
    """What sections of a crane carry whose jibs hang on ties."""

    at: TiedSight

    @cached_property
    def tower_top(self) -> Body:
        """What is beyond the top of the tower: all that turns, and the load."""
        at, crane, state = self.at, self.at.seen.crane, self.at.state
        q, rates, moving = (at.on_head(own) for own in (state.coordinates, state.rates, self.accelerations))
        moved = move_fields(at.own.fields, self.head, self.felt(crane.self_gravity), q, rates)
        x, y, z, rolling, pitching, turning = (
            -dot([row[part][k] for row in moved.rows], moving) for part in (0, 1) for k in range(3)
        )
        body = self.loaded(moved.body.pushed((x, y, z), (rolling, pitching, turning)))
        return self.blown(body, "jib", "counter")

    def cut_off(self, cut: JibCut) -> Body:
        """What is beyond a section of the jib, without trolley and load: what its ties do there is part of it."""
        at, body = self.at, super().cut_off(cut)
        q, rates = (at.on_head(own) for own in (at.state.coordinates, at.state.rates))
        moving, felt = at.on_head(self.accelerations), self.felt(at.seen.crane.self_gravity)
        for tie in cut.ties:
            # Its lower end bears its share of the tie's inertia and weight.
            moved = move_fields(tie.share, self.head, felt, q, rates)
            pull, along = at.taut.tensions[tie.number], at.taut.spans[tie.number].direction
            x, y, z = (
                moved.body.force[k] - dot([row[0][k] for row in moved.rows], moving) - pull * along[k]
                for k in range(3)
            )
            u, v, w = (tie.place[k] + dot(tie.moves[:, k], q) for k in range(3))
            body = body.pushed((x, y, z), cross((u, v, w), (x, y, z)))
        return body

    @cached_property
    def compression(self) -> Any:
        """Of the jib at its foot [N]: the ties' pull along it, less what pulls it outward."""
        at = self.at
        ahead = at.own.ahead
        pulled = dot(at.taut.tensions[:ahead], [span.direction[0] for span in at.taut.spans[:ahead]])
        return pulled - self.jib_root.force[0]


Read = dict[str, tuple["Callable[[Any], Any]", About]]


def tensions(jib: int, counter_jib: int) -> Read:
    """Tensions of so many ties, from the tower's axis outward."""

    def read(k: int, side: str) -> Callable[[Any], Any]:
        # Those of the jib first; behind them are guards of slings, rope and ground.
        def tension(at: TiedSight) -> Any:
            load = at.seen.crane.load
            last = len(at.own.lengths) + len(load.slings) + len(guards_of(load))
            return at.instant.guards[k + (at.own.ahead if side == "counter_jib" else 0) - last]

        return tension

    return {
        f"{side}_tie_{k + 1}_tension": (read(k, side), About("N", f"tension of tie {k + 1} of the {said}"))
        for side, said, count in (("jib", "jib", jib), ("counter_jib", "counter-jib", counter_jib))
        for k in range(count)
    }


def tie(name: str) -> bool:
    """Whether an output is a tension of a tie."""
    return "_tie_" in name


OWN: Read = {
    **tensions(MOST_TIES, MOST_TIES),
    "jib_compression": (lambda at: at.sections.compression, About("N", "compression of the jib at its foot")),
    "total_energy": (lambda at: at.energies, About("J", "kinetic and potential energy")),
}

LEFT_OUT = (
    "jib_root_moment", "jib_root_moment_sideways", "counter_jib_root_moment", "counter_jib_root_moment_sideways",
)  # fmt: skip
"""Outputs of jibs that are clamped at their feet."""

READ: Read = {**{name: read for name, read in OUTPUTS.items() if name not in (*OWN, *LEFT_OUT)}, **OWN}
"""How each output is read off and what it is."""


def outputs(seen: Seen, instant: Instant) -> Outputs:
    """Outputs at an instant."""
    return Outputs(TiedSight(seen, instant), READ)
