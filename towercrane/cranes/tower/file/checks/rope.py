"""What a tower crane's rope that stretches, or slings below a hook, leave no room for."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from towercrane.cranes.parts.load import stretched
from towercrane.cranes.tower.file.plane import stays_in_plane
from towercrane.schema.faults import Fault, shown
from towercrane.schema.ranges import at

if TYPE_CHECKING:
    from collections.abc import Iterator

    from towercrane.cranes.tower.file.case_tables import TowerCase

RIGID = "it takes the rope for inextensible"

REFUSED = {"map": RIGID, "compare": RIGID, "verify": RIGID}
"""Studies that know no rope that stretches."""

IN_PLANE = f"beside exact modes in the plane {RIGID}; in space it knows the rope"


def refused(tables: TowerCase) -> dict[str, str]:
    """Uses that a checked case cannot serve, and why."""
    if not tables.rope.stretches and tables.hook is None:
        return {}
    more = {"modes": IN_PLANE} if stays_in_plane(tables) and tables.crane.jib.luffing is None else {}
    if tables.hook is not None:
        return dict.fromkeys(REFUSED | more, "the load hangs below a hook: it knows the load on its rope alone")
    return {use: f"the rope stretches: {why}" for use, why in (REFUSED | more).items()}


def check_elastic(tree: dict[str, Any]) -> Iterator[Fault]:
    """An error that is asked for of a run on an elastic rope, or with a hook and slings."""
    target = at(tree, "accuracy.target")
    if target is not None and stretched(tree):
        hint = "a rope that slackens and is caught makes small motions silent; state modes and solver.rtol instead"
        yield Fault("", "accuracy.target", "no error to ask for with an elastic rope", shown(target), hint)
    elif target is not None and at(tree, "hook") is not None:
        hint = "errors are foretold of one swing alone; state modes and solver.rtol instead"
        yield Fault("", "accuracy.target", "no error to ask for with a load below a hook", shown(target), hint)
