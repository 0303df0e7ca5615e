"""What a case asks for, its defaults filled in."""

from __future__ import annotations

from typing import TYPE_CHECKING

from towercrane.cranes.tower.crane_model import MODE_KINDS, moving
from towercrane.cranes.tower.file.plane import heading_of, stays_in_plane
from towercrane.cranes.tower.targets import ANY_MOTION, FORETOLD, absent, lacking
from towercrane.schema.targets import ForEvery

if TYPE_CHECKING:
    from towercrane.cranes.tower.file.case_tables import MapRequest, ModesRequest, TowerCase
    from towercrane.cranes.tower.model import FlexibleModel
    from towercrane.motions.motion import Motion
    from towercrane.schema.targets import Targets


def modes_of(tables: TowerCase, trolley: Motion) -> ModesRequest:
    """What to show of the modes; positions of the trolley default to both ends of its way."""
    modes = tables.modes
    if modes.trolley_positions:
        return modes
    return modes.model_copy(update={"trolley_positions": tuple(dict.fromkeys(trolley.range()))})


def map_of(tables: TowerCase) -> MapRequest:
    """Where the frequency map is taken."""
    asked, jib, load = tables.map, tables.crane.jib.reach, tables.payload.mass
    steps = asked.position_count - 1
    positions = asked.trolley_positions or tuple(jib * i / steps for i in range(steps + 1))
    masses = asked.payload_masses or (0.5 * load, load, 2.0 * load)
    return asked.model_copy(update={"trolley_positions": positions, "payload_masses": masses})


def targets_of(tables: TowerCase) -> Targets:
    """Tolerance of every output whose error a case limits; where it names none, of those that fit the scene."""
    asked = tables.accuracy
    if asked.outputs or not isinstance(asked.target, ForEvery):
        return asked.targets
    jib, counter_jib = tables.crane.jib, tables.crane.counter_jib
    none = lacking(jib.luffing is not None, len(jib.ties), len(counter_jib.ties))
    heading, clamped = heading_of(tables), jib.luffing is None and not jib.ties
    still = () if heading is None else absent(heading)
    fitting = FORETOLD if clamped and heading is not None else ANY_MOTION
    return {name: asked.targets[name] for name in fitting if name in asked.targets and name not in {*none, *still}}


def modes_that_move(tables: TowerCase) -> dict[str, str]:
    """Kinds of modes that move in a scene, by the key that counts them; a counter-jib bends as the case has it."""
    named = zip(MODE_KINDS, ("tower", "torsion", "lateral", "vertical"), strict=False)
    return {key: word for key, word in named if key in moving(stays_in_plane(tables))}


def notices(tables: TowerCase, model: FlexibleModel) -> list[str]:
    """What the modes of a run leave out of forces on base and collars."""
    written, count = model.crane.written, model.crane.tower.count
    if written is None:
        return []
    from towercrane.cranes.tower.modes.left_out.collar_statics import notice
    from towercrane.cranes.tower.modes.left_out.effective_mass import effective_mass

    said = [notice(written, count)]
    if tables.earthquake is not None:
        said.append(effective_mass(written).notice(count))
    return [sentence for sentence in said if sentence]


SIDEWAYS = "torsion of the tower, bending of tower and jib to their sides and sway across the jib are left out"


def left_out(tables: TowerCase) -> list[str]:
    """What a scene leaves out because nothing excites it."""
    if not stays_in_plane(tables):
        return []
    answer = ", and what a linear model's wind across the jib would do" if tables.wind is not None else ""
    shakes = "turns the head, blows or shakes" if tables.earthquake is not None else "turns the head or blows"
    return [f"nothing {shakes} across the jib: {SIDEWAYS}{answer}"]


def left_out_in_plane(tables: TowerCase) -> list[str]:
    """What a study of the crane in the jib's plane leaves out, in a scene that may leave it."""
    return left_out(tables) or [f"the scene leaves the jib's plane, but this shows the crane in it alone: {SIDEWAYS}"]
