"""The door for slewing and jib cranes: each kind's keys, values, motions and messages."""

import json
import math
import tomllib
from dataclasses import FrozenInstanceError, asdict, replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from case_files import BASIC, COMBINED, ENHANCED, HEAVY, MULTI, PLAN, RADIAL, copy_case, faults_of, only_fault
from hypothesis import given, settings
from hypothesis import strategies as st

from towercrane.case import CaseError, Fault, case_folder, list_cases, load_case
from towercrane.casefile import split_provenance
from towercrane.cranes.slewing_parameters import BasicParameters, EnhancedParameters, MultiMassParameters
from towercrane.kinds import known_keys, known_to
from towercrane.motion import phases, smooth_ramps, speed_trapezoid, trapezoid
from towercrane.schema_cases import KINDS

RAMPS = {
    "multi-mass": [(0.71, 8), (1.42, 8), (2.13, 6), (2.84, 6), (3.55, 6), (4.26, 6)],
    "basic": [(0.71, 8), (1.42, 8), (2.84, 8), (4.26, 8)],
    "enhanced": [(0.71, 8), (1.42, 8), (2.84, 8), (4.26, 8)],
}
EXAMPLES = [(kind, n, *ramp) for kind, ramps in RAMPS.items() for n, ramp in enumerate(ramps, start=1)]


@pytest.fixture
def copied(tmp_path):
    return partial(copy_case, tmp_path)


# Shipped cases


def test_every_kind_ships_and_loads():
    kinds = {name: load_case(name).kind for name, _ in list_cases() if not name.startswith("hard/")}
    tower_cranes = {name: kind for name, kind in kinds.items() if name.startswith(("qtz5613/", "towers/"))}
    assert {name: kind for name, kind in kinds.items() if name not in tower_cranes} == {
        **{f"slewing/{kind}/example-{n}": kind for kind, n, _, _ in EXAMPLES},
        **{f"slewing/{kind}/cycle": kind for kind, _, _, _ in EXAMPLES},
        **dict.fromkeys((PLAN, HEAVY, COMBINED), "jib"),
    }
    in_space = {
        "manoeuvre",
        "slewing",
        "gentle",
        "soft-drive",
        "gusts-parked",
        "gusts-working",
        "manoeuvre-within-2e-2",
    }
    assert {name for name, kind in tower_cranes.items() if kind != "radial"} == {f"qtz5613/{n}" for n in in_space}
    assert {tower_cranes[f"qtz5613/{name}"] for name in in_space} == {"space"}


@pytest.mark.parametrize(("kind", "number", "ramp", "hold"), EXAMPLES)
def test_slewing_examples_are_the_published_ones(kind, number, ramp, hold):
    case = load_case(f"slewing/{kind}/example-{number}")
    assert set(case.motions) == {"shaft", "rope"}
    shaft = case.motions["shaft"]
    assert shaft.switch_times == pytest.approx([0.0, ramp, ramp + hold, 2 * ramp + hold], rel=1e-15)
    assert shaft.range(1) == pytest.approx((0.0, 0.738), rel=1e-15, abs=1e-15)
    assert (float(shaft(0.0)), shaft.end) == (0.0, pytest.approx(0.738 * (ramp + hold), rel=1e-15))
    assert case.rope_motion().range() == (2.0, 2.0)
    assert case.crane.geometry.jib_radius == 2.0
    assert case.run.duration == {"multi-mass": 25.0}.get(kind, 18.0 if number == 4 else 14.0)
    assert (case.start.state, case.start.swing_angle) == ("equilibrium", 0.0)
    assert case.load().mass == 50.5
    assert case.load().drag == pytest.approx(0.08, rel=1e-15)


SHARED = {
    "gravity": 9.81, "geometry_tower_height": 1.8, "geometry_top_height": 0.4, "geometry_jib_radius": 2.0,
    "mass_jib_tip": 14.0, "stiffness_jib_vertical": 6e4, "damping_jib_vertical": 60.0,
    "drive_soft_stiffness": 20.0, "drive_stiff_stiffness": 750.0, "drive_corner": 0.25, "drive_damping": 60.0,
    "friction_law": "tanh", "friction_torque": 22.0, "friction_rate": 0.01,
}  # fmt: skip
TOWER = {
    "stiffness_tower_x": 1.6e5, "stiffness_tower_y": 1.6e5, "stiffness_tower_torsion": 4e4,
    "stiffness_jib_lateral": 6e4, "damping_tower_x": 150.0, "damping_tower_y": 150.0, "damping_tower_torsion": 50.0,
    "damping_jib_lateral": 80.0, "inertia_platform": 6.0, "drag_tower_top": 0.0, "drag_jib_tip": 0.0,
}  # fmt: skip
PARAMETERS = {
    MULTI: (MultiMassParameters, {
        **SHARED, **TOWER, "name": "Laboratory crane, multi-mass model", "mass_tower_top": 35.0,
        "inertia_tower_top": 8.0, "geometry_counterweight_radius": 0.9, "mass_counterweight": 100.0,
        "stiffness_counter_jib_vertical": 1.2e5, "stiffness_counter_jib_lateral": 6e4,
        "damping_counter_jib_vertical": 100.0, "damping_counter_jib_lateral": 80.0, "drag_counterweight": 0.0,
    }),
    ENHANCED: (EnhancedParameters, {
        **SHARED, **TOWER, "name": "Laboratory crane, enhanced model", "mass_tower_top": 135.0,
        "inertia_tower_top": 89.0, "mass_counter_moment": 90.0,
    }),
    BASIC: (BasicParameters, {
        **SHARED, "name": "Laboratory crane, basic model", "inertia_platform": 95.0, "stiffness_jib_lateral": 5800.0,
        "stiffness_jib_radial": 1.6e5, "stiffness_rope": 7.5e5, "damping_jib_lateral": 20.0,
        "damping_jib_radial": 150.0, "damping_rope": 100.0, "drag_jib_tip": 0.02,
    }),
}  # fmt: skip


@pytest.mark.parametrize("name", PARAMETERS)
def test_lumped_parameters_are_si_and_complete(name):
    kind, expected = PARAMETERS[name]
    parameters = load_case(name).lumped_parameters()
    assert type(parameters) is kind
    assert asdict(parameters) == pytest.approx(expected)
    assert parameters.suspension_height == pytest.approx(2.2)
    assert {type(v) for k, v in asdict(parameters).items() if k not in ("name", "friction_law")} == {float}


JIB = {
    "name": "Jib crane", "gravity": 9.81, "post_height": 0.0, "post_inertia": 1e4, "primary_length": 15.0,
    "primary_mass_per_length": 1.5, "secondary_length": 10.0, "secondary_mass_per_length": 1.5,
}  # fmt: skip


def test_jib_crane_is_the_published_one_and_its_heavy_sister():
    assert load_case(PLAN).jib_parameters() == JIB
    heavy = {
        "name": "Jib crane with heavy booms", "post_height": 12.0, "post_inertia": 2e5,
        "primary_mass_per_length": 200.0, "secondary_mass_per_length": 120.0,
    }  # fmt: skip
    assert load_case(HEAVY).jib_parameters() == JIB | heavy == load_case(COMBINED).jib_parameters()


@pytest.mark.parametrize("name", [PLAN, HEAVY])
def test_jib_plan_is_the_published_one(name):
    case = load_case(name)
    luff = case.motions["luff"]
    assert luff.switch_times == pytest.approx([0.0, 20.0, 60.0, 80.0])
    assert luff([0.0, 30.0, 60.0, 80.0], 2) == pytest.approx([0.001, 0.0, -0.001, 0.0], abs=1e-18)
    assert luff.range() == pytest.approx((0.3, 1.5))
    assert [case.motions[joint].range() for joint in ("slew", "fold")] == [(0.0, 0.0)] * 2
    assert (case.rope_motion().range(), case.load().mass) == ((20.0, 20.0), 5000.0)


def test_combined_plan_moves_everything():
    case = load_case(COMBINED)
    assert set(case.motions) == {"slew", "luff", "fold", "rope"}
    plan = {
        "slew": (0.0, 2.0, 48.0),
        "luff": (0.4, 0.8, 56.0),
        "fold": (-0.2, -0.4, 50.0),
        "rope": (20.0, 12.0, 59.0),
    }
    for joint, (start, end, duration) in plan.items():
        motion = case.motions[joint]
        assert (float(motion(0.0)), motion.end, motion.duration) == pytest.approx((start, end, duration))
        times = motion.switch_times
        for derivative in (1, 2):  # speed and acceleration do not jump
            before, after = motion(times - 1e-6, derivative), motion(times + 1e-6, derivative)
            assert before == pytest.approx(after, abs=1e-6)


@pytest.mark.parametrize("crane", sorted(case_folder().glob("*/**/crane*.toml")), ids=lambda p: p.parent.name)
def test_crane_files_say_why_values_are_assumed(crane):
    _, assumed, faults = split_provenance(tomllib.loads(crane.read_text("utf-8")))
    assert not faults
    assert all(len(a.why) > 10 for a in assumed)
    printed = {"geometry.jib_radius", "post.inertia", "primary_boom.length", "secondary_boom.length"}
    assert not printed & {a.key for a in assumed} or crane.name == "crane-heavy.toml"


# Motions


@pytest.mark.parametrize("speed", [0.738, -0.738])
@pytest.mark.parametrize("hold", [8.0, 0.0])
def test_a_speed_trapezoid_is_the_trapezoid_with_that_way(speed, hold):
    motion = speed_trapezoid(1.0, speed, 0.71, hold)
    same = trapezoid(1.0, 1.0 + speed * (0.71 + hold), abs(speed), abs(speed) / 0.71)
    times = np.linspace(-1.0, 12.0, 500)
    assert motion(times) == pytest.approx(same(times), abs=1e-14)
    assert motion(times, 1) == pytest.approx(same(times, 1), abs=1e-14)


@pytest.mark.parametrize("hold", [6.0, 0.0])
def test_smooth_ramps_follow_the_quintic_step(hold):
    motion = smooth_ramps(2.0, -0.5, 4.0, hold)
    times = np.linspace(0.0, 15.0, 301)

    def step(x):
        x = np.clip(x, 0.0, 1.0)
        return x**3 * (10 - 15 * x + 6 * x**2)

    assert motion(times, 1) == pytest.approx(-0.5 * (step(times / 4) - step((times - 4 - hold) / 4)), abs=1e-13)
    assert motion.end == pytest.approx(2.0 - 0.5 * (4 + hold), rel=1e-15)
    assert motion.range() == pytest.approx((motion.end, 2.0))
    assert motion.range(2) == pytest.approx((-0.5 * 1.875 / 4, 0.5 * 1.875 / 4))
    assert phases((motion,), 20.0).inputs.shape[2] == 7


@pytest.mark.parametrize(("ramp", "hold"), [(0.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (math.nan, 1.0)])
def test_ramps_refuse_impossible_times(ramp, hold):
    for build in (speed_trapezoid, smooth_ramps):
        with pytest.raises(ValueError, match="ramp, hold: wanted a positive time"):
            build(0.0, 1.0, ramp, hold)


SHAPES = {
    "rest": ({"start": "90 deg"}, (math.pi / 2, math.pi / 2)),
    "trapezoid": ({"end": "1 rev", "speed": "7 rpm", "acceleration": 0.1}, (0.0, 2 * math.pi)),
    "s-curve": ({"end": "-90 deg", "speed": "6 deg/s", "acceleration": 0.1, "jerk": 1}, (-math.pi / 2, 0.0)),
    "speed-trapezoid": ({"speed": "-6 rpm", "ramp": "1 s", "hold": "9 s"}, (-2 * math.pi, 0.0)),
    "smooth": ({"speed": "6 rpm", "ramp": "1 s", "hold": "9 s", "start": 1, "delay": 3}, (1.0, 1.0 + 2 * math.pi)),
    "sequence": ({"start": "10 deg", "steps": [
        {"shape": "trapezoid", "end": "60 deg", "speed": 0.1, "acceleration": 0.1},
        {"shape": "rest", "duration": 3},
        {"shape": "smooth", "speed": "-0.1 rad/s", "ramp": 1, "hold": 0},
    ]}, (math.radians(10), math.radians(60))),
}  # fmt: skip


def toml(value):
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{k} = {toml(v)}" for k, v in value.items()) + " }"
    return f"[{', '.join(map(toml, value))}]" if isinstance(value, list) else json.dumps(value)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize(("case", "joint"), [(MULTI, "shaft"), (PLAN, "slew")])
def test_joints_take_every_shape_in_angles(case, joint, shape):
    keys, extent = SHAPES[shape]
    motion = load_case(case, [f"motion.{joint}={toml({'shape': shape} | keys)}"]).motions[joint]
    assert motion.range() == pytest.approx(extent)


def test_a_table_of_angles(copied, tmp_path):
    path = copied(PLAN)
    setting = 'motion.slew={ shape = "table", file = "turn.csv" }'
    (tmp_path / "turn.csv").write_text("t,angle\n0,1\n10,2\n20,2.5\n")
    assert load_case(path, [setting]).motions["slew"].end == pytest.approx(2.5)
    (tmp_path / "turn.csv").write_text("t,angle\n0,0\n10,90\n")
    fault = only_fault(path, setting)
    assert (fault.key, fault.wanted) == ("motion.slew.file", "speeds up to 5 rad/s")
    assert "radians?" in fault.hint
    (tmp_path / "turn.csv").write_text("t,angle\n0,0\n10,x\n")
    fault = only_fault(path, setting)
    assert (Path(fault.file).name, fault.key) == ("turn.csv", "line 3")
    assert "seconds and radians" in fault.hint


@pytest.mark.parametrize("case", [MULTI, PLAN])
def test_hoisting_takes_the_new_shapes(case):
    hoist = 'motion.hoist={ shape = "smooth", speed = "-6 m/min", ramp = 1, hold = 4 }'
    rope = load_case(case, [hoist]).rope_motion()
    assert float(rope(0.0)) - rope.end == pytest.approx(0.5)
    too_far = hoist.replace("hold = 4", "hold = 400")
    assert "above 0" in only_fault(case, too_far).wanted


def test_trolleys_take_the_new_shapes():
    move = 'motion.trolley={ shape = "speed-trapezoid", start = 5, speed = 0.5, ramp = 2, hold = 10 }'
    assert load_case(RADIAL, [move]).trolley_motion().end == pytest.approx(11.0)
    assert "a motion from 5 to 66 m" in only_fault(RADIAL, move.replace("hold = 10", "hold = 120")).got


# Parameters


def test_parameters_refuse_what_is_no_crane():
    parameters = load_case(MULTI).lumped_parameters()
    for name, value in [
        ("stiffness_tower_x", 0.0),
        ("mass_jib_tip", -1.0),
        ("damping_jib_lateral", -1.0),
        ("inertia_platform", math.nan),
        ("gravity", math.inf),
        ("friction_law", "sticky"),
        ("friction_rate", 0.0),
    ]:
        with pytest.raises(ValueError, match=rf"MultiMassParameters\.{name}: wanted"):
            replace(parameters, **{name: value})
    zeros = ("damping_jib_lateral", "drag_jib_tip", "drive_damping", "friction_torque", "mass_tower_top")
    replace(parameters, **dict.fromkeys(zeros, 0.0))
    with pytest.raises(FrozenInstanceError):
        parameters.gravity = 1.0


def test_each_model_is_asked_of_its_own_kind():
    radial, multi, jib = (load_case(name) for name in (RADIAL, MULTI, PLAN))
    calls = [
        (radial.lumped_parameters, '"multi-mass" or "basic" or "enhanced"', "radial"),
        (radial.jib_parameters, '"jib"', "radial"),
        (multi.radial_crane, '"radial"', "multi-mass"),
        (multi.trolley_motion, '"radial"', "multi-mass"),
        (jib.lumped_parameters, '"multi-mass"', "jib"),
        (jib.lattice, '"radial"', "jib"),
        (lambda: jib.modes, '"radial"', "jib"),
        (lambda: jib.model, '"radial"', "jib"),
    ]
    for call, wanted, got in calls:
        with pytest.raises(CaseError) as caught:
            call()
        (fault,) = caught.value.faults
        assert (fault.key, fault.got) == ("crane.kind", f'"{got}"')
        assert wanted in fault.wanted


def test_drag_is_given_as_area_or_as_coefficient():
    assert load_case(RADIAL, ["payload.drag=0.08 kg/m"]).load().drag == pytest.approx(0.08)
    assert load_case(RADIAL, ["payload.drag_area=2 m^2"]).load().drag_area == 2.0
    fault = only_fault(MULTI, "payload.drag_area=0.1 m^2")
    assert fault.key == "payload.drag"
    assert "drag_area = " in fault.got


def test_friction_can_be_switched_by_its_law_alone():
    for law in ("none", "stick-slip"):
        assert load_case(MULTI, [f"crane.friction.law={law}"]).lumped_parameters().friction_law == law


def test_friction_may_be_left_out(copied):
    path = copied(BASIC, ("[friction]", "[unread]"))
    assert only_fault(path).key == "unread"
    text = path.with_name("crane.toml").read_text()
    path.with_name("crane.toml").write_text(text[: text.index("[unread]")])
    assert load_case(path).lumped_parameters().friction_law == "none"


# Faults: case, override, key, words of the message

MEND = [
    (MULTI, "crane.geometry.tower_height=1.8 s", "crane.geometry.tower_height", ["a length", "which is a time"]),
    (MULTI, "crane.geometry.tower_hight=3", "crane.geometry.tower_hight", ['closest known key: "tower_height"']),
    (MULTI, "crane.mass.counterweight=0", "crane.mass.counterweight", ["a mass", "above 0"]),
    (MULTI, "crane.inertia.platform=6 kg m", "crane.inertia.platform", ["a moment of inertia", "a mass moment"]),
    (MULTI, "crane.stiffness.tower_x=3 kN m/rad", "crane.stiffness.tower_x", ["a stiffness", "a rotary stiffness"]),
    (MULTI, "crane.stiffness.jib_lateral=3 kN/m", "crane.stiffness.jib_lateral", ["a rotary stiffness"]),
    (BASIC, "crane.stiffness.jib_lateral=3 N m/rad", "crane.stiffness.jib_lateral", ["a stiffness", "60 kN/m"]),
    (MULTI, "crane.stiffness.tower_y=-1", "crane.stiffness.tower_y", ["above 0"]),
    (MULTI, "crane.damping.tower_y=-1", "crane.damping.tower_y", ["a damping", "from 0"]),
    (MULTI, "crane.damping.jib_lateral=1 N s/m", "crane.damping.jib_lateral", ["a rotary damping"]),
    (ENHANCED, "crane.mass.counter_moment=90 kg", "crane.mass.counter_moment", ["a mass moment", "is a mass"]),
    (MULTI, "crane.drive.corner=0", "crane.drive.corner", ["an angle", "above 0"]),
    (MULTI, "crane.drive.corner=3 mm", "crane.drive.corner", ["an angle", "which is a length"]),
    (MULTI, "crane.friction.law=tan", "crane.friction.law", ['"stick-slip"', 'did you mean "tanh"?']),
    (MULTI, "crane.friction.rate=0", "crane.friction.rate", ['the law "tanh" needs it', "got:    0"]),
    (MULTI, "crane.friction.torque=0 N m", "crane.friction.torque", ['the law "tanh" needs it', "22 N m"]),
    (BASIC, "crane.drag.jib_tip=2 m^2", "crane.drag.jib_tip", ["a drag force per squared speed", "an area"]),
    (BASIC, "crane.drag.tower_top=2", "crane.drag.tower_top", ['of kind "multi-mass" or "enhanced"', '"basic"']),
    (BASIC, "crane.mass.counterweight=2", "crane.mass.counterweight", ['of kind "multi-mass"; this crane is of']),
    (ENHANCED, "crane.mass.counterweight=2", "crane.mass.counterweight", ['cranes of kind "multi-mass"']),
    (MULTI, "crane.trolley.mass=2", "crane.trolley", ['cranes of kind "radial"', '"multi-mass"']),
    (MULTI, "crane.post.inertia=2", "crane.post", ['cranes of kind "jib"']),
    (RADIAL, "crane.mass.jib_tip=2", "crane.mass", ['"multi-mass", "basic" or "enhanced"; this crane']),
    (MULTI, "model.jib_modes=2", "model", ['cranes of kind "radial"']),
    (PLAN, "modes.count=2", "modes", ['cranes of kind "radial"']),
    (MULTI, "motion.trolley.start=2", "motion.trolley", ["one of the keys shaft, hoist", '"radial"']),
    (PLAN, "motion.shaft.start=2", "motion.shaft", ['"multi-mass", "basic", "enhanced" or "space"']),
    (RADIAL, "motion.luff.start=2", "motion.luff", ['cranes of kind "jib"']),
    (MULTI, "motion.shaft.speed=0.7 m/s", "motion.shaft.speed", ["a rotary speed", '"7 rpm"', "is a speed"]),
    (MULTI, "motion.shaft.ramp=0 s", "motion.shaft.ramp", ["a time", "above 0"]),
    (MULTI, "motion.shaft.hold=-1 s", "motion.shaft.hold", ["a time", "from 0"]),
    (MULTI, "motion.shaft.end=3", "motion.shaft.end", ["unknown key", "speed, ramp, hold"]),
    (MULTI, "motion.shaft.shape=speed", "motion.shaft.shape", ['"smooth"', "speed"]),
    (PLAN, "motion.fold.shape=rst", "motion.fold.shape", ['did you mean "rest"?']),
    (PLAN, "motion.luff.start=3 m", "motion.luff.start", ["an angle", "which is a length"]),
    (PLAN, "crane.primary_boom.length=0", "crane.primary_boom.length", ["a length", "above 0"]),
    (PLAN, "crane.post.inertia=-1", "crane.post.inertia", ["a moment of inertia", "above 0"]),
    (PLAN, "start.state=zero", "start.state", ['one of "equilibrium"']),
    (MULTI, "start.state=zero-no-self-weight", "start.state", ['"equilibrium", "zero"']),
    (MULTI, "rope.length=2.3 m", "rope.length", ["up to 2.2 m (the height of the tower with its top)", "ground"]),
    (HEAVY, "rope.length=38 m", "rope.length", ["up to 37 m (post and booms upright)"]),
]


@pytest.mark.parametrize(("case", "override", "key", "words"), MEND)
def test_one_slip_makes_one_message(case, override, key, words):
    fault = only_fault(case, override)
    assert fault.file.startswith("--set ")
    assert fault.key == key
    for word in words:
        assert word in str(fault)


IMPLAUSIBLE = [
    (MULTI, "crane.geometry.tower_height", 1800, "mm meant?"),
    (MULTI, "crane.mass.jib_tip", 1.4e7, "g meant?"),
    (MULTI, "crane.stiffness.tower_x", 160, "kN/m meant?"),
    (MULTI, "crane.stiffness.jib_lateral", 60, "kN m/rad meant?"),
    (BASIC, "crane.stiffness.jib_lateral", 5.8, "kN/m meant?"),
    (MULTI, "crane.stiffness.counter_jib_lateral", 60, "kN m/rad meant?"),
    (MULTI, "crane.drive.corner", 14, "deg meant?"),
    (MULTI, "motion.shaft.speed", 7, "rpm meant?"),
    (MULTI, "motion.shaft.speed", -7, "rpm meant?"),
    (MULTI, "motion.shaft.ramp", 7e5, "ms meant?"),
    (PLAN, "motion.luff.start", 20, "deg meant?"),
    (PLAN, "motion.fold.start", -90, "deg meant?"),
    (PLAN, "crane.primary_boom.length", 15000, "mm meant?"),
    (PLAN, "crane.post.inertia", 0.5, "t m^2 meant?"),
    (PLAN, "crane.secondary_boom.mass_per_length", 0.12, "t/m meant?"),
]


@pytest.mark.parametrize(("case", "key", "value", "meant"), IMPLAUSIBLE)
def test_implausible_values_name_the_likely_unit_and_can_be_allowed(case, key, value, meant):
    fault = only_fault(case, f"{key}={value}")
    assert fault.key == key
    assert "a value from " in fault.wanted
    assert fault.hint.startswith(meant)
    load_case(case, [f"{key}={value}", f'allow_implausible=["{key}"]'])


def test_a_post_without_height_limits_no_rope():
    assert load_case(PLAN, ["rope.length=40 m"]).rope.length == 40.0


def test_all_faults_come_at_once():
    faults = faults_of(
        MULTI,
        "crane.mass.tower_topp=3",
        "crane.stiffness.tower_x=3 kN m/rad",
        "crane.stiffness.jib_lateral=60",
        "crane.friction.law=tan",
        "motion.shaft.speed=7",
        "payload.drag_area=0.1 m^2",
        "rope.length=3 m",
        "motion.slew.start=1",
    )
    assert sorted(f.key for f in faults) == [
        "crane.friction.law",
        "crane.mass.tower_topp",
        "crane.stiffness.jib_lateral",
        "crane.stiffness.tower_x",
        "motion.shaft.speed",
        "motion.slew",
        "payload.drag",
        "rope.length",
    ]


def test_missing_tables_and_keys_are_named(copied):
    path = copied(MULTI, ("[drive]", "[driv]"), ('jib_radius = "2 m"', ""), ("[motion.shaft]", "[motion.shft]"))
    faults = {(Path(f.file).name, f.key): f for f in faults_of(path)}
    assert set(faults) == {
        ("crane.toml", "geometry.jib_radius"),
        ("crane.toml", "driv"),
        ("example-1.toml", "motion.shft"),
    }
    path = copied(PLAN, ("[motion.fold]", "[motion.slew]"))
    fault = only_fault(path)
    assert (fault.key, fault.wanted) == ("motion.fold", "a table [motion.fold] with shape")


# The kind


@pytest.mark.parametrize(
    ("kind", "hint"),
    [
        ('"multimass"', 'did you mean "multi-mass"?'),
        ('"Multi-Mass"', 'did you mean "multi-mass"?'),
        ('"tower"', 'the keys are those of kind "multi-mass"'),
        ("3", 'the keys are those of kind "multi-mass"'),
        ('""', 'the keys are those of kind "multi-mass"'),
    ],
)
def test_an_unknown_kind_is_one_fault_and_the_rest_is_still_checked(kind, hint):
    fault = only_fault(MULTI, f"crane.kind={kind}")
    assert (fault.key, fault.got) == ("crane.kind", kind)
    assert fault.wanted == 'one of "radial", "multi-mass", "basic", "enhanced", "jib", "space"'
    assert fault.hint == hint
    faults = faults_of(MULTI, f"crane.kind={kind}", "crane.mass.tower_topp=3")
    assert [f.key for f in faults] == ["crane.kind", "crane.mass.tower_topp"]


def test_a_misspelt_kind_counts_more_than_the_keys(copied):
    moment = 'counter_moment = { value = "90 kg m", assumed = "not printed; 100 kg at 0.9 m" }'
    # Without this key the crane looks as much like a multi-mass one that lacks some.
    path = copied(ENHANCED, (moment, ""), ('"enhanced"', '"enhansed"'))
    assert only_fault(path).hint == 'did you mean "enhanced"?'


@pytest.mark.parametrize(("name", "kind"), [(MULTI, "multi-mass"), (BASIC, "basic"), (PLAN, "jib")])
def test_a_crane_without_its_kind_is_told_which(copied, name, kind):
    path = copied(name, (f'kind = "{kind}"', ""))
    fault = only_fault(path)
    assert (Path(fault.file).name, fault.key, fault.got) == ("crane.toml", "kind", "nothing: the key is missing")
    assert f'the keys are those of kind "{kind}"' in fault.hint
    assert '"radial"' in fault.hint


def test_a_radial_crane_may_state_its_kind():
    assert load_case(RADIAL, ["crane.kind=radial"]).kind == "radial"


@pytest.mark.parametrize("name", [MULTI, PLAN, RADIAL])
def test_a_crane_that_cannot_be_read_leaves_the_case_checked(copied, name):
    path = copied(name)
    crane = tomllib.loads(path.read_text("utf-8"))["crane"]
    path.with_name(crane).write_text("[tower\n")
    faults = faults_of(path, "run.duration=0")
    assert [(Path(f.file).name, f.key.split(",")[0]) for f in faults[:1]] == [(crane, "line 1")]
    assert [f.key for f in faults[1:]] == ["run.duration"]


def test_a_wrong_kind_refuses_each_foreign_key_with_its_kinds():
    faults = {f.key: f for f in faults_of(MULTI, "crane.kind=enhanced")}
    assert set(faults) == {
        "geometry.counterweight_radius",
        "mass.counterweight",
        *(f"{t}.counter_jib_{d}" for t in ("stiffness", "damping") for d in ("lateral", "vertical")),
    }
    for fault in faults.values():
        assert fault.hint == 'a key of cranes of kind "multi-mass"; this crane is of kind "enhanced"'


def test_known_keys_cover_all_kinds():
    everything = set(known_keys())
    assert everything == {key for case in KINDS.values() for key in known_keys(case)}
    assert known_to("crane.post.height") == ["jib"]
    assert known_to("payload.mass") == list(KINDS)


VALUES = st.one_of(
    st.integers().map(str),
    st.floats().map(repr),
    st.sampled_from(["true", "[]", "{}", '"x"', '"3 m"', '"rest"', '"basic"', "{ value = 3 }", "[{ shape = 1 }]"]),
)


@settings(max_examples=150, deadline=None)
@given(st.sampled_from([MULTI, BASIC, ENHANCED, COMBINED]), st.sampled_from(sorted(known_keys())), VALUES)
def test_any_value_at_any_key_is_read_or_explained(case, key, value):
    try:
        load_case(case, [f"{key}={value}"])
        faults = [Fault("none", "", "none", "none")]
    except CaseError as error:
        faults = error.faults
    assert faults
    assert all(f.file and f.wanted and f.got for f in faults)


def test_friction_that_sticks_refuses_solvers_that_cannot_switch():
    changes = ["crane.friction.law=stick-slip", "solver.method=scipy-radau"]
    with pytest.raises(CaseError) as caught:
        load_case("slewing/basic/example-1", changes)
    assert 'wanted: "dop853" or "dopri5" with stick-slip friction' in str(caught.value)
    assert load_case("slewing/basic/example-1", changes[:1]).lumped_parameters().friction_law == "stick-slip"
