"""Equations of jibs on tie bars against virtual work on positions of points and energies of positions alone."""

import dataclasses
from functools import cache

import numpy as np
import pytest
from oracles.jets import Jet
from oracles.tied_points import TiedCloud
from samples import hammerhead as sample

from towercrane.cranes.slewing.description import Drive
from towercrane.cranes.tower.equations.body import body_of
from towercrane.cranes.tower.equations.head import head_of
from towercrane.cranes.tower.equations.jib import bend
from towercrane.cranes.tower.equations.motion import SLEWING_TORQUE, TROLLEY_FORCE, motion
from towercrane.cranes.tower.equations.tied.fields import move_fields
from towercrane.cranes.tower.model import FlexibleModel
from towercrane.cranes.tower.modes.damping import ModalDamping
from towercrane.cranes.tower.modes.modal_crane import flexible_crane
from towercrane.cranes.tower.modes.mode_counts import ModeCounts
from towercrane.cranes.tower.modes.tied.head import sums_on_axis
from towercrane.kernels.load import Load
from towercrane.kernels.payload import State
from towercrane.motions.motion import Motion

DRIVE = Drive("slewing", 4e6, 3e7, 0.02, 2e5, "none", 0.0, 1.0)

SCENES = {
    "head": {"lateral": 1, "aside": 1},
    "whole": {"tower": 2, "torsion": 1, "aside": 1, "vertical": 2, "back": 1},
    "planar": {"tower": 2, "lateral": 0, "planes": 1, "slewing": "fixed"},
    "lossy": {
        "tower": 1, "lateral": 1, "vertical": 0, "back": 0,
        "load": Load(5000.0, rope_damping=400.0, drag_area=6.0), "damping": ModalDamping(0.02, 0.01, 0.03, 0.05),
    },
    "driven": {"tower": 1, "torsion": 1, "slewing": DRIVE, "drive_inertia": 2e5, "lateral": 1, "back": 0},
}  # fmt: skip


class Moving:
    """A random state with moving drives, and what both sides say of it."""

    def __init__(self, rng, options):
        self.model = model = sample.model(**options)
        self.cloud = TiedCloud(model, options.get("crane", sample.CRANE))
        n = model.coordinates
        amplitude = 0.3 * model.system.scale[:n]
        amplitude[n - model.crane.tied.count :] *= 0.1
        rest = model.undeformed(np.zeros((len(model.channels), 3)))
        self.q, self.rates = rest + amplitude * rng.normal(size=n), amplitude * rng.normal(size=n)
        self.angles, self.angle_rates = rng.uniform([-2.5, -1.0], [2.5, 1.0]), rng.normal(size=2)
        if model.slewing == "fixed":
            self.angles[1] = self.angle_rates[1] = 0.0
        drives = {
            "trolley": [rng.uniform(2.0, 58.0), rng.normal(), rng.normal()],
            "rope": [rng.uniform(14, 30), rng.normal(), rng.normal()],
            "slewing": [rng.uniform(-3, 3), 0.2 * rng.normal(), 0.2 * rng.normal()],
        }
        if model.slewing == "fixed":
            drives["slewing"] = [0.0, 0.0, 0.0]
        self.extra = np.zeros(n + 2)
        if model.drive is not None:
            at = model.parts["slewing"]
            self.q[at], self.rates[at] = rng.uniform(-3, 3), 0.02 * rng.normal()
            drives["shaft"] = [float(self.q[at][0]) - 0.01, 0.1, 0.0]
            self.extra[at] = -DRIVE.soft * 0.01 - DRIVE.damping * (self.rates[at] - 0.1)
        self.inputs = np.array([drives[channel] for channel in model.channels])
        self.drives = [Jet(*drives[name]) for name in ("slewing", "trolley", "rope")]
        (theta, phi), (theta_rate, phi_rate) = self.angles, self.angle_rates
        s, c, sp, cp = np.sin(theta), np.cos(theta), np.sin(phi), np.cos(phi)
        e_theta, e_phi = np.array([c, 0, s]), np.array([-s * sp, cp, c * sp])
        rope = np.array([s * cp, sp, -c * cp])
        swing = cp * theta_rate * e_theta + phi_rate * e_phi
        axes = [0, 1, 2] if model.axes == 3 else [0, 2]
        self.state = np.concatenate([self.q, rope[axes], self.rates, swing[axes], [0.0]])
        self.slope, self.guards = (np.array(row) for row in motion(model.constants, 0.0, self.state, self.inputs))
        bending = np.zeros(3)
        bending[axes] = self.slope[2 * n + len(axes) : -1]
        self.found = np.concatenate([
            self.slope[n + len(axes) : 2 * n + len(axes)],
            [bending @ e_theta / cp + 2 * theta_rate * phi_rate * sp / cp, bending @ e_phi - theta_rate**2 * sp * cp],
        ])  # fmt: skip

    def check_sections(self, columns):
        """Base and drives carry what every point needs."""
        model, cloud, n = self.model, self.cloud, self.model.coordinates
        sums, sizes = cloud.left_over(*self.drawn(), self.found, self.drives, columns, np.zeros(3))
        bound = 1e-9 * sizes[n + 2 :]
        if model.drive is None and model.slewing != "fixed":
            assert abs(self.guards[SLEWING_TORQUE] - sums[n + 2]) < bound[0]
        assert abs(self.guards[TROLLEY_FORCE] - sums[n + 3]) < bound[1]
        span = np.array([0.0, 1.0])
        motions = {c: Motion(span, row[None]) for c, row in zip(model.channels, self.inputs, strict=True)}
        seen = model.observe(motions, np.zeros(1), self.state[None], self.slope[None], self.guards[None])
        force, moment, size = np.zeros(3), np.zeros(3), 0.0
        for name, points in cloud.now.items():
            arm = points.derivative(0) + np.array([0.0, 0.0, model.crane.tower_height])
            if name == "tower":
                arm[:, 2] = cloud.height
            force += cloud.felt[name].sum(axis=0)
            moment += np.cross(arm, cloud.felt[name]).sum(axis=0)
            size += abs(np.cross(arm, cloud.felt[name])).sum()
        part = model.parts["torsion"]
        inertia = model.crane.torsion.shaft.inertia_per_length * cloud.tower_weights
        moment[2] += inertia @ (self.found[:-2][part] @ cloud.twists)
        carried = {"base_moment_x": moment[0], "base_moment_y": moment[1], "base_torque": moment[2]}
        carried |= {f"base_force_{axis}": own for axis, own in zip("xyz", force, strict=True)}
        for name, needed in carried.items():
            if name in seen:
                assert abs(seen[name].values[0] + needed) < 1e-10 * size, name
        jib = [name for name in cloud.now if name in ("jib", "trolley", "load")]
        along = np.array([row[0].c[0] for row in cloud.axes]).ravel()
        pushed = -sum(cloud.felt[name].sum(axis=0) for name in jib) @ along
        for k, tension in enumerate(self.guards[-model.counts["tie"] :][: len(cloud.bars.jib)]):
            pushed -= tension * cloud.forward(self.q, k)
        assert abs(seen["jib_compression"].values[0] + pushed) < 1e-9 * abs(pushed)

    def drawn(self):
        return np.concatenate([self.q, self.angles]), np.concatenate([self.rates, self.angle_rates])


@cache
def states(name):
    rng = np.random.default_rng(5)
    options = SCENES[name]
    axes = {"axes": 2} if options.get("planes") == 1 else {}
    return [Moving(rng, {**options, **axes})]


@pytest.mark.parametrize("name", SCENES)
def test_accelerations_and_tensions_follow_from_positions_and_energies(name):
    for at in states(name):
        columns = at.cloud.displace(at.drawn()[0], at.drives)
        expected, mass = at.cloud.accelerations(*at.drawn(), at.drives, columns, np.zeros(3), at.extra)
        size = np.sqrt(np.diag(mass))
        assert np.max(abs(at.found - expected) * size) < 1e-10 * np.max(abs(expected) * size)
        at.check_sections(columns)
        at.cloud.energy([Jet(value) for value in at.q])
        assert np.allclose(at.guards[-len(at.cloud.tensions) :], at.cloud.tensions, rtol=1e-10)


def test_points_that_move_across_an_axis_are_the_plain_jib():
    """Sections that turn about their own axes among them."""
    heavy = {
        name: dataclasses.replace(
            chain, segments=tuple(dataclasses.replace(own, rotary_inertia=300.0) for own in chain.segments)
        )
        for name, chain in (("jib", sample.JIB), ("jib_lateral", sample.SIDEWAYS), ("counter_jib", sample.COUNTER),
                            ("counter_jib_lateral", sample.COUNTER))
    }  # fmt: skip
    plain = dataclasses.replace(sample.CRANE, tie_bars=None, roll_inertia=4e4, **heavy)
    model = FlexibleModel(flexible_crane(plain, ModeCounts(1, 1, 2, 2, 1, 1)), Load(2000.0))
    crane, n = model.constants, model.coordinates
    rng = np.random.default_rng(2)
    q, rates = model.system.scale[:n] * rng.normal(size=(2, n))
    state = State(list(q), (), list(rates), ())
    head, _ = head_of(crane, state, [(20.0, 0.0, 0.0), (10.0, 0.0, 0.0), (0.4, 0.3, 0.2)])
    felt = tuple(9.81 * down for down in head.rotation[6:])
    left, up = bend(crane, head, felt, state)
    expected = body_of(crane.straight, head, felt, left.sums, up.sums)
    sums = sums_on_axis(model.crane.slewing, 3, 6)
    body, forces, rows, rate = move_fields(sums, head, felt, q[-6:], rates[-6:])
    assert np.allclose(rate, (0.0, left.sums.first_rate, up.sums.first_rate), rtol=1e-12)
    for one, other in zip(body, expected, strict=True):
        assert np.allclose(one, other, rtol=1e-12, atol=1e-12 * np.max(np.abs(other)))
    assert np.allclose(forces, left.forces + up.forces, rtol=1e-12, atol=1e-12 * np.max(np.abs(forces)))
    arms = [
        (-c, 0.0, b)
        for b, c in zip((crane.jib_moment + crane.jib_turning)[list(crane.lateral)], left.across, strict=True)
    ]
    arms += [(c, -b, 0.0) for b, c in zip((crane.jib_moment + crane.jib_turning)[list(crane.vertical)], up.across,
                                          strict=True)]  # fmt: skip
    assert np.allclose([moment for _, moment in rows], arms, rtol=1e-12, atol=1e-9)
    assert np.allclose(np.sum([momentum for momentum, _ in rows], axis=1), crane.jib_mass[-6:], rtol=1e-12)
