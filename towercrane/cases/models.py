"""The model that a case describes, for every kind of crane."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from towercrane.cases.kinds import TOWER_CRANES

if TYPE_CHECKING:
    from collections.abc import Callable

    from towercrane.cases.case import Case
    from towercrane.cranes.slewing.model import LumpedModel
    from towercrane.cranes.tower.model import FlexibleModel
    from towercrane.cranes.tower.planar import RadialModel
    from towercrane.motions.motion import Motion
    from towercrane.simulation.system import Model

SLEWING = ("multi-mass", "enhanced", "basic")
"""Kinds that are lumped cranes."""


def model_of(case: Case) -> Model:
    """Model of a case of any kind."""
    if case.kind in SLEWING:
        return slewing_builder(case)(case.lumped_parameters())
    if case.kind == "jib":
        from towercrane.cranes.jib.model import JibCrane, PlannedJibCrane

        return PlannedJibCrane(JibCrane(**case.jib_parameters()), case.load(), rope_as_rod=case.rope.slack == "rod")
    return flexible_model(case)


def motions_of(case: Case) -> dict[str, Motion]:
    """Motions of a case's drives, shaped where the case says so.

    Raises
    ------
    CaseError
        If a ramp is to be shaped for frequencies that the model does not have.
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


def flexible_model(case: Case, **changes: Any) -> FlexibleModel | RadialModel:
    """Model of a case of a flexible crane; keyword arguments replace what the case chose."""
    if case.kind not in TOWER_CRANES:
        raise ValueError(f"flexible_model: wanted a case of a flexible crane, got kind {case.kind!r}")
    return space_model(case, **changes) if case.kind == "space" else radial_model(case, **changes)


def radial_model(case: Case, **changes: Any) -> RadialModel:
    """Model of a radial case; keyword arguments replace what the case chose."""
    from towercrane.cranes.tower.file.effects import softened
    from towercrane.cranes.tower.planar import RadialModel

    chosen = {
        "tower_modes": case.model.tower_modes,
        "jib_modes": case.model.jib_modes,
        "weight_softening": softened(case),
        "tower_damping_ratio": case.model.tower_damping_ratio,
        "jib_damping_ratio": case.model.jib_damping_ratio,
        "rope_as_rod": case.rope.slack == "rod",
        "self_weight": case.start.state != "zero-no-self-weight",
    }
    return RadialModel(case.radial_crane(), case.load(), **{**chosen, **changes})


def space_model(case: Case, **changes: Any) -> FlexibleModel:
    """Model of a case in space; keyword arguments replace what the case chose."""
    from towercrane.accuracy.space_scene import space_scene_of, space_setting_of

    # Its motions may be waiting for the frequencies of this very model.
    return space_scene_of(case, {}).model(replace(space_setting_of(case), **changes))


def slewing_builder(case: Case) -> Callable[[Any], LumpedModel]:
    """Model of a slewing case from a parameter set that may differ from the case's own."""
    from towercrane.cranes.slewing import models as slewing
    from towercrane.cranes.slewing.model import LumpedModel

    builders: dict[str, Callable[[Any], Any]] = {
        "multi-mass": slewing.multi_mass,
        "enhanced": slewing.enhanced,
        "basic": slewing.basic,
    }
    crane = builders[case.kind]
    load, as_rod = case.load(), case.rope.slack == "rod"
    return lambda parameters: LumpedModel(crane(parameters), load, as_rod)
