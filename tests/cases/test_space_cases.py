"""The door for cranes in space: what a case becomes, what it leaves idle, and the messages about it."""

import tomllib
from functools import partial

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples import space_crane as space
from samples.case_files import copy_case, only_fault

from modal import Chain
from towercrane.cases.assumptions import idle_in_file, rests_on
from towercrane.cases.case import CaseError, case_folder, load_case
from towercrane.cases.models import model_of, motions_of
from towercrane.cranes.parts.wind import WindAreas
from towercrane.cranes.slewing.description import Drive
from towercrane.cranes.tower.equations.small_motions import natural_modes
from towercrane.cranes.tower.file.build import crane_of
from towercrane.cranes.tower.file.effects import kept_tower
from towercrane.cranes.tower.file.members import tower_of
from towercrane.runs.run import record_case, run_case
from towercrane.runs.summary import summarise
from towercrane.simulation.simulate import simulate
from towercrane.studies.linear_report import linear_model

MANOEUVRE, SLEWING, DRIVEN = "qtz5613/manoeuvre", "qtz5613/slewing", "qtz5613/soft-drive"
DAMPED = ("tower", "torsion", "jib_lateral", "jib_vertical")
PARKED, WORKING, RADIAL = "qtz5613/gusts-parked", "qtz5613/gusts-working", "qtz5613/condition-3"
WIND = ["wind.speed=10 m/s", "wind.direction=90 deg"]
LATTICES = "crane.tower.lattice", "crane.jib.lattice"
TORSIONAL = ("crane.tower.torsional_stiffness", "crane.tower.torsional_inertia_per_length")


@pytest.fixture
def write(tmp_path):
    return partial(copy_case, tmp_path)


# What a case becomes


def test_manoeuvre_is_the_one_built_by_hand():
    case = load_case(MANOEUVRE, ["run.duration=8 s", "run.output_step=0.5 s"])
    assert crane_of(case.checked) == space.CRANE
    by_hand = simulate(space.model(2, 1, 2, 2), space.manoeuvre(), 8.0, output_step=0.5)
    result = run_case(case)
    for name in by_hand.data_vars:
        scale = abs(by_hand[name].values).max()
        assert_allclose(result[name].values, by_hand[name].values, rtol=0.0, atol=3e-8 * scale)
    assert set(motions_of(case)) == {"trolley", "rope", "slewing"}
    assert motions_of(case)["slewing"].end == pytest.approx(np.pi / 2)
    assert motions_of(case)["slewing"].range(1)[1] == pytest.approx(0.6 * 2 * np.pi / 60)


def test_drive_wind_and_damping_arrive_as_written():
    case = load_case(DRIVEN, [*WIND, "model.torsion_damping_ratio=2 %", "model.tower_modes=1"])
    model = model_of(case)
    assert model.slewing == Drive("slewing", 4e6, 20e6, 0.01, 4e5, "tanh", 2e4, 0.005)
    assert model.drive_inertia == 2e5
    assert set(model.channels) == {"trolley", "rope", "shaft", "wind_x", "wind_y", "wind_z"} == set(motions_of(case))
    assert_allclose([motions_of(case)[f"wind_{axis}"].end for axis in "xyz"], [0.0, 10.0, 0.0], atol=1e-15)
    assert (model.damping.torsion, model.damping.tower, model.counts["tower_y"]) == (0.02, 0.0, 1)
    with_areas = space.model(1, 1, 2, 2, areas=WindAreas(0.8, 0.5, 0.6, 4.0)).crane
    for (found,), (wanted,) in zip(
        vars(model.crane.exposure).values(), vars(with_areas.exposure).values(), strict=True
    ):
        shares = (found.area, wanted.area) if hasattr(found, "area") else (found.jib.moment, wanted.jib.moment)
        assert shares[0] == pytest.approx(shares[1], rel=1e-14)
    assert motions_of(load_case(SLEWING, [*WIND, "wind.upward=-2 m/s"]))["wind_z"].end == -2.0


def test_gusts_are_those_of_their_file():
    case = load_case(WORKING)
    rows = np.loadtxt(case_folder() / "qtz5613" / "gusts.csv", delimiter=",", skiprows=1)
    for column, axis in enumerate("xyz", start=1):
        assert_allclose(motions_of(case)[f"wind_{axis}"](rows[:, 0]), rows[:, column], atol=1e-12)
        between = 0.5 * (rows[1:, column] + rows[:-1, column])
        assert_allclose(motions_of(case)[f"wind_{axis}"](rows[:-1, 0] + 0.25), between, atol=1e-12)


def test_head_rests_where_nothing_turns_it():
    parked = load_case(PARKED, ["motion.slewing.start=30 deg"])
    assert motions_of(parked)["slewing"].range() == pytest.approx((np.pi / 6, np.pi / 6))
    assert model_of(parked).drive is None


def test_towers_of_segments_and_lattices_serve_in_space(write):
    laced = (case_folder() / "towers" / "crane-laced.toml").read_text("utf-8")
    tower = laced[laced.index("[tower]") : laced.index("[jib]")]
    crane = (case_folder() / "qtz5613" / "crane.toml").read_text("utf-8")
    uniform = crane[crane.index("[tower]") : crane.index("[jib]")]
    torsion = "".join(line + "\n" for line in uniform.splitlines() if line.startswith("torsional"))
    path = write(SLEWING, (uniform, tower.replace("[tower.lattice]", f"{torsion}\n[tower.lattice]")))
    case = load_case(path, ["run.duration=1 s"])
    assert isinstance(tower_of(case.crane), Chain)
    assert crane_of(case.checked).shaft.length == tower_of(case.crane).length
    result = run_case(case)
    assert result.attrs["outcome"] == "finished"
    assert repr(tower_of(case.crane)) == repr(kept_tower(load_case("towers/laced").checked))


# One crane file for the plane and for space


def test_a_scene_in_the_plane_leaves_idle_what_leaves_it():
    case = load_case(RADIAL, ["run.duration=10 s"])
    assert idle_in_file(case) == (
        *TORSIONAL, "crane.tower.lattice", "crane.jib.lateral_second_moment_of_area", "crane.jib.lattice",
        "crane.wind_areas", "crane.drive", "crane.friction",
    )  # fmt: skip
    assert summarise(case, record_case(case))["idle"] == list(idle_in_file(case))
    assert [a.key for a in rests_on(case)] == ["crane.jib.youngs_modulus", "crane.jib.second_moment_of_area"]


@pytest.mark.parametrize(
    ("name", "changes", "used", "idle"),
    [
        (MANOEUVRE, [], {"torsional", "lateral_"}, {*LATTICES, "crane.wind_areas", "crane.drive", "crane.friction"}),
        (MANOEUVRE, ["model.torsion_modes=0"], {"lateral_"},
         {*LATTICES, *TORSIONAL, "crane.wind_areas", "crane.drive", "crane.friction"}),
        (DRIVEN, [], {"torsional", "lateral_", "crane.drive", "crane.friction"}, {*LATTICES, "crane.wind_areas"}),
        (WORKING, ["model.jib_lateral_modes=0"], {"torsional", "wind_areas"},
         {*LATTICES, "crane.jib.lateral_second_moment_of_area", "crane.drive", "crane.friction"}),
    ],
)  # fmt: skip
def test_a_run_names_what_it_rests_on_and_what_it_leaves_idle(name, changes, used, idle):
    case = load_case(name, changes)
    keys = {a.key for a in rests_on(case)}
    assert all(any(word in key for key in keys) for word in used)
    assert set(idle_in_file(case)) == idle
    assert not any(key.startswith(tuple(idle)) for key in keys)


# Messages

FAULTS = [
    (SLEWING, ["motion.shaft.shape=rest"], "motion.slewing", ["one of [motion.slewing]", "leave one out"]),
    (SLEWING, ["wind.direction=3 deg"], "wind.speed", ["a speed", "or series"]),
    (SLEWING, ["wind.speed=200 km/h"], None, []),
    (SLEWING, ["wind.speed=120 m/s"], "wind.speed", ["km/h meant?"]),
    (WORKING, ["wind.speed=9 m/s"], "wind.series", ["beside speed", "not both"]),
    (WORKING, ["wind.series=gust.csv"], "", ["no readable file", "wind.series"]),
    (SLEWING, ["crane.friction.law=stick-slip"], "crane.friction.law", ['one of "tanh", "none"']),
    (SLEWING, ["crane.tower.torsional_stiffness=-1"], "crane.tower.torsional_stiffness", ["above 0"]),
    (SLEWING, ["crane.tower.torsional_stiffness=170 N m^2"], "crane.tower.torsional_stiffness", ["MN m^2 meant?"]),
    (SLEWING, ["model.torsion_modes=15"], "model.torsion_modes", ["from 0 to 14"]),
    (SLEWING, ["model.torsional_modes=1"], "model.torsional_modes", ['closest known key: "torsion_modes"']),
    (MANOEUVRE, ["motion.slewing.speed=90"], "motion.slewing.speed", ["not plausible", "deg/s meant?"]),
    (MANOEUVRE, ["modes.rope_lengths=[30]"], "modes.rope_lengths.0", ["rope lengths above 0 and up to 23.8 m"]),
    (MANOEUVRE, ["modes.trolley_positions=[60]"], "modes.trolley_positions.0", ["the trolley leaves the jib"]),
    (MANOEUVRE, ["accuracy.target=5"], "accuracy.target", ["above 0 to 0.5", "50 % of the peak at most"]),
]  # fmt: skip


@pytest.mark.parametrize(("name", "changes", "key", "words"), FAULTS)
def test_one_slip_makes_one_message(name, changes, key, words):
    if key is None:
        assert motions_of(load_case(name, changes))["wind_x"].end == pytest.approx(200 / 3.6)
        return
    fault = only_fault(name, *changes)
    seen = f"{fault.wanted} {fault.got} {fault.hint}"
    assert fault.key == key or key.endswith(fault.key)
    assert all(word in seen for word in words), seen


@pytest.mark.parametrize(
    ("table", "line", "key", "words"),
    [
        (SLEWING, "torsional_inertia_per_length", "tower.torsional_inertia_per_length", "model.torsion_modes = 0"),
        (SLEWING, "lateral_second", "jib.lateral_second_moment_of_area", "model.jib_lateral_modes = 0"),
    ],
)
def test_modes_of_a_member_need_its_data(write, table, line, key, words):
    crane = (case_folder() / "qtz5613" / "crane.toml").read_text("utf-8")
    whole = next(text for text in crane.splitlines() if text.startswith(line))
    lattice = crane[crane.index("[tower.lattice]") : crane.index("[jib]")]
    path = write(table, (whole + "\n", ""), (lattice, ""))
    fault = only_fault(path)
    assert (fault.key, fault.got) == (key, "nothing: the key is missing")
    assert words in fault.hint
    off = words.replace(" ", "")
    load_case(path, [off])


def test_a_shaft_needs_its_drive_and_a_wind_something_to_press_on(write):
    crane = (case_folder() / "qtz5613" / "crane.toml").read_text("utf-8")
    drive = crane[crane.index("[drive]") : crane.index("[friction]")]
    fault = only_fault(write(DRIVEN, (drive, "")))
    assert fault.key == "drive"
    assert "soft_stiffness" in fault.wanted
    areas = crane[crane.index("[wind_areas]") : crane.index("[drive]")]
    path = write(SLEWING, (areas, ""))
    fault = only_fault(path, *WIND)
    assert (fault.key, fault.got) == ("wind", "no area at all")
    assert "wind_x" in motions_of(load_case(path, [*WIND, "payload.drag_area=1 m^2"]))


@pytest.mark.parametrize(
    ("old", "new", "line", "wanted"),
    [
        ("time [s],x [m/s],y [m/s],z [m/s]\n", "", "line 1", "a header line"),
        ("\n1,", "\n1.2,", "line 4", "the time 1 s, evenly spaced from 0"),
        ("\n0.5,", "\n-1,", "line 3", "a time after the last"),
        ("\n1,", "\n1;", "line 4", "four finite numbers"),
        ("\n1,", "\n1,900,", "line 4", "four finite numbers"),
    ],
)
def test_gusts_are_checked_line_by_line(write, old, new, line, wanted):
    with pytest.raises(CaseError) as caught:
        load_case(write(WORKING, (old, new)))
    first = caught.value.faults[0]
    assert first.file.endswith("gusts.csv")
    assert first.key == line
    assert wanted in first.wanted
    assert "named by wind.series" in first.hint


def test_every_space_key_is_shown_in_a_shipped_crane():
    crane = tomllib.loads((case_folder() / "qtz5613" / "crane.toml").read_text("utf-8"))
    assert {"soft_stiffness", "stiff_stiffness", "corner", "damping", "inertia"} == set(crane["drive"])
    assert {"tower", "jib", "counter_jib", "counterweight"} == set(crane["wind_areas"])


FEW = [f"model.{kind}=1" for kind in ("tower_modes", "jib_lateral_modes", "jib_vertical_modes")]


@pytest.mark.parametrize("at", [0.0, 1000.0])
def test_linear_model_names_the_sways_by_where_the_jib_points(at):
    case = load_case(MANOEUVRE, FEW)
    rope = float(motions_of(case)["rope"](at))
    table = linear_model(case, at).eigenvalues()
    outward = next(e.frequency for e in table if e.state == "sway_outward")
    assert outward == pytest.approx(np.sqrt(9.81 / rope) / (2 * np.pi), rel=2e-3)


def test_linear_model_of_a_case_is_named_and_has_the_cranes_frequencies():
    case = load_case(SLEWING, [f"model.{kind}_damping_ratio=0" for kind in DAMPED])
    linear = linear_model(case, 0.0)
    assert [signal.name for signal in linear.inputs] == [f"{name}_acceleration" for name in model_of(case).channels]
    assert {"torsion_mode_1", "jib_lateral_mode_2", "sway_sideways"} <= {signal.name for signal in linear.states}
    assert {"slewing_torque", "tower_tip_twist", "payload_position_up"} & {signal.name for signal in linear.outputs}
    modes = natural_modes(model_of(case), 30.0, 15.0)
    assert_allclose(linear.frequencies, [mode.frequency_hz for mode in modes], rtol=2e-6)
