"""What a crane, its rope and its load tell each other, and their state, for every crane.

A crane states only its structure without the load: mass matrix, forces, and the motion of the point D that the
rope hangs from; :mod:`towercrane.kernels.hanging` adds rope and load. The rope's direction is a unit
vector, so there is no angle chart and no singular position; angles are outputs.

Vectors have ``d`` inertial components, the vertical last: (x, z) in a plane, (x, y, z) in space. The state is
``y = (q, n, q', p, work)``: coordinates, unit vector from D to the load, rates, rate of the unit vector, and the
work [J] that inputs and dissipation have put into the crane since the start. On an elastic rope n and p are the
load's place and velocity instead: its tension is known before anything is solved, and a load may fly free.

Under a hook block the load hangs on slings: the rope then carries the hook, and the unit vector of each sling, from
the body above it to that below, follows n, its rate p.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from towercrane.kernels.algebra import Row

SLACK = -1e-6
"""Tension below which a rope is slack [N]: where a whole crane is let fall, rounding decides the sign of none."""


class Structure(NamedTuple):
    """A crane of n coordinates without its load, as the load on it sees it.

    Parameters
    ----------
    mass : sequence of n sequences
        Rows of the lower triangle of the mass matrix.
    force : sequence of n
        Forces on the coordinates while nothing accelerates.
    place, velocity, bias : sequence of d
        Of D: where it is, its velocity, and its acceleration while no coordinate accelerates.
    jacobian : sequence of d sequences of n
        What a rate of each coordinate moves D.
    wind : sequence of d
        Velocity of the air at the load, as seen from the ground.
    ground : sequence of d
        Acceleration of the ground that all places, velocities and accelerations are relative to.
    """

    mass: Sequence[Sequence[Any]]
    force: Sequence[Any]
    place: Sequence[Any]
    velocity: Sequence[Any]
    bias: Sequence[Any]
    jacobian: Sequence[Sequence[Any]]
    wind: Sequence[Any] = (0.0, 0.0, 0.0)
    ground: Sequence[Any] = (0.0, 0.0, 0.0)

    def mass_matrix(self) -> NDArray[np.float64]:
        """The whole mass matrix, of numbers; shape (n, n)."""
        matrix = np.zeros((len(self.mass), len(self.mass)))
        for i, row in enumerate(self.mass):
            matrix[i, : i + 1] = matrix[: i + 1, i] = row
        return matrix


class State(NamedTuple):
    """Parts of a state: coordinates, rope direction and their rates; of an elastic rope the load's place instead.

    Directions of slings, one after the other, and their rates stand behind those of the rope.
    """

    coordinates: Row
    direction: Row
    rates: Row
    swing: Row
    slings: Row = ()
    slings_swing: Row = ()

    def links(self) -> list[tuple[Row, Row]]:
        """Direction of each sling, and its rate."""
        axes = len(self.direction)
        return [
            (self.slings[first : first + axes], self.slings_swing[first : first + axes])
            for first in range(0, len(self.slings), axes)
        ]


class Rope(NamedTuple):
    """The rope from D to the load.

    Parameters
    ----------
    length : number
        Unstretched [m].
    rate, acceleration : number
        What the winch gives to its rate, and its acceleration while no coordinate accelerates [m/s, m/s^2].
    paid : sequence of n
        What a rate of each coordinate adds to the length, as where a rope is led over a jib that moves; nothing where
        the winch alone decides.
    wound : number, optional
        Length that the winch gives it [m], where it is not the whole.
    """

    length: Any
    rate: Any
    acceleration: Any
    paid: Sequence[Any] = ()
    wound: Any = None


class Hung(NamedTuple):
    """Crane and load in motion.

    Parameters
    ----------
    tension : number
        Force of the rope [N].
    power : number
        Of winch, drag, hinge, rope and, on the load, ground [W].
    accelerations : list of n
    turning : list of d
        Second derivative of the rope's direction; of an elastic rope the acceleration of what it carries. Those of
        the slings' directions follow.
    direction, hinge, suspension : list of d
        Unit vector from D to the load, hinge force on the load, acceleration of D with that of the ground.
    guards : list
        Tensions of slings [N]; of the ground, if there is any; of an elastic rope: how far it is from slack and from
        taut, as strains, and energy stored in it [J].
    """

    tension: Any
    power: Any
    accelerations: list[Any]
    turning: list[Any]
    direction: list[Any]
    hinge: list[Any]
    suspension: list[Any]
    guards: Sequence[Any] = ()

    def pull(self, axis: int) -> Any:
        """Force of rope and hinge on D along an axis."""
        return self.tension * self.direction[axis] - self.hinge[axis]


def state_of(y: Row, coordinates: int, axes: int) -> State:
    """Parts of a state with so many coordinates and axes of space."""
    half, ropes = (len(y) - 1) // 2, coordinates + axes
    places, rates = y[:half], y[half : 2 * half]
    return State(
        places[:coordinates], places[coordinates:ropes], rates[:coordinates], rates[coordinates:ropes],
        places[ropes:], rates[ropes:],
    )  # fmt: skip


def slopes(state: State, hung: Hung, power: Any) -> list[Any]:
    """Derivative of a state, with the power that inputs put in less what is lost [W]."""
    return [*state.rates, *state.swing, *state.slings_swing, *hung.accelerations, *hung.turning, power]
