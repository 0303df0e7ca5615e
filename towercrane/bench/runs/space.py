"""Benchmark of the crane in space: its right-hand side with more and more modes."""

from __future__ import annotations

from typing import Any

from towercrane.bench.evaluations import Instant, evaluations
from towercrane.bench.scenes.prepared import SPACE
from towercrane.cases.case import load_case
from towercrane.cases.models import motions_of
from towercrane.cranes.parts.load import load_of
from towercrane.cranes.tower.file.build import crane_of
from towercrane.cranes.tower.file.case_tables import TowerCase
from towercrane.cranes.tower.model import FlexibleModel
from towercrane.cranes.tower.modes.modal_crane import flexible_crane
from towercrane.cranes.tower.modes.mode_counts import ModeCounts
from towercrane.motions.motion import phases

EVALUATIONS = 20_000
"""Right-hand sides in one measurement."""

AT = 6.0
"""Time at which they are taken [s]: slewing drive and trolley at speed, the hoist accelerates."""

MODELS = (
    ("0+0+0 / 0+0", ModeCounts(0, 0, 0, 0), 2),
    ("2+0+0 / 0+3, not slewing", ModeCounts(2, 0, 0, 3), 1),
    ("1+1+1 / 1+1", ModeCounts(1, 1, 1, 1), 2),
    ("2+2+1 / 3+3", ModeCounts(2, 1, 3, 3), 2),
)
"""Name, modes, and planes in which the tower bends; a tower that bends in one carries a jib that does not slew."""


def space_right_hand_sides(repeats: int) -> dict[str, Any]:
    """One evaluation of the right-hand side in space."""
    case = load_case(SPACE)
    written = crane_of(case.tables(TowerCase))
    models = {}
    for name, counts, planes in MODELS:
        crane = flexible_crane(written, counts, planes=planes)
        model = FlexibleModel(crane, load_of(case.payload), slewing="prescribed" if planes == 2 else "fixed")
        cut = phases(tuple(motions_of(case)[channel] for channel in model.channels), case.run.duration)
        models[name] = Instant(model.system, cut, model.start(cut.inputs[0]), AT)
    found = evaluations("space-rhs", "Right-hand side of the crane in space", models, repeats)
    return {**found, "columns": ["modes: tower x+y+torsion / jib lateral+vertical", *found["columns"][1:]]}
