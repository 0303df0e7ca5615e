"""A flexible crane at rest: the forces on it, and the coordinates at which it stands."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cranes.tower.equations.actions.collars import pressed_at_rest
from towercrane.cranes.tower.equations.constants import SLEWING, Constants, constants_of
from towercrane.cranes.tower.equations.coordinates import Coordinates
from towercrane.cranes.tower.equations.matrices import geometric_stiffness, scale
from towercrane.cranes.tower.equations.structure import static_force, structure
from towercrane.kernels.payload import State, Structure
from towercrane.kernels.straight.leaves import numbers_of
from towercrane.kernels.straight.written import written
from towercrane.simulation.equilibrium import Unstable, stable_equilibrium
from towercrane.simulation.outcomes import TOWER_BUCKLED
from towercrane.simulation.system import NoEquilibrium

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Resting(Coordinates):
    """A flexible crane that stands still, its load hanging at rest."""

    @cached_property
    def constants(self) -> Constants:
        """Constants of the equations."""
        return constants_of(self)

    def equilibrium(self, inputs: Floats) -> Floats:
        """Coordinates at rest under all weights and the wind; shape (coordinates,).

        Newton's method on f(q) + J_D^T F = 0 with the weight and the wind's force F of the load. The rope's direction
        is that of F, so the inverted pendulum cannot be found; the solution is refused unless it is stable.

        Raises
        ------
        NoEquilibrium
            If the stiffness is not positive definite, or no equilibrium is found.
        """
        n, origin = self.coordinates, self.undeformed(inputs)
        forces, held = self._forces_at_rest, np.ascontiguousarray(inputs[:, :1])

        def residual(departures: Floats) -> Floats:
            return forces(origin[:, None] + departures, held)

        try:
            return origin + stable_equilibrium(residual, scale(self)[:n], self._contact(origin, inputs))
        except Unstable as failure:
            raise self.gives_way(f"{failure}; ") from failure

    def undeformed(self, inputs: Floats) -> Floats:
        """Coordinates of the undeformed crane as its drives hold it; shape (coordinates,)."""
        origin = np.zeros(self.coordinates)
        if self.drive is not None:
            origin[self.parts["slewing"]] = inputs[SLEWING, 0]
        return origin

    def contact(self, q: Floats, inputs: Floats) -> tuple[Floats, Floats]:
        """Forces of collars with play on the crane at rest, and their stiffness there.

        Parameters
        ----------
        q : ndarray, shape (coordinates,)
        inputs : ndarray
            Polynomials of a phase, whose values count.
        """
        return pressed_at_rest(self.constants, q, [(value, 0.0, 0.0) for value in inputs[:, 0].tolist()])

    def _contact(self, origin: Floats, inputs: Floats) -> Callable[[Floats], tuple[Floats, Floats]] | None:
        """The same by departures from an origin; None without such collars."""
        return None if self.constants.play is None else lambda departures: self.contact(origin + departures, inputs)

    def static_forces(self, q: Floats, inputs: Floats) -> Floats:
        """Generalised forces on the crane at rest with its load hanging at rest, but for those of collars with play;
        shapes (coordinates, p)."""
        return self._forces_at_rest(q, np.ascontiguousarray(inputs[:, :1]))

    @cached_property
    def _forces_at_rest(self) -> Callable[[Floats, Floats], Floats]:
        return self._written_at_rest(static_force)

    def _written_at_rest(self, forces: Callable[..., Any]) -> Callable[[Floats, Floats], Floats]:
        constants, shape = replace(self.constants, play=None), (len(self.channels), 1)
        numbers = numbers_of(constants)
        code = written(forces, constants, [numbers], self.coordinates, shape)
        return code.values(numbers, self.constants.shapes)

    def gives_way(self, why: str = "") -> NoEquilibrium:
        """What is said of a crane that cannot stand."""
        return NoEquilibrium(TOWER_BUCKLED, f"{why}{self.buckling_message()}")

    def buckling_factor(self) -> float:
        """Factor on all weights at which the tower alone buckles in its modes; infinite for a rigid one [1]."""
        if not self.crane.tower.count:
            return np.inf
        geometric = np.linalg.eigvals(np.linalg.solve(self.crane.tower.stiffness_matrix(), geometric_stiffness(self)))
        return float(1.0 / geometric.real.max())

    def buckling_message(self) -> str:
        """How far the tower is from buckling."""
        if not self.crane.tower.count:
            return "the tower is rigid"
        return f"the tower alone would carry {self.buckling_factor():.3g} times the weight upon it"

    def at_rest(self, q: Floats, inputs: Floats) -> Structure:
        """The structure at rest at these coordinates, in the wind of the inputs, its drives held."""
        held = [(value, 0.0, 0.0) for value in inputs[:, 0].tolist()]
        state = State(q.tolist(), (), [0.0] * self.coordinates, ())
        return structure(self.constants, state, held).hanging
