"""Varied cranes, drawn by a seeded generator: towers from stubby to slender, of one piece and of several."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf, pi
from typing import TYPE_CHECKING

import numpy as np

from modal.beams.beam import Beam, EndBody
from modal.beams.chain import Chain, Foundation
from modal.beams.segment import Segment
from modal.beams.torsion import Shaft
from towercrane.cranes.tower.file.members import TAPER_POWERS
from towercrane.cranes.tower.modes.parameters import TowerCrane

if TYPE_CHECKING:
    from numpy.random import Generator

STEEL = 206e9
"""Young's modulus [Pa]."""


@dataclass(frozen=True)
class Build:
    """How a drawn tower is built: a plain beam, or pieces that may be soft in shear on ground that may give way."""

    share: float
    plain: bool = False
    soft_in_shear: bool = True
    of_pieces: bool = False
    on_springs: bool = False


BUILDS = (
    Build(0.25, plain=True),
    Build(0.25),
    Build(0.2, soft_in_shear=False, on_springs=True),
    Build(0.3, of_pieces=True),
)
"""What is not said of a build is true of half of its towers."""


def spread(rng: Generator, low: float, high: float) -> float:
    """A number whose logarithm is spread evenly."""
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def familiar_crane(rng: Generator) -> TowerCrane:
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


def any_crane(rng: Generator) -> TowerCrane:
    """A crane of any size: its jib and tower as stiff as their natural frequencies want, its tower of any kind."""
    height, reach = spread(rng, 10.0, 110.0), spread(rng, 18.0, 80.0)
    mass = spread(rng, 60.0, 350.0)
    # The first root of a cantilever is 1.875.
    bending = mass * (2.0 * pi * spread(rng, 0.25, 6.0)) ** 2 * (reach / 1.875) ** 4
    jib = Beam(reach, mass, STEEL, bending / STEEL)
    counter = rng.uniform(0.18, 0.45) * reach
    crane = TowerCrane(
        name="drawn",
        tower=Beam(height, 1.0, STEEL, 1.0),
        jib=jib,
        counter_jib_length=counter,
        counter_jib_mass_per_length=rng.uniform(50.0, 250.0),
        counterweight=rng.uniform(0.5, 1.5) * jib.mass * reach / 2.0 / counter,
        trolley_mass=spread(rng, 100.0, 1200.0),
    )
    return replace(crane, tower=_tower(rng, height, crane.slewing_mass, crane.slewing_inertia))


def in_space(rng: Generator, crane: TowerCrane) -> TowerCrane:
    """A crane of the plane with a jib that bends to its sides and a tower that twists."""
    jib, height = crane.jib, crane.tower.length
    assert isinstance(jib, Beam), "drawn as one"
    lateral = Beam(jib.length, jib.mass_per_length, STEEL, jib.second_moment_of_area * spread(rng, 0.2, 1.5))
    # The whole twists at between a tenth and twice its frequency in bending, or thereabouts.
    inertia = crane.slewing_inertia
    stiffness = height * inertia * (2.0 * pi * spread(rng, 0.15, 2.0)) ** 2
    return replace(crane, jib_lateral=lateral, shaft=Shaft(height, spread(rng, 200.0, 1500.0), stiffness))


def _tower(rng: Generator, height: float, load: float, inertia: float) -> Beam | Chain:
    """A tower whose first frequency under the slewing part is about one that is drawn."""
    frequency, mass = spread(rng, 0.2, 2.5), spread(rng, 200.0, 1200.0)
    heavy = load + 0.25 * mass * height + inertia / height**2
    bending = heavy * (2.0 * pi * frequency) ** 2 * height**3 / 3.0
    build = BUILDS[rng.choice(len(BUILDS), p=[one.share for one in BUILDS])]
    if build.plain:
        return Beam(height, mass, STEEL, bending / STEEL)
    shear = bending / height**2 * spread(rng, 1.0, 100.0) if build.soft_in_shear or rng.random() < 0.5 else inf
    rotary = mass * rng.uniform(0.3, 1.5) ** 2 if rng.random() < 0.5 else 0.0
    pieces: list[Segment] = []
    lengths = rng.dirichlet(np.full(rng.integers(2, 5), 4.0)) * height if build.of_pieces else [height]
    share = 1.0
    for length in lengths:
        ratio, powers = 1.0, (0.0, 2.0, 0.0)
        if rng.random() < 0.6:
            ratio, powers = rng.uniform(0.4, 1.0), TAPER_POWERS[str(rng.choice(list(TAPER_POWERS)))]
        stiff = shear if not build.of_pieces or rng.random() < 0.5 else inf
        pieces.append(
            Segment(float(length), mass * share, bending * share, stiff * share, rotary * share, ratio, *powers)
        )
        share *= rng.uniform(0.5, 1.0)
    foundation = Foundation()
    if build.on_springs or rng.random() < 0.5:
        sliding = spread(rng, 2e7, 1e10) if rng.random() < 0.5 else inf
        foundation = Foundation(bending / height * spread(rng, 0.5, 100.0), sliding)
    bodies = {}
    if rng.random() < 0.3:
        bodies[0] = EndBody(spread(rng, 1e4, 2e5), spread(rng, 1e4, 1e6))
    if rng.random() < 0.2:
        bodies[len(pieces)] = EndBody(spread(rng, 500.0, 5000.0), spread(rng, 500.0, 1e4), rng.uniform(-1.0, 1.0))
    return Chain(tuple(pieces), bodies, foundation)
