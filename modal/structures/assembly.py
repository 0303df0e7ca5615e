"""A structure made ready for the compiled search: joined to runs as its waves ask for, in its own units."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from modal.structures.kernels import count_below, dynamic_stiffness, find_roots, find_runs, scaled_stiffness
from modal.structures.kernels.blocks import SIZES
from modal.structures.kernels.piece import TERMS
from modal.structures.kernels.stiffness import ROWS
from modal.structures.members import HELD, POINTS, Members
from modal.structures.refinement import LONGEST, MOST_RUNS, STRONGEST
from modal.structures.rows import rows_of, units_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from modal.structures.members import Member

    Floats = NDArray[np.float64]
    Runs = NDArray[np.int64]


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

    @property
    def _scratch(self) -> Floats:
        n = self.points.shape[1]
        return np.zeros((n + 2, n))

    def matrix(self, angular_frequency: float, load: float = 1.0) -> tuple[Floats, int]:
        """Dynamic stiffness in the arrays' units, and the count of fixed-end modes of the runs."""
        matrix = np.zeros(self.points.shape[1:])
        inside = dynamic_stiffness((angular_frequency / self.units[2]) ** 2, load, *self.arrays, matrix)
        return matrix, int(inside)

    def scaled(self, angular_frequency: float, load: float = 1.0) -> tuple[Floats, Floats, int]:
        """Dynamic stiffness with every unknown brought to size, by what it was multiplied, and the count."""
        scratch, n = self._scratch, self.points.shape[1]
        inside = scaled_stiffness((angular_frequency / self.units[2]) ** 2, load, *self.arrays, scratch)
        return scratch[:n], scratch[n], int(inside)

    def count(self, angular_frequency: float, load: float = 1.0) -> int:
        """Number of natural frequencies below one [rad/s], each with its multiplicity."""
        return int(count_below((angular_frequency / self.units[2]) ** 2, load, *self.arrays, self._scratch))

    def roots(self, above: float, below: float, known: int, count: int, *, by_load: bool = False) -> Floats:
        """The next natural angular frequencies [rad/s], or load factors, between two; so many are known below."""
        roots, unit = np.zeros(count), 1.0 if by_load else self.units[2]
        bounds = np.zeros((2, count))
        find_roots(*self.arrays, self._scratch, bounds, by_load, above / unit, below / unit, known, roots)
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
    segments = rows_of(fine.members, fine, units)
    size = np.array([length if unit == "m" else 1.0 for unit in fine.unknowns])
    free = np.zeros(len(segments)) if whole else _free(fine)
    scale = {"springs": 1.0, "geometric": 1.0, "bodies": frequency**2}
    nodes = np.zeros((len(segments), len(POINTS), 3))
    before = {u: (s, k) for s in np.flatnonzero(free) for k, u in enumerate(fine.members[s].unknowns[:2])}
    for row, name in enumerate(POINTS):
        for (i, j), value in getattr(fine, name).items():
            if i in before and j in before:
                (s, k), (_, other) = before[i], before[j]
                nodes[s, row, k + other] = value * scale[name] * size[i] * size[j] / (force * length)
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
    entries = [
        (row, i, j, value * scale[name] / (force * length))
        for row, name in enumerate(POINTS)
        for (i, j), value in getattr(fine, name).items()
        if i not in inside
    ]
    # Most unknowns have nothing on them.
    held = sorted({i for _, i, _, _ in entries})
    place, kept = {u: k for k, u in enumerate(held)}, composition[held]
    points = np.zeros((len(POINTS), len(held), len(held)))
    for row, i, j, value in entries:
        points[row, place[i], place[j]] = value
    points = np.ascontiguousarray(kept.T @ points @ kept)
    return Assembly(fine, units, segments, nodes, runs, motions, points, composition)


def _free(structure: Members) -> Floats:
    """Where the node before a member may lie inside a run: nothing else hangs on its unknowns; shape (members,)."""
    uses = Counter(unknown for member in structure.members for unknown in member.unknowns)
    members, plain = structure.members, (1.0, 1.0)
    free, own = np.zeros(len(members)), {}
    for s, (before, member) in enumerate(pairwise(members), 1):
        near = member.unknowns[:2]
        lone = near == before.unknowns[2:] and HELD not in near and near[0] != near[1]
        if lone and uses[near[0]] == uses[near[1]] == 2 and member.factors[:2] == before.factors[2:] == plain:
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
