"""The constants of a cat-head with tie bars and of what they hold."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Fields:
    """Mass of points at s0 + sum psi_i q_i in the axes of a head, summed; n coordinates.

    Parameters
    ----------
    mass : float
        [kg]
    first : ndarray, shape (3,)
        int s0.
    inertia : ndarray, shape (3, 3)
        Tensor of inertia at s0, with that of sections about their own axes.
    momentum : ndarray, shape (n, 3)
        int psi_i.
    moved : ndarray, shape (n, 3, 3)
        int psi_i s0^T.
    products : ndarray, shape (n, n, 3, 3)
        int psi_i psi_j^T.
    spun : ndarray, shape (n, 3)
        Moment of momentum of sections that turn about their own axes.
    """

    mass: float
    first: Floats
    inertia: Floats
    momentum: Floats
    moved: Floats
    products: Floats
    spun: Floats


@dataclass(frozen=True, eq=False)
class Tied:
    """What the equations know of tie bars; n coordinates of what is on the head, t ties.

    Parameters
    ----------
    ahead : int
        How many ties hold the jib: the first.
    sags : int
        Where the sags of the ties begin, the last coordinates but for their bows to the left.
    fields : Fields
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
    fields: Fields
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
