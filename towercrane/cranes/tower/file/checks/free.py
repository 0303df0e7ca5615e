"""What cannot be asked of a crane whose head is free to turn; as written."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from towercrane.schema.faults import Fault
from towercrane.schema.motions import FreeTurn
from towercrane.schema.ranges import at

if TYPE_CHECKING:
    from collections.abc import Iterator

    from towercrane.cranes.tower.file.case_tables import TowerCase

REFUSED = {
    "compare": "models are compared in motions that a drive prescribes",
    "verify": "--verify is for heads that are driven; choose [model] and [solver] and compare two runs",
    "shape": "a head that is free follows no motion that leaves the load at rest",
    "lift": "a load is lifted off below a head that is held",
}
"""What a crane cannot be used for whose head is free, and why."""


def refused_free(tables: TowerCase) -> dict[str, str]:
    """Uses that a checked case cannot serve, and why."""
    if not isinstance(tables.motion.slewing, FreeTurn):
        return {}
    return {use: f"the head is free to turn: {why}" for use, why in REFUSED.items()}


def check_free(tree: dict[str, Any]) -> Iterator[Fault]:
    """What a head that is free cannot go with."""
    if at(tree, "motion.slewing.shape") != "free":
        return
    for key, wanted, hint in (
        (
            "accuracy.target",
            "no error for a head that is free to turn",
            "where its brake sticks, errors are not small",
        ),
        ("crane.jib.luffing", "a jib that does not pivot where the head is free", "its drag is not known there"),
    ):
        if at(tree, key) is not None:
            yield Fault("", key, wanted, "one that is asked for" if key == "accuracy.target" else f"[{key}]", hint)
