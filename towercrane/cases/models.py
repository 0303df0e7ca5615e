"""The model and the motions that a case describes, for every kind of crane."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, Any

from towercrane.cases.kinds import TOWER_CRANES
from towercrane.cranes.jib.tables import JibCase
from towercrane.cranes.slewing.tables import SlewingCase
from towercrane.cranes.tower.file.case_tables import RadialCase, SpaceCase

if TYPE_CHECKING:
    from towercrane.cases.case import Case
    from towercrane.cranes.tower.model import FlexibleModel
    from towercrane.cranes.tower.planar import RadialModel
    from towercrane.motions.motion import Motion
    from towercrane.simulation.system import Model

SLEWING = ("multi-mass", "enhanced", "basic")
"""Kinds that are lumped cranes."""


def model_of(case: Case) -> Model:
    """Model of a case of any kind."""
    if isinstance(case.checked, SlewingCase):
        from towercrane.cranes.slewing import build as slewing

        return slewing.model_of(case.checked)
    if isinstance(case.checked, JibCase):
        from towercrane.cranes.jib import build as jib

        return jib.model_of(case.checked)
    return flexible_model(case)


def flexible_model(case: Case, **changes: Any) -> FlexibleModel | RadialModel:
    """Model of a case of a flexible crane; keyword arguments replace what the case chose."""
    from towercrane.cranes.tower.file.build import radial_model, space_model

    if isinstance(case.checked, SpaceCase):
        return space_model(case.checked, **changes)
    if isinstance(case.checked, RadialCase):
        return radial_model(case.checked, **changes)
    raise ValueError(f"flexible_model: wanted a case of a flexible crane, got kind {case.kind!r}")


@lru_cache(maxsize=8)
def motions_of(case: Case) -> dict[str, Motion]:
    """What drives the crane, by channel; where a ramp is shaped for the model's frequencies, the model is asked.

    Raises
    ------
    CaseError
        If the model has no such frequencies, because it buckles.
    """
    from towercrane.motions.plans import NotSettled, shaped_motions

    modelled = [channel for channel, plan in case.plans.items() if plan.needs_model]
    if not modelled:
        return shaped_motions(case.plans, None)
    from towercrane.cranes.tower.sway_frequencies import SwayFrequencies
    from towercrane.schema.faults import CaseError, Fault
    from towercrane.simulation.system import NoEquilibrium

    try:
        return shaped_motions(case.plans, SwayFrequencies(flexible_model(case)))
    except (NoEquilibrium, NotSettled) as failure:
        key = f"motion.{'hoist' if modelled[0] == 'rope' else modelled[0]}"
        wanted, hint = "frequencies that the model has, or a list of them", "towercrane modes shows what it has"
        raise CaseError([Fault(str(case.path), f"{key}.frequencies", wanted, str(failure), hint)]) from failure


def uses_of(case: Case) -> tuple[str, ...]:
    """What its crane needs of :data:`towercrane.kernels.compilation.KERNELS`."""
    return (case.kind, *tower_uses(case))


def tower_uses(case: Case) -> tuple[str, ...]:
    """The part of it that is for the tower."""
    from modal.beams.beam import Beam
    from towercrane.cranes.tower.file.members import tower_of

    plain = case.kind not in TOWER_CRANES or isinstance(tower_of(case.crane), Beam)
    return () if plain else ("chain",)
