"""Rope and slings as the solver sees them, over ground or not: where they go slack; how fast the load vibrates."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cranes.parts.hoisting import contact, slackening
from towercrane.cranes.parts.hoisting.contact import Contact
from towercrane.cranes.parts.hoisting.slackening import Slackening
from towercrane.kernels.algebra import vibrations
from towercrane.kernels.elastic_rope import TAUT
from towercrane.kernels.payload import SLACK
from towercrane.kernels.straight.leaves import place_of
from towercrane.simulation.outcomes import SLACK_SLING

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from towercrane.kernels.algebra import Row
    from towercrane.kernels.load import Load, Momentary
    from towercrane.kernels.payload import Structure
    from towercrane.simulation.system import Switch, System

    Floats = NDArray[np.float64]


def on_its_rope(
    system: System, load: Load, rope: int, fastest: Callable[[float], float], rope_as_rod: bool = False
) -> System:
    """A crane's system, with what slings and an elastic rope add and take away if its load hangs on such.

    Parameters
    ----------
    system : System
        With an inextensible rope, whose tension is its first guard and whose direction the first of all.
    load : Load
    rope : int
        Row of the inputs that is the rope's length.
    fastest : callable
        Highest angular frequency of small motions with so much rope [rad/s], see :func:`fastest_on`.
    rope_as_rod : bool
        Whether the rope pushes.

    Raises
    ------
    ValueError
        If it does, and its elasticity does not say so; or if there is ground under a rope that is not elastic.
    """
    system = _with_slings(system, load)
    if load.elasticity is None:
        if load.ground is not None:
            raise ValueError("Load.ground: wanted None under a rope that does not stretch, got ground")
        return system
    rod = load.elasticity.mode == TAUT
    if rod and load.ground is not None:
        raise ValueError("Load.ground: wanted None under a rope that pushes, got ground")
    if rope_as_rod and not rod:
        raise ValueError("rope_as_rod: wanted a rope whose elasticity is always taut (mode=TAUT), got another")
    guards = guards_of(load)
    floors = np.concatenate([system.floors, np.full(len(guards), -np.inf)])
    floors[0] = -np.inf
    return replace(
        system,
        guards=(*system.guards, *guards),
        floors=floors,
        directions=system.directions[1:],
        switch=system.switch if rod else _switch(system, load),
        rope=rope,
        fastest=fastest,
    )


def guards_of(load: Load) -> tuple[str, ...]:
    """Guards that an elastic rope, and ground under its load, add behind all others."""
    if load.elasticity is None:
        return ()
    return slackening.GUARDS if load.ground is None else (*contact.GUARDS, *slackening.GUARDS)


def _switch(system: System, load: Load) -> Switch:
    places = {name: place_of(system.constants, name) for name in ("mode", "gravity")}
    rope = Slackening(places["mode"], system.switch)
    if load.ground is None:
        return rope
    ((first, rate, axes),) = system.directions.tolist()
    return Contact(
        rope,
        load,
        float(system.numbers[places["gravity"]]),
        place_of(system.constants, "contact"),
        place_of(system.constants, "sliding"),
        slice(first, first + axes),
        slice(rate, rate + axes),
    )


def _with_slings(system: System, load: Load) -> System:
    """A system with tensions of slings as guards behind all others, and their directions behind that of the rope."""
    if not (count := len(load.slings)):
        return system
    first, rate, axes = system.directions[0]
    ropes = [(first + axes * k, rate + axes * k, axes) for k in range(count + 1)]
    names = [SLACK_SLING] if count == 1 else [f"{SLACK_SLING} {k + 1}" for k in range(count)]
    return replace(
        system,
        guards=(*system.guards, *names),
        floors=np.append(system.floors, np.full(count, SLACK)),
        directions=np.array(ropes),
    )


def sling_force(load: Load | Momentary, guards: Row) -> Any:
    """Tension of the lowest sling, from the guards [N]."""
    return guards[-1 if load.elasticity is None else slackening.SLACKENS - 1]


def fastest_on(stiffness: Floats, hanging: Structure, load: Load, length: float) -> float:
    """Highest angular frequency of a crane's small motions with its load on so much rope [rad/s].

    On an inextensible rope a load only adds inertia, and is left out; on an elastic one it vibrates along the rope,
    whose direction is taken along each of the axes. A rope whose damping relaxes faster counts by that rate.

    Parameters
    ----------
    stiffness : ndarray, shape (n, n)
        Of the crane's coordinates.
    hanging : Structure
        The crane at rest.
    load : Load
    length : float
        [m]
    """
    n, mass = len(stiffness), hanging.mass_matrix()
    if load.elasticity is None:
        return float(np.sqrt(max(vibrations(stiffness, mass)[0][-1], 0.0))) if n else 0.0
    spring, highest = load.elasticity.spring(length), 0.0
    whole = np.zeros((n + 1, n + 1))
    whole[:n, :n], whole[n, n] = mass, load.lightest
    for row in hanging.jacobian:
        along = np.append(np.array(row, dtype=float), -1.0)
        held = spring * np.outer(along, along)
        relaxing = load.elasticity.relaxation_time * spring * (along @ np.linalg.solve(whole, along))
        held[:n, :n] += stiffness
        highest = max(highest, np.sqrt(max(vibrations(held, whole)[0][-1], 0.0)), relaxing)
    return float(highest)
