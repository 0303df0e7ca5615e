"""Motions of a wind that differs from place to place."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from towercrane.cranes.parts.turbulence.spectra import CLASSES, SPECTRA, class_deviation, eurocode_intensity
from towercrane.cranes.parts.turbulence.synthesis import Turbulence
from towercrane.cranes.parts.wind import CHANNELS, gusts, wind_channels
from towercrane.motions.motion import Motion

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from towercrane.cranes.parts.turbulence.tables import Wind

    Floats = NDArray[np.float64]

SHORTEST = 600.0
"""Duration of a record at least [s]: runs up to it are beginnings of one record."""

PERIODS = 3.0
"""Periods of the load as a pendulum over which the fluctuation rises: two of the slowest sway of a crane that gives
way, which is up to 1.4 times as slow."""


class Places(NamedTuple):
    """Where a wind of its own blows.

    Parameters
    ----------
    points : ndarray, shape (p, 3)
        When the run begins, the third the height over the ground, the load's the last [m].
    hub : float
        Height of the jib over the ground, for what counts once for all places [m].
    period : float
        Of the load as a pendulum on its rope [s].
    """

    points: Floats
    hub: float
    period: float


def ramp_of(wind: Wind, places: Places) -> float:
    """Time over which the fluctuation rises [s]."""
    assert wind.turbulence is not None, "the wind is turbulent"
    return PERIODS * places.period if wind.turbulence.ramp is None else wind.turbulence.ramp


def turbulence_of(wind: Wind, places: Places, duration: float) -> Turbulence:
    """Turbulence of a case for a run of this duration [s]."""
    table, speed, profile = wind.turbulence, wind.speed, wind.over_height
    assert table is not None, "the wind is turbulent"
    assert speed is not None, "about its mean speed"
    spectrum, mean = SPECTRA[table.spectrum], speed * float(profile.share(places.hub))
    if table.reference_class is not None:
        deviation = class_deviation(CLASSES[table.reference_class], mean)
    elif table.intensity is not None:
        deviation = table.intensity * mean
    else:
        deviation = eurocode_intensity(max(places.hub, wind.minimum_height), wind.roughness_length) * mean
    ratio = spectrum.deviation_across if table.across_ratio is None else table.across_ratio
    return Turbulence(
        spectrum, deviation, ratio * deviation, table.step, table.duration or max(duration, SHORTEST), table.seed,
        length_scale=table.length_scale, roughness_length=wind.roughness_length, decay=table.coherence_decay,
        coherence_scale=table.coherence_length, across=table.across, ramp=ramp_of(wind, places),
    )  # fmt: skip


def field_motions(wind: Wind, blown: Mapping[str, Motion], places: Places, duration: float) -> dict[str, Motion]:
    """Motions at all places, by channel.

    Parameters
    ----------
    wind : Wind
        Table of a case, one whose wind differs.
    blown : mapping of str to Motion
        At the reference height, without turbulence.
    places : Places
    duration : float
        Of the run [s].
    """
    shares = wind.over_height.share(places.points[:, 2])
    east, north, up = (blown[channel] for channel in CHANNELS)
    if wind.turbulence is None:
        moved = [_times(axis, float(share)) for share in shares for axis in (east, north)]
        return dict(zip(wind_channels(len(shares)), (*moved, up), strict=True))
    turbulence, speed = turbulence_of(wind, places, duration), wind.speed
    assert speed is not None, "it is turbulent about its mean speed"
    series = turbulence.risen(
        turbulence.series(
            places.points, speed * shares, speed * float(wind.over_height.share(places.hub)), places.hub
        )
    )
    c, s = np.cos(wind.direction), np.sin(wind.direction)
    along = speed * shares[:, None] + series[0]
    across = series[1] if turbulence.across else np.zeros_like(along)
    moved = []
    for u, v in zip(along, across, strict=True):
        own = gusts(turbulence.step, np.stack([c * u - s * v, s * u + c * v, np.zeros_like(u)], axis=1))
        moved += [own[channel] for channel in CHANNELS[:2]]
    return dict(zip(wind_channels(len(shares)), (*moved, up), strict=True))


def _times(motion: Motion, factor: float) -> Motion:
    return Motion(motion.switch_times, factor * motion.coefficients)
