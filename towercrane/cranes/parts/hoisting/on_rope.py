"""A load on its rope at the start of a run, whatever crane it hangs from and whether the rope stretches."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from towercrane.simulation.outcomes import IN_THE_GROUND
from towercrane.simulation.system import NoEquilibrium, check_start

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.kernels.load import Load
    from towercrane.kernels.payload import Structure

    Floats = NDArray[np.float64]


UNLOADED = 1e-6
"""Mass that stands for none [kg]."""


class OnRope(ABC):
    """A model with its load on a rope.

    It has ``load``, ``axes`` of the load's space, ``size`` of its state, and ``rope``: where the load's part of the
    state begins, so many places before that of its rate.
    """

    load: Any
    axes: Any
    rope: Any
    system: Any

    @abstractmethod
    def suspended(self, state: Floats, inputs: Floats) -> Structure:
        """The crane without its load in a state, its drives as their polynomials are at time zero."""

    @abstractmethod
    def below(self, state: Floats, inputs: Floats) -> tuple[float, float, float]:
        """Rope below what it hangs from, what the winch has given of it and the rate of that [m, m, m/s]."""

    @abstractmethod
    def load_at_rest(self, inputs: Floats, load: Load) -> Floats:
        """Force of weight and wind on a load, all of it that hangs or less, at rest [N]; shape (axes,)."""

    @property
    def carried(self) -> Load:
        """The load on the rope that it hangs on."""
        found: Load = self.load
        return found

    def hung(self, state: Floats, inputs: Floats, start: str) -> Floats:
        """A state with its load hanging at rest; unless the start is "zero", as it would hang in the wind.

        Raises
        ------
        ValueError
            If the start is none.
        NoEquilibrium
            If it would hang in the ground.
        """
        check_start(start)
        ground = self.carried.ground
        if ground is not None and ground.carries:
            return self._standing(inputs, start, ground.height)
        carried, still = self.carried, np.zeros(self.axes)
        links = [self._hanging(inputs, carried.under(k), start) for k in range(len(carried.bodies))]
        direction, tension = links[0]
        strain = tension / carried.elasticity.stiffness if carried.elasticity is not None else 0.0
        found = self._placed(state, inputs, direction, still, strain)
        for (first, moved, count), (own, _) in zip(self.slings, links[1:], strict=True):
            found[first : first + count], found[moved : moved + count] = own, still
        if ground is not None and start == "equilibrium":
            above = float(found[self.rope + self.axes - 1]) - ground.height
            if above < 0.0:
                raise NoEquilibrium(IN_THE_GROUND, f"the load would hang {-above:.4g} m below the ground")
        return found

    def _hanging(self, inputs: Floats, load: Load, start: str) -> tuple[Floats, float]:
        """Direction of the link that a load hangs on at rest, and its tension [N]."""
        force = self.load_at_rest(inputs, load) if start == "equilibrium" else np.zeros(self.axes)
        if not force.any():
            # Without weight and wind any direction will do.
            return -np.eye(self.axes)[-1], 0.0
        tension = float(np.linalg.norm(force))
        return force / tension, tension

    @property
    def slings(self) -> Any:
        """Rows of the table of directions that are slings."""
        return self.system.directions[len(self.system.directions) - len(self.carried.slings) :]

    @property
    def lifted(self) -> Self:
        """The same model without ground."""
        if self.load.ground is None:
            return self
        asked: Any = self
        found: Self = replace(asked, load=replace(self.load, ground=None))
        return found

    def standing(self, inputs: Floats) -> Self:
        """The same model with the ground under its load, where that stands on it at the start."""
        ground = self.load.ground
        if ground is None or not np.isnan(ground.height):
            return self
        asked: Any = self
        state = self._unloaded(inputs, "equilibrium")
        length, *_ = self.below(state, inputs)
        height = float(self.suspended(state, inputs).place[-1]) - (length - ground.slack)
        found: Self = replace(asked, load=replace(self.load, ground=replace(ground, height=height)))
        return found

    def _unloaded(self, inputs: Floats, start: str) -> Floats:
        """State of the crane at rest without a load."""
        found: Any = self
        bare = replace(self.load, mass=UNLOADED, elasticity=None, ground=None)
        return np.asarray(replace(found, load=bare).start(inputs, start))

    def _standing(self, inputs: Floats, start: str, height: float) -> Floats:
        """State of the crane at rest without a load, which stands below it on the ground."""
        found, moved = self._unloaded(inputs, start), self.system.size // 2 + self.rope
        place = np.array(self.suspended(found, inputs).place, dtype=float)
        place[-1] = height
        found[self.rope : self.rope + self.axes], found[moved : moved + self.axes] = place, 0.0
        return found

    def rope_direction(self, state: Floats, inputs: Floats) -> Floats:
        """Unit vector from where the rope hangs to the load; shape (3,)."""
        along = self._along(state, inputs)
        along = along / np.linalg.norm(along)
        return np.array([along[0], along[1] if self.axes == 3 else 0.0, along[-1]])

    def hang(self, state: Floats, inputs: Floats, direction: Floats, rate: Floats) -> Floats:
        """The state with its load along another direction, an elastic rope stretched by the part of the force on the
        load along it; both vectors of shape (3,)."""
        kept = [0, 1, 2] if self.axes == 3 else [0, 2]
        own, strain, elasticity = direction[kept], 0.0, self.carried.elasticity
        if elasticity is not None:
            length, wound, _ = self.below(state, inputs)
            before, force = self._along(state, inputs), self.load_at_rest(inputs, self.carried)
            reach = float(np.linalg.norm(before))
            strain = (reach - length) / (wound + elasticity.extra_length)
            if pulled := float(force @ before):
                strain *= max(float(force @ own) * reach / pulled, 0.0)
        return self._placed(state, inputs, own, rate[kept], strain)

    def _along(self, state: Floats, inputs: Floats) -> Floats:
        own = np.asarray(state[self.rope : self.rope + self.axes])
        if self.carried.elasticity is None:
            return own
        return np.asarray(own - np.array(self.suspended(state, inputs).place, dtype=float))

    def _placed(self, state: Floats, inputs: Floats, direction: Floats, rate: Floats, strain: float) -> Floats:
        found, elasticity = np.array(state), self.carried.elasticity
        if elasticity is not None:
            length, wound, hauled = self.below(state, inputs)
            crane, reach = self.suspended(state, inputs), length + strain * (wound + elasticity.extra_length)
            rate = np.array(crane.velocity, dtype=float) + (1.0 + strain) * hauled * direction + reach * rate
            direction = np.array(crane.place, dtype=float) + reach * direction
        ropes = (
            self.system.directions if elasticity is None else [(self.rope, len(state) // 2 + self.rope, self.axes)]
        )
        for first, moved, count in ropes:
            found[first : first + count], found[moved : moved + count] = direction, rate
        return found
