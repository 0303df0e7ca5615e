"""Where a crane's members and its load are at the times of a film: one description for every kind of crane."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from towercrane.results.result_file import entries

if TYPE_CHECKING:
    from collections.abc import Mapping

    import xarray as xr
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

ROUND = tuple(factor * 10.0**power for power in range(5) for factor in (1.0, 2.0, 5.0))
"""Numbers that a reader divides by at sight: 1, 2, 5, 10, ..."""

SHOWN = 0.2
"""Largest deformation that is drawn unasked, of the crane's size."""


@dataclass(frozen=True, eq=False)
class Poses:
    """A crane and its load at each of f times, in fixed axes from the tower's foot: x, y, up [m].

    Parameters
    ----------
    times : ndarray, shape (f,)
        [s]
    heading : ndarray, shape (f,)
        Angle about the vertical to which the drives have turned the crane [rad].
    members : mapping of str to ndarray, shapes (f, points, 3)
        Lines of the deformed crane by name, and points: the one that the rope hangs from, "suspension", and where
        there are any, those where sections of the jib meet, "joints", where weights balance it, "ballast", and where
        floors at rest hold the tower, "collars".
    undeformed : mapping of str to ndarray
        The same without any deformation, its drives where they are at that time.
    load : ndarray, shape (f, 3)
    hook : ndarray, shape (f, 3), optional
        What the load hangs below, on slings.
    """

    times: Floats
    heading: Floats
    members: Mapping[str, Floats]
    undeformed: Mapping[str, Floats]
    load: Floats
    hook: Floats | None = None

    @property
    def hanging(self) -> Floats:
        """What hangs on the rope from above, the load the last; shape (f, bodies, 3)."""
        return np.stack([self.load] if self.hook is None else [self.hook, self.load], axis=1)

    def below_hook(self, result: xr.Dataset) -> Poses:
        """The same with the hook of a result that has one."""
        if "hook_position" not in result:
            return self
        hook, load = (sampled(result, name, self.times) for name in ("hook_position", "payload_position"))
        return replace(self, hook=self.load + (hook - load))

    def magnified(self, factor: float) -> dict[str, Floats]:
        """Members whose points are so many times as far from their undeformed places as they really are."""
        return {name: still + factor * (self.members[name] - still) for name, still in self.undeformed.items()}

    @cached_property
    def deformation(self) -> float:
        """Largest distance of a point from its undeformed place [m]."""
        moved = (np.linalg.norm(line - self.undeformed[name], axis=-1).max() for name, line in self.members.items())
        return float(max(moved))

    @property
    def size(self) -> float:
        """Height of the undeformed crane or its reach about its foot, whichever is larger [m]."""
        points = np.concatenate([line.reshape(-1, 3) for line in self.undeformed.values()])
        return float(max(np.hypot(points[:, 0], points[:, 1]).max(), points[:, 2].max()))

    @property
    def planar(self) -> bool:
        """Whether nothing ever leaves the plane of x and the vertical."""
        lines = [*self.members.values(), self.hanging]
        return max(float(abs(line[..., 1]).max()) for line in lines) == 0.0

    def fitting_magnification(self) -> float:
        """Largest of 1, 2, 5, 10, ... that draws no deformation larger than `SHOWN` of the crane; 1 if all do."""
        if self.deformation == 0.0:
            return 1.0
        return max((factor for factor in ROUND if factor * self.deformation <= SHOWN * self.size), default=1.0)

    def turned_back(self, points: Floats) -> Floats:
        """Points seen by somebody who turns with the drives: along the heading, across it, up; shapes (f, ..., 3)."""
        heading = self.heading.reshape(-1, *[1] * (points.ndim - 2))
        c, s = np.cos(heading), np.sin(heading)
        x, y, z = np.moveaxis(points, -1, 0)
        return np.stack([c * x + s * y, c * y - s * x, z], axis=-1)


def sampled(result: xr.Dataset, name: str, times: Floats) -> Floats:
    """A variable of a result at any times within it, linear between its rows; shape (f, ...).

    Raises
    ------
    ValueError
        If the result has no such variable, or one of another shape.
    """
    rows, values = result["time"].values, entries(result, name)
    found = np.empty((len(times), *values.shape[1:]))
    for entry in np.ndindex(values.shape[1:]):
        found[:, *entry] = np.interp(times, rows, values[:, *entry])
    return found


"""Numbers that a reader divides by at sight: 1, 2, 5, 10, ..."""
