"""Wind: what it presses on, and motions that describe it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from modal.checks import check_fields
from towercrane.cranes.parts.turbulence.profile import Profile
from towercrane.kernels.load import AIR_DENSITY
from towercrane.motions.motion import Motion, rest

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

CHANNELS = ("wind_x", "wind_y", "wind_z")
"""Names of the motions whose values are the components of the wind's velocity in fixed axes [m/s]."""

JIB_NODES, TOWER_NODES = 5, 2
"""Places that are enough for the slewing moment in turbulence: within 3 per cent of a continuum's."""


def wind_channels(nodes: int) -> tuple[str, ...]:
    """Names of the motions of a wind that blows differently at so many places, the load's the last.

    What blows upward is the same at all.
    """
    others = (f"wind_{axis}_{node}" for node in range(1, nodes) for axis in "xy")
    return (*others, *CHANNELS) if nodes else ()


@dataclass(frozen=True, slots=True)
class WindAreas:
    """Drag areas of a crane's structure, drag coefficients included.

    The tower is pressed along the wind; jib, counter-jib and counterweight across their axis, by the component of
    the wind normal to it. The structure's own motion is slow beside the wind's.

    Parameters
    ----------
    tower, jib, counter_jib : float
        Per unit length [m].
    counterweight : float
        [m^2]

    Raises
    ------
    ValueError
        If a value is negative or not finite.
    """

    tower: float = 0.0
    jib: float = 0.0
    counter_jib: float = 0.0
    counterweight: float = 0.0

    def __post_init__(self) -> None:
        check_fields(self, not_negative=self.__slots__)


@dataclass(frozen=True, slots=True)
class WindNodes:
    """Places on a tower crane that see a wind of their own: of the tower, of what turns, and the load.

    Between places of the jib, and from its root to the counter-jib's end, the pressure is linear. Of the tower each
    is the middle of one of equal parts, over which the wind changes as its mean does.

    Parameters
    ----------
    jib : int
        From the jib's root to its tip, with the counter-jib's end as one more; 1: one place for all that turns.
    tower : int
    profile : Profile
        Of the mean wind.
    """

    jib: int = JIB_NODES
    tower: int = TOWER_NODES
    profile: Profile = field(default_factory=Profile)

    @property
    def head(self) -> int:
        """Number of those on what turns."""
        return self.jib + 1 if self.jib > 1 else 1

    @property
    def count(self) -> int:
        """Number of all: those of the tower from its foot, counter-jib's end, jib from its root, load."""
        return self.tower + self.head + 1

    def tower_heights(self, height: float) -> NDArray[np.float64]:
        """Heights of the tower's [m]; shape (tower,)."""
        return (np.arange(self.tower) + 0.5) * height / self.tower

    def along_jib(self, length: float, counter_length: float) -> NDArray[np.float64]:
        """Places of those on what turns, along the jib from the tower's axis [m]; shape (head,)."""
        return np.append(-counter_length, np.linspace(0.0, length, self.jib)) if self.jib > 1 else np.zeros(1)


def drag(area: float) -> float:
    """Drag per squared speed of a drag area, rho C_d A / 2 [kg/m]."""
    return 0.5 * AIR_DENSITY * area


def steady(velocity: ArrayLike) -> dict[str, Motion]:
    """Wind of constant velocity, a motion for each channel.

    Parameters
    ----------
    velocity : array_like, shape (3,)
        [m/s]
    """
    vector = np.asarray(velocity, dtype=float)
    if vector.shape != (3,) or not np.all(np.isfinite(vector)):
        raise ValueError(f"velocity: wanted 3 finite components, got {velocity!r}")
    return {channel: rest(float(value)) for channel, value in zip(CHANNELS, vector, strict=True)}


def gusts(times: ArrayLike, velocities: ArrayLike) -> dict[str, Motion]:
    """Wind that varies linearly between values; after the last it stays.

    The solver restarts at every knot, so no accuracy is lost there.

    Parameters
    ----------
    times : float, or array_like, shape (p,)
        Time between two values, or the time of each, which increase from 0 [s].
    velocities : array_like, shape (p, 3)
        [m/s]

    Raises
    ------
    ValueError
        If the times do not increase, or there are not two or more rows of three finite values.
    """
    rows, knots = np.asarray(velocities, dtype=float), np.asarray(times, dtype=float)
    if rows.ndim != 2 or rows.shape[1] != 3 or len(rows) < 2 or not np.all(np.isfinite(rows)):
        raise ValueError(f"velocities: wanted two or more rows of 3 finite components, got shape {rows.shape}")
    if knots.ndim == 0:
        if not 0.0 < knots < np.inf:
            raise ValueError(f"step: wanted a positive time, got {times!r}")
        knots = np.arange(len(rows), dtype=np.float64) * knots
    if knots.shape != rows.shape[:1] or knots[0] != 0.0 or not np.all(np.diff(knots) > 0.0):
        raise ValueError(f"times: wanted {len(rows)} that increase from 0, got shape {knots.shape}")
    slopes = np.diff(rows, axis=0) / np.diff(knots)[:, None]
    return {
        channel: Motion(knots, np.stack([rows[:-1, k], slopes[:, k]], axis=1)) for k, channel in enumerate(CHANNELS)
    }
