"""The constants of a cat-head with tie bars."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from towercrane.cranes.tower.modes.tied.head import FieldSums

    Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Tied:
    """What the equations know of tie bars; n coordinates of what is on the head, t ties.

    Parameters
    ----------
    ahead : int
        How many ties hold the jib: the first.
    sags : int
        Where the sags of the ties begin, the last coordinates but for their bows to the left.
    fields : FieldSums
        All that turns, without trolley.
    spans : ndarray, shape (t, 2)
        From the cat-head's top to the end of each straight tie: forward and up [m].
    ends : ndarray, shape (t, n, 3)
        What each coordinate moves the lower end against the upper one.
    along, across : ndarray, shape (t, n, n)
        Second derivatives of the same forward and up.
    lengths, reference, pretension, slack : ndarray, shape (t,)
        Length of each straight tie [m], its length and tension under the crane's own weight [m, N], and what it gives
        per sag that is added there [1].
    stiffness : ndarray, shape (t, t)
        Tension of each per lengthening of each [N/m].
    """

    ahead: int
    sags: int
    fields: FieldSums
    spans: Floats
    ends: Floats
    along: Floats
    across: Floats
    lengths: Floats
    reference: Floats
    pretension: Floats
    slack: Floats
    stiffness: Floats

    @property
    def count(self) -> int:
        """Number of ties."""
        return len(self.lengths)
