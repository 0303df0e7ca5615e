"""Overhead crane as a simulation asks for it: bridge and trolley on their motions, a bridge that bends, the load."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cranes.overhead import equations
from towercrane.cranes.overhead.outputs import ABOUT, Seen, overhead_outputs
from towercrane.kernels.payload import SLACK
from towercrane.simulation.observed import observe
from towercrane.simulation.outcomes import SLACK_ROPE
from towercrane.simulation.system import System, check_start

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.cranes.overhead.parameters import OverheadCrane
    from towercrane.kernels.payload import Load

    Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class OverheadModel:
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

    outputs = staticmethod(overhead_outputs)
    about = ABOUT
    observe = observe

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
        scale = np.ones(equations.SIZE)
        scale[equations.WORK] = load.work_scale(crane.gravity, crane.bridge_span)
        return System(
            equations=equations.equations,
            size=equations.SIZE,
            guards=guards,
            floors=np.array([-np.inf if self.rope_as_rod else SLACK, *[-np.inf] * (len(guards) - 1)]),
            scale=scale,
            constants=equations.Constants(
                crane.bridge_span, crane.stiffness, crane.damping, crane.girder_mass, crane.bridge_end_carriage_mass,
                crane.trolley_mass, crane.gravity, load,
            ),
            directions=np.array([[equations.ROPE_DIRECTION, equations.SWAY, equations.AXES]]),
            # A trolley on it only adds inertia.
            fastest=lambda: crane.frequency,
        )  # fmt: skip

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
        y = np.zeros(equations.SIZE)
        if state == "equilibrium":
            y[equations.UPLIFT] = self.crane.uplift_at_rest(inputs[equations.TROLLEY, 0], self.load.mass)
        y[equations.ROPE_DIRECTION + equations.AXES - 1] = -1.0
        return y

    @property
    def seen(self) -> Seen:
        """What outputs are told beside the instant."""
        return Seen(self.system.constants, self.crane.runway_height)

    def provenance(self) -> dict[str, Any]:
        """Crane and load, for a result's attributes."""
        return {"crane": self.crane.name, "payload_mass": self.load.mass, "gravity": self.crane.gravity}
