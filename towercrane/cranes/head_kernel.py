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
from towercrane.lane_choices import below, choose, everywhere

Vector = tuple[float, float, float]

Head = tuple[tuple[float, ...], Vector, Vector, Vector, Vector, Vector]
"""R (9, row by row), then in the head's axes what a rate of th_x and of th_y turns, the angular velocity, the angular
acceleration while all rates are constant, and the velocity of the tower's top."""

ROTATION, TURN_X, TURN_Y, SPIN, SPIN_BIAS, TOP_VELOCITY, SIZE = 0, 9, 12, 15, 18, 21, 24
"""Where these begin in a row of :func:`move_heads`, and how many numbers they are."""

NEARLY_UPRIGHT = 0.0225
"""Squared tilt [rad^2] below which the functions of the tilt are summed as series."""


@kernel(inline=True)
def tilt_functions(square: float) -> tuple[float, float, float, float, float]:
    """sin f / f, (1 - cos f) / f^2, (f - sin f) / f^3 and, of the last two, the derivatives by f over f.

    Parameters
    ----------
    square : float
        Squared tilt, f^2.
    """
    near = below(square, NEARLY_UPRIGHT)
    c0 = 1.0 - square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0 * (1.0 - square / 72.0)))
    c1 = 0.5 - square / 24.0 * (1.0 - square / 30.0 * (1.0 - square / 56.0 * (1.0 - square / 90.0)))
    c2 = (1.0 - square / 20.0 * (1.0 - square / 42.0 * (1.0 - square / 72.0 * (1.0 - square / 110.0)))) / 6.0
    d1 = (
        -1.0 + square / 15.0 * (1.0 - 3.0 * square / 112.0 * (1.0 - 2.0 * square / 135.0 * (1.0 - square / 105.6)))
    ) / 12.0
    d2 = (-1.0 + square / 21.0 * (1.0 - square / 48.0 * (1.0 - 2.0 * square / 165.0 * (1.0 - square / 124.8)))) / 60.0
    if everywhere(near):
        return c0, c1, c2, d1, d2
    f = np.sqrt(square)
    s, c = np.sin(f), np.cos(f)
    far1, far2 = (1.0 - c) / square, (f - s) / (square * f)
    e1, e2 = (s / f - 2.0 * far1) / square, (far1 - 3.0 * far2) / square
    return (
        choose(near, c0, s / f),
        choose(near, c1, far1),
        choose(near, c2, far2),
        choose(near, d1, e1),
        choose(near, d2, e2),
    )


@kernel(inline=True)
def move_head(
    tx: float,
    ty: float,
    txd: float,
    tyd: float,
    c: float,
    s: float,
    turning: float,
    acceleration: float,
    ud_x: float,
    ud_y: float,
) -> Head:
    """Orientation and motion of the head.

    Parameters
    ----------
    tx, ty, txd, tyd : float
        Tilt vector and its rate [rad, rad/s].
    c, s, turning, acceleration : float
        Cosine and sine of Psi, its rate, and the part of its second derivative that is prescribed.
    ud_x, ud_y : float
        Velocity of the tower's top [m/s].
    """
    c0, c1, c2, d1, d2 = tilt_functions(tx * tx + ty * ty)
    kappa = tx * tyd - ty * txd
    xx, xy, yy = 1.0 - c1 * ty * ty, c1 * tx * ty, 1.0 - c1 * tx * tx
    r00, r01, r02 = xx * c + xy * s, xy * c - xx * s, c0 * ty
    r10, r11, r12 = xy * c + yy * s, yy * c - xy * s, -c0 * tx
    r20, r21, r22 = c0 * (tx * s - ty * c), c0 * (tx * c + ty * s), 1.0 - c1 * (tx * tx + ty * ty)
    xx, xy, yy = 1.0 - c2 * ty * ty, c2 * tx * ty, 1.0 - c2 * tx * tx
    turn_x = (xx * c + xy * s, xy * c - xx * s, c1 * ty)
    turn_y = (xy * c + yy * s, yy * c - xy * s, -c1 * tx)
    x, y = txd + c2 * kappa * ty, tyd - c2 * kappa * tx
    spin = (x * c + y * s, y * c - x * s, turning - c1 * kappa)
    along = tx * txd + ty * tyd
    x, y = kappa * (d2 * along * ty + c2 * tyd), -kappa * (d2 * along * tx + c2 * txd)
    bias_x, bias_y = x * c + y * s + turning * spin[1], y * c - x * s - turning * spin[0]
    top = (r00 * ud_x + r10 * ud_y, r01 * ud_x + r11 * ud_y, r02 * ud_x + r12 * ud_y)
    rotation = (r00, r01, r02, r10, r11, r12, r20, r21, r22)
    return rotation, turn_x, turn_y, spin, (bias_x, bias_y, acceleration - d1 * along * kappa), top


@kernel(types.void(types.float64[:, ::1], types.float64[:, ::1]))
def move_heads(motions: Any, heads: Any) -> None:
    """:func:`move_head` over time, for each row of ``heads`` (p, SIZE).

    A row of motions holds its nine parameters, Psi instead of cosine and sine.
    """
    for row in range(motions.shape[0]):
        rotation, turn_x, turn_y, spin, bias, top = move_head(
            motions[row, 0], motions[row, 1], motions[row, 2], motions[row, 3], np.cos(motions[row, 4]),
            np.sin(motions[row, 4]), motions[row, 5], motions[row, 6], motions[row, 7], motions[row, 8],
        )  # fmt: skip
        for k in range(9):
            heads[row, ROTATION + k] = rotation[k]
        for k in range(3):
            heads[row, TURN_X + k] = turn_x[k]
            heads[row, TURN_Y + k] = turn_y[k]
            heads[row, SPIN + k] = spin[k]
            heads[row, SPIN_BIAS + k] = bias[k]
            heads[row, TOP_VELOCITY + k] = top[k]
