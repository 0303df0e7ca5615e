"""Varied radial scenes, drawn by a seeded generator: cranes, loads, ropes, drives, starts."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from modal.beam import Beam
from towercrane.cranes.tower_crane import TowerCrane
from towercrane.motion import rest, s_curve, smooth_ramps, trapezoid
from towercrane.payload import Load
from towercrane.scene import RadialScene

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
