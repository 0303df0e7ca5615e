"""The compiled equations of the flexible crane against virtual work on positions of points alone."""

import dataclasses
from functools import cache, cached_property

import numpy as np
import pytest
from oracles.jets import Jet
from oracles.space_points import CraneCloud
from samples import sectioned_crane as sectioned
from samples import space_crane as space

from towercrane.cranes.parts.ground import CHANNELS as GROUND
from towercrane.cranes.parts.wind import WindAreas, WindNodes, wind_channels
from towercrane.cranes.slewing.description import Drive
from towercrane.cranes.tower.equations.constants import SLIDE_X, SLIDE_Y
from towercrane.cranes.tower.equations.motion import SLEWING_TORQUE, TENSION, TROLLEY_FORCE
from towercrane.cranes.tower.modes.damping import ModalDamping
from towercrane.kernels.payload import Load
from towercrane.motions.motion import Motion

AREAS = WindAreas(tower=3.0, jib=1.2, counter_jib=1.5, counterweight=8.0)
DRIVE = Drive("slewing", 4e6, 3e7, 0.02, 2e5, "tanh", 3e4, 0.01)
LOSSY = {
    "load": Load(1500.0, rope_damping=400.0, drag_area=6.0),
    "damping": ModalDamping(0.02, 0.01, 0.03, 0.05, 0.04, 0.06),
    "weight_softening": True,
}
ROLLING = dataclasses.replace(space.CRANE, roll_inertia=3e5)
NODES = WindNodes(jib=2, tower=1)
BLOWN = {"wind": NODES.count, "areas": AREAS, "nodes": NODES}
SECTIONED = {"tower": 2, "torsion": 1, "lateral": 3, "vertical": 3, "counter": (2, 2), "crane": sectioned.CRANE}

SCENES = {
    "rigid": {"tower": 0, "torsion": 0, "lateral": 0, "vertical": 0},
    "one of each": {"tower": 1, "torsion": 1, "lateral": 1, "vertical": 1},
    "torsion": {"tower": 0, "torsion": 2, "lateral": 0, "vertical": 0},
    "jib": {"tower": 0, "torsion": 0, "lateral": 3, "vertical": 2},
    "planar tower": {"tower": 2, "torsion": 0, "lateral": 0, "vertical": 2, "planes": 1, "slewing": "fixed"},
    "whole": {"tower": 2, "torsion": 1, "lateral": 3, "vertical": 3, "crane": ROLLING},
    "lossy": {"tower": 2, "torsion": 1, "lateral": 2, "vertical": 2, **LOSSY},
    "weightless": {"tower": 1, "torsion": 1, "lateral": 1, "vertical": 2, "self_weight": False},
    "windy": {"tower": 2, "torsion": 1, "lateral": 1, "vertical": 2, "wind": True, "areas": AREAS, **LOSSY},
    "shaken": {"tower": 2, "torsion": 1, "lateral": 2, "vertical": 2, "ground": True, **LOSSY},
    "shaken in wind": {
        "tower": 1,
        "torsion": 1,
        "lateral": 1,
        "vertical": 1,
        "ground": True,
        "wind": True,
        "areas": AREAS,
        **LOSSY,
    },
    "shaken without weight": {
        "tower": 2,
        "torsion": 1,
        "lateral": 1,
        "vertical": 2,
        "ground": True,
        "self_weight": False,
    },
    "shaken and driven": {
        "tower": 1,
        "torsion": 1,
        "lateral": 1,
        "vertical": 1,
        "ground": True,
        "slewing": DRIVE,
        "drive_inertia": 2e5,
        **LOSSY,
    },
    "driven": {
        "tower": 1,
        "torsion": 1,
        "lateral": 2,
        "vertical": 1,
        "slewing": DRIVE,
        "drive_inertia": 2e5,
        **LOSSY,
    },
    "of segments": {**SECTIONED, "crane": dataclasses.replace(sectioned.CRANE, roll_inertia=3e5)},
    "of segments, planar": {
        **SECTIONED,
        "torsion": 0,
        "lateral": 0,
        "counter": (0, 2),
        "planes": 1,
        "slewing": "fixed",
    },
    "of segments, windy": {**SECTIONED, "wind": True, "areas": AREAS, **LOSSY},
    "in many winds": {"tower": 1, "torsion": 1, "lateral": 2, "vertical": 1, **BLOWN, **LOSSY},
    "of segments, in many winds": {**SECTIONED, "lateral": 1, "vertical": 1, "counter": (1, 1), **BLOWN, **LOSSY},
    "of segments, driven": {**SECTIONED, "vertical": 2, "slewing": DRIVE, "drive_inertia": 2e5, **LOSSY},
    "driven rigid": {"tower": 0, "torsion": 0, "lateral": 0, "vertical": 1, "slewing": DRIVE, "drive_inertia": 2e5},
}


class Instant:
    """A random state of a scene with moving drives, and all that both sides say of it."""

    def __init__(self, rng, options):
        self.model = model = space.model(**options)
        self.cloud = CraneCloud(model, options.get("crane", space.CRANE), options.get("areas"))
        n = self.n = model.coordinates
        amplitude = 0.3 * model.system.scale[:n]
        self.q, self.rates = amplitude * rng.normal(size=n), amplitude * rng.normal(size=n)
        self.angles, self.angle_rates = rng.uniform([-2.5, -1.0], [2.5, 1.0]), rng.normal(size=2)
        drives = {
            "trolley": [rng.uniform(2, 50), rng.normal(), rng.normal()],
            "rope": [rng.uniform(4, 20), rng.normal(), rng.normal()],
            "slewing": [rng.uniform(-3, 3), 0.2 * rng.normal(), 0.2 * rng.normal()],
        }
        self.wind = rng.normal(size=(max(int(model.wind), 1), 3)) * (12.0 if model.wind else 0.0)
        self.wind[:, 2] = self.wind[-1, 2]
        if model.slewing == "fixed":
            drives["slewing"] = [0.0, 0.0, 0.0]
        if model.drive is not None:
            at = model.parts["slewing"]
            self.q[at], self.rates[at] = rng.uniform(-3, 3), 0.02 * rng.normal()
            # Within the soft line and beyond the corner in turn.
            drives["shaft"] = [float(self.q[at][0]) + rng.choice([-0.05, -0.01, 0.01, 0.05]), 0.1, 0.0]
        blown = [*self.wind[:, :2].ravel(), self.wind[-1, 2]]
        drives |= {c: [speed, 0.0, 0.0] for c, speed in zip(wind_channels(len(self.wind)), blown, strict=True)}
        if model.ground:
            shaken = [[0.0, rng.normal(), 1.5 * rng.normal()] for _ in range(3)]
            drives |= dict(zip(GROUND, shaken, strict=True))
            self.cloud.ground = [Jet(*own) for own in shaken]
        self.inputs = np.array([drives[channel] for channel in model.channels])
        self.drives = [Jet(*drives[name]) for name in ("slewing", "trolley", "rope")]
        (theta, phi), (theta_rate, phi_rate) = self.angles, self.angle_rates
        s, c, sp, cp = np.sin(theta), np.cos(theta), np.sin(phi), np.cos(phi)
        e_theta, e_phi = np.array([c, 0, s]), np.array([-s * sp, cp, c * sp])
        rope = np.array([s * cp, sp, -c * cp])
        swing = cp * theta_rate * e_theta + phi_rate * e_phi
        self.state = np.concatenate([self.q, rope, self.rates, swing, [0.0]])
        self.slope, self.guards = model.system.slope(0.0, self.state, self.inputs)
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
        spring = drive.soft * np.clip(twist, -drive.corner, drive.corner)
        spring += drive.stiff * (twist - np.clip(twist, -drive.corner, drive.corner))
        self.coupling = -spring - drive.damping * slip
        friction = drive.friction_torque * np.tanh(self.rates[at] / drive.friction_rate)
        return self.coupling - friction

    def drawn(self):
        """Coordinates and angles, and their rates."""
        return np.concatenate([self.q, self.angles]), np.concatenate([self.rates, self.angle_rates])

    @cached_property
    def columns(self):
        return self.cloud.displace(self.drawn()[0], self.drives)

    def left_over(self):
        return self.cloud.left_over(*self.drawn(), self.found, self.drives, self.columns, self.wind)

    def expected(self):
        return self.cloud.accelerations(*self.drawn(), self.drives, self.columns, self.wind, self.extra)

    def observed(self):
        span = np.array([0.0, 1.0])
        motions = {c: Motion(span, row[None]) for c, row in zip(self.model.channels, self.inputs, strict=True)}
        return self.model.observe(motions, np.zeros(1), self.state[None], self.slope[None], self.guards[None])


@cache
def instants(name):
    rng = np.random.default_rng(5)
    return [Instant(rng, SCENES[name]) for _ in range(4)]


@pytest.mark.parametrize("name", SCENES)
def test_accelerations_follow_from_positions(name):
    for instant in instants(name):
        expected, mass = instant.expected()
        size = np.sqrt(np.diag(mass))
        assert np.max(abs(instant.found - expected) * size) < 1e-12 * np.max(abs(expected) * size)


@pytest.mark.parametrize("name", SCENES)
def test_drives_hold_what_virtual_work_asks(name):
    for instant in instants(name):
        n = instant.n
        sums, sizes = instant.left_over()
        assert np.max(abs(sums[: n + 2] - instant.extra) / (sizes[: n + 2] + abs(instant.extra))) < 1e-11
        torque, force, pull = sums[n + 2 :]
        guards, scale = instant.guards, 1e-11 * sizes[n + 2 :]
        if instant.model.drive is None:
            assert abs(guards[SLEWING_TORQUE] - torque) < scale[0]
        else:
            assert abs(guards[SLEWING_TORQUE] - instant.coupling) < 1e-9 * abs(instant.coupling)
        assert abs(guards[TROLLEY_FORCE] - force) < scale[1]
        assert abs(guards[TENSION] + pull) < scale[2]


@pytest.mark.parametrize("name", SCENES)
def test_sections_carry_what_moves_beyond_them(name):
    for instant in instants(name):
        instant.left_over()
        felt, points, model = instant.cloud.felt, instant.cloud.now, instant.model
        seen = instant.observed()
        foot = [0.0, 0.0, model.crane.tower_height]
        moments, sizes = np.zeros(3), 0.0
        for part_name, cloud in points.items():
            arm = cloud.derivative(0) + foot
            if part_name == "tower":
                arm[:, 2] = instant.cloud.height
            moments += np.cross(arm, felt[part_name]).sum(axis=0)
            sizes += abs(np.cross(arm, felt[part_name])).sum()
        part = model.parts["torsion"]
        inertia = model.crane.torsion.shaft.inertia_per_length * instant.cloud.tower_weights
        moments[2] += inertia @ (instant.found[:-2][part] @ instant.cloud.twists)
        base = [seen[name].values[0] for name in ("base_moment_x", "base_moment_y", "base_torque")]
        assert np.max(abs(base + moments)) < 1e-11 * sizes
        assert abs(seen["overturning_moment"].values[0] - np.hypot(*moments[:2])) < 1e-11 * sizes
        forces, weights = sum(own.sum(axis=0) for own in felt.values()), sum(abs(own).sum() for own in felt.values())
        base = [seen[f"base_force_{axis}"].values[0] for axis in "xyz"]
        assert np.max(abs(base + forces)) < 1e-11 * weights
        assert abs(seen["base_shear"].values[0] - np.hypot(*forces[:2])) < 1e-11 * weights

        top = np.zeros(3)
        top[:2] = model.constants.motions[[SLIDE_X, SLIDE_Y]] @ instant.q
        # A tower that bears its loads undeformed: its points on the axis, its top over its foot.
        arms = {part: cloud.derivative(0) - top + foot for part, cloud in points.items()}
        arms["tower"] = np.stack([0.0 * instant.cloud.height, 0.0 * instant.cloud.height, instant.cloud.height], 1)
        upright = sum(np.cross(arms[part], felt[part]).sum(axis=0) for part in points)
        assert abs(seen["overturning_moment_first_order"].values[0] - np.hypot(*upright[:2])) < 1e-11 * sizes
        roots = {}
        for member, more in (("jib", ("trolley", "load")), ("counter-jib", ("counterweight",))):
            roots[member] = np.zeros(3)
            for beyond in (member, *(f"{member}, rotor {k}" for k in range(3)), *more):
                roots[member] += np.cross(points[beyond].derivative(0) - top, felt[beyond]).sum(axis=0)
        left, up = (np.array([row[k].c[0] for row in instant.cloud.axes]).ravel() for k in (1, 2))
        assert abs(seen["jib_root_moment"].values[0] + roots["jib"] @ left) < 1e-11 * sizes
        assert abs(seen["jib_root_moment_sideways"].values[0] - roots["jib"] @ up) < 1e-11 * sizes
        if not any(model.crane.groups[1::2]):
            assert not any(name.startswith("counter_jib") for name in seen)
            continue
        assert abs(seen["counter_jib_root_moment"].values[0] - roots["counter-jib"] @ left) < 1e-11 * sizes
        assert abs(seen["counter_jib_root_moment_sideways"].values[0] - roots["counter-jib"] @ up) < 1e-11 * sizes
        # Where its tip is drawn, seen from the straight counter-jib.
        _, y, z = (
            float(np.squeeze(jet.c[0]))
            for jet in instant.cloud.members["counter-jib"].tip(instant.cloud.split(instant.q))
        )
        tip = [seen[f"counter_jib_tip_deflection{way}"].values[0] for way in ("_sideways", "")]
        assert np.max(abs(np.array(tip) - [-y, z])) < 1e-13
