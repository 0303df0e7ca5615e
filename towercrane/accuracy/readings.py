"""What a crane's outputs read off its coordinates in small motions."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from towercrane.cranes.tower.targets import MOTIONS
from towercrane.motions.motion import Motion
from towercrane.results.measures import PLACE

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from towercrane.cranes.tower.model import FlexibleModel

    Floats = NDArray[np.float64]

SMALL = 1e-4
"""Departure of a coordinate over its scale in the state, from which a reading is told."""

ROUNDING = 1e-9
"""Part of the largest, below which a number is rounding."""


def components(outputs: Iterable[str]) -> tuple[dict[str, list[int]], NDArray[np.bool_]]:
    """Rows of the readings by output, and which of them are of forces, which follow accelerations and no place."""
    found: dict[str, list[int]] = {}
    forces: list[bool] = []
    for name in outputs:
        size = 3 if name == PLACE else 1
        found[name] = list(range(len(forces), len(forces) + size))
        forces += size * [name not in MOTIONS]
    if "base_moment_x" in found:
        # About fixed axes: a head that turns makes one of the other.
        both = found["base_moment_x"] + found["base_moment_y"]
        found |= {"base_moment_x": both, "base_moment_y": both}
    return found, np.array(forces)


def held(model: FlexibleModel, outputs: Iterable[str], drives: Floats, read: Floats) -> Floats:
    """Readings of a crane that is held where it is, from those of `readings`: no force but the trolley's.

    That is the weight's part along the jib, which is as steep as it and the tower's top are bent.
    """
    crane, a = model.crane, model.parts["tower_x"].stop
    rows, forces = components(outputs)
    found = np.where(forces[:, None], 0.0, read)
    if "trolley_force" in rows:
        steep = np.zeros((len(drives), read.shape[2]))
        steep[:, :a], steep[:, model.parts["jib_vertical"]] = -crane.top_slope, crane.vertical(drives[:, 0], 1).T
        found[:, rows["trolley_force"][0]] = crane.gravity * (crane.trolley_mass + model.load.mass) * steep
    return found


def readings(model: FlexibleModel, outputs: Iterable[str], drives: Floats) -> Floats:
    """Outputs per coordinate about the undeformed crane at some places of its drives.

    Parameters
    ----------
    model : FlexibleModel
    outputs : iterable of str
    drives : ndarray, shape (p, channels)
        The second is the rope's length.

    Returns
    -------
    ndarray, shape (p, components, coordinates + axes - 1)
        The last are over the load's way from the point it hangs from [m].
    """
    n, axes, count = model.coordinates, model.axes, len(drives)
    step = SMALL * np.append(model.system.scale[:n], np.ones(axes - 1))
    states = np.zeros((count, 1 + len(step), model.size))
    slopes, guards = np.zeros_like(states), np.zeros((count, 1 + len(step), len(model.system.guards)))
    states[:, :, n + axes - 1] = -1.0
    vector = np.arange(len(step))
    # The rope's direction follows the coordinates in a state.
    states[:, 1 + vector, vector] = step
    states[:, 1 + n :, n : n + axes - 1] /= drives[:, 1, None, None]
    for place, values in enumerate(drives):
        inputs = np.column_stack([values, np.zeros((len(values), 2))])
        for row, state in enumerate(states[place]):
            slopes[place, row], guards[place, row] = model.system.slope(0.0, state, inputs)
    # One time for every state, at which the drives rest at its place.
    resting = {
        name: Motion(np.arange(count + 1.0), values[:, None])
        for name, values in zip(model.channels, drives.T, strict=True)
    }
    times = np.repeat(np.arange(count) + 0.5, 1 + len(step))
    rows = (array.reshape(len(times), -1) for array in (states, slopes, guards))
    seen = model.observe(resting, times, *rows)
    found = []
    for name in outputs:
        values = seen[name].values.reshape(count, 1 + len(step), -1)
        change = values[:, 1:] - values[:, :1]
        change[abs(change) < ROUNDING * abs(values).max()] = 0.0
        found.append((change / step[:, None]).transpose(0, 2, 1))
    return np.concatenate(found, axis=1)
