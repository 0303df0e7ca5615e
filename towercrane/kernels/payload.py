"""The load on its rope: the equations that every crane shares.

A crane states only its structure without the load: mass matrix, forces, and the motion of the point D that the
rope hangs from. What is here adds a rope of prescribed length and a point load. The rope's direction is a unit
vector, so there is no angle chart and no singular position; angles are outputs.

Vectors have ``d`` inertial components, the vertical last: (x, z) in a plane, (x, y, z) in space. The state is
``y = (q, n, q', p, work)``: coordinates, unit vector from D to the load, rates, rate of the unit vector, and the
work [J] that inputs and dissipation have put into the crane since the start. An elastic rope adds its stretch e:
``y = (q, e, n, q', e', p, work)``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from modal.checks import check_fields
from towercrane.kernels.algebra import Row, dot, solve

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

AIR_DENSITY = 1.225
"""Density of air at 15 degrees Celsius and sea level [kg/m^3] (ISO 2533)."""

SLACK = -1e-6
"""Tension below which a rope is slack [N]: where a whole crane is let fall, rounding decides the sign of none."""


@dataclass(frozen=True, slots=True)
class Load:
    """The load and its rope's losses.

    Parameters
    ----------
    mass : float
        Mass of the load with hook [kg].
    rope_damping : float
        Damping where the rope hangs, a torque per rate of swing [N m s/rad].
    drag_area : float
        Drag coefficient times area [m^2].

    Raises
    ------
    ValueError
        If the mass is not positive or another value is negative.
    """

    mass: float
    rope_damping: float = 0.0
    drag_area: float = 0.0

    def __post_init__(self) -> None:
        check_fields(self, positive=("mass",), not_negative=("rope_damping", "drag_area"))

    def work_scale(self, gravity: float, length: float) -> float:
        """Tolerance of the work per unit of that of swing, by gravity [m/s^2] and a length of the crane [m]; [J].

        Work steers where nothing else does, as where the load hangs while its rope is let out, and where it is worse
        than the balance of energy allows. Without gravity nothing says which work is small: it then steers no step.
        """
        return self.mass * gravity * length or np.inf

    @property
    def drag(self) -> float:
        """Drag force per squared speed, rho C_d A / 2 [kg/m]."""
        return 0.5 * AIR_DENSITY * self.drag_area


class Structure(NamedTuple):
    """A crane of n coordinates without its load, as the load on it sees it.

    Parameters
    ----------
    mass : sequence of n sequences
        Rows of the lower triangle of the mass matrix.
    force : sequence of n
        Forces on the coordinates while nothing accelerates.
    velocity, bias : sequence of d
        Of D: its velocity, and its acceleration while no coordinate accelerates.
    jacobian : sequence of d sequences of n
        What a rate of each coordinate moves D.
    wind : sequence of d
        Velocity of the air at the load, as seen from the ground.
    ground : sequence of d
        Acceleration of the ground that all places, velocities and accelerations are relative to.
    """

    mass: Sequence[Sequence[Any]]
    force: Sequence[Any]
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
    """Parts of a state: coordinates, stretch of an elastic rope or nothing, rope direction, and their rates."""

    coordinates: Row
    stretch: Row
    direction: Row
    rates: Row
    stretching: Row
    swing: Row


class Rope(NamedTuple):
    """The rope from D to the load.

    Parameters
    ----------
    length : number
        Unstretched [m].
    rate, acceleration : number
        What the winch gives to its rate, and its acceleration while no coordinate accelerates [m/s, m/s^2].
    stiffness, damping : number
        Where it stretches [N/m, N s/m].
    paid : sequence of n
        What a rate of each coordinate adds to the length, as where a rope is led over a jib that moves; nothing where
        the winch alone decides.
    """

    length: Any
    rate: Any
    acceleration: Any
    stiffness: Any = 0.0
    damping: Any = 0.0
    paid: Sequence[Any] = ()


class Hung(NamedTuple):
    """Crane and load in motion.

    Parameters
    ----------
    tension : number
        Force of the rope [N].
    power : number
        Of winch, drag, hinge, rope and, on the load, ground [W].
    accelerations : list of n
    stretch_acceleration : sequence
        Of an elastic rope, else nothing.
    turning : list of d
        Second derivative of the rope's direction.
    direction, hinge, suspension : list of d
        Unit vector from D to the load, hinge force on the load, acceleration of D with that of the ground.
    """

    tension: Any
    power: Any
    accelerations: list[Any]
    stretch_acceleration: Sequence[Any]
    turning: list[Any]
    direction: list[Any]
    hinge: list[Any]
    suspension: list[Any]

    def pull(self, axis: int) -> Any:
        """Force of rope and hinge on D along an axis."""
        return self.tension * self.direction[axis] - self.hinge[axis]


def state_of(y: Row, coordinates: int, axes: int) -> State:
    """Parts of a state with so many coordinates and axes of space."""
    half = (len(y) - 1) // 2
    rope = half - axes
    places, rates = y[:half], y[half : 2 * half]
    return State(
        places[:coordinates], places[coordinates:rope], places[rope:],
        rates[:coordinates], rates[coordinates:rope], rates[rope:],
    )  # fmt: skip


def slopes(state: State, hung: Hung, power: Any) -> list[Any]:
    """Derivative of a state, with the power that inputs put in less what is lost [W]."""
    return [
        *state.rates, *state.stretching, *state.swing,
        *hung.accelerations, *hung.stretch_acceleration, *hung.turning, power,
    ]  # fmt: skip


def hang_load(structure: Structure, state: State, rope: Rope, load: Load, gravity: Any) -> Hung:
    """Accelerations of a crane with its load.

    Notes
    -----
    With j = J^T n, w the tangential rate and s the rope force if the structure did not accelerate,
    (M + m j j^T) q'' = f - J^T H + j s and T = s - m j.q''. The matrix is symmetric positive definite whenever M
    is, so one Cholesky factor serves, and nothing divides by the load's mass but its own acceleration. An elastic
    rope pulls with k e + c e' whatever the structure does: then nothing of the load is in the matrix, and the stretch
    has an equation of its own. What a rate of the coordinates pays out, dl/dq, adds to j: the rope's force acts on
    whatever its length depends on.
    """
    elastic = len(state.stretch) > 0
    stretch, stretching = (state.stretch[0], state.stretching[0]) if elastic else (0.0, 0.0)
    winding = rope.rate + dot(rope.paid, state.rates)
    length, rate = rope.length + stretch, winding + stretching
    axes, ground = range(len(state.direction)), structure.ground
    # Seen from a ground that accelerates, everything has its acceleration besides.
    bias = [own + base for own, base in zip(structure.bias, ground, strict=False)]
    norm = np.sqrt(dot(state.direction, state.direction))
    direction = [component / norm for component in state.direction]
    along = dot(direction, state.swing)
    across = [p - along * n for p, n in zip(state.swing, direction, strict=True)]
    ww = dot(across, across)
    velocity = [structure.velocity[k] + rate * direction[k] + length * across[k] for k in axes]
    through = [velocity[k] - structure.wind[k] for k in axes]
    speed = np.sqrt(dot(through, through))
    air = [-load.drag * speed * v for v in through]
    hinge = [-load.rope_damping / length * w for w in across]
    power = -load.rope_damping * ww
    if elastic:
        bound, s = 0.0, rope.stiffness * stretch + rope.damping * stretching
        power = power - rope.damping * stretching * stretching
    else:
        bound, s = load.mass, load.mass * (length * ww - rope.acceleration - gravity * direction[-1])
        for k in axes:
            s = s + direction[k] * (air[k] - load.mass * bias[k])
    for k in axes:
        power = power + (air[k] - load.mass * ground[k]) * velocity[k]

    columns = list(zip(*structure.jacobian, strict=True))
    pulled = [dot(column, direction) for column in columns]
    if rope.paid:
        pulled = [along + paid for along, paid in zip(pulled, rope.paid, strict=True)]
    right = [
        force - dot(column, hinge) + j * s
        for force, column, j in zip(structure.force, columns, pulled, strict=True)
    ]  # fmt: skip
    matrix = [
        [own + bound * j * other for own, other in zip(row, pulled, strict=False)]
        for row, j in zip(structure.mass, pulled, strict=True)
    ]
    accelerations = solve(matrix, right)

    tension = s
    for j, acceleration in zip(pulled, accelerations, strict=True):
        tension = tension - bound * j * acceleration
    suspension = []
    for row, own in zip(structure.jacobian, bias, strict=True):
        for moved, acceleration in zip(row, accelerations, strict=True):
            own = own + moved * acceleration
        suspension.append(own)
    falling = [suspension[k] - (air[k] + hinge[k]) / load.mass for k in axes]
    falling[-1] = falling[-1] + gravity
    outward = dot(falling, direction)
    turning = [
        -ww * n - (b - outward * n + 2.0 * rate * w) / length
        for n, b, w in zip(direction, falling, across, strict=True)
    ]
    paying = rope.acceleration + dot(rope.paid, accelerations)
    stretched = [length * ww - outward - tension / load.mass - paying] if elastic else []
    return Hung(tension, power - tension * rope.rate, accelerations, stretched, turning, direction, hinge, suspension)
