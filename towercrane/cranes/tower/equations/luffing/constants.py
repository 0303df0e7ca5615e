"""The constants of a jib that pivots."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from towercrane.cranes.tower.modes.exposures import Exposure

    Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Luffing:
    """What the equations know of a jib that pivots; n modes of the jib.

    Parameters
    ----------
    foot, frame_head, winch : ndarray, shape (2,)
        Pivot, upper end of the luffing rope, hoist winch: forward and up from the tower's top [m].
    length, attachment : float
        Of the chord, and height of the luffing rope's end above it [m].
    rope_stiffness, axial_flexibility : float
        E A of the luffing rope [N], L / E A of the jib [m/N].
    falls, reference_way : float
        Of the hoist rope: number below the jib's head, and the way from its winch at which all that the winch has
        paid out for the falls is below the head [m].
    highest_angle : float
        [rad]
    jib : ndarray, shape (3,)
        Mass, first moment and moment of inertia of the jib about its foot [kg, kg m, kg m^2].
    rest_mass : float
        Of what else turns [kg].
    rest_first : ndarray, shape (2,)
        Its first moments forward and up [kg m].
    rest_inertia : ndarray, shape (4,)
        Its moments of inertia xx, yy, zz and -sum m x z [kg m^2].
    tip_shapes, tip_slopes, middle : ndarray, shape (n,)
        Shapes of the modes at the jib's head to the left, and slopes of those up; of all at the jib's middle.
    shortening, weighted : ndarray, shape (n, n)
        Sums of slopes of either direction over the length, and with the mass beyond.
    exposure : Exposure or None
        What a wind meets, of the jib about its foot.
    """

    foot: Floats
    frame_head: Floats
    winch: Floats
    length: float
    attachment: float
    rope_stiffness: float
    axial_flexibility: float
    falls: float
    reference_way: float
    highest_angle: float
    jib: Floats
    rest_mass: float
    rest_first: Floats
    rest_inertia: Floats
    tip_shapes: Floats
    tip_slopes: Floats
    middle: Floats
    shortening: Floats
    weighted: Floats
    exposure: Exposure | None = None
