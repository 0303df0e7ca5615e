"""What hangs below the first body on a rope: rigid links, whose tensions follow from one tridiagonal system.

Bodies m_1 .. m_N hang one below the other; link i of length l_i along the unit vector n_i with the rate w_i ends at
body i, link 1 is the rope. With G_i the acceleration that all but the links give body i, links keep their lengths if

    (1 / m_i + 1 / m_(i-1)) T_i - n_(i-1).n_i T_(i-1) / m_(i-1) - n_i.n_(i+1) T_(i+1) / m_i
        = l_i |w_i|^2 + n_i.(G_i - G_(i-1)),    i = 2 .. N

The system is symmetric and positive definite. It is solved from below, so that a rope sees one body of another mass
with another force on it, and the crane's own equations stay as they are; then the tensions follow from above.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.kernels.algebra import Row, dot

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from towercrane.kernels.load import Load, Momentary
    from towercrane.kernels.payload import State


@dataclass(frozen=True, eq=False)
class Chain:
    """Links below the first body.

    Parameters
    ----------
    masses : list of N
        Of the bodies, from above [kg].
    directions, rates : list of N - 1 vectors
        Unit vectors of the links, and their rates at right angles to them.
    lengths : list of N - 1
        [m]
    given : list of N vectors
        G of each body [m/s^2].
    air : list of N - 1 vectors
        Force of the air on each body but the first [N].
    velocities : list of N - 1 vectors
        Of the same [m/s].
    """

    masses: list[Any]
    directions: list[list[Any]]
    rates: list[list[Any]]
    lengths: list[Any]
    given: list[list[Any]]
    air: list[list[Any]]
    velocities: list[list[Any]]

    def solved(self, first: Row) -> tuple[list[tuple[Any, Any]], Any, Any]:
        """The system below a rope of this direction, solved from below.

        Returns
        -------
        links : list of N - 1 pairs
            A tension is the first less the second times the tension of the link above it [N, 1].
        share, drop : number
            What the links are to the rope, whose own equation (1 / m_1) T_1 = right they change to
            (1 / m_1 - share) T_1 = right + drop.
        """
        directions, links = [first, *self.directions], []
        share, drop = 0.0, 0.0
        for i in range(len(self.lengths), 0, -1):
            own, above = directions[i], directions[i - 1]
            pivot = 1.0 / self.masses[i] + 1.0 / self.masses[i - 1] - share
            apart = [a - b for a, b in zip(self.given[i], self.given[i - 1], strict=True)]
            right = self.lengths[i - 1] * dot(self.rates[i - 1], self.rates[i - 1]) + dot(own, apart) + drop
            coupled = -dot(above, own) / self.masses[i - 1]
            links.append((right / pivot, coupled / pivot))
            share, drop = coupled * coupled / pivot, -coupled * right / pivot
        return links[::-1], share, drop

    def tensions(self, links: Sequence[tuple[Any, Any]], above: Any) -> list[Any]:
        """Tensions of the links, by that of the rope [N]."""
        found = []
        for own, coupled in links:
            above = own - coupled * above
            found.append(above)
        return found

    def turning(self, first: Row, tensions: Sequence[Any]) -> list[Any]:
        """Second derivatives of the links' directions, of all tensions, the rope's first."""
        found: list[Any] = []
        for i, (own, rates, length) in enumerate(
            zip(self.directions, self.rates, self.lengths, strict=True), start=1
        ):
            # Its own tension acts along it; those of its neighbours turn it.
            above = first if i == 1 else self.directions[i - 2]
            pulled = [
                a - b + tensions[i - 1] / self.masses[i - 1] * n
                for a, b, n in zip(self.given[i], self.given[i - 1], above, strict=True)
            ]
            if i < len(self.lengths):
                held = tensions[i + 1] / self.masses[i]
                pulled = [a + held * n for a, n in zip(pulled, self.directions[i], strict=True)]
            along, square = dot(pulled, own), dot(rates, rates)
            found += [(a - along * n) / length - square * n for a, n in zip(pulled, own, strict=True)]
        return found


def chain_at_rest(load: Load | Momentary, state: State) -> Chain:
    """What hangs below the first body, at rest and without weight: what impulses see, in place of tensions."""
    directions = [list(direction) for direction, _ in state.links()]
    still = [[0.0] * len(state.direction)] * len(load.bodies)
    lengths = [sling.length for sling in load.slings]
    return Chain([body.mass for body in load.bodies], directions, still[1:], lengths, still, [], [])


def chain_of(
    load: Load, state: State, velocity: Row, force: Row, gravity: Any, blown: Callable[[Any, Row], list[Any]]
) -> Chain:
    """What hangs below the first body, of its velocity and the force on it but for links and weight.

    Parameters
    ----------
    load : Load
    state : State
    velocity, force : sequence of d
        [m/s, N]
    gravity : number
    blown : callable
        Force of the air on a body at a velocity [N].
    """
    bodies, directions, rates, velocities = load.bodies, [], [], []
    for sling, (own, swing) in zip(load.slings, state.links(), strict=True):
        norm = np.sqrt(dot(own, own))
        direction = [component / norm for component in own]
        along = dot(direction, swing)
        across = [p - along * n for p, n in zip(swing, direction, strict=True)]
        velocity = [v + sling.length * w for v, w in zip(velocity, across, strict=True)]
        directions.append(direction)
        rates.append(across)
        velocities.append(velocity)
    air = [blown(body, own) for body, own in zip(bodies[1:], velocities, strict=True)]
    given = [[own / body.mass for own in pushed] for body, pushed in zip(bodies, [force, *air], strict=True)]
    for own in given:
        own[-1] = own[-1] - gravity
    lengths = [sling.length for sling in load.slings]
    return Chain([body.mass for body in bodies], directions, rates, lengths, given, air, velocities)
