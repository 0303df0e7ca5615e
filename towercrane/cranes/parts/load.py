"""The load of a case, on its rope."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cranes.parts.hoisting.release_table import release_of
from towercrane.kernels.elastic_rope import BY_STRAIN, TAUT, Elasticity
from towercrane.kernels.ground import Ground
from towercrane.kernels.load import AIR_DENSITY, Load, Sling
from towercrane.schema.faults import Fault, shown
from towercrane.schema.ranges import at, si_at

if TYPE_CHECKING:
    from collections.abc import Iterator

    from towercrane.cranes.parts.hoisting.release_table import Released
    from towercrane.cranes.parts.tables import CaseTable
    from towercrane.schema.fields import Hook, Payload, Rope, Slings

LIGHTEST = 0.01
"""Mass of a hook over that of the load below which it is merged with the load."""


def load_of(
    payload: Payload,
    rope: Rope | None = None,
    ground: Ground | None = None,
    released: Released | None = None,
    *,
    hook: Hook | None = None,
    slings: Slings | None = None,
) -> Load:
    """The load, its rope's losses, how it stretches if the rope is told and does, the ground, what of it lets go, and
    the hook that it hangs below.

    A light hook would swing ever faster for nothing: one that is lighter than a hundredth of the load gets that mass
    from the load.
    """
    drag_area, mass = payload.drag_area or 2.0 * payload.drag / AIR_DENSITY, payload.mass
    links: tuple[Sling, ...] = ()
    if hook is not None and slings is not None:
        whole = payload.mass + hook.mass
        mass = min(mass, whole / (1.0 + LIGHTEST))
        links = (Sling(whole - mass, slings.length, hook.drag_area),)
    going = None if released is None else release_of(payload, released)
    found = Load(mass, payload.rope_damping, drag_area, None, ground, going, links)
    return found if rope is None else replace(found, elasticity=elasticity_of(found.whole_mass, rope))


def ground_of(tables: CaseTable, foot: float = 0.0) -> Ground | None:
    """Ground of a case, if there is any; the foot of its crane at a height in the equations [m]."""
    if tables.ground is None:
        return None
    if tables.start.slack is not None:
        return Ground(slack=tables.start.slack, friction=tables.ground.friction)
    return Ground((tables.ground.height or 0.0) + foot, friction=tables.ground.friction)


def merged(payload: Payload, hook: Hook | None) -> Iterator[str]:
    """What is said of a hook that is merged with its load; nothing of others."""
    if hook is not None and hook.mass < LIGHTEST * payload.mass:
        share = (payload.mass + hook.mass) * LIGHTEST / (1.0 + LIGHTEST)
        yield (
            f"hook.mass: a hook of {hook.mass:g} kg, below {LIGHTEST:g} of the load, would only swing fast: it is "
            f"merged with the load and takes {share:.4g} kg of both together"
        )


def elasticity_of(mass: float, rope: Rope) -> Elasticity | None:
    """How a rope stretches, if it does; a damping ratio is of this mass on its length at the start."""
    stiffness = rope.stiffness or rope.falls * (rope.axial_stiffness or 0.0)
    if not stiffness:
        return None
    relaxation = rope.relaxation_time
    if rope.damping_ratio:
        spring = stiffness / (rope.length + rope.extra_length)
        relaxation = 2.0 * rope.damping_ratio * float(np.sqrt(mass / spring))
    return Elasticity(stiffness, rope.extra_length, relaxation, TAUT if rope.slack == "rod" else BY_STRAIN)


BASIC = "crane.stiffness.rope"
"""Where the file of a crane whose rope is a spring of its own has it."""

OF_STRETCH = ("extra_length", "relaxation_time", "damping_ratio", "falls")
"""Keys that say more of a rope's stiffness."""


def stretched(tree: dict[str, Any]) -> bool:
    """Whether the rope of a case as written stretches."""
    return any(at(tree, key) is not None for key in (BASIC, "rope.stiffness", "rope.axial_stiffness"))


def check_slings(tree: dict[str, Any]) -> Iterator[Fault]:
    """A hook without slings, and slings without a hook."""
    for key, other, hint in (
        ("hook", "slings", "a hook that the load does not hang below is part of payload.mass"),
        ("slings", "hook", "slings hang from a hook: [hook] mass"),
    ):
        if at(tree, key) is not None and at(tree, other) is None:
            yield Fault("", key, f"a table [{other}] beside it", "none", hint)
    if at(tree, "hook") is not None:
        for key in ("ground", "release"):
            if at(tree, key) is not None:
                hint = "a load on slings neither stands on ground nor lets go; leave the hook in payload.mass"
                yield Fault("", key, "no such table beside [hook]", "one", hint)
    if (stiffness := at(tree, "slings.stiffness")) is not None:
        hint = "slings do not stretch: a tension that falls to nothing ends the run; a rope does, rope.stiffness"
        yield Fault("", "slings.stiffness", "no key here", shown(stiffness), hint)


def check_rope(tree: dict[str, Any]) -> Iterator[Fault]:
    """Keys of a rope that do not go together; of one that belongs to the crane all are the crane file's."""
    rope = at(tree, "rope")
    if not isinstance(rope, dict):
        return
    stiffnesses, more = [key for key in ("stiffness", "axial_stiffness") if key in rope], set(rope) & {*OF_STRETCH}
    if at(tree, BASIC) is not None:
        for key in [*stiffnesses, *sorted(more)]:
            hint = f"the crane file has its rope as a spring, {BASIC.partition('.')[2]}"
            yield Fault("", f"rope.{key}", "no key here", shown(rope[key]), hint)
    elif len(stiffnesses) == 2:
        hint = "stiffness is that of all falls together, axial_stiffness E A of the rope, times falls"
        yield Fault("", "rope.axial_stiffness", "no key beside stiffness", shown(rope["axial_stiffness"]), hint)
    elif not stiffnesses:
        for key in sorted(more):
            hint = "without a stiffness the rope does not stretch"
            yield Fault("", f"rope.{key}", "a key beside stiffness or axial_stiffness", shown(rope[key]), hint)
    elif "falls" in more and "stiffness" in rope:
        hint = "stiffness is that of all falls together; axial_stiffness is E A of the rope, times falls"
        yield Fault("", "rope.falls", "no key beside stiffness", shown(rope["falls"]), hint)
    if {"relaxation_time", "damping_ratio"} <= more:
        hint = "a damping ratio zeta is the relaxation time 2 zeta / w"
        yield Fault("", "rope.damping_ratio", "no key beside relaxation_time", shown(rope["damping_ratio"]), hint)
    if rope.get("slack") == "stop" and stretched(tree):
        hint = "a rope that stretches goes slack and is caught; as a rod it would push"
        yield Fault("", "rope.slack", 'no key of a rope that stretches, or "rod"', shown(rope["slack"]), hint)


def check_ground(tree: dict[str, Any]) -> Iterator[Fault]:
    """Ground that does not go with the rope, and a load that is to stand on it and cannot."""
    ground, slack, start = at(tree, "ground"), at(tree, "start.slack"), at(tree, "start")
    if ground is None:
        if slack is not None:
            hint = "the load stands on ground, [ground]; friction may be stated there"
            yield Fault("", "start.slack", "a table [ground] beside it", shown(slack), hint)
        return
    if not stretched(tree) or at(tree, "rope.slack") == "rod":
        hint = "what is lifted off by a rope that does not stretch, or pushes, has no force to tell"
        yield Fault("", "ground", "a rope that stretches and goes slack, rope.stiffness", "another", hint)
    if slack is None:
        return
    if at(tree, "ground.height") is not None:
        hint = "the ground is where the load stands: below the crane at rest without it, by the rope less its slack"
        yield Fault("", "ground.height", "no key beside start.slack", shown(at(tree, "ground.height")), hint)
    length, loose = si_at(tree, "rope.length", "m"), si_at(tree, "start.slack", "m")
    if length and loose and loose >= length:
        yield Fault("", "start.slack", f"less than rope.length, {length:g} m", shown(slack))
    others = [key for key in start if key not in ("slack", "state")] if isinstance(start, dict) else []
    if others or at(tree, "start.state") not in (None, "equilibrium"):
        got = ", ".join(others) or shown(at(tree, "start.state"))
        yield Fault("", "start.slack", 'a crane in equilibrium, state = "equilibrium", and nothing else', got)
