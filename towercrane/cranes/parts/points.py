"""Points of cranes and the load on its rope: where they are, how they move, what energy a mass there has.

Plain functions like the equations: of numbers, of arrays of them, or of operands that record.
"""

from __future__ import annotations

from functools import reduce
from operator import add
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from towercrane.cranes.parts.hoisting.contact import REACTION
from towercrane.cranes.parts.hoisting.elastic import sling_force
from towercrane.cranes.parts.hoisting.slackening import SLACKENS, STORED
from towercrane.kernels.algebra import Row, dot
from towercrane.kernels.choices import below, choose
from towercrane.simulation.observed import About

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from towercrane.kernels.load import Load, Momentary
    from towercrane.kernels.payload import State


class Point(NamedTuple):
    """Place [m] and velocity [m/s], the vertical last."""

    place: Sequence[Any]
    velocity: Sequence[Any]

    def hung(self, length: Any, rate: Any, direction: Row, swing: Row) -> Point:
        """What hangs from it on a rope of a length with its rate, along a direction with its rate."""
        return Point(
            [at + length * n for at, n in zip(self.place, direction, strict=True)],
            [v + rate * n + length * p for v, n, p in zip(self.velocity, direction, swing, strict=True)],
        )

    def carry(self, load: Load, state: State, length: Any, rate: Any, guards: Row) -> Carried:
        """The load of a state that hangs from it on so much rope."""
        if load.elasticity is None:
            hung = self.hung(length, rate, state.direction, state.swing)
            rope = load.rope_damping, length, state.direction, state.swing
            return Carried(hung.with_slings(load, state), state.direction, rope, _shown(load, hung, guards), 0.0)
        hung = Point([*state.direction], [*state.swing])
        along, parting = (
            [own - other for own, other in zip(*pair, strict=True)]
            for pair in ((hung.place, self.place), (hung.velocity, self.velocity))
        )
        reach, stretched = rope_seen(load, along, parting, guards)
        shown = {"rope_stretch": reach - length, **_shown(load, hung, guards)}
        if load.ground is not None:
            shown["load_ground_force"] = guards[REACTION]
        return Carried(hung.with_slings(load, state), along, stretched, shown, guards[STORED])

    def with_slings(self, load: Load | Momentary, state: State) -> list[Point]:
        """Each body of a load, from above, whose first is here."""
        found = [self]
        for sling, (direction, swing) in zip(load.slings, state.links(), strict=True):
            found.append(found[-1].hung(sling.length, 0.0, direction, swing))
        return found

    def energy(self, mass: Any, gravity: Any) -> Any:
        """Kinetic and potential energy of a mass there [J]."""
        return mass * (0.5 * dot(self.velocity, self.velocity) + gravity * self.place[-1])


class Carried(NamedTuple):
    """A load on its rope.

    Parameters
    ----------
    bodies : list of Point
        From above; the last is the load.
    along : sequence of numbers
        Vector along the rope, of no certain length.
    rope : tuple
        What :func:`towercrane.cranes.parts.base.rope_on_crane` asks of it.
    shown : dict
        Outputs of a rope that stretches, and of slings.
    stored : number
        Energy in it [J].
    """

    bodies: list[Point]
    along: Row
    rope: tuple[Any, Any, Row, Row]
    shown: dict[str, Any]
    stored: Any

    @property
    def load(self) -> Point:
        """The load."""
        return self.bodies[-1]

    def energy(self, load: Load | Momentary, gravity: Any) -> Any:
        """Kinetic and potential energy of all that hangs on the rope [J]."""
        bodies = zip(load.bodies, self.bodies, strict=True)
        return reduce(add, [at.energy(body.mass, gravity) for body, at in bodies])

    def sling_sways(self, state: State, sways: Callable[[Row], Mapping[str, Any]]) -> dict[str, Any]:
        """Sways of the load below the hook, by what sways of a vector are; nothing without slings."""
        links = state.links()
        return {f"sling_{name}": value for name, value in sways(links[-1][0]).items()} if links else {}


def _shown(load: Load | Momentary, hook: Point, guards: Row) -> dict[str, Any]:
    return {"hook_position": [*hook.place], "sling_force": sling_force(load, guards)} if load.slings else {}


ROPE_STRETCH = About("m", "distance from load to rope's upper end beyond the rope's length; below zero it is slack")
"""What an elastic rope shows."""

GROUND_FORCE = About("N", "force of the load on the ground")
"""What ground shows."""


def rope_about(load: Load, origin: str, sways: Mapping[str, About]) -> dict[str, About]:
    """What outputs of a rope that stretches, of ground and of slings are, if there are any.

    Parameters
    ----------
    load : Load
    origin : str
        What places count from.
    sways : mapping of str to About
        Those of the rope.
    """
    found = {} if load.elasticity is None else {"rope_stretch": ROPE_STRETCH}
    if load.ground is not None:
        found["load_ground_force"] = GROUND_FORCE
    if load.slings:
        found |= {
            f"sling_{name}": own._replace(long_name=f"below the hook, {own.long_name}") for name, own in sways.items()
        }
        found["sling_force"] = About("N", "tension of the sling")
        found["hook_position"] = About("m", f"hook from {origin} in fixed axes: x, y, up", ("fixed_axis",), 3)
    return found


def rope_seen(load: Load | Momentary, along: Row, parting: Row, guards: Row) -> tuple[Any, tuple[Any, Any, Row, Row]]:
    """Distance that an elastic rope spans, and its damping, length, direction and rate of direction.

    A slack rope does not damp, and its direction does not matter.
    """
    taut, reach = below(0.0, guards[SLACKENS]), np.sqrt(dot(along, along))
    length = choose(taut, reach, 1.0)
    direction, swing = ([own / length for own in vector] for vector in (along, parting))
    return reach, (taut * load.rope_damping, length, direction, swing)


def turned_back(heading: Any, vector: Row) -> tuple[Any, Any]:
    """Horizontal components of a vector in axes that have turned to a heading: along it, and to its left."""
    c, s = np.cos(heading), np.sin(heading)
    return c * vector[0] + s * vector[1], c * vector[1] - s * vector[0]


def load_places(place: Sequence[Any], heading: Any) -> dict[str, Any]:
    """Place of a load in fixed axes and in those that turn with its crane.

    Parameters
    ----------
    place : sequence of 3 numbers
        In fixed axes, from the axis that the crane turns about [m].
    heading : number
        Angle of the jib's root, or of the booms, from the x axis [rad].
    """
    return {
        "payload_position": [*place],
        "payload_in_crane_axes": [*turned_back(heading, place), place[2]],
    }


def load_places_about(origin: str) -> dict[str, About]:
    """What these are, by what they count from."""
    fixed = f"load from {origin} in fixed axes: x, y, up"
    own = f"load from {origin} in axes that turn with the crane: outward along its jib, sideways, up"
    return {
        "payload_position": About("m", fixed, ("fixed_axis",), 3),
        "payload_in_crane_axes": About("m", own, ("axis",), 3),
    }
