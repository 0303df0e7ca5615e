"""Lattice jib of several lattices, as the frame that it is drawn as and as a beam."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from modal.checks import check_positive, whole_number
from modal.lattices.space import beam_of, frame_of_round

if TYPE_CHECKING:
    from modal.elements.space_beam import SpaceBeam
    from modal.elements.space_frame import SpaceFrame
    from modal.lattices.jib import JibLattice
    from modal.lattices.walls import Wall


SAME = 0.01
"""Relative; heights of lattices end to end that differ by less count as rounded."""

DIGITS = 9
"""Of the places of nodes along a jib [m]."""


@dataclass(frozen=True, eq=False)
class LatticeJib:
    """Lattices end to end from the root out, whose chords are held at the root.

    Parameters
    ----------
    parts : tuple of (float, JibLattice)
        Lengths [m], each a whole number of panels, and lattices.

    Raises
    ------
    ValueError
        If there is no part, a length is no whole number of panels, or shapes, breadths or heights do not meet.

    Notes
    -----
    Along the jib is x, to the left y, up z. Members cross from one lattice to the next with areas in series. Chords
    end with their last node; where a rectangle ends, posts and a diagonal keep its shape.
    """

    parts: tuple[tuple[float, JibLattice], ...]

    def __post_init__(self) -> None:
        if not self.parts:
            raise ValueError("LatticeJib.parts: wanted at least one, got none")
        for length, lattice in self.parts:
            panels = check_positive("LatticeJib.parts: length", length) / lattice.panel_length
            if not (panels > 0.5 and abs(panels - round(panels)) < 1e-6 * panels):
                raise ValueError(
                    f"LatticeJib.parts: wanted a whole number of panels of {lattice.panel_length!r} m, got "
                    f"{length!r} m, which is {panels:.6g}"
                )
        for name in ("shape", "side", "breadth"):
            values = {getattr(lattice, name) for _, lattice in self.parts}
            if len(values) > 1:
                raise ValueError(f"LatticeJib.parts: wanted one {name} all along, got {sorted(values)!r}")
        for (_, near), (_, far) in pairwise(self.parts):
            if abs(far.height - near.far_height) > SAME * near.far_height:
                raise ValueError(
                    f"LatticeJib.parts: wanted a height of {near.far_height:.6g} m as that before ends with, got "
                    f"{far.height:.6g} m"
                )

    @property
    def length(self) -> float:
        """Length of all parts together [m]."""
        return sum(length for length, _ in self.parts)

    def frame(self, rigidity: float | None = None) -> SpaceFrame:
        """The jib member by member.

        Parameters
        ----------
        rigidity : float, optional
            Second moment of area of every member over the square of its area [1], where joints are rigid: 1/4 pi of
            round bars, 1/8 pi times diameter over wall of round tubes; without it all are pinned.
        """
        members = _Members(self)
        areas, moduli, masses = (np.array(values) for values in zip(*members.values, strict=True))
        nodes, pairs = np.array(list(members.nodes)), np.array(members.pairs)
        return frame_of_round(nodes, pairs, areas, moduli, masses, np.flatnonzero(nodes[:, 0] == 0.0), rigidity)

    def beam(self, elements: int = 10) -> SpaceBeam:
        """The jib as a beam, each part as so many elements, its tip as `modal.lattices.space.beam_of` has it."""
        whole_number("elements", elements, 1)
        sections = [
            (length / elements, lattice.at((k + 0.5) / elements, length))
            for length, lattice in self.parts
            for k in range(elements)
        ]
        return beam_of(sections, self.frame(), 0.5 * self.parts[-1][1].panel_length)


class _Members:
    """Nodes and members of a jib, put together part by part."""

    def __init__(self, jib: LatticeJib) -> None:
        self.nodes: dict[tuple[float, float, float], int] = {}
        self.pairs: list[tuple[int, int]] = []
        self.values: list[tuple[float, float, float]] = []
        # Positions of nodes along each chord.
        stations: dict[int, set[float]] = defaultdict(lambda: {0.0})
        # Rounded, so that a node that ends two walls is one.
        self.ends = np.cumsum([0.0, *(length for length, _ in jib.parts)]).round(DIGITS)
        self.jib = jib
        count = len(jib.parts[0][1].section(1.0).chords)
        passed = [0] * count
        for (length, lattice), start in zip(jib.parts, self.ends, strict=False):
            for k, wall in enumerate(lattice.walls):
                panels = round(length / wall.panel)
                at = [float(x) for x in (start + length * np.arange(panels + 1) / panels).round(DIGITS)]
                self._lace(lattice, wall, at, stations, passed[k])
                passed[k] += panels
        end = float(self.ends[-1])
        if count == 4:
            lattice = jib.parts[-1][1]
            for first, second in ((0, 1), (1, 2), (2, 3), (3, 0), (0, 2)):
                stations[first].add(end)
                self._member((first, end), (second, end), lattice, lattice.base_diagonal_area)
        for chord in range(count):
            ordered = sorted(stations[chord])
            for near, far in pairwise(ordered):
                self._chord(chord, near, far)

    def _lace(
        self, lattice: JibLattice, wall: Wall, at: list[float], stations: dict[int, set[float]], passed: int
    ) -> None:
        first, second = wall.first, wall.second

        def join(here: float, there: float, area: float) -> None:
            stations[first].add(here)
            stations[second].add(there)
            self._member((first, here), (second, there), lattice, area)

        for k, (near, far) in enumerate(pairwise(at)):
            # A zigzag goes on where that of the part before ended.
            back = wall.lacing == "zigzag" and (passed + k) % 2 == 1
            join(*((far, near) if back else (near, far)), wall.diagonal_area)
            if wall.lacing == "X":
                join(far, near, wall.diagonal_area)
            if wall.post_area > 0.0:
                join(far, far, wall.post_area)

    def _chord(self, chord: int, near: float, far: float) -> None:
        """A member of a chord, through whatever lattices it passes."""
        passed = np.clip(self.ends, near, far)
        shares = np.diff(passed) / (far - near)
        areas = [(lattice.base_chord_area, lattice.opposite_chord_area)[chord > 1] for _, lattice in self.jib.parts]
        moduli = [lattice.youngs_modulus for _, lattice in self.jib.parts]
        further = [0.5 * lattice.further_mass_per_length * (chord < 2) for _, lattice in self.jib.parts]
        masses = [lattice.density * area for (_, lattice), area in zip(self.jib.parts, areas, strict=True)]
        stiff = 1.0 / float(shares @ (1.0 / (np.array(areas) * moduli)))
        modulus = float(shares @ moduli)
        ends = self._node(chord, near), self._node(chord, far)
        self.pairs.append(ends)
        # Rails weigh by length of the jib.
        start, end = (np.array(list(self.nodes)[node]) for node in ends)
        mass = float(shares @ masses) + float(shares @ further) * (far - near) / float(np.linalg.norm(end - start))
        self.values.append((stiff / modulus, modulus, mass))

    def _member(self, start: tuple[int, float], end: tuple[int, float], lattice: JibLattice, area: float) -> None:
        self.pairs.append((self._node(*start), self._node(*end)))
        self.values.append((area, lattice.youngs_modulus, lattice.density * area))

    def _node(self, chord: int, x: float) -> int:
        part = max(int(np.searchsorted(self.ends, x, side="left")) - 1, 0)
        length, lattice = self.jib.parts[part]
        there = lattice.at((x - float(self.ends[part])) / length, length).chords[chord]
        return self.nodes.setdefault((x, there.y, there.z), len(self.nodes))
