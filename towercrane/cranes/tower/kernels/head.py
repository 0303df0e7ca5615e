"""Compiled motion of the head of a flexible crane: the turning, tilting frame on top of the tower.

The tower's top moves by u, its bending tilts it by the rotation vector th = (th_x, th_y, 0), its torsion and the
slewing turn the head by Psi about the tilted axis. With Q = exp(th^) the head's axes are the columns of
R = Q Rz(Psi): e1 along the jib, e2 to its left, e3 up. The rotation vector, and not two angles in turn, keeps the
tower equal in all directions; for its rates see Cardona and Geradin (1988), Eq. 2.24-2.30.
"""

from __future__ import annotations

import numpy as np

from modal.compiler.compiled import kernel
from modal.compiler.traced import traced
from towercrane.kernels.choices import below, either

Vector = tuple[float, float, float]

Head = tuple[tuple[float, ...], Vector, Vector, Vector, Vector, Vector]
"""R (9, row by row), then in the head's axes what a rate of th_x and of th_y turns, the angular velocity, the angular
acceleration while all rates are constant, and the velocity of the tower's top."""

NEARLY_UPRIGHT = 0.0225
"""Squared tilt [rad^2] below which the functions of the tilt are summed as series."""


@traced
def upright_functions(square: float) -> tuple[float, float, float, float, float]:
    """:func:`tilt_functions` as series."""
    c0 = 1.0 - square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0 * (1.0 - square / 72.0)))
    c1 = 0.5 - square / 24.0 * (1.0 - square / 30.0 * (1.0 - square / 56.0 * (1.0 - square / 90.0)))
    c2 = (1.0 - square / 20.0 * (1.0 - square / 42.0 * (1.0 - square / 72.0 * (1.0 - square / 110.0)))) / 6.0
    d1 = (
        -1.0 + square / 15.0 * (1.0 - 3.0 * square / 112.0 * (1.0 - 2.0 * square / 135.0 * (1.0 - square / 105.6)))
    ) / 12.0
    d2 = (-1.0 + square / 21.0 * (1.0 - square / 48.0 * (1.0 - 2.0 * square / 165.0 * (1.0 - square / 124.8)))) / 60.0
    return c0, c1, c2, d1, d2


@kernel()
def leaning_functions(square: float) -> tuple[float, float, float, float, float]:
    """:func:`tilt_functions` of a tilt that is not small."""
    f = np.sqrt(square)
    s, c = np.sin(f), np.cos(f)
    far1, far2 = (1.0 - c) / square, (f - s) / (square * f)
    return s / f, far1, far2, (s / f - 2.0 * far1) / square, (far1 - 3.0 * far2) / square


@kernel()
def nearly_upright(square: float) -> float:
    """Whether a squared tilt is small."""
    return below(square, NEARLY_UPRIGHT)


tilt_functions = either(nearly_upright, upright_functions, leaning_functions)
"""Of the squared tilt f^2: sin f / f, (1 - cos f) / f^2, (f - sin f) / f^3 and, of the last two, the derivatives by f
over f."""


@traced
def move_head(
    tilt: tuple[float, float, float, float],
    functions: tuple[float, float, float, float, float],
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
    tilt : tuple of 4 floats
        Tilt vector and its rate [rad, rad/s].
    functions : tuple of 5 floats
        :func:`tilt_functions` of it.
    c, s, turning, acceleration : float
        Cosine and sine of Psi, its rate, and the part of its second derivative that is prescribed.
    ud_x, ud_y : float
        Velocity of the tower's top [m/s].
    """
    tx, ty, txd, tyd = tilt
    c0, c1, c2, d1, d2 = functions
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
