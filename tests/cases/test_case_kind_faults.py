"""The door for slewing and jib cranes: how it explains what it cannot take."""

import tomllib
from functools import partial
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from samples.case_files import BASIC, COMBINED, ENHANCED, HEAVY, MULTI, PLAN, RADIAL, copy_case, faults_of, only_fault

from towercrane.cases.case import CaseError, Fault, load_case
from towercrane.cases.kinds import EveryKey, known_to
from towercrane.cranes.registry import KINDS
from towercrane.cranes.slewing.build import parameters_of
from towercrane.schema.fields import known_keys


@pytest.fixture
def copied(tmp_path):
    return partial(copy_case, tmp_path)


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
    (MULTI, "crane.trolley.mass=2", "crane.trolley", ['cranes of kind "tower" or "overhead"', '"multi-mass"']),
    (MULTI, "crane.post.inertia=2", "crane.post", ['cranes of kind "jib"']),
    (RADIAL, "crane.mass.jib_tip=2", "crane.mass", ['"multi-mass", "basic" or "enhanced"; this crane']),
    (MULTI, "model.jib_vertical_modes=2", "model", ['cranes of kind "tower"']),
    (PLAN, "modes.count=2", "modes", ['cranes of kind "tower"']),
    (MULTI, "motion.trolley.start=2", "motion.trolley", ["one of the keys shaft, hoist", '"tower" or "overhead"']),
    (PLAN, "motion.shaft.start=2", "motion.shaft", ['"tower", "multi-mass", "basic" or "enhanced"']),
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
    (MULTI, "start.state=zero-no-self-weight", "start.state", ['"equilibrium", "quiet", "zero"']),
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
        ('"mobile"', 'the keys are those of kind "multi-mass"'),
        ("3", 'the keys are those of kind "multi-mass"'),
        ('""', 'the keys are those of kind "multi-mass"'),
    ],
)
def test_an_unknown_kind_is_one_fault_and_the_rest_is_still_checked(kind, hint):
    fault = only_fault(MULTI, f"crane.kind={kind}")
    assert (fault.key, fault.got) == ("crane.kind", kind)
    assert fault.wanted == 'one of "tower", "multi-mass", "basic", "enhanced", "jib", "overhead"'
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
    assert 'states no kind is a "tower" crane' in fault.hint


def test_a_tower_crane_may_state_its_kind():
    assert load_case(RADIAL, ["crane.kind=tower"]).kind == load_case(RADIAL).kind == "tower"


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
    assert {name: kind.name for name, kind in KINDS.items()} == {name: name for name in KINDS}
    assert EveryKey() == {key for case in KINDS.values() for key in known_keys(case.tables)}
    assert known_to("crane.post.height") == ["jib"]
    assert known_to("payload.mass") == list(KINDS)


VALUES = st.one_of(
    st.integers().map(str),
    st.floats().map(repr),
    st.sampled_from(["true", "[]", "{}", '"x"', '"3 m"', '"rest"', '"basic"', "{ value = 3 }", "[{ shape = 1 }]"]),
)


@settings(max_examples=150, deadline=None)
@given(st.sampled_from([MULTI, BASIC, ENHANCED, COMBINED]), st.sampled_from(sorted(EveryKey())), VALUES)
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
    assert parameters_of(load_case("slewing/basic/example-1", changes[:1]).crane).friction_law == "stick-slip"
