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
    from modal.structures.refinement import refined

    omega = structure.angular_frequencies(whole_number("count", count, 1))
    fine = refined(structure, float(omega[-1]))
    shapes, ends, motions = _shapes(fine, omega)
    parts = {name: _part(fine, name, shapes, ends) for name in dict.fromkeys(m.part for m in fine.members)}
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


def _shapes(fine: Members, omega: Floats) -> tuple[Floats, list[Floats], Floats]:
    """Shapes along all pieces (n, p, terms, 5), where those of each member end, motions of unknowns (n, u), in SI.

    Not yet of unit mass. Pieces are those of the highest frequency, from the first member to the last.
    """
    from modal.structures.assembly import assembly
    from modal.structures.kernels import piece_ends, run_shape
    from modal.structures.kernels.piece import TERMS
    from modal.structures.kernels.stiffness import ROWS, SLOT
    from modal.structures.rows import rows_of, units_of

    units = units_of(fine)
    length, force, frequency = units
    highest = float((omega[-1] / frequency) ** 2)
    rows, counts = rows_of(fine.members, fine, units), np.zeros(len(fine.members))
    ends = np.zeros(piece_ends(rows, highest, 1.0, counts, np.zeros(0)))
    piece_ends(rows, highest, 1.0, counts, ends)
    bounds = np.concatenate([[0], np.cumsum(counts.astype(int))])
    shapes, motions = np.zeros((omega.size, ends.size, TERMS + 1, 5)), np.zeros((omega.size, len(fine.unknowns)))
    for of in _clusters(omega):
        # Arrays made for this frequency alone: those for higher ones would cost digits.
        ready = assembly(fine, float(omega[of][-1]))
        for k, vector in zip(range(omega.size)[of], ready.null_vectors(omega[of]), strict=True):
            motions[k] = ready.composition @ vector
            for (first, last, single), motion in zip(ready.runs.tolist(), ready.motions, strict=True):
                out, along = shapes[k, bounds[first] : bounds[last]], np.zeros((last - first + 1, 2))
                work, scratch = np.zeros((ROWS, TERMS)), np.zeros((SLOT * len(out) + len(out) + 1, 4))
                run_shape(
                    ready.segments, ready.nodes, first, last, single == 1, highest,
                    (omega[k] / frequency) ** 2, 1.0, motion @ vector, work, scratch, out, along,
                )  # fmt: skip
                for member in range(first + 1, last):
                    motions[k, fine.members[member].unknowns[:2]] = along[member - first] * (length, 1.0)
    # Deflections come in the unit of length, forces in that of force.
    shapes *= np.array([length, 1.0, force, force * length, 1.0])
    return shapes, np.split(ends * length, bounds[1:-1]), motions


def _part(fine: Members, part: str, shapes: Floats, ends: list[Floats]) -> PartShapes:
    """Shapes along one part from those along all members."""
    along, properties, chosen = [np.zeros(1)], [], []
    for member, own in zip(fine.members, ends, strict=True):
        chosen.append(np.full(own.size, member.part == part))
        if member.part == part:
            along.append(member.position + own)
            properties.append(_properties(member, np.concatenate([[0.0], own])))
    found = shapes[:, np.concatenate(chosen)]
    return PartShapes(np.concatenate(along), found, *map(np.concatenate, zip(*properties, strict=True)))


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
