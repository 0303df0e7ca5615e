"""Crane in radial motion: tower, jib, trolley and load in the vertical plane of the jib, whose head does not slew.

Source: Gao et al. (2023). It is the flexible crane of :mod:`towercrane.cranes.tower.model` in a scene whose tower
bends along the jib only and whose jib bends up and down only.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from modal.checks import check_fields, whole_number
from towercrane.cranes.tower.equations.constants import geometric_stiffness
from towercrane.cranes.tower.equations.small_motions import linear_matrices, reciprocal_modes
from towercrane.cranes.tower.kernels import layout
from towercrane.cranes.tower.model import FlexibleModel
from towercrane.cranes.tower.modes.damping import ModalDamping
from towercrane.cranes.tower.modes.modal_crane import ModeCounts, flexible_crane

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.cranes.tower.modes.mass_sums import Basis
    from towercrane.cranes.tower.modes.parameters import TowerCrane
    from towercrane.kernels.payload import Load
    from towercrane.motions.motion import Motion
    from towercrane.results.recording import Quantity
    from towercrane.simulation.system import System

    Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class RadialModel:
    """Equations of motion in chosen coordinates: any numbers of tower and jib modes, 0 meaning rigid.

    The counter-jib is rigid, also where a case gives it a bending stiffness for the exact frequencies of the crane.

    Parameters
    ----------
    crane : TowerCrane
    load : Load
    tower_modes, jib_modes : int
        Numbers of modes.
    weight_softening : bool
        Include the geometric stiffness of the weight above each section of the tower.
    tower_damping_ratio, jib_damping_ratio : float
        Modal damping as a fraction of critical.
    self_weight : bool
        Whether the structure has weight; without it, as in Gao et al. (2023), Eq. 15, only trolley and load do.
    rope_as_rod : bool
        Let the rope push, as most published models do. Without it a slack rope ends the run.
    axes : int
        2 for motion in the plane of the jib, 3 for a load that may swing out of it.
    cap : float
        Highest frequency of a mode [Hz], see :class:`towercrane.cranes.tower.equations.coordinates.Coordinates`.
    """

    crane: TowerCrane
    load: Load
    tower_modes: int = 2
    jib_modes: int = 3
    weight_softening: bool = False
    tower_damping_ratio: float = 0.0
    jib_damping_ratio: float = 0.0
    self_weight: bool = True
    rope_as_rod: bool = False
    axes: Literal[2, 3] = 2
    cap: float = np.inf

    def __post_init__(self) -> None:
        for name in ("tower_modes", "jib_modes"):
            whole_number(f"RadialModel.{name}", getattr(self, name))
        check_fields(self, not_negative=("tower_damping_ratio", "jib_damping_ratio"))

    @cached_property
    def scene(self) -> FlexibleModel:
        """The flexible crane that this is."""
        modes = ModeCounts(tower=self.tower_modes, torsion=0, lateral=0, vertical=self.jib_modes)
        return FlexibleModel(
            flexible_crane(self.crane, modes, planes=1),
            self.load,
            slewing="fixed",
            damping=ModalDamping(tower=self.tower_damping_ratio, vertical=self.jib_damping_ratio),
            weight_softening=self.weight_softening,
            self_weight=self.self_weight,
            rope_as_rod=self.rope_as_rod,
            axes=self.axes,
            cap=self.cap,
        )

    @property
    def channels(self) -> tuple[str, ...]:
        """Motions: position of the trolley along the jib and length of the rope [m]."""
        return self.scene.channels

    @property
    def channel_units(self) -> tuple[str, ...]:
        """Units of the channels."""
        return self.scene.channel_units

    @property
    def state_names(self) -> dict[str, str]:
        """Name and unit of every coordinate."""
        parts = (("tower", self.tower_modes), ("jib", self.jib_modes))
        return {f"{part}_mode_{i + 1}": "kg^0.5 m" for part, count in parts for i in range(count)}

    @property
    def coordinates(self) -> int:
        """Number of modal coordinates."""
        return self.tower_modes + self.jib_modes

    @property
    def size(self) -> int:
        """Number of states: coordinates and rope direction with their rates, and the work done."""
        return self.scene.size

    @property
    def tower(self) -> Basis:
        """Modes of the tower with the slewing part on its end."""
        return self.scene.crane.tower

    @property
    def jib(self) -> Basis:
        """Modes of the jib, clamped at the tower top and free at its end."""
        return self.scene.crane.vertical

    @property
    def geometric_stiffness(self) -> Floats:
        """Stiffness that the weight takes from the tower modes [1/s^2], shape (tower_modes, tower_modes)."""
        return geometric_stiffness(self.scene)

    @property
    def system(self) -> System:
        """The model as the solver sees it."""
        return self.scene.system

    @property
    def tip_shapes(self) -> Floats:
        """Displacement of the tower top and deflection of the jib tip per coordinate; shape (2, coordinates)."""
        shapes = np.zeros((2, self.coordinates))
        shapes[0] = self.system.vectors[layout.SLIDE_X]
        shapes[1, self.tower_modes :] = self.scene.crane.tip_shapes[:, 0]
        return shapes

    def with_load(self, load: Load) -> RadialModel:
        """The same crane with another load, see
        :meth:`towercrane.cranes.tower.equations.flexible.Equations.with_load`."""
        other = replace(self, load=load)
        vars(other)["scene"] = self.scene.with_load(load)
        return other

    def without_cap(self) -> RadialModel:
        """The same crane with the frequencies that its modes have."""
        if self.cap == np.inf:
            return self
        other = replace(self, cap=np.inf)
        vars(other)["scene"] = replace(self.scene, cap=np.inf)
        return other

    def start(self, inputs: Floats, state: str = "equilibrium", swing_angle: float = 0.0) -> Floats:
        """State at rest at the start, see :meth:`towercrane.cranes.tower.equations.flexible.Equations.start`."""
        return self.scene.start(inputs, state, swing_angle)

    def equilibrium(self, inputs: Floats) -> Floats:
        """Coordinates at rest under all weights, see
        :meth:`towercrane.cranes.tower.equations.flexible.Equations.equilibrium`."""
        return self.scene.equilibrium(inputs)

    def observe(
        self, motions: dict[str, Motion], times: Floats, states: Floats, guards: Floats
    ) -> dict[str, Quantity]:
        """Outputs over time, see :func:`towercrane.cranes.tower.outputs.plane.observe`."""
        from towercrane.cranes.tower.outputs.plane import observe

        return observe(self.scene, motions, times, states, guards)

    def provenance(self) -> dict[str, Any]:
        """Crane, modes and load, for a result's attributes."""
        return {
            "crane": self.crane.name,
            "tower_modes": self.tower_modes,
            "jib_modes": self.jib_modes,
            "frequency_cap": self.cap if np.isfinite(self.cap) else 0.0,
            "payload_mass": self.load.mass,
            "gravity": self.crane.gravity,
        }

    def linear_matrices(self, trolley_position: float, rope_length: float) -> tuple[Floats, Floats]:
        """Mass and stiffness of small motions about the undeformed crane; shapes (n + 1, n + 1).

        The last coordinate is the load's horizontal distance from the trolley [m]. The second-order effect of the
        static deflection is not in it, as in any linear frame.
        """
        mass, stiffness = linear_matrices(self.scene, np.array([[trolley_position], [rope_length]]))
        outward = np.arange(self.coordinates + 1)
        return mass[np.ix_(outward, outward)], stiffness[np.ix_(outward, outward)]

    def natural_frequencies(self, trolley_position: float, rope_length: float) -> Floats:
        """Angular frequencies of small motions, pendulum included; shape (coordinates + 1,) [rad/s]."""
        return self.natural_modes(trolley_position, rope_length)[0]

    def natural_modes(self, trolley_position: float, rope_length: float) -> tuple[Floats, int]:
        """Small motions about the undeformed crane.

        Returns
        -------
        frequencies : ndarray, shape (coordinates + 1,)
            Angular frequencies, ascending [rad/s].
        swing : int
            Index of the mode in which the load swings most: the one with the largest share of its elastic and
            potential energy in the pendulum.

        Raises
        ------
        NoEquilibrium
            If the weight's softening leaves the tower no stiffness.
        """
        mass, stiffness = self.linear_matrices(trolley_position, rope_length)
        frequencies, vectors = reciprocal_modes(self.scene, mass, stiffness)
        return frequencies, int(np.argmax(stiffness[-1, -1] * vectors[-1] ** 2))
