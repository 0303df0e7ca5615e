"""Largest and smallest values of outputs between the looks at a run, with all other outputs at that time.

Around the highest looks and on both sides of every switch the run is taken up again from the look before, by the same
solver with its dense output, and looked at closely; a parabola through the three highest looks has the extreme.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import comb
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from towercrane.motions.motion import SAME_INSTANT, Phases, phases, shifted
from towercrane.simulation.integrate import evaluate, integrate
from towercrane.simulation.trajectory import phase_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from towercrane.simulation.run import Run

    Floats = NDArray[np.float64]

CANDIDATES = 2
"""Looks whose surroundings are searched for each extreme of an output."""

CLOSELY = 0.08
"""Turn of the crane's fastest vibration between two close looks [rad]; a parabola then errs by less than 1e-6."""

LEAST, MOST = 8, 64
"""Close looks between two looks."""

BEFORE = 2.0 * SAME_INSTANT
"""How long before a switch its left limit is taken [s]."""


class Extreme(NamedTuple):
    """A value and its time [s]."""

    value: float
    time: float


@dataclass(frozen=True, eq=False)
class Extremes:
    """Of a run's outputs that are single numbers.

    Parameters
    ----------
    highest, lowest : dict of str to Extreme
    times : ndarray, shape (looks,)
        All looks, close ones included, ascending [s].
    values : dict of str to ndarray, shape (looks,)
    """

    highest: dict[str, Extreme]
    lowest: dict[str, Extreme]
    times: Floats
    values: dict[str, Floats]

    def at(self, time: float, names: Sequence[str]) -> dict[str, float]:
        """Outputs at a time of an extreme, by the parabola of the looks around it."""
        return {name: float(_through(self.times, self.values[name], time)) for name in names}


def extremes_of(run: Run) -> Extremes:
    """Extremes of every output of a run that is a single number.

    While turbulence rises none are taken; of a run that ended before then its end counts.
    """
    first = min(int(np.searchsorted(run.times, run.attrs.get("evaluated_from", 0.0))), len(run.times) - 1)
    names = [name for name, own in run.data_vars.items() if own.dims == ("time",)]
    looked = {name: run[name].values[first:] for name in names}
    times, found = run.times[first:], looked
    if len(times) > 1:
        close, seen = _close(run, first, names, looked)
        times, order = np.unique(np.concatenate([times, close]), return_index=True)
        found = {name: np.concatenate([looked[name], seen[name]])[order] for name in names}
    kinks = np.zeros(0) if run.switches is None else run.switches.times
    return Extremes(
        {name: highest(times, own, 1.0, kinks) for name, own in found.items()},
        {name: highest(times, own, -1.0, kinks) for name, own in found.items()},
        times,
        found,
    )


def _close(run: Run, start: int, names: list[str], looked: dict[str, Floats]) -> tuple[Floats, dict[str, Floats]]:
    """Close looks from the look ``start`` on, and the outputs there."""
    times = run.times[start:]
    cut = phases(tuple(run.motions[channel] for channel in run.model.channels), float(run.times[-1]))
    crossings = run.model.system.crossings
    switches = _jumps(run, cut if crossings is None else crossings.cut(cut))
    wanted = np.zeros(len(times) - 1, dtype=bool)
    for values in looked.values():
        for sign in (1.0, -1.0):
            at = _promising(sign * values)
            wanted[np.clip(at - 1, 0, None)] = wanted[np.clip(at, None, len(wanted) - 1)] = True
    switches = switches[(switches > times[0]) & (switches <= times[-1])]
    wanted[np.clip(np.searchsorted(times, switches) - 1, 0, len(wanted) - 1)] = True
    edges = start + np.flatnonzero(np.diff(np.r_[False, wanted, False]))
    pieces = [_again(run, cut, first, last, switches) for first, last in zip(edges[::2], edges[1::2], strict=True)]
    times, states = (np.concatenate(parts) for parts in zip(*pieces, strict=True))
    quantities = run.model.observe(run.motions, times, states, *evaluate(run.model.system, cut, times, states))
    if run.switches is None:
        return times, {name: quantities[name].values for name in names}
    # Where equations switch, forces may jump.
    after = (run.switches.times >= run.times[start]) & (run.switches.times <= run.times[-1])
    switched = {name: run.switches[name].values[after] for name in names}
    found = {name: np.concatenate([quantities[name].values, switched[name]]) for name in names}
    return np.concatenate([times, run.switches.times[after]]), found


def _jumps(run: Run, cut: Phases) -> Floats:
    """Instants at which a drive's acceleration or more jumps, or at which the equations of the structure do."""
    powers = np.arange(cut.inputs.shape[2])
    spans = np.diff(cut.times)[:, None, None]
    ends = np.stack(
        [
            np.sum(cut.inputs * [comb(power, k) for power in powers] * spans ** np.maximum(powers - k, 0), axis=2)
            for k in range(3)
        ],
        axis=2,
    )  # fmt: skip
    after = np.concatenate([cut.inputs[1:], cut.after[None]])[:, :, :3]
    # What acts by its value alone may bend; rows beyond those of the drives are no polynomials.
    drives = len(run.model.channels)
    by_value = np.flatnonzero(np.isin(run.model.channels, getattr(run.model, "value_channels", ())))
    ends[:, by_value, 1:] = after[:, by_value, 1:]
    ends[:, drives:] = cut.inputs[:, drives:, :3]
    same = np.isclose(ends, after, rtol=1e-9, atol=1e-12).all(axis=(1, 2))
    return np.asarray(cut.times[1:][~same])


def _promising(values: Floats) -> NDArray[np.int64]:
    """Looks around which a largest value may be: the highest maxima by the parabola through their neighbours."""
    padded = np.r_[-np.inf, values, -np.inf]
    (peaks,) = np.nonzero((values >= padded[:-2]) & (values >= padded[2:]))
    left, right = padded[peaks], padded[peaks + 2]
    with np.errstate(invalid="ignore", divide="ignore"):
        rise = (right - left) ** 2 / (8.0 * (2.0 * values[peaks] - left - right))
    expected = values[peaks] + np.where(np.isfinite(rise), rise, 0.0)
    return np.asarray(peaks[np.argsort(-expected, kind="stable")[:CANDIDATES]])


def _again(run: Run, cut: Phases, first: int, last: int, switches: Floats) -> tuple[Floats, Floats]:
    """Close times between two looks, both limits of every switch among them, and the states there."""
    begin, end = run.times[first], run.times[last]
    known = run.model.system.fastest_in(cut)
    fastest = known() if known is not None else 0.0
    count = int(np.clip((end - begin) / (last - first) * fastest / CLOSELY, LEAST, MOST))
    within = switches[(switches > begin) & (switches <= end)]
    grid = begin + (end - begin) * np.linspace(0.0, 1.0, (last - first) * count + 1)
    times = np.unique(np.concatenate([grid, within, within - BEFORE]))
    times = times[(times >= begin) & (times <= end)]
    part = phases_between(cut, float(begin), float(end))
    options = {name: run.attrs[name] for name in ("method", "rtol", "atol")}
    found = integrate(run.model.system, part, run.states[first], times - begin, **options)
    return found.times + begin, found.states


def phases_between(cut: Phases, begin: float, end: float) -> Phases:
    """Phases from one time to another, counted from the first."""
    inside = cut.times[(cut.times > begin + SAME_INSTANT) & (cut.times < end - SAME_INSTANT)]
    starts = np.r_[begin, inside]
    whole = np.concatenate([cut.inputs, cut.after[None]])
    inputs = np.zeros((len(starts) + 1, *whole.shape[1:]))
    for row, (start, phase) in enumerate(zip(np.r_[starts, end], phase_of(np.r_[starts, end], cut), strict=True)):
        for channel, coefficients in enumerate(whole[phase]):
            inputs[row, channel] = shifted(coefficients, start - cut.times[phase])
    return Phases(np.r_[starts, end] - begin, inputs[:-1], inputs[-1])


def highest(times: Floats, values: Floats, sign: float, kinks: Sequence[float] | Floats = ()) -> Extreme:
    """Largest of values times the sign; no parabola is laid over a time at which the equations switch."""
    at = int(np.argmax(sign * values))
    if 0 < at < len(times) - 1 and not np.isin(times[at : at + 2], np.asarray(kinks)).any():
        step = np.diff(times[at - 1 : at + 2])
        low, mid, high = sign * values[at - 1 : at + 2]
        slopes = (mid - low) / step[0], (high - mid) / step[1]
        bend = (slopes[1] - slopes[0]) / (step[0] + step[1])
        # Beside a switch the three are no parabola; its sides are looked at themselves.
        if step.min() > 2.0 * BEFORE and bend < 0.0 and step.max() < 1.5 * step.min():
            turn = 0.5 * (times[at - 1] + times[at]) - 0.5 * slopes[0] / bend
            if abs(turn - times[at]) <= step.max():
                return Extreme(float(_through(times, values, turn)), float(turn))
    return Extreme(float(values[at]), float(times[at]))


def _through(times: Floats, values: Floats, time: float) -> float:
    """Value at a time by the parabola through the three looks around it; at a look its own."""
    at = int(np.clip(np.searchsorted(times, time), 0, len(times) - 1))
    if times[at] == time or len(times) < 3:
        return float(values[at])
    nearest = at if at == 0 or times[at] - time < time - times[at - 1] else at - 1
    first = int(np.clip(nearest - 1, 0, len(times) - 3))
    (a, b, c), (low, mid, high) = times[first : first + 3], values[first : first + 3]
    return float(
        low * (time - b) * (time - c) / ((a - b) * (a - c))
        + mid * (time - a) * (time - c) / ((b - a) * (b - c))
        + high * (time - a) * (time - b) / ((c - a) * (c - b))
    )
