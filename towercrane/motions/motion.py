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
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]

SAME_INSTANT = 1e-9
"""Switch times closer than this [s] are one: two profiles may differ by rounding."""


@dataclass(frozen=True, eq=False)
class Motion:
    """Piecewise polynomial motion; after its last switch time it rests, or goes on at a steady rate.

    Parameters
    ----------
    switch_times : ndarray, shape (p + 1,)
        Start of each piece and end of the last [s]; the first is 0.
    coefficients : ndarray, shape (p, k)
        Ascending powers of the time since the piece's start.
    end_rate : float
        Rate at which it goes on.
    """

    switch_times: Floats
    coefficients: Floats
    end_rate: float = 0.0

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
        """Time after which the motion rests, or goes on at its steady rate [s]."""
        return float(self.switch_times[-1])

    @property
    def stop(self) -> float:
        """Time after which it rests; infinite where it goes on [s]."""
        return float("inf") if self.end_rate else self.duration

    @property
    def end(self) -> float:
        """Value at the last switch time."""
        return _polynomial(self.coefficients[-1], self.switch_times[-1] - self.switch_times[-2])

    @property
    def mean(self) -> float:
        """Mean over the motion's own duration; of one without duration its value."""
        if not self.duration > 0.0:
            return self.end
        powers = np.arange(1.0, self.coefficients.shape[1] + 1.0)
        ways = self.coefficients * self._spans[:, None] ** powers / powers
        return float(ways.sum() / self.duration)

    def pieces(self, times: Floats) -> Floats:
        """Coefficients about times of zero or more, valid until the next switch time; shape (times, k or more)."""
        index = np.searchsorted(self.switch_times, times + SAME_INSTANT, side="right") - 1
        index = np.minimum(index, len(self.coefficients) - 1)
        found = shifted(self.coefficients[index], times - self.switch_times[index])
        if self.end_rate and found.shape[1] < 2:
            found = np.pad(found, ((0, 0), (0, 1)))
        rests = self.duration <= times + SAME_INSTANT
        found[rests], found[rests, 0] = 0.0, self.end
        if self.end_rate:
            found[rests, 0] += self.end_rate * np.maximum(times[rests] - self.duration, 0.0)
            found[rests, 1] = self.end_rate
        return found

    def __call__(self, time: ArrayLike, derivative: int = 0) -> Floats:
        """Value or derivative at ``time`` [s]; at a switch time the right limit. Shape as ``time``."""
        return self.derivatives(time, (derivative,))[0]

    def derivatives(self, time: ArrayLike, orders: Sequence[int] = (0, 1, 2)) -> list[Floats]:
        """Value, rate and acceleration, or derivatives of other orders, as a call gives them one by one."""
        t = np.asarray(time, dtype=float)
        rests = (t < 0.0) | (self.duration <= t + SAME_INSTANT)
        index = np.searchsorted(self.switch_times, t + SAME_INSTANT, side="right") - 1
        index = np.clip(index, 0, len(self.coefficients) - 1)
        local, found = t - self.switch_times[index], []
        for order in orders:
            pieces = np.polynomial.polynomial.polyder(self.coefficients, order, axis=1)
            value = np.zeros_like(t)
            for column in pieces.T[::-1]:
                value = value * local + column[index]
            beyond = self.end_rate * np.maximum(t - self.duration, 0.0)
            later = (self.end + beyond, self.end_rate, 0.0)[min(order, 2)]
            earlier = self.coefficients[0, 0] if order == 0 else 0.0
            found.append(np.where(rests, np.where(t < 0.0, earlier, later), value))
        return found

    def range(self, derivative: int = 0, until: float = 0.0) -> tuple[float, float]:
        """Smallest and largest value that the motion, or a derivative of it, ever takes.

        One that goes on at a steady rate is looked at up to a time [s].
        """
        values = [float(self.coefficients[0, 0]), self.end] if derivative == 0 else [0.0]
        if self.end_rate:
            later = max(until - self.duration, 0.0)
            values.append((self.end + float(self.end_rate) * later, float(self.end_rate), 0.0)[min(derivative, 2)])
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
    return Motion(np.array(times), np.array(pieces), motions[-1].end_rate)


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
    for channel, motion in enumerate(motions):
        pieces = motion.pieces(times)
        inputs[:, channel, : pieces.shape[1]] = pieces
    return Phases(times, inputs[:-1], inputs[-1])


def distinct(moments: Floats) -> Floats:
    """Ascending times without those that are the same instant as the last one kept [s]."""
    kept: list[float] = []
    for moment in np.unique(moments).tolist():
        if not kept or moment > kept[-1] + SAME_INSTANT:
            kept.append(moment)
    return np.array(kept)


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
        # Scaled to near one, exactly: squares of large numbers would overflow.
        _, exponents = np.frexp(np.max(abs(polynomials), axis=1))
        c, b, *rest = np.ldexp(polynomials, -exponents[:, None]).T
        a = rest[0] if rest else np.zeros_like(b)
        # What overflows is a root beyond all numbers.
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
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


def shifted(coefficients: Floats, time: ArrayLike) -> Floats:
    """Coefficients about ``time`` instead of 0, of one polynomial or of many in rows: repeated synthetic division."""
    shifted, width = np.array(coefficients, dtype=float), np.shape(coefficients)[-1]
    for first in range(width - 1):
        for k in range(width - 2, first - 1, -1):
            shifted[..., k] += time * shifted[..., k + 1]
    return shifted
