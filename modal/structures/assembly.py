"""A structure made ready for the compiled search: cut and joined to runs as its waves ask for, in its own units."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, isinf, log, sqrt
from typing import TYPE_CHECKING

import numpy as np

from modal.structures.kernels import block_counts, dynamic_stiffness, find_roots, find_runs
from modal.structures.kernels.blocks import SIZES
from modal.structures.kernels.piece import TERMS
from modal.structures.kernels.stiffness import ROWS
from modal.structures.members import HELD, POINTS, Members

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from modal.structures.members import Member

    Floats = NDArray[np.float64]
    Runs = NDArray[np.int64]

LONGEST = 5
"""Blocks, see `modal.structures.kernels.stiffness`, that a run may have without a node of its own; each is 1.7 rad of
wave at most."""

MOST_RUNS = 128
"""Number of runs from which on they get longer instead: matrices are full."""

STRONGEST = 30.0
"""Change of bending or shear stiffness along a run, as a factor, that needs no node of its own."""


@dataclass(frozen=True, eq=False)
class Assembly:
    """Arrays of a structure that hold up to a frequency and a load factor.

    Parameters
    ----------
    structure : Members
        The structure with the nodes that were put inside its members; the unknowns of the original come first.
    units : tuple of float
        Length [m], force [N] and circular frequency [rad/s] that the arrays are counted in.
    segments, nodes, runs, motions, points : ndarray
        As `modal.structures.kernels.structure` takes them.
    composition : ndarray, shape (u, n)
        What turns the arrays' unknowns into the structure's u [m, rad]; beyond single blocks they are departures, and
        those inside a run do not follow.
    """

    structure: Members
    units: tuple[float, float, float]
    segments: Floats
    nodes: Floats
    runs: Runs
    motions: Floats
    points: Floats
    composition: Floats

    @property
    def arrays(self) -> tuple[Floats, Floats, Runs, Floats, Floats, Floats]:
        """What kernels take, the scratch array last."""
        return self.segments, self.nodes, self.runs, self.motions, self.points, np.zeros((ROWS, TERMS))

    def matrix(self, angular_frequency: float, load: float = 1.0) -> tuple[Floats, int]:
        """Dynamic stiffness in the arrays' units, and the count of fixed-end modes of the runs."""
        matrix = np.zeros(self.points.shape[1:])
        inside = dynamic_stiffness((angular_frequency / self.units[2]) ** 2, load, *self.arrays, matrix)
        return matrix, int(inside)

    def scaled(self, angular_frequency: float, load: float = 1.0) -> tuple[Floats, Floats, int]:
        """Dynamic stiffness with every unknown brought to size, by what it was multiplied, and the count."""
        matrix, inside = self.matrix(angular_frequency, load)
        _, geometric, bodies = (np.abs(np.diag(points)) for points in self.points)
        squared = (angular_frequency / self.units[2]) ** 2
        size = np.diag(self.matrix(0.0, 0.0)[0]) + load * geometric + squared * bodies + np.abs(np.diag(matrix))
        scale = 1.0 / np.sqrt(np.where(size > 0.0, size, 1.0))
        return matrix * np.outer(scale, scale), scale, inside

    def count(self, angular_frequency: float, load: float = 1.0) -> int:
        """Number of natural frequencies below one [rad/s], each with its multiplicity."""
        matrix, _, inside = self.scaled(angular_frequency, load)
        return inside + int((np.linalg.eigvalsh(matrix) < 0.0).sum())

    def roots(self, above: float, below: float, known: int, count: int, *, by_load: bool = False) -> Floats:
        """The next natural angular frequencies [rad/s], or load factors, between two; so many are known below."""
        roots, unit = np.zeros(count), 1.0 if by_load else self.units[2]
        unknowns = self.points.shape[1]
        scratch, bounds = np.zeros((unknowns + 2, unknowns)), np.zeros((2, count))
        find_roots(*self.arrays, scratch, bounds, by_load, above / unit, below / unit, known, roots)
        return roots * unit

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
        matrix, scale, _ = self.scaled(0.0)
        solved = np.linalg.solve(matrix, scale[:, None] * (kept.T @ np.atleast_2d(forces.T).T))
        found = kept @ (scale[:, None] * solved) / (force * length)
        return found.reshape(np.shape(forces))

    def null_vectors(self, angular_frequencies: Floats) -> Floats:
        """The arrays' unknowns at natural frequencies that count as one [rad/s], shape (k, n), independent."""
        vectors = []
        for k, omega in enumerate(angular_frequencies):
            matrix, scale, _ = self.scaled(omega)
            values, found = np.linalg.eigh(matrix)
            vectors.append(scale * found[:, np.argsort(np.abs(values))[k]])
        return np.array(vectors)


def refined(structure: Members, angular_frequency: float, load: float = 1.0, most_runs: int = MOST_RUNS) -> Members:
    """The structure with nodes inside long members, up to a frequency [rad/s] and a load factor.

    Between its ends a member that is long for the waves has fixed-end frequencies exponentially close to natural ones
    of the structure, which its condensed stiffness no longer tells apart: e^x digits are lost, x the length in waves.
    In a strong taper the slender end hides the stout one. Both get nodes.
    """
    units = units_of(structure)
    squared = (angular_frequency / units[2]) ** 2
    fine = Members(structure.unknowns, shear_theory=structure.shear_theory)
    parts = [part for member in structure.members for part in _even(member, fine)]
    blocks = np.zeros(len(parts))
    block_counts(np.array([row_of(part, structure, units) for part in parts]), squared, load, np.zeros(SIZES), blocks)
    longest = max(LONGEST, int(blocks.sum()) // most_runs)
    for part, count in zip(parts, blocks, strict=True):
        # Equal ones would all have the same fixed-end frequencies.
        cut = part.cut(-(-int(count) // longest), len(fine.unknowns), spread=0.1)
        fine.members += cut
        fine.unknowns += ("m", "rad") * (len(cut) - 1)
    for name in POINTS:
        getattr(fine, name).update(getattr(structure, name))
    return fine


def assembly(
    fine: Members, angular_frequency: float, load: float = 1.0, most_runs: int = MOST_RUNS, *, whole: bool = False
) -> Assembly:
    """The arrays of a `refined` structure for frequencies up to one [rad/s] and a load factor.

    Segments are joined to runs as long as the waves allow, so that neither the number of unknowns nor the digits hang
    on how finely the structure is cut. A run that is a single block is so stiff, as 1/h^3, that rounding of its rigid
    motion would outweigh the rest: beyond it, unknowns are counted from where it would be if it were rigid.

    Parameters
    ----------
    fine : Members
    angular_frequency, load : float
    most_runs : int
    whole : bool
        Whether to keep every unknown.
    """
    units = units_of(fine)
    length, force, frequency = units
    segments = np.array([row_of(member, fine, units) for member in fine.members])
    size = np.array([length if unit == "m" else 1.0 for unit in fine.unknowns])
    free = np.zeros(len(segments)) if whole else _free(fine)
    scale = {"springs": 1.0, "geometric": 1.0, "bodies": frequency**2}
    nodes = np.zeros((len(segments), len(POINTS), 3))
    for s in np.flatnonzero(free):
        v, theta = fine.members[s].unknowns[:2]
        for row, name in enumerate(POINTS):
            found = getattr(fine, name)
            for column, (i, j) in enumerate(((v, v), (v, theta), (theta, theta))):
                nodes[s, row, column] = found.get((i, j), 0.0) * scale[name] * size[i] * size[j] / (force * length)
    squared, runs = (angular_frequency / frequency) ** 2, np.zeros((len(segments), 3), dtype=np.int64)
    scratch, longest, number = np.zeros((4, SIZES)), LONGEST, most_runs + 1
    while number > most_runs and longest <= LONGEST * len(segments):
        number = find_runs(segments, nodes, free, squared, load, longest, STRONGEST, scratch, runs)
        longest *= 2
    runs = runs[:number]

    starts = set(runs[:, 0].tolist())
    inside = {u for s in np.flatnonzero(free) if s not in starts for u in fine.members[s].unknowns[:2]}
    outer = [u for u in range(size.size) if u not in inside]
    composition, motions = _motions(fine, runs, size, outer, angular_frequency**2)
    motions[:, [0, 2]] /= length
    points = np.zeros((len(POINTS), len(outer), len(outer)))
    place = {u: k for k, u in enumerate(outer)}
    for row, name in enumerate(POINTS):
        for (i, j), value in getattr(fine, name).items():
            if i in place:
                points[row, place[i], place[j]] = value * scale[name]
    kept = composition[outer]
    points = np.ascontiguousarray(kept.T @ points @ kept / (force * length))
    return Assembly(fine, units, segments, nodes, runs, motions, points, composition)


def units_of(structure: Members) -> tuple[float, float, float]:
    """Length [m], force [N] and circular frequency [rad/s] of the size of the structure's own, however it is cut."""
    parts: dict[str, float] = {}
    for member in structure.members:
        parts[member.part] = parts.get(member.part, 0.0) + member.segment.length
    length = max(parts.values())
    bending = max(member.segment.bending_stiffness for member in structure.members)
    mass = max(member.segment.mass_per_length for member in structure.members)
    return length, bending / length**2, sqrt(bending / mass) / length**2


def row_of(member: Member, structure: Members, units: tuple[float, float, float]) -> Floats:
    """Row of `modal.structures.kernels.piece` for a member, shape (14,)."""
    s, (length, force, frequency) = member.segment, units
    mass = force / (length * frequency**2)
    flexibility = 0.0 if isinf(s.shear_stiffness) else force / s.shear_stiffness
    return np.array([
        s.length / length, s.mass_per_length * length / mass, s.bending_stiffness / (force * length**2),
        flexibility, s.rotary_inertia / (mass * length), s.end_ratio,
        s.mass_power, s.bending_power, s.shear_power, member.compression / force, member.gravity * mass / force,
        float(structure.shear_theory == "engesser"), float(s.inclined_chords),
        s.mass_flexibility * force / length**2,
    ])  # fmt: skip


def _even(member: Member, structure: Members) -> list[Member]:
    """A tapered member as several with equal changes of breadth, on new unknowns of the structure."""
    s = member.segment
    power = max(s.bending_power, 0.0 if isinf(s.shear_stiffness) else abs(s.shear_power))
    parts = max(1, ceil(power * abs(log(s.end_ratio)) / log(STRONGEST)))
    found, rest = [], member
    for left in range(parts, 1, -1):
        # Of the breadth that is left, its parts-th root.
        step = rest.segment.end_ratio ** (1.0 / left)
        at = rest.segment.length * (1.0 - step) / (1.0 - rest.segment.end_ratio)
        near, rest = rest.split(at, len(structure.unknowns))
        structure.unknowns += ("m", "rad")
        found.append(near)
    return [*found, rest]


def _free(structure: Members) -> Floats:
    """Where the node before a member may lie inside a run: nothing else hangs on its unknowns; shape (members,)."""
    uses = np.zeros(len(structure.unknowns), dtype=int)
    for member in structure.members:
        for unknown in member.unknowns:
            if unknown != HELD:
                uses[unknown] += 1
    members = structure.members
    free, own = np.zeros(len(members)), {}
    for s in range(1, len(members)):
        near, far = members[s].unknowns[:2], members[s - 1].unknowns[2:]
        plain = members[s].factors[:2] == members[s - 1].factors[2:] == (1.0, 1.0)
        if plain and near == far and HELD not in near and near[0] != near[1] and (uses[[*near]] == 2).all():
            free[s] = 1.0
            own.update(dict.fromkeys(near, s))
    for name in POINTS:
        for i, j in getattr(structure, name):
            if own.get(i) != own.get(j):
                for unknown in (i, j):
                    if unknown in own:
                        free[own[unknown]] = 0.0
    return free


def _is_light(structure: Members, members: list[Member], v: int, theta: int, omega2: float) -> bool:
    """Whether the body at the far end of members yields to their stiffness at a square of a circular frequency."""
    span = turn = slide = 0.0
    for member in members:
        s = member.segment
        span += s.length
        turn += s.length / (s.bending_stiffness * min(1.0, s.end_ratio**s.bending_power))
        slide += s.length / (s.shear_stiffness * min(1.0, s.end_ratio**s.shear_power))
    sway = span**2 * turn + slide
    body = structure.bodies
    return omega2 * (body.get((v, v), 0.0) * sway + body.get((theta, theta), 0.0) * turn) < 1.0


def _motions(structure: Members, runs: Runs, size: Floats, outer: list[int], omega2: float) -> tuple[Floats, Floats]:
    """How the arrays' unknowns move those of the structure and the ends of runs; of runs only some remain single."""
    composition = np.zeros((size.size, len(outer)))
    composition[outer, range(len(outer))] = size[outer]
    motions = np.zeros((len(runs), 4, len(outer)))
    used: set[int] = set()
    for r, (first, last, single) in enumerate(runs):
        near, far = structure.members[first], structure.members[last - 1]
        unknowns, factors = (*near.unknowns[:2], *far.unknowns[2:]), (*near.factors[:2], *far.factors[2:])
        for row, (i, factor) in enumerate(zip(unknowns, factors, strict=True)):
            if i != HELD:
                motions[r, row] = factor * composition[i]
        v, theta = unknowns[2:]
        # An end that something was measured from already cannot be counted from elsewhere any more, and one with a
        # heavy body rests where it is.
        lone = HELD not in (v, theta) and not used & {v, theta} and factors[2:] == (1.0, 1.0)
        if single and not (lone and _is_light(structure, structure.members[first:last], v, theta, omega2)):
            runs[r, 2] = 0
        elif single:
            span = sum(member.segment.length for member in structure.members[first:last])
            composition[v] += motions[r, 0] + span * motions[r, 1]
            composition[theta] += motions[r, 1]
        used.update(unknowns)
    return composition, motions
