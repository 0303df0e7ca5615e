"""The door for case files: what it reads, and how it explains what it cannot read."""

import json
import math
import subprocess
import sys
import tomllib
from fnmatch import fnmatchcase
from functools import partial
from pathlib import Path

import pytest
from case_files import CASE, CRANE, SEQUENCE, faults_of, only_fault, with_motion, write_case
from hypothesis import given, settings
from hypothesis import strategies as st

from modal.beam import Beam
from towercrane import shipped
from towercrane.case import Assumption, CaseError, Fault, case_folder, list_cases, load_case
from towercrane.casefile import leaves, split_provenance
from towercrane.explain import known_keys
from towercrane.faults import closest, did_you_mean, shown
from towercrane.plausibility import RANGES
from towercrane.profiles import read_points
from towercrane.units import to_si


@pytest.fixture
def write(tmp_path):
    return partial(write_case, tmp_path)


# What is read


def test_values_are_si_and_defaults_hold(write):
    case = load_case(write())
    assert (case.name, case.title, case.path.name) == ("case", "A case", "case.toml")
    assert case.crane.tower.height == 30.0
    assert case.crane.counter_jib.counterweight == 10e3
    assert (case.crane.gravity, case.crane.source, case.crane.tower.lattice) == (9.81, "", None)
    assert (case.payload.mass, case.payload.rope_damping, case.payload.drag_area) == (800.0, 0.0, 0.0)
    assert (case.model.tower_modes, case.model.jib_modes, case.model.weight_softening) == (2, 3, False)
    assert (case.model.tower_damping_ratio, case.model.jib_damping_ratio) == (0.0, 0.0)
    assert (case.start.state, case.start.swing_angle) == ("equilibrium", 0.0)
    assert (case.run.duration, case.run.output_step) == (60.0, 0.05)
    assert (case.solver.method, case.solver.rtol, case.solver.atol) == ("dop853", 1e-8, 1e-10)
    assert (case.modes.count, case.modes.trolley_positions, case.modes.elements) == (
        4,
        pytest.approx((5.0, 30.0)),
        32,
    )
    assert case.assumed == ()


def test_every_optional_key_is_read(write):
    options = """
[model]
tower_modes = 0
jib_modes = 14
weight_softening = true
tower_damping_ratio = "2 %"
jib_damping_ratio = 0.01
[start]
state = "zero"
swing_angle = "-5 deg"
[solver]
method = "scipy-radau"
rtol = 1e-5
atol = 1e-7
[modes]
count = 6
trolley_positions = ["5 m", 30]
elements = 64
"""
    path = write(
        ('mass = "800 kg"', 'mass = 800\nrope_damping = "3 N m s/rad"\ndrag_area = "2 m^2"'),
        case_text=CASE + 'output_step = "20 ms"' + options,
        crane=[('name = "Small"', 'name = "Small"\ngravity = "981 cm/s^2"\nsource = "mine"')],
    )
    case = load_case(path)
    assert (case.payload.mass, case.payload.rope_damping, case.payload.drag_area) == (800.0, 3.0, 2.0)
    assert (case.model.tower_modes, case.model.jib_modes, case.model.weight_softening) == (0, 14, True)
    assert case.model.tower_damping_ratio == pytest.approx(0.02)
    assert case.model.jib_damping_ratio == 0.01
    assert case.start.swing_angle == pytest.approx(math.radians(-5))
    assert case.start.state == "zero"
    assert case.run.output_step == pytest.approx(0.02)
    assert (case.solver.method, case.solver.rtol, case.solver.atol) == ("scipy-radau", 1e-5, 1e-7)
    assert (case.modes.count, case.modes.trolley_positions, case.modes.elements) == (6, (5.0, 30.0), 64)
    assert case.crane.gravity == pytest.approx(9.81)


def test_domain_objects(write):
    case = load_case(write())
    crane = case.radial_crane()
    assert crane.tower == case.tower_beam() == Beam(30.0, 300.0, to_si("210 GPa", "Pa"), 0.01)
    assert crane.jib == case.jib_beam() == Beam(40.0, 100.0, to_si("210 GPa", "Pa"), 0.003)
    assert (crane.counter_jib_length, crane.counter_jib_mass_per_length) == (10.0, 150.0)
    assert (crane.name, crane.counterweight, crane.trolley_mass, crane.gravity) == (
        "Small",
        10e3,
        300.0,
        9.81,
    )
    assert case.load().mass == 800.0
    trolley, rope = case.trolley_motion(), case.rope_motion()
    assert float(trolley(0.0)) == 5.0
    assert float(trolley(8.0, 1)) == pytest.approx(0.8)
    assert trolley.duration == pytest.approx(25 / 0.8 + 8.0)
    assert float(rope(17.0)) == 12.0
    assert case.lattice() is None


def test_an_inline_crane_needs_no_file(write):
    inline = "[crane]\n" + CRANE.replace("[", "[crane.")
    path = write(('crane = "crane.toml"', ""), case_text=CASE + inline)
    (path.parent / "crane.toml").unlink()
    assert load_case(path).crane.jib.length == 40.0
    path.write_text(path.read_text().replace('height = "30 m"', 'heigth = "30 m"'))
    fault = only_fault(path)
    assert (fault.file, fault.key) == (str(path), "crane.tower.heigth")


def test_assumed_values_are_listed_as_written_the_cranes_first(write):
    path = write(
        ('"800 kg"', '{ value = "800 kg", assumed = "a guess" }'),
        crane=[
            ('"40 m"', '{ value = "40 m", source = "data sheet" }'),
            ('"0.003 m^4"', '{ value = 0.003, assumed = "not printed" }'),
        ],
    )
    case = load_case(path)
    assert case.assumed == (
        Assumption("crane.jib.second_moment_of_area", 0.003, "not printed"),
        Assumption("payload.mass", "800 kg", "a guess"),
    )
    assert case.crane.jib.length == 40.0
    assert case.as_written["crane"]["jib"]["length"] == {"value": "40 m", "source": "data sheet"}
    assert json.loads(json.dumps(case.as_written)) == case.as_written
    # A value given on the command line is no longer the file's assumption.
    assert [a.key for a in load_case(path, ["payload.mass=900 kg"]).assumed] == ["crane.jib.second_moment_of_area"]


@pytest.mark.parametrize(
    ("table", "key", "words"),
    [
        ('{ value = "800 kg", asumed = "x" }', "payload.mass.asumed", ("unknown", '"assumed"')),
        ('{ value = "800 kg", assumed = "" }', "payload.mass.assumed", ("why", '""')),
        ('{ value = "800 kg", assumed = true }', "payload.mass.assumed", ("why", "true")),
        ('{ assumed = "x" }', "payload.mass", ("a mass", "a table with assumed")),
    ],
)
def test_provenance_faults(write, table, key, words):
    fault = only_fault(write(('"800 kg"', table)))
    assert fault.key == key
    assert all(w in str(fault) for w in words)


# Motions


def test_s_curve_and_delay(write):
    text = 'shape = "s-curve"\nstart = 5\nend = 20\nspeed = 0.8\nacceleration = 0.1\njerk = 0.05\ndelay = "4 s"'
    motion = load_case(write(case_text=with_motion(text))).trolley_motion()
    assert float(motion(3.9)) == 5.0
    assert float(motion(5.0, 2)) == pytest.approx(0.05)
    assert motion.end == pytest.approx(20.0)


def test_rest_is_where_the_modes_are_shown(write):
    case = load_case(write(case_text=with_motion('shape = "rest"\nstart = "7 m"')))
    assert case.trolley_motion().range() == (7.0, 7.0)
    assert case.modes.trolley_positions == (7.0,)


def test_sequence_of_trolley_and_hoist(write):
    move = 'speed = "0.5 m/s", acceleration = "0.1 m/s^2"'
    text = f"""shape = "sequence"
start = "5 m"
delay = "1 s"
steps = [{{ shape = "trapezoid", end = "20 m", {move} }}, {{ shape = "rest", duration = "10 s" }},
         {{ shape = "s-curve", end = "8 m", {move}, jerk = "0.1 m/s^3", delay = "2 s" }}]
"""
    hoist = f'[motion.hoist]\nshape = "trapezoid"\nend = "20 m"\n{move.replace(", ", chr(10))}\n'
    case = load_case(write(case_text=with_motion(text, hoist)))
    trolley, rope = case.trolley_motion(), case.rope_motion()
    first = 15 / 0.5 + 5
    assert float(trolley(1.0 + first + 12.0)) == pytest.approx(20.0)
    assert float(trolley(1.0 + first + 12.5)) < 20.0
    assert trolley.end == pytest.approx(8.0)
    assert trolley.range() == pytest.approx((5.0, 20.0))
    assert (float(rope(0.0)), rope.end) == (12.0, pytest.approx(20.0))


def test_table_from_csv(write, tmp_path):
    (tmp_path / "way.csv").write_text("\ufefftime,position\n0,5\n10,12.5\n\n20,20\n", "utf-8")
    case = load_case(write(case_text=with_motion('shape = "table"\nfile = "way.csv"\ndelay = 2')))
    assert float(case.trolley_motion()(12.0)) == pytest.approx(12.5)
    assert case.trolley_motion().end == pytest.approx(20.0)


CSV_FAULTS = [
    ("t,x\n0,5,1\n1,6\n2,7\n", "line 2", "two columns", "3 in"),
    ("t;x\n0;5\n1;6\n", "line 2", "commas", "1 in"),
    ("t,x\n0,5\n2,6\n2,7\n", "line 4", "a time after 2", "2"),
    ("t,x\n0,5\n1,six\n", "line 3", "two finite numbers", "1,six"),
    ("t,x\n0,5\n1,nan\n", "line 3", "two finite numbers", "1,nan"),
    ("t,x\n1,5\n2,6\n", "line 2", "a first time of 0", "1"),
    ("0,5\n1,6\n", "line 1", "a header line", "0,5"),
    ("", "", "a CSV file", "0 lines"),
    ("t,x\n0,5\n", "", "two or more", "1 lines"),
]


@pytest.mark.parametrize(("text", "line", "wanted", "got"), CSV_FAULTS)
def test_csv_faults_name_file_and_line(write, tmp_path, text, line, wanted, got):
    (tmp_path / "way.csv").write_text(text)
    fault = faults_of(write(case_text=with_motion('shape = "table"\nfile = "way.csv"')))[0]
    assert fault.file == str(tmp_path / "way.csv")
    assert fault.key == line
    assert wanted in str(fault)
    assert got in fault.got


def test_csv_that_is_missing_or_not_text(write, tmp_path):
    path = write(case_text=with_motion('shape = "table"\nfile = "way.csv"'))
    assert only_fault(path).file == str(tmp_path / "way.csv")
    (tmp_path / "way.csv").write_bytes(b"\xff\xfe\x00")
    assert "UTF-8" in only_fault(path).got
    assert "no readable file" in only_fault(path, r'motion.trolley.file="a\u0000b"').got


def test_csv_reports_every_faulty_line(tmp_path):
    path = tmp_path / "way.csv"
    path.write_text("t,x\n0,5\nx,6\n2,7,8\n")
    with pytest.raises(CaseError) as caught:
        read_points(path)
    assert [f.key for f in caught.value.faults] == ["line 3", "line 4"]


def test_hoist_table_begins_at_the_rope_length(write, tmp_path):
    (tmp_path / "rope.csv").write_text("t,l\n0,13\n10,15\n")
    hoist = '\n[motion.hoist]\nshape = "table"\nfile = "rope.csv"\n'
    path = write(case_text=with_motion('shape = "rest"\nstart = "7 m"', hoist))
    fault = only_fault(path)
    assert fault.key == "motion.hoist.file"
    assert "rope.length, 12 m" in fault.wanted
    assert "13 m" in fault.got
    assert load_case(path, ["rope.length=13 m"]).rope_motion().end == pytest.approx(15.0)


def test_a_spline_that_overshoots_the_jib_is_caught(write, tmp_path):
    (tmp_path / "way.csv").write_text("t,x\n0,5\n10,39.9\n11,40\n12,40\n")
    fault = only_fault(write(case_text=with_motion('shape = "table"\nfile = "way.csv"')))
    assert fault.key == "motion.trolley.file"
    assert "40 m" in fault.wanted
    assert "a motion from 5 to 40." in fault.got


# Faults: (replacement in the case, replacement in the crane, key, words of the message)

MEND = [
    (
        ('"800 kg"', '"800 kgg"'),
        None,
        "payload.mass",
        ["a mass", '"800 kgg"', "unknown", 'did you mean "kg"?'],
    ),
    (None, ('"30 m"', '"23.8 s"'), "tower.height", ['a length, such as "18 m"', '"23.8 s", which is a time']),
    (None, ("height", "heigth"), "tower.heigth", ["height, beam, segments", "unknown key", '"height"']),
    (None, ("[jib]", "[jibb]"), "jibb", ["unknown key", 'closest known key: "jib"']),
    (('mass = "800 kg"', ""), None, "payload.mass", ['a mass, such as "800 kg"', "missing"]),
    (('[payload]\nmass = "800 kg"', ""), None, "payload", ["a table [payload] with mass", "missing"]),
    (('"800 kg"', "[800]"), None, "payload.mass", ["a mass", "a list of 1"]),
    (('"800 kg"', "true"), None, "payload.mass", ["a mass", "true"]),
    (('"800 kg"', "nan"), None, "payload.mass", ["finite", "nan"]),
    (('"800 kg"', "inf"), None, "payload.mass", ["finite", "inf"]),
    (('"800 kg"', '"-800 kg"'), None, "payload.mass", ["above 0", '"-800 kg"']),
    (('"800 kg"', "0"), None, "payload.mass", ["above 0", "got:    0"]),
    (('"800 kg"', '"20 degC"'), None, "payload.mass", ["a mass", "degC", "unknown"]),
    (('"800 kg"', '"20 dB"'), None, "payload.mass", ["a mass", "dB", "unknown"]),
    (('title = "A case"', "title = 3"), None, "title", ["a text in quotes", "got:    3"]),
    (('title = "A case"', "title = 2001-01-01"), None, "title", ["a text in quotes", "2001-01-01"]),
    (('shape = "trapezoid"', ""), None, "motion.trolley.shape", ['"trapezoid"', '"s-curve"', "missing"]),
    (
        ('"trapezoid"', '"trapezium"'),
        None,
        "motion.trolley.shape",
        ['"trapezium"', 'did you mean "trapezoid"?'],
    ),
    (('speed = "0.8 m/s"', ""), None, "motion.trolley.speed", ["a speed", "missing"]),
    (('"0.8 m/s"', '"0 m/s"'), None, "motion.trolley.speed", ["a speed", "above 0", '"0 m/s"']),
    (('"0.1 m/s^2"', '"-0.1 m/s^2"'), None, "motion.trolley.acceleration", ["an acceleration", "above 0"]),
    (("acceleration", "jerk = 0\nacceleration"), None, "motion.trolley.jerk", ["unknown key"]),
    (('"60 s"', '"0 s"'), None, "run.duration", ["a time", "above 0"]),
    (('"60 s"', '"60 s"\noutput_step = 70'), None, "run.output_step", ["at most run.duration, 60 s", "70 s"]),
    (
        ('"60 s"', '"60 s"\noutput_step = "1 µs"'),
        None,
        "run.output_step",
        ["5000000 output samples", "6e+07"],
    ),
    (('"60 s"', '"60 s"\n[model]\ntower_modes = 15'), None, "model.tower_modes", ["from 0 to 14", "15"]),
    (('"60 s"', '"60 s"\n[model]\ntower_modes = -1'), None, "model.tower_modes", ["from 0 to 14", "-1"]),
    (('"60 s"', '"60 s"\n[model]\njib_modes = 2.0'), None, "model.jib_modes", ["whole number", "2.0"]),
    (('"60 s"', '"60 s"\n[model]\njib_modes = "2"'), None, "model.jib_modes", ["whole number", '"2"']),
    (('"60 s"', '"60 s"\n[model]\njib_modes = true'), None, "model.jib_modes", ["whole number", "true"]),
    (('"60 s"', '"60 s"\n[model]\nweight_softening = 1'), None, "model.weight_softening", ["true or false"]),
    (('"60 s"', '"60 s"\n[solver]\nrtol = 1e-14'), None, "solver.rtol", ["from 1e-13 to 0.1", "1e-14"]),
    (('"60 s"', '"60 s"\n[solver]\nrtol = 0.2'), None, "solver.rtol", ["from 1e-13 to 0.1", "0.2"]),
    (('"60 s"', '"60 s"\n[solver]\natol = 0'), None, "solver.atol", ["above 0", "got:    0"]),
    (('"60 s"', '"60 s"\n[solver]\nduration = 3'), None, "solver.duration", ["known as", "run.duration"]),
    (
        ('"60 s"', '"60 s"\n[start]\nstate = "zro"'),
        None,
        "start.state",
        ['did you mean "zero"?', '"equilibrium"'],
    ),
    (('"60 s"', '"60 s"\n[modes]\ntrolley_positions = 5'), None, "modes.trolley_positions", ["list"]),
    (
        ('"60 s"', '"60 s"\n[modes]\ntrolley_positions = [5, 41]'),
        None,
        "modes.trolley_positions.1",
        ["40 m", "41"],
    ),
    (('"60 s"', '"60 s"\n[modes]\ncount = 0'), None, "modes.count", ["from 1 to 50"]),
    (('"5 m"', '"-1 m"'), None, "motion.trolley.start", ["from 0 to 40 m (the length of the jib)", '"-1 m"']),
    (
        ('"30 m"', '"41 m"'),
        None,
        "motion.trolley.end",
        ["from 0 to 40 m (the length of the jib)", "leaves the jib"],
    ),
    (('"12 m"', '"31 m"'), None, "rope.length", ["up to 30 m (the height of the tower)", '"31 m"', "ground"]),
    (('"12 m"', '"0 m"'), None, "rope.length", ["above 0", '"0 m"']),
    ((None), ('"10 t"', '"-1 kg"'), "counter_jib.counterweight", ["from 0", '"-1 kg"']),
]


@pytest.mark.parametrize(("change", "crane", "key", "words"), MEND)
def test_one_slip_makes_one_message(write, change, crane, key, words):
    path = write(*([change] if change else []), crane=[crane] if crane else [])
    faults = faults_of(path)
    assert [f.key for f in faults] == [key]
    fault = faults[0]
    assert fault.file == str(path if change else path.with_name("crane.toml"))
    text = str(fault)
    assert text.startswith(f"{fault.file}: {key}\n  wanted: ")
    for word in words:
        assert word in text


IMPLAUSIBLE = [
    ("crane.tower.youngs_modulus", 210, "GPa meant?"),
    ("crane.tower.youngs_modulus", "210 MPa", "GPa meant?"),
    ("crane.jib.youngs_modulus", 210000, "MPa meant?"),
    ("crane.tower.height", 60000, "mm meant?"),
    ("crane.tower.height", "60000 m", "mm meant?"),
    ("crane.tower.second_moment_of_area", 1.4e6, "cm^4 meant?"),
    ("crane.counter_jib.counterweight", 15.13, "t meant?"),
    ("payload.mass", 0.8, "t meant?"),
    ("motion.trolley.speed", 48, "m/min meant?"),
    ("start.swing_angle", -20, "deg meant?"),
    ("model.tower_damping_ratio", 2, "% meant?"),
    ("run.duration", 1e7, "ms meant?"),
    ("crane.gravity", 981, "cm/s^2 meant?"),
]


@pytest.mark.parametrize(("key", "value", "meant"), IMPLAUSIBLE)
def test_implausible_values_name_the_likely_unit_and_can_be_allowed(write, key, value, meant):
    path, override = write(), f"{key}={json.dumps(value)}"
    extra = ["run.output_step=10"] if key == "run.duration" else []
    fault = only_fault(path, override, *extra)
    assert (fault.file, fault.key) == (f"--set {override}", key)
    assert "a value from " in fault.wanted
    assert shown(value) in fault.got
    assert fault.hint.startswith(meant)
    allowed = f'allow_implausible = ["{key}"]'
    assert allowed in fault.hint
    load_case(path, [override, *extra, allowed])


def test_impossible_values_cannot_be_allowed(write):
    path = write()
    fault = only_fault(path, "payload.mass=-5", 'allow_implausible=["payload.mass"]')
    assert "above 0" in fault.wanted
    assert only_fault(path, "rope.length=31", 'allow_implausible=["rope.length"]').key == "rope.length"


def test_allowing_an_unknown_key_is_a_fault(write):
    fault = only_fault(write(), 'allow_implausible=["crane.tower.hieght"]')
    assert "crane.tower.hieght" in fault.got
    assert "crane.tower.height" in fault.hint


def test_the_table_of_ranges_is_sound():
    known = set(known_keys())
    for row in RANGES:
        assert 0.0 < row.low < row.high, row
        for unit in row.likely:
            to_si(f"1 {unit}", row.unit)
        assert any(fnmatchcase(k, row.key) for k in known), row


def test_all_faults_come_at_once(write, tmp_path):
    path = write(
        ('"800 kg"', '"800 kgg"'),
        ('length = "12 m"', 'lenght = "12 m"'),
        ('"0.8 m/s"', '"0.8 m"'),
        ('"30 m"', '"70 m"'),
        ('[run]\nduration = "60 s"', "[run]\nduration = -1"),
        crane=[('"210 GPa"', "210"), ('height = "30 m"', ""), ('"300 kg"', '"-300 kg"')],
    )
    faults = faults_of(path)
    assert sorted((Path(f.file).name, f.key) for f in faults) == [
        ("case.toml", "motion.trolley.end"),
        ("case.toml", "motion.trolley.speed"),
        ("case.toml", "payload.mass"),
        ("case.toml", "rope.lenght"),
        ("case.toml", "run.duration"),
        ("crane.toml", "tower.height"),
        ("crane.toml", "tower.youngs_modulus"),
        ("crane.toml", "trolley.mass"),
    ]
    with pytest.raises(CaseError) as caught:
        load_case(path)
    text = str(caught.value)
    assert text.startswith("8 faults in the input\n\n")
    assert all(str(f) in text for f in faults)
    assert "Traceback" not in text


def test_faults_in_steps_name_the_step(write):
    text = SEQUENCE + 'steps = [{ shape = "rest" }, { shape = "trapezoid", ed = 50, speed = 1 }]'
    faults = faults_of(write(case_text=with_motion(text)))
    assert [f.key for f in faults] == ["motion.trolley.steps.1.ed", "motion.trolley.steps.1.acceleration"]
    text = text.replace(" ed =", " end =").replace("speed = 1", "speed = 1, acceleration = 1")
    assert only_fault(write(case_text=with_motion(text))).key == "motion.trolley.steps.1.end"
    fault = only_fault(write(case_text=with_motion(SEQUENCE + "steps = []")))
    assert (fault.key, fault.wanted) == ("motion.trolley.steps", "a list of tables, one per step")


@pytest.mark.parametrize(("end", "words"), [("0 m", "above 0"), ("31 m", "30 m (the height"), ("-2 m", "above 0")])
def test_hoist_keeps_the_load_between_trolley_and_ground(write, end, words):
    hoist = f'\n[motion.hoist]\nshape = "trapezoid"\nend = "{end}"\nspeed = 1\nacceleration = 1\n'
    fault = only_fault(write(case_text=with_motion('shape = "rest"\nstart = "7 m"', hoist)))
    assert fault.key == "motion.hoist.end"
    assert words in fault.wanted
    assert end in fault.got


def test_rope_and_trolley_may_reach_their_limits_exactly(write):
    case = load_case(write(('"30 m"', '"40 m"'), ('"12 m"', '"30 m"'), ('"5 m"', '"0 m"')))
    assert case.trolley_motion().range() == pytest.approx((0.0, 40.0))


def test_lacing_with_horizontals_needs_them(write):
    members = '[tower.lattice]\nleg_area = "50 cm^2"\nleg_spacing = 1.7\npanel_height = 1.4\nlacing = "N"\n'
    members += 'diagonal_area = "8 cm^2"\n'
    path = write(crane=[("[jib]", members + "[jib]")])
    fault = only_fault(path)
    assert (Path(fault.file).name, fault.key) == ("crane.toml", "tower.lattice.horizontal_area")
    column = load_case(path, ["crane.tower.lattice.horizontal_area=8 cm^2"]).lattice()
    assert (column.lacing, column.horizontal_area, column.youngs_modulus) == (
        "N",
        pytest.approx(8e-4),
        to_si("210 GPa", "Pa"),
    )
    assert 'did you mean "zigzag"?' in only_fault(path, "crane.tower.lattice.lacing=zigzig").hint


# Files


@pytest.mark.parametrize(
    ("text", "key", "words"),
    [
        (CASE.replace('"800 kg"', "800 kg"), "line 4, column 12", ["TOML", "mass = 800 kg", "in quotes"]),
        (CASE.replace('"800 kg"', "heavy"), "line 4, column 8", ["TOML", "mass = heavy", "in quotes"]),
        (CASE.replace('mass = "800 kg"', "mass ="), "line 4, column 7", ["TOML"]),
        (CASE.replace("[rope]", "[payload]"), "line 5, column 9", ["twice"]),
        (CASE + '"', "end of file", ["TOML"]),
        (CASE + "\nx = " + "9" * 5000, "", ["TOML"]),
        (CASE + "\nx = " + "[" * 5000, "", ["TOML"]),
    ],
)
def test_syntax_errors_give_line_and_column(write, text, key, words):
    fault = only_fault(write(case_text=text))
    if key:
        assert fault.key.split(",")[0] == key.split(",")[0]
        assert fault.key.split("column")[0] == key.split("column")[0]
    for word in words:
        assert word in str(fault)


def test_syntax_error_in_the_crane_leaves_the_case_checked(write, tmp_path):
    path = write(('"800 kg"', '"800 m"'))
    (tmp_path / "crane.toml").write_text("[tower\n")
    faults = faults_of(path)
    assert [Path(f.file).name for f in faults] == ["crane.toml", "case.toml"]
    assert faults[0].key.startswith("line 1, column ")
    assert faults[1].key == "payload.mass"


def test_empty_files(write, tmp_path):
    path = write()
    (tmp_path / "crane.toml").write_text("# nothing\n")
    fault = only_fault(path)
    assert (Path(fault.file).name, fault.got) == ("crane.toml", "an empty file")
    path.write_text("\n")
    fault = only_fault(path)
    assert fault.got == "an empty file"
    assert "[motion.trolley]" in fault.wanted


def test_missing_and_unreadable_files(write, tmp_path):
    path = write(('"crane.toml"', '"carne.toml"'))
    fault = only_fault(path)
    assert (fault.file, fault.key) == (str(path), "crane")
    assert 'did you mean "crane.toml"?' in fault.hint
    assert "a folder" in only_fault(tmp_path).got
    assert "case.toml" in only_fault(tmp_path).hint
    path.write_bytes(b"title = '\xff'")
    assert "UTF-8" in only_fault(path).got
    assert "crane file" in only_fault(tmp_path / "crane.toml").got
    assert only_fault(write(('"crane.toml"', "3"))).key == "crane"
    assert "no such file" in only_fault(write(('"crane.toml"', '"."'))).got
    assert "no such file" in only_fault("a" * 5000).got


def test_a_byte_order_mark_is_harmless(write):
    path = write()
    path.write_text("\ufeff" + path.read_text(), "utf-8")
    assert load_case(path).title == "A case"


# Overrides


def test_overrides(write):
    case = load_case(
        write(),
        [
            "payload.mass = 1200 kg",
            "crane.jib.second_moment_of_area=0.004 m^4",
            "solver.rtol=1e-6",
            "start.state=zero",
            "model.weight_softening=true",
            'modes.trolley_positions=["5 m", 9]',
        ],
    )
    assert case.payload.mass == 1200.0
    assert case.crane.jib.second_moment_of_area == 0.004
    assert case.solver.rtol == 1e-6
    assert case.start.state == "zero"
    assert case.model.weight_softening is True
    assert case.modes.trolley_positions == (5.0, 9.0)
    assert case.as_written["payload"]["mass"] == "1200 kg"
    assert case.as_written["crane"]["jib"]["second_moment_of_area"] == "0.004 m^4"


def test_an_override_can_exchange_the_crane_and_change_it(write, tmp_path):
    path = write()
    (tmp_path / "long.toml").write_text(CRANE.replace('"40 m"', '"60 m"'))
    case = load_case(path, ["crane.tower.height=50 m", "crane=long.toml"])
    assert (case.crane.jib.length, case.crane.tower.height) == (60.0, 50.0)


def test_an_override_reaches_into_a_step(write):
    text = SEQUENCE + 'steps = [{ shape = "trapezoid", end = 50, speed = 1, acceleration = 1 }]'
    path = write(case_text=with_motion(text))
    assert load_case(path, ["motion.trolley.steps.0.end=20"]).trolley_motion().end == pytest.approx(20.0)
    assert "index below 1" in faults_of(path, "motion.trolley.steps.7=3")[0].wanted


@pytest.mark.parametrize(
    ("override", "key", "words"),
    [
        ("payload.mas=3", "payload.mas", ["unknown key", '"mass"']),
        ("crane.jbi.length=3 m", "crane.jbi", ["unknown key", '"jib"']),
        ("crane.jib.length=3 s", "crane.jib.length", ["a length", "a time"]),
        ("paylod.mass=3 kg", "paylod", ['"payload"']),
        ("payload.mass.value=3", "payload.mass", ["a table", '"800 kg"']),
        ("payload.mass", "", ["key=value", '"payload.mass"']),
        ("=3", "", ["key=value"]),
        ("payload..mass=3", "", ["key=value"]),
        ("payload.mass=1\nx=2", "payload.mass", ["a mass"]),
        ("payload.mass=", "payload.mass", ["a mass", '""']),
        ("run=3", "run", ["a table [run] with duration"]),
    ],
)
def test_faults_of_an_override_name_it(write, override, key, words):
    fault = only_fault(write(), override)
    assert fault.file.startswith("--set ")
    assert fault.file.removeprefix("--set ").startswith(override.split("\n")[0])
    assert fault.key == key
    for word in words:
        assert word in str(fault)


# Shipped cases


def test_shipped_cases_load_anywhere(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    cases = list_cases()
    names = [name for name, _ in cases]
    for number in (1, 2, 3, 4):
        assert {f"qtz5613/condition-{number}", f"qtz5613/condition-{number}-paper"} <= set(names)
    assert "qtz5613/condition-4-zero" in names
    assert names == sorted(names)
    assert not any("crane" in name.rpartition("/")[2] for name in names)
    for name, title in cases:
        case = load_case(name)
        assert case.name == name == load_case(f"{name}.toml").name
        assert case.title == title != ""
        assert case.path == case_folder() / f"{name}.toml"


CONDITIONS = {1: (0.4, 400.0, 18.0), 2: (0.8, 400.0, 18.0), 3: (0.8, 800.0, 18.0), 4: (0.8, 800.0, 10.0)}
SHIPPED = [*((n, variant) for n in CONDITIONS for variant in ("", "-paper")), (4, "-zero")]


@pytest.mark.parametrize(("number", "variant"), SHIPPED)
def test_shipped_conditions(number, variant):
    speed, mass, rope = CONDITIONS[number]
    case = load_case(f"qtz5613/condition-{number}{variant}")
    assert case.payload.mass == mass
    assert case.rope_motion().range() == (rope, rope)
    assert case.trolley_motion().range() == pytest.approx((5.0, 41.0))
    cruise = case.trolley_motion()(case.trolley_motion().duration / 2, 1)
    assert float(cruise) == pytest.approx(speed)
    assert float(case.trolley_motion()(0.0, 2)) == pytest.approx(0.1)
    assert (case.run.duration, case.solver.rtol, case.solver.atol) == (120.0, 1e-8, 1e-10)
    assert (case.model.tower_modes, case.model.jib_modes) == (2, 3)
    states = {"": "equilibrium", "-paper": "zero-no-self-weight", "-zero": "zero"}
    assert case.start.state == states[variant]
    assumed = {a.key for a in case.assumed}
    assert ("payload.mass" in assumed) == (number < 3)
    assert {"crane.jib.second_moment_of_area", "crane.tower.lattice.lacing"} <= assumed


def test_shipped_crane_is_the_published_one():
    crane = load_case("qtz5613/condition-3").radial_crane()
    assert crane.tower == Beam(23.8, 350.0, 206e9, 0.014)
    assert crane.jib == Beam(55.6, 123.8, 206e9, 0.0035)
    assert (crane.counter_jib_length, crane.counter_jib_mass_per_length) == (12.3, 159.3)
    assert (crane.counterweight, crane.trolley_mass) == (15130.0, 350.0)
    column = load_case("qtz5613/condition-3").lattice()
    assert 4 * column.leg_area == pytest.approx(198.8e-4)
    assert column.leg_spacing == pytest.approx(1.68)


def test_shipped_crane_file_says_which_values_are_assumed():
    tree = tomllib.loads((case_folder() / "qtz5613" / "crane.toml").read_text("utf-8"))
    _, assumed, faults = split_provenance(tree)
    assert not faults
    assert all(len(a.why) > 10 for a in assumed)


@pytest.mark.parametrize("name", ["qtz5613/conditon-3", "condition-3", "qtz5613/condition-3.tml"])
def test_a_misspelt_case_name_gets_the_closest(name):
    fault = only_fault(name)
    assert fault.got == "no such file"
    assert '"qtz5613/condition-3"' in fault.hint


def test_a_name_like_no_case_lists_them():
    assert "qtz5613/condition-1, " in only_fault("zzzzzz").hint


def test_importing_the_door_loads_neither_units_nor_schema():
    code = "import sys, towercrane.case; print({'pint', 'pydantic', 'numpy'} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"


def test_installed_cases_come_first(tmp_path, monkeypatch):
    package = tmp_path / "towercrane"
    (package / "_cases").mkdir(parents=True)
    monkeypatch.setattr(shipped, "__file__", str(package / "shipped.py"))
    assert case_folder() == package / "_cases"
    (package / "_cases").rmdir()
    assert case_folder() == tmp_path / "cases"


# Small parts


def test_fault_reads_as_a_block():
    fault = Fault("a.toml", "rope.length", "a length", '"3 s"', "seconds?")
    assert str(fault) == 'a.toml: rope.length\n  wanted: a length\n  got:    "3 s"\n  hint:   seconds?'
    assert str(Fault("a.toml", "", "x", "y")) == "a.toml\n  wanted: x\n  got:    y"
    assert str(CaseError([fault])).startswith("1 fault in the input\n\n")


def test_closest_ignores_case_and_gives_up():
    assert closest("HEIGTH", ["height", "length"]) == "height"
    assert closest("zzz", ["height"]) is None
    assert did_you_mean("zzz", ["height"], "no") == "no"


def test_shown_is_one_short_line():
    assert shown("a\nb") == '"a\\nb"'
    assert len(shown("x" * 500)) == 80
    assert (shown({}), shown([])) == ("an empty table", "an empty list")
    assert shown(False) == "false"


def test_leaves_are_dotted():
    assert dict(leaves({"a": {"b": 1, "c": [2, {"d": 3}]}})) == {"a.b": 1, "a.c.0": 2, "a.c.1.d": 3}


VALUES = st.recursive(
    st.one_of(
        st.none().map(lambda _: "nan"),
        st.booleans().map(lambda b: str(b).lower()),
        st.integers().map(str),
        st.floats().map(lambda x: repr(x)),
        st.text(st.characters(codec="utf-8", exclude_categories=("C",)), max_size=8).map(
            lambda s: json.dumps(s, ensure_ascii=False)
        ),
    ),
    lambda inner: st.one_of(
        st.lists(inner, max_size=3).map(lambda v: f"[{', '.join(v)}]"),
        st.dictionaries(st.sampled_from(["value", "assumed", "shape", "start", "x"]), inner, max_size=3).map(
            lambda d: "{ " + ", ".join(f"{k} = {v}" for k, v in d.items()) + " }"
        ),
    ),
    max_leaves=4,
)


@settings(max_examples=200, deadline=None)
@given(
    st.sampled_from(["qtz5613/condition-3", "towers/tapered"]),
    st.sampled_from([*sorted(known_keys()), "x", "crane.x.y", "motion.trolley.start.x"]),
    VALUES,
)
def test_any_value_at_any_key_is_read_or_explained(name, key, value):
    for listed in ("segments", "bodies"):
        key = key.replace(f"tower.{listed}.", f"tower.{listed}.1.")
    try:
        load_case(name, [f"{key}={value}"])
        faults = [Fault("none", "", "none", "none")]
    except CaseError as error:
        faults = error.faults
    assert faults
    assert all(f.file and f.wanted and f.got for f in faults)
