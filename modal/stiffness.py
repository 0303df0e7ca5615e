"""Dynamic stiffness of a beam segment between its two ends, exact but for rounding, and its count of fixed-end modes.

The state (v, theta, V, M), deflection, section rotation, transverse force and moment, obeys with compression P

    v' = a theta + b V,   theta' = M / EI,   V' = -m w^2 v,   M' = -V - P v' - rho I w^2 theta

with a = 1 + P/S, b = 1/S (Haringx) or a = 1/(1 - P/S), b = a/S (Engesser). The segment is cut into pieces so short
that no piece with its ends held can vibrate or buckle at the frequency asked for, each piece is solved by the Taylor
series of its state, whatever the change of section and compression along it, and the pieces are joined by condensing
the node between them. Joining keeps the count of Wittrick and Williams (1971): a negative eigenvalue of the condensed
node is one more fixed-end mode below the frequency. So neither the count of a closed form with its blind spots at
simply supported frequencies nor growing exponentials appear anywhere.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from modal.compiled import kernel
from modal.traced import traced

(LENGTH, MASS, BENDING, SHEAR_FLEXIBILITY, ROTARY, RATIO, MASS_POWER, BENDING_POWER, SHEAR_POWER,
 COMPRESSION, WEIGHT, ENGESSER, SHORT) = range(13)  # fmt: skip
"""Properties of a segment, those of the section at its near end. COMPRESSION is that at the near end, of which WEIGHT
times the mass passed is taken away along the segment; both are multiplied by the load factor. SHORT says that the far
end's unknowns are its departure from where the near end would move it if the segment were rigid."""

TERMS = 22
"""Terms of the Taylor series: with the pieces cut as below, what is left out is rounding, 1e-16 of a stiffness."""

REACH = 3.0
"""Largest square of a piece's length in waves [rad^2]; all bounds of `pieces_within` together then stay below one."""

JOINT_REACH = 3.6
"""The same for the wave number that all effects give together, on which the series' convergence hangs [rad^2]."""

TAPER = 0.1
"""Change of breadth over one piece, relative; up to one and a half times as much in the last of a segment."""

LEAST_SHEAR = 1e-4
"""Part of the shear stiffness that compression must leave (Engesser); with less a segment counts as unstable: the
number of pieces grows without bound towards none."""


@kernel()
def mass_passed(segment: Any, distance: float) -> float:
    """Mass between the near end and a distance from it."""
    slope = (segment[RATIO] - 1.0) / segment[LENGTH]
    if slope == 0.0 or segment[MASS_POWER] == 0.0:
        return float(segment[MASS] * distance)
    power = segment[MASS_POWER] + 1.0
    return float(segment[MASS] * ((1.0 + slope * distance) ** power - 1.0) / (slope * power))


@kernel()
def pieces_within(segment: Any, near: float, far: float, omega2: float, load: float) -> int:
    """Number of equal pieces between two distances, short enough to have no fixed-end mode; 0: unstable in shear.

    With fixed ends, ``int theta^2 <= (h/pi)^2 int theta'^2`` and the same for v; the bounds below then leave the
    energy of every motion positive, and the Taylor series converge fast.
    """
    slope = (segment[RATIO] - 1.0) / segment[LENGTH]
    low, high = 1.0 + slope * near, 1.0 + slope * far
    wide, thin = max(low, high), min(low, high)
    bending = segment[BENDING] * thin ** segment[BENDING_POWER]
    mass = segment[MASS] * wide ** segment[MASS_POWER]
    flexibility = segment[SHEAR_FLEXIBILITY] / thin ** segment[SHEAR_POWER]
    rotary = segment[ROTARY] * wide ** segment[BENDING_POWER]
    force, least = 0.0, 1.0
    for i in range(3):
        z = near + 0.5 * i * (far - near)
        compression = load * (segment[COMPRESSION] - segment[WEIGHT] * mass_passed(segment, z))
        force = max(force, abs(compression))
        left = 1.0 - compression * segment[SHEAR_FLEXIBILITY] / (1.0 + slope * z) ** segment[SHEAR_POWER]
        least = min(least, left)
    pieces = 0.0
    if segment[ENGESSER] != 0.0:
        if least < LEAST_SHEAR:
            return 0
        flexibility /= least
        # 1 / (1 - P/S) must vary little along a piece as well.
        change = abs(load) * segment[WEIGHT] * mass * (far - near) * segment[SHEAR_FLEXIBILITY]
        pieces = change / thin ** segment[SHEAR_POWER] / (least * TAPER)
    squared = np.sqrt(omega2 * mass / bending)
    squared = max(squared, (force + 2.0 * force * force * flexibility) / bending)
    squared = max(squared, 2.0 * omega2 * mass * flexibility)
    squared = max(squared, omega2 * rotary / bending)
    # Largest square of a wave number that mass, force, shear and rotary inertia give together.
    stretch = 1.0 + force * flexibility
    half = 0.5 * ((force * stretch + omega2 * rotary) / bending + omega2 * mass * flexibility)
    waves = half + np.sqrt(half * half + omega2 * mass / bending * (stretch + omega2 * rotary * flexibility))
    squared = max(squared, waves * REACH / JOINT_REACH)
    return 1 + int(max(pieces, (far - near) * np.sqrt(squared / REACH)))


@kernel()
def cell_end(segment: Any, near: float) -> float:
    """Far end of the cell that starts at a distance: breadth changes by about `TAPER` in it.

    What is left of a segment is never a sliver, whose stiffness would drown all else in rounding errors.
    """
    slope = (segment[RATIO] - 1.0) / segment[LENGTH]
    if slope == 0.0:
        return float(segment[LENGTH])
    far = near + TAPER * (1.0 + slope * near) / abs(slope)
    return float(segment[LENGTH] if far + 0.5 * (far - near) > segment[LENGTH] else far)


@kernel()
def _power_series(value: float, relative_slope: float, power: float, out: Any, terms: int) -> None:
    """Coefficients of value (1 + relative_slope s)^power in s."""
    out[0] = value
    for i in range(1, terms):
        out[i] = out[i - 1] * relative_slope * (power - i + 1.0) / i


@kernel()
def coefficients(segment: Any, start: float, length: float, omega2: float, load: float, out: Any) -> int:
    """Series of m w^2, 1/EI, a, b, P and rho I w^2 along a piece, in the units of the piece; their number of terms.

    Lengths are counted in the piece's length h and forces in EI/h^2 at its start.
    """
    slope = (segment[RATIO] - 1.0) / segment[LENGTH]
    breadth = 1.0 + slope * start
    bending = segment[BENDING] * breadth ** segment[BENDING_POWER]
    mass = segment[MASS] * breadth ** segment[MASS_POWER]
    flexibility = segment[SHEAR_FLEXIBILITY] / breadth ** segment[SHEAR_POWER]
    rotary = segment[ROTARY] * breadth ** segment[BENDING_POWER]
    force = load * (segment[COMPRESSION] - segment[WEIGHT] * mass_passed(segment, start)) * length**2 / bending
    weight = load * segment[WEIGHT] * mass * length**3 / bending
    flexibility *= bending / length**2
    change = slope * length / breadth

    terms = TERMS if slope != 0.0 or (segment[ENGESSER] != 0.0 and weight * flexibility != 0.0) else 2
    for row in range(6):
        for i in range(terms):
            out[row, i] = 0.0
    out[0, 0], out[1, 0], out[3, 0], out[5, 0] = mass, 1.0, flexibility, rotary
    if slope != 0.0:
        _power_series(mass, change, segment[MASS_POWER], out[0], terms)
        _power_series(1.0, change, -segment[BENDING_POWER], out[1], terms)
        _power_series(flexibility, change, -segment[SHEAR_POWER], out[3], terms)
        _power_series(rotary, change, segment[BENDING_POWER], out[5], terms)
    out[4, 0] = force
    for i in range(1, terms):
        out[4, i] = -weight * out[0, i - 1] / (mass * i)
    for i in range(terms):
        out[0, i] *= omega2 * length**4 / bending
        out[5, i] *= omega2 * length**2 / bending
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
    series : ndarray, shape (8, TERMS)
        From `coefficients`.
    terms : int
        How many of them are not zero.
    state : ndarray, shape (TERMS + 1, 5)
        Row k is the coefficient of s^k; the last column is v'.
    """
    for k in range(TERMS):
        last = min(k, terms - 1)
        dv, dtheta, dforce, dmoment = 0.0, 0.0, 0.0, -state[k, 2]
        for i in range(last + 1):
            dv += series[2, i] * state[k - i, 1] + series[3, i] * state[k - i, 2]
            dtheta += series[1, i] * state[k - i, 3]
            dforce -= series[0, i] * state[k - i, 0]
            dmoment -= series[5, i] * state[k - i, 1]
        state[k, 4] = dv
        for i in range(last + 1):
            dmoment -= series[4, i] * state[k - i, 4]
        state[k + 1, 0], state[k + 1, 1] = dv / (k + 1), dtheta / (k + 1)
        state[k + 1, 2], state[k + 1, 3] = dforce / (k + 1), dmoment / (k + 1)
    state[TERMS, 4] = 0.0


@traced
def _from_transfer(T: Any, unit: float, length: float, out: Any) -> None:
    """Stiffness for near end and departure into ``out``, from what the near state gives at the far end, ``T``."""
    # Departure d' = E d + F p, far forces p' = G d + (R^-T + H) p with the near motion d and the near forces p; R
    # moves the far end rigidly. F is the block above right, inverted here.
    determinant = T[0, 2] * T[1, 3] - T[0, 3] * T[1, 2]
    i00, i01 = T[1, 3] / determinant, -T[0, 3] / determinant
    i10, i11 = -T[1, 2] / determinant, T[0, 2] / determinant
    # R^T H and R^T G, R = [[1, 1], [0, 1]] in lengths of the piece.
    h00, h01 = T[2, 2], T[2, 3]
    h10, h11 = T[2, 2] + T[3, 2], T[2, 3] + T[3, 3]
    g00, g01 = T[2, 0], T[2, 1]
    g11 = T[2, 1] + T[3, 1]
    # Near, with departure: R^T H F^-1.
    out[0, 2], out[0, 3] = h00 * i00 + h01 * i10, h00 * i01 + h01 * i11
    out[1, 2], out[1, 3] = h10 * i00 + h11 * i10, h10 * i01 + h11 * i11
    out[0, 0] = g00 - out[0, 2] * T[0, 0] - out[0, 3] * T[1, 0]
    out[0, 1] = g01 - out[0, 2] * T[0, 1] - out[0, 3] * T[1, 1]
    out[1, 1] = g11 - out[1, 2] * T[0, 1] - out[1, 3] * T[1, 1]
    # Departure: (R^-T + H) F^-1, R^-T = [[1, 0], [-1, 1]].
    out[2, 2] = (1.0 + T[2, 2]) * i00 + T[2, 3] * i10
    out[2, 3] = (1.0 + T[2, 2]) * i01 + T[2, 3] * i11
    out[3, 3] = (T[3, 2] - 1.0) * i01 + (1.0 + T[3, 3]) * i11
    for i in range(4):
        for j in range(i, 4):
            value = out[i, j] * unit
            if i % 2 == 1:
                value = value * length
            if j % 2 == 1:
                value = value * length
            out[i, j] = value
            out[j, i] = value


@kernel()
def relative_stiffness(
    segment: Any, start: float, length: float, omega2: float, load: float, series: Any, state: Any, T: Any, out: Any
) -> None:
    """Dynamic stiffness (4, 4) of one piece for (v, theta) at its near end and the far end's departure from it.

    The far end departs from where it would be if the piece were rigid. Bending then works on the departure alone, and
    the large stiffness of a short piece takes no digits from the motion of the whole.

    ``series`` (8, TERMS), ``state`` (TERMS + 1, 5) and ``T`` (4, 4) are scratch.
    """
    terms = coefficients(segment, start, length, omega2, load, series)
    # Columns: what a unit of v, theta, V, M at the near end gives at the far end beyond rigid motion and equilibrium.
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
            T[i, column] = total
    slope = (segment[RATIO] - 1.0) / segment[LENGTH]
    bending = segment[BENDING] * (1.0 + slope * start) ** segment[BENDING_POWER]
    _from_transfer(T, bending / length**3, length, out)


@traced
def make_absolute(matrix: Any, length: float) -> None:
    """Turn a relative stiffness (4, 4) into that for (v, theta) at both ends, in place."""
    a, b, c = matrix[2, 2], matrix[2, 3], matrix[3, 3]
    # R^T C, then near with far B - R^T C, then near A - B R - R^T B^T + R^T C R.
    rows = (a, b, length * a + b, length * b + c)
    b00, b01, b10, b11 = matrix[0, 2], matrix[0, 3], matrix[1, 2], matrix[1, 3]
    matrix[0, 0] = matrix[0, 0] + rows[0] - 2.0 * b00
    matrix[0, 1] = matrix[0, 1] + (rows[0] * length + rows[1] - b00 * length - b01 - b10)
    matrix[1, 1] = matrix[1, 1] + (rows[2] * length + rows[3] - 2.0 * (b10 * length + b11))
    matrix[0, 2], matrix[0, 3] = b00 - rows[0], b01 - rows[1]
    matrix[1, 2], matrix[1, 3] = b10 - rows[2], b11 - rows[3]
    for i in range(4):
        for j in range(i):
            matrix[i, j] = matrix[j, i]


@traced
def _condense(near: Any, piece: Any, recovery: Any, i00: float, i01: float, i11: float) -> None:
    """Take the node between out, of whose stiffness this is the inverse."""
    for j in range(2):
        recovery[0, j] = -(i00 * near[2, j] + i01 * near[3, j])
        recovery[1, j] = -(i01 * near[2, j] + i11 * near[3, j])
        recovery[0, 2 + j] = -(i00 * piece[0, 2 + j] + i01 * piece[1, 2 + j])
        recovery[1, 2 + j] = -(i01 * piece[0, 2 + j] + i11 * piece[1, 2 + j])
    for i in range(2):
        for j in range(2):
            near[i, j] = near[i, j] + (near[i, 2] * recovery[0, j] + near[i, 3] * recovery[1, j])
    for i in range(2):
        deflection, rotation = near[i, 2], near[i, 3]
        for j in range(2, 4):
            near[i, j] = deflection * recovery[0, j] + rotation * recovery[1, j]
            near[j, i] = near[i, j]
            near[2 + i, j] = piece[2 + i, j] + piece[2 + i, 0] * recovery[0, j] + piece[2 + i, 1] * recovery[1, j]


@kernel()
def join(near: Any, piece: Any, recovery: Any) -> int:
    """Append a piece to a segment's stiffness ``near`` (4, 4), in place; negative eigenvalues of the node between.

    ``recovery`` (2, 4) takes what gives the node's (v, theta) from those at the near and at the piece's far end.
    """
    a = near[2, 2] + piece[0, 0]
    b = near[2, 3] + piece[0, 1]
    c = near[3, 3] + piece[1, 1]
    determinant = a * c - b * b
    if determinant == 0.0:
        # On a fixed-end mode to the last bit: a nearby frequency would do as well.
        a *= 1.0 + 1e-15
        determinant = a * c - b * b
    negative = 1 if determinant < 0.0 else (2 if a + c < 0.0 else 0)
    _condense(near, piece, recovery, c / determinant, -b / determinant, a / determinant)
    return negative
