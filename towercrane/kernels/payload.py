"""The load on its rope: one compiled kernel that every crane shares.

A crane states only its structure without the load: mass matrix, forces, and the motion of the point D that the
rope hangs from. The kernel adds a rope of prescribed length and a point load. The rope's direction is a unit
vector, so there is no angle chart and no singular position; angles are outputs.

Vectors have ``d`` inertial components, the vertical last: (x, z) in a plane, (x, y, z) in space. The state is
``y = (q, n, q', p, work)``: coordinates, unit vector from D to the load, rates, rate of the unit vector, and the
work [J] that inputs and dissipation have put into the crane since the start. An elastic rope adds its stretch e:
``y = (q, e, n, q', e', p, work)``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from modal.checks import check_fields
from modal.compiler.compiled import kernel
from modal.compiler.traced import traced

AIR_DENSITY = 1.225
"""Density of air at 15 degrees Celsius and sea level [kg/m^3] (ISO 2533)."""

SLACK = -1e-6
"""Tension below which a rope is slack [N]: where a whole crane is let fall, rounding decides the sign of none."""

FORCE, VELOCITY, BIAS, ACCELERATION, DIRECTION, HINGE, WIND, ALONG, JACOBIAN = range(9)
"""Rows of the scratch array: forces without the load (n), velocity, bias acceleration and acceleration of D (d),
rope direction (d), hinge force on the load (d), velocity of the air (d), direction seen by the coordinates (n), and
from here on d rows of the Jacobian of D. Scratch starts as zeros, so a crane that writes no WIND stands in still air.
"""

MASS = JACOBIAN + 3
"""First of the n rows of the mass matrix, of which only the lower triangle is used."""


@dataclass(frozen=True, slots=True)
class Load:
    """The load and its rope's losses.

    Parameters
    ----------
    mass : float
        Mass of the load with hook [kg].
    rope_damping : float
        Damping where the rope hangs, a torque per rate of swing [N m s/rad].
    drag_area : float
        Drag coefficient times area [m^2].

    Raises
    ------
    ValueError
        If the mass is not positive or another value is negative.
    """

    mass: float
    rope_damping: float = 0.0
    drag_area: float = 0.0

    def __post_init__(self) -> None:
        check_fields(self, positive=("mass",), not_negative=("rope_damping", "drag_area"))

    def work_scale(self, gravity: float, length: float) -> float:
        """Tolerance of the work per unit of that of swing, by gravity [m/s^2] and a length of the crane [m]; [J].

        Work steers where nothing else does, as where the load hangs while its rope is let out, and where it is worse
        than the balance of energy allows. Without gravity nothing says which work is small: it then steers no step.
        """
        return self.mass * gravity * length or np.inf

    @property
    def drag(self) -> float:
        """Drag force per squared speed, rho C_d A / 2 [kg/m]."""
        return 0.5 * AIR_DENSITY * self.drag_area


def work_shape(coordinates: int) -> tuple[int, int]:
    """Shape of the scratch array of a crane with so many coordinates."""
    return MASS + coordinates, max(coordinates, 3)


@traced
def _sway(k: int, sway: int, along: float, y: Any, work: Any) -> float:
    """Rate of the rope's direction, at right angles to it."""
    return y[sway + k] - along * work[DIRECTION, k]


@traced
def _velocity(k: int, rate: float, length: float, w: float, work: Any) -> float:
    """Velocity of the load."""
    return work[VELOCITY, k] + rate * work[DIRECTION, k] + length * w


@traced
def _through_air(k: int, rate: float, length: float, w: float, work: Any) -> float:
    """Velocity of the load through the air."""
    return work[VELOCITY, k] + rate * work[DIRECTION, k] + length * w - work[WIND, k]


@traced
def _carried(i: int, k: int, j: float, hinged: float, work: Any) -> tuple[float, float]:
    """How a coordinate moves D along the rope, and the hinge's force on it, with one more axis."""
    moved = work[k + JACOBIAN, i]
    return j + moved * work[DIRECTION, k], hinged + moved * work[HINGE, k]


@traced
def _drive(i: int, place: int, j: float, hinged: float, s: float, dy: Any, work: Any) -> None:
    """Force on a coordinate, with what the rope would pull if the structure did not accelerate."""
    work[ALONG, i] = j
    dy[place] = work[FORCE, i] - hinged + j * s


@traced
def _bind(i: int, m: int, carried: float, work: Any) -> None:
    """Add the load's mass to that of two coordinates."""
    work[i + MASS, m] = work[i + MASS, m] + carried * work[ALONG, m]


@kernel()
def hang_load(
    y: Any,
    dy: Any,
    n: int,
    d: int,
    length: float,
    rate: float,
    acceleration: float,
    mass: float,
    gravity: float,
    drag: float,
    hinge: float,
    stiffness: float,
    loss: float,
    work: Any,
) -> float:
    """Solve for all accelerations, given the structure in ``work``, and write dy.

    Parameters
    ----------
    y, dy : ndarray, shape (2 n + 2 d + 1,), or two more with an elastic rope
        State and its derivative; the last entry of dy becomes the power of winch, drag and hinge [W].
    n, d : int
        Coordinates of the structure and axes of space.
    length, rate, acceleration : float
        Length of the unstretched rope and its time derivatives [m, m/s, m/s^2].
    mass, gravity, drag, hinge : float
        Load [kg], gravity [m/s^2], drag per squared speed [kg/m], hinge damping [N m s/rad].
    stiffness, loss : float
        Of an elastic rope [N/m, N s/m], which the state has a stretch of.
    work : ndarray
        FORCE, VELOCITY, BIAS, JACOBIAN and MASS filled by the structure, WIND where there is any; ACCELERATION,
        DIRECTION and HINGE are left for it.

    Returns
    -------
    float
        Rope tension [N].

    Notes
    -----
    With j = J^T n, w the tangential rate and s the rope force if the structure did not accelerate,
    (M + m j j^T) q'' = f - J^T H + j s and T = s - m j.q''. The matrix is symmetric positive definite whenever M
    is, so one Cholesky factor serves, and nothing divides by the load's mass but its own acceleration. An elastic
    rope pulls with k e + c e' whatever the structure does: then nothing of the load is in the matrix, and the stretch
    has an equation of its own."""
    rates = (y.size - 1) // 2
    elastic = rates > n + d
    direction, sway = n, rates + n
    winding = rate
    bound = mass
    if elastic:
        bound = 0.0
        length += y[n]
        rate += y[rates + n]
        direction += 1
        sway += 1
    norm, along = 0.0, 0.0
    for k in range(d):
        norm += y[direction + k] * y[direction + k]
    norm = np.sqrt(norm)
    for k in range(d):
        work[DIRECTION, k] = y[direction + k] / norm
        along += work[DIRECTION, k] * y[sway + k]
    ww, speed, outward = 0.0, 0.0, 0.0
    for k in range(d):
        w = _sway(k, sway, along, y, work)
        ww += w * w
        v = _through_air(k, rate, length, w, work)
        speed += v * v
    speed = np.sqrt(speed)
    power = -hinge * ww
    s = mass * (length * ww - acceleration - gravity * work[DIRECTION, d - 1])
    if elastic:
        s = stiffness * y[n] + loss * y[rates + n]
        power -= loss * y[rates + n] * y[rates + n]
    for k in range(d):
        w = _sway(k, sway, along, y, work)
        air = -drag * speed * _through_air(k, rate, length, w, work)
        power += air * _velocity(k, rate, length, w, work)
        work[HINGE, k] = -hinge / length * w
        if not elastic:
            s += work[DIRECTION, k] * (air - mass * work[BIAS, k])

    for i in range(n):
        j = 0.0
        hinged = 0.0
        for k in range(d):
            j, hinged = _carried(i, k, j, hinged, work)
        _drive(i, rates + i, j, hinged, s, dy, work)
        for m in range(i + 1):
            _bind(i, m, bound * j, work)
    _solve(work, dy, n, rates)

    tension = s
    for i in range(n):
        tension -= bound * work[ALONG, i] * dy[rates + i]
        dy[i] = y[rates + i]
    for k in range(d):
        a = work[BIAS, k]
        for i in range(n):
            a += work[JACOBIAN + k, i] * dy[rates + i]
        work[ACCELERATION, k] = a
    for k in range(d):
        w = _sway(k, sway, along, y, work)
        air = -drag * speed * _through_air(k, rate, length, w, work)
        b = work[ACCELERATION, k] - (air + work[HINGE, k]) / mass
        if k == d - 1:
            b += gravity
        dy[sway + k] = b
        outward += b * work[DIRECTION, k]
    for k in range(d):
        w = _sway(k, sway, along, y, work)
        across = dy[sway + k] - outward * work[DIRECTION, k] + 2.0 * rate * w
        dy[sway + k] = -ww * work[DIRECTION, k] - across / length
        dy[direction + k] = y[sway + k]
    if elastic:
        dy[n] = y[rates + n]
        dy[rates + n] = length * ww - outward - tension / mass - acceleration
    dy[y.size - 1] = power - tension * winding
    return tension


@traced
def _less(value: float, i: int, j: int, m: int, work: Any) -> float:
    """Without the part of column m in the product of two rows of the factor."""
    return value - work[i + MASS, m] * work[j + MASS, m]


@kernel(inline=True)
def _solve(work: Any, x: Any, n: int, first: int) -> None:
    """Solve M x = b in place by Cholesky; b and x are n entries of x from ``first``, M is overwritten."""
    for i in range(n):
        for j in range(i):
            value = work[MASS + i, j]
            for m in range(j):
                value = _less(value, i, j, m, work)
            work[MASS + i, j] = value * work[MASS + j, j]
        value = work[MASS + i, i]
        for m in range(i):
            value = _less(value, i, i, m, work)
        # The inverse of the diagonal is stored: each entry is divided by once and multiplied by often.
        work[MASS + i, i] = 1.0 / np.sqrt(value)
        value = x[first + i]
        for m in range(i):
            value -= work[MASS + i, m] * x[first + m]
        x[first + i] = value * work[MASS + i, i]
    for i in range(n - 1, -1, -1):
        value = x[first + i]
        for m in range(i + 1, n):
            value -= work[MASS + m, i] * x[first + m]
        x[first + i] = value * work[MASS + i, i]
