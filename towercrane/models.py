"""The model that a case describes, for every kind of crane."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable

    from towercrane.case import Case
    from towercrane.cranes.lumped import LumpedModel
    from towercrane.cranes.radial import RadialModel
    from towercrane.system import Model

SLEWING = ("multi-mass", "enhanced", "basic")
"""Kinds that are lumped cranes."""


def model_of(case: Case) -> Model:
    """Model of a case of any kind."""
    if case.kind in SLEWING:
        return slewing_builder(case)(case.lumped_parameters())
    if case.kind == "jib":
        from towercrane.cranes.jib_crane import JibCrane, PlannedJibCrane

        return PlannedJibCrane(JibCrane(**case.jib_parameters()), case.load(), rope_as_rod=case.rope.slack == "rod")
    return radial_model(case)


def radial_model(case: Case, **changes: Any) -> RadialModel:
    """Model of a radial case; keyword arguments replace what the case chose."""
    from towercrane.cranes.radial import RadialModel

    chosen = {
        "tower_modes": case.model.tower_modes,
        "jib_modes": case.model.jib_modes,
        "weight_softening": _softened(case),
        "tower_damping_ratio": case.model.tower_damping_ratio,
        "jib_damping_ratio": case.model.jib_damping_ratio,
        "rope_as_rod": case.rope.slack == "rod",
        "self_weight": case.start.state != "zero-no-self-weight",
    }
    return RadialModel(case.radial_crane(), case.load(), **{**chosen, **changes})


def _softened(case: Case) -> bool:
    """Whether the weight softens the tower: as the case says, or by its tolerance on frequencies."""
    if case.accuracy.frequency is None:
        return case.model.weight_softening
    from towercrane.effects import effects_in

    return "weight" in effects_in(case).kept


def slewing_builder(case: Case) -> Callable[[Any], LumpedModel]:
    """Model of a slewing case from a parameter set that may differ from the case's own."""
    from towercrane.cranes import slewing
    from towercrane.cranes.lumped import LumpedModel

    builders: dict[str, Callable[[Any], Any]] = {
        "multi-mass": slewing.multi_mass,
        "enhanced": slewing.enhanced,
        "basic": slewing.basic,
    }
    crane = builders[case.kind]
    load, as_rod = case.load(), case.rope.slack == "rod"
    return lambda parameters: LumpedModel(crane(parameters), load, as_rod)
