"""Restarts of the step control where the coupling of a drive meets its corner."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Corner:
    """A corner only restarts the step control.

    Which line of the coupling holds is read off the twist at every evaluation, so that a crossing that is missed or
    merely touched cannot leave the wrong one in force.

    Parameters
    ----------
    inside, outside : int
        Guards: way to the corner from within, and from beyond it.
    """

    inside: int
    outside: int

    @property
    def changes_equations(self) -> bool:
        """Never: a corner is only watched."""
        return False

    def begin(self, state: Floats, numbers: Floats, floors: Floats, guards_at: Callable[[], Floats]) -> None:
        """Watch the side that the state is on."""
        self.watch(bool(guards_at()[self.inside] >= 0.0), floors)

    def cross(
        self, guard: int, state: Floats, numbers: Floats, floors: Floats, guards_at: Callable[[], Floats]
    ) -> bool:
        """Watch the other side after a crossing; any other guard ends the run."""
        if guard not in (self.inside, self.outside):
            return False
        self.watch(guard == self.outside, floors)
        return True

    def watch(self, inside: bool, floors: Floats) -> None:
        """Watch the way out from inside, or the way back from beyond."""
        floors[self.inside] = 0.0 if inside else -np.inf
        floors[self.outside] = -np.inf if inside else 0.0
