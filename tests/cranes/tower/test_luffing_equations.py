"""Equations of a jib that pivots against virtual work on positions of points and energies of positions alone."""

import dataclasses
from functools import cache

import numpy as np
import pytest
from oracles.jets import Jet
from oracles.luffing_points import LuffingCloud
from samples import luffing_crane as sample

from towercrane.cranes.slewing.description import Drive
from towercrane.cranes.tower.equations.luffing import motion as luffing
from towercrane.cranes.tower.modes.damping import ModalDamping
from towercrane.kernels.payload import Load

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
    "weightless": {"tower": 1, "torsion": 1, "self_weight": False},
    "driven": {"tower": 1, "torsion": 1, "slewing": DRIVE, "drive_inertia": 2e5, "crane": SOFT, **LOSSY},
}


class Moving:
    """A random state with moving drives, and what both sides say of it."""

    def __init__(self, rng, options):
        self.model = model = sample.model(**options)
        self.cloud = LuffingCloud(model, options.get("crane", sample.CRANE))
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

    def drawn(self):
        return np.concatenate([self.q, self.angles]), np.concatenate([self.rates, self.angle_rates])


@cache
def states(name):
    rng = np.random.default_rng(7)
    return [Moving(rng, SCENES[name]) for _ in range(2)]


@pytest.mark.parametrize("name", SCENES)
def test_accelerations_follow_from_positions_and_energies(name):
    for at in states(name):
        columns = at.cloud.displace(at.drawn()[0], at.drives)
        expected, mass = at.cloud.accelerations(*at.drawn(), at.drives, columns, np.zeros(3), at.extra)
        size = np.sqrt(np.diag(mass))
        assert np.max(abs(at.found - expected) * size) < 1e-11 * np.max(abs(expected) * size)
