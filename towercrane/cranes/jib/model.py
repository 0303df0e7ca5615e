"""Jib crane with slewing post, luffing boom, folding boom and a load on a rope of prescribed length.

Source: Al-Ajmi, Abu-El Yazied, Abu-El-Hagag, Makady, Dynamic modeling and load sway simulation of jib cranes; the
equations are derived anew, see :mod:`towercrane.cranes.jib.kernel`. Each model answers one question:
:class:`PlannedJibCrane` which torques a plan needs and how the load then sways, :class:`DrivenJibCrane` how the
crane moves under given torques, :class:`towercrane.cranes.jib.tracking.TrackingJibCrane` how it moves under
the torques of its plan.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from modal.checks import check_fields
from towercrane.cranes.jib import kernel
from towercrane.kernels.payload import SLACK
from towercrane.kernels.straight.written import Known
from towercrane.simulation.outcomes import SLACK_ROPE
from towercrane.simulation.system import System

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from towercrane.kernels.payload import Load
    from towercrane.motions.motion import Motion
    from towercrane.results.recording import Quantity

    Floats = NDArray[np.float64]

PLAN = ("slew", "luff", "fold", "rope")
"""Channels of a plan: three joint angles [rad] and the rope's length [m]."""

TORQUES = ("slew_torque", "luff_torque", "fold_torque", "rope")
"""Channels of a driven crane: three joint torques [N m] and the rope's length [m]."""

DRIVEN_ROPE = (kernel.JOINTS, 2 * kernel.JOINTS + kernel.AXES)
"""Where the rope's direction and its rate begin in the state of a driven crane."""


@dataclass(frozen=True, slots=True)
class JibCrane:
    """Parameters of a jib crane with two straight, uniform booms in one vertical plane.

    Parameters
    ----------
    name : str
    post_height : float
        Height a_1 of the luffing hinge above the post's foot [m].
    post_inertia : float
        Moment of inertia J_1 of all that only slews, about the post [kg m^2].
    primary_length, secondary_length : float
        Lengths a_2 and a_3 of the booms [m].
    primary_mass_per_length, secondary_mass_per_length : float
        Masses per length rho_2 and rho_3 of the booms [kg/m].
    gravity : float
        Acceleration of gravity [m/s^2].

    Raises
    ------
    ValueError
        If a length, a mass per length or gravity is not positive, or height or inertia is negative.
    """

    name: str
    post_height: float
    post_inertia: float
    primary_length: float
    primary_mass_per_length: float
    secondary_length: float
    secondary_mass_per_length: float
    gravity: float = 9.81

    def __post_init__(self) -> None:
        booms = [f"{boom}_{what}" for boom in ("primary", "secondary") for what in ("length", "mass_per_length")]
        check_fields(self, positive=(*booms, "gravity"), not_negative=("post_height", "post_inertia"))


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

    @property
    def channels(self) -> tuple[str, ...]:
        """Motions: the three joint angles [rad] and the rope's length [m]."""
        return PLAN

    @property
    def channel_units(self) -> tuple[str, ...]:
        """Units of the motions."""
        return ("rad", "rad", "rad", "m")

    @property
    def numbers(self) -> Floats:
        """Constants of the compiled structure; shape (13,)."""
        crane, load = self.crane, self.load
        numbers = np.zeros(13)
        numbers[: kernel.STIFFNESS] = (
            crane.post_height, crane.post_inertia, crane.primary_length, crane.primary_mass_per_length,
            crane.secondary_length, crane.secondary_mass_per_length, crane.gravity,
            load.mass, load.drag, load.rope_damping,
        )  # fmt: skip
        return numbers

    def make_system(
        self,
        rhs: Any,
        works: tuple[int, ...],
        numbers: Floats,
        ropes: tuple[tuple[int, int], ...],
        more_guards: tuple[str, ...] = (),
    ) -> System:
        """System whose states in ``works`` are work done, the last of them the last state.

        ``ropes`` says where the direction of each rope and its rate begin.
        """
        guards = (SLACK_ROPE, *TORQUES[: kernel.JOINTS], *more_guards)
        floors = np.full(len(guards), -np.inf)
        if not self.rope_as_rod:
            floors[kernel.TENSION] = floors[kernel.PLANNED_TENSION :] = SLACK
        scale = np.ones(works[-1] + 1)
        reach = self.crane.primary_length + self.crane.secondary_length
        scale[list(works)] = self.load.work_scale(self.crane.gravity, reach)
        return System(
            equations=lambda: rhs,
            size=works[-1] + 1,
            guards=guards,
            floors=floors,
            scale=scale,
            numbers=numbers,
            vectors=np.empty((0, 0)),
            matrices=np.empty((0, 0, 0)),
            tables=np.empty((0, 0, 0)),
            work_shape=(kernel.ROWS, kernel.JOINTS),
            known=Known(),
            directions=np.array([(*rope, kernel.AXES) for rope in ropes]),
        )

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

    @cached_property
    def system(self) -> System:
        """The model as the solver sees it."""
        return self.make_system(kernel.planned_rhs, (2 * kernel.AXES,), self.numbers, ((0, kernel.AXES),))

    def start(self, inputs: Floats, state: str = "equilibrium", swing_angle: float = 0.0) -> Floats:
        """State in which the load hangs at rest in inertial axes.

        Parameters
        ----------
        inputs : ndarray
            Polynomials of the first phase.
        state : str
            "equilibrium" or "zero", the same for rigid booms.
        swing_angle : float
            In-plane angle of the rope from the vertical, positive outward [rad].

        Returns
        -------
        ndarray, shape (size,)

        Raises
        ------
        ValueError
            If the state is not one of the two.
        """
        return np.concatenate([hanging(float(inputs[0, 0]), state, swing_angle), np.zeros(kernel.AXES + 1)])

    def observe(
        self, motions: dict[str, Motion], times: Floats, states: Floats, guards: Floats
    ) -> dict[str, Quantity]:
        """Outputs over time, see :func:`towercrane.cranes.jib.outputs.observe`."""
        from towercrane.cranes.jib.outputs import Rows, observe, planned_joints

        angles, rates = planned_joints(motions, times)
        n = kernel.AXES
        return observe(
            self.numbers,
            self.load,
            motions,
            times,
            Rows(angles, rates, states[:, :n], states[:, n : 2 * n], states[:, -1]),
            guards,
        )


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
        return self.make_system(kernel.driven_rhs, (kernel.PLAN - 1,), self.numbers, (DRIVEN_ROPE,))

    def start(self, inputs: Floats, state: str = "equilibrium", swing_angle: float = 0.0) -> Floats:
        """State at the start angles with the load at rest; arguments as of :meth:`PlannedJibCrane.start`."""
        return driven_start(self.start_angles, self.start_rates, state, swing_angle)

    def observe(
        self, motions: dict[str, Motion], times: Floats, states: Floats, guards: Floats
    ) -> dict[str, Quantity]:
        """Outputs over time, see :func:`towercrane.cranes.jib.outputs.observe`."""
        from towercrane.cranes.jib.outputs import driven_rows, observe

        return observe(self.numbers, self.load, motions, times, driven_rows(states), guards)


def hanging(slew: float, state: str, swing_angle: float) -> Floats:
    """Direction of a rope that hangs in the booms' plane; shape (3,)."""
    if state not in ("equilibrium", "zero"):
        raise ValueError(f"state: wanted 'equilibrium' or 'zero', got {state!r}")
    outward = np.sin(swing_angle)
    return np.array([outward * np.cos(slew), outward * np.sin(slew), -np.cos(swing_angle)])


def driven_start(angles: ArrayLike, rates: ArrayLike, state: str, swing_angle: float) -> Floats:
    """State (theta, n, theta', p, work) with the load at rest."""
    theta = np.asarray(angles, dtype=float)
    return np.concatenate([theta, hanging(theta[0], state, swing_angle), rates, np.zeros(kernel.AXES + 1)])
