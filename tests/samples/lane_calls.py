"""Right-hand sides of lanes, called for one state in each."""

from numba import types

from modal.compiler.compiled import kernel
from towercrane.kernels.arrays import in_lanes, lane_rhs_signature

_two, _three = types.float64[:, ::1], types.float64[:, :, ::1]


@kernel(python_entry=(types.FunctionType(lane_rhs_signature()), _two, _two, _two, _three, _two, _three, _two))
def call_in_lanes(rhs, t, y, dy, inputs, numbers, tables, guards):
    """Write dy and guards; every array but the tables has the lanes as its last axis, times the shape (1, lanes)."""
    rhs(
        in_lanes(t)[0],
        in_lanes(y),
        in_lanes(dy),
        in_lanes(inputs),
        in_lanes(numbers),
        tables,
        in_lanes(guards),
    )
