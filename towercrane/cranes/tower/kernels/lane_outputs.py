"""Compiled outputs of a crane in its jib's plane for lane vectors: the same for several runs."""

from __future__ import annotations

from typing import Any

import numpy as np

from modal.compiler.compiled import kernel
from towercrane.cranes.tower.kernels import layout
from towercrane.kernels.arrays import lane_observer_signature
from towercrane.kernels.vector import LANES

TOWER_TIP, JIB_TIP, SWING, TENSION = range(4)
"""Outputs: the two linear ones, then swing angle and rope tension."""


@kernel(lane_observer_signature())
def observe(states: Any, lane_states: Any, guards: Any, watched: Any, outputs: Any, lane_outputs: Any) -> None:
    """Outputs of every lane in these states."""
    n = watched.shape[1]
    for output in (TOWER_TIP, JIB_TIP):
        value = guards[0] * 0.0
        for i in range(n):
            value += watched[output, i] * states[i]
        outputs[output] = value
    outputs[TENSION] = guards[layout.TENSION]
    for lane in range(LANES):
        lane_outputs[SWING, lane] = np.arctan2(lane_states[n, lane], -lane_states[n + 1, lane])
