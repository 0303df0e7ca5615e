"""Jib crane under the torques of its plan, solved beside the plan itself."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from modal.checks import check_fields
from towercrane.cranes.jib import equations
from towercrane.cranes.jib.model import DRIVEN_ROPE, JibModel, check_bare
from towercrane.cranes.jib.outputs import TRACKING_ABOUT, tracking_outputs
from towercrane.simulation.outcomes import SLACK_ROPE

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.simulation.observed import About
    from towercrane.simulation.system import System

    Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class TrackingJibCrane(JibModel):
    """Joints under the torques of their plan, with or without a controller that holds them to it.

    Plan and crane are solved side by side: tau = tau_plan - stiffness (theta - theta_plan) - damping
    (theta' - theta_plan'), where tau_plan is the inverse dynamics of the plan and its own load.

    Parameters
    ----------
    crane : JibCrane
    load : Load
    stiffness : float
        Torque per angle that a joint is off its plan, the same for each [N m/rad]; 0 is open loop.
    damping : float
        Torque per rate that a joint is off its plan [N m s/rad].
    rope_as_rod : bool
        Let the rope push. Without it a slack rope, of crane or plan, ends the run.

    Raises
    ------
    ValueError
        If a gain is negative.
    """

    stiffness: float = 0.0
    damping: float = 0.0

    rope = equations.JOINTS
    outputs = staticmethod(tracking_outputs)

    @property
    def about(self) -> dict[str, About]:
        """What the outputs are."""
        return TRACKING_ABOUT

    def __post_init__(self) -> None:
        check_fields(self, not_negative=("stiffness", "damping"))
        if self.load.elasticity is not None:
            raise ValueError("TrackingJibCrane.load: wanted a rope that does not stretch, got an elastic one")
        check_bare(self)

    @cached_property
    def constants(self) -> equations.Constants:
        """Crane and gains as the equations know them."""
        return equations.Constants(self.crane, self.load, self.stiffness, self.damping)

    @cached_property
    def system(self) -> System:
        """The model as the solver sees it."""
        ropes = DRIVEN_ROPE, (equations.PLAN, equations.PLAN + equations.AXES)
        works = (equations.PLAN - 1, equations.PLAN + 2 * equations.AXES)
        return self.make_system(equations.tracking, works, ropes, (f"{SLACK_ROPE} in the plan",))

    def start(self, inputs: Floats, state: str = "equilibrium") -> Floats:
        """State on the plan with both loads at rest; arguments as of :meth:`PlannedJibCrane.start`."""
        found = np.zeros(self.system.size)
        rates = slice(DRIVEN_ROPE[1] - equations.JOINTS, DRIVEN_ROPE[1])
        found[: equations.JOINTS], found[rates] = inputs[: equations.JOINTS, 0], inputs[: equations.JOINTS, 1]
        return self.hung(found, inputs, state)
