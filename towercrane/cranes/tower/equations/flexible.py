"""Equations of motion of a flexible crane in space, and the states of rest that they have."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from towercrane.cranes.parts.air import load_force
from towercrane.cranes.parts.corner import Corners
from towercrane.cranes.parts.friction import Transitions
from towercrane.cranes.parts.hoisting.elastic import fastest_on, on_its_rope
from towercrane.cranes.parts.hoisting.letting_go import CHANNEL, LettingGo, crossings_of
from towercrane.cranes.parts.hoisting.on_rope import OnRope
from towercrane.cranes.tower.equations import motion
from towercrane.cranes.tower.equations.actions.collars import corners_of, names_of
from towercrane.cranes.tower.equations.actions.wind import winds_of
from towercrane.cranes.tower.equations.constants import ROPE, SLEWING, TROLLEY, TURN
from towercrane.cranes.tower.equations.joints import Joints
from towercrane.cranes.tower.equations.matrices import scale, softening, stiffness
from towercrane.cranes.tower.equations.play import contact_stiffness
from towercrane.cranes.tower.equations.rest import Resting
from towercrane.cranes.tower.equations.structure import structure
from towercrane.kernels.payload import SLACK, State, Structure, state_of
from towercrane.kernels.polynomial import polynomial
from towercrane.kernels.straight.leaves import place_of
from towercrane.simulation.outcomes import SLACK_ROPE, TOWER_BUCKLED, TROLLEY_OFF_JIB
from towercrane.simulation.starts.turning import Turning
from towercrane.simulation.system import Switch, System

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from towercrane.kernels.load import Load
    from towercrane.motions.motion import Motion
    from towercrane.simulation.system import Crossings

    Floats = NDArray[np.float64]

ROUNDING = 1e-9
"""Way beyond an end of the jib that counts as parked on it [m]."""


@dataclass(frozen=True, eq=False)
class Equations(Resting, OnRope):
    """Equations of motion of a flexible crane with its load."""

    @cached_property
    def system(self) -> System:
        """The model as the solver sees it."""
        return self.on_its_rope(self.fixed_system)

    @property
    def fixed_system(self) -> System:
        """The same with an inextensible rope."""
        n = self.coordinates
        section = ("section", "section", "section") if self.constants.jointed else ()
        brake = ("slip", "stick", "needed") if self.constants.slewing == "free" else ()
        contacts, first = names_of(self.constants.play), motion.GUARDS + len(section) + len(brake)
        floors = np.full(first + len(contacts), -np.inf)
        floors[motion.TENSION] = -np.inf if self.rope_as_rod else SLACK
        floors[[motion.INNER_END, motion.OUTER_END]] = -ROUNDING
        floors[motion.TILT] = 0.0
        recorded = ("corner", "corner", "slewing torque", "trolley force")
        return System(
            equations=motion.motion,
            size=self.size,
            guards=(
                SLACK_ROPE,
                TROLLEY_OFF_JIB,
                TROLLEY_OFF_JIB,
                TOWER_BUCKLED,
                *recorded,
                *section,
                *brake,
                *contacts,
            ),
            floors=floors,
            scale=scale(self),
            constants=self.constants,
            directions=np.array([[n, self.size // 2 + n, self.axes]]),
            switch=self.switch((motion.INSIDE, motion.OUTSIDE), first),
            fastest=lambda: self.fastest,
            crossings=self.crossings,
        )

    @property
    def crossings(self) -> Crossings | None:
        """Instants at which its rates or its load jump."""
        joints = Joints(self.constants) if self.constants.jointed else None
        return crossings_of(joints, LettingGo(self) if self.load.release is not None else None)

    def corners(self, coupling: tuple[int, int], first: int) -> Corners | None:
        """Corners of forces, if there are any, of guards of the drive's coupling and of collars from a place on."""
        bends = self.drive is not None and self.drive.soft != self.drive.stiff
        found = (*([coupling] if bends else ()), *corners_of(self.constants.play, first))
        return Corners(found) if found else None

    def on_its_rope(self, system: System) -> System:
        """A system with what an elastic rope adds, if there is one."""
        return on_its_rope(system, self.load, ROPE, self.fastest_on, self.rope_as_rod)

    @property
    def held(self) -> Self:
        """The crane as small motions are of it: a head that is free stands where it begins."""
        return replace(self, slewing="prescribed", drive_inertia=0.0) if self.constants.slewing == "free" else self

    def switch(self, coupling: tuple[int, int], first: int) -> Switch | None:
        """Corners of forces, and of a head that is free its brake, whose guards stand before those of collars."""
        corners = self.corners(coupling, first)
        if self.constants.slewing != "free":
            return corners
        rate = self.coordinates + self.axes + self.parts["slewing"].start
        guards = first - 3, first - 2, first - 1
        return Transitions(rate, place_of(self.constants, "friction_state"), corners, guards, changes_equations=True)

    @cached_property
    def fastest(self) -> float:
        """Highest angular frequency of its small motions [rad/s]; zero without coordinates.

        Without load, its trolley at the tower, its drive at its stiffest, all collars met: a load can only lower it,
        by its inertia along the rope, and so does the trolley further out, but for one per cent where it hardly
        moves.
        """
        return self.fastest_on(np.inf)

    def fastest_on(self, length: float) -> float:
        """The same with the load on so much elastic rope, at the tower and at the jib's end."""
        return max(fastest_on(held, hanging, self.load, length) for held, hanging in self.small_motions)

    @cached_property
    def small_motions(self) -> list[tuple[Floats, Structure]]:
        """Stiffness and structure where it is to be sought."""
        held = self.stiffness_when_held
        return [(held, self.at_rest(np.zeros(self.coordinates), inputs)) for inputs in self.trolley_ends]

    @property
    def trolley_ends(self) -> list[Floats]:
        """Inputs with the trolley at the tower; where the rope stretches, also with it at the jib's end."""
        inputs = np.zeros((2, len(self.channels), 3))
        inputs[:, ROPE, 0], inputs[1, TROLLEY, 0] = 1.0, self.crane.jib_length
        return list(inputs[:1] if self.load.elasticity is None else inputs)

    @property
    def stiffness_when_held(self) -> Floats:
        """Stiffness with all collars met and the drive at its stiffest."""
        held = self.constants.stiffness + contact_stiffness(self)
        if self.drive is not None:
            turned = self.parts["slewing"].start
            held[turned, turned] += max(self.drive.soft, self.drive.stiff)
        return held

    def with_load(self, load: Load) -> Self:
        """The same crane with another load: what does not depend on the load is shared, not made again."""
        other = replace(self, load=load)
        steered = np.append(self.system.scale[:-1], load.work_scale(self.crane.gravity, self.crane.jib_length))
        constants, fastest = replace(self.constants, load=load), self.system.fastest
        if self.weight_softening:
            # The load's weight takes stiffness, and with it speed, from the tower.
            constants = replace(constants, stiffness=stiffness(other), softening=softening(other))
            fastest = lambda: other.fastest  # noqa: E731
        # Cached properties that are filled beforehand.
        vars(other)["constants"] = constants
        if self.load.elasticity is not None or load.elasticity is not None:
            return other
        vars(other)["system"] = replace(
            self.system, constants=constants, scale=steered, fastest=fastest, crossings=other.crossings
        )
        return other

    def settled(
        self, motions: Mapping[str, Motion] | Floats, time: float
    ) -> tuple[Self, Mapping[str, Motion] | Floats]:
        """The same crane with what hangs of its load at a time [s] for good, and its other motions.

        Raises
        ------
        ValueError
            If nothing hangs then.
        """
        if self.load.release is None:
            return self, motions
        row = self.constants.release
        if isinstance(motions, np.ndarray):
            gone, motions = np.polynomial.polynomial.polyval(time, motions[row]), np.delete(motions, row, axis=0)
        else:
            gone = motions[CHANNEL](time)
        left = self.load.now((float(gone), 0.0))
        if not left.mass > 0.0:
            raise ValueError(f"time: wanted one at which a load hangs, got {time:g} s")
        area = self.load.drag_area - self.load.release.drag_area * float(gone)
        return replace(self, load=replace(self.load, mass=left.mass, drag_area=area, release=None)), motions

    def start(self, inputs: Floats, state: str = "equilibrium") -> Floats:
        """State at rest, the load hanging at rest.

        Parameters
        ----------
        inputs : ndarray
            Polynomials of the first phase, the wind's at the value that counts, see
            :func:`towercrane.simulation.system.start_inputs`.
        state : str
            "equilibrium" (the static solution, in the wind) or "zero" (undeformed, all weights on, in still air).

        Returns
        -------
        ndarray, shape (size,)

        Raises
        ------
        NoEquilibrium
            If there is no stable equilibrium.
        ValueError
            If the state is not one of the two.
        """
        y = np.zeros(self.size)
        y[: self.coordinates] = self.equilibrium(inputs) if state == "equilibrium" else self.undeformed(inputs)
        return self.hung(y, inputs, state)

    def jib_heading(self, state: Floats, inputs: Floats) -> float:
        """Angle from the first axis of the coordinates to the jib's root [rad]."""
        given = float(inputs[SLEWING, 0]) if self.slewing == "prescribed" else 0.0
        n = self.constants.movers
        return given + float(self.constants.motions[TURN, :n] @ state[:n])

    @cached_property
    def turning(self) -> Turning | None:
        """What turns with the head, where a motion turns it."""
        if self.slewing == "fixed" or self.counts["tower_x"] != self.counts["tower_y"]:
            return None
        n, parts, half = self.coordinates, self.parts, self.size // 2
        x, y = (range(parts[kind].start, parts[kind].stop) for kind in ("tower_x", "tower_y"))
        places = [*zip(x, y, strict=True), *((first, first + 1) for first in range(n, half, self.axes))]
        rates = [(half + one, half + other) for one, other in places]
        return Turning((*places, *rates), range(parts["slewing"].start, parts["slewing"].stop), SLEWING)

    @property
    def rope(self) -> int:
        """Where the load's part of the state begins."""
        return self.coordinates

    def load_at_rest(self, inputs: Floats, load: Load) -> Floats:
        """Force of weight and wind on a load at rest [N]; shape (axes,)."""
        *_, air = winds_of(self.constants, [[value] for value in inputs[:, 0]])
        own = [air[k] for k in self.constants.fixed_axes]
        return np.array(load_force(load.now(inputs[self.constants.release]), self.constants.gravity, own))

    def below(self, state: Floats, inputs: Floats) -> tuple[float, float, float]:
        """Rope below what it hangs from, what the winch has given of it and its rate [m, m, m/s]."""
        wound, rate, _ = polynomial(inputs[ROPE], 0.0)
        return self.rope_at_rest(state[: self.coordinates], inputs), float(wound), rate

    def suspended(self, state: Floats, inputs: Floats) -> Structure:
        """The crane without its load in a state, moved by its drives."""
        return structure(self.constants, *self.as_driven(state, inputs)).hanging

    def as_driven(self, state: Floats, inputs: Floats) -> tuple[State, list[Any]]:
        """Parts of a state, and values, rates and accelerations of the drives."""
        drives = [polynomial(row, 0.0) for row in inputs.tolist()]
        return state_of(state.tolist(), self.coordinates, self.axes), drives

    @property
    def basis(self) -> Floats:
        """Numbers that tell the coordinates from those of another crane, or of modes of other signs: mass matrix of
        the undeformed crane, and what a rate of each moves the point that the rope hangs from."""
        inputs = np.zeros((len(self.channels), 3))
        own = self.crane.luffing
        inputs[:2, 0] = 0.7 * self.crane.jib_length if own is None else own.reference_angle, self.crane.jib_length
        there = self.at_rest(self.undeformed(inputs), inputs)
        return np.concatenate([there.mass_matrix().ravel(), np.ravel(there.jacobian)])

    def paid_out(self, _state: Floats, _inputs: Floats) -> float:
        """Rate at which the crane's motion pays out rope beside the winch [m/s]."""
        return 0.0

    def rope_at_rest(self, _q: Floats, inputs: Floats) -> float:
        """Length of the rope below what it hangs from [m]."""
        return float(inputs[ROPE, 0])
