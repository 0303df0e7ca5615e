"""A run: what it recorded, with the model and the motions that were built for it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from towercrane.results.recording import Recording

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from towercrane.motions.motion import Motion
    from towercrane.simulation.system import Model


@dataclass(frozen=True, eq=False, kw_only=True)
class Run(Recording):
    """A recording that hands on what it was computed from: who asks more of the crane builds none of it again.

    Parameters
    ----------
    model : Model
    motions : dict of str to Motion
        What drove it, by channel.
    states : ndarray, shape (times, size)
        Those that the solver had at the looks.
    switches : Recording or None
        The same quantities right after each switch of its equations, if there was one.
    """

    model: Model
    motions: dict[str, Motion]
    states: NDArray[np.float64]
    switches: Recording | None = None
