"""What lumped cranes do to their base: against second derivatives of the positions of every mass."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.polynomial.legendre import leggauss
from numpy.testing import assert_allclose
from oracles.jets import Jet, total
from samples import jib_cranes, lab_crane, overhead_crane

from towercrane.cranes.jib.model import TORQUES, DrivenJibCrane
from towercrane.cranes.overhead.model import OverheadModel
from towercrane.kernels.load import Load
from towercrane.kernels.payload import state_of
from towercrane.motions.motion import Motion

LOAD = Load(1500.0, rope_damping=300.0, drag_area=2.0)
G = 9.81
SPAN = np.array([0.0, 1.0])
POINTS, WEIGHTS = leggauss(12)


class Drawn:
    """A model in a state at random, with its slopes, and its coordinates, rope and drives as Jets."""

    def __init__(self, model, inputs, count, seed, size):
        random = np.random.default_rng(seed)
        self.model, self.inputs = model, np.array(inputs)
        state = size * random.normal(size=model.system.size)
        half = (len(state) - 1) // 2
        direction, swing = np.array([0.3, -0.2, -1.0]) + 0.2 * random.normal(size=3), random.normal(size=3)
        self.elastic = model.system.constants.load.elasticity is not None
        if not self.elastic:
            # On an elastic rope it is the load's own place, far below.
            direction /= np.linalg.norm(direction)
            swing -= direction * (swing @ direction)
        state[half - 3 : half], state[2 * half - 3 : 2 * half] = direction, swing
        self.state = state
        self.slopes, self.guards = model.system.slope(0.0, state, self.inputs)
        now, moved = state_of(state, count, 3), state_of(self.slopes, count, 3)
        self.q, self.rope = (
            [Jet(*own) for own in zip(here, rates, 0.5 * np.asarray(seconds), strict=True)]
            for here, rates, seconds in (
                (now.coordinates, now.rates, moved.rates),
                (now.direction, now.swing, moved.swing),
            )
        )
        self.drives = [Jet(*row[:3]) for row in self.inputs]

    def observed(self):
        motions = {name: Motion(SPAN, row[None]) for name, row in zip(self.model.channels, self.inputs, strict=True)}
        seen = self.model.observe(motions, np.zeros(1), self.state[None], self.slopes[None], self.guards[None])
        return {name: quantity.values[0] for name, quantity in seen.items()}


def reaction(points):
    """Force and moment about the origin of points (place as 3 Jets, mass, drag), and their sizes."""
    force, moment, sizes = np.zeros(3), np.zeros(3), np.zeros(2)
    for place, mass, drag in points:
        at, velocity, half = (
            np.stack([np.broadcast_to(Jet.of(jet).c[k], np.shape(mass)) for jet in place], axis=-1) for k in range(3)
        )
        speed = np.linalg.norm(velocity, axis=-1, keepdims=True)
        own = -np.asarray(mass)[..., None] * (2.0 * half + [0.0, 0.0, G]) - drag * speed * velocity
        force += own.reshape(-1, 3).sum(axis=0)
        moment += np.cross(at, own).reshape(-1, 3).sum(axis=0)
        sizes += abs(own).sum(), abs(np.cross(at, own)).sum()
    return force, moment, sizes


def agree(seen, points, more=(0.0, 0.0, 0.0), names="xyz"):
    force, moment, (forces, moments) = reaction(points)
    moment = moment + more
    found = [seen[f"base_force_{axis}"] for axis in "xyz"]
    assert_allclose(found, force, rtol=0, atol=1e-12 * forces)
    assert_allclose(seen["base_shear"], np.hypot(*force[:2]), rtol=0, atol=1e-12 * forces)
    if "base_torque" not in seen:
        return
    found = [seen["base_moment_x"], seen["base_moment_y"], seen["base_torque"]]
    assert_allclose(found, moment, rtol=0, atol=1e-12 * moments)
    assert_allclose(seen["overturning_moment"], np.hypot(*moment[:2]), rtol=0, atol=1e-12 * moments)


def hung(at, place, length):
    load = at.model.load
    beside = at.rope if at.elastic else [own + length * n for own, n in zip(place, at.rope, strict=True)]
    return beside, load.mass, load.drag


def turned(angle, ahead, left):
    c, s = angle.cos(), angle.sin()
    return c * ahead - s * left, s * ahead + c * left


@pytest.mark.parametrize("kind", ["basic", "enhanced", "multi-mass"])
def test_a_slewing_crane_does_to_its_base_what_all_its_masses_resist(kind):
    model = replace(lab_crane.crane(kind, drag_jib_tip=0.3), load=replace(LOAD, mass=50.0, rope_damping=3.0))
    crane, names = model.crane, model.crane.coordinates
    for seed in range(4):
        at = Drawn(model, [[0.3, 0.5, -0.2], [2.0, -0.3, 0.4]], len(names), seed, 0.3)
        values = dict(zip(names, at.q, strict=True)) | {"": Jet(1.0)}

        def form(row, values=values):
            return total(factor * values[name] for name, factor in row.items())

        points, places = [], {}
        for name, point in crane.points.items():
            arms = [turned(values[a.turns_with], form(a.ahead), form(a.across)) for a in point.links]
            places[name] = [total(arm[k] for arm in arms) for k in range(2)] + [form(point.height)]
            points.append((places[name], point.mass, point.drag))
        points.append(hung(at, places[crane.suspension], at.drives[1]))
        spun = sum(inertia * 2.0 * float(values[name].c[2]) for name, inertia in crane.inertias.items())
        more = np.array([0.0, 0.0, -spun])
        if kind == "enhanced":
            # 90 kg m of counterweight behind the tower.
            more += (
                90.0 * G * np.array([np.sin(values["tower_angle"].c[0]), -np.cos(values["tower_angle"].c[0]), 0.0])
            )
        agree(at.observed(), points, more)


def test_the_torque_on_the_base_is_that_of_drive_and_friction():
    """Nothing else acts about the vertical where air and hinge take nothing."""
    for kind in ("basic", "enhanced", "multi-mass"):
        model = replace(lab_crane.crane(kind, drag_jib_tip=0.0), load=Load(50.0))
        for seed in range(3):
            at = Drawn(model, [[0.3, 0.5, -0.2], [2.0, -0.3, 0.4]], len(model.crane.coordinates), seed, 0.3)
            seen, rate = at.observed(), float(at.q[model.crane.coordinates.index("platform_angle")].c[1])
            needed = seen["drive_torque"] - 22.0 * np.tanh(rate / 0.01)
            assert_allclose(seen["base_torque"], -needed, rtol=1e-10, atol=1e-9)


def test_a_jib_crane_does_to_its_base_what_booms_and_load_resist():
    crane = jib_cranes.HEAVY
    planned = [[0.4, 0.2, -0.1], [0.7, -0.15, 0.2], [-0.3, 0.1, 0.3], [9.0, 0.4, -0.2]]
    driven = [[3e4, 0.0, 0.0], [6e5, 0.0, 0.0], [2e5, 0.0, 0.0], planned[3]]
    for model, inputs, count in (
        (jib_cranes.planned(load=LOAD), planned, 0),
        (DrivenJibCrane(crane, LOAD, (0.0, 0.5, -0.2)), driven, 3),
    ):
        assert count == 0 or model.channels[:3] == TORQUES[:3]
        for seed in range(3):
            at = Drawn(model, inputs, count, seed, 0.4)
            slew, luff, fold = at.q if count else at.drives[:3]
            points, foot = [], [Jet(0.0), Jet(0.0), Jet(crane.post_height)]
            for mass, length, angle in (
                (crane.primary_mass, crane.primary_length, luff),
                (crane.secondary_mass, crane.secondary_length, luff + fold),
            ):
                boom = [*turned(slew, length * angle.cos(), Jet(0.0)), length * angle.sin()]
                part = Jet(0.5 * (POINTS + 1.0))
                places = [p + part * b for p, b in zip(foot, boom, strict=True)]
                points.append((places, 0.5 * mass * WEIGHTS, 0.0))
                foot = [p + b for p, b in zip(foot, boom, strict=True)]
            points.append(hung(at, foot, at.drives[3]))
            agree(at.observed(), points, [0.0, 0.0, -crane.post_inertia * 2.0 * float(slew.c[2])])


def test_an_overhead_crane_does_to_its_runway_what_bridge_trolley_and_load_resist():
    crane = overhead_crane.SMALL
    model = OverheadModel(crane, LOAD)
    for seed in range(3):
        at = Drawn(model, [[2.0, 0.5, -0.3], [4.0, 0.4, 0.2], [5.0, -0.2, 0.1]], 1, seed, 0.05)
        bridge, trolley, length = at.drives
        wave = np.pi / crane.bridge_span
        along = 0.5 * crane.bridge_span * (POINTS + 1.0)
        girder = [bridge, Jet(along), np.sin(wave * along) * at.q[0]]
        hangs = [bridge, trolley, (wave * trolley).sin() * at.q[0]]
        points = [
            (girder, 0.5 * crane.girder_mass * WEIGHTS, 0.0), (hangs, crane.trolley_mass, 0.0),
            ([bridge, Jet(0.0), Jet(0.0)], crane.bridge_end_carriage_mass, 0.0), hung(at, hangs, length),
        ]  # fmt: skip
        seen = at.observed()
        assert "overturning_moment" not in seen
        agree(seen, points)
        assert_allclose(-seen["base_force_z"], seen["first_rail_load"] + seen["second_rail_load"], rtol=1e-13)
