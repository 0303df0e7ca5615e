"""The ground's motion in an earthquake, and that of a building's floors."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from towercrane.motions.motion import Motion

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]

CHANNELS = ("ground_x", "ground_y", "ground_z")
"""Names of the motions that displace the ground along the fixed axes [m]."""


def floor_channels(count: int) -> tuple[str, ...]:
    """Names of the motions of so many floors against the ground, along x and y of each [m]."""
    return tuple(f"floor_{k}_{axis}" for k in range(1, count + 1) for axis in "xy")


def earthquake(times: ArrayLike, accelerations: ArrayLike, until: float = 0.0) -> dict[str, Motion]:
    """Ground that rests at first and accelerates linearly between values, then goes on as the last left it.

    Parameters
    ----------
    times : array_like, shape (p,)
        Increasing from 0 [s].
    accelerations : array_like, shape (p, 3)
        [m/s^2]
    until : float
        Time up to which the ground goes on [s]; a motion rests beyond its end.

    Raises
    ------
    ValueError
        If the times do not increase, or there are not two or more rows of three finite values.
    """
    knots, rows = _checked(times, accelerations, 3)
    spans = np.diff(knots)[:, None]
    slopes = np.diff(rows, axis=0) / spans
    rates = _running((rows[:-1] + 0.5 * slopes * spans) * spans)
    places = _running((rates[:-1] + (0.5 * rows[:-1] + slopes * spans / 6.0) * spans) * spans)
    pieces = np.stack([places[:-1], rates[:-1], 0.5 * rows[:-1], slopes / 6.0], axis=1)
    if until > knots[-1]:
        knots = np.append(knots, until)
        last = np.stack([places[-1], rates[-1], np.zeros(3), np.zeros(3)])
        pieces = np.concatenate([pieces, last[None]])
    return {channel: Motion(knots, np.ascontiguousarray(pieces[:, :, k])) for k, channel in enumerate(CHANNELS)}


def floor(number: int, times: ArrayLike, displacements: ArrayLike) -> dict[str, Motion]:
    """Floor of that number, whose displacement against the ground is linear between values; after the last it stays.

    Parameters
    ----------
    number : int
        From 1.
    times : array_like, shape (p,)
        Increasing from 0 [s].
    displacements : array_like, shape (p, 2)
        Along x and y [m].

    Raises
    ------
    ValueError
        If the times do not increase, or there are not two or more rows of two finite values.
    """
    knots, rows = _checked(times, displacements, 2)
    slopes = np.diff(rows, axis=0) / np.diff(knots)[:, None]
    names = floor_channels(number)[-2:]
    return {name: Motion(knots, np.stack([rows[:-1, k], slopes[:, k]], axis=1)) for k, name in enumerate(names)}


def _checked(times: ArrayLike, values: ArrayLike, columns: int) -> tuple[Floats, Floats]:
    knots, rows = np.asarray(times, dtype=float), np.asarray(values, dtype=float)
    if rows.ndim != 2 or rows.shape[1] != columns or len(rows) < 2 or not np.all(np.isfinite(rows)):
        raise ValueError(f"values: wanted two or more rows of {columns} finite components, got shape {rows.shape}")
    if knots.shape != rows.shape[:1] or knots[0] != 0.0 or not np.all(np.diff(knots) > 0.0):
        raise ValueError(f"times: wanted {len(rows)} that increase from 0, got shape {knots.shape}")
    return knots, rows


def _running(steps: Floats) -> Floats:
    """Sums of steps so far, from zero."""
    return np.concatenate([np.zeros((1, steps.shape[1])), np.cumsum(steps, axis=0)])
