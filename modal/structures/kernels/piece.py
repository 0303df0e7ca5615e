"""What the near end of a short piece of a beam does to its far end, exact but for rounding.

The state (v, theta, V, M), deflection, section rotation, transverse force and moment, obeys with compression P

    v' = a theta + b (V + g M),  theta' = M / EI + g (v' - theta),  V' = -m w^2 v,  M' = -V - P v' - rho I w^2 theta

with a = 1 + P/S, b = 1/S (Haringx) or a = 1/(1 - P/S), b = a/S (Engesser). Inclined chords at the breadth B, which
carry a part of the shear, have g = B'/B; all else has g = 0. Mass m on a flexibility c of its own counts for
m = m / (1 - c m w^2). A segment is cut into pieces so short that none with its
ends held can vibrate or buckle at the frequency asked for, and each is solved by the Taylor series of its state,
whatever the change of section and compression along it.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from modal.compiler.compiled import kernel

(LENGTH, MASS, BENDING, SHEAR_FLEXIBILITY, ROTARY, RATIO, MASS_POWER, BENDING_POWER, SHEAR_POWER,
 COMPRESSION, WEIGHT, ENGESSER, INCLINED, MASS_FLEXIBILITY) = range(14)  # fmt: skip
"""Properties of a segment, those of the section at its near end. COMPRESSION is that at the far end, to which WEIGHT
times the mass beyond is added along the segment; both are multiplied by the load factor."""

TERMS = 22
"""Terms of the Taylor series: with the pieces cut as below, what is left out is rounding, 1e-16 of a stiffness."""

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

SERIES = 9
"""Rows of the scratch array of `coefficients`."""


@kernel()
def mass_beyond(segment: Any, left: float) -> float:
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


@kernel()
def cells(segment: Any) -> int:
    """Number of cells of a segment, in each of which the breadth changes by the same small factor."""
    return max(1, int(np.ceil(abs(np.log(segment[RATIO])) / TAPER)))


@kernel()
def cell(segment: Any, k: int, count: int) -> Any:
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


@kernel()
def piece_of(ends: Any, i: int, pieces: int) -> Any:
    """The same for the i-th of equal pieces of a cell."""
    near, far, length, left = ends
    step = (far - near) / pieces
    return near + i * step, near + (i + 1) * step, length / pieces, left - i * (length / pieces)


@kernel()
def beyond(segment: Any, ends: Any, omega2: float) -> float:
    """Largest part of the mass's motion that is beyond the axis along a piece or cell, c m w^2."""
    wide = max(ends[0], ends[1])
    return float(omega2 * segment[MASS_FLEXIBILITY] * segment[MASS] * wide ** (1.0 + segment[MASS_POWER]))


@kernel()
def bounds(segment: Any, ends: Any, omega2: float, load: float) -> Any:
    """Least bending stiffness, most mass, shear flexibility, rotary inertia, force along a piece or cell; shear left.

    The force is ``P (1 + 5 P/S)`` with the largest compression P: with shear strain g it takes
    ``P (theta^2 + 2 g theta)`` (Haringx), at most ``P (1 + 5 P/S) theta^2`` and a fifth of the energy in shear. With
    Engesser it takes ``P (theta + g)^2``: at most ``2 P / (1 - P/S) theta^2`` and all of that energy but half of the
    part that the force leaves, ``1 - P/S``, which counts as a softer shear stiffness.

    Inclined chords couple bending and shear; their energy is no less than that of a section without the coupling
    whose two stiffnesses are less by ``1 + r + r^2``, r^2 = EI g^2 / S.
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
    if segment[INCLINED] != 0.0 and flexibility != 0.0:
        incline = (far - near) / (thin * length)
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


@kernel()
def pieces_within(segment: Any, ends: Any, omega2: float, load: float) -> int:
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


@kernel()
def _power_series(value: float, change: float, power: float, out: Any, terms: int) -> None:
    """Coefficients of value (1 + change s)^power in s."""
    out[0] = value
    for i in range(1, terms):
        out[i] = out[i - 1] * change * (power - i + 1.0) / i


@kernel()
def coefficients(segment: Any, ends: Any, omega2: float, load: float, out: Any) -> int:
    """Series of m w^2, 1/EI, a, b, P, rho I w^2 and, last, g along a piece, in its units; their number of terms.

    Lengths are counted in the piece's length h and forces in EI/h^2 at its start.
    """
    near, far, length, left = ends
    bending = segment[BENDING] * near ** segment[BENDING_POWER]
    mass = segment[MASS] * near ** segment[MASS_POWER]
    flexibility = segment[SHEAR_FLEXIBILITY] * near ** -segment[SHEAR_POWER]
    rotary = segment[ROTARY] * near ** segment[BENDING_POWER]
    force = load * (segment[COMPRESSION] + segment[WEIGHT] * mass_beyond(segment, left)) * length**2 / bending
    weight = load * segment[WEIGHT] * mass * length**3 / bending
    flexibility *= bending / length**2
    change = (far - near) / near

    terms = TERMS if change != 0.0 or (segment[ENGESSER] != 0.0 and weight * flexibility != 0.0) else 2
    for row in range(SERIES):
        for i in range(terms):
            out[row, i] = 0.0
    out[0, 0], out[1, 0], out[3, 0], out[5, 0] = mass, 1.0, flexibility, rotary
    if change != 0.0:
        _power_series(mass, change, segment[MASS_POWER], out[0], terms)
        _power_series(1.0, change, -segment[BENDING_POWER], out[1], terms)
        _power_series(flexibility, change, -segment[SHEAR_POWER], out[3], terms)
        _power_series(rotary, change, segment[BENDING_POWER], out[5], terms)
        if segment[INCLINED] != 0.0:
            _power_series(change, change, -1.0, out[SERIES - 1], terms)
    out[4, 0] = force
    for i in range(1, terms):
        out[4, i] = -weight * out[0, i - 1] / (mass * i)
    for i in range(terms):
        out[0, i] *= omega2 * length**4 / bending
        out[5, i] *= omega2 * length**2 / bending
    taken = omega2 * segment[MASS_FLEXIBILITY] * near * mass
    if taken != 0.0:
        _power_series(taken, change, 1.0 + segment[MASS_POWER], out[6], terms)
        for i in range(terms):
            for j in range(1, i + 1):
                out[0, i] += out[6, j] * out[0, i - j]
            out[0, i] /= 1.0 - taken
    # P/S first, then a and b from it.
    for i in range(terms):
        product = 0.0
        for j in range(i + 1):
            product += out[4, j] * out[3, i - j]
        out[2, i] = product
    if segment[ENGESSER] == 0.0:
        out[2, 0] += 1.0
        return int(terms)
    first = 1.0 - out[2, 0]
    for i in range(terms):
        total = 1.0 if i == 0 else 0.0
        for j in range(i):
            total += out[2, i - j] * out[6, j]
        out[6, i] = total / first
    for i in range(terms):
        product = 0.0
        for j in range(i + 1):
            product += out[6, j] * out[3, i - j]
        out[7, i] = product
    for i in range(terms):
        out[2, i], out[3, i] = out[6, i], out[7, i]
    return int(terms)


@kernel()
def state_series(series: Any, terms: int, state: Any) -> None:
    """Taylor coefficients of (v, theta, V, M) along a piece of unit length; ``state[0]`` holds the start.

    Parameters
    ----------
    series : ndarray, shape (SERIES, TERMS)
        From `coefficients`.
    terms : int
        How many of them are not zero.
    state : ndarray, shape (TERMS + 1, 6)
        Row k is the coefficient of s^k; after the four, v' and V + g M.
    """
    inclined = series[SERIES - 1, 0] != 0.0
    for k in range(TERMS):
        last = min(k, terms - 1)
        state[k, 5] = state[k, 2]
        if inclined:
            for i in range(last + 1):
                state[k, 5] += series[SERIES - 1, i] * state[k - i, 3]
        dv, dtheta, dforce, dmoment = 0.0, 0.0, 0.0, -state[k, 2]
        for i in range(last + 1):
            dv += series[2, i] * state[k - i, 1] + series[3, i] * state[k - i, 5]
            dtheta += series[1, i] * state[k - i, 3]
            dforce -= series[0, i] * state[k - i, 0]
            dmoment -= series[5, i] * state[k - i, 1]
        state[k, 4] = dv
        for i in range(last + 1):
            dmoment -= series[4, i] * state[k - i, 4]
        if inclined:
            for i in range(last + 1):
                dtheta += series[SERIES - 1, i] * (state[k - i, 4] - state[k - i, 1])
        state[k + 1, 0], state[k + 1, 1] = dv / (k + 1), dtheta / (k + 1)
        state[k + 1, 2], state[k + 1, 3] = dforce / (k + 1), dmoment / (k + 1)
    state[TERMS, 4] = state[TERMS, 5] = 0.0


@kernel()
def piece_transfer(segment: Any, ends: Any, omega2: float, load: float, series: Any, state: Any, out: Any) -> None:
    """What a unit of v, theta, V, M at the near end gives at the far end beyond rigid motion and equilibrium.

    A rigid piece without mass or load moves the far end by ``v + h theta`` and carries ``M - h V`` to it. What is
    left is small for a short piece, and sums of it keep digits that the whole transfer matrix would drown.

    ``out`` is (4, 4); ``series`` (SERIES, TERMS) and ``state`` (TERMS + 1, 6) are scratch.
    """
    terms, length = coefficients(segment, ends, omega2, load, series), ends[2]
    force = segment[BENDING] * ends[0] ** segment[BENDING_POWER] / length**2
    for column in range(4):
        for i in range(4):
            state[0, i] = 1.0 if i == column else 0.0
        state_series(series, terms, state)
        if column == 1:
            state[1, 0] -= 1.0
        if column == 2:
            state[1, 3] += 1.0
        for i in range(4):
            total = 0.0
            for k in range(TERMS, 0, -1):
                total += state[k, i]
            # From units of the piece: rotations as they are.
            if i == 0 or i == 3:
                total *= length
            if column == 0 or column == 3:
                total /= length
            if i >= 2:
                total *= force
            if column >= 2:
                total /= force
            out[i, column] = total
