"""Ramps of a motion, each shaped for what the crane is like when it happens."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from towercrane.motions.motion import Motion, rest, sequence
from towercrane.motions.superposition import integral, rate, total

if TYPE_CHECKING:
    from collections.abc import Sequence

    from towercrane.motions.shaping import Shaper

STEADY = 1e-12
"""Change of speed over a piece, relative to the fastest, that is none."""


@dataclass(frozen=True, eq=False)
class Ramp:
    """Change of speed between two times of steady speed.

    Parameters
    ----------
    begin : float
        When it begins [s].
    speed : Motion
        What it adds to the speed from then on: from 0 to the whole change.
    """

    begin: float
    speed: Motion

    @property
    def end(self) -> float:
        """When it ends [s]."""
        return self.begin + self.speed.duration


def ramps(motion: Motion) -> list[Ramp]:
    """Ramps of a motion: neighbouring pieces that change its speed in the same sense."""
    speed = rate(motion)
    spans = np.diff(speed.switch_times)
    changes = np.array([np.polynomial.polynomial.polyval(span, piece) - piece[0]
                        for span, piece in zip(spans, speed.coefficients, strict=True)])  # fmt: skip
    fastest = max(abs(bound) for bound in motion.range(1))
    senses = np.where(abs(changes) > STEADY * fastest, np.sign(changes), 0.0)
    found = []
    first = 0
    for last in range(1, len(senses) + 1):
        if last < len(senses) and senses[last] == senses[first]:
            continue
        if senses[first]:
            pieces = speed.coefficients[first:last].copy()
            begin, before = float(speed.switch_times[first]), pieces[0, 0]
            pieces[:, 0] -= before
            found.append(Ramp(begin, Motion(speed.switch_times[first : last + 1] - begin, pieces)))
        first = last
    return found


def shape_ramps(motion: Motion, shapers: Sequence[Shaper]) -> tuple[Motion, list[float]]:
    """Motion each of whose ramps is convolved with its own shaper; it travels as far.

    That asks for one delay of all ramps' centres, so that ramps move by the difference of the shapers' mean delays;
    it is the least with which none begins before the first did. With a start and a stop, speed and acceleration stay
    within those of the motion. Where the two overlap and differ, the motion may turn back a little at its ends.

    Parameters
    ----------
    motion : Motion
        From rest to rest.
    shapers : sequence of Shaper
        One for each of :func:`ramps`.

    Returns
    -------
    motion : Motion
    ends : list of float
        When its ramps end [s].

    Raises
    ------
    ValueError
        If there are not as many shapers as ramps.
    """
    parts = ramps(motion)
    if len(shapers) != len(parts):
        raise ValueError(f"shape_ramps: wanted a shaper for each of {len(parts)} ramps, got {len(shapers)}")
    if not parts:
        return motion, []
    delay = max(s.mean_delay - (part.begin - parts[0].begin) for part, s in zip(parts, shapers, strict=True))
    # Rounding may leave a ramp that begins at zero an instant before.
    begins = [max(part.begin + delay - s.mean_delay, 0.0) for part, s in zip(parts, shapers, strict=True)]
    speeds = [shaper(part.speed) for part, shaper in zip(parts, shapers, strict=True)]
    start = float(motion.coefficients[0, 0])
    shaped = integral(total(speeds, begins, [1.0] * len(speeds)), start)
    # A motion may wait after its last ramp, and then does so as long.
    waits = motion.duration - max(part.end for part in parts)
    if waits > 0.0:
        shaped = sequence(shaped, rest(shaped.end, waits))
    return shaped, [begin + speed.duration for begin, speed in zip(begins, speeds, strict=True)]
