"""Prescribed motions as piecewise polynomials that know their switch points.

A motion is a value over time (a trolley's position, a rope's length) with continuous first derivative. Its
pieces are polynomials, so the solver can restart exactly where acceleration or jerk jumps and evaluate the
right piece on each side.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from modal.checks import check_not_negative, check_positive, number_in

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]

SHORTEST_WAY = 1e-12
"""Ways shorter than this [m] are none."""

LIKE = 5
"""Neighbouring points whose curvatures are alike where a motion is sampled finely."""

SAME_INSTANT = 1e-9
"""Switch times closer than this [s] are one: two profiles may differ by rounding."""


@dataclass(frozen=True, eq=False)
class Motion:
    """Piecewise polynomial motion; before its first and after its last switch time it rests.

    Parameters
    ----------
    switch_times : ndarray, shape (p + 1,)
        Start of each piece and end of the last [s]; the first is 0.
    coefficients : ndarray, shape (p, k)
        Ascending powers of the time since the piece's start.
    """

    switch_times: Floats
    coefficients: Floats

    def __post_init__(self) -> None:
        times, coefficients = self.switch_times, self.coefficients
        if times.ndim != 1 or coefficients.ndim != 2 or len(times) != len(coefficients) + 1:
            raise ValueError(
                f"Motion: wanted p + 1 switch times for p pieces, got {times.shape}, {coefficients.shape}"
            )
        if times[0] != 0.0 or np.any(np.diff(times) < 0.0) or not np.all(np.isfinite(times)):
            raise ValueError("Motion.switch_times: wanted finite, increasing times from 0")
        if not np.all(np.isfinite(coefficients)):
            raise ValueError("Motion.coefficients: wanted finite numbers")

    @property
    def duration(self) -> float:
        """Time after which the motion rests [s]."""
        return float(self.switch_times[-1])

    @property
    def end(self) -> float:
        """Value at which the motion comes to rest."""
        return _polynomial(self.coefficients[-1], self.switch_times[-1] - self.switch_times[-2])

    @property
    def mean(self) -> float:
        """Mean over the motion's own duration; of one without duration its value."""
        if not self.duration > 0.0:
            return self.end
        powers = np.arange(1.0, self.coefficients.shape[1] + 1.0)
        ways = self.coefficients * self._spans[:, None] ** powers / powers
        return float(ways.sum() / self.duration)

    def piece(self, time: float) -> Floats:
        """Coefficients about a ``time`` of zero or more, valid until the next switch time; shape (k,)."""
        if self.duration <= time + SAME_INSTANT:
            return _padded(self.end, self.coefficients.shape[1])
        index = int(np.searchsorted(self.switch_times, time + SAME_INSTANT, side="right")) - 1
        return _shifted(self.coefficients[index], time - self.switch_times[index])

    def __call__(self, time: ArrayLike, derivative: int = 0) -> Floats:
        """Value or derivative at ``time`` [s]; at a switch time the right limit. Shape as ``time``."""
        t = np.asarray(time, dtype=float)
        rests = (t < 0.0) | (self.duration <= t + SAME_INSTANT)
        index = np.searchsorted(self.switch_times, t + SAME_INSTANT, side="right") - 1
        index = np.clip(index, 0, len(self.coefficients) - 1)
        pieces = np.polynomial.polynomial.polyder(self.coefficients, derivative, axis=1)
        local = t - self.switch_times[index]
        value = np.zeros_like(t)
        for column in pieces.T[::-1]:
            value = value * local + column[index]
        resting = np.where(t < 0.0, self.coefficients[0, 0], self.end) if derivative == 0 else 0.0
        return np.where(rests, resting, value)

    def range(self, derivative: int = 0) -> tuple[float, float]:
        """Smallest and largest value that the motion, or a derivative of it, ever takes."""
        values = [float(self.coefficients[0, 0]), self.end] if derivative == 0 else [0.0]
        pieces, spans = np.polynomial.polynomial.polyder(self.coefficients, derivative, axis=1), self._spans
        turns = _roots(np.asarray(np.polynomial.polynomial.polyder(pieces, axis=1), dtype=np.float64))
        for at in (np.zeros(len(spans)), spans, *np.clip(turns, 0.0, spans[:, None]).T):
            reached = np.zeros(len(spans))
            for column in pieces.T[::-1]:
                reached = reached * at + column
            values += [float(reached.min()), float(reached.max())]
        return min(values), max(values)

    @property
    def _spans(self) -> Floats:
        """Duration of each piece [s]."""
        return np.diff(self.switch_times)


def rest(value: float, duration: float = 0.0) -> Motion:
    """Motion that stays at ``value`` for ``duration`` [s] (and after)."""
    number_in("rest: value", value, "a finite number")
    check_not_negative("rest: duration", duration)
    return Motion(np.array([0.0, duration]), np.array([[float(value)]]))


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


def speed_trapezoid(start: float, speed: float, ramp: float, hold: float) -> Motion:
    """Speed that rises linearly, holds and falls linearly; the way is speed (ramp + hold).

    Parameters
    ----------
    start : float
        First value [m or rad].
    speed : float
        Speed while it holds [m/s or rad/s]; its sign is the direction.
    ramp, hold : float
        Time of each ramp, positive, and time between them, zero or more [s].
    """
    return _speed_ramps(start, speed, ramp, hold, (0.0, 0.0, 0.5))


def smooth_ramps(start: float, speed: float, ramp: float, hold: float) -> Motion:
    """Speed that rises and falls as 10 x^3 - 15 x^4 + 6 x^5, with x from 0 to 1 over each ramp.

    Acceleration and jerk are continuous; the way is speed (ramp + hold).

    Parameters
    ----------
    start : float
        First value [m or rad].
    speed : float
        Speed while it holds [m/s or rad/s]; its sign is the direction.
    ramp, hold : float
        Time of each ramp, positive, and time between them, zero or more [s].
    """
    return _speed_ramps(start, speed, ramp, hold, (0.0, 0.0, 0.0, 0.0, 2.5, -3.0, 1.0))


def sequence(*motions: Motion) -> Motion:
    """Motions one after the other; each begins where the one before ends.

    Raises
    ------
    ValueError
        If a motion begins elsewhere.
    """
    if not motions:
        raise ValueError("sequence: wanted at least one motion, got none")
    width = max(m.coefficients.shape[1] for m in motions)
    times, pieces, now, value = [0.0], [], 0.0, float(motions[0].coefficients[0, 0])
    for number, motion in enumerate(motions, start=1):
        begin = float(motion.coefficients[0, 0])
        if abs(begin - value) > 1e-9 * max(1.0, abs(value)):
            raise ValueError(f"sequence: motion {number} begins at {begin:g}, the one before ends at {value:g}")
        times += list(now + motion.switch_times[1:])
        pieces += [np.pad(p, (0, width - len(p))) for p in motion.coefficients]
        now, value = times[-1], motion.end
    return Motion(np.array(times), np.array(pieces))


def table(times: ArrayLike, values: ArrayLike) -> Motion:
    """Motion through points that starts and ends at rest and keeps their shape: it never leaves the points' range.

    It is the cubic spline with continuous acceleration where that stays between neighbouring points. Elsewhere its
    slopes are limited, and the acceleration jumps at the point; the solver restarts at each.

    Parameters
    ----------
    times : array_like, shape (p,)
        Increasing times from 0 [s].
    values : array_like, shape (p,)
        Values at those times.

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
    slopes = np.array(CubicSpline(t, x, bc_type="clamped")(t, 1))
    secants = np.diff(x) / np.diff(t)
    before, after, sense = secants[:-1], secants[1:], np.sign(secants[:-1])
    steepest = np.where(before * after > 0.0, 3.0 * np.minimum(abs(before), abs(after)), 0.0)
    limited = sense * np.clip(sense * slopes[1:-1], 0.0, steepest)
    slopes[1:-1] = np.where(_turns_smoothly(t, before, after), slopes[1:-1], limited)
    slopes[[0, -1]] = 0.0
    return Motion(t, np.ascontiguousarray(CubicHermiteSpline(t, x, slopes).c[::-1].T))


def _turns_smoothly(t: Floats, before: Floats, after: Floats) -> NDArray[np.bool_]:
    """Whether the curvature at each inner point and two to either side has one sign and about one size."""
    curvature = (after - before) / (t[2:] - t[:-2])
    smooth = np.zeros(len(curvature), dtype=bool)
    if len(curvature) >= LIKE:
        near = np.lib.stride_tricks.sliding_window_view(curvature, LIKE)
        signed = near * np.sign(near[:, :1])
        smooth[LIKE // 2 : len(smooth) - LIKE // 2] = signed.max(axis=1) < 2.0 * signed.min(axis=1)
    return smooth


@dataclass(frozen=True, eq=False)
class Phases:
    """Several motions cut at the union of their switch times.

    Parameters
    ----------
    times : ndarray, shape (p + 1,)
        Start of each phase and end of the last [s].
    inputs : ndarray, shape (p, channels, k)
        For each phase and motion the ascending coefficients in the time since the phase began.
    after : ndarray, shape (channels, k)
        Those in the time since the end of the last phase, for the right limits there.
    """

    times: Floats
    inputs: Floats
    after: Floats

    def moved(self, channel: int, start: float) -> Phases:
        """The same phases with one motion begun elsewhere that rests."""
        inputs, after = self.inputs.copy(), self.after.copy()
        inputs[:, channel, 0] = after[channel, 0] = start
        return Phases(self.times, inputs, after)


def phases(motions: tuple[Motion, ...], duration: float) -> Phases:
    """Cut ``duration`` [s] into the phases in which every motion is one polynomial."""
    check_positive("duration", duration)
    switches = np.concatenate([[0.0], *(m.switch_times for m in motions)])
    inside = switches[(switches >= 0.0) & (switches + SAME_INSTANT < duration)]
    times = np.append(distinct(inside), duration)
    width = max((m.coefficients.shape[1] for m in motions), default=1)
    inputs = np.zeros((len(times), len(motions), max(width, 3)))
    for p, start in enumerate(times):
        for channel, motion in enumerate(motions):
            piece = motion.piece(float(start))
            inputs[p, channel, : len(piece)] = piece
    return Phases(times, inputs[:-1], inputs[-1])


def distinct(moments: Floats) -> Floats:
    """Ascending times without those that are the same instant as the last one kept [s]."""
    kept: list[float] = []
    for moment in np.unique(moments).tolist():
        if not kept or moment > kept[-1] + SAME_INSTANT:
            kept.append(moment)
    return np.array(kept)


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


def _speed_ramps(start: float, speed: float, ramp: float, hold: float, rise: tuple[float, ...]) -> Motion:
    """Ramps whose way, as a fraction of speed times ramp, is the polynomial ``rise`` of x, with rise(1) = 1/2."""
    number_in("start", start, "a finite number")
    number_in("speed", speed, "a finite number")
    check_positive("ramp", ramp)
    check_not_negative("hold", hold)
    way = speed * ramp
    # Floats of Python raise where numpy would warn: a ramp of 1e-300 s is refused, not turned into infinities.
    up = np.array([way * share / float(ramp) ** power for power, share in enumerate(rise)])
    cruise, down = np.zeros_like(up), -up
    cruise[1] = down[1] = speed
    up[0], cruise[0], down[0] = start, start + way / 2, start + way / 2 + speed * hold
    if hold == 0.0:
        return Motion(np.array([0.0, ramp, 2 * ramp]), np.array([up, down]))
    return Motion(np.array([0.0, ramp, ramp + hold, 2 * ramp + hold]), np.array([up, cruise, down]))


def _ramp_time(speed: float, acceleration: float, jerk: float) -> float:
    if speed * jerk >= acceleration**2:
        return speed / acceleration + acceleration / jerk
    return float(2 * np.sqrt(speed / jerk))


def _polynomial(coefficients: Floats, time: float) -> float:
    value = 0.0
    for c in coefficients[::-1]:
        value = value * time + c
    return float(value)


def _roots(polynomials: Floats) -> Floats:
    """Real roots of polynomials in rows of ascending coefficients; zeros fill up; shape (p, columns - 1)."""
    found = np.zeros((len(polynomials), max(polynomials.shape[1] - 1, 0)))
    high = np.any(polynomials[:, 3:] != 0.0, axis=1)
    if polynomials.shape[1] > 1:
        c, b = polynomials[:, 0], polynomials[:, 1]
        a = polynomials[:, 2] if polynomials.shape[1] > 2 else np.zeros_like(b)
        with np.errstate(divide="ignore", invalid="ignore"):
            # The stable form: no difference of near numbers, and a line's root where a is zero.
            q = -0.5 * (b + np.copysign(np.sqrt(b * b - 4.0 * a * c), b))
            for column, root in enumerate((c / q, q / a)[: found.shape[1]]):
                found[:, column] = np.where(np.isfinite(root), root, 0.0)
    for row in np.flatnonzero(high):
        roots = np.polynomial.polynomial.polyroots(np.polynomial.polynomial.polytrim(polynomials[row]))
        real = roots.real[abs(roots.imag) < 1e-12]
        found[row] = 0.0
        found[row, : len(real)] = real
    return found


def _shifted(coefficients: Floats, time: float) -> Floats:
    """Coefficients about ``time`` instead of 0, by repeated synthetic division."""
    shifted = np.array(coefficients, dtype=float)
    for first in range(len(shifted) - 1):
        for k in range(len(shifted) - 2, first - 1, -1):
            shifted[k] += time * shifted[k + 1]
    return shifted


def _padded(value: float, width: int) -> Floats:
    return np.pad(np.array([value]), (0, width - 1))
