"""Pictures of a case's run and modes, as its kind of crane has them."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from towercrane.cases.case import Case
    from towercrane.simulation.run import Run


def run_pictures(case: Case, run: Run) -> dict[str, Any]:
    """Pictures of a run by the names of their files."""
    from towercrane.cranes.registry import KINDS
    from towercrane.report.plots.runs import panels

    kind, result = KINDS[case.kind], run.dataset()
    if isinstance(kind.pictures, str):
        drawn = dict(import_module(f"towercrane.report.plots.runs.{kind.pictures}").run_pictures(result))
    else:
        drawn = panels.run_pictures(result, kind.pictures)
    # Every crane does something to its base.
    drawn = panels.over_times(result, panels.BASE) | drawn
    if "members" not in kind.serves or kind.refusal("members", case.checked):
        return drawn
    return {**drawn, "modes.png": mode_picture(case, run.model)}


def mode_picture(case: Case, model: Any) -> Any:
    """Modes of a plane crane's tower and jibs."""
    from towercrane.cases.assumptions import as_notes, rests_on
    from towercrane.cranes.tower.file.case_tables import TowerCase
    from towercrane.report.plots.runs import plane

    crane, count = model.crane.written, case.tables(TowerCase).modes.count
    notes = as_notes(a for a in rests_on(case) if a.key.startswith("crane."))
    return plane.modes(crane.tower_modes(count), crane.jib_modes(count), notes, crane.counter_jib_modes(count))
