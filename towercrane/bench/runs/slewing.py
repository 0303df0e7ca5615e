"""Benchmark of the slewing cranes' right-hand sides."""

from __future__ import annotations

from typing import Any

from towercrane.bench.evaluations import Instant, evaluations
from towercrane.bench.scenes.prepared import lumped_scene
from towercrane.cranes.slewing.kind import SLEWING


def right_hand_sides(repeats: int) -> dict[str, Any]:
    """One evaluation of each slewing model's right-hand side."""
    scenes = {kind.name: lumped_scene(kind.name) for kind in SLEWING}
    models = {kind: Instant(scene.system, scene.cut, scene.start, 0.1) for kind, scene in scenes.items()}
    return evaluations("slewing-rhs", "Right-hand side of the slewing cranes", models, repeats)
