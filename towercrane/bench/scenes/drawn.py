"""Varied scenes, drawn by a seeded generator: cranes, loads, ropes, drives, starts; in the plane and in space."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from towercrane.accuracy.scene import Scene
from towercrane.bench.scenes.drawn_cranes import any_crane, familiar_crane, in_space, spread
from towercrane.cranes.parts.wind import WindAreas, gusts, steady
from towercrane.cranes.slewing.description import Drive
from towercrane.cranes.tower.modes.damping import ModalDamping
from towercrane.kernels.load import Load
from towercrane.motions.motion import rest, sequence
from towercrane.motions.profiles import s_curve, smooth_ramps, table, trapezoid
from towercrane.motions.shaping import minimum_jerk
from towercrane.simulation.starts.start import Start

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.random import Generator

    from towercrane.cranes.tower.modes.parameters import TowerCrane
    from towercrane.motions.motion import Motion

FAMILIAR = 0.25
"""Part of the scenes whose crane is about the QTZ5613."""


@dataclass(frozen=True)
class Begin:
    """How scenes of the plane begin: at rest, swinging, or let go with rope and load hanging straight."""

    share: float
    swings: bool = False
    let_go: bool = False


BEGINS = (Begin(0.5), Begin(0.3, swings=True), Begin(0.2, let_go=True))


def scenes(count: int, seed: int) -> Iterator[Scene]:
    """As many scenes as wanted; the same seed gives the same."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        yield _scene(rng)


def space_scenes(count: int, seed: int) -> Iterator[Scene]:
    """As many scenes in space as wanted; the same seed gives the same."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        yield _space_scene(rng)


def _scene(rng: Generator) -> Scene:
    crane = _crane(rng)
    begin = BEGINS[rng.choice(len(BEGINS), p=[one.share for one in BEGINS])]
    rope = spread(rng, 3.0, 55.0)
    hoist: Motion = rest(rope)
    if rng.random() < 0.4:
        hoist = _motion(rng, rope, float(np.clip(rope * spread(rng, 0.4, 2.5), 2.5, 60.0)), 1.0)
    ratio = spread(rng, 0.003, 0.05) if rng.random() < 0.35 else 0.0
    return Scene(
        crane=crane,
        load=_load(rng, crane),
        motions={"trolley": _travel(rng, crane.jib.length, 1.5), "rope": hoist},
        duration=float(np.round(rng.uniform(20.0, 150.0))),
        start=Start(
            "zero" if begin.let_go else "equilibrium",
            float(rng.uniform(0.01, 0.35) * rng.choice([-1.0, 1.0])) if begin.swings else None,
        ),
        planar=True,
        damping=ModalDamping(tower=ratio, vertical=ratio),
        # A whole crane let fall would leave its rope slack at once.
        self_weight=bool(not begin.let_go or rng.random() < 0.5),
        rope_as_rod=bool(begin.let_go or rng.random() < 0.3),
    )


def _space_scene(rng: Generator) -> Scene:
    crane = in_space(rng, _crane(rng))
    load = _load(rng, crane)
    rope, turned = spread(rng, 4.0, 35.0), float(rng.uniform(-np.pi, np.pi))
    motions = {"trolley": _travel(rng, crane.jib.length, 1.0), "rope": rest(rope)}
    if rng.random() < 0.4:
        motions["rope"] = _motion(rng, rope, float(np.clip(rope * spread(rng, 0.5, 2.0), 3.0, 40.0)), 0.8)
    turn = rest(turned) if rng.random() < 0.15 else _turn(rng, turned)
    drive, inertia = None, 0.0
    if rng.random() < 0.35:
        soft = crane.slewing_inertia * (2.0 * np.pi * spread(rng, 0.1, 1.0)) ** 2
        damping = 2.0 * spread(rng, 0.01, 0.4) * float(np.sqrt(soft * crane.slewing_inertia))
        drive = Drive("slewing", soft, soft * rng.uniform(1.0, 4.0), spread(rng, 0.002, 0.03), damping, "none")
        inertia = crane.slewing_inertia * spread(rng, 0.01, 0.5)
    motions["slewing" if drive is None else "shaft"] = turn
    areas = None
    if rng.random() < 0.35:
        areas = WindAreas(rng.uniform(0.0, 0.8), rng.uniform(0.0, 0.8), rng.uniform(0.0, 0.8), rng.uniform(1.0, 8.0))
        speeds = rng.uniform(-12.0, 12.0, (20, 3)) * np.array([1.0, 1.0, 0.1])
        motions |= steady(speeds[0]) if rng.random() < 0.5 else gusts(float(rng.uniform(2.0, 4.0)), speeds)
    swinging = rng.random() < 0.35
    ratios = [spread(rng, 0.003, 0.03) if rng.random() < 0.5 else 0.0 for _ in range(4)]
    return Scene(
        crane=crane,
        load=load,
        motions=motions,
        duration=float(np.round(rng.uniform(20.0, 80.0))),
        start=Start(along=float(rng.uniform(0.01, 0.25) * rng.choice([-1.0, 1.0])) if swinging else None),
        rope_as_rod=bool(rng.random() < 0.2),
        damping=ModalDamping(*ratios),
        drive=drive,
        drive_inertia=inertia,
        areas=areas,
    )


def _crane(rng: Generator) -> TowerCrane:
    return familiar_crane(rng) if rng.random() < FAMILIAR else any_crane(rng)


def _load(rng: Generator, crane: TowerCrane) -> Load:
    """From an empty hook to what balances the crane, in a third of the draws with drag."""
    mass = spread(rng, 50.0, 0.4 * crane.counterweight)
    return Load(mass, drag_area=rng.uniform(0.5, 8.0) if rng.random() < 0.35 else 0.0)


def _travel(rng: Generator, reach: float, fastest: float) -> Motion:
    """The trolley's way between places far enough apart, in one move or several; now and then it stands."""
    places = rng.uniform(0.06, 0.97, rng.choice([2, 2, 3, 4])) * reach
    if rng.random() < 0.12:
        return rest(float(places[0]))
    if len(places) > 2:
        moves: list[Motion] = []
        for start, end in pairwise(places):
            moves += [_motion(rng, float(start), float(end), fastest), rest(float(end), rng.uniform(0.5, 8.0))]
        return sequence(*moves)
    return _motion(rng, float(places[0]), float(places[1]), fastest)


def _turn(rng: Generator, start: float) -> Motion:
    """A turn by 5 to 180 degrees at up to 0.8 rpm."""
    way = np.radians(spread(rng, 5.0, 180.0)) * rng.choice([-1.0, 1.0])
    speed = spread(rng, 0.1, 0.8) * np.pi / 30.0
    return _shaped(rng, start, float(start + way), speed, speed / rng.uniform(2.0, 15.0))


def _motion(rng: Generator, start: float, end: float, fastest: float) -> Motion:
    """A move after a wait or at once."""
    speed, acceleration = spread(rng, 0.1, fastest), spread(rng, 0.04, 1.0)
    move = _shaped(rng, start, end, speed, acceleration)
    return sequence(rest(start, rng.uniform(0.5, 8.0)), move) if rng.random() < 0.5 else move


def _shaped(rng: Generator, start: float, end: float, speed: float, acceleration: float) -> Motion:
    """A move of a shape that is drawn, within speed and acceleration but for one that is a table."""
    shape = list(_SHAPES)[rng.choice(len(_SHAPES), p=list(_SHAPES.values()))]
    return shape(rng, start, end, speed, acceleration)


def _trapezoid(rng: Generator, start: float, end: float, speed: float, acceleration: float) -> Motion:
    return trapezoid(start, end, speed, acceleration)


def _s_curve(rng: Generator, start: float, end: float, speed: float, acceleration: float) -> Motion:
    return s_curve(start, end, speed, acceleration, acceleration / rng.uniform(0.2, 2.0))


def _smooth(rng: Generator, start: float, end: float, speed: float, acceleration: float) -> Motion:
    way = abs(end - start)
    ramp = min(speed / acceleration, way / speed)
    return smooth_ramps(start, float(np.copysign(speed, end - start)), ramp, way / speed - ramp)


def _minimum_jerk(rng: Generator, start: float, end: float, speed: float, acceleration: float) -> Motion:
    return minimum_jerk(start, end, _unhurried(abs(end - start), speed, acceleration))


def _record(rng: Generator, start: float, end: float, speed: float, acceleration: float) -> Motion:
    """Someone's record of a move: some points at uneven times."""
    duration = _unhurried(abs(end - start), speed, acceleration)
    times = np.unique(np.concatenate([[0.0, 1.0], rng.uniform(0.0, 1.0, rng.integers(3, 9))]))
    return table(duration * times, start + (end - start) * times**2 * (3.0 - 2.0 * times))


def _unhurried(way: float, speed: float, acceleration: float) -> float:
    """Duration [s] of a move of least jerk within a speed and an acceleration."""
    return max(1.875 * way / speed, float(np.sqrt(5.8 * way / acceleration)))


_SHAPES = {_trapezoid: 0.45, _s_curve: 0.15, _smooth: 0.15, _minimum_jerk: 0.1, _record: 0.15}
"""Shapes of moves and the shares of each."""
