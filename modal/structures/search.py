"""Search for a structure's natural frequencies and critical loads, octave by octave, each on arrays made for it."""

from __future__ import annotations

from math import inf, sqrt
from typing import TYPE_CHECKING

import numpy as np

from modal.structures.assembly import Assembly, assembly
from modal.structures.members import FewModes, Members, Unstable
from modal.structures.refinement import refined
from modal.structures.rows import units_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

FOREVER = 1e9
"""Load factor beyond which buckling is not looked for."""

SMALLEST = 1e-150
"""Part of a structure's own frequency, or load factor, below which nothing is looked for."""

FEW_RUNS = 16
"""Runs for the search of critical loads, which goes to loads far beyond those of any interest."""

CROWDED = 300.0
"""Waves in a segment [rad] from which on critical loads are looked for from far below: cut for the full load it
would fall into very many pieces, and as a rule it has buckled long before."""

SLICES = 32
"""Of a segment in which its waves are bounded."""

CLOSEST = 0.999
"""Part of the frequency at which masses vibrate on their own flexibility, up to which modes are looked for: there
they crowd, or end."""

_FREE = "structure: wanted one that no motion leaves unstrained, got one without support"


def lowest_frequencies(structure: Members, count: int) -> Floats:
    """Lowest natural angular frequencies [rad/s], see `modal.structures.structure.Structure.angular_frequencies`."""
    require_stable(structure)
    return _lowest(structure, count, units_of(structure)[2], inf, by_load=False)


def buckling_factor(structure: Members) -> float:
    """Lowest critical load factor [1], see `modal.structures.structure.Structure.buckling_factor`."""
    if not structure.is_loaded:
        return inf
    found = _lowest(structure, 1, min(1.0, (CROWDED / _pressed(structure)) ** 2), FOREVER, by_load=True)
    return float(found[0]) if found.size else inf


def require_stable(structure: Members) -> None:
    """Refuse a structure that buckles.

    Raises
    ------
    ValueError
        If the structure can move without strain.
    Unstable
        With the factor under which it buckles.
    """
    crowded = _pressed(structure) > CROWDED
    if not crowded and assembly(refined(structure, 0.0), 0.0).count(0.0) == 0:
        return
    factor = buckling_factor(structure)
    if factor <= 1.0:
        raise Unstable(f"the structure carries only {factor:.4g} times its weights and loads")
    if not crowded:
        raise ValueError(_FREE)


def _pressed(structure: Members) -> float:
    """Largest length of a segment under its weights and loads, in radians of the waves that it buckles in [1]."""
    strongest = 1.0
    for member in structure.members:
        s = member.segment
        # Slice by slice: a thin end need not be where the weight is.
        breadths = np.linspace(1.0, s.end_ratio, SLICES + 1)
        masses = s.mass_per_length * s.length / SLICES * breadths**s.mass_power
        beyond = np.append(np.cumsum(np.maximum(masses[1:], masses[:-1])[::-1])[::-1], 0.0)
        pressed = member.compression + np.maximum(member.gravity * beyond, 0.0)
        stiffness = s.bending_stiffness * breadths**s.bending_power
        slices = np.maximum(pressed[:-1], 0.0) / np.minimum(stiffness[1:], stiffness[:-1])
        strongest = max(strongest, s.length * sqrt(np.max(slices)))
    return strongest


def _lowest(structure: Members, count: int, start: float, most: float, *, by_load: bool) -> Floats:
    """Lowest frequencies or load factors up to one; as many as there are if fewer."""

    def below(limit: float) -> tuple[float, Assembly, int]:
        if by_load:
            ready = assembly(refined(structure, 0.0, limit, FEW_RUNS), 0.0, limit, FEW_RUNS)
            return limit, ready, ready.count(0.0, limit)
        ready = assembly(refined(structure, limit), limit)
        return limit, ready, ready.count(limit)

    # Arrays made for high frequencies would cost digits of low ones.
    highest = inf if by_load else CLOSEST * structure.mass_frequency
    levels = [below(min(start, highest))]
    while levels[-1][2] > 0:
        if levels[-1][0] < SMALLEST * start:
            raise ValueError(_FREE)
        levels.append(below(levels[-1][0] / 8.0))
    above, _, known = levels.pop()
    found: list[Floats] = []
    while known < count and above < most:
        if above == highest:
            raise FewModes(
                f"count: wanted at most {known} frequencies, as many as there are below {highest:.6g} rad/s, where "
                f"masses vibrate on their own flexibility; got {count!r}"
            )
        limit, ready, number = levels.pop() if levels else below(min(2.0 * above, highest))
        if number > known:
            found.append(ready.roots(above, limit, known, min(number, count) - known, by_load=by_load))
            known = number
        above = limit
    return np.concatenate(found) if found else np.empty(0)
