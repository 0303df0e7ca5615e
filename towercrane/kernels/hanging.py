"""Accelerations of a crane with its load on a rope, inextensible or elastic: what every crane shares."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.kernels.algebra import Row, dot, solve
from towercrane.kernels.elastic_rope import stretch
from towercrane.kernels.ground import stand
from towercrane.kernels.payload import Hung, Momentary

if TYPE_CHECKING:
    from collections.abc import Sequence

    from towercrane.kernels.elastic_rope import Elasticity
    from towercrane.kernels.payload import Load, Rope, State, Structure


def hang_load(structure: Structure, state: State, rope: Rope, load: Load | Momentary, gravity: Any) -> Hung:
    """Accelerations of a crane with its load.

    Notes
    -----
    With j = J^T n, w the tangential rate and s the rope force if the structure did not accelerate,
    (M + m j j^T) q'' = f - J^T H + j s and T = s - m j.q''. The matrix is symmetric positive definite whenever M
    is, so one Cholesky factor serves, and nothing divides by the load's mass but its own acceleration. What a rate of
    the coordinates pays out, dl/dq, adds to j: the rope's force acts on whatever its length depends on. An elastic
    rope pulls with what it is stretched by, whatever the structure does: then nothing of the load is in the matrix.
    Mass that goes takes its energy along, m' (v^2 / 2 + g z). Where none is left the end of an inextensible rope
    swings on with T = 0, and on an elastic one the place is that of what falls.
    """
    if load.elasticity is not None:
        return _hang_elastically(structure, state, rope, load, load.elasticity, gravity)
    length, rate = rope.length, rope.rate + dot(rope.paid, state.rates)
    axes, ground = range(len(state.direction)), structure.ground
    # Seen from a ground that accelerates, everything has its acceleration besides.
    bias = [own + base for own, base in zip(structure.bias, ground, strict=False)]
    norm = np.sqrt(dot(state.direction, state.direction))
    direction = [component / norm for component in state.direction]
    along = dot(direction, state.swing)
    across = [p - along * n for p, n in zip(state.swing, direction, strict=True)]
    ww = dot(across, across)
    velocity = [structure.velocity[k] + rate * direction[k] + length * across[k] for k in axes]
    air = _drag(load, velocity, structure.wind)
    hinge = [-load.rope_damping / length * w for w in across]
    power = -load.rope_damping * ww
    s = load.mass * (length * ww - rope.acceleration - gravity * direction[-1])
    for k in axes:
        s = s + direction[k] * (air[k] - load.mass * bias[k])
    for k in axes:
        power = power + (air[k] - load.mass * ground[k]) * velocity[k]
    inertia = load.mass
    if isinstance(load, Momentary):
        inertia = load.inertia
        power = power - load.leaving * _energy(velocity, structure.place[-1] + length * direction[-1], gravity)

    columns, pulled = _pulled(structure, rope, direction)
    right = [
        force - dot(column, hinge) + j * s
        for force, column, j in zip(structure.force, columns, pulled, strict=True)
    ]  # fmt: skip
    matrix = [
        [own + load.mass * j * other for own, other in zip(row, pulled, strict=False)]
        for row, j in zip(structure.mass, pulled, strict=True)
    ]
    accelerations = solve(matrix, right)

    tension = s
    for j, acceleration in zip(pulled, accelerations, strict=True):
        tension = tension - load.mass * j * acceleration
    suspension = _moved(structure, bias, accelerations)
    falling = [suspension[k] - (air[k] + hinge[k]) / inertia for k in axes]
    falling[-1] = falling[-1] + gravity
    outward = dot(falling, direction)
    turning = [
        -ww * n - (b - outward * n + 2.0 * rate * w) / length
        for n, b, w in zip(direction, falling, across, strict=True)
    ]
    return Hung(tension, power - tension * rope.rate, accelerations, turning, direction, hinge, suspension)


def _hang_elastically(
    structure: Structure, state: State, rope: Rope, load: Load | Momentary, elasticity: Elasticity, gravity: Any
) -> Hung:
    """:func:`hang_load` where the rope stretches: M q'' = f + J^T (T n - H), m v' = -T n + H + F - m g e_z."""
    place, velocity, axes, ground = state.direction, state.swing, range(len(state.direction)), structure.ground
    bias = [own + base for own, base in zip(structure.bias, ground, strict=False)]
    pull = stretch(
        elasticity,
        rope.length,
        rope.length if rope.wound is None else rope.wound,
        rope.rate,
        dot(rope.paid, state.rates),
        [place[k] - structure.place[k] for k in axes],
        [velocity[k] - structure.velocity[k] for k in axes],
        load.rope_damping,
        load.hangs if isinstance(load, Momentary) else None,
    )
    air = _drag(load, velocity, structure.wind)
    columns, pulled = _pulled(structure, rope, pull.direction)
    right = [
        force - dot(column, pull.hinge) + j * pull.tension
        for force, column, j in zip(structure.force, columns, pulled, strict=True)
    ]
    accelerations = solve(structure.mass, right)
    power, pushed, inertia = pull.power, [], load.mass
    if isinstance(load, Momentary):
        inertia = load.inertia
        power = power - load.leaving * _energy(velocity, place[-1], gravity)
    for k in axes:
        power = power + (air[k] - load.mass * ground[k]) * velocity[k]
        pushed.append(air[k] + pull.hinge[k] - pull.tension * pull.direction[k] - load.mass * ground[k])
    suspension, of_rope = _moved(structure, bias, accelerations), (pull.margin, -pull.margin, pull.stored)
    if load.ground is not None:
        held = stand(load.ground, place, velocity, pushed, load.mass, gravity)
        falling, power, guards = held.accelerations, power + held.power, (*held.guards, *of_rope)
    else:
        falling, guards = [own / inertia for own in pushed], of_rope
        falling[-1] = falling[-1] - gravity
    return Hung(pull.tension, power, accelerations, falling, pull.direction, pull.hinge, suspension, guards)


def _energy(velocity: Row, height: Any, gravity: Any) -> Any:
    """Kinetic and potential energy per mass [J/kg]."""
    return 0.5 * dot(velocity, velocity) + gravity * height


def _drag(load: Load | Momentary, velocity: Row, wind: Row) -> list[Any]:
    """Force of the air on the load."""
    through = [v - air for v, air in zip(velocity, wind, strict=False)]
    speed = np.sqrt(dot(through, through))
    return [-load.drag * speed * v for v in through]


def _pulled(structure: Structure, rope: Rope, direction: Sequence[Any]) -> tuple[list[Any], list[Any]]:
    """What a rate of each coordinate moves D, and how far it lets the load come."""
    columns = list(zip(*structure.jacobian, strict=True))
    pulled = [dot(column, direction) for column in columns]
    if rope.paid:
        pulled = [along + paid for along, paid in zip(pulled, rope.paid, strict=True)]
    return columns, pulled


def _moved(structure: Structure, bias: Sequence[Any], accelerations: Sequence[Any]) -> list[Any]:
    """Acceleration of D."""
    suspension = []
    for row, own in zip(structure.jacobian, bias, strict=True):
        for moved, acceleration in zip(row, accelerations, strict=True):
            own = own + moved * acceleration
        suspension.append(own)
    return suspension
