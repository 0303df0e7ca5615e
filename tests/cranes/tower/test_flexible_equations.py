"""The compiled equations of the flexible crane against virtual work on positions of points alone."""

import dataclasses
from functools import cache, cached_property

import numpy as np
import pytest
from oracles.jets import Jet
from oracles.space_points import CraneCloud, on
from samples import sectioned_crane as sectioned
from samples import space_crane as space

from modal.beams.beam import Beam
from towercrane.cranes.parts.ground import CHANNELS as GROUND
from towercrane.cranes.parts.wind import WindAreas, WindNodes, wind_channels
from towercrane.cranes.slewing.description import Drive
from towercrane.cranes.tower.equations.constants import SLIDE_X, SLIDE_Y
from towercrane.cranes.tower.equations.motion import SLEWING_TORQUE, TENSION, TROLLEY_FORCE
from towercrane.cranes.tower.modes.damping import ModalDamping
from towercrane.cranes.tower.outputs.cut_sums import Section, cuts_of
from towercrane.kernels.load import Load
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

    def observed(self, model=None):
        model = model or self.model
        span = np.array([0.0, 1.0])
        motions = {c: Motion(span, row[None]) for c, row in zip(self.model.channels, self.inputs, strict=True)}
        return model.observe(motions, np.zeros(1), self.state[None], self.slope[None], self.guards[None])


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


def cloud_beyond(instant, name, of, place):
    """The crane's points with those of tower or jib beyond a section alone."""
    model, crane = instant.model, SCENES[name].get("crane", space.CRANE)
    cloud = CraneCloud(model, crane, SCENES[name].get("areas"))
    cloud.ground = instant.cloud.ground
    if of == "tower":
        cloud.height, cloud.tower_weights = on(model.crane.tower_height - place, place)
        cloud.bends, cloud.leans = model.crane.tower(cloud.height), model.crane.tower(cloud.height, 1)
        cloud.twists = model.crane.torsion(cloud.height)
    else:
        member, bases = cloud.members["jib"], (model.crane.lateral, model.crane.vertical)
        if isinstance(crane.jib, Beam):
            member.at, member.length = on(crane.jib.length - place, place)
            member.mass, (member.pitch, member.yaw) = 123.8 * member.length, np.zeros((2, len(member.at)))
        else:
            kept = member.at >= place
            for own in ("at", "length", "mass", "pitch", "yaw"):
                setattr(member, own, getattr(member, own)[kept])
        member.shapes, member.turns = ([own(member.at) for own in bases], [own.rotation(member.at) for own in bases])
    cloud.left_over(*instant.drawn(), instant.found, instant.drives, [], instant.wind)
    return cloud


@pytest.mark.parametrize("name", ["windy", "of segments, windy", "shaken", "in many winds", "of segments, planar"])
def test_a_named_section_bears_all_that_is_beyond_it(name):
    options = SCENES[name]
    crane = options.get("crane", space.CRANE)
    asked = [Section("low", "tower", 7.3), Section("in", "jib", 5.0), Section("out", "jib", 20.0)]
    for instant in instants(name):
        cuts = cuts_of(instant.model.crane, crane, asked, options.get("areas"), options.get("nodes"))
        seen = instant.observed(dataclasses.replace(instant.model, cuts=cuts))
        part, part_c = instant.model.parts, instant.model.parts["torsion"]
        for section in asked:
            cloud = cloud_beyond(instant, name, section.of, section.place)
            points, felt = cloud.now, cloud.felt
            if section.of == "tower":
                beyond, bent = list(points), instant.model.crane.tower([section.place])[:, 0]
                place = np.array([0.0, 0.0, section.place])
                for axis, kind in enumerate(("tower_x", "tower_y")):
                    place[axis] = bent[: part[kind].stop - part[kind].start] @ instant.q[part[kind]]
                place[2] -= instant.model.crane.tower_height
            else:
                beyond = ["jib", *(f"jib, rotor {k}" for k in range(3))]
                if instant.inputs[instant.model.channels.index("trolley"), 0] >= section.place:
                    beyond += ["trolley", "load"]
                top = np.zeros(3)
                top[:2] = instant.model.constants.motions[[SLIDE_X, SLIDE_Y]] @ instant.q
                left, up = (
                    float(basis([section.place])[:, 0] @ instant.q[part[kind]])
                    for basis, kind in (
                        (instant.model.crane.lateral, "jib_lateral"), (instant.model.crane.vertical, "jib_vertical"),
                    )
                )  # fmt: skip
                axes = np.array([[own.c[0] for own in row] for row in cloud.axes]).reshape(3, 3)
                place = top + axes @ [section.place, left, up]
            force, moment, size = np.zeros(3), np.zeros(3), np.zeros(2)
            for own in beyond:
                arm = points[own].derivative(0) - place
                if own == "tower":
                    arm[:, 2] = cloud.height - section.place
                force -= felt[own].sum(axis=0)
                moment -= np.cross(arm, felt[own]).sum(axis=0)
                size += abs(felt[own]).sum(), abs(np.cross(arm, felt[own])).sum()
            before = f"section_{section.name}_"
            if section.of == "tower":
                inertia = instant.model.crane.torsion.shaft.inertia_per_length * cloud.tower_weights
                moment[2] -= inertia @ (instant.found[:-2][part_c] @ cloud.twists)
                expected = {"force_x": force[0], "force_y": force[1], "force_z": force[2]}
                expected |= {"moment_x": moment[0], "moment_y": moment[1], "torque": moment[2]}
                expected |= {"shear": np.hypot(*force[:2]), "moment": np.hypot(*moment[:2])}
            else:
                force, moment = axes.T @ force, axes.T @ moment
                expected = dict(zip(("axial_force", "shear_sideways", "shear"), force, strict=True))
                expected |= {"torque": moment[0], "moment": moment[1], "moment_sideways": -moment[2]}
            for kind, value in expected.items():
                bound = 1e-11 * (size[1] if kind.startswith(("moment", "torque")) else size[0])
                assert abs(seen[before + kind].values[0] - value) < bound, (section, kind)


def test_sections_at_foot_and_root_bear_what_base_and_root_do():
    (instant, *_), options = instants("windy"), SCENES["windy"]
    ends = [Section("foot", "tower", 0.0), Section("root", "jib", 0.0), Section("top", "tower", 23.8)]
    cuts = cuts_of(instant.model.crane, space.CRANE, ends, options["areas"], None)
    seen = instant.observed(dataclasses.replace(instant.model, cuts=cuts))
    for own, other in (
        ("section_foot_moment", "overturning_moment"), ("section_foot_shear", "base_shear"),
        ("section_foot_torque", "base_torque"), ("section_root_moment", "jib_root_moment"),
        ("section_root_moment_sideways", "jib_root_moment_sideways"),
    ):  # fmt: skip
        assert seen[own].values[0] == pytest.approx(seen[other].values[0], rel=1e-11), own
    with pytest.raises(ValueError, match=r"section tip: wanted a place from 0 to 55.6 m, got 56"):
        cuts_of(instant.model.crane, space.CRANE, [Section("tip", "jib", 56.0)], None, None)


def test_a_trolley_on_a_section_is_beyond_it():
    """At both sides of the section its shear jumps by what the trolley does, its moment does not."""
    (instant, *_), crane = instants("one of each"), space.CRANE
    x = instant.inputs[instant.model.channels.index("trolley"), 0]
    found = []
    for place in (x - 1e-9, x, x + 1e-9):
        cuts = cuts_of(instant.model.crane, crane, [Section("at", "jib", place)], None, None)
        seen = instant.observed(dataclasses.replace(instant.model, cuts=cuts))
        found.append([seen[f"section_at_{kind}"].values[0] for kind in ("shear", "moment")])
    (before, moment), (there, _), (after, without) = found
    assert there == pytest.approx(before, rel=1e-8)
    assert before < after - 1e4
    assert without == pytest.approx(moment, rel=1e-6)
