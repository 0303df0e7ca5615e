"""Compiled right-hand side of the crane in radial motion for lane vectors: the same equations for several runs."""

from __future__ import annotations

from modal.compiled import kernel
from towercrane.cranes import flexible_rhs
from towercrane.lane_arrays import lane_rhs_signature

rhs = kernel(lane_rhs_signature())(flexible_rhs.rhs.py_func)
