"""Modes of a chain as the coordinates of a larger model: the same door as `modal.beams.shapes.Modes`, for any
chain."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from modal.beams.beam import EndBody
from modal.checks import whole_number
from modal.structures.part_shapes import DEFLECTION, ROTATION, PartShapes
from modal.structures.structure import chain_structure
from modal.structures.structure_modes import structure_modes

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from modal.beams.chain import Chain

    Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class ChainModes:
    """Natural modes of a chain with a rigid body at its end, orthonormal in the mass of both.

    Made by `chain_modes`. What the matrices hold is the chain's alone, with its own bodies, without the end body.

    Parameters
    ----------
    chain : Chain
        The chain, without the end body.
    angular_frequencies : ndarray, shape (n,)
        Natural angular frequencies, ascending [rad/s].
    shapes : PartShapes
        Shapes [kg^-1/2] and what belongs to them.
    """

    chain: Chain
    angular_frequencies: Floats
    shapes: PartShapes

    @property
    def count(self) -> int:
        """Number of modes, n."""
        return int(self.angular_frequencies.size)

    @property
    def length(self) -> float:
        """Length of the chain [m]."""
        return self.chain.length

    @property
    def frequencies_hz(self) -> Floats:
        """Natural frequencies [Hz], shape (n,)."""
        return self.angular_frequencies / (2.0 * np.pi)

    def __call__(self, position: ArrayLike, derivative: int = 0) -> Floats:
        """Deflections or their derivatives at positions along the chain [kg^-1/2 m^-derivative].

        Raises
        ------
        ValueError
            If a position is off the chain or not a number, or the order is negative or no integer.
        """
        return self.shapes.evaluate(position, DEFLECTION, derivative)

    def rotation(self, position: ArrayLike) -> Floats:
        """Rotation of the section at positions along the chain [kg^-1/2 m^-1]; with shear strain not the slope."""
        return self.shapes.evaluate(position, ROTATION)

    @cached_property
    def _nodes(self) -> tuple[Floats, Floats]:
        """Deflections and rotations of the nodes, shape (n, nodes) each."""
        return self(self.chain.nodes), self.rotation(self.chain.nodes)

    def _of_bodies(self) -> list[tuple[EndBody, Floats, Floats]]:
        """Bodies of the chain with the motion of their centres of mass and their rotation, shape (n,) each."""
        deflection, rotation = self._nodes
        return [
            (body, deflection[:, node] + body.offset * rotation[:, node], rotation[:, node])
            for node, body in self.chain.bodies.items()
        ]

    def mass_matrix(self) -> Floats:
        """Mass of segments and bodies [1], shape (n, n)."""
        total = self.shapes.mass_matrix()
        for body, motion, turn in self._of_bodies():
            total += body.mass * np.outer(motion, motion) + body.rotary_inertia * np.outer(turn, turn)
        return total

    def mass_moments(self) -> tuple[Floats, Floats]:
        """First moments ``int m phi dx`` [kg^1/2] and ``int m x phi dx`` [kg^1/2 m], bodies included; shape (n,)."""
        mass = self.shapes.mass_per_length * self.shapes.weights
        values = self.shapes.at_points(DEFLECTION)
        zeroth: Floats = np.tensordot(values, mass, 2)
        first: Floats = np.tensordot(values, mass * self.shapes.points, 2)
        for node, (body, motion, _) in zip(self.chain.bodies, self._of_bodies(), strict=True):
            zeroth = zeroth + body.mass * motion
            first = first + body.mass * (self.chain.nodes[node] + body.offset) * motion
        return zeroth, first

    def rotary_moments(self) -> Floats:
        """Moment of momentum of the sections' and bodies' own rotary inertia [kg^1/2 m], shape (n,)."""
        along: Floats = np.tensordot(
            self.shapes.at_points(ROTATION), self.shapes.rotary_inertia * self.shapes.weights, 2
        )
        return along + sum(body.rotary_inertia * turn for body, _, turn in self._of_bodies())

    def rotary_matrix(self) -> Floats:
        """What the own rotary inertia of sections and bodies adds to the mass matrix [1], shape (n, n)."""
        total = self.shapes.product(self.shapes.rotary_inertia, ROTATION, ROTATION)
        for body, _, turn in self._of_bodies():
            total = total + body.rotary_inertia * np.outer(turn, turn)
        return total

    def deflection_integrals(self) -> Floats:
        """Integrals ``int phi dx`` [m kg^-1/2], shape (n,)."""
        integrals: Floats = np.tensordot(self.shapes.at_points(DEFLECTION), self.shapes.weights, 2)
        return integrals

    def stiffness_matrix(self) -> Floats:
        """Stiffness of segments, foundation and collars [1/s^2], shape (n, n)."""
        total = self.shapes.strain_matrix()
        foot, (deflection, rotation) = self.chain.foundation, self._nodes
        for stiffness, motion in ((foot.translation_stiffness, deflection), (foot.rotation_stiffness, rotation)):
            if np.isfinite(stiffness):
                total += stiffness * np.outer(motion[:, 0], motion[:, 0])
        if foot.coupling:
            coupled = np.outer(deflection[:, 0], rotation[:, 0])
            total += foot.coupling * (coupled + coupled.T)
        for node, collar in self.chain.collars.items():
            for stiffness, motion in ((collar.stiffness, deflection), (collar.rotation_stiffness, rotation)):
                total += stiffness * np.outer(motion[:, node], motion[:, node])
        moved = _moved(self.chain, self.shapes)
        if moved.any():
            total = np.asarray(np.linalg.inv(np.linalg.inv(total) + moved))
        return total

    def slope_matrix(self) -> Floats:
        """What a unit weight on the end takes from the stiffness [1/(kg m)], shape (n, n)."""
        return self.shapes.softening_matrix(1.0, self.chain.shear_theory)

    def weight_matrix(self) -> Floats:
        """What the chain's own weight takes from the stiffness under unit gravity [1/m], shape (n, n)."""
        chain = replace(self.chain, gravity=1.0, axial_load=0.0, pendulum=None)
        total = self.shapes.softening_matrix(chain.compression(self.shapes.points), chain.shear_theory)
        for body, _, turn in self._of_bodies():
            total += body.mass * body.offset * np.outer(turn, turn)
        return total


def chain_modes(chain: Chain, count: int, end_body: EndBody = EndBody()) -> ChainModes:  # noqa: B008  frozen
    """Natural modes of a chain with a rigid body at its end.

    Where the mass moves beyond the axis, the modes are those of as many without that flexibility: the shapes then are
    motions of the mass, and flexibilities add, ``1 / omega^2 + int c m^2 phi phi dx``.

    Parameters
    ----------
    chain : Chain
        With gravity, the weight of the end body softens it too. A pendulum is left out.
    count : int
        Number of modes; with 0 every result is an empty array of its shape.
    end_body : EndBody
        The body at the end, besides the chain's own ones; of finite mass and inertia.

    Raises
    ------
    ValueError
        If the count is negative or the end body infinite.
    Unstable
        If the chain buckles under its weights and loads.
    """
    if not np.isfinite([end_body.mass, end_body.rotary_inertia]).all():
        raise ValueError(f"end_body: wanted finite mass and inertia, got {end_body!r}")
    count = whole_number("count", count)
    weight = chain.gravity * end_body.mass
    stiff = tuple(replace(segment, mass_flexibility=0.0) for segment in chain.segments)
    loaded = replace(chain, segments=stiff, axial_load=chain.axial_load + weight, pendulum=None)
    structure = chain_structure(loaded)
    last = structure.members[-1].unknowns
    structure.add_body(end_body, last[2], last[3], weight)
    modes = structure_modes(structure, max(count, 1))
    shapes = modes.parts["tower"]
    kept, omega = replace(shapes, coefficients=shapes.coefficients[:count]), modes.angular_frequencies[:count]
    moved = _moved(chain, kept)
    if moved.any():
        values, mix = np.linalg.eigh(np.diag(omega**-2.0) + moved)
        omega, mix = values[::-1] ** -0.5, mix[:, ::-1].T
        mix *= np.sign(np.diag(mix))[:, None]
        kept = replace(kept, coefficients=np.tensordot(mix, kept.coefficients, 1))
    return ChainModes(chain, omega, kept)


def _moved(chain: Chain, shapes: PartShapes) -> Floats:
    """Flexibility of the mass against the axis in the shapes that it moves with [s^2], shape (n, n)."""
    flexibility = chain.section(shapes.points, "mass_flexibility")
    return shapes.product(flexibility * shapes.mass_per_length**2, DEFLECTION, DEFLECTION)
