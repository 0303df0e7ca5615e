"""Compiled motion of the head of a flexible crane: the turning, tilting frame on top of the tower.

The tower's top moves by u, its bending tilts it by the rotation vector th = (th_x, th_y, 0), its torsion and the
slewing turn the head by Psi about the tilted axis. With Q = exp(th^) the head's axes are the columns of
R = Q Rz(Psi): e1 along the jib, e2 to its left, e3 up. The rotation vector, and not two angles in turn, keeps the
tower equal in all directions; for its rates see Cardona and Geradin (1988), Eq. 2.24-2.30.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import types

from modal.compiled import kernel

ROTATION, TURN_X, TURN_Y, SPIN, SPIN_BIAS, TOP_VELOCITY = 0, 9, 12, 15, 18, 21
"""Where in the head's row: R (9, row by row); what a rate of th_x and of th_y turns (3 each, in the head's axes, as
everything that follows); angular velocity; angular acceleration while all rates are constant; velocity of the top."""

SIZE = 24
"""Entries that :func:`move_head` writes."""

NEARLY_UPRIGHT = 0.0225
"""Squared tilt [rad^2] below which the functions of the tilt are summed as series."""


@kernel()
def tilt_functions(square: float) -> tuple[float, float, float, float, float]:
    """sin f / f, (1 - cos f) / f^2, (f - sin f) / f^3 and, of the last two, the derivatives by f over f.

    Parameters
    ----------
    square : float
        Squared tilt, f^2.
    """
    if square < NEARLY_UPRIGHT:
        c0 = 1.0 - square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0 * (1.0 - square / 72.0)))
        c1 = 0.5 - square / 24.0 * (1.0 - square / 30.0 * (1.0 - square / 56.0 * (1.0 - square / 90.0)))
        c2 = (1.0 - square / 20.0 * (1.0 - square / 42.0 * (1.0 - square / 72.0 * (1.0 - square / 110.0)))) / 6.0
        d1 = (
            -1.0
            + square / 15.0 * (1.0 - 3.0 * square / 112.0 * (1.0 - 2.0 * square / 135.0 * (1.0 - square / 105.6)))
        ) / 12.0
        d2 = (
            -1.0 + square / 21.0 * (1.0 - square / 48.0 * (1.0 - 2.0 * square / 165.0 * (1.0 - square / 124.8)))
        ) / 60.0
        return c0, c1, c2, d1, d2
    f = np.sqrt(square)
    s, c = np.sin(f), np.cos(f)
    c1, c2 = (1.0 - c) / square, (f - s) / (square * f)
    return s / f, c1, c2, (s / f - 2.0 * c1) / square, (c1 - 3.0 * c2) / square


@kernel()
def move_head(
    tx: float,
    ty: float,
    txd: float,
    tyd: float,
    turn: float,
    turning: float,
    acceleration: float,
    ud_x: float,
    ud_y: float,
    work: Any,
    row: int,
) -> None:
    """Write orientation and motion of the head into a row of ``work``.

    Parameters
    ----------
    tx, ty, txd, tyd : float
        Tilt vector and its rate [rad, rad/s].
    turn, turning, acceleration : float
        Psi, its rate, and the part of its second derivative that is prescribed.
    ud_x, ud_y : float
        Velocity of the tower's top [m/s].
    work : ndarray
    row : int
    """
    c0, c1, c2, d1, d2 = tilt_functions(tx * tx + ty * ty)
    c, s = np.cos(turn), np.sin(turn)
    kappa = tx * tyd - ty * txd
    xx, xy, yy = 1.0 - c1 * ty * ty, c1 * tx * ty, 1.0 - c1 * tx * tx
    work[row, ROTATION] = xx * c + xy * s
    work[row, ROTATION + 1] = xy * c - xx * s
    work[row, ROTATION + 2] = c0 * ty
    work[row, ROTATION + 3] = xy * c + yy * s
    work[row, ROTATION + 4] = yy * c - xy * s
    work[row, ROTATION + 5] = -c0 * tx
    work[row, ROTATION + 6] = c0 * (tx * s - ty * c)
    work[row, ROTATION + 7] = c0 * (tx * c + ty * s)
    work[row, ROTATION + 8] = 1.0 - c1 * (tx * tx + ty * ty)

    xx, xy, yy = 1.0 - c2 * ty * ty, c2 * tx * ty, 1.0 - c2 * tx * tx
    work[row, TURN_X] = xx * c + xy * s
    work[row, TURN_X + 1] = xy * c - xx * s
    work[row, TURN_X + 2] = c1 * ty
    work[row, TURN_Y] = xy * c + yy * s
    work[row, TURN_Y + 1] = yy * c - xy * s
    work[row, TURN_Y + 2] = -c1 * tx
    w_x, w_y = txd + c2 * kappa * ty, tyd - c2 * kappa * tx
    work[row, SPIN] = w_x * c + w_y * s
    work[row, SPIN + 1] = w_y * c - w_x * s
    work[row, SPIN + 2] = turning - c1 * kappa
    along = tx * txd + ty * tyd
    bias_x = kappa * (d2 * along * ty + c2 * tyd)
    bias_y = -kappa * (d2 * along * tx + c2 * txd)
    work[row, SPIN_BIAS] = bias_x * c + bias_y * s + turning * work[row, SPIN + 1]
    work[row, SPIN_BIAS + 1] = bias_y * c - bias_x * s - turning * work[row, SPIN]
    work[row, SPIN_BIAS + 2] = acceleration - d1 * along * kappa
    for k in range(3):
        work[row, TOP_VELOCITY + k] = work[row, ROTATION + k] * ud_x + work[row, ROTATION + 3 + k] * ud_y


@kernel(types.void(types.float64[:, ::1], types.float64[:, ::1]))
def move_heads(motions: Any, heads: Any) -> None:
    """:func:`move_head` over time: a row of nine motions, in its order, for each row of ``heads`` (p, SIZE)."""
    for row in range(motions.shape[0]):
        move_head(
            motions[row, 0], motions[row, 1], motions[row, 2], motions[row, 3], motions[row, 4], motions[row, 5],
            motions[row, 6], motions[row, 7], motions[row, 8], heads, row,
        )  # fmt: skip
