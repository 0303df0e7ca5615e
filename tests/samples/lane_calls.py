"""Right-hand sides of lanes, called for one state in each."""

from modal.compiler.kinds import LaneRow, LaneTable, Procedure, Stack
from modal.compiler.native import native


def _call_in_lanes(
    rhs: Procedure, t: LaneRow, y: LaneRow, dy: LaneRow, inputs: LaneTable, numbers: LaneRow, tables: Stack,
    guards: LaneRow,
) -> None:  # fmt: skip
    """Write dy and guards; every array but the tables has the lanes as its last axis, times the shape (1, lanes)."""
    rhs(t[0], y, dy, inputs, numbers, tables, guards)


(call_in_lanes,) = native("lane_calls", _call_in_lanes)
