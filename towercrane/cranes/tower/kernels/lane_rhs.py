"""Compiled right-hand side of the crane in radial motion for lane vectors: the same equations for several runs."""

from __future__ import annotations

from modal.compiler.compiled import kernel
from towercrane.cranes.tower.kernels import rhs as flexible_rhs
from towercrane.kernels.arrays import lane_rhs_signature

rhs = kernel(lane_rhs_signature())(flexible_rhs.rhs.py_func)
