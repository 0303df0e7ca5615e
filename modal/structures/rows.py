"""Members of a structure as rows of numbers, in units of the structure's own."""

from __future__ import annotations

from math import inf, sqrt
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from modal.structures.members import Member, Members

    Floats = NDArray[np.float64]
    Units = tuple[float, float, float]


def units_of(structure: Members) -> Units:
    """Length [m], force [N] and circular frequency [rad/s] of the size of the structure's own, however it is cut."""
    parts: dict[str, float] = {}
    bending = mass = 0.0
    for member in structure.members:
        s = member.segment
        parts[member.part] = parts.get(member.part, 0.0) + s.length
        bending, mass = max(bending, s.bending_stiffness), max(mass, s.mass_per_length)
    length = max(parts.values())
    return length, bending / length**2, sqrt(bending / mass) / length**2


def rows_of(members: Sequence[Member], structure: Members, units: Units) -> Floats:
    """Rows of `modal.structures.kernels.cut` for members, shape (members, 15)."""
    length, force, frequency = units
    mass = force / (length * frequency**2)
    engesser = float(structure.shear_theory == "engesser")
    found = []
    for member in members:
        s = member.segment
        shear = s.shear_stiffness
        found.append((
            s.length / length, s.mass_per_length * length / mass, s.bending_stiffness / (force * length**2),
            0.0 if shear == inf else force / shear, s.rotary_inertia / (mass * length), s.end_ratio,
            s.mass_power, s.bending_power, s.shear_power, member.compression / force, member.gravity * mass / force,
            engesser, float(s.inclined_chords), s.mass_flexibility * force / length**2, s.coupling * length,
        ))  # fmt: skip
    return np.array(found)
