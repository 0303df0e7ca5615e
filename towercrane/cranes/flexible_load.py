"""Compiles the flexible crane's load ahead of its other equations, in a process that imports this."""

from __future__ import annotations

from numba import types

from towercrane.payload import hang_load

_state, _whole, _number = types.float64[::1], types.int64, types.float64

hang_load.compile((_state, _state, _whole, _whole, *[_number] * 9, types.float64[:, ::1]))
