"""Accelerations of a crane with its load on a rope, inextensible or elastic: what every crane shares."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.kernels.algebra import Row, dot, solve
from towercrane.kernels.chain import chain_of
from towercrane.kernels.elastic_rope import stretch
from towercrane.kernels.ground import stand
from towercrane.kernels.load import Load, Momentary
from towercrane.kernels.payload import Hung

if TYPE_CHECKING:
    from collections.abc import Sequence

    from towercrane.kernels.chain import Chain
    from towercrane.kernels.elastic_rope import Elasticity
    from towercrane.kernels.load import Sling
    from towercrane.kernels.payload import Rope, State, Structure


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
    swings on with T = 0, and on an elastic one the place is that of what falls. Slings are solved first, see
    :mod:`towercrane.kernels.chain`: they change m and s.
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
    first = load.bodies[0]
    mass = first.mass
    air = _drag(first, velocity, structure.wind)
    hinge = [-load.rope_damping / length * w for w in across]
    power = -load.rope_damping * ww
    s = mass * (length * ww - rope.acceleration - gravity * direction[-1])
    for k in axes:
        s = s + direction[k] * (air[k] - mass * bias[k])
    power = _pushed(power, first, air, velocity, ground)
    inertia = mass
    if isinstance(load, Momentary):
        inertia = load.inertia
        power = power - load.leaving * _energy(velocity, structure.place[-1] + length * direction[-1], gravity)
    chain: Chain | None = None
    links: list[tuple[Any, Any]] = []
    if isinstance(load, Load) and load.slings:
        force = [own + held for own, held in zip(air, hinge, strict=True)]
        chain = _chain(structure, state, load, velocity, force, gravity)
        links, share, drop = chain.solved(direction)
        # To the rope all that hangs is one body of another mass.
        felt = 1.0 / (1.0 / mass - share)
        mass, s = felt, felt * (s / mass + drop)
        power = _pushed_below(power, chain, load, ground)

    columns, pulled = _pulled(structure, rope, direction)
    right = [
        force - dot(column, hinge) + j * s
        for force, column, j in zip(structure.force, columns, pulled, strict=True)
    ]  # fmt: skip
    matrix = [
        [own + mass * j * other for own, other in zip(row, pulled, strict=False)]
        for row, j in zip(structure.mass, pulled, strict=True)
    ]
    accelerations = solve(matrix, right)

    tension = s
    for j, acceleration in zip(pulled, accelerations, strict=True):
        tension = tension - mass * j * acceleration
    suspension = _moved(structure, bias, accelerations)
    pulls, held = [tension], [own + other for own, other in zip(air, hinge, strict=True)]
    if chain is not None:
        pulls += chain.tensions(links, tension)
        held = [own + pulls[1] * n for own, n in zip(held, chain.directions[0], strict=True)]
    falling = [suspension[k] - held[k] / inertia for k in axes]
    falling[-1] = falling[-1] + gravity
    outward = dot(falling, direction)
    turning = [
        -ww * n - (b - outward * n + 2.0 * rate * w) / length
        for n, b, w in zip(direction, falling, across, strict=True)
    ]
    if chain is not None:
        turning += chain.turning(direction, pulls)
    power = power - tension * rope.rate
    return Hung(tension, power, accelerations, turning, direction, hinge, suspension, pulls[1:])


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
    first = load.bodies[0]
    air = _drag(first, velocity, structure.wind)
    columns, pulled = _pulled(structure, rope, pull.direction)
    right = [
        force - dot(column, pull.hinge) + j * pull.tension
        for force, column, j in zip(structure.force, columns, pulled, strict=True)
    ]
    accelerations = solve(structure.mass, right)
    power, pushed, inertia = pull.power, [], first.mass
    if isinstance(load, Momentary):
        inertia = load.inertia
        power = power - load.leaving * _energy(velocity, place[-1], gravity)
    power = _pushed(power, first, air, velocity, ground)
    force = [own + held for own, held in zip(air, pull.hinge, strict=True)]
    pushed = [force[k] - pull.tension * pull.direction[k] - first.mass * ground[k] for k in axes]
    suspension, of_rope = _moved(structure, bias, accelerations), (pull.margin, -pull.margin, pull.stored)
    if load.ground is not None:
        held = stand(load.ground, place, velocity, pushed, load.mass, gravity)
        falling, power, guards = held.accelerations, power + held.power, (*held.guards, *of_rope)
        return Hung(pull.tension, power, accelerations, falling, pull.direction, pull.hinge, suspension, guards)
    pulls, turning = [pull.tension], []
    if isinstance(load, Load) and load.slings:
        chain = _chain(structure, state, load, velocity, force, gravity)
        links, *_ = chain.solved(pull.direction)
        pulls += chain.tensions(links, pull.tension)
        power = _pushed_below(power, chain, load, ground)
        turning = chain.turning(pull.direction, pulls)
        pushed = [own + pulls[1] * n for own, n in zip(pushed, chain.directions[0], strict=True)]
    falling = [own / inertia for own in pushed]
    falling[-1] = falling[-1] - gravity
    guards = (*pulls[1:], *of_rope)
    return Hung(
        pull.tension, power, accelerations, falling + turning, pull.direction, pull.hinge, suspension, guards
    )  # fmt: skip


def _energy(velocity: Row, height: Any, gravity: Any) -> Any:
    """Kinetic and potential energy per mass [J/kg]."""
    return 0.5 * dot(velocity, velocity) + gravity * height


def _drag(body: Sling | Load | Momentary, velocity: Row, wind: Row) -> list[Any]:
    """Force of the air on a body."""
    through = [v - air for v, air in zip(velocity, wind, strict=False)]
    speed = np.sqrt(dot(through, through))
    return [-body.drag * speed * v for v in through]


def _pushed(power: Any, body: Sling | Load | Momentary, air: Row, velocity: Row, ground: Row) -> Any:
    """Power with that of the air and, as seen from the ground, of its acceleration on a body."""
    for force, v, a in zip(air, velocity, ground, strict=False):
        power = power + (force - body.mass * a) * v
    return power


def _chain(structure: Structure, state: State, load: Load, velocity: Row, force: Row, gravity: Any) -> Chain:
    """What hangs below the first body, see :func:`towercrane.kernels.chain.chain_of`."""
    return chain_of(load, state, velocity, force, gravity, partial(_drag, wind=structure.wind))


def _pushed_below(power: Any, chain: Chain, load: Load, ground: Row) -> Any:
    """The same with that on all bodies but the first."""
    for body, air, velocity in zip(load.bodies[1:], chain.air, chain.velocities, strict=True):
        power = _pushed(power, body, air, velocity, ground)
    return power


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
