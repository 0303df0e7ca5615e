"""The earthquake of a case: the ground's acceleration, and what floors do, from CSV files."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.schema.csv_series import read_series
from towercrane.schema.faults import CaseError, Fault
from towercrane.schema.ranges import at, si_at

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from towercrane.motions.motion import Motion

    Floats = NDArray[np.float64]

GROUND = ("ground_x", "ground_y", "ground_z")
"""Names of the ground's motions, as in :data:`towercrane.cranes.parts.ground.CHANNELS`."""

STRONGEST = 50.0
"""Largest plausible component of an acceleration of the ground [m/s^2]."""

FARTHEST = 5.0
"""Largest plausible displacement of a floor against the ground [m]."""


def channels_of(tree: dict[str, Any]) -> tuple[str, ...]:
    """Names of the motions of ground and floors in a case as written."""
    if not isinstance(at(tree, "earthquake"), dict):
        return ()
    floors = at(tree, "earthquake.floors")
    count = len(floors) if isinstance(floors, list) else 0
    return (*GROUND, *(f"floor_{k}_{axis}" for k in range(1, count + 1) for axis in "xy"))


def earthquake_motions(tree: dict[str, Any], folder: Path) -> tuple[list[Fault], dict[str, Motion]]:
    """Motions of ground and floors [m], none for a case at rest, and what is wrong with their files."""
    table = at(tree, "earthquake")
    if not isinstance(table, dict):
        return [], {}
    from towercrane.cranes.parts.ground import earthquake, floor

    factor, axes = si_at(tree, "earthquake.factor", "1", 1.0), table.get("axes", ["x", "y", "z"])
    if factor is None or not isinstance(axes, list):
        return [], {}
    acts = np.array([factor * (axis in axes) for axis in "xyz"])
    faults: list[Fault] = []
    motions: dict[str, Motion] = {}
    file, floors = table.get("file"), table.get("floors", [])
    if isinstance(file, str) and file:
        try:
            times, accelerations = read_accelerations(folder / file)
            # Beyond the last row of the run, at which it may still be looked at.
            until = float(times[-1]) + 1.0 + (si_at(tree, "run.duration", "s") or 0.0)
            motions |= earthquake(times, acts * accelerations, until)
        except CaseError as error:
            faults += _named(error, "earthquake.file")
    for k, name in enumerate(floors if isinstance(floors, list) else ()):
        if not isinstance(name, str):
            continue
        try:
            times, displacements = read_floor(folder / name)
            motions |= floor(k + 1, times, acts[:2] * displacements)
        except CaseError as error:
            faults += _named(error, f"earthquake.floors.{k}")
    return faults, motions


def read_accelerations(path: Path) -> tuple[Floats, Floats]:
    """Times [s], shape (p,), and accelerations [m/s^2], shape (p, 3), of a CSV file.

    Raises
    ------
    CaseError
        If it is no such series, see :func:`towercrane.schema.csv_series.read_series`.
    """
    words = {axis: (axis, f"a{axis}", f"a_{axis}", f"acceleration {axis}", f"ground {axis}") for axis in "xyz"}
    hint = "x [cm/s^2] meant? The header names the unit"
    return read_series(path, "m/s^2", words, STRONGEST, hint)


def read_floor(path: Path) -> tuple[Floats, Floats]:
    """Times [s], shape (p,), and displacements against the ground [m], shape (p, 2), of a CSV file.

    Raises
    ------
    CaseError
        As :func:`read_accelerations`.
    """
    words = {axis: (axis, f"u{axis}", f"u_{axis}", f"displacement {axis}") for axis in "xy"}
    return read_series(path, "m", words, FARTHEST, "against the ground; x [mm] meant? The header names the unit")


def _named(error: CaseError, key: str) -> list[Fault]:
    named = f"named by {key} of the case"
    return [replace(f, hint=f"{f.hint}; {named}" if f.hint else named) for f in error.faults]
