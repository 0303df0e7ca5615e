"""An elastic rope as the solver sees it: where it goes slack and is caught, how fast it vibrates, how it begins."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from towercrane.kernels.algebra import vibrations
from towercrane.kernels.elastic_rope import SLACK_MODE, TAUT
from towercrane.kernels.straight.leaves import place_of
from towercrane.simulation.outcomes import ROPE_CAUGHT, ROPE_SLACK

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from towercrane.kernels.payload import Load, Structure
    from towercrane.simulation.system import Switch, System

    Floats = NDArray[np.float64]

GUARDS = (ROPE_SLACK, ROPE_CAUGHT, "rope energy")
"""Guards of an elastic rope, behind all others: strains to where it slackens and to where it is caught, and its
energy [J], which is only recorded."""

SLACKENS, CATCHES, STORED = -3, -2, -1
"""Their places."""


@dataclass(frozen=True, slots=True)
class Slackening:
    """A rope that goes slack and is caught, beside whatever else of a crane switches.

    A rope that slackens while it retracts leaves some strain to its own damping: what that stores is lost, and is
    there again if the rope is caught before it is gone.

    Parameters
    ----------
    mode : int
        Where the numbers have the rope's mode.
    other : Switch or None
        Of the crane.
    """

    mode: int
    other: Switch | None

    @property
    def changes_equations(self) -> bool:
        """Always."""
        return True

    def begin(self, state: Floats, numbers: Floats, floors: Floats, guards_at: Callable[[], Floats]) -> None:
        """Set the rope's mode from the state, then the others."""
        taut = float(guards_at()[SLACKENS]) > 0.0
        if numbers[self.mode] in (SLACK_MODE, TAUT) and taut != (numbers[self.mode] == TAUT):
            # The winch's speed has jumped.
            self._turn(taut, state, numbers, floors, guards_at)
        self._set(taut, numbers, floors)
        if self.other is not None:
            self.other.begin(state, numbers, floors, guards_at)

    def cross(
        self, guard: int, state: Floats, numbers: Floats, floors: Floats, guards_at: Callable[[], Floats]
    ) -> bool:
        """Set what holds after a guard."""
        if guard - len(floors) in (SLACKENS, CATCHES):
            self._turn(guard - len(floors) == CATCHES, state, numbers, floors, guards_at)
            return True
        return self.other is not None and self.other.cross(guard, state, numbers, floors, guards_at)

    def _turn(
        self, taut: bool, state: Floats, numbers: Floats, floors: Floats, guards_at: Callable[[], Floats]
    ) -> None:
        self._set(True, numbers, floors)
        state[-1] += guards_at()[STORED] * (1.0 if taut else -1.0)
        self._set(taut, numbers, floors)

    def _set(self, taut: bool, numbers: Floats, floors: Floats) -> None:
        numbers[self.mode] = TAUT if taut else SLACK_MODE
        floors[SLACKENS], floors[CATCHES] = (0.0, -np.inf) if taut else (-np.inf, 0.0)


def on_its_rope(
    system: System, load: Load, rope: int, fastest: Callable[[float], float], rope_as_rod: bool = False
) -> System:
    """A crane's system, with what an elastic rope adds and takes away if it hangs its load on one.

    Parameters
    ----------
    system : System
        With an inextensible rope, whose tension is its first guard.
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
        If it does, and its elasticity does not say so.
    """
    if load.elasticity is None:
        return system
    rod = load.elasticity.mode == TAUT
    if rope_as_rod and not rod:
        raise ValueError("rope_as_rod: wanted a rope whose elasticity is always taut (mode=TAUT), got another")
    floors = np.concatenate([system.floors, np.full(len(GUARDS), -np.inf)])
    floors[0] = -np.inf
    return replace(
        system,
        guards=(*system.guards, *GUARDS),
        floors=floors,
        directions=system.directions[:0],
        switch=system.switch if rod else Slackening(place_of(system.constants, "mode"), system.switch),
        rope=rope,
        fastest=fastest,
    )


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
    whole[:n, :n], whole[n, n] = mass, load.mass
    for row in hanging.jacobian:
        along = np.append(np.array(row, dtype=float), -1.0)
        held = spring * np.outer(along, along)
        relaxing = load.elasticity.relaxation_time * spring * (along @ np.linalg.solve(whole, along))
        held[:n, :n] += stiffness
        highest = max(highest, np.sqrt(max(vibrations(held, whole)[0][-1], 0.0)), relaxing)
    return float(highest)
