"""Jib crane with slewing post, luffing boom, folding boom and a load on a rope of prescribed length.

Source: Al-Ajmi, Abu-El Yazied, Abu-El-Hagag, Makady, Dynamic modeling and load sway simulation of jib cranes; the
equations are derived anew, see :mod:`towercrane.cranes.jib.equations`. Each model answers one question:
:class:`PlannedJibCrane` which torques a plan needs and how the load then sways, :class:`DrivenJibCrane` how the
crane moves under given torques, :class:`towercrane.cranes.jib.tracking.TrackingJibCrane` how it moves under
the torques of its plan.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cranes.jib import equations
from towercrane.cranes.jib.outputs import ABOUT, ORIGIN, SWAYS, Seen, driven_outputs, planned_outputs
from towercrane.cranes.parts.hoisting.elastic import fastest_on, on_its_rope
from towercrane.cranes.parts.hoisting.on_rope import OnRope
from towercrane.cranes.parts.points import rope_about
from towercrane.kernels.payload import SLACK, Structure
from towercrane.kernels.polynomial import polynomial
from towercrane.simulation.observed import observe
from towercrane.simulation.outcomes import SLACK_ROPE
from towercrane.simulation.starts.start import OUT_OF_PLANE
from towercrane.simulation.starts.turning import Turning
from towercrane.simulation.system import System

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from towercrane.cranes.jib.parameters import JibCrane
    from towercrane.kernels.load import Load
    from towercrane.simulation.observed import About

    Floats = NDArray[np.float64]

PLAN = ("slew", "luff", "fold", "rope")
"""Channels of a plan: three joint angles [rad] and the rope's length [m]."""

TORQUES = ("slew_torque", "luff_torque", "fold_torque", "rope")
"""Channels of a driven crane: three joint torques [N m] and the rope's length [m]."""

DRIVEN_ROPE = (equations.JOINTS, 2 * equations.JOINTS + equations.AXES)
"""Where the rope's direction and its rate begin in the state of a driven crane."""


@dataclass(frozen=True, eq=False)
class JibModel(OnRope):
    """What the models of a jib crane share.

    Parameters
    ----------
    crane : JibCrane
    load : Load
    rope_as_rod : bool
        Let the rope push. Without it a slack rope ends the run.
    """

    crane: JibCrane
    load: Load
    rope_as_rod: bool = field(default=False, kw_only=True)

    axes, rope = equations.AXES, 0
    observe = observe
    sways = OUT_OF_PLANE

    @property
    def about(self) -> dict[str, About]:
        """What the outputs are."""
        return {**ABOUT, **rope_about(self.load, ORIGIN, SWAYS)}

    @property
    def channels(self) -> tuple[str, ...]:
        """Motions: the three joint angles [rad] and the rope's length [m]."""
        return PLAN

    @property
    def channel_units(self) -> tuple[str, ...]:
        """Units of the motions."""
        return ("rad", "rad", "rad", "m")

    @cached_property
    def constants(self) -> equations.Constants:
        """The crane as its equations know it."""
        return equations.Constants(self.crane, self.load)

    @property
    def seen(self) -> Seen:
        """What outputs are told beside the instant."""
        return Seen(self.constants)

    def make_system(
        self,
        rhs: Callable[..., Any],
        works: tuple[int, ...],
        ropes: tuple[tuple[int, int], ...],
        more_guards: tuple[str, ...] = (),
    ) -> System:
        """System whose states in ``works`` are work done, the last of them the last state.

        ``ropes`` says where the direction of each rope and its rate begin.
        """
        guards = (SLACK_ROPE, *TORQUES[: equations.JOINTS], *more_guards)
        floors = np.full(len(guards), -np.inf)
        if not self.rope_as_rod:
            floors[equations.TENSION] = floors[equations.PLANNED_TENSION :] = SLACK
        scale = np.ones(works[-1] + 1)
        reach = self.crane.primary_length + self.crane.secondary_length
        scale[list(works)] = self.load.work_scale(self.crane.gravity, reach)
        system = System(
            equations=rhs,
            size=works[-1] + 1,
            guards=guards,
            floors=floors,
            scale=scale,
            constants=self.constants,
            directions=np.array([(*rope, equations.AXES) for rope in ropes]),
        )
        return on_its_rope(system, self.load, equations.ROPE, self.fastest_on, self.rope_as_rod)

    def fastest_on(self, length: float) -> float:
        """Highest angular frequency of the load on so much elastic rope, the joints on their paths [rad/s]."""
        held = Structure([], [], [], [], [], [[]] * equations.AXES)
        return fastest_on(np.zeros((0, 0)), held, self.load, length)

    def suspended(self, state: Floats, inputs: Floats) -> Structure:
        """The booms in a state, on the paths of their inputs."""
        angles, rates = inputs[: equations.JOINTS, 0], inputs[: equations.JOINTS, 1]
        return equations.structure(self.crane, angles, rates)

    def below(self, _state: Floats, inputs: Floats) -> tuple[float, float, float]:
        """Rope below the booms' end, what the winch has given of it and its rate [m, m, m/s]."""
        length, rate, _ = polynomial(inputs[equations.ROPE], 0.0)
        return length, length, rate

    def load_at_rest(self, _inputs: Floats, load: Load) -> Floats:
        """Force on the load at rest [N]; shape (3,)."""
        return np.array([0.0, 0.0, -load.whole_mass * self.crane.gravity])

    def jib_heading(self, _state: Floats, inputs: Floats) -> float:
        """Slewing angle of the booms [rad]."""
        return float(inputs[0, 0])

    def provenance(self) -> dict[str, Any]:
        """Crane and load, for a result's attributes."""
        return {"crane": self.crane.name, "payload_mass": self.load.mass, "gravity": self.crane.gravity}


@dataclass(frozen=True, eq=False)
class PlannedJibCrane(JibModel):
    """Joints on prescribed paths: sway of the load, and the joint torques by inverse dynamics.

    Parameters
    ----------
    crane : JibCrane
    load : Load
    rope_as_rod : bool
        Let the rope push. Without it a slack rope ends the run.

    Notes
    -----
    The state is (n, p, work): the rope's direction in inertial axes, its rate, and the work [J] that joints, winch
    and losses have put in. Where a joint's acceleration jumps, so does its torque; every row holds the right limit.
    """

    outputs = staticmethod(planned_outputs)

    @cached_property
    def system(self) -> System:
        """The model as the solver sees it."""
        half = equations.AXES * len(self.load.bodies)
        return self.make_system(equations.planned, (2 * half,), ((0, half),))

    @property
    def turning(self) -> Turning:
        """What turns with the post."""
        ropes = range(0, self.system.size - 1, equations.AXES)
        return Turning([(first, first + 1) for first in ropes], (), 0)

    def start(self, inputs: Floats, state: str = "equilibrium") -> Floats:
        """State in which the load hangs at rest in inertial axes.

        Parameters
        ----------
        inputs : ndarray
            Polynomials of the first phase.
        state : str
            "equilibrium" or "zero", the same for rigid booms.

        Returns
        -------
        ndarray, shape (size,)

        Raises
        ------
        ValueError
            If the state is not one of the two.
        """
        return self.hung(np.zeros(self.system.size), inputs, state)


def check_bare(model: JibModel) -> None:
    """Refuse slings where joints move under torques.

    Raises
    ------
    ValueError
    """
    if model.load.slings:
        raise ValueError(f"{type(model).__name__}.load: wanted a load on its rope, got one below a hook on slings")


@dataclass(frozen=True, eq=False)
class DrivenJibCrane(JibModel):
    """Joints that move under given torques.

    Parameters
    ----------
    crane : JibCrane
    load : Load
    start_angles, start_rates : tuple of float
        Slew, luff and fold at the start [rad], and their rates [rad/s].
    rope_as_rod : bool
        Let the rope push. Without it a slack rope ends the run.

    Notes
    -----
    The state is (theta, n, theta', p, work). Torques are piecewise polynomials of the same class as motions. Booms
    under torques alone are inverted pendulums: whatever the solver, errors grow at the rates of
    :func:`towercrane.cranes.jib.linear.growth_rates`.
    """

    start_angles: tuple[float, float, float]
    start_rates: tuple[float, float, float] = (0.0, 0.0, 0.0)

    rope = equations.JOINTS
    outputs = staticmethod(driven_outputs)

    @property
    def channels(self) -> tuple[str, ...]:
        """Motions: the three joint torques [N m] and the rope's length [m]."""
        return TORQUES

    @property
    def channel_units(self) -> tuple[str, ...]:
        """Units of the motions."""
        return ("N m", "N m", "N m", "m")

    @property
    def state_names(self) -> dict[str, str]:
        """Joint angles with their units."""
        return {"slew_angle": "rad", "luff_angle": "rad", "fold_angle": "rad"}

    @cached_property
    def system(self) -> System:
        """The model as the solver sees it."""
        check_bare(self)
        return self.make_system(equations.driven, (equations.PLAN - 1,), (DRIVEN_ROPE,))

    def start(self, inputs: Floats, state: str = "equilibrium") -> Floats:
        """State at the start angles with the load at rest; arguments as of :meth:`PlannedJibCrane.start`."""
        found = np.zeros(self.system.size)
        found[: equations.JOINTS] = self.start_angles
        found[equations.JOINTS + equations.AXES : 2 * equations.JOINTS + equations.AXES] = self.start_rates
        return self.hung(found, inputs, state)

    def suspended(self, state: Floats, _inputs: Floats) -> Structure:
        """The booms in a state."""
        angles, rates = state[: equations.JOINTS], state[equations.JOINTS + equations.AXES :][: equations.JOINTS]
        return equations.structure(self.crane, angles, rates)

    def jib_heading(self, state: Floats, _inputs: Floats) -> float:
        """Slewing angle of the booms [rad]."""
        return float(state[0])

    def fastest_on(self, length: float) -> float:
        """Highest angular frequency of load and booms where they begin, on so much elastic rope [rad/s]."""
        joints = np.zeros((equations.JOINTS, equations.JOINTS))
        booms = equations.structure(self.crane, self.start_angles, self.start_rates)
        return fastest_on(joints, booms, self.load, length)
