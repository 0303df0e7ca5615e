"""Types of right-hand sides, and arrays of lane vectors: their types, and arrays of numbers seen as such."""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic
from numba.np.arrayobj import make_array, populate_array

from towercrane.kernels.vector import LANES, TABLE, VECTOR

_intrinsic: Any = intrinsic


def rhs_signature() -> Any:
    """Numba signature of every right-hand side, so that one compiled integrator serves all models.

    ``rhs(t, y, dy, inputs, numbers, tables, guards)``: t is the time since the phase began [s]; inputs holds the
    polynomials of that phase, one row per channel; numbers and tables are the model's constants, the numbers followed
    by what is worked out from them; dy and guards are written.
    """
    one, two, three = types.float64[::1], types.float64[:, ::1], types.float64[:, :, ::1]
    return types.void(types.float64, one, one, two, one, three, one)


def lane_rhs_signature() -> Any:
    """:func:`rhs_signature` for lane vectors; the tables are the same for all lanes."""
    one, two = (lane_array(axes) for axes in (1, 2))
    return types.void(VECTOR, one, one, two, one, TABLE, one)


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
