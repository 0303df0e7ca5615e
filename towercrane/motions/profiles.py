"""Motions of a shape: trapezoids and smooth ramps of speed, ways with limited jerk, and motions through points."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from modal.checks import check_not_negative, check_positive, number_in
from towercrane.motions.motion import Motion, rest

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]

SHORTEST_WAY = 1e-12
"""Ways shorter than this [m] are none."""

LIKE = 5
"""Neighbouring points whose curvatures are alike where a motion is sampled finely."""


def trapezoid(start: float, end: float, speed: float, acceleration: float) -> Motion:
    """Constant acceleration, constant speed, constant deceleration; a triangle where the way is short.

    Parameters
    ----------
    start, end : float
        First and last value [m].
    speed, acceleration : float
        Largest rate [m/s] and acceleration [m/s^2], both positive.
    """
    return _ramped(start, end, speed, acceleration, float("inf"))


def s_curve(start: float, end: float, speed: float, acceleration: float, jerk: float) -> Motion:
    """Motion with limited jerk: seven pieces of constant jerk, fewer where a limit is not reached.

    Parameters
    ----------
    start, end : float
        First and last value [m].
    speed, acceleration, jerk : float
        Largest rate [m/s], acceleration [m/s^2] and jerk [m/s^3], all positive.
    """
    check_positive("jerk", jerk)
    return _ramped(start, end, speed, acceleration, jerk)


def speed_trapezoid(
    start: float, speed: float, ramp: float, hold: float, start_speed: float = 0.0, end_speed: float = 0.0
) -> Motion:
    """Speed that rises linearly, holds and falls linearly; from rest to rest the way is speed (ramp + hold).

    Parameters
    ----------
    start : float
        First value [m or rad].
    speed : float
        Speed while it holds [m/s or rad/s]; its sign is the direction.
    ramp, hold : float
        Time of each ramp, positive, and time between them, zero or more [s].
    start_speed, end_speed : float
        Speed before the first ramp, and after the last, at which the motion goes on [m/s or rad/s].
    """
    return _speed_ramps(start, (start_speed, speed, end_speed), ramp, hold, (0.0, 0.0, 0.5))


def smooth_ramps(
    start: float, speed: float, ramp: float, hold: float, start_speed: float = 0.0, end_speed: float = 0.0
) -> Motion:
    """Speed that rises and falls as 10 x^3 - 15 x^4 + 6 x^5, with x from 0 to 1 over each ramp.

    Acceleration and jerk are continuous; from rest to rest the way is speed (ramp + hold).

    Parameters
    ----------
    start : float
        First value [m or rad].
    speed : float
        Speed while it holds [m/s or rad/s]; its sign is the direction.
    ramp, hold : float
        Time of each ramp, positive, and time between them, zero or more [s].
    start_speed, end_speed : float
        Speed before the first ramp, and after the last, at which the motion goes on [m/s or rad/s].
    """
    return _speed_ramps(start, (start_speed, speed, end_speed), ramp, hold, (0.0, 0.0, 0.0, 0.0, 2.5, -3.0, 1.0))


def table(times: ArrayLike, values: ArrayLike, start_speed: float = 0.0, end_speed: float = 0.0) -> Motion:
    """Motion through points that keeps their shape: from rest to rest it never leaves the points' range.

    It is the cubic spline with continuous acceleration where that stays between neighbouring points. Elsewhere its
    slopes are limited, and the acceleration jumps at the point; the solver restarts at each.

    Parameters
    ----------
    times : array_like, shape (p,)
        Increasing times from 0 [s].
    values : array_like, shape (p,)
        Values at those times.
    start_speed, end_speed : float
        Rates at the first point, and at the last, with which the motion goes on.

    Notes
    -----
    Limits of Hyman 1983, Accurate monotonicity preserving cubic interpolation, SIAM J. Sci. Stat. Comput. 4: a slope
    of the sign of the secants beside it, at most three times the smaller; zero where they differ in sign. A turn that
    is sampled finely, with like curvature over five points, keeps the spline's: a zero slope at the highest of its
    points would double the acceleration there.
    """
    from scipy.interpolate import CubicHermiteSpline, CubicSpline

    t, x = np.asarray(times, dtype=float), np.asarray(values, dtype=float)
    if t.ndim != 1 or t.shape != x.shape or len(t) < 2:
        raise ValueError(f"table: wanted two or more times and as many values, got {t.shape} and {x.shape}")
    if t[0] != 0.0 or np.any(np.diff(t) <= 0.0):
        raise ValueError("table: wanted times that start at 0 and increase")
    number_in("start_speed", start_speed, "a finite number")
    number_in("end_speed", end_speed, "a finite number")
    slopes = np.array(CubicSpline(t, x, bc_type=((1, start_speed), (1, end_speed)))(t, 1))
    secants = np.diff(x) / np.diff(t)
    before, after, sense = secants[:-1], secants[1:], np.sign(secants[:-1])
    steepest = np.where(before * after > 0.0, 3.0 * np.minimum(abs(before), abs(after)), 0.0)
    limited = sense * np.clip(sense * slopes[1:-1], 0.0, steepest)
    slopes[1:-1] = np.where(_turns_smoothly(t, before, after), slopes[1:-1], limited)
    slopes[[0, -1]] = start_speed, end_speed
    return Motion(t, np.ascontiguousarray(CubicHermiteSpline(t, x, slopes).c[::-1].T), end_speed)


def _turns_smoothly(t: Floats, before: Floats, after: Floats) -> NDArray[np.bool_]:
    """Whether the curvature at each inner point and two to either side has one sign and about one size."""
    curvature = (after - before) / (t[2:] - t[:-2])
    smooth = np.zeros(len(curvature), dtype=bool)
    if len(curvature) >= LIKE:
        near = np.lib.stride_tricks.sliding_window_view(curvature, LIKE)
        signed = near * np.sign(near[:, :1])
        smooth[LIKE // 2 : len(smooth) - LIKE // 2] = signed.max(axis=1) < 2.0 * signed.min(axis=1)
    return smooth


# Limits so far from each other that numbers overflow make times that are not finite, which a motion refuses.
@np.errstate(all="ignore")
def _ramped(start: float, end: float, speed: float, acceleration: float, jerk: float) -> Motion:
    number_in("start", start, "a finite number")
    number_in("end", end, "a finite number")
    check_positive("speed", speed)
    check_positive("acceleration", acceleration)
    way = abs(end - start)
    if way < SHORTEST_WAY:
        return rest(end)
    a, j = acceleration, jerk
    if way < speed * _ramp_time(speed, a, j):
        # Without a cruise: the peak speed v solves v * ramp_time(v) = way on the branch that is reached.
        speed = a / 2 * (np.sqrt((a / j) ** 2 + 4 * way / a) - a / j)
        if speed * j < a * a:
            speed = np.cbrt(way * way * j / 4)
    rounding = min(a / j, np.sqrt(speed / j))
    steady = max(_ramp_time(speed, a, j) - 2 * rounding, 0.0)
    cruise = max(way / speed - _ramp_time(speed, a, j), 0.0)
    peak = min(a, np.sqrt(speed * j))
    slope = 0.0 if np.isinf(j) else j
    ramp = [(rounding, slope, 0.0), (steady, 0.0, peak), (rounding, -slope, peak)]
    brake = [(time, -jerk_, -acceleration_) for time, jerk_, acceleration_ in ramp]
    times, pieces, x, v, sign = [0.0], [], float(start), 0.0, np.sign(end - start)
    for time, s, acc in [*ramp, (cruise, 0.0, 0.0), *brake]:
        if time == 0.0:
            continue
        pieces.append([x, v, sign * acc / 2, sign * s / 6])
        x += time * (v + time * (sign * acc / 2 + time * sign * s / 6))
        v += time * (sign * acc + time * sign * s / 2)
        times.append(times[-1] + time)
    return Motion(np.array(times), np.array(pieces)[:, : 3 if np.isinf(j) else 4])


def _speed_ramps(
    start: float, speeds: tuple[float, float, float], ramp: float, hold: float, rise: tuple[float, ...]
) -> Motion:
    """Ramps between three speeds whose way, as a fraction of the change times ramp, is the polynomial ``rise`` of x
    beside that of the speed before, with rise(1) = 1/2."""
    number_in("start", start, "a finite number")
    before, speed, after = (
        number_in(name, value, "a finite number")
        for name, value in zip(("start_speed", "speed", "end_speed"), speeds, strict=True)
    )
    check_positive("ramp", ramp)
    check_not_negative("hold", hold)
    # Floats of Python raise where numpy would warn: a ramp of 1e-300 s is refused, not turned into infinities.
    up, down = (
        np.array([change * ramp * share / float(ramp) ** power for power, share in enumerate(rise)])
        for change in (speed - before, after - speed)
    )
    cruise, reached = np.zeros_like(up), start + 0.5 * ramp * (before + speed)
    up[1], cruise[1], down[1] = before, speed, speed
    up[0], cruise[0], down[0] = start, reached, reached + speed * hold
    if hold == 0.0:
        return Motion(np.array([0.0, ramp, 2 * ramp]), np.array([up, down]), after)
    return Motion(np.array([0.0, ramp, ramp + hold, 2 * ramp + hold]), np.array([up, cruise, down]), after)


def _ramp_time(speed: float, acceleration: float, jerk: float) -> float:
    if speed * jerk >= acceleration**2:
        return speed / acceleration + acceleration / jerk
    return float(2 * np.sqrt(speed / jerk))
