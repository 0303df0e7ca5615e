"""Motion of the head of a flexible crane: the turning, tilting frame on top of the tower.

The tower's top moves by u, its bending tilts it by the rotation vector th = (th_x, th_y, 0), its torsion and the
slewing turn the head by Psi about the tilted axis. With Q = exp(th^) the head's axes are the columns of
R = Q Rz(Psi): e1 along the jib, e2 to its left, e3 up. The rotation vector, and not two angles in turn, keeps the
tower equal in all directions; for its rates see Cardona and Geradin (1988), Eq. 2.24-2.30.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from towercrane.cranes.tower.equations.constants import SLEWING, TILT_X
from towercrane.kernels.algebra import Vector, dot
from towercrane.kernels.choices import below, either

if TYPE_CHECKING:
    from towercrane.cranes.tower.equations.constants import Constants, Drives
    from towercrane.kernels.payload import State

NEARLY_UPRIGHT = 0.0225
"""Squared tilt [rad^2] below which the functions of the tilt are summed as series."""


class Head(NamedTuple):
    """Orientation and motion of the head, all but ``rotation`` in its own axes.

    Parameters
    ----------
    rotation : tuple of 9
        R, row by row.
    turn_x, turn_y : tuple of 3
        What a rate of th_x and of th_y turns.
    spin, spin_bias : tuple of 3
        Angular velocity, and angular acceleration while all rates are constant.
    top : tuple of 3
        Velocity of the tower's top.
    """

    rotation: tuple[Any, ...]
    turn_x: Vector
    turn_y: Vector
    spin: Vector
    spin_bias: Vector
    top: Vector

    @property
    def rows(self) -> tuple[Vector, Vector, Vector]:
        """Rows of R: the fixed axes x, y, z in the head's."""
        r = self.rotation
        return (r[0], r[1], r[2]), (r[3], r[4], r[5]), (r[6], r[7], r[8])

    def to_head(self, vector: Vector) -> Vector:
        """A vector along the fixed axes in the head's."""
        x, y, z = (self.rotation[axis::3] for axis in range(3))
        return dot(x, vector), dot(y, vector), dot(z, vector)

    def to_fixed(self, vector: Vector) -> Vector:
        """A vector given in the head's axes along the fixed ones."""
        x, y, z = self.rows
        return dot(x, vector), dot(y, vector), dot(z, vector)


def upright_functions(square: Any) -> tuple[Any, Any, Any, Any, Any]:
    """:func:`tilt_functions` as series."""
    c0 = 1.0 - square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0 * (1.0 - square / 72.0)))
    c1 = 0.5 - square / 24.0 * (1.0 - square / 30.0 * (1.0 - square / 56.0 * (1.0 - square / 90.0)))
    c2 = (1.0 - square / 20.0 * (1.0 - square / 42.0 * (1.0 - square / 72.0 * (1.0 - square / 110.0)))) / 6.0
    d1 = (
        -1.0 + square / 15.0 * (1.0 - 3.0 * square / 112.0 * (1.0 - 2.0 * square / 135.0 * (1.0 - square / 105.6)))
    ) / 12.0
    d2 = (-1.0 + square / 21.0 * (1.0 - square / 48.0 * (1.0 - 2.0 * square / 165.0 * (1.0 - square / 124.8)))) / 60.0
    return c0, c1, c2, d1, d2


def leaning_functions(square: Any) -> tuple[Any, Any, Any, Any, Any]:
    """:func:`tilt_functions` of a tilt that is not small."""
    f = np.sqrt(square)
    s, c = np.sin(f), np.cos(f)
    far1, far2 = (1.0 - c) / square, (f - s) / (square * f)
    return s / f, far1, far2, (s / f - 2.0 * far1) / square, (far1 - 3.0 * far2) / square


def tilt_functions(square: Any) -> tuple[Any, ...]:
    """Of the squared tilt f^2: sin f / f, (1 - cos f) / f^2, (f - sin f) / f^3; of the last two, the derivatives by f
    over f."""
    return either(below(square, NEARLY_UPRIGHT), upright_functions, leaning_functions, square)


def move_head(
    tilt: tuple[Any, Any, Any, Any], c: Any, s: Any, turning: Any, acceleration: Any, ud_x: Any, ud_y: Any
) -> Head:
    """Orientation and motion of the head.

    Parameters
    ----------
    tilt : tuple of 4
        Tilt vector and its rate [rad, rad/s].
    c, s, turning, acceleration
        Cosine and sine of Psi, its rate, and the part of its second derivative that is prescribed.
    ud_x, ud_y
        Velocity of the tower's top [m/s].
    """
    tx, ty, txd, tyd = tilt
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
    return Head(rotation, turn_x, turn_y, spin, (bias_x, bias_y, acceleration - d1 * along * kappa), top)


def head_of(crane: Constants, state: State, drives: Drives) -> tuple[Head, Any]:
    """Head as the coordinates of tower and slewing move it, and its tilt [rad]."""
    movers = crane.movers
    q, qd = state.coordinates[:movers], state.rates[:movers]
    tx, ty, turn = (dot(row[:movers], q) for row in crane.motions[TILT_X:])
    ux, uy, txd, tyd, turning = (dot(row[:movers], qd) for row in crane.motions)
    acceleration: Any = 0.0
    if crane.slewing == "prescribed":
        angle, rate, acceleration = drives[SLEWING]
        turn, turning = turn + angle, turning + rate
    # What cannot turn stands along x.
    c, s = (np.cos(turn), np.sin(turn)) if crane.turns else (1.0, 0.0)
    return move_head((tx, ty, txd, tyd), c, s, turning, acceleration, ux, uy), np.sqrt(tx * tx + ty * ty)
