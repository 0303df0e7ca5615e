"""Compiled structure of the overhead crane: a bridge that bends, a trolley on it.

The bridge is a girder on two simple supports that bends in its first natural shape, y from the first rail and S the
span: uplift q sin(pi y / S). With E I and the mass per length mu its energies give q the stiffness pi^4 E I / (2 S^3)
and the mass mu S / 2, and the bare girder its first natural frequency exactly (S. Timoshenko, Vibration Problems in
Engineering, on lateral vibration of bars with hinged ends; loads that move along a bridge are treated there in the
same way). For a force at mid-span that is 48.70 E I / S^3 beside the static 48; the static shape has 17/35 = 0.486 of
the girder's mass beside this 0.5. A trolley away from mid-span finds the girder stiffer than it is: at a quarter of
the span by 14 %.

Bridge and trolley follow their motions; what their drives must do for it is read off. The load is not in this file:
:func:`towercrane.kernels.payload.hang_load` adds it. Axes are fixed: x along the runway, y along the bridge, z up.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import types

from modal.compiler.compiled import kernel
from towercrane.kernels.payload import (
    ACCELERATION,
    BIAS,
    DIRECTION,
    FORCE,
    HINGE,
    JACOBIAN,
    MASS,
    VELOCITY,
    hang_load,
)
from towercrane.kernels.polynomial import polynomial
from towercrane.simulation.system import rhs_signature

(SPAN, STIFFNESS, DAMPING, GIRDER_MASS, CARRIAGE_MASS, TROLLEY_MASS, GRAVITY, LOAD_MASS, DRAG,
 HINGE_DAMPING) = range(10)  # fmt: skip
"""Entries of ``numbers``. STIFFNESS and DAMPING are those of the uplift at mid-span, masses those of whole parts."""

BRIDGE, TROLLEY, ROPE = range(3)
"""Rows of ``inputs``."""

TENSION, BRIDGE_FORCE, TROLLEY_FORCE, FIRST_RAIL, SECOND_RAIL = range(5)
"""Guards: rope tension; forces of both drives and of the bridge on each rail, only recorded [N]."""

UPLIFT, ROPE_DIRECTION, RATE, SWAY, WORK, SIZE = 0, 1, 4, 5, 8, 9
"""Where the parts of a state begin, and its size."""

AXES = 3

_one, _two = types.float64[::1], types.float64[:, ::1]


@kernel(types.float64(types.float64, _one, _two, _one, _two))
def structure(t: float, y: Any, inputs: Any, numbers: Any, work: Any) -> float:
    """Fill ``work`` with mass, force and the suspension point's motion.

    Parameters
    ----------
    t, y, inputs, numbers, work
        As in :func:`towercrane.simulation.system.rhs_signature`.

    Returns
    -------
    float
        Slope of the girder under the trolley.
    """
    _, along, along_more = polynomial(inputs, BRIDGE, t)
    place, across, across_more = polynomial(inputs, TROLLEY, t)
    wave = np.pi / numbers[SPAN]
    shape, tilt = np.sin(wave * place), wave * np.cos(wave * place)
    q, rate = y[UPLIFT], y[RATE]
    trolley, girder, gravity = numbers[TROLLEY_MASS], numbers[GIRDER_MASS], numbers[GRAVITY]

    work[VELOCITY, 0], work[VELOCITY, 1] = along, across
    work[VELOCITY, 2] = shape * rate + tilt * across * q
    work[BIAS, 0], work[BIAS, 1] = along_more, across_more
    work[BIAS, 2] = 2.0 * tilt * across * rate + (tilt * across_more - wave * wave * shape * across * across) * q
    work[JACOBIAN, 0] = work[JACOBIAN + 1, 0] = 0.0
    work[JACOBIAN + 2, 0] = shape
    work[MASS, 0] = 0.5 * girder + trolley * shape * shape
    work[FORCE, 0] = (
        -numbers[STIFFNESS] * q
        - numbers[DAMPING] * rate
        - 2.0 / np.pi * girder * gravity
        - trolley * shape * (gravity + work[BIAS, 2])
    )
    return tilt * q


@kernel(rhs_signature(), at_once=False)
def rhs(
    t: float,
    y: Any,
    dy: Any,
    inputs: Any,
    numbers: Any,
    vectors: Any,
    matrices: Any,
    tables: Any,
    work: Any,
    guards: Any,
) -> None:
    """Right-hand side; y = (q, n, q', p, work)."""
    slope = structure(t, y, inputs, numbers, work)
    length, rate, acceleration = polynomial(inputs, ROPE, t)
    tension = hang_load(
        y, dy, 1, AXES, length, rate, acceleration,
        numbers[LOAD_MASS], numbers[GRAVITY], numbers[DRAG], numbers[HINGE_DAMPING], 0.0, 0.0, work,
    )  # fmt: skip
    trolley, girder, carriages = numbers[TROLLEY_MASS], numbers[GIRDER_MASS], numbers[CARRIAGE_MASS]
    gravity = numbers[GRAVITY]
    # What bridge and trolley must push with: inertia less the pull of rope and hinge.
    along = trolley * work[ACCELERATION, 0] - tension * work[DIRECTION, 0] + work[HINGE, 0]
    across = trolley * work[ACCELERATION, 1] - tension * work[DIRECTION, 1] + work[HINGE, 1]
    down = trolley * (work[ACCELERATION, 2] + gravity) - tension * work[DIRECTION, 2] + work[HINGE, 2]
    along += (girder + carriages) * work[ACCELERATION, 0]
    across += slope * down
    dy[WORK] += along * work[VELOCITY, 0] + across * work[VELOCITY, 1] - numbers[DAMPING] * y[RATE] * y[RATE]
    place, _, _ = polynomial(inputs, TROLLEY, t)
    # By moments about the rails; the girder's inertia and weight are even about mid-span.
    end = 0.5 * (girder + carriages) * gravity + girder * dy[RATE] / np.pi
    share = place / numbers[SPAN]
    guards[TENSION] = tension
    guards[BRIDGE_FORCE], guards[TROLLEY_FORCE] = along, across
    guards[FIRST_RAIL], guards[SECOND_RAIL] = end + (1.0 - share) * down, end + share * down
