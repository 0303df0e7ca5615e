"""Poses of the lumped slewing cranes: lines between their points, which are all that such a crane knows of itself."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from towercrane.cranes.parts.poses import Poses, sampled
from towercrane.cranes.slewing.build import parameters_of
from towercrane.cranes.slewing.models import PLATFORM, TOWER, TOWER_X, TOWER_Y
from towercrane.cranes.slewing.outputs import point_of

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import NDArray

    from towercrane.cranes.slewing.model import LumpedModel
    from towercrane.cranes.slewing.parameters import SlewingParameters
    from towercrane.cranes.slewing.tables import SlewingCase

    Floats = NDArray[np.float64]

POINTS = 20
"""Points along the tower."""


def slewing_poses(model: LumpedModel, tables: SlewingCase, result: xr.Dataset, times: Floats) -> Poses:
    """Poses of a slewing crane.

    Jib and counter-jib are straight between the crane's points; the tower bends as the parabola of a cantilever under
    a moment, whose slope at the top is the model's tilt (Marinovic, Sprecic, Jerman 2012).

    Parameters
    ----------
    model : LumpedModel
    tables : SlewingCase
    result : xarray.Dataset
    times : ndarray, shape (f,)
        [s]

    Raises
    ------
    ValueError
        If the result lacks one of the crane's coordinates.
    """
    parameters = parameters_of(tables.crane)
    names, angles = model.crane.coordinates, model.crane.angles
    q = np.stack([sampled(result, name, times) for name in names], axis=1)
    heading = q[:, names.index(PLATFORM)]
    rigid = np.where([name in angles for name in names], heading[:, None], 0.0)
    return Poses(
        times,
        heading,
        _members(model, parameters, q),
        _members(model, parameters, rigid),
        sampled(result, "payload_position", times),
    )


def _members(model: LumpedModel, parameters: SlewingParameters, q: Floats) -> dict[str, Floats]:
    """Lines of the crane at given coordinates (f, n); shapes (f, points, 3)."""
    crane, names = model.crane, model.crane.coordinates
    points = {
        name: np.stack(np.broadcast_arrays(*point_of(body, q.T, np.zeros_like(q.T)).place), axis=1)
        for name, body in zip(crane.points, model.constants.bodies, strict=True)
    }
    bend = np.zeros(len(q), dtype=complex)
    if TOWER_X in names:
        x, y, turned = (q[:, names.index(name)] for name in (TOWER_X, TOWER_Y, TOWER))
        bend = np.exp(1j * turned) * (x + 1j * y)
    up = np.linspace(0.0, parameters.geometry_tower_height, POINTS)
    # The piece on the tower's top moves with it sideways.
    up, share = np.append(up, parameters.suspension_height), np.append((up / up[-1]) ** 2, 1.0)
    across = bend[:, None] * share
    tower = np.stack([across.real, across.imag, np.broadcast_to(up, across.shape)], axis=-1)
    tip = points[crane.suspension]
    members = {
        "tower": tower,
        "jib": np.stack([tower[:, -1], tip], axis=1),
        "suspension": tip[:, None],
    }
    if "counterweight" in points:
        members["counter-jib"] = np.stack([tower[:, -1], points["counterweight"]], axis=1)
        members["ballast"] = points["counterweight"][:, None]
    return members
