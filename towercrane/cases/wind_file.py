"""The wind of a case: steady, gusts from a CSV file, or turbulent."""

from __future__ import annotations

from dataclasses import replace
from math import cos, sin
from typing import TYPE_CHECKING, Any

from towercrane.cranes.registry import KINDS
from towercrane.schema.csv_series import read_series
from towercrane.schema.faults import CaseError, Fault
from towercrane.schema.ranges import at, si_at

if TYPE_CHECKING:
    from pathlib import Path

    import numpy as np
    from numpy.typing import NDArray

    from towercrane.cranes.registry import AnyCase
    from towercrane.motions.motion import Motion

    Floats = NDArray[np.float64]

CHANNELS = ("wind_x", "wind_y", "wind_z")
"""Names of the wind's motions, as in :data:`towercrane.cranes.parts.wind.CHANNELS`."""

AXES = {
    axis: (axis, f"wind_{axis}", f"wind {axis}", f"v{axis}", speed) for axis, speed in zip("xyz", "uvw", strict=True)
}
"""Components, and the names that a header may give them."""

STRONGEST = 80.0
"""Largest plausible component of the wind [m/s]."""


def wind_motions(
    tree: dict[str, Any], folder: Path, kind: str, checked: AnyCase | None
) -> tuple[list[Fault], dict[str, Motion]]:
    """Motions of the wind's components [m/s], none for a case in still air, and what is wrong with its file.

    Where the wind differs from place to place they wait until all tables are right.
    """
    faults, blown = _blown(tree, folder)
    wind, places = getattr(checked, "wind", None), KINDS[kind].wind_places
    if wind is None or not wind.differs or places is None or not blown:
        return faults, blown
    from towercrane.cranes.parts.turbulence.field import field_motions

    assert checked is not None, "it has a wind"
    where, duration = places(checked), checked.run.duration
    if (ramp := rises_until(checked)) >= duration:
        hint = "unless stated three periods of the load on its rope; extremes are taken after it"
        wanted = f"a ramp shorter than run.duration, {duration:g} s"
        return [Fault("", "wind.turbulence.ramp", wanted, f"{ramp:.4g} s", hint)], {}
    return faults, field_motions(wind, blown, where, duration)


def rises_until(checked: AnyCase) -> float:
    """Time until which turbulence rises, from which on a run is evaluated [s]; zero without turbulence."""
    wind, places = getattr(checked, "wind", None), KINDS[checked.crane.kind].wind_places
    if wind is None or wind.turbulence is None or places is None:
        return 0.0
    from towercrane.cranes.parts.turbulence.field import ramp_of

    return ramp_of(wind, places(checked))


def _blown(tree: dict[str, Any], folder: Path) -> tuple[list[Fault], dict[str, Motion]]:
    """The same at the reference height, without turbulence."""
    wind = at(tree, "wind")
    if not isinstance(wind, dict):
        return [], {}
    from towercrane.cranes.parts.wind import gusts, steady

    series = wind.get("series")
    if isinstance(series, str) and series:
        try:
            return [], dict(gusts(*read_gusts(folder / series)))
        except CaseError as error:
            named = "named by wind.series of the case"
            return [replace(f, hint=f"{f.hint}; {named}" if f.hint else named) for f in error.faults], {}
    speed = si_at(tree, "wind.speed", "m/s")
    direction, upward = si_at(tree, "wind.direction", "rad", 0.0), si_at(tree, "wind.upward", "m/s", 0.0)
    if speed is None or direction is None or upward is None:
        return [], {}
    return [], dict(steady([speed * cos(direction), speed * sin(direction), upward]))


def read_gusts(path: Path) -> tuple[Floats, Floats]:
    """Times [s], shape (p,), and velocities [m/s], shape (p, 3), of a CSV file.

    Raises
    ------
    CaseError
        If it is no such series, see :func:`towercrane.schema.csv_series.read_series`.
    """
    return read_series(path, "m/s", AXES, STRONGEST, "x [km/h] meant? The header names the unit")
