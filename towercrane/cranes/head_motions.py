"""Compiled motion of the head of a flexible crane over time, for what is observed of a run."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import types

from modal.compiled import kernel
from towercrane.cranes.head_kernel import move_head, tilt_functions

ROTATION, TURN_X, TURN_Y, SPIN, SPIN_BIAS, TOP_VELOCITY, SIZE = 0, 9, 12, 15, 18, 21, 24
"""Where these begin in a row of :func:`move_heads`, and how many numbers they are."""


@kernel(types.void(types.float64[:, ::1], types.float64[:, ::1]))
def move_heads(motions: Any, heads: Any) -> None:
    """:func:`move_head` over time, for each row of ``heads`` (p, SIZE).

    A row of motions holds tilt vector and rate, Psi, its rate and prescribed acceleration, and the top's velocity.
    """
    for row in range(motions.shape[0]):
        tilt = motions[row, 0], motions[row, 1], motions[row, 2], motions[row, 3]
        functions = tilt_functions(tilt[0] * tilt[0] + tilt[1] * tilt[1])
        rotation, turn_x, turn_y, spin, bias, top = move_head(
            tilt, functions, np.cos(motions[row, 4]), np.sin(motions[row, 4]), motions[row, 5], motions[row, 6],
            motions[row, 7], motions[row, 8],
        )  # fmt: skip
        for k in range(9):
            heads[row, ROTATION + k] = rotation[k]
        for k in range(3):
            heads[row, TURN_X + k] = turn_x[k]
            heads[row, TURN_Y + k] = turn_y[k]
            heads[row, SPIN + k] = spin[k]
            heads[row, SPIN_BIAS + k] = bias[k]
            heads[row, TOP_VELOCITY + k] = top[k]
