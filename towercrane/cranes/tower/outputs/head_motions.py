"""Motion of the head of a flexible crane over time, for what is observed of a run."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from towercrane.cranes.tower.kernels.head import move_head, tilt_functions

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]


class HeadMotion(NamedTuple):
    """What :data:`towercrane.cranes.tower.kernels.head.Head` is at an instant, at many of them."""

    rotation: Floats
    """From the head's axes to the fixed ones, shape (p, 3, 3)."""
    turn_x: Floats
    """What a rate of th_x turns, in the head's axes like all that follow; shape (p, 3)."""
    turn_y: Floats
    spin: Floats
    """Angular velocity [rad/s]."""
    spin_bias: Floats
    """Angular acceleration while all rates are constant [rad/s^2]."""
    top_velocity: Floats
    """Velocity of the tower's top [m/s]."""


def head_motion(
    tilt: Floats, tilting: Floats, turn: Floats, turning: Floats, acceleration: Floats, velocity: Floats
) -> HeadMotion:
    """:func:`towercrane.cranes.tower.kernels.head.move_head` over time.

    Parameters
    ----------
    tilt, tilting, velocity : ndarray, shape (p, 2)
        Tilt vector, its rate, and velocity of the tower's top.
    turn, turning, acceleration : ndarray, shape (p,)
        Psi, its rate, and the part of its second derivative that is prescribed.
    """
    square = np.einsum("ti,ti->t", tilt, tilt)
    functions, c, s = tilt_functions(square), np.cos(turn), np.sin(turn)
    parts = move_head((*tilt.T, *tilting.T), functions, c, s, turning, acceleration, *velocity.T)
    rotation, *vectors = (np.stack(part, axis=-1) for part in parts)
    return HeadMotion(rotation.reshape(-1, 3, 3), *vectors)
