"""What a case asks for, its defaults filled in."""

from __future__ import annotations

from typing import TYPE_CHECKING

from towercrane.cranes.tower.crane_model import MODE_KINDS, moving
from towercrane.cranes.tower.file.plane import heading_of, stays_in_plane
from towercrane.cranes.tower.targets import ANY_MOTION, FORETOLD, absent, lacking
from towercrane.schema.motions import FreeTurn
from towercrane.schema.targets import ForEvery

if TYPE_CHECKING:
    from collections.abc import Collection

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
    asked, load = tables.map, tables.payload.mass
    places, (low, high) = places_of(tables), ends_of_map(tables)
    steps = asked.position_count - 1
    positions = getattr(asked, places) or tuple(low + (high - low) * i / steps for i in range(steps + 1))
    masses = asked.payload_masses or (0.5 * load, load, 2.0 * load)
    return asked.model_copy(update={places: positions, "payload_masses": masses})


def places_of(tables: TowerCase) -> str:
    """Key of the places of a map: of a trolley, or angles of a jib that pivots."""
    return "trolley_positions" if tables.crane.jib.luffing is None else "luffing_angles"


def ends_of_map(tables: TowerCase) -> tuple[float, float]:
    """How far a trolley [m] or a jib that pivots [rad] goes."""
    jib = tables.crane.jib
    return (0.0, jib.reach) if jib.luffing is None else (jib.luffing.lowest_angle, jib.luffing.highest_angle)


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


def of_play(tables: TowerCase, pressed: Collection[int] | None = ()) -> list[str]:
    """What natural frequencies know of collars with play, the lowest is 1; of those that the tower leans on at rest,
    or, where that is not asked, of any."""
    collars = sorted(tables.crane.tower.collars, key=lambda collar: collar.height)
    gaps = {number: collar.gap for number, collar in enumerate(collars, start=1) if collar.gap}
    leaned = [number for number in gaps if pressed is None or number in pressed]
    free, said = [number for number in gaps if number not in leaned], []

    def named(numbers: Collection[int]) -> str:
        shown = " and ".join(f"{number} ({1e3 * gaps[number]:g} mm)" for number in numbers)
        return f"the play of collar{'s' if len(numbers) > 1 else ''} {shown}"

    if free:
        said.append(f"{named(free)} is open: natural frequencies are of motions within it, which no collar feels")
    if leaned and pressed is None:
        said.append(f"{named(leaned)} may be used up at rest: natural frequencies are of the tower as it leans")
    elif leaned:
        said.append(f"{named(leaned)} is used up at rest: natural frequencies are of motions that stay in contact")
    return said


def of_free_head(tables: TowerCase, model: FlexibleModel) -> list[str]:
    """Which way the wind turns a head that is free, and what natural frequencies know of it."""
    if not isinstance(tables.motion.slewing, FreeTurn):
        return []
    from towercrane.cranes.tower.file.wind import HELD, weathervane

    return [*weathervane(tables, model), HELD]


def notices(tables: TowerCase, model: FlexibleModel) -> list[str]:
    """What the modes of a run leave out of forces on base and collars, and natural frequencies of play."""
    written = model.crane.written
    if written is None:
        return []
    count = max(0, model.crane.tower.count - len(written.gapped))
    from towercrane.cranes.tower.modes.left_out.collar_statics import notice
    from towercrane.cranes.tower.modes.left_out.effective_mass import effective_mass

    said = [notice(written, count)]
    if tables.earthquake is not None:
        said.append(effective_mass(written).notice(count))
    said += of_play(tables, () if model.axes == 2 else None)
    said += of_free_head(tables, model)
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
    aside = f"the scene leaves the jib's plane, but this shows the crane in it alone: {SIDEWAYS}"
    return [*(left_out(tables) or [aside]), *of_play(tables)]
