"""Finite elements of a plane structure: frequencies, modes, displacements, buckling; a check of the exact ones."""

from __future__ import annotations

from functools import cached_property
from math import ceil, inf, isinf
from typing import TYPE_CHECKING

import numpy as np

from modal.beams.beam import EndBody
from modal.beams.segment import Segment
from modal.elements.beam_elements import MOST_ELEMENTS, Elements, require_elements
from modal.elements.sparse import Entries, factorised, lowest_modes
from modal.structures.members import HELD, Member, Unstable
from modal.structures.structure import Structure

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike, NDArray

    from modal.beams.beam import Beam

    Floats = NDArray[np.float64]

FOREVER = 1e9
"""Load factor beyond which buckling is not looked for."""


class StructureElements:
    """Finite elements for every member of a structure.

    Parameters
    ----------
    structure : Structure
        From `modal.structures.structure.chain_structure` or `modal.structures.crane_frame.crane_structure`, or made
        by hand.
    elements : int
        Number of elements along each part, tower or jib, shared out to its members by length, at least one each.
    allow_round_off : bool
        Accept more than 256 elements, although rounding then outweighs the discretisation.

    Raises
    ------
    ValueError
        If there are too many elements for the round-off floor.

    Notes
    -----
    Frequencies lie above the exact ones, by a relative error of fourth order in the element length where a member
    has no shear strain (cubic Hermite elements), of sixth order where all have (see `modal.elements.beam_elements`).
    A second error grows with the fourth power of the number of elements, see
    `modal.elements.beam_elements.round_off_floor`: with a heavy body the lowest frequency is best at some 30
    elements.
    """

    def __init__(self, structure: Structure, elements: int = 32, *, allow_round_off: bool = False) -> None:
        require_elements("elements", elements, allow_round_off)
        self.structure = structure
        parts: dict[str, float] = {}
        for member in structure.members:
            parts[member.part] = parts.get(member.part, 0.0) + member.segment.length
        fine = Structure(structure.unknowns, shear_theory=structure.shear_theory)
        short = []
        for member in structure.members:
            pieces = max(1, ceil(elements * member.segment.length / parts[member.part] - 1e-9))
            fine.members += member.cut(pieces, len(fine.unknowns))
            fine.unknowns += ("m", "rad") * (pieces - 1)
            short += [pieces == 1 and member.segment.length < parts[member.part] / MOST_ELEMENTS] * pieces
        self._assemble(fine, short)

    def _assemble(self, fine: Structure, short: list[bool]) -> None:
        """Stiffness, geometric stiffness under unit load and mass of a structure whose members are one element each.

        Unknowns are those of its nodes, then those inside elements. A short element's far end is counted from where
        it would be were the element rigid; else its stiffness drowned all others in rounding.
        """
        from scipy.sparse import block_diag, csc_array, eye_array

        absolute, rigid = _follow([m for m, is_short in zip(fine.members, short, strict=True) if is_short], fine)
        size = len(fine.unknowns)
        stiffness, close, geometric, mass = (Entries() for _ in range(4))
        for shear in (False, True):
            rows = [i for i, m in enumerate(fine.members) if isinf(m.segment.shear_stiffness) != shear]
            if not rows:
                continue
            elements = Elements([fine.members[i] for i in rows], shear, fine.shear_theory)
            inner = size + np.arange(len(rows) * elements.inner).reshape(len(rows), -1)
            size += inner.size
            unknowns = np.hstack([[fine.members[i].unknowns for i in rows], inner])
            factors = np.hstack([[fine.members[i].factors for i in rows], np.ones(inner.shape)])
            elastic = elements.stiffness()
            follows = np.array([fine.members[i] in rigid for i in rows])
            stiffness.add(elastic[~follows], unknowns[~follows], factors[~follows])
            # A rigid motion of the whole element strains nothing: what is left is the far end's part.
            elastic[:, :2], elastic[:, :, :2] = 0.0, 0.0
            close.add(elastic[follows], unknowns[follows], factors[follows])
            if any(member.compression or member.gravity for member in elements.members):
                geometric.add(elements.geometric(), unknowns, factors)
            mass.add(elements.mass(), unknowns, factors)
        self._absolute = csc_array(block_diag([absolute, eye_array(size - len(absolute))]))
        found = (
            stiffness.matrix(size, self.structure.springs),
            geometric.matrix(size, self.structure.geometric),
            mass.matrix(size, self.structure.bodies),
        )
        if rigid:
            to = self._absolute
            found = tuple(csc_array(to.T @ matrix @ to) for matrix in found)
        self._stiffness, self._geometric, self._mass = found
        self._stiffness += close.matrix(size)

    @cached_property
    def _solve(self) -> Callable[[Floats], Floats]:
        """Displacements under forces, by a factorisation of the stiffness under the loads."""
        factor = factorised(self._stiffness - self._geometric)
        if factor is None:
            raise Unstable(f"the structure carries only {self.buckling_factor():.4g} times its weights and loads")
        return factor

    def angular_frequencies(self, count: int) -> Floats:
        """Lowest natural angular frequencies [rad/s], ascending; shape (count,).

        Raises
        ------
        ValueError
            If the count is negative or not less than the number of unknowns that have mass.
        Unstable
            If the structure buckles under its weights and loads.
        """
        return np.sqrt(lowest_modes(self._stiffness, self._mass, count, self._solve)[0])

    def modes(self, count: int) -> tuple[Floats, Floats]:
        """Lowest natural angular frequencies [rad/s] and their modes.

        Returns
        -------
        tuple of ndarray, shapes (count,) and (n, count)
            The modes are what the n unknowns of the structure do, of unit modal mass [1/sqrt(kg)], the largest of
            each positive.

        Raises
        ------
        ValueError
            If the count is negative or not less than the number of unknowns that have mass.
        Unstable
            If the structure buckles under its weights and loads.
        """
        values, vectors = lowest_modes(self._stiffness, self._mass, count, self._solve)
        vectors = (self._absolute @ vectors)[: len(self.structure.unknowns)]
        largest = np.abs(vectors).max(axis=0, initial=0.0)
        positive = (vectors == largest).any(axis=0)
        return np.sqrt(values), np.where(positive, vectors, -vectors)

    def displacements(self, forces: ArrayLike) -> Floats:
        """What constant forces and moments on the structure's unknowns do to them under its weights and loads.

        Parameters
        ----------
        forces : array_like, shape (n,)
            Forces [N] and moments [N m].

        Raises
        ------
        ValueError
            If there is not one for each unknown.
        Unstable
            If the structure buckles under its weights and loads.
        """
        n = len(self.structure.unknowns)
        given = np.asarray(forces, dtype=float)
        if given.shape != (n,):
            raise ValueError(f"forces: wanted one for each of {n} unknowns, got shape {given.shape}")
        padded = np.zeros(self._stiffness.shape[0])
        padded[:n] = given
        return np.asarray(self._absolute @ self._solve(self._absolute.T @ padded))[:n]

    def buckling_factor(self) -> float:
        """Factor on all weights and axial loads at which the structure buckles [1]; ``inf``: it never does.

        Raises
        ------
        ValueError
            If the structure can move without strain.
        """
        from scipy.sparse.linalg import LinearOperator, eigsh

        factor = factorised(self._stiffness)
        if factor is None:
            raise ValueError("structure: wanted one that no motion leaves unstrained, got one without support")
        # Where no part of the load softens, the eigenvalues crowd below zero and none is largest.
        if factorised(self._stiffness - FOREVER * self._geometric) is not None:
            return inf
        inverse = LinearOperator(self._stiffness.shape, factor)
        # Of the load's work per strain energy the largest, so that loads which stiffen do not matter.
        start = np.ones(self._stiffness.shape[0])
        largest = eigsh(
            self._geometric, 1, self._stiffness, Minv=inverse, which="LA", v0=start, return_eigenvectors=False
        )[0]
        return 1.0 / float(largest) if largest > 0.0 else inf


def _follow(short: list[Member], structure: Structure) -> tuple[Floats, list[Member]]:
    """Let far ends of short members count from where they would be, were these rigid.

    Returns
    -------
    tuple
        What leads from the new unknowns to the absolute ones, shape (n, n), and the members for which it does.
    """
    absolute, rigid = np.eye(len(structure.unknowns)), []
    taken: set[int] = set()
    # From the foot outward: the near end is then itself in its final place.
    for member in sorted(short, key=lambda member: member.unknowns[2]):
        near, far = member.unknowns[:2], member.unknowns[2:]
        if HELD in far or member.factors[2:] != (1.0, 1.0) or max(near) >= min(far) or taken & {*far}:
            continue
        taken |= {*far}
        for unknown, row, factor in zip(near, (0, 1), member.factors[:2], strict=True):
            if unknown != HELD:
                absolute[far[row]] += factor * absolute[unknown]
                if row == 1:
                    absolute[far[0]] += member.segment.length * factor * absolute[unknown]
        rigid.append(member)
    return absolute, rigid


def finite_element_structure_frequencies(structure: Structure, count: int, *, elements: int = 32) -> Floats:
    """Lowest natural angular frequencies of a structure by finite elements [rad/s]; shape (count,).

    See `StructureElements`, which takes the same arguments and knows more.
    """
    return StructureElements(structure, elements).angular_frequencies(count)


def finite_element_frequencies(
    beam: Beam,
    count: int,
    end_body: EndBody = EndBody(),  # noqa: B008  frozen
    *,
    elements: int = 32,
    allow_round_off: bool = False,
) -> Floats:
    """Natural angular frequencies of a clamped beam with an end body, by scikit-fem's Hermite elements.

    Parameters
    ----------
    beam : Beam
        The beam, clamped at position 0.
    count : int
        Number of frequencies, less than the number of free displacements and rotations (two per element).
    end_body : EndBody
        The body at position L; an infinite mass or inertia holds its centre of mass or its rotation.
    elements : int
        Number of elements of equal length.
    allow_round_off : bool
        Accept more than 256 elements, although rounding then outweighs the discretisation.

    Returns
    -------
    ndarray, shape (count,)
        Angular frequencies in ascending order [rad/s].

    Raises
    ------
    ValueError
        If there are too many elements for the round-off floor, or too few for the count.
    """
    structure = Structure(())
    rotation = structure.add_unknown("rad", end_body.rotary_inertia if isinf(end_body.rotary_inertia) else 0.0)
    if isinf(end_body.mass):
        # The centre of mass rests, and the end of the beam turns about it.
        far, factors = (rotation, rotation), (1.0, 1.0, -end_body.offset, 1.0)
        structure.add_body(EndBody(0.0, end_body.rotary_inertia), HELD, rotation)
    else:
        far, factors = (structure.add_unknown("m"), rotation), (1.0, 1.0, 1.0, 1.0)
        structure.add_body(end_body, *far)
    segment = Segment(beam.length, beam.mass_per_length, beam.bending_stiffness)
    structure.members.append(Member(segment, (HELD, HELD, *far), factors))
    return StructureElements(structure, elements, allow_round_off=allow_round_off).angular_frequencies(count)
