"""A structure with nodes where waves and tapers ask for them."""

from __future__ import annotations

from math import ceil, isinf, log
from typing import TYPE_CHECKING

import numpy as np

from modal.structures.kernels import block_counts
from modal.structures.kernels.blocks import SIZES
from modal.structures.members import POINTS, Members
from modal.structures.rows import rows_of, units_of

if TYPE_CHECKING:
    from modal.structures.members import Member

LONGEST = 5
"""Blocks, see `modal.structures.kernels.stiffness`, that a run may have without a node of its own; each is 1.7 rad of
wave at most."""

MOST_RUNS = 128
"""Number of runs from which on they get longer instead: matrices are full."""

STRONGEST = 30.0
"""Change of bending or shear stiffness along a run, as a factor, that needs no node of its own."""


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
    block_counts(rows_of(parts, structure, units), squared, load, np.zeros(SIZES), blocks)
    longest = max(LONGEST, int(blocks.sum()) // most_runs)
    for part, count in zip(parts, blocks.tolist(), strict=True):
        if count <= longest:
            fine.members.append(part)
            continue
        # Equal ones would all have the same fixed-end frequencies.
        cut = part.cut(-(-int(count) // longest), len(fine.unknowns), spread=0.1)
        fine.members += cut
        fine.unknowns += ("m", "rad") * (len(cut) - 1)
    for name in POINTS:
        getattr(fine, name).update(getattr(structure, name))
    return fine


def _even(member: Member, structure: Members) -> list[Member]:
    """A tapered member as several with equal changes of breadth, on new unknowns of the structure."""
    s = member.segment
    if s.end_ratio == 1.0:
        return [member]
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
