"""A structure made ready for the compiled search: cut where it has to be, in arrays, in its own units."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, inf, isinf, log, sqrt
from typing import TYPE_CHECKING

import numpy as np

from modal.stiffness import TERMS
from modal.structure import HELD, Structure
from modal.structure_kernel import ROWS, dynamic_stiffness, find_roots, piece_ends

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from modal.structure import Member

    Floats = NDArray[np.float64]

LONGEST = 5
"""Pieces, see `modal.stiffness`, that a member may have without a node of its own; each is some 1.7 rad of wave."""

SHORT = 0.03
"""Length over that of the longest member below which a member's far end is counted from its near end."""

STRONGEST = 3.0
"""Change of breadth along a tapered member, as a factor, that needs no node of its own."""

FOREVER = 1e9
"""Load factor beyond which buckling is not looked for."""


@dataclass(frozen=True, eq=False)
class Assembly:
    """Arrays of a structure that hold up to a frequency.

    Parameters
    ----------
    structure : Structure
        The structure with the nodes that were put inside its members; the unknowns of the original come first.
    units : tuple of float
        Length [m], force [N] and circular frequency [rad/s] that the arrays are counted in.
    segments, motions, points : ndarray
        As `modal.structure_kernel` takes them.
    composition : ndarray, shape (n, n)
        What turns the arrays' unknowns into the structure's [m, rad]; beyond short members they are departures.
    """

    structure: Structure
    units: tuple[float, float, float]
    segments: Floats
    motions: Floats
    points: Floats
    composition: Floats

    @property
    def _arrays(self) -> tuple[Floats, Floats, Floats, Floats]:
        return self.segments, self.motions, self.points, np.zeros((ROWS, TERMS))

    def matrix(self, angular_frequency: float, load: float = 1.0) -> tuple[Floats, int]:
        """Dynamic stiffness in the arrays' units, and the count of fixed-end modes of the segments."""
        matrix = np.zeros_like(self.composition)
        inside = dynamic_stiffness((angular_frequency / self.units[2]) ** 2, load, *self._arrays, matrix)
        return matrix, int(inside)

    def count(self, angular_frequency: float) -> int:
        """Number of natural frequencies below one [rad/s], each with its multiplicity."""
        matrix, inside = self.matrix(angular_frequency)
        _, geometric, bodies = self.points
        # Heavy bodies are scaled down, or their rounding errors would drown light ones.
        squared = (angular_frequency / self.units[2]) ** 2
        size = np.diag(self.matrix(0.0, 0.0)[0]) + np.abs(np.diag(geometric)) + squared * np.diag(bodies)
        scale = 1.0 / np.sqrt(size)
        return inside + int((np.linalg.eigvalsh(matrix * np.outer(scale, scale)) < 0.0).sum())

    def angular_frequencies(self, count: int) -> Floats:
        """Lowest natural angular frequencies [rad/s]; shape (count,)."""
        roots = np.zeros(count)
        find_roots(dynamic_stiffness, *self._arrays, False, 1.0, inf, roots)
        return roots * self.units[2]

    def buckling_factor(self) -> float:
        """Lowest factor on all weights and axial loads at which the structure buckles [1]; ``inf``: it never does."""
        roots = np.zeros(1)
        found = find_roots(dynamic_stiffness, *self._arrays, True, 1.0, FOREVER, roots)
        return float(roots[0]) if found else inf

    def stiffness(self, unknowns: int) -> Floats:
        """Static stiffness of the original's unknowns under all weights and loads [N/m, N, N m], shape (n, n)."""
        length, force, _ = self.units
        inverse = np.linalg.inv(self.composition)
        full = inverse.T @ self.matrix(0.0)[0] @ inverse * (force * length)
        if unknowns == len(full):
            return full
        inner = np.linalg.solve(full[unknowns:, unknowns:], full[unknowns:, :unknowns])
        condensed: Floats = full[:unknowns, :unknowns] - full[:unknowns, unknowns:] @ inner
        return condensed

    def displacements(self, forces: Floats) -> Floats:
        """Static displacements of the original's unknowns under forces on them, in SI."""
        length, force, _ = self.units
        # Not by way of `stiffness`, which short members spoil.
        kept = self.composition[: len(forces)]
        matrix, _ = self.matrix(0.0)
        scale = 1.0 / np.sqrt(np.diag(matrix))
        solved = np.linalg.solve(
            matrix * np.outer(scale, scale), scale[:, None] * (kept.T @ np.atleast_2d(forces.T).T)
        )
        found = kept @ (scale[:, None] * solved) / (force * length)
        return found.reshape(np.shape(forces))

    def null_vectors(self, angular_frequencies: Floats, double: float) -> Floats:
        """The arrays' unknowns at natural frequencies, shape (k, n); independent ones where they are equal.

        Parameters
        ----------
        angular_frequencies : ndarray, shape (k,)
            Ascending [rad/s].
        double : float
            Relative distance below which frequencies count as equal [1].
        """
        scale = 1.0 / np.sqrt(np.diag(self.matrix(0.0, 0.0)[0]))
        vectors = np.zeros((angular_frequencies.size, scale.size))
        for k, omega in enumerate(angular_frequencies):
            values, found = np.linalg.eigh(self.matrix(omega)[0] * np.outer(scale, scale))
            before = int((np.abs(angular_frequencies[:k] - omega) <= double * omega).sum())
            vectors[k] = scale * found[:, np.argsort(np.abs(values))[before]]
        return vectors


def assembly(structure: Structure, angular_frequency: float) -> Assembly:
    """A structure made ready for frequencies up to one [rad/s].

    Three things would cost digits and are avoided. Between its ends a member that is long for the waves has fixed-end
    frequencies exponentially close to natural ones of the structure, which its condensed stiffness no longer tells
    apart: e^x digits are lost, x the length in waves; so it gets nodes. In a strong taper the slender end hides the
    stout one: it gets nodes too. And a short member is so stiff, as 1/h^3, that rounding of its rigid motion would
    outweigh the rest: beyond it, unknowns are counted from where it would be if it were rigid.
    """
    units = _units(structure)
    squared, none = (angular_frequency / units[2]) ** 2, np.empty(1)
    fine = Structure(structure.unknowns, shear_theory=structure.shear_theory)
    for member in structure.members:
        for part in _even(member, fine):
            pieces = piece_ends(np.array(_properties(part, structure, units)), squared, 1.0, none)
            # Equal ones would all have the same fixed-end frequencies.
            cut = part.cut(max(1, -(-pieces // LONGEST)), len(fine.unknowns), spread=0.1)
            fine.members += cut
            fine.unknowns += ("m", "rad") * (len(cut) - 1)
    extra = len(fine.unknowns) - len(structure.unknowns)
    for name in ("springs", "geometric", "bodies"):
        setattr(fine, name, np.pad(getattr(structure, name), (0, extra)))

    segments = np.array([_properties(member, structure, units) for member in fine.members])
    short = [
        member.segment.length < SHORT * units[0] and piece_ends(row, squared, 1.0, none) == 1
        for member, row in zip(fine.members, segments, strict=True)
    ]
    # A rotation counts as it is, a deflection in units of length.
    size = np.array([units[0] if unit == "m" else 1.0 for unit in fine.unknowns])
    composition, motions, departing = _motions(fine, short, size)
    segments[:, -1] = departing
    motions[:, [0, 2]] /= units[0]
    points = np.array([fine.springs, fine.geometric, fine.bodies * units[2] ** 2])
    points = composition.T @ points @ composition / (units[0] * units[1])
    return Assembly(fine, units, segments, motions, np.ascontiguousarray(points), composition)


def _units(structure: Structure) -> tuple[float, float, float]:
    """Length [m], force [N] and circular frequency [rad/s] of the size of the structure's own."""
    segments = [member.segment for member in structure.members]
    length = max(segment.length for segment in segments)
    bending = max(segment.bending_stiffness for segment in segments)
    mass = max(segment.mass_per_length for segment in segments)
    return length, bending / length**2, sqrt(bending / mass) / length**2


def _properties(member: Member, structure: Structure, units: tuple[float, float, float]) -> list[float]:
    """Row of `modal.stiffness` for a member."""
    s, (length, force, frequency) = member.segment, units
    mass = force / (length * frequency**2)
    flexibility = 0.0 if isinf(s.shear_stiffness) else force / s.shear_stiffness
    return [
        s.length / length, s.mass_per_length * length / mass, s.bending_stiffness / (force * length**2),
        flexibility, s.rotary_inertia / (mass * length), s.end_ratio,
        s.mass_power, s.bending_power, s.shear_power,
        member.compression / force, member.gravity * mass / force, float(structure.shear_theory == "engesser"), 0.0,
    ]  # fmt: skip


def _even(member: Member, structure: Structure) -> list[Member]:
    """A tapered member as several with equal changes of breadth, on new unknowns of the structure."""
    ratio = member.segment.end_ratio
    parts = max(1, ceil(abs(log(ratio)) / log(STRONGEST)))
    found, rest = [], member
    for left in range(parts, 1, -1):
        # Of the breadth that is left, its parts-th root.
        step = rest.segment.end_ratio ** (1.0 / left)
        at = rest.segment.length * (1.0 - step) / (1.0 - rest.segment.end_ratio)
        near, rest = rest.split(at, len(structure.unknowns))
        structure.unknowns += ("m", "rad")
        found.append(near)
    return [*found, rest]


def _motions(structure: Structure, short: list[bool], size: Floats) -> tuple[Floats, Floats, list[bool]]:
    """How the arrays' unknowns move those of the structure and the ends of members, and which far ends depart."""
    composition = np.diag(size)
    motions, departing = np.zeros((len(structure.members), 4, size.size)), []
    used: set[int] = set()
    for s, (member, flag) in enumerate(zip(structure.members, short, strict=True)):
        for row, (i, factor) in enumerate(zip(member.unknowns, member.factors, strict=True)):
            if i != HELD:
                motions[s, row] = factor * composition[i]
        v, theta = member.unknowns[2:]
        # An end that something was measured from already cannot be counted from elsewhere any more.
        departs = flag and HELD not in (v, theta) and not used & {v, theta} and member.factors[2:] == (1.0, 1.0)
        if departs:
            composition[v] += motions[s, 0] + member.segment.length * motions[s, 1]
            composition[theta] += motions[s, 1]
        used.update(member.unknowns)
        departing.append(departs)
    return composition, motions, departing
