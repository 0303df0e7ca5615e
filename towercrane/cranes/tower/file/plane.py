"""Whether a scene stays in the jib's vertical plane: it follows from what the case drives and what blows on it."""

from __future__ import annotations

from math import sin
from typing import TYPE_CHECKING, Any, NamedTuple

from towercrane.schema.ranges import at, si, si_at

if TYPE_CHECKING:
    from towercrane.cranes.tower.file.case_tables import TowerCase

TURNS = ("slewing", "shaft")
"""Motions that turn the head."""

ALONG = 1e-12
"""Sine of a wind's direction that is along the jib but for rounding."""


class _Turn(NamedTuple):
    """How a joint turns: shape, and the angles [rad] from and to which where the shape has them."""

    shape: str
    start: float | None
    end: float | None

    @property
    def moves(self) -> bool:
        """Whether it leaves the angle zero."""
        return self.start != 0.0 or (self.shape != "rest" and self.end != 0.0)


def stays_in_plane(tables: TowerCase) -> bool:
    """Whether nothing drives or blows crane and load out of the plane in which the jib stands, along x.

    The head neither turns nor stands turned, and the wind, if any, is steady and blows along the jib.
    """
    turns = [turn for name in TURNS if (turn := getattr(tables.motion, name)) is not None]
    if any(_Turn(t.shape, getattr(t, "start", None), getattr(t, "end", None)).moves for t in turns):
        return False
    return tables.wind is None or _along(tables.wind.series, tables.wind.direction)


def written_in_plane(tree: dict[str, Any]) -> bool:
    """The same of a case as written; what cannot be read moves out of it."""
    for name in TURNS:
        turn = at(tree, f"motion.{name}")
        if isinstance(turn, dict):
            start = si(turn["start"], "rad") if "start" in turn else 0.0
            if _Turn(str(turn.get("shape")), start, si_at(turn, "end", "rad")).moves:
                return False
    wind = at(tree, "wind")
    return not isinstance(wind, dict) or _along(wind.get("series"), si_at(wind, "direction", "rad", 0.0))


def _along(series: object, direction: float | None) -> bool:
    return not series and direction is not None and abs(sin(direction)) <= ALONG
