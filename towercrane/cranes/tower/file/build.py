"""What the checked tables of a tower crane's case describe: the crane, its exact structure and its models."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from modal import Beam, CraneFrame, EndBody
from towercrane.cranes.parts.load import load_of
from towercrane.cranes.tower.file.effects import kept_tower, softened
from towercrane.cranes.tower.file.members import as_chain, counter_jib_of, crane_on, tower_of, with_end_body

if TYPE_CHECKING:
    from modal import Chain
    from towercrane.cranes.tower.file.case_tables import RadialCase, SpaceCase
    from towercrane.cranes.tower.file.tables import Crane
    from towercrane.cranes.tower.model import FlexibleModel
    from towercrane.cranes.tower.modes.parameters import TowerCrane
    from towercrane.cranes.tower.planar import RadialModel


def radial_crane(tables: RadialCase) -> TowerCrane:
    """The crane in the plane, on a tower without what the case's tolerance leaves out."""
    return crane_on(kept_tower(tables), tables.crane)


def space_crane(crane: Crane) -> TowerCrane:
    """The crane in space: with its torsion, its jib's bending to the sides and its roll inertia where given."""
    from modal.beams.torsion import Shaft

    tower, jib, standing = crane.tower, crane.jib, tower_of(crane)
    lateral, shaft = None, None
    if jib.lateral_second_moment_of_area is not None:
        lateral = Beam(jib.length, jib.mass_per_length, jib.youngs_modulus, jib.lateral_second_moment_of_area)
    if tower.torsional_stiffness is not None and tower.torsional_inertia_per_length is not None:
        shaft = Shaft(standing.length, tower.torsional_inertia_per_length, tower.torsional_stiffness)
    return crane_on(standing, crane, jib_lateral=lateral, shaft=shaft, roll_inertia=crane.roll_inertia)


def crane_frame(tables: RadialCase, *, weight: bool = False) -> CraneFrame:
    """Tower, jib, trolley and load of a radial case in their common vertical plane.

    A counter-jib that has a bending stiffness bends, with the counterweight at its end; without one it is rigid, a
    part of the body on the tower.

    Parameters
    ----------
    tables : RadialCase
    weight : bool
        Whether the weight softens the tower.
    """
    counter_jib = counter_jib_of(tables.crane)
    crane, load = radial_crane(tables), tables.payload
    return frame_of(crane, load.mass, tables.rope.length, weight=weight, counter_jib=counter_jib)


def frame_of(
    crane: TowerCrane,
    payload_mass: float,
    rope_length: float,
    *,
    weight: bool = False,
    counter_jib: Chain | None = None,
) -> CraneFrame:
    """A crane with its load in their common vertical plane; without a counter-jib of its own, that is rigid."""
    tower = as_chain(crane.tower)
    if counter_jib is None:
        tower = with_end_body(tower, EndBody(crane.counter_mass, crane.counter_inertia))
    return CraneFrame(
        tower=replace(tower, gravity=crane.gravity if weight else 0.0),
        jib=as_chain(crane.jib),
        counter_jib=counter_jib,
        trolley_mass=crane.trolley_mass,
        payload_mass=payload_mass,
        rope_length=rope_length,
        gravity=crane.gravity,
    )


def radial_model(tables: RadialCase, **changes: Any) -> RadialModel:
    """Model of a radial case; keyword arguments replace what the case chose."""
    from towercrane.cranes.tower.planar import RadialModel

    chosen = {
        "tower_modes": tables.model.tower_modes,
        "jib_modes": tables.model.jib_modes,
        "weight_softening": softened(tables),
        "tower_damping_ratio": tables.model.tower_damping_ratio,
        "jib_damping_ratio": tables.model.jib_damping_ratio,
        "rope_as_rod": tables.rope.slack == "rod",
        "self_weight": tables.start.state != "zero-no-self-weight",
    }
    return RadialModel(radial_crane(tables), load_of(tables.payload), **{**chosen, **changes})


def space_model(tables: SpaceCase, **changes: Any) -> FlexibleModel:
    """Model of a case in space; keyword arguments replace what the case chose, or keep it in the plane."""
    from towercrane.cranes.tower.modes.modal_crane import ModeCounts
    from towercrane.cranes.tower.space import KINDS, model_in_space

    chosen = {key: getattr(tables.model, key) for key in (*KINDS, "weight_softening")} | changes
    counts = ModeCounts(*(chosen.pop(key) for key in KINDS))
    return model_in_space(counts=counts, **chosen, **space_parts(tables))


def space_parts(tables: SpaceCase) -> dict[str, Any]:
    """What a case in space says of its crane but how many modes it has, by the arguments of
    :func:`towercrane.cranes.tower.space.model_in_space`."""
    from towercrane.cranes.parts.wind import WindAreas
    from towercrane.cranes.slewing.description import Drive
    from towercrane.cranes.tower.modes.damping import ModalDamping

    crane, model = tables.crane, tables.model
    drive = None
    if crane.drive is not None and tables.motion.shaft is not None:
        coupling, friction = crane.drive, crane.friction
        drive = Drive(
            "slewing", coupling.soft_stiffness, coupling.stiff_stiffness, coupling.corner, coupling.damping,
            friction.law, friction.torque, friction.rate,
        )  # fmt: skip
    return {
        "crane": space_crane(crane),
        "load": load_of(tables.payload),
        "self_weight": tables.start.state != "zero-no-self-weight",
        "rope_as_rod": tables.rope.slack == "rod",
        "damping": ModalDamping(
            model.tower_damping_ratio,
            model.torsion_damping_ratio,
            model.jib_lateral_damping_ratio,
            model.jib_vertical_damping_ratio,
        ),
        "drive": drive,
        "drive_inertia": crane.drive.inertia if drive is not None and crane.drive is not None else 0.0,
        "areas": WindAreas(**dict(crane.wind_areas)) if tables.wind is not None else None,
    }
