"""Natural modes of a structure: frequencies, and shapes exact along every segment, orthonormal in its mass."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from modal.checks import whole_number
from modal.structures.part_shapes import PartShapes, gauss

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from modal.structures.members import Member, Members
    from modal.structures.structure import Structure

    Floats = NDArray[np.float64]

_DOUBLE = 1e-9
"""Relative distance of frequencies whose shapes are found together."""


@dataclass(frozen=True, eq=False)
class StructureModes:
    """Natural modes of a structure, orthonormal in its mass: shapes are in m/(kg^1/2 m), that is kg^-1/2.

    Parameters
    ----------
    structure : Structure
    angular_frequencies : ndarray, shape (n,)
        Ascending [rad/s].
    vectors : ndarray, shape (n, unknowns)
        Motion of the structure's unknowns [kg^-1/2, rad/(m kg^1/2)].
    parts : dict of str to PartShapes
        Shapes along every part.
    """

    structure: Structure
    angular_frequencies: Floats
    vectors: Floats
    parts: dict[str, PartShapes]

    @property
    def frequencies_hz(self) -> Floats:
        """Natural frequencies [Hz], shape (n,)."""
        return self.angular_frequencies / (2.0 * np.pi)

    def mass_matrix(self) -> Floats:
        """Mass of all parts and bodies; the unit matrix but for rounding, shape (n, n)."""
        total = np.zeros((len(self.vectors),) * 2)
        for (i, j), value in self.structure.bodies.items():
            total += value * np.outer(self.vectors[:, i], self.vectors[:, j])
        for part in self.parts.values():
            total += part.mass_matrix()
        return total


def structure_modes(structure: Structure, count: int) -> StructureModes:
    """Lowest natural modes of a structure.

    Parameters
    ----------
    structure : Structure
    count : int
        Number of modes, one or more.

    Returns
    -------
    StructureModes
        Signs make the last unknown of the first part move to the positive side.

    Raises
    ------
    ValueError
        If the count is less than one.
    Unstable
        If the structure buckles under its weights and loads.
    """
    from modal.structures.assembly import refined

    omega = structure.angular_frequencies(whole_number("count", count, 1))
    fine = refined(structure, float(omega[-1]))
    shapes, motions = _shapes(fine, omega)
    parts = {
        name: _part(fine, name, shapes, float(omega[-1])) for name in dict.fromkeys(m.part for m in fine.members)
    }
    modes = StructureModes(structure, omega, motions[:, : len(structure.unknowns)], parts)
    mix = _orthonormal(modes)
    first = structure.members[0].part
    end = max((m for m in structure.members if m.part == first), key=lambda m: m.position).unknowns
    tip = mix @ modes.vectors[:, [end[2], end[3]]]
    lead = np.where(np.abs(tip[:, 0]) > 1e-9 * np.abs(tip[:, 1]), tip[:, 0], tip[:, 1])
    mix *= np.where(lead < 0.0, -1.0, 1.0)[:, None]
    mixed = {
        name: PartShapes(
            part.ends, np.tensordot(mix, part.coefficients, 1), part.mass_per_length, part.rotary_inertia,
            part.bending_stiffness, part.shear_flexibility, part.mass_flexibility,
        )
        for name, part in parts.items()
    }  # fmt: skip
    return StructureModes(structure, omega, mix @ modes.vectors, mixed)


def _clusters(omega: Floats) -> list[slice]:
    """Frequencies that count as equal, side by side."""
    starts = [k for k in range(omega.size) if k == 0 or omega[k] - omega[k - 1] > _DOUBLE * omega[k]]
    return [slice(near, far) for near, far in pairwise([*starts, omega.size])]


def _orthonormal(modes: StructureModes) -> Floats:
    """What makes the shapes orthonormal: a scale for each, a mixture of those of equal frequency; shape (n, n)."""
    mass = modes.mass_matrix()
    mix = np.zeros_like(mass)
    for of in _clusters(modes.angular_frequencies):
        mix[of, of] = np.linalg.inv(np.linalg.cholesky(mass[of, of]))
    return mix


def _shapes(fine: Members, omega: Floats) -> tuple[list[Floats], Floats]:
    """Shape along every member (n, p, terms, 5), in SI, and motions of all unknowns (n, u), not yet of unit mass."""
    from modal.structures.assembly import assembly
    from modal.structures.kernels import piece_ends, run_shape
    from modal.structures.kernels.piece import TERMS
    from modal.structures.kernels.stiffness import ROWS, SLOT

    none = np.empty(1)
    motions, counts = np.zeros((omega.size, len(fine.unknowns))), np.empty(0, dtype=int)
    shapes: list[Floats] = []
    for of in _clusters(omega):
        # Arrays made for this frequency alone: those for higher ones would cost digits.
        ready = assembly(fine, float(omega[of][-1]))
        length, force, frequency = ready.units
        highest = float((omega[-1] / frequency) ** 2)
        if not shapes:
            counts = np.array([piece_ends(row, highest, 1.0, none) for row in ready.segments])
            shapes = [np.zeros((omega.size, count, TERMS + 1, 5)) for count in counts]
        for k, vector in zip(range(omega.size)[of], ready.null_vectors(omega[of]), strict=True):
            motions[k] = ready.composition @ vector
            for (first, last, single), motion in zip(ready.runs, ready.motions, strict=True):
                pieces = counts[first:last].sum()
                out, along = np.zeros((pieces, TERMS + 1, 5)), np.zeros((last - first + 1, 2))
                work, scratch = np.zeros((ROWS, TERMS)), np.zeros((SLOT * pieces + pieces + 1, 4))
                run_shape(
                    ready.segments, ready.nodes, first, last, single == 1, highest,
                    float((omega[k] / frequency) ** 2), 1.0, motion @ vector, work, scratch,
                    out, along,
                )  # fmt: skip
                # Deflections come in the unit of length, forces in that of force.
                out *= np.array([length, 1.0, force, force * length, 1.0])
                for member, part in zip(
                    range(first, last), np.split(out, np.cumsum(counts[first:last])[:-1]), strict=True
                ):
                    shapes[member][k] = part
                    if member > first:
                        motions[k, fine.members[member].unknowns[:2]] = along[member - first] * (length, 1.0)
    return shapes, motions


def _part(fine: Members, part: str, shapes: list[Floats], highest: float) -> PartShapes:
    """Shapes along one part from those along its members, whose pieces are those of the highest frequency."""
    from modal.structures.assembly import row_of, units_of
    from modal.structures.kernels import piece_ends

    units = units_of(fine)
    along, found = [np.zeros(1)], []
    properties: list[list[Floats]] = [[], [], [], [], []]
    for member, shape in zip(fine.members, shapes, strict=True):
        if member.part != part:
            continue
        ends = np.zeros(1 + shape.shape[1])
        piece_ends(row_of(member, fine, units), (highest / units[2]) ** 2, 1.0, ends)
        found.append(shape)
        along.append(member.position + ends[1:] * units[0])
        for values, one in zip(properties, _properties(member, ends * units[0]), strict=True):
            values.append(one)
    return PartShapes(np.concatenate(along), np.concatenate(found, axis=1), *map(np.concatenate, properties))


def _properties(member: Member, ends: Floats) -> tuple[Floats, ...]:
    """Properties of the section at the Gauss points of a segment's pieces, as `PartShapes` lists them."""
    s, distance = member.segment, ends[:-1, None] + np.diff(ends)[:, None] * gauss()[0]
    return (
        s.section("mass_per_length", distance),
        s.section("rotary_inertia", distance),
        s.section("bending_stiffness", distance),
        1.0 / s.section("shear_stiffness", distance),
        s.section("mass_flexibility", distance),
    )
