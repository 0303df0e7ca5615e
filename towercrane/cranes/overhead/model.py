"""Overhead crane as a simulation asks for it: bridge and trolley on their motions, a bridge that bends, the load."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cranes.overhead import equations
from towercrane.cranes.overhead.outputs import ABOUT, SWAYS, Seen, overhead_outputs
from towercrane.cranes.parts.hoisting.elastic import fastest_on, on_its_rope
from towercrane.cranes.parts.hoisting.on_rope import OnRope
from towercrane.cranes.parts.points import rope_about
from towercrane.kernels.payload import SLACK, Structure
from towercrane.kernels.polynomial import polynomial
from towercrane.simulation.observed import observe
from towercrane.simulation.outcomes import SLACK_ROPE
from towercrane.simulation.system import System, check_start

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.cranes.overhead.parameters import OverheadCrane
    from towercrane.kernels.load import Load
    from towercrane.simulation.observed import About

    Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class OverheadModel(OnRope):
    """Overhead crane with a load in space.

    Parameters
    ----------
    crane : OverheadCrane
    load : Load
    rope_as_rod : bool
        Let the rope push. Without it a slack rope ends the run.

    Notes
    -----
    The state is (q, n, q', p, work): uplift of the bridge at mid-span [m], the rope's direction in fixed axes, their
    rates, and the work [J] that drives, winch and losses have put in.
    """

    crane: OverheadCrane
    load: Load
    rope_as_rod: bool = False

    axes, rope = equations.AXES, equations.ROPE_DIRECTION
    outputs = staticmethod(overhead_outputs)
    observe = observe

    @property
    def about(self) -> dict[str, About]:
        """What the outputs are."""
        return {**ABOUT, **rope_about(self.load, "the floor where runway and first rail begin", SWAYS)}

    @property
    def channels(self) -> tuple[str, ...]:
        """Motions: place of the bridge on the runway, of the trolley on the bridge, and the rope's length [m]."""
        return ("bridge", "trolley", "rope")

    @property
    def channel_units(self) -> tuple[str, ...]:
        """Units of the motions."""
        return ("m", "m", "m")

    @property
    def state_names(self) -> dict[str, str]:
        """Uplift and sways with their units."""
        return {"bridge_uplift": "m", "sway_x": "rad", "sway_y": "rad"}

    @cached_property
    def system(self) -> System:
        """The model as the solver sees it."""
        crane, load = self.crane, self.load
        guards = (SLACK_ROPE, "bridge force", "trolley force", "first rail", "second rail")
        half = equations.ROPE_DIRECTION + equations.AXES * len(load.bodies)
        scale = np.ones(2 * half + 1)
        scale[-1] = load.work_scale(crane.gravity, crane.bridge_span)
        system = System(
            equations=equations.equations,
            size=len(scale),
            guards=guards,
            floors=np.array([-np.inf if self.rope_as_rod else SLACK, *[-np.inf] * (len(guards) - 1)]),
            scale=scale,
            constants=equations.Constants(
                crane.bridge_span, crane.stiffness, crane.damping, crane.girder_mass, crane.bridge_end_carriage_mass,
                crane.trolley_mass, crane.gravity, crane.runway_height, load,
            ),
            directions=np.array([[equations.ROPE_DIRECTION, half + equations.ROPE_DIRECTION, equations.AXES]]),
            # A trolley on it only adds inertia.
            fastest=lambda: crane.frequency,
        )  # fmt: skip
        return on_its_rope(system, load, equations.ROPE, self.fastest_on, self.rope_as_rod)

    def fastest_on(self, length: float) -> float:
        """Highest angular frequency of its small motions on so much elastic rope [rad/s], the trolley at mid-span."""
        middle = np.array([[0.0, 0.0], [0.5 * self.crane.bridge_span, 0.0]])
        return fastest_on(np.array([[self.crane.stiffness]]), self.suspended(np.zeros(3), middle), self.load, length)

    def suspended(self, state: Floats, inputs: Floats) -> Structure:
        """Bridge and trolley in a state, as their drives move them."""
        bridge, trolley = (polynomial(inputs[row], 0.0) for row in (equations.BRIDGE, equations.TROLLEY))
        uplift, rate = state[equations.UPLIFT], state[len(state) // 2 + equations.UPLIFT]
        return equations.structure(self.system.constants, uplift, rate, bridge, trolley)

    def below(self, _state: Floats, inputs: Floats) -> tuple[float, float, float]:
        """Rope below the trolley, what the winch has given of it and its rate [m, m, m/s]."""
        length, rate, _ = polynomial(inputs[equations.ROPE], 0.0)
        return length, length, rate

    def load_at_rest(self, _inputs: Floats, load: Load) -> Floats:
        """Force on a load at rest [N]; shape (3,)."""
        return np.array([0.0, 0.0, -load.whole_mass * self.crane.gravity])

    def start(self, inputs: Floats, state: str = "equilibrium") -> Floats:
        """State in which bridge and load are at rest.

        Parameters
        ----------
        inputs : ndarray
            Polynomials of the first phase.
        state : str
            "equilibrium" under all weights, or "zero", the bridge straight.

        Returns
        -------
        ndarray, shape (size,)

        Raises
        ------
        ValueError
            If the state is not one of the two.
        """
        check_start(state)
        y = np.zeros(self.system.size)
        if state == "equilibrium":
            y[equations.UPLIFT] = self.crane.uplift_at_rest(inputs[equations.TROLLEY, 0], self.load.whole_mass)
        return self.hung(y, inputs, state)

    @property
    def seen(self) -> Seen:
        """What outputs are told beside the instant."""
        return Seen(self.system.constants)

    def provenance(self) -> dict[str, Any]:
        """Crane and load, for a result's attributes."""
        return {"crane": self.crane.name, "payload_mass": self.load.mass, "gravity": self.crane.gravity}
