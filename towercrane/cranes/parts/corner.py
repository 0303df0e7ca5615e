"""Restarts of the step control where forces bend: the coupling of a drive, a tower that meets a collar with play."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Corners:
    """Corners only restart the step control.

    Which line holds is read off the state at every evaluation, so that a crossing that is missed or merely touched
    cannot leave the wrong one in force.

    Parameters
    ----------
    guards : tuple of (int, int)
        Of each corner: way to it from within, and from beyond it.
    """

    guards: tuple[tuple[int, int], ...]

    @property
    def changes_equations(self) -> bool:
        """Never: corners are only watched."""
        return False

    def begin(self, state: Floats, numbers: Floats, floors: Floats, guards_at: Callable[[], Floats]) -> None:
        """Watch the sides that the state is on."""
        found = guards_at()
        for corner in self.guards:
            watch(corner, bool(found[corner[0]] >= 0.0), floors)

    def cross(
        self, guard: int, state: Floats, numbers: Floats, floors: Floats, guards_at: Callable[[], Floats]
    ) -> bool:
        """Watch the other side after a crossing; any other guard ends the run."""
        for corner in self.guards:
            if guard in corner:
                watch(corner, guard == corner[1], floors)
                return True
        return False


def watch(corner: tuple[int, int], inside: bool, floors: Floats) -> None:
    """Watch the way out from inside, or the way back from beyond."""
    floors[corner[0]] = 0.0 if inside else -np.inf
    floors[corner[1]] = -np.inf if inside else 0.0
