"""The door for case files: how it explains what it cannot take."""

import json
from fnmatch import fnmatchcase
from pathlib import Path

import pytest
from samples.case_files import SEQUENCE, faults_of, only_fault, with_motion

from towercrane.cases.case import CaseError, load_case
from towercrane.cases.kinds import EveryKey
from towercrane.cases.models import motions_of
from towercrane.cases.plausibility import RANGES
from towercrane.cranes.tower.file.members import lattice_of
from towercrane.schema.faults import shown
from towercrane.schema.units import to_si

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
    (
        ('"60 s"', '"60 s"\n[model]\njib_vertical_modes = 2.0'),
        None,
        "model.jib_vertical_modes",
        ["whole number", "2.0"],
    ),
    (
        ('"60 s"', '"60 s"\n[model]\njib_vertical_modes = "2"'),
        None,
        "model.jib_vertical_modes",
        ["whole number", '"2"'],
    ),
    (
        ('"60 s"', '"60 s"\n[model]\njib_vertical_modes = true'),
        None,
        "model.jib_vertical_modes",
        ["whole number", "true"],
    ),
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
    ("start.sway_radial", -20, "deg meant?"),
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
    known = EveryKey()
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
    assert motions_of(case)["trolley"].range() == pytest.approx((0.0, 40.0))


def test_lacing_with_horizontals_needs_them(write):
    members = '[tower.lattice]\nleg_area = "50 cm^2"\nleg_spacing = 1.7\npanel_height = 1.4\nlacing = "N"\n'
    members += 'diagonal_area = "8 cm^2"\n'
    path = write(crane=[("[jib]", members + "[jib]")])
    fault = only_fault(path)
    assert (Path(fault.file).name, fault.key) == ("crane.toml", "tower.lattice.horizontal_area")
    column = lattice_of(load_case(path, ["crane.tower.lattice.horizontal_area=8 cm^2"]).crane)
    assert (column.lacing, column.horizontal_area, column.youngs_modulus) == (
        "N",
        pytest.approx(8e-4),
        to_si("210 GPa", "Pa"),
    )
    assert 'did you mean "zigzag"?' in only_fault(path, "crane.tower.lattice.lacing=zigzig").hint
