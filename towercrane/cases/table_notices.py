"""What a case's CSV tables and its wind do to a run that nobody would expect, in sentences."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from towercrane.cranes.parts.load import merged
from towercrane.cranes.registry import KINDS

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from towercrane.cases.case import Case
    from towercrane.motions.motion import Motion

    Floats = NDArray[np.float64]

SHAKING = {"m": 0.05, "rad": 0.002}
"""Acceleration by noise that is named, a half per cent of gravity [m/s^2], and what makes it 25 m out [rad/s^2]."""

FEWEST = 8
"""Second differences of a table from which scatter can be told."""

SAME_INSTANT = 1e-6
"""[s]"""

STEADY = 0.02
"""Part of the wind by which it may change with the load's height before that is named."""

STILL = 0.01
"""Velocity of the ground over its largest that rounding of a record leaves."""


def table_notices(case: Case) -> tuple[str, ...]:
    """Light hooks, records that end before the run does, tables whose noise the crane feels as acceleration."""
    # The case of a result has no motions to look at: what was to be said of them stands in the result.
    told = merged(case.payload, case.checked.hook)
    return (*told, *_blowing(case), *_ended(case), *_shaken(case), *_noisy(case)) if case.plans else ()


def _blowing(case: Case) -> Iterator[str]:
    """What a wind is made of that differs from place to place, and what it leaves out."""
    wind, places = getattr(case.checked, "wind", None), KINDS[case.kind].wind_places
    if wind is None or not wind.differs or places is None:
        return
    from towercrane.cranes.parts.turbulence.field import turbulence_of

    where, profile = places(case.checked), wind.over_height
    if wind.turbulence is not None:
        own, speed = turbulence_of(wind, where, case.run.duration), wind.speed * float(profile.share(where.hub))
        across = f" and {own.deviation_across:.3g} m/s across" if own.across else ""
        yield (
            f"wind.turbulence: standard deviations of {own.deviation:.3g} m/s along{across}, about {speed:.4g} "
            f"m/s at {where.hub:g} m, by the spectrum of {own.spectrum.source}, at {len(where.points)} places whose "
            f"coherence is that of IEC 61400-1:2019, C.16; it rises within {own.ramp:.4g} s, of which no extremes "
            "are taken"
        )
    height, rope = where.points[-1, 2], case.plans["rope"].commanded
    shares = profile.share([height, *(height + rope(0.0) - end for end in rope.range())])
    if np.ptp(shares) > STEADY * shares[0]:
        yield (
            f"wind.profile: the load's wind stays that of its height at the start, {height:.3g} m; where the hoist "
            f"moves it the profile would have {shares.min() / shares[0]:.3g} to {shares.max() / shares[0]:.3g} of it"
        )


def _ended(case: Case) -> Iterator[str]:
    """Gusts that end before the run."""
    wind = getattr(case.checked, "wind", None)
    if wind is None or not wind.series:
        return
    blown = {axis: case.plans[f"wind_{axis}"].commanded for axis in "xyz"}
    end, duration = max(motion.duration for motion in blown.values()), case.run.duration
    if end < duration - SAME_INSTANT:
        stays = ", ".join(f"{motion.end:g}" for motion in blown.values())
        yield (
            f"wind.series: the record ends at {end:g} s; in the {duration - end:g} s that the run goes on the wind "
            f"stays at its last value, x, y, z = {stays} m/s"
        )


def _shaken(case: Case) -> Iterator[str]:
    """Earthquakes that end before the run or after it, and ground that they leave moving."""
    if getattr(case.checked, "earthquake", None) is None:
        return
    motions, duration = [case.plans[f"ground_{axis}"].commanded for axis in "xyz"], case.run.duration
    # The last piece carries on what the file's last line leaves.
    end, fastest = float(motions[0].switch_times[-2]), max(max(map(abs, own.range(1))) for own in motions)
    if end > duration + SAME_INSTANT:
        knots = motions[0].switch_times[:-1]
        largest = np.max([abs(own(knots, 2)) for own in motions], axis=0)
        seen, missed = (float(largest[part].max(initial=0.0)) for part in (knots <= duration, knots > duration))
        yield (
            f"earthquake.file: the record goes on to {end:g} s, the run ends at {duration:g} s: it has felt up to "
            f"{seen:.2g} m/s^2 and misses up to {missed:.2g} m/s^2"
        )
        return
    left = [float(own(end, 1)) for own in motions]
    moves = max(map(abs, left)) > STILL * fastest
    at = f"moves on at its last velocity, x, y, z = {', '.join(f'{v:.2g}' for v in left)} m/s" if moves else "rests"
    if end < duration - SAME_INSTANT:
        rest = duration - end
        yield f"earthquake.file: the record ends at {end:g} s; in the {rest:g} s that the run goes on the ground {at}"
    elif moves:
        yield f"earthquake.file: the record leaves the ground moving, x, y, z = {at.partition(' = ')[2]}"


def _noisy(case: Case) -> Iterator[str]:
    """Tables whose points scatter."""
    for name, described in case.checked.motion:
        if getattr(described, "shape", "") != "table":
            continue
        motion = case.plans["rope" if name == "hoist" else name].moves[-1].commanded
        unit = "m" if name in ("trolley", "hoist") else "rad"
        step, size = scatter(motion)
        shaken, allowed = np.sqrt(6.0) * size / step**2, SHAKING[unit]
        if shaken > allowed:
            # A parabola fitted over a time T leaves e sqrt(720 h) / T^2.5 of a scatter e at steps of h.
            time = (size * np.sqrt(720.0 * step) / allowed) ** 0.4
            felt = max(abs(rate) for rate in motion.range(2))
            yield (
                f"motion.{name}.file: its values scatter by {size:.2g} {unit} from point to point, by rounding or "
                f"noise, which makes {shaken:.2g} of the up to {felt:.2g} {unit}/s^2 that the drive accelerates by; "
                f"a parabola fitted to each point over {time:.2g} s (scipy.signal.savgol_filter) leaves {allowed:g}"
            )


def scatter(motion: Motion) -> tuple[float, float]:
    """Step of a table's points [s] and standard deviation by which they scatter, zero where they do not.

    Independent errors e make second differences whose neighbours have the covariance -4 e^2. Those of a smooth way
    have the same sign.

    Parameters
    ----------
    motion : Motion
        Through the points, a piece between each.
    """
    times = motion.switch_times
    values = np.append(motion.coefficients[:, 0], motion.end)
    spans = np.diff(times)
    step = float(np.median(spans))
    second = 2.0 * step**2 * np.diff(np.diff(values) / spans) / (spans[1:] + spans[:-1])
    if len(second) < FEWEST:
        return step, 0.0
    return step, float(np.sqrt(np.maximum(-np.mean(second[1:] * second[:-1]) / 4.0, 0.0)))
