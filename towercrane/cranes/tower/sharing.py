"""What runs of tower cranes that differ in little have in common."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from towercrane.cranes.tower.file.case_tables import TowerCase
    from towercrane.cranes.tower.model import FlexibleModel


def made_of(model: FlexibleModel) -> str:
    """Text that is equal for models which differ in their load alone."""
    # Written out, floats to the last digit: equal text is equal data.
    coordinates = model.crane.written, model.counts, model.axes, model.heading, model.slewing, model.drive_inertia
    losses = model.damping, model.cap, model.wind, model.ground, model.floors
    said = model.weight_softening, model.self_weight, model.rope_as_rod, model.load.release is None, model.cuts.asked
    return repr((*coordinates, *losses, *said, len(model.load.slings)))


def plain(tables: TowerCase) -> bool:
    """Whether another load, and another rope that rests, change nothing else of a run."""
    # A hauled rope begins its motion at its length; what a tolerance of frequencies leaves out hangs on the load, and
    # so does what lets go of it.
    differs = tables.rope.stretches or tables.release is not None
    # A light hook's mass hangs on the load's.
    return tables.hook is None and tables.motion.hoist is None and tables.accuracy.frequency is None and not differs
