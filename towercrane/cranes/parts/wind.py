"""Wind: what it presses on, and motions that describe it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from modal.checks import check_fields
from towercrane.kernels.payload import AIR_DENSITY
from towercrane.motions.motion import Motion, rest

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

CHANNELS = ("wind_x", "wind_y", "wind_z")
"""Names of the motions whose values are the components of the wind's velocity in fixed axes [m/s]."""


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
