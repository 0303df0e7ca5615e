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
from towercrane.cranes.jib.outputs import ABOUT, Seen, driven_outputs, planned_outputs
from towercrane.kernels.payload import SLACK
from towercrane.simulation.observed import observe
from towercrane.simulation.outcomes import SLACK_ROPE
from towercrane.simulation.starts.start import OUT_OF_PLANE
from towercrane.simulation.starts.turning import Turning
from towercrane.simulation.system import System, check_start

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike, NDArray

    from towercrane.cranes.jib.parameters import JibCrane
    from towercrane.kernels.payload import Load

    Floats = NDArray[np.float64]

PLAN = ("slew", "luff", "fold", "rope")
"""Channels of a plan: three joint angles [rad] and the rope's length [m]."""

TORQUES = ("slew_torque", "luff_torque", "fold_torque", "rope")
"""Channels of a driven crane: three joint torques [N m] and the rope's length [m]."""

DRIVEN_ROPE = (equations.JOINTS, 2 * equations.JOINTS + equations.AXES)
"""Where the rope's direction and its rate begin in the state of a driven crane."""


@dataclass(frozen=True, eq=False)
class JibModel:
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

    about = ABOUT
    observe = observe
    sways = OUT_OF_PLANE

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
        return System(
            equations=rhs,
            size=works[-1] + 1,
            guards=guards,
            floors=floors,
            scale=scale,
            constants=self.constants,
            directions=np.array([(*rope, equations.AXES) for rope in ropes]),
        )

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
    turning = Turning(((0, 1), (equations.AXES, equations.AXES + 1)), (), 0)

    @cached_property
    def system(self) -> System:
        """The model as the solver sees it."""
        return self.make_system(equations.planned, (2 * equations.AXES,), ((0, equations.AXES),))

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
        return np.concatenate([hanging(state), np.zeros(equations.AXES + 1)])


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
        return self.make_system(equations.driven, (equations.PLAN - 1,), (DRIVEN_ROPE,))

    def start(self, inputs: Floats, state: str = "equilibrium") -> Floats:
        """State at the start angles with the load at rest; arguments as of :meth:`PlannedJibCrane.start`."""
        return driven_start(self.start_angles, self.start_rates, state)

    def jib_heading(self, state: Floats, _inputs: Floats) -> float:
        """Slewing angle of the booms [rad]."""
        return float(state[0])


def hanging(state: str) -> Floats:
    """Direction of a rope that hangs; shape (3,)."""
    check_start(state)
    return np.array([0.0, 0.0, -1.0])


def driven_start(angles: ArrayLike, rates: ArrayLike, state: str) -> Floats:
    """State (theta, n, theta', p, work) with the load at rest."""
    return np.concatenate([np.asarray(angles, dtype=float), hanging(state), rates, np.zeros(equations.AXES + 1)])
