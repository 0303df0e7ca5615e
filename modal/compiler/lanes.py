"""Lane vectors: numbers of several runs side by side, one operation for all.

Compiled, an operation on a lane vector is one instruction of the processor's vector unit (or a few, where its
registers are shorter) and rounds in every lane as the same operation on a single number does. What is written for
numbers gives every lane the bits that a single run would get. In Python a lane vector is the last axis of an array.
"""

from __future__ import annotations

from typing import Any

import numpy as np

LANES = 8
"""Runs side by side; eight doubles fill a register of AVX-512."""


def in_lanes(array: Any) -> Any:
    """An array whose last axis, of length LANES, holds the lanes, as one of lane vectors over the same memory."""
    return array


def choose(where: Any, a: Any, b: Any) -> Any:
    """In every lane one value where a condition is not zero, else another; numbers count for all lanes."""
    return np.where(where, a, b)
