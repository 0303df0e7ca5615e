"""Short scenes of every kind of crane in which much happens at once, drawn by a seeded generator.

Friction breaks away and sticks, drives are softer or stiffer than the structure, motions begin away from zero, ropes
are hauled until they go slack, gusts blow. All times are multiples of a quarter of a second, so that rows, switches
of all motions and the end of the run meet.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache, partial
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cases.case import load_case
from towercrane.cranes.jib import build as jib
from towercrane.cranes.jib.model import PlannedJibCrane
from towercrane.cranes.jib.parameters import JibCrane
from towercrane.cranes.parts.wind import gusts
from towercrane.cranes.slewing import build as slewing
from towercrane.cranes.slewing.description import Drive
from towercrane.cranes.slewing.kind import SLEWING
from towercrane.cranes.slewing.tables import SlewingCase
from towercrane.cranes.tower.file.build import tower_model
from towercrane.cranes.tower.file.case_tables import TowerCase
from towercrane.kernels.load import Load
from towercrane.motions.motion import rest, sequence
from towercrane.motions.profiles import speed_trapezoid
from towercrane.simulation.starts.start import Start

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from towercrane.cases.case import Case
    from towercrane.cranes.slewing.parameters import FrictionLaw
    from towercrane.motions.motion import Motion
    from towercrane.simulation.system import Model

TICK = 0.25
"""All times are multiples of it [s]."""


@dataclass(frozen=True, eq=False)
class EventScene:
    """What is run, as :func:`towercrane.simulation.simulate.record` wants it."""

    kind: str
    model: Model
    motions: dict[str, Motion]
    duration: float
    start: Start


def event_scenes(count: int, seed: int) -> Iterator[EventScene]:
    """As many scenes as wanted, all kinds in turn; the same seed gives the same."""
    rng = np.random.default_rng(seed)
    for number in range(count):
        kind = SCENE_KINDS[number % len(SCENE_KINDS)]
        model, motions = _MAKERS[kind](rng)
        state = "zero" if rng.random() < 0.2 else "equilibrium"
        swing = float(rng.uniform(-1.7, 1.7)) if rng.random() < 0.3 else None
        yield EventScene(kind, model, motions, _ticks(rng, 4, 12), Start(state, swing))


def _ticks(rng: np.random.Generator, low: int, high: int) -> float:
    return TICK * int(rng.integers(low, high + 1))


def _spread(rng: np.random.Generator, low: float, high: float) -> float:
    """Between two positive numbers, any order of magnitude alike."""
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def _moved(rng: np.random.Generator, start: float, fastest: float) -> Motion:
    """Wait, ramps and steady speed either way, or rest."""
    if rng.random() < 0.2:
        return rest(start)
    speed = float(rng.uniform(-fastest, fastest))
    move = speed_trapezoid(start, speed, _ticks(rng, 1, 3), _ticks(rng, 0, 4))
    waits = _ticks(rng, 0, 3)
    return sequence(rest(start, waits), move) if waits else move


def _hoisted(rng: np.random.Generator, length: float) -> Motion:
    """Rope that is hauled or paid out, now and then faster than the load falls, and never to nothing."""
    return _moved(rng, length, 0.2 * length if rng.random() < 0.7 else 0.4 * length)


def _turned(rng: np.random.Generator, fastest: float) -> Motion:
    return _moved(rng, float(rng.uniform(-3.0, 3.0)) if rng.random() < 0.6 else 0.0, fastest)


@cache
def _loaded(name: str) -> Case:
    return load_case(name)


def _load(rng: np.random.Generator, low: float, high: float) -> Load:
    mass = _spread(rng, low, high)
    return Load(
        mass, rope_damping=float(rng.choice([0.0, 0.1 * mass])), drag_area=float(rng.choice([0.0, 1e-3 * mass]))
    )


def _lumped(rng: np.random.Generator, *, kind: str) -> tuple[Model, dict[str, Motion]]:
    """Laboratory crane with another drive and another friction."""
    tables = _loaded(f"slewing/{kind}/example-1").tables(SlewingCase)
    soft = _spread(rng, 5.0, 1e5)
    laws: list[FrictionLaw] = ["none", "tanh", "stick-slip", "stick-slip"]
    parameters = replace(
        slewing.parameters_of(tables.crane),
        drive_soft_stiffness=soft,
        drive_stiff_stiffness=soft * _spread(rng, 1.0, 30.0),
        drive_corner=_spread(rng, 1e-3, 0.3),
        drive_damping=float(rng.choice([0.0, 10.0, 60.0])),
        friction_law=laws[rng.integers(len(laws))],
        friction_torque=_spread(rng, 1.0, 100.0),
        friction_rate=_spread(rng, 3e-3, 0.1),
    )
    model = slewing.builder_of(tables)(parameters)
    return replace(model, load=_load(rng, 5.0, 100.0)), {"shaft": _turned(rng, 1.0), "rope": _hoisted(rng, 2.0)}


def _wind(rng: np.random.Generator) -> dict[str, Motion]:
    return gusts(2.0 * TICK, rng.uniform(-1.0, 1.0, (6, 3)) * [12.0, 12.0, 2.0])


def _flexible(rng: np.random.Generator, *, driven: bool) -> tuple[Model, dict[str, Motion]]:
    """QTZ5613 in space with few modes, with or without its drive, in gusts."""
    model = _tower_model()
    motions = {
        "trolley": _moved(rng, float(rng.uniform(5.0, 40.0)), 1.0),
        "rope": _hoisted(rng, _spread(rng, 3.0, 20.0)),
    }
    turning = _turned(rng, 0.1)
    if driven:
        soft = _spread(rng, 1e5, 1e9)
        stiff, corner, damping = soft * _spread(rng, 1.0, 30.0), _spread(rng, 1e-4, 0.02), _spread(rng, 1e3, 1e6)
        drive = Drive(
            "slewing", soft, stiff, corner, damping, "tanh", _spread(rng, 1e2, 3e4), _spread(rng, 3e-3, 0.1)
        )
        model, motions = (
            replace(model, slewing=drive, drive_inertia=_spread(rng, 1e3, 1e5)),
            motions | {"shaft": turning},
        )
    else:
        motions |= {"slewing": turning}
    blows = rng.random() < 0.5
    motions |= _wind(rng) if blows else {}
    return replace(model, load=_load(rng, 200.0, 5000.0), wind=blows), motions


@cache
def _tower_model() -> Any:
    case = _loaded("qtz5613/soft-drive")
    modes = {"tower_modes": 1, "torsion_modes": 1, "jib_lateral_modes": 1, "jib_vertical_modes": 1}
    return replace(tower_model(case.tables(TowerCase), **modes), slewing="prescribed", drive_inertia=0.0)


def _radial(rng: np.random.Generator) -> tuple[Model, dict[str, Motion]]:
    """QTZ5613 in the plane."""
    model = tower_model(
        _loaded("qtz5613/condition-3").tables(TowerCase), tower_modes=2, jib_vertical_modes=2
    ).with_load(_load(rng, 200.0, 5000.0))
    trolley = _moved(rng, float(rng.uniform(5.0, 40.0)), 1.0)
    return model, {"trolley": trolley, "rope": _hoisted(rng, _spread(rng, 3.0, 20.0))}


def _jib(rng: np.random.Generator) -> tuple[Model, dict[str, Motion]]:
    """Jib crane on a plan."""
    model = PlannedJibCrane(
        JibCrane(**jib.parameters_of(_loaded("jib-crane/heavy").crane)), _load(rng, 500.0, 10_000.0)
    )
    joints = {"slew": _turned(rng, 0.3), "luff": _moved(rng, 0.6, 0.05), "fold": _moved(rng, -0.2, 0.05)}
    return model, joints | {"rope": _hoisted(rng, _spread(rng, 4.0, 25.0))}


_MAKERS: dict[str, Callable[[np.random.Generator], tuple[Model, dict[str, Motion]]]] = {
    **{kind.name: partial(_lumped, kind=kind.name) for kind in SLEWING},
    "radial": _radial,
    "prescribed slewing": partial(_flexible, driven=False),
    "slewing drive": partial(_flexible, driven=True),
    "jib": _jib,
}

SCENE_KINDS = tuple(_MAKERS)
"""Kinds of scenes, in the order in which they are drawn."""
