"""Laced column whose legs draw together, as beams: every property that of the local breadth, chords inclined."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from math import ceil, isinf, log
from typing import TYPE_CHECKING

from modal.checks import check_positive

if TYPE_CHECKING:
    from modal.beams.segment import Segment
    from modal.lattices.lattice import BeamModel, LacedColumn

STEP = 0.1
"""Largest change of the breadth's logarithm along one segment, along which properties go with powers of the breadth:
the shear stiffness, which goes with no power, is off by 0.2 % between the ends at most."""


def column_segments(
    column: LacedColumn,
    height: float,
    top_ratio: float = 1.0,
    mass_per_length: float | None = None,
    beam: BeamModel = "shear-flexible",
) -> tuple[Segment, ...]:
    """A column that is described at its foot as segments of a `modal.beams.chain.Chain`, from the foot up.

    The height of the panels stays. Legs at a slope to the vertical, ``b'/2`` in both directions for the breadth b,
    are longer, which softens the chords by ``(1 + b'^2/2)^(-3/2)``, and carry the part ``M b'/b`` of the shear; what
    is left strains the lacing, whose stiffness is that of the local breadth. Over columns of 40 m, 8 m to 1.7 m broad
    at the foot and tapering down to an eighth or up to twice that, in panels of 1 or 2 m, the first three frequencies
    are off from the truss by 0.8 % (X), 0.9 % (zigzag) and 2.1 % (N) at most, bare or under a slewing part. Most of
    that, with X and zigzag lacing, is that the truss has its mass at the nodes alone.

    Parameters
    ----------
    column : LacedColumn
    height : float
        Height [m].
    top_ratio : float
        Breadth at the top over that at the foot [1]; with 1 the column is one segment.
    mass_per_length : float, optional
        Mass per height [kg/m]; without one, the members' own.
    beam : {"shear-flexible", "euler", "code-equivalent"}
        See `LacedColumn.segment`; the code's equivalent inertia is that of a column with one breadth.

    Raises
    ------
    ValueError
        If a length, the ratio or a mass is not a positive finite number, or the beam is unknown, or of one breadth.
    """
    check_positive("top_ratio", top_ratio)
    check_positive("height", height)
    if top_ratio == 1.0:
        return (column.segment(height, mass_per_length, beam),)
    if beam == "code-equivalent":
        raise ValueError('beam: wanted "shear-flexible" or "euler" for a column that tapers, got "code-equivalent"')
    count = ceil(abs(log(top_ratio)) / STEP)
    breadths = [column.leg_spacing * top_ratio ** (k / count) for k in range(count + 1)]
    slope = column.leg_spacing * (top_ratio - 1.0) / height
    ends = [_leaning(column, breadth, slope, mass_per_length, beam) for breadth in breadths]
    found = []
    for k, (near, far) in enumerate(pairwise(ends)):
        part, ratio = (breadths[k + 1] - breadths[k]) / slope, breadths[k + 1] / breadths[k]
        segment = tapered(near, far, part, ratio, inclined=beam != "euler")
        found.append(segment if mass_per_length is None else replace(segment, mass_power=0.0))
    return tuple(found)


def tapered(near: Segment, far: Segment, length: float, ratio: float, *, inclined: bool) -> Segment:
    """A segment of a length [m] between two sections, whose properties go with powers of the breadth.

    Parameters
    ----------
    near, far : Segment
        Sections at its ends.
    length : float
    ratio : float
        Breadth at the far end over that at the near end [1].
    inclined : bool
        See `modal.beams.segment.Segment.inclined_chords`.
    """
    if ratio == 1.0:
        return replace(near, length=length)

    def power(name: str) -> float:
        first, last = getattr(near, name), getattr(far, name)
        return 0.0 if isinf(first) else log(last / first) / log(ratio)

    return replace(
        near,
        length=length,
        end_ratio=ratio,
        mass_power=power("mass_per_length"),
        # What does not change with the breadth may round to less than nothing.
        bending_power=max(0.0, power("bending_stiffness")),
        shear_power=power("shear_stiffness"),
        inclined_chords=inclined,
        coupling=0.5 * (near.coupling + far.coupling),
    )


def _leaning(column: LacedColumn, breadth: float, slope: float, mass: float | None, beam: BeamModel) -> Segment:
    """Section of the column at a breadth, its legs leaning by half a slope in both directions; of unit length."""
    here = replace(column, leg_spacing=breadth)
    section = here.segment(1.0, mass, beam)
    leaning = (1.0 + 0.5 * slope**2) ** -1.5
    return replace(section, bending_stiffness=section.bending_stiffness * leaning)
