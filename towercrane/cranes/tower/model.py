"""Flexible crane in space: equations of motion in chosen modes, for simulation, equilibrium and small motions."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from modal.checks import check_fields
from towercrane.cranes.parts.corner import Corner
from towercrane.cranes.parts.wind import CHANNELS
from towercrane.cranes.tower.constants import geometric_stiffness, matrices, numbers, scale, vectors
from towercrane.cranes.tower.damping import ModalDamping
from towercrane.cranes.tower.frequency_cap import added_mass
from towercrane.cranes.tower.kernels import drive as drive_kernel
from towercrane.cranes.tower.kernels import layout
from towercrane.cranes.tower.kernels import structure as flexible_kernel
from towercrane.cranes.tower.shape_table import shape_table
from towercrane.cranes.tower.small_motions import fastest_vibration
from towercrane.kernels.payload import FORCE, JACOBIAN, SLACK, WIND, Load, work_shape
from towercrane.simulation.equilibrium import Unstable, stable_equilibrium
from towercrane.simulation.system import NoEquilibrium, System

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from towercrane.cranes.slewing.description import Drive
    from towercrane.cranes.tower.modal_crane import FlexibleCrane
    from towercrane.motions.motion import Motion
    from towercrane.results.recording import Quantity

    Floats = NDArray[np.float64]

SLACK_ROPE = "slack rope"
TROLLEY_OFF_JIB = "trolley off the jib"
TOWER_BUCKLED = "tower buckled"

ROUNDING = 1e-9
"""Way beyond an end of the jib that counts as parked on it [m]."""


@dataclass(frozen=True, eq=False)
class FlexibleModel:
    """Equations of motion of a flexible crane with its load.

    Parameters
    ----------
    crane : FlexibleCrane
        With as many modes as are to move; made by :func:`towercrane.cranes.tower.modal_crane.flexible_crane`.
    load : Load
    slewing : {"prescribed", "fixed"} or Drive
        The slewing angle of the head on the tower's top as a motion, at zero, or as a coordinate that a drive with an
        elastic coupling turns.
    drive_inertia : float
        Moment of inertia that turns with the slewing angle and does not tilt [kg m^2]; with a drive only.
    damping : ModalDamping
    weight_softening : bool
        Include the geometric stiffness of the weight above each section of the tower.
    self_weight : bool
        Whether the structure has weight; without it only trolley and load do.
    rope_as_rod : bool
        Let the rope push, as most published models do. Without it a slack rope ends the run.
    wind : bool
        Whether a wind blows, prescribed by motions of its three components.
    axes : {2, 3}
        2 for a load that swings in the plane of a jib at rest, 3 in space.
    cap : float
        Highest frequency [Hz] of a mode by itself: every mode after a member's second that is faster keeps its
        stiffness and is made so slow by mass added to its own coordinate (selective mass scaling). The static
        flexibility stays exact and energy is conserved; what vibrates near the cap or beyond it is not.

    Raises
    ------
    ValueError
        If the cap is not positive, a crane that leaves the plane is asked to stay in it, the slewing is of no known
        kind, the drive's friction is set-valued, or there is inertia of a drive without a drive.
    """

    crane: FlexibleCrane
    load: Load
    slewing: Literal["prescribed", "fixed"] | Drive = "prescribed"
    drive_inertia: float = 0.0
    damping: ModalDamping = field(default_factory=ModalDamping)
    weight_softening: bool = False
    self_weight: bool = True
    rope_as_rod: bool = False
    wind: bool = False
    axes: Literal[2, 3] = 3
    cap: float = np.inf

    def __post_init__(self) -> None:
        check_fields(self, not_negative=("drive_inertia",))
        if not isinstance(self.cap, int | float) or not self.cap > 0.0:
            raise ValueError(f"FlexibleModel.cap: wanted a positive frequency [Hz], got {self.cap!r}")
        crane = self.crane
        leaves = crane.planes > 1 or crane.torsion.count or crane.lateral.count or self.slewing != "fixed"
        if self.axes == 2 and leaves:
            raise ValueError("FlexibleModel.axes: wanted 3 for a crane that moves out of its plane, got 2")
        if isinstance(self.slewing, str) and self.slewing not in ("prescribed", "fixed"):
            raise ValueError(f"FlexibleModel.slewing: wanted 'prescribed', 'fixed' or a Drive, got {self.slewing!r}")
        if self.drive is None and self.drive_inertia:
            raise ValueError(f"FlexibleModel.drive_inertia: wanted 0 without a drive, got {self.drive_inertia!r}")
        if self.drive is not None and self.drive.friction == "stick-slip":
            raise ValueError("FlexibleModel.slewing: wanted friction 'none' or 'tanh', got 'stick-slip'")

    @property
    def drive(self) -> Drive | None:
        """The drive that turns the head, if its angle is a coordinate."""
        return None if isinstance(self.slewing, str) else self.slewing

    @cached_property
    def channels(self) -> tuple[str, ...]:
        """Motions: trolley and rope [m], slewing angle or shaft of its drive [rad], wind [m/s], as there are."""
        turning: tuple[str, ...] = ("shaft",) if self.drive is not None else ("slewing",)
        if self.slewing == "fixed":
            turning = ()
        return ("trolley", "rope", *turning, *self.value_channels)

    @property
    def value_channels(self) -> tuple[str, ...]:
        """Channels that act by their value alone, of which a crane at rest knows the mean: the wind's components."""
        return CHANNELS if self.wind else ()

    @property
    def channel_units(self) -> tuple[str, ...]:
        """Units of the channels."""
        units = {"trolley": "m", "rope": "m", "slewing": "rad", "shaft": "rad"}
        return tuple(units.get(channel, "m/s") for channel in self.channels)

    @cached_property
    def counts(self) -> dict[str, int]:
        """Number of coordinates of each kind, in the order of the state."""
        crane = self.crane
        return {
            "tower_x": crane.tower.count,
            "tower_y": crane.tower.count if crane.planes > 1 else 0,
            "torsion": crane.torsion.count,
            "slewing": int(self.drive is not None),
            "jib_lateral": crane.lateral.count,
            "jib_vertical": crane.vertical.count,
        }

    @cached_property
    def parts(self) -> dict[str, slice]:
        """Where the coordinates of each kind are in the state."""
        ends = np.cumsum([0, *self.counts.values()])
        return {kind: slice(int(a), int(b)) for kind, a, b in zip(self.counts, ends[:-1], ends[1:], strict=True)}

    @property
    def state_names(self) -> dict[str, str]:
        """Name and unit of every coordinate."""
        names: dict[str, str] = {}
        for kind, count in self.counts.items():
            if kind == "slewing":
                names |= dict.fromkeys(["slewing_angle"][:count], "rad")
            else:
                names |= {f"{kind}_mode_{i + 1}": "kg^0.5 m" for i in range(count)}
        return names

    @cached_property
    def coordinates(self) -> int:
        """Number of structural coordinates."""
        return sum(self.counts.values())

    @property
    def size(self) -> int:
        """Number of states: coordinates and rope direction with their rates, and the work done."""
        return 2 * (self.coordinates + self.axes) + 1

    @cached_property
    def system(self) -> System:
        """The model as the solver sees it."""
        n, drive = self.coordinates, self.drive
        floors = np.full(layout.GUARDS, -np.inf)
        floors[layout.TENSION] = -np.inf if self.rope_as_rod else SLACK
        floors[[layout.INNER_END, layout.OUTER_END]] = -ROUNDING
        floors[layout.TILT] = 0.0
        rows, columns = work_shape(n)
        recorded = ("corner", "corner", "slewing torque", "trolley force")
        return System(
            equations=_equations,
            size=self.size,
            guards=(SLACK_ROPE, TROLLEY_OFF_JIB, TROLLEY_OFF_JIB, TOWER_BUCKLED, *recorded),
            floors=floors,
            scale=scale(self),
            numbers=numbers(self),
            vectors=vectors(self),
            matrices=matrices(self),
            tables=shape_table((self.crane.lateral, self.crane.vertical), self.crane.jib_length),
            work_shape=(rows + layout.ROWS, columns),
            directions=np.array([[n, 2 * n + self.axes, self.axes]]),
            switch=Corner(layout.INSIDE, layout.OUTSIDE, drive.soft != drive.stiff) if drive else None,
            fastest=lambda: self.fastest,
        )

    @cached_property
    def fastest(self) -> float:
        """Highest angular frequency of its small motions, whatever hangs on it [rad/s]; zero without coordinates."""
        return fastest_vibration(self)

    def with_load(self, load: Load) -> FlexibleModel:
        """The same crane with another load: what does not depend on the load is shared, not made again."""
        other = replace(self, load=load)
        system = replace(self.system, numbers=numbers(other))
        if self.weight_softening:
            # The load's weight takes stiffness, and with it speed, from the tower.
            system = replace(system, matrices=matrices(other), fastest=lambda: other.fastest)
        # A cached property that is filled beforehand.
        vars(other)["system"] = system
        return other

    @cached_property
    def angular_frequencies(self) -> Floats:
        """Of each coordinate's mode by itself [rad/s], zero for the slewing angle; shape (coordinates,)."""
        crane, counts = self.crane, self.counts
        tower = np.asarray(crane.tower.angular_frequencies)
        return np.concatenate([
            tower,
            tower[: counts["tower_y"]],
            crane.torsion.angular_frequencies,
            np.zeros(counts["slewing"]),
            crane.lateral.angular_frequencies,
            crane.vertical.angular_frequencies,
        ])  # fmt: skip

    @cached_property
    def added_mass(self) -> Floats:
        """Mass that the cap adds to each coordinate, whose own is 1; shape (coordinates,)."""
        order = np.concatenate([np.arange(count) for count in self.counts.values()])
        return added_mass(self.angular_frequencies, order, self.cap)

    def start(self, inputs: Floats, state: str = "equilibrium", swing_angle: float = 0.0) -> Floats:
        """State at rest at the start.

        Parameters
        ----------
        inputs : ndarray
            Polynomials of the first phase, the wind's at the value that counts, see
            :func:`towercrane.simulation.system.start_inputs`.
        state : str
            "equilibrium" (the static solution, in the wind) or "zero" (undeformed, all weights on, in still air).
        swing_angle : float
            Turn of the rope in the vertical plane of the head from where it would hang, positive outward [rad].

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
        if state not in ("equilibrium", "zero"):
            raise ValueError(f"state: wanted 'equilibrium' or 'zero', got {state!r}")
        n, y = self.coordinates, np.zeros(self.size)
        heading = 0.0 if self.slewing == "fixed" else float(inputs[layout.SLEWING, 0])
        if self.drive is not None:
            y[self.parts["slewing"]] = heading
        hung, outward = -np.eye(self.axes)[-1], np.zeros(self.axes)
        if state == "equilibrium":
            y[:n] = self.equilibrium(inputs)
            force = self.load_force(self.at_rest(y[:n], inputs))
            # Without weight and wind any direction will do.
            hung = force / np.linalg.norm(force) if force.any() else hung
        outward[: self.axes - 1] = np.array([np.cos(heading), np.sin(heading)])[: self.axes - 1]
        along, rise = hung @ outward, hung[-1]
        c, s = np.cos(swing_angle), np.sin(swing_angle)
        hung += (along * (c - 1.0) - rise * s) * outward
        hung[-1] = rise * c + along * s
        y[n : n + self.axes] = hung
        return y

    def equilibrium(self, inputs: Floats) -> Floats:
        """Coordinates at rest under all weights and the wind; shape (coordinates,).

        Newton's method on f(q) + J_D^T F = 0 with the weight and the wind's force F of the load. The rope's direction
        is that of F, so the inverted pendulum cannot be found; the solution is refused unless it is stable.

        Raises
        ------
        NoEquilibrium
            If the stiffness is not positive definite, or no equilibrium is found.
        """
        n, origin = self.coordinates, np.zeros(self.coordinates)
        if self.drive is not None:
            origin[self.parts["slewing"]] = inputs[layout.SLEWING, 0]
        at_rest = self.rests(inputs)
        # The wind does not depend on where the crane is.
        pull = self.load_force(at_rest(origin))

        def residual(departure: Floats) -> Floats:
            return _static_force(at_rest(origin + departure), pull, n)

        try:
            return origin + stable_equilibrium(residual, self.system.scale[:n])
        except Unstable as failure:
            raise NoEquilibrium(TOWER_BUCKLED, f"{failure}; {self.buckling_message()}") from failure

    def static_force(self, q: Floats, inputs: Floats) -> Floats:
        """Generalised forces on the crane at rest with its load hanging at rest; shape (coordinates,)."""
        work = self.at_rest(q, inputs)
        return _static_force(work, self.load_force(work), self.coordinates)

    def load_force(self, work: Floats) -> Floats:
        """Force of weight and wind on the load at rest, as scratch knows the wind [N]; shape (axes,)."""
        wind = work[WIND, : self.axes]
        force = self.load.drag * np.linalg.norm(wind) * wind
        force[-1] -= self.load.mass * self.crane.gravity
        return np.asarray(force)

    def buckling_message(self) -> str:
        """How far the tower is from buckling."""
        if not self.crane.tower.count:
            return "the tower is rigid"
        geometric = np.linalg.eigvals(np.linalg.solve(self.crane.tower.stiffness_matrix(), geometric_stiffness(self)))
        return f"the tower alone would carry {1.0 / geometric.real.max():.3g} times the weight upon it"

    def at_rest(self, q: Floats, inputs: Floats) -> Floats:
        """Scratch array of the structure at rest at these coordinates, in the wind of the inputs."""
        return self.rests(inputs)(q)

    def rests(self, inputs: Floats) -> Callable[[Floats], Floats]:
        """:meth:`at_rest` with these inputs, for many coordinates: every call fills the same array."""
        n, axes, driven, constants = self.coordinates, self.axes, self.drive is not None, self.system.constants
        y, work, fixed = np.zeros(self.size), np.zeros(self.system.work_shape), np.zeros_like(inputs)
        fixed[:, 0] = inputs[:, 0]

        def at_rest(q: Floats) -> Floats:
            y[:n] = q
            flexible_kernel.structure(axes, 0.0, y, fixed, *constants, work)
            if driven:
                drive_kernel.drive(0.0, y, fixed, constants[0], work)
            return work

        return at_rest

    def observe(
        self, motions: dict[str, Motion], times: Floats, states: Floats, guards: Floats
    ) -> dict[str, Quantity]:
        """Outputs over time, see :func:`towercrane.cranes.tower.outputs.observe`."""
        from towercrane.cranes.tower.outputs import observe

        return observe(self, motions, times, states, guards)

    def provenance(self) -> dict[str, Any]:
        """Crane, modes and load, for a result's attributes."""
        modes = {f"{kind}_modes": count for kind, count in self.counts.items() if kind != "slewing"}
        return {
            "crane": self.crane.name,
            **modes,
            "frequency_cap": self.cap if np.isfinite(self.cap) else 0.0,
            "payload_mass": self.load.mass,
            "gravity": self.crane.gravity,
        }


def _static_force(work: Floats, pull: Floats, n: int) -> Floats:
    """Forces on the coordinates in a scratch array, with a force on the load."""
    return np.asarray(work[FORCE, :n] + pull @ work[JACOBIAN : JACOBIAN + len(pull), :n])


def _equations() -> Any:
    # Here, since what is asked at rest need not wait until these are compiled.
    from towercrane.cranes.tower.kernels.rhs import rhs

    return rhs
