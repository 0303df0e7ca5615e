"""Which moments of a run a film shows, and how fast they pass."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from towercrane.cranes.parts.poses import ROUND

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

LASTS = 30.0
"""Longest film that is made unasked [s]."""

MOST_FRAMES = 6000
"""Of one film."""

SPEEDS = (1e-3, 1e3)
"""Slowest and fastest playback."""

RATES = (1.0, 100.0)
"""Fewest and most frames per second."""


@dataclass(frozen=True, slots=True)
class Playback:
    """Moments of a run at even steps, and how they are played.

    Parameters
    ----------
    start, end : float
        First and last moment [s].
    speed : float
        Time of the run over time of the film.
    frames_per_second : float
        Of the film.

    Raises
    ------
    ValueError
        If the span is empty, the speed or the number of frames absurd.
    """

    start: float
    end: float
    speed: float = 1.0
    frames_per_second: float = 20.0

    def __post_init__(self) -> None:
        if not 0.0 <= self.start < np.inf:
            raise ValueError(f"Playback.start: wanted zero or more seconds, got {self.start:g} s")
        if not self.start < self.end < np.inf:
            raise ValueError(f"Playback.end: wanted more than {self.start:g} s, the start, got {self.end:g} s")
        if not SPEEDS[0] <= self.speed <= SPEEDS[1]:
            wanted = f"{SPEEDS[0]:g} to {SPEEDS[1]:g} times real time"
            raise ValueError(f"Playback.speed: wanted {wanted}, got {self.speed:g}")
        if not RATES[0] <= self.frames_per_second <= RATES[1]:
            wanted = f"{RATES[0]:g} to {RATES[1]:g}"
            raise ValueError(f"Playback.frames_per_second: wanted {wanted}, got {self.frames_per_second:g}")
        if (frames := (self.end - self.start) / self.step) > MOST_FRAMES:
            wanted = f"one at which {self.end - self.start:g} s take at most {MOST_FRAMES} frames"
            raise ValueError(f"Playback.speed: wanted {wanted}, got {self.speed:g}, at which they take {frames:.0f}")

    @property
    def step(self) -> float:
        """Time of the run between two frames [s]."""
        return self.speed / self.frames_per_second

    @property
    def times(self) -> Floats:
        """Time of each frame in the run [s]; the last frame shows the end of the span; shape (frames,)."""
        whole = int(np.floor((self.end - self.start) / self.step * (1.0 + 1e-12)))
        times = self.start + self.step * np.arange(whole + 1)
        # A step's remainder that nobody could see makes no frame of its own.
        if self.end - times[-1] > 1e-3 * self.step:
            times = np.append(times, self.end)
        return np.asarray(np.minimum(times, self.end))


def fitting_speed(span: float) -> float:
    """Slowest of the speeds 1, 2, 5, 10, ... at which a film of a span [s] is not too long."""
    return next(speed for speed in ROUND if span <= LASTS * speed or speed >= SPEEDS[1])
