"""How a segment is cut into pieces so short that none with its ends held can vibrate or buckle."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from modal.compiler.kinds import Four, Row

(LENGTH, MASS, BENDING, SHEAR_FLEXIBILITY, ROTARY, RATIO, MASS_POWER, BENDING_POWER, SHEAR_POWER,
 COMPRESSION, WEIGHT, ENGESSER, INCLINED, MASS_FLEXIBILITY, COUPLING) = range(15)  # fmt: skip
"""Properties of a segment, those of the section at its near end. COMPRESSION is that at the far end, to which WEIGHT
times the mass beyond is added along the segment; both are multiplied by the load factor."""

PIECE = 0.4
"""Largest part of a piece's energy that inertia and compression may take, its near end held; with less than one no
motion is without stiffness, and the series converge fast. What is left lets short pieces be added to one."""

SLOWER = 0.15
"""Part of a tension that counts as if it were a compression."""

TAPER = 0.1
"""Largest change of the breadth's logarithm along a cell."""

LEAST_SHEAR = 1e-4
"""Part of the shear stiffness that compression must leave (Engesser); with less a segment counts as unstable: the
number of pieces grows without bound towards none."""


def mass_beyond(segment: Row, left: float) -> float:
    """Mass of the last part of a segment, of a length."""
    ratio, power = segment[RATIO], segment[MASS_POWER] + 1.0
    if ratio == 1.0 or power == 1.0:
        return float(segment[MASS] * left)
    # Counted from the far end, so that a thin one loses no digits.
    growth = left * (1.0 - ratio) / (segment[LENGTH] * ratio)
    if growth < 1.0:
        part = ratio**power * np.expm1(power * np.log1p(growth))
    else:
        part = (ratio * (1.0 + growth)) ** power - ratio**power
    return float(segment[MASS] * segment[LENGTH] * part / ((1.0 - ratio) * power))


def cells(segment: Row) -> int:
    """Number of cells of a segment, in each of which the breadth changes by the same small factor."""
    return max(1, int(np.ceil(abs(np.log(segment[RATIO])) / TAPER)))


def cell(segment: Row, k: int, count: int) -> Four:
    """Breadths at the ends of the k-th cell, its length, and that from its near end to the segment's far end."""
    ratio = segment[RATIO]
    if ratio == 1.0:
        return 1.0, 1.0, segment[LENGTH], segment[LENGTH]
    near = 1.0 if k == 0 else ratio ** (k / count)
    far = ratio if k + 1 == count else ratio ** ((k + 1) / count)
    return (
        near,
        far,
        segment[LENGTH] * ((far - near) / (ratio - 1.0)),
        segment[LENGTH] * ((near - ratio) / (1.0 - ratio)),
    )


def piece_of(ends: Four, i: int, pieces: int) -> Four:
    """The same for the i-th of equal pieces of a cell."""
    near, far, length, left = ends
    step = (far - near) / pieces
    return near + i * step, near + (i + 1) * step, length / pieces, left - i * (length / pieces)


def beyond(segment: Row, ends: Four, omega2: float) -> float:
    """Largest part of the mass's motion that is beyond the axis along a piece or cell, c m w^2."""
    wide = max(ends[0], ends[1])
    return float(omega2 * segment[MASS_FLEXIBILITY] * segment[MASS] * wide ** (1.0 + segment[MASS_POWER]))


def bounds(segment: Row, ends: Four, omega2: float, load: float) -> tuple[float, float, float, float, float, float]:
    """Least bending stiffness, most mass, shear flexibility, rotary inertia, force along a piece or cell; shear left.

    The force is ``P (1 + 5 P/S)`` with the largest compression P: with shear strain g it takes
    ``P (theta^2 + 2 g theta)`` (Haringx), at most ``P (1 + 5 P/S) theta^2`` and a fifth of the energy in shear. With
    Engesser it takes ``P (theta + g)^2``: at most ``2 P / (1 - P/S) theta^2`` and all of that energy but half of the
    part that the force leaves, ``1 - P/S``, which counts as a softer shear stiffness.

    Inclined chords and parallel diagonals couple bending and shear; their energy is no less than that of a section
    without the coupling whose two stiffnesses are less by ``1 + r + r^2``, r^2 = EI g^2 / S.
    """
    near, far, length, left = ends
    wide, thin = max(near, far), min(near, far)
    bending = segment[BENDING] * thin ** segment[BENDING_POWER]
    mass = segment[MASS] * wide ** segment[MASS_POWER] / (1.0 - beyond(segment, ends, omega2))
    power = segment[SHEAR_POWER]
    flexibility = segment[SHEAR_FLEXIBILITY] * (thin if power > 0.0 else wide) ** -power
    rotary = segment[ROTARY] * wide ** segment[BENDING_POWER]
    force, tension, least = 0.0, 0.0, 1.0
    for i in range(3):
        passed = 0.5 * i
        compression = load * (segment[COMPRESSION] + segment[WEIGHT] * mass_beyond(segment, left - passed * length))
        force, tension = max(force, compression), max(tension, -compression)
        there = segment[SHEAR_FLEXIBILITY] * (near + passed * (far - near)) ** -power
        least = min(least, 1.0 - compression * there)
    if (segment[INCLINED] != 0.0 or segment[COUPLING] != 0.0) and flexibility != 0.0:
        incline = abs(segment[INCLINED] * (far - near) / (thin * length)) + abs(segment[COUPLING])
        stout = segment[BENDING] * wide ** segment[BENDING_POWER]
        coupling = np.sqrt(stout * incline * incline * flexibility)
        weaker = 1.0 + coupling + coupling * coupling
        bending /= weaker
        flexibility *= weaker
    # Tension stiffens but for what it does to shear strain; it only makes the series slower.
    if tension * flexibility < 0.2:
        tension *= SLOWER
    force = max(force, tension)
    if segment[ENGESSER] == 0.0:
        return bending, mass, flexibility, rotary, force * (1.0 + 5.0 * force * flexibility), 1.0
    left = max(least, LEAST_SHEAR)
    return bending, mass, 2.0 * flexibility / left, rotary, 2.0 * force / left, least


def pieces_within(segment: Row, ends: Four, omega2: float, load: float) -> int:
    """Number of equal pieces of a cell, short enough to have no fixed-end mode; 0: unstable in shear.

    With the near end held and strain energy U, ``v^2 <= 2 U (x^3 / 3 EI + x / S)`` and ``theta^2 <= 2 U x / EI`` at
    the distance x; what inertia and compression take follows.
    """
    bending, mass, flexibility, rotary, force, shear_left = bounds(segment, ends, omega2, load)
    if shear_left < LEAST_SHEAR:
        return 0
    length, pieces = ends[2], 0.0
    moved = beyond(segment, ends, omega2)
    if moved != 0.0:
        # The series of 1 / (1 - c m w^2) must converge as well.
        growth = abs(np.log(ends[1] / ends[0])) * (1.0 + segment[MASS_POWER])
        pieces = 5.0 * growth * moved / (1.0 - moved)
    if segment[ENGESSER] != 0.0:
        # 1 / (1 - P/S) must vary little along a piece as well.
        pieces = max(pieces, 0.5 * abs(load) * segment[WEIGHT] * mass * length * flexibility / TAPER)
    quartic = omega2 * mass / (12.0 * bending)
    half = 0.25 * omega2 * (mass * flexibility + rotary / bending) + 0.5 * force / bending
    squared = (half + np.sqrt(half * half + quartic * PIECE)) / PIECE
    return 1 + int(max(pieces, length * np.sqrt(squared)))
