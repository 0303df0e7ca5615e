"""The door for slewing and jib cranes: each kind's cases and parameters."""

import math
import tomllib
from dataclasses import FrozenInstanceError, asdict, replace
from functools import partial

import pytest
from samples.case_files import BASIC, COMBINED, ENHANCED, HEAVY, MULTI, PLAN, RADIAL, copy_case, only_fault

from towercrane.cases.case import CaseError, case_folder, list_cases, load_case
from towercrane.cases.models import motions_of
from towercrane.cranes.jib.build import parameters_of as jib_parameters
from towercrane.cranes.jib.tables import JibCase
from towercrane.cranes.parts.load import load_of
from towercrane.cranes.slewing.build import parameters_of
from towercrane.cranes.slewing.parameters import BasicParameters, EnhancedParameters, MultiMassParameters
from towercrane.cranes.slewing.tables import SlewingCase
from towercrane.cranes.tower.file.case_tables import TowerCase
from towercrane.cranes.tower.file.plane import stays_in_plane
from towercrane.schema.provenance import split_provenance

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
    folders = ("qtz5613/", "towers/", "luffing/", "flat-top/", "hammerhead/")
    tower_cranes = {name: kind for name, kind in kinds.items() if name.startswith(folders)}
    assert {name: kind for name, kind in kinds.items() if name not in tower_cranes} == {
        **{f"slewing/{kind}/example-{n}": kind for kind, n, _, _ in EXAMPLES},
        **{f"slewing/{kind}/cycle": kind for kind, _, _, _ in EXAMPLES},
        **dict.fromkeys((PLAN, HEAVY, COMBINED), "jib"),
        **dict.fromkeys(("overhead-crane/travel", "overhead-crane/hoist"), "overhead"),
    }
    assert set(tower_cranes.values()) == {"tower"}
    turned = {
        "manoeuvre",
        "turbulence",
        "weathervane",
        "slewing",
        "gentle",
        "soft-drive",
        "gusts-parked",
        "gusts-working",
        "manoeuvre-within-2e-2",
    }
    in_space = {name for name in tower_cranes if not stays_in_plane(load_case(name).tables(TowerCase))}
    more = {"luffing/manoeuvre", "flat-top/manoeuvre", "flat-top/gusts", "hammerhead/manoeuvre"}
    more |= {"towers/tied-earthquake", "towers/tied-wind"}
    assert in_space == {*(f"qtz5613/{name}" for name in turned), *more}


@pytest.mark.parametrize(("kind", "number", "ramp", "hold"), EXAMPLES)
def test_slewing_examples_are_the_published_ones(kind, number, ramp, hold):
    case = load_case(f"slewing/{kind}/example-{number}")
    assert set(motions_of(case)) == {"shaft", "rope"}
    shaft = motions_of(case)["shaft"]
    assert shaft.switch_times == pytest.approx([0.0, ramp, ramp + hold, 2 * ramp + hold], rel=1e-15)
    assert shaft.range(1) == pytest.approx((0.0, 0.738), rel=1e-15, abs=1e-15)
    assert (float(shaft(0.0)), shaft.end) == (0.0, pytest.approx(0.738 * (ramp + hold), rel=1e-15))
    assert motions_of(case)["rope"].range() == (2.0, 2.0)
    assert case.crane.geometry.jib_radius == 2.0
    assert case.run.duration == {"multi-mass": 25.0}.get(kind, 18.0 if number == 4 else 14.0)
    assert (case.start.state, case.start.sway_radial) == ("equilibrium", None)
    assert load_of(case.payload).mass == 50.5
    assert load_of(case.payload).drag == pytest.approx(0.08, rel=1e-15)


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
    parameters = parameters_of(load_case(name).crane)
    assert type(parameters) is kind
    assert asdict(parameters) == pytest.approx(expected)
    assert parameters.suspension_height == pytest.approx(2.2)
    assert {type(v) for k, v in asdict(parameters).items() if k not in ("name", "friction_law")} == {float}


JIB = {
    "name": "Jib crane", "gravity": 9.81, "post_height": 0.0, "post_inertia": 1e4, "primary_length": 15.0,
    "primary_mass_per_length": 1.5, "secondary_length": 10.0, "secondary_mass_per_length": 1.5,
}  # fmt: skip


def test_jib_crane_is_the_published_one_and_its_heavy_sister():
    assert jib_parameters(load_case(PLAN).crane) == JIB
    heavy = {
        "name": "Jib crane with heavy booms", "post_height": 12.0, "post_inertia": 2e5,
        "primary_mass_per_length": 200.0, "secondary_mass_per_length": 120.0,
    }  # fmt: skip
    assert jib_parameters(load_case(HEAVY).crane) == JIB | heavy == jib_parameters(load_case(COMBINED).crane)


@pytest.mark.parametrize("name", [PLAN, HEAVY])
def test_jib_plan_is_the_published_one(name):
    case = load_case(name)
    luff = motions_of(case)["luff"]
    assert luff.switch_times == pytest.approx([0.0, 20.0, 60.0, 80.0])
    assert luff([0.0, 30.0, 60.0, 80.0], 2) == pytest.approx([0.001, 0.0, -0.001, 0.0], abs=1e-18)
    assert luff.range() == pytest.approx((0.3, 1.5))
    assert [motions_of(case)[joint].range() for joint in ("slew", "fold")] == [(0.0, 0.0)] * 2
    assert (motions_of(case)["rope"].range(), load_of(case.payload).mass) == ((20.0, 20.0), 5000.0)


def test_combined_plan_moves_everything():
    case = load_case(COMBINED)
    assert set(motions_of(case)) == {"slew", "luff", "fold", "rope"}
    plan = {
        "slew": (0.0, 2.0, 48.0),
        "luff": (0.4, 0.8, 56.0),
        "fold": (-0.2, -0.4, 50.0),
        "rope": (20.0, 12.0, 59.0),
    }
    for joint, (start, end, duration) in plan.items():
        motion = motions_of(case)[joint]
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


# Parameters


def test_parameters_refuse_what_is_no_crane():
    parameters = parameters_of(load_case(MULTI).crane)
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


def test_tables_are_asked_of_their_own_kind():
    tower, multi, jib = (load_case(name) for name in (RADIAL, MULTI, PLAN))
    assert tower.tables(TowerCase) is tower.checked
    assert multi.tables(SlewingCase) is multi.checked
    calls = [
        (tower, SlewingCase, '"multi-mass" or "basic" or "enhanced"', "tower"),
        (tower, JibCase, '"jib"', "tower"),
        (multi, TowerCase, '"tower"', "multi-mass"),
        (jib, SlewingCase, '"multi-mass"', "jib"),
        (jib, TowerCase, '"tower"', "jib"),
    ]
    for case, tables, wanted, got in calls:
        with pytest.raises(CaseError) as caught:
            case.tables(tables)
        (fault,) = caught.value.faults
        assert (fault.key, fault.got) == ("crane.kind", f'"{got}"')
        assert wanted in fault.wanted


def test_drag_is_given_as_area_or_as_coefficient():
    assert load_of(load_case(RADIAL, ["payload.drag=0.08 kg/m"]).payload).drag == pytest.approx(0.08)
    assert load_of(load_case(RADIAL, ["payload.drag_area=2 m^2"]).payload).drag_area == 2.0
    fault = only_fault(MULTI, "payload.drag_area=0.1 m^2")
    assert fault.key == "payload.drag"
    assert "drag_area = " in fault.got


def test_friction_can_be_switched_by_its_law_alone():
    for law in ("none", "stick-slip"):
        assert parameters_of(load_case(MULTI, [f"crane.friction.law={law}"]).crane).friction_law == law


def test_friction_may_be_left_out(copied):
    path = copied(BASIC, ("[friction]", "[unread]"))
    assert only_fault(path).key == "unread"
    text = path.with_name("crane.toml").read_text()
    path.with_name("crane.toml").write_text(text[: text.index("[unread]")])
    assert parameters_of(load_case(path).crane).friction_law == "none"
