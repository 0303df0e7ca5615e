"""Poses of a case's run, for every kind of crane."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from towercrane.cases.models import SLEWING

if TYPE_CHECKING:
    import numpy as np
    import xarray as xr
    from numpy.typing import NDArray

    from towercrane.cases.case import Case
    from towercrane.cranes.parts.poses import Poses

    Floats = NDArray[np.float64]


def poses_of(case: Case, result: xr.Dataset, times: Floats) -> Poses:
    """Poses of a run at any times within it.

    Between two rows of the result its coordinates are interpolated linearly; on a row they are the row's.

    Parameters
    ----------
    case : Case
        What was run.
    result : xarray.Dataset
    times : ndarray, shape (f,)
        [s]

    Raises
    ------
    ValueError
        If the result does not hold what the case's kind of crane needs.
    """
    poses: Any
    if case.kind in SLEWING:
        from towercrane.cranes.slewing.poses import slewing_poses as poses
    elif case.kind == "jib":
        from towercrane.cranes.jib.poses import jib_poses as poses
    elif case.kind == "space":
        from towercrane.cranes.tower.poses import space_poses as poses
    else:
        from towercrane.cranes.tower.poses import radial_poses as poses
    found: Poses = poses(case.checked, result, times)
    return found
