"""Dynamic stiffness of a block: from its transfer, and joined to that of the blocks before it."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from modal.compiler.kinds import Table


STIFF = 0.3
"""Largest part of a motion that the flexibility of a block may add where it counts as stiff beside those before."""


def _from_transfer(T: Table, unit: float, length: float, out: Table) -> None:
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


def relative_stiffness(transfer: Table, length: float, T: Table, out: Table) -> None:
    """Dynamic stiffness (4, 4) for (v, theta) at the near end and the far end's departure from it, from a transfer.

    The far end departs from where it would be if the block were rigid. Bending then works on the departure alone, and
    the large stiffness of a short block takes no digits from the motion of the whole. ``T`` (4, 4) is scratch.
    """
    for i in range(4):
        for j in range(4):
            value = transfer[i, j]
            if i == 0 or i == 3:
                value /= length
            if j == 0 or j == 3:
                value *= length
            T[i, j] = value
    _from_transfer(T, 1.0 / length, length, out)


def make_absolute(matrix: Table, length: float) -> None:
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


def _condense(near: Table, piece: Table, recovery: Table, i00: float, i01: float, i11: float) -> None:
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


def negative(a: float, b: float, c: float) -> int:
    """Number of negative eigenvalues of [[a, b], [b, c]]."""
    return 1 if a * c - b * b < 0.0 else (2 if a + c < 0.0 else 0)


def join(near: Table, piece: Table, recovery: Table) -> None:
    """Append a block to a run's stiffness ``near`` (4, 4), in place.

    ``recovery`` (2, 4) takes what gives the node's (v, theta) from those at the near and at the block's far end.
    """
    a = near[2, 2] + piece[0, 0]
    b = near[2, 3] + piece[0, 1]
    c = near[3, 3] + piece[1, 1]
    determinant = a * c - b * b
    if determinant == 0.0:
        # On a fixed-end mode to the last bit: a nearby frequency would do as well.
        a *= 1.0 + 1e-15
        determinant = a * c - b * b
    _condense(near, piece, recovery, c / determinant, -b / determinant, a / determinant)


def extended(total: Table, transfer: Table, length: float, recovery: Table, scratch: Table) -> bool:
    """Append a block that is stiff beside what is before it, in place, see `join`; False where it is not stiff.

    Its large stiffness would drown that of the rest in rounding; its flexibility is a small correction.
    """
    # Far motion and forces d' = A d + B p, p' = C d + D p; before it p = K21 d0 + K22 d, so d' = E d + B K21 d0.
    a, b = scratch[0:2], scratch[2:4]
    for i in range(2):
        for j in range(2):
            a[i, j] = transfer[i, 2] * total[2, 2 + j] + transfer[i, 3] * total[3, 2 + j]
            b[i, j] = transfer[i, 2] * total[2, j] + transfer[i, 3] * total[3, j]
    if max(abs(a[0, 0]), abs(a[0, 1]) / length, abs(a[1, 0]) * length, abs(a[1, 1])) > STIFF:
        return False
    for i in range(2):
        for j in range(2):
            a[i, j] += transfer[i, j] + (1.0 if i == j else 0.0)
    a[0, 1] += length
    determinant = a[0, 0] * a[1, 1] - a[0, 1] * a[1, 0]
    e00, e01 = a[1, 1] / determinant, -a[0, 1] / determinant
    e10, e11 = -a[1, 0] / determinant, a[0, 0] / determinant
    for j in range(2):
        recovery[0, j], recovery[1, j] = -(e00 * b[0, j] + e01 * b[1, j]), -(e10 * b[0, j] + e11 * b[1, j])
    recovery[0, 2], recovery[0, 3], recovery[1, 2], recovery[1, 3] = e00, e01, e10, e11
    # C + D K22, D differing from the identity by the lever arm.
    for j in range(2):
        v, m = total[2, 2 + j], total[3, 2 + j]
        a[0, j] = transfer[2, j] + transfer[2, 2] * v + transfer[2, 3] * m + v
        a[1, j] = transfer[3, j] + transfer[3, 2] * v + transfer[3, 3] * m + m - length * v
    k00, k11 = a[0, 0] * e00 + a[0, 1] * e10, a[1, 0] * e01 + a[1, 1] * e11
    k01 = 0.5 * (a[0, 0] * e01 + a[0, 1] * e11 + a[1, 0] * e00 + a[1, 1] * e10)
    for i in range(2):
        for j in range(2):
            total[i, j] += total[i, 2] * recovery[0, j] + total[i, 3] * recovery[1, j]
    for i in range(2):
        v, m = total[i, 2], total[i, 3]
        total[i, 2], total[i, 3] = v * e00 + m * e10, v * e01 + m * e11
        total[2, i], total[3, i] = total[i, 2], total[i, 3]
    total[2, 2], total[2, 3], total[3, 2], total[3, 3] = k00, k01, k01, k11
    return True
