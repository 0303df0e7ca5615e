"""What the near end of a short piece of a beam does to its far end, exact but for rounding.

The state (v, theta, V, M), deflection, section rotation, transverse force and moment, obeys with compression P

    v' = a theta + b (V + g M),  theta' = M / EI + g (v' - theta),  V' = -m w^2 v,  M' = -V - P v' - rho I w^2 theta

with a = 1 + P/S, b = 1/S (Haringx) or a = 1/(1 - P/S), b = a/S (Engesser). Inclined chords at the breadth B, which
carry a part of the shear, have g = B'/B, parallel diagonals a g of their own; all else has g = 0. Mass m on a
flexibility c of its own counts for m = m / (1 - c m w^2). A segment is cut into pieces so short that none with its
ends held can vibrate or buckle at the frequency asked for, and each is solved by the Taylor series of its state,
whatever the change of section and compression along it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from modal.structures.kernels.cut import (
    BENDING,
    BENDING_POWER,
    COMPRESSION,
    COUPLING,
    ENGESSER,
    INCLINED,
    MASS,
    MASS_FLEXIBILITY,
    MASS_POWER,
    ROTARY,
    SHEAR_FLEXIBILITY,
    SHEAR_POWER,
    WEIGHT,
    mass_beyond,
)

if TYPE_CHECKING:
    from modal.compiler.kinds import Four, Row, Table

TERMS = 22
"""Terms of the Taylor series: with the pieces cut as below, what is left out is rounding, 1e-16 of a stiffness."""

NOTHING = 1e-20
"""Part of the smallest entry of a transfer beyond rigid motion that a term must have to count; four rows without any
end the series of a uniform piece, in which each row is made of the two before it."""

SERIES = 9
"""Rows of the scratch array of `coefficients`."""


def _power_series(value: float, change: float, power: float, out: Row, terms: int) -> None:
    """Coefficients of value (1 + change s)^power in s."""
    out[0] = value
    for i in range(1, terms):
        out[i] = out[i - 1] * change * (power - i + 1.0) / i


def coefficients(segment: Row, ends: Four, omega2: float, load: float, out: Table) -> int:
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
    out[SERIES - 1, 0] += segment[COUPLING] * length
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


def state_series(series: Table, terms: int, state: Table) -> int:
    """Taylor coefficients of (v, theta, V, M) along a piece of unit length; the last row that counts.

    ``state[0]`` holds the start.

    Parameters
    ----------
    series : ndarray, shape (SERIES, TERMS)
        From `coefficients`.
    terms : int
        How many of them are not zero.
    state : ndarray, shape (TERMS + 1, 6)
        Row k is the coefficient of s^k; after the four, v' and V + g M.
    """
    # At the start two parts of it may cancel.
    inclined = series[SERIES - 1, 0] != 0.0 or series[SERIES - 1, 1] != 0.0
    # Inertia has a part in every entry, if there is any.
    unit = series[0, 0] if series[0, 0] != 0.0 else abs(series[4, 0]) + series[5, 0]
    start = max(abs(state[0, 0]), abs(state[0, 1]), abs(state[0, 2]), abs(state[0, 3]))
    negligible, idle, count = NOTHING * unit * start, 0, TERMS
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
        largest = max(abs(dv), abs(dtheta), abs(dforce), abs(dmoment))
        idle = idle + 1 if terms == 2 and largest <= negligible else 0
        if idle == 4:
            count = k + 1
            break
    for k in range(count, TERMS + 1):
        for i in range(6):
            if k > count or i >= 4:
                state[k, i] = 0.0
    return count


def piece_transfer(
    segment: Row, ends: Four, omega2: float, load: float, series: Table, state: Table, out: Table
) -> None:
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
        count = state_series(series, terms, state)
        if column == 1:
            state[1, 0] -= 1.0
        if column == 2:
            state[1, 3] += 1.0
        for i in range(4):
            total = 0.0
            for k in range(count, 0, -1):
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
