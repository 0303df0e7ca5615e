"""What the checked tables of a tower crane's case describe: the crane, its exact structure and its models."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from modal import CraneFrame, EndBody
from towercrane.cranes.parts.load import ground_of, load_of
from towercrane.cranes.tower.file.effects import kept_tower, softened
from towercrane.cranes.tower.file.members import (
    counter_jib_of,
    crane_on,
    jib_of,
    luffing_of,
    tie_bars_of,
    with_end_body,
)
from towercrane.cranes.tower.file.plane import heading_of
from towercrane.cranes.tower.modes.collars import TowerCollar
from towercrane.cranes.tower.modes.parameters import as_chain
from towercrane.cranes.tower.outputs.cut_sums import Section
from towercrane.schema.motions import FreeTurn

if TYPE_CHECKING:
    from towercrane.cranes.tower.file.case_tables import TowerCase
    from towercrane.cranes.tower.file.tables import Crane
    from towercrane.cranes.tower.model import FlexibleModel
    from towercrane.cranes.tower.modes.parameters import TowerCrane


def crane_of(tables: TowerCase) -> TowerCrane:
    """The crane of a case, on a tower without what the case's tolerance leaves out, with all that its file gives."""
    crane, standing = tables.crane, kept_tower(tables)
    # Nobody asks a scene in the plane for torsion; sections of a lattice take a few milliseconds.
    shaft = None
    if heading_of(tables) is None or crane.tower.torsional_stiffness is not None:
        from towercrane.cranes.tower.file.lattices.torsion import tower_shaft

        shaft = tower_shaft(crane, standing.length)
    return crane_on(
        standing, crane, jib_lateral=jib_of(crane, "lateral"), shaft=shaft, roll_inertia=crane.roll_inertia,
        counter_jib_lateral=counter_jib_of(crane, "lateral"), luffing=luffing_of(tables),
        tie_bars=tie_bars_of(crane), gapped=gapped_of(crane, standing.length),
    )  # fmt: skip


def gapped_of(crane: Crane, length: float) -> tuple[TowerCollar, ...]:
    """Collars with play that a tower of this length has."""
    return tuple(
        TowerCollar(min(collar.height, length), collar.stiffness, gap=collar.gap)
        for collar in crane.tower.collars
        if collar.gap
    )


def crane_frame(tables: TowerCase, *, weight: bool = False) -> CraneFrame:
    """Tower, jib, trolley and load of a case in their common vertical plane.

    A counter-jib that has a bending stiffness bends, with the counterweight at its end; without one it is rigid, a
    part of the body on the tower.

    Parameters
    ----------
    tables : TowerCase
    weight : bool
        Whether the weight softens the tower.

    Raises
    ------
    ValueError
        If the jib pivots or hangs on ties.
    """
    if tables.crane.tower_head is not None:
        raise ValueError("crane.tower_head: wanted jibs that are clamped; a frame of beams is of such alone")
    if tables.crane.jib.luffing is not None:
        raise ValueError("crane.jib.luffing: wanted a jib that does not pivot; a frame of beams is of such alone")
    return frame_of(crane_of(tables), tables.payload.mass, tables.rope.length, weight=weight)


def frame_of(crane: TowerCrane, payload_mass: float, rope_length: float, *, weight: bool = False) -> CraneFrame:
    """A crane with its load in their common vertical plane."""
    tower = as_chain(crane.tower)
    if crane.counter_jib is None:
        tower = with_end_body(tower, EndBody(crane.counter_mass, crane.counter_inertia))
    return CraneFrame(
        tower=replace(tower, gravity=crane.gravity if weight else 0.0),
        jib=as_chain(crane.jib),
        counter_jib=crane.counter_jib,
        trolley_mass=crane.trolley_mass,
        payload_mass=payload_mass,
        rope_length=rope_length,
        gravity=crane.gravity,
    )


def tower_model(tables: TowerCase, **changes: Any) -> FlexibleModel:
    """Model of a case; keyword arguments replace what the case chose, or keep it in the plane."""
    from towercrane.cranes.tower.crane_model import tower_crane_model

    return tower_crane_model(**described_model(tables, **changes))


def described_model(tables: TowerCase, **changes: Any) -> dict[str, Any]:
    """What a case says of its model, by the arguments of
    :func:`towercrane.cranes.tower.crane_model.tower_crane_model`."""
    from towercrane.cranes.tower.crane_model import MODE_KINDS
    from towercrane.cranes.tower.modes.mode_counts import ModeCounts

    heading = heading_of(tables)
    chosen = {
        **asked_modes(tables),
        "weight_softening": softened(tables),
        "planar": heading is not None,
        "heading": heading or 0.0,
    } | changes
    counts = ModeCounts(*(chosen.pop(key) for key in MODE_KINDS))
    return {**described_scene(tables), "modes": counts, **chosen}


def sections_of(tables: TowerCase) -> tuple[Section, ...]:
    """Sections of tower and jib whose loads a case asks for."""
    places = (own.height if own.of == "tower" else own.position for own in tables.sections)
    return tuple(Section(own.name, own.of, place or 0.0) for own, place in zip(tables.sections, places, strict=True))


def asked_modes(tables: TowerCase) -> dict[str, int]:
    """Number of modes of each kind that a case takes; of a counter-jib one of each kind that its file gives."""
    from towercrane.cranes.tower.crane_model import MODE_KINDS

    jib = tables.crane.counter_jib
    bends = {
        # Its turning on a hinge and its bending under the ties are there beside modes.
        "counter_jib_vertical_modes": jib.bends and not jib.ties,
        "counter_jib_lateral_modes": jib.bends and counter_jib_of(tables.crane, "lateral") is not None,
    }
    stated = {kind: getattr(tables.model, kind) for kind in MODE_KINDS}
    return {kind: int(bends[kind]) if count is None else count for kind, count in stated.items()}


def described_scene(tables: TowerCase, built: TowerCrane | None = None) -> dict[str, Any]:
    """The same without what may be chosen: modes, softening by the weight, whether it stays in the plane.

    What is built of the crane already is taken as it is.
    """
    from towercrane.cranes.parts.wind import WindAreas
    from towercrane.cranes.slewing.description import Drive
    from towercrane.cranes.tower.modes.damping import ModalDamping

    crane, model = tables.crane, tables.model
    drive = None
    if isinstance(free := tables.motion.slewing, FreeTurn):
        # A coupling that holds nothing leaves the brake.
        drive = Drive("slewing", 0.0, 0.0, 1.0, 0.0, "stick-slip", free.brake_torque)
    elif crane.drive is not None and tables.motion.shaft is not None:
        coupling, friction = crane.drive, crane.friction
        drive = Drive(
            "slewing", coupling.soft_stiffness, coupling.stiff_stiffness, coupling.corner, coupling.damping,
            friction.law, friction.torque, friction.rate,
        )  # fmt: skip
    made = built or crane_of(tables)
    return {
        "crane": made,
        "load": load_of(
            tables.payload,
            tables.rope,
            ground_of(tables, -made.tower.length),
            tables.release,
            hook=tables.hook,
            slings=tables.slings,
        ),
        "self_weight": tables.start.state != "zero-no-self-weight",
        "rope_as_rod": tables.rope.slack == "rod",
        "damping": ModalDamping(
            model.tower_damping_ratio,
            model.torsion_damping_ratio,
            model.jib_lateral_damping_ratio,
            model.jib_vertical_damping_ratio,
            model.counter_jib_lateral_damping_ratio,
            model.counter_jib_vertical_damping_ratio,
        ),
        "drive": drive,
        "drive_inertia": crane.drive.inertia if drive is not None and crane.drive is not None else 0.0,
        "ground": tables.earthquake is not None,
        "floors": 0 if tables.earthquake is None else len(tables.earthquake.floors),
        "areas": WindAreas(**dict(crane.wind_areas)) if tables.wind is not None else None,
        "nodes": None if tables.wind is None else tables.wind.nodes,
        "sections": sections_of(tables),
    }
