"""Arrays of lane vectors: their types, and arrays of numbers seen as such."""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic
from numba.np.arrayobj import make_array, populate_array

from towercrane.kernels.vector import LANES, TABLE, VECTOR

_intrinsic: Any = intrinsic


def lane_rhs_signature() -> Any:
    """Numba signature of right-hand sides written out for lane vectors.

    ``rhs(t, y, dy, inputs, numbers, tables, guards)``, as :func:`towercrane.simulation.system.rhs_signature` has
    them; the tables are the same for all lanes.
    """
    one, two = (lane_array(axes) for axes in (1, 2))
    return types.void(VECTOR, one, one, two, one, TABLE, one)


def lane_observer_signature() -> Any:
    """Numba signature of what turns states and guards of lanes into outputs.

    ``observe(states, lane_states, guards, watched, outputs, lane_outputs)``: states and outputs once as lane vectors
    and once as numbers of shape (..., lanes); ``watched`` (linear outputs, coordinates) is each run's own.
    """
    one, numbers = lane_array(1), types.float64[:, ::1]
    return types.void(one, numbers, one, lane_array(2), one, numbers)


def lane_array(axes: int) -> Any:
    """Type of an array of lane vectors, see :func:`in_lanes`."""
    # Without a claim of alignment: numpy promises 16 bytes, a register would want 64.
    return types.Array(VECTOR, axes, "C", aligned=False)


def _view(context: Any, builder: Any, source: Any, kind: Any, axes: int, itemsize: Any) -> Any:
    """Array over the first axes of another's memory, which it does not own.

    Counting owners at every call of a small function would take a quarter of the time of the steps.
    """
    target = make_array(kind)(context, builder)
    populate_array(
        target,
        data=builder.bitcast(source.data, target.data.type),
        shape=cgutils.unpack_tuple(builder, source.shape)[:axes],
        strides=cgutils.unpack_tuple(builder, source.strides)[:axes],
        itemsize=itemsize,
        meminfo=None,
    )
    return target._getvalue()


@_intrinsic
def in_lanes(_context: Any, array: Any) -> Any:
    """The same memory with its last axis, of length LANES, as lane vectors; the caller keeps the array."""
    kind = lane_array(array.ndim - 1)

    def build(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        source = make_array(signature.args[0])(context, builder, arguments[0])
        itemsize = ir.Constant(ir.IntType(64), 8 * LANES)
        return _view(context, builder, source, kind, array.ndim - 1, itemsize)

    return kind(array), build


@_intrinsic
def borrowed(_context: Any, array: Any) -> Any:
    """The same array for functions that are called often; the caller keeps it."""

    def build(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        source = make_array(signature.args[0])(context, builder, arguments[0])
        return _view(context, builder, source, array, array.ndim, source.itemsize)

    return array(array), build
