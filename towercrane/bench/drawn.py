"""Varied scenes, drawn by a seeded generator: cranes, loads, ropes, drives, starts; in the plane and in space."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from modal.beam import Beam
from modal.torsion import Shaft
from towercrane.cranes.damping import ModalDamping
from towercrane.cranes.tower_crane import TowerCrane
from towercrane.cranes.wind import WindAreas, gusts, steady
from towercrane.motion import rest, s_curve, smooth_ramps, trapezoid
from towercrane.payload import Load
from towercrane.scene import RadialScene
from towercrane.space_scene import SpaceScene

if TYPE_CHECKING:
    from collections.abc import Iterator

    from towercrane.motion import Motion

STEEL = 206e9
"""Young's modulus [Pa]."""


def scenes(count: int, seed: int) -> Iterator[RadialScene]:
    """As many scenes as wanted; the same seed gives the same."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        yield _scene(rng)


def _scene(rng: np.random.Generator) -> RadialScene:
    crane = _crane(rng)
    reach = crane.jib.length
    heaviest = 0.25 * crane.counterweight
    load = Load(float(np.exp(rng.uniform(np.log(200.0), np.log(heaviest)))))
    rope = rng.uniform(4.0, 40.0)
    near, far = sorted(rng.uniform(0.06, 0.95, 2) * reach)
    start, end = (near, far) if rng.random() < 0.6 else (far, near)
    trolley = _motion(rng, start, end, 1.2)
    hoist: Motion = rest(rope)
    if rng.random() < 0.3:
        hoist = _motion(rng, rope, float(np.clip(rope + rng.uniform(-15.0, 15.0), 4.0, 45.0)), 1.0)
    if rng.random() < 0.1:
        trolley = rest(start)
    kind = rng.choice(["equilibrium", "swinging", "zero"], p=[0.55, 0.25, 0.2])
    damped = rng.random() < 0.4
    return RadialScene(
        crane=crane,
        load=load,
        motions={"trolley": trolley, "rope": hoist},
        duration=float(np.round(rng.uniform(40.0, 150.0))),
        state="zero" if kind == "zero" else "equilibrium",
        swing_angle=float(rng.uniform(0.02, 0.3)) if kind == "swinging" else 0.0,
        tower_damping_ratio=0.01 if damped else 0.0,
        jib_damping_ratio=0.01 if damped else 0.0,
        # A whole crane let fall would leave its rope slack at once.
        self_weight=bool(kind != "zero" or rng.random() < 0.5),
        rope_as_rod=bool(kind == "zero"),
    )


def space_scenes(count: int, seed: int) -> Iterator[SpaceScene]:
    """As many scenes in space as wanted; the same seed gives the same."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        yield _space_scene(rng)


def _space_scene(rng: np.random.Generator) -> SpaceScene:
    plain = _crane(rng)
    height, jib = plain.tower.length, plain.jib
    lateral = Beam(jib.length, jib.mass_per_length, STEEL, jib.second_moment_of_area * rng.uniform(0.3, 1.0))
    # As stiff as four walls of shear stiffness make it, for a tower about as broad as its bending tells.
    shaft = Shaft(height, rng.uniform(300.0, 900.0), 1.7e8 * (height / 23.8) * rng.uniform(0.6, 2.0))
    crane = replace(plain, jib_lateral=lateral, shaft=shaft)
    load = Load(float(np.exp(rng.uniform(np.log(200.0), np.log(0.25 * crane.counterweight)))))
    near, far = sorted(rng.uniform(0.1, 0.95, 2) * jib.length)
    rope = rng.uniform(5.0, 30.0)
    motions = {
        "trolley": rest(near) if rng.random() < 0.3 else _motion(rng, near, far, 1.0),
        "rope": rest(rope),
        "slewing": rest(0.0) if rng.random() < 0.1 else _slewing(rng),
    }
    if rng.random() < 0.4:
        motions["rope"] = _motion(rng, rope, float(np.clip(rope + rng.uniform(-12.0, 12.0), 4.0, 35.0)), 0.8)
    areas = None
    if rng.random() < 0.2:
        areas = WindAreas(tower=0.5, jib=0.3, counter_jib=0.3, counterweight=4.0)
        speeds = rng.uniform(-12.0, 12.0, (20, 3)) * np.array([1.0, 1.0, 0.1])
        motions |= steady(speeds[0]) if rng.random() < 0.5 else gusts(3.0, speeds)
        load = replace(load, drag_area=rng.uniform(1.0, 6.0))
    ratio = 0.01 if rng.random() < 0.5 else 0.0
    return SpaceScene(
        crane=crane,
        load=load,
        motions=motions,
        duration=float(np.round(rng.uniform(30.0, 80.0))),
        swing_angle=float(rng.uniform(0.02, 0.2)) if rng.random() < 0.2 else 0.0,
        damping=ModalDamping(ratio, ratio, ratio, ratio),
        areas=areas,
    )


def _slewing(rng: np.random.Generator) -> Motion:
    """A turn by 20 to 180 degrees at up to 0.8 rpm."""
    way = np.radians(rng.uniform(20.0, 180.0)) * rng.choice([-1.0, 1.0])
    speed = rng.uniform(0.2, 0.8) * np.pi / 30.0
    return trapezoid(0.0, float(way), speed, speed / rng.uniform(3.0, 15.0))


def _crane(rng: np.random.Generator) -> TowerCrane:
    """A crane about the QTZ5613: tower and jib of like stiffness for their size, counterweight in balance."""
    height, reach = rng.uniform(15.0, 60.0), rng.uniform(30.0, 70.0)
    tower = Beam(height, rng.uniform(250.0, 900.0), STEEL, 0.014 * (height / 23.8) ** 1.5 * rng.uniform(0.6, 2.0))
    jib = Beam(reach, rng.uniform(80.0, 180.0), STEEL, 0.0035 * (reach / 55.6) ** 3 * rng.uniform(0.7, 3.0))
    counter = rng.uniform(0.18, 0.28) * reach
    balance = rng.uniform(0.7, 1.3) * jib.mass * reach / 2.0 / counter
    return TowerCrane(
        name="drawn",
        tower=tower,
        jib=jib,
        counter_jib_length=counter,
        counter_jib_mass_per_length=rng.uniform(100.0, 250.0),
        counterweight=balance,
        trolley_mass=rng.uniform(200.0, 600.0),
    )


def _motion(rng: np.random.Generator, start: float, end: float, fastest: float) -> Motion:
    speed, acceleration = rng.uniform(0.2, fastest), np.exp(rng.uniform(np.log(0.05), np.log(0.4)))
    shape = rng.choice(["trapezoid", "s-curve", "smooth"], p=[0.6, 0.2, 0.2])
    if shape == "trapezoid":
        return trapezoid(start, end, speed, acceleration)
    if shape == "s-curve":
        return s_curve(start, end, speed, acceleration, acceleration / rng.uniform(0.3, 2.0))
    ramp = speed / acceleration
    hold = abs(end - start) / speed - ramp
    if hold < 0.0:
        ramp, hold = abs(end - start) / speed, 0.0
    return smooth_ramps(start, float(np.copysign(speed, end - start)), ramp, hold)
