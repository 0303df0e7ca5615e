"""Natural modes of the whole plane crane at one place of the trolley: shapes, energies, what they take part in."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Protocol

import numpy as np

from modal import crane_structure
from modal.structures.members import HELD
from modal.structures.part_shapes import DEFLECTION, FORCE, MOMENT, ROTATION, SLOPE
from modal.structures.structure import Structure
from modal.structures.structure_modes import structure_modes

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from modal import Chain, CraneFrame
    from modal.structures.members import Member
    from modal.structures.part_shapes import PartShapes
    from modal.structures.structure_modes import StructureModes

    Floats = NDArray[np.float64]

POINTS = 24
"""Gauss points along a segment: enough for shapes of some twelve half-waves."""

PROPERTIES = "mass_per_length", "rotary_inertia", "bending_stiffness", "shear_stiffness", "mass_flexibility"
"""Of a section, as `Points` has them."""

MEMBERS = ("tower", "jib", "counter-jib", "foundation", "collars", "load")
"""Where the potential energy of a mode is; that of the load is its height as it swings."""

LOADS = ("vertical", "horizontal")
"""Unit forces on the trolley, down and outward."""

STATIC_OUTPUTS = ("tower_tip", "jib_tip", "base_moment")
"""Tower top outward [m], jib end down [m], bending moment at the tower's foot [N m], positive like the moment of an
outward force at the top."""


class Shapes(Protocol):
    """Shapes of n modes along one part, such as :class:`modal.structures.part_shapes.PartShapes`."""

    def evaluate(self, position: Floats | float, quantity: int = DEFLECTION) -> Floats:
        """Deflection or rotation at positions along the part [m], shape (n, *positions)."""


@dataclass(frozen=True, eq=False)
class Points:
    """Fixed points along a chain with the properties there.

    Parameters
    ----------
    positions, weights : ndarray, shape (p,)
        Gauss points of every segment and their weights [m].
    mass_per_length, rotary_inertia, bending_stiffness, shear_stiffness, mass_flexibility : ndarray, shape (p,)
        [kg/m], [kg m], [N m^2], [N], [m^2/N].
    """

    positions: Floats
    weights: Floats
    mass_per_length: Floats
    rotary_inertia: Floats
    bending_stiffness: Floats
    shear_stiffness: Floats
    mass_flexibility: Floats

    @classmethod
    def along(cls, chain: Chain) -> Points:
        """Gauss points of all segments of a chain."""
        abscissae, gauss = np.polynomial.legendre.leggauss(POINTS)
        rows = []
        for segment, start in zip(chain.segments, chain.nodes[:-1], strict=True):
            z = 0.5 * segment.length * (abscissae + 1.0)
            sections = [segment.section(name, z) for name in PROPERTIES]
            rows.append([start + z, 0.5 * segment.length * gauss, *sections])
        return cls(*np.concatenate(rows, axis=1))

    def motion(self, chain: Chain, shapes: Shapes) -> Floats:
        """Deflections and rotations times the roots of their masses, bodies included; shape (n, q)."""
        mass = np.sqrt(self.mass_per_length * self.weights)
        columns = [shapes.evaluate(self.positions, DEFLECTION) * mass]
        if self.rotary_inertia.any():
            columns.append(shapes.evaluate(self.positions, ROTATION) * np.sqrt(self.rotary_inertia * self.weights))
        for node, body in chain.bodies.items():
            deflection, rotation = (shapes.evaluate(chain.nodes[node], q) for q in (DEFLECTION, ROTATION))
            columns.append(np.sqrt(body.mass) * (deflection + body.offset * rotation)[:, None])
            columns.append(np.sqrt(body.rotary_inertia) * rotation[:, None])
        return np.concatenate(columns, axis=1)

    def strain(self, shapes: PartShapes) -> Floats:
        """Twice the strain energy of every mode [1/s^2], shape (n,)."""
        moment = shapes.evaluate(self.positions, MOMENT)
        total: Floats = moment**2 @ (self.weights / self.bending_stiffness)
        soft = np.isfinite(self.shear_stiffness)
        if soft.any():
            where = self.positions[soft]
            shear = shapes.evaluate(where, SLOPE) - shapes.evaluate(where, ROTATION)
            total = total + shear**2 @ (self.weights * self.shear_stiffness)[soft]
        if self.mass_flexibility.any():
            total = total + shapes.evaluate(self.positions, FORCE, 1) ** 2 @ (self.weights * self.mass_flexibility)
        return total


class PlaneCrane:
    """A crane in the plane of its jib, made ready to be asked at many places of the trolley.

    Parameters
    ----------
    frame : CraneFrame
        With a jib and a payload.

    Raises
    ------
    ValueError
        If the frame has no jib or no payload.
    """

    def __init__(self, frame: CraneFrame) -> None:
        if frame.jib is None:
            raise ValueError("frame.jib: wanted a flexible jib, got None")
        if frame.payload_mass <= 0.0:
            raise ValueError(f"frame.payload_mass: wanted a mass above 0 kg, got {frame.payload_mass!r}")
        self.frame = frame
        self.jib: Chain = frame.jib
        chains = {"tower": frame.tower, "jib": self.jib, "counter-jib": frame.counter_jib}
        self.chains: dict[str, Chain] = {name: chain for name, chain in chains.items() if chain is not None}
        self.points = {name: Points.along(chain) for name, chain in self.chains.items()}

    @property
    def pendulum_stiffness(self) -> float:
        """Horizontal force per horizontal distance between load and trolley [N/m]."""
        return self.frame.payload_mass * self.frame.gravity / self.frame.rope_length

    @property
    def moving_along(self) -> float:
        """Mass that moves outward with the tower's top besides what stands on the tower: jibs and trolley [kg]."""
        carried = [chain for name, chain in self.chains.items() if name != "tower"]
        bodies = sum(body.mass for chain in carried for body in chain.bodies.values())
        return self.frame.trolley_mass + sum(chain.mass for chain in carried) + bodies

    def motion(self, position: float, parts: Mapping[str, Shapes], load: Floats) -> Floats:
        """Motion of fixed points, times the roots of their masses; rows of unit length, shape (n, p).

        The same columns at every place of the trolley: tower, jibs, their bodies, and as bodies of their own the
        trolley with the load (vertically) and the load (outward). Products of two rows are the modes' products in
        the mass of the crane, so they compare the motion of the same bodies wherever the trolley stands.

        Parameters
        ----------
        position : float
            Of the trolley [m].
        parts : mapping of str to Shapes
            Of tower, jib and a counter-jib that bends.
        load : ndarray, shape (n,)
            Outward motion of the load.
        """
        columns = [points.motion(self.chains[name], parts[name]) for name, points in self.points.items()]
        carried = self.frame.trolley_mass + self.frame.payload_mass
        bodies = (
            np.sqrt(self.moving_along) * parts["tower"].evaluate(self.frame.tower.length),
            np.sqrt(carried) * parts["jib"].evaluate(position),
            np.sqrt(self.frame.payload_mass) * load,
        )
        found = np.concatenate([*columns, np.stack(bodies, axis=1)], axis=1)
        unit: Floats = found / np.linalg.norm(found, axis=1)[:, None]
        return unit

    def structure(self, position: float) -> Structure:
        """The exact structure with the trolley at a distance from the tower's axis [m]."""
        return crane_structure(self.frame, position)

    def modes(self, position: float, count: int) -> PlaneModes:
        """Lowest natural modes with the trolley at a distance from the tower's axis [m].

        Raises
        ------
        ValueError
            If the position is off the jib or the count less than one.
        modal.Unstable
            If the tower buckles under the weights.
        """
        return PlaneModes(self, position, structure_modes(self.structure(position), count))


@dataclass(frozen=True, eq=False)
class PlaneModes:
    """Natural modes of a plane crane at one place of the trolley.

    Parameters
    ----------
    crane : PlaneCrane
    position : float
        Distance of the trolley from the tower's axis [m].
    modes : StructureModes
        Orthonormal in the mass.
    """

    crane: PlaneCrane
    position: float
    modes: StructureModes

    @property
    def frequencies(self) -> Floats:
        """Natural frequencies [Hz], shape (n,)."""
        return self.modes.frequencies_hz

    @cached_property
    def _top(self) -> Floats:
        """Outward motion of the tower's top [kg^-1/2], shape (n,)."""
        return self.modes.parts["tower"].evaluate(self.crane.frame.tower.length)

    @cached_property
    def _trolley(self) -> Floats:
        """Upward motion of the trolley [kg^-1/2], shape (n,)."""
        return self.modes.parts["jib"].evaluate(self.position)

    @property
    def _load(self) -> Floats:
        """Outward motion of the load [kg^-1/2], shape (n,)."""
        return self.modes.vectors[:, -1]

    @cached_property
    def shapes(self) -> Floats:
        """Motion of fixed points, times the roots of their masses, see `PlaneCrane.motion`."""
        return self.crane.motion(self.position, self.modes.parts, self._load)

    @cached_property
    def energy_shares(self) -> Floats:
        """Shares of `MEMBERS` in the potential energy of every mode [1], shape (n, 6).

        Strain energy of tower and jibs, of the springs of foundation and collars, and the load's as it swings on its
        rope; what the weight takes from the tower's stiffness is not in it.
        """
        crane, parts = self.crane, self.modes.parts
        none = np.zeros(len(self.frequencies))
        strain = {name: points.strain(parts[name]) for name, points in crane.points.items()}
        tower, moves = crane.frame.tower, parts["tower"].evaluate
        foot, ground, tied = tower.foundation, none, none
        for stiffness, quantity in ((foot.translation_stiffness, DEFLECTION), (foot.rotation_stiffness, ROTATION)):
            if np.isfinite(stiffness):
                ground = ground + stiffness * moves(0.0, quantity) ** 2
        ground = ground + 2.0 * foot.coupling * moves(0.0, DEFLECTION) * moves(0.0, ROTATION)
        for node, collar in tower.collars.items():
            for stiffness, quantity in ((collar.stiffness, DEFLECTION), (collar.rotation_stiffness, ROTATION)):
                tied = tied + stiffness * moves(tower.nodes[node], quantity) ** 2
        swing = crane.pendulum_stiffness * (self._load - self._top) ** 2
        energies = [strain["tower"], strain["jib"], strain.get("counter-jib", none), ground, tied, swing]
        total = np.stack(energies, axis=1)
        shares: Floats = total / total.sum(axis=1, keepdims=True)
        return shares

    @cached_property
    def outputs(self) -> Floats:
        """`STATIC_OUTPUTS` per modal coordinate [kg^-1/2], [kg^-1/2], [N m/(kg^1/2 m)]; shape (n, 3)."""
        parts = self.modes.parts
        tip = -parts["jib"].evaluate(self.crane.jib.length)
        return np.stack([self._top, tip, parts["tower"].evaluate(0.0, MOMENT)], axis=1)

    @cached_property
    def modal_static(self) -> Floats:
        """Part of every mode in the outputs under a static unit force on the trolley, shape (n, 2 loads, 3 outputs).

        With a mode's output o, its motion f where and as the force acts, and unit modal mass it adds ``o f /
        omega^2`` [m/N; N m/N]: the modal static response, whose share in `static` is Chopra's modal contribution
        factor (Chopra 1996, Modal analysis of linear dynamic systems: physical interpretation, Journal of Structural
        Engineering 122). All modes together add up to `static`.
        """
        forces = np.stack([-self._trolley, self._top], axis=1) / self.modes.angular_frequencies[:, None] ** 2
        return forces[:, :, None] * self.outputs[:, None, :]

    @cached_property
    def static(self) -> Floats:
        """Outputs under a static unit force on the trolley [m/N; N m/N], shape (2 loads, 3 outputs)."""
        structure = self.modes.structure
        tower = [m for m in structure.members if m.part == "tower"]
        jib = [m for m in structure.members if m.part == "jib"]
        top = tower[-1].unknowns[2]
        forces = np.zeros((len(structure.unknowns), 2))
        forces[top, 1] = 1.0
        # The trolley stands on a node of the jib, or on the tower's axis, where its weight bends nothing.
        if self.position > 0.0:
            node = min(jib, key=lambda m: abs(m.position + m.segment.length - self.position))
            if node.position + node.segment.length < 2.0 * self.position:
                forces[node.unknowns[2], 0] = -1.0
        found = self.modes.structure.displacements(forces)
        return np.stack([found[top], -found[jib[-1].unknowns[2]], self._foot_moment(tower[0], found)], axis=1)

    def _foot_moment(self, lowest: Member, motion: Floats) -> Floats:
        """Bending moment at the tower's foot from the motion of the unknowns, shape (loads,)."""
        alone = Structure(("m", "rad", "m", "rad"), shear_theory=self.modes.structure.shear_theory)
        alone.members.append(replace(lowest, unknowns=(0, 1, 2, 3), factors=(1.0, 1.0, 1.0, 1.0)))
        ends = np.array([motion[i] if i != HELD else np.zeros(2) for i in lowest.unknowns])
        moment: Floats = -alone.stiffness()[1] @ (ends * np.array(lowest.factors)[:, None])
        return moment
