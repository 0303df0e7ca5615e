"""Equations and outputs of a jib that pivots against virtual work on positions of points and energies alone."""

import dataclasses
from functools import cache, cached_property

import numpy as np
import pytest
from numpy.testing import assert_allclose
from oracles.balance import imbalance
from oracles.jets import Jet
from oracles.luffing_points import LuffingCloud
from samples import luffing_crane as sample

from towercrane.cranes.parts.wind import CHANNELS, WindAreas
from towercrane.cranes.slewing.description import Drive
from towercrane.cranes.tower.equations.constants import SLIDE_X, SLIDE_Y
from towercrane.cranes.tower.equations.luffing import motion as luffing
from towercrane.cranes.tower.equations.luffing.pivot import pivot_at
from towercrane.cranes.tower.equations.luffing.ropes import tied_at, way_to
from towercrane.cranes.tower.equations.structure import structure
from towercrane.cranes.tower.model import FlexibleModel
from towercrane.cranes.tower.modes.damping import ModalDamping
from towercrane.kernels.load import Load
from towercrane.kernels.payload import State
from towercrane.motions.motion import Motion
from towercrane.motions.profiles import speed_trapezoid, trapezoid
from towercrane.simulation.simulate import simulate

AREAS = WindAreas(tower=3.0, jib=1.2, counter_jib=1.5, counterweight=8.0)
DRIVE = Drive("slewing", 4e6, 3e7, 0.02, 2e5, "tanh", 3e4, 0.01)
LOSSY = {
    "load": Load(5000.0, rope_damping=400.0, drag_area=6.0),
    "damping": ModalDamping(0.02, 0.01, 0.03, 0.05),
    "weight_softening": False,
}
SOFT = sample.crane(axial_stiffness=sample.AXIAL)
BEHIND = dataclasses.replace(SOFT, counter_jib_length=6.0, counter_jib_mass_per_length=200.0, counterweight=9e3)

SCENES = {
    "rigid": {"lateral": 0, "vertical": 0},
    "jib": {"lateral": 2, "vertical": 3, "crane": SOFT},
    "tower": {"tower": 2, "torsion": 1, "lateral": 0, "vertical": 0},
    "whole": {"tower": 2, "torsion": 1, "crane": BEHIND},
    "planar": {"tower": 2, "lateral": 0, "vertical": 2, "planes": 1, "slewing": "fixed", "crane": SOFT},
    "lossy": {"tower": 1, "torsion": 1, "crane": SOFT, **LOSSY},
    "windy": {"tower": 1, "torsion": 1, "crane": BEHIND, "wind": 1, "areas": AREAS, **LOSSY},
    "weightless": {"tower": 1, "torsion": 1, "self_weight": False},
    "driven": {"tower": 1, "torsion": 1, "slewing": DRIVE, "drive_inertia": 2e5, "crane": SOFT, **LOSSY},
}


class Moving:
    """A random state with moving drives, and what both sides say of it."""

    def __init__(self, rng, options):
        self.model = model = sample.model(**options)
        self.cloud = LuffingCloud(model, options.get("crane", sample.CRANE), options.get("areas"))
        n = self.n = model.coordinates
        amplitude = 0.3 * model.system.scale[:n]
        self.q, self.rates = amplitude * rng.normal(size=n), amplitude * rng.normal(size=n)
        self.q[-1] = rng.uniform(0.3, 1.4)
        self.angles, self.angle_rates = rng.uniform([-2.5, -1.0], [2.5, 1.0]), rng.normal(size=2)
        drives = {
            "luffing": [self.q[-1] + 0.01 * rng.normal(), 0.1 * rng.normal(), rng.normal()],
            "rope": [rng.uniform(14, 30), rng.normal(), rng.normal()],
            "slewing": [rng.uniform(-3, 3), 0.2 * rng.normal(), 0.2 * rng.normal()],
        }
        self.wind = rng.normal(size=3) * 12.0 if model.wind else np.zeros(3)
        drives |= {c: [speed, 0.0, 0.0] for c, speed in zip(CHANNELS, self.wind, strict=True)}
        if model.slewing == "fixed":
            drives["slewing"] = [0.0, 0.0, 0.0]
        if model.drive is not None:
            at = model.parts["slewing"]
            self.q[at], self.rates[at] = rng.uniform(-3, 3), 0.02 * rng.normal()
            drives["shaft"] = [float(self.q[at][0]) + rng.choice([-0.05, -0.01, 0.01, 0.05]), 0.1, 0.0]
        self.inputs = np.array([drives[channel] for channel in model.channels])
        self.drives = [Jet(*drives[name]) for name in ("slewing", "luffing", "rope")]
        (theta, phi), (theta_rate, phi_rate) = self.angles, self.angle_rates
        s, c, sp, cp = np.sin(theta), np.cos(theta), np.sin(phi), np.cos(phi)
        e_theta, e_phi = np.array([c, 0, s]), np.array([-s * sp, cp, c * sp])
        rope = np.array([s * cp, sp, -c * cp])
        swing = cp * theta_rate * e_theta + phi_rate * e_phi
        self.state = np.concatenate([self.q, rope, self.rates, swing, [0.0]])
        self.slope, self.guards = (
            np.array(row) for row in luffing.motion(model.constants, 0.0, self.state, self.inputs)
        )
        bending = self.slope[2 * n + 3 : -1]
        self.found = np.concatenate([
            self.slope[n + 3 : 2 * n + 3],
            [bending @ e_theta / cp + 2 * theta_rate * phi_rate * sp / cp, bending @ e_phi - theta_rate**2 * sp * cp],
        ])  # fmt: skip
        self.extra = np.zeros(n + 2)
        if model.drive is not None:
            self.extra[at] = self.drive_torque(drives["shaft"])

    def drive_torque(self, shaft):
        at, drive = self.model.parts["slewing"].start, self.model.drive
        twist, slip = self.q[at] - shaft[0], self.rates[at] - shaft[1]
        inside = np.clip(twist, -drive.corner, drive.corner)
        friction = drive.friction_torque * np.tanh(self.rates[at] / drive.friction_rate)
        return -drive.soft * inside - drive.stiff * (twist - inside) - drive.damping * slip - friction

    @cached_property
    def columns(self):
        return self.cloud.displace(self.drawn()[0], self.drives)

    def left_over(self):
        """Work that inertia and forces leave over, per displacement of coordinates, the load's angles and drives."""
        return self.cloud.left_over(*self.drawn(), self.found, self.drives, self.columns, self.wind)

    def observed(self):
        span = np.array([0.0, 1.0])
        motions = {c: Motion(span, row[None]) for c, row in zip(self.model.channels, self.inputs, strict=True)}
        return self.model.observe(motions, np.zeros(1), self.state[None], self.slope[None], self.guards[None])

    def drawn(self):
        return np.concatenate([self.q, self.angles]), np.concatenate([self.rates, self.angle_rates])


@cache
def states(name):
    rng = np.random.default_rng(7)
    return [Moving(rng, SCENES[name]) for _ in range(3 if name == "whole" else 1)]


@pytest.mark.parametrize("name", SCENES)
def test_accelerations_follow_from_positions_and_energies(name):
    for at in states(name):
        expected, mass = at.cloud.accelerations(*at.drawn(), at.drives, at.columns, at.wind, at.extra)
        size = np.sqrt(np.diag(mass))
        assert np.max(abs(at.found - expected) * size) < 1e-11 * np.max(abs(expected) * size)


def test_ways_of_ropes_over_the_head_follow_from_places():
    for at in states("whole"):
        own, model = at.model.constants.luffing, at.model
        moving = [Jet(q, rate) for q, rate in zip(at.q, at.rates, strict=True)]
        expected = at.cloud.ways(at.cloud.split(moving), moving[-1])
        part, pivot = slice(model.constants.movers, -1), pivot_at(at.q[-1], at.rates[-1])
        for anchor, above, way in zip(
            (own.frame_head, own.winch), (own.attachment, 0.0), expected, strict=True
        ):  # fmt: skip
            found = way_to(own, anchor, tied_at(own, at.q[part], at.rates[part], above), pivot)
            assert_allclose([found.length, found.rate], [jet.item() for jet in way.c[:2]], rtol=1e-12, atol=1e-12)
            assert abs(found.bias - 2.0 * way.c[2].item()) < 1e-11 * abs(found.bias)


@pytest.mark.parametrize("name", SCENES)
def test_drives_hold_what_virtual_work_asks(name):
    for at in states(name):
        n = at.n
        sums, sizes = at.left_over()
        assert np.max(abs(sums[: n + 2] - at.extra) / (sizes[: n + 2] + abs(at.extra))) < 3e-12
        torque, lifting, pull = sums[n + 2 :]
        scale = 1e-11 * sizes[n + 2 :]
        if at.model.drive is None:
            assert abs(at.guards[luffing.SLEWING_TORQUE] - torque) < scale[0]
        assert abs(at.guards[luffing.TENSION] + pull) < scale[2]
        tension, crane = at.guards[luffing.HOLDING], at.cloud.crane
        assert abs(tension - at.cloud.holding) < 1e-11 * abs(tension) + 1e-3
        # The winch's power, per rate of the commanded angle.
        lever = crane.luffing.lever(crane.jib.length, at.inputs[0, 0])
        power = (tension + 0.5 * tension**2 / crane.luffing.rope_stiffness) * lever
        assert abs(lifting - power) < 1e-9 * sizes[n + 3]


@pytest.mark.parametrize("name", SCENES)
def test_the_base_carries_what_moves_above_it(name):
    for at in states(name):
        at.left_over()
        felt, points, model = at.cloud.felt, at.cloud.now, at.model
        seen = at.observed()
        moments, sizes = np.zeros(3), 0.0
        for part, cloud in points.items():
            arm = cloud.derivative(0) + np.array([0.0, 0.0, model.crane.tower_height])
            if part == "tower":
                arm[:, 2] = at.cloud.height
            moments += np.cross(arm, felt[part]).sum(axis=0)
            sizes += abs(np.cross(arm, felt[part])).sum()
        part = model.parts["torsion"]
        inertia = model.crane.torsion.shaft.inertia_per_length * at.cloud.tower_weights
        moments[2] += inertia @ (at.found[:-2][part] @ at.cloud.twists)
        names = ["base_moment_y"] if model.axes == 2 else ["base_moment_x", "base_moment_y", "base_torque"]
        base = [seen[name].values[0] for name in names]
        expected = moments[[1]] if model.axes == 2 else moments
        assert np.max(abs(base + expected)) < 1e-11 * sizes


def along(direction):
    """Numbers of a list of Jets."""
    return np.array([jet.c[0] for jet in direction]).ravel()


@pytest.mark.parametrize("name", SCENES)
def test_the_foot_carries_jib_load_and_both_ropes(name):
    for at in states(name):
        at.left_over()
        felt, points, own = at.cloud.felt, at.cloud.now, at.cloud.own
        part, angle = at.cloud.split([Jet(q) for q in at.q]), at.q[-1]
        axes = np.array([along(row) for row in at.cloud.axes])
        top = np.zeros(3)
        top[:2] = at.model.constants.motions[[SLIDE_X, SLIDE_Y]] @ at.q

        def fixed(x, z, axes=axes, top=top):
            return top + axes @ [x, 0.0, z]

        foot = fixed(*own.foot)
        loads = [(cloud.derivative(0), -felt[k]) for k, cloud in points.items() if k in ("jib", "sheaves", "load")]
        for anchor, above, tension in (
            (own.winch, 0.0, at.guards[luffing.TENSION] / own.falls),
            (own.frame_head, own.attachment, at.guards[luffing.HOLDING]),
        ):
            head = top + axes @ along(at.cloud.on_jib(Jet(angle), *at.cloud.tied(part, above)))
            way = fixed(*anchor) - head
            loads.append((head[None], tension * way[None] / np.linalg.norm(way)))
        force = sum(pushed.sum(axis=0) for _, pushed in loads)
        moment = sum(np.cross(place - foot, pushed).sum(axis=0) for place, pushed in loads)
        sizes = sum(abs(np.cross(place - foot, pushed)).sum() for place, pushed in loads)
        seen = at.observed()
        chord, square = axes @ [np.cos(angle), 0.0, np.sin(angle)], axes @ [-np.sin(angle), 0.0, np.cos(angle)]
        assert abs(seen["jib_compression"].values[0] + force @ chord) < 1e-11 * sizes
        if "jib_root_moment_sideways" in seen:
            assert abs(seen["jib_root_moment_sideways"].values[0] + moment @ square) < 1e-11 * sizes


def test_a_jib_held_level_at_the_tower_is_one_with_its_trolley_at_the_end():
    """Without shortening, luffing rope and hoist rope on the jib, and with nothing beside the axis."""
    behind = {"counter_jib_length": 6.0, "counter_jib_mass_per_length": 200.0, "counterweight": 9e3}
    crane = dataclasses.replace(
        sample.crane(foot=(0.0, 0.0), rope_stiffness=1e-30, falls=10**18, reference_angle=0.0, bodies=()), **behind
    )
    model = sample.model(tower=2, torsion=1, crane=crane)
    own = dataclasses.replace(
        model.constants.luffing, shortening=np.zeros((4, 4)), weighted=np.zeros((4, 4)), attachment=0.0
    )
    constants = dataclasses.replace(model.constants, luffing=own)
    fixed = FlexibleModel(dataclasses.replace(model.crane, luffing=None), model.load)
    rng = np.random.default_rng(3)
    n = fixed.coordinates
    q, rates = (0.3 * fixed.system.scale[:n] * rng.normal(size=n) for _ in range(2))
    rope, slewing = (15.0, 0.3, -0.2), (0.7, 0.1, 0.3)
    held = State(np.append(q, 0.0), (), np.append(rates, 0.0), ())
    found = luffing.structure(constants, held, [(0.0, 0.0, 0.0), rope, slewing])
    end = (crane.jib.length, 0.0, 0.0)
    expected = structure(fixed.constants, State(q, (), rates, ()), [end, rope, slewing]).hanging
    mass, wanted = found.hanging.mass_matrix()[:n, :n], expected.mass_matrix()
    assert_allclose(mass, wanted, rtol=0.0, atol=1e-12 * abs(wanted).max())
    assert_allclose(found.hanging.force[:n], expected.force, rtol=1e-11, atol=1e-9)
    assert_allclose(found.hanging.velocity, expected.velocity, rtol=1e-12)
    assert_allclose(found.hanging.bias, expected.bias, rtol=1e-12, atol=1e-12)
    assert_allclose(np.array(found.hanging.jacobian)[:, :n], expected.jacobian, rtol=1e-12, atol=1e-13)
    assert_allclose([found.rope.length, found.rope.rate, found.rope.acceleration], rope, rtol=1e-13)
    assert abs(found.held.tension) < 1e-20


def test_energy_of_a_manoeuvre_is_what_drives_put_in():
    crane = sample.crane(axial_stiffness=sample.AXIAL, reference_angle=np.radians(30.0))
    model = sample.model(tower=1, torsion=1, crane=crane)
    motions = {
        "slewing": speed_trapezoid(0.0, 0.07, 6.0, 0.5 * np.pi / 0.07 - 6.0),
        "luffing": trapezoid(np.radians(30.0), np.radians(57.0), 0.012, 0.004),
        "rope": trapezoid(30.0, 15.0, 0.4, 0.2),
    }
    run = simulate(model, motions, 70.0, output_step=0.5, rtol=1e-10, atol=1e-12)
    assert run.attrs["outcome"] == "finished"
    assert imbalance(run) < 1e-11
    # All of it moved, and none of the ropes was slack.
    assert float(np.ptp(run["luffing_angle"].values)) > np.radians(26.0)
    assert float(run["luffing_rope_force"].min()) > 1e5
