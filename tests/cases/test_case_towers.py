"""The door for general towers: segments, lattices, bodies, foundations, and the messages about them."""

import json
import re
from math import inf
from pathlib import Path

import pytest
from samples.case_files import faults_of
from samples.tower_files import CASE, LACED, MEMBERS, ONE_SEGMENT, SEGMENTS, UNIFORM, write_case

from modal import Beam, Chain, EndBody, Foundation, LacedColumn, Segment
from towercrane.cases.assumptions import rests_on
from towercrane.cases.case import load_case
from towercrane.cranes.tower.file.build import radial_crane
from towercrane.cranes.tower.file.effects import kept_tower
from towercrane.cranes.tower.file.members import beam_choice, lattice_of
from towercrane.cranes.tower.file.requests import map_of
from towercrane.cranes.tower.file.tower_tables import Foundation as FoundationTable
from towercrane.cranes.tower.file.tower_tables import Tower, TowerBody, TowerSegment

E = 210e9
COLUMN = LacedColumn(50e-4, 1.7, 1.4, 8e-4, E, "X", 6e-4)
MAST = Segment(18.0, 350.0, COLUMN.bending_stiffness.value, COLUMN.shear_stiffness.value, 350.0 * 0.85**2)


@pytest.fixture
def write(tmp_path):
    return lambda tower, *changes, case=CASE: write_case(tmp_path, tower, *changes, case=case)


def same(one, other):
    """Chains equal but for the last digits that units cost."""
    numbers = [re.split(r"(-?\d[\d.e+-]*|inf)", repr(chain)) for chain in (one, other)]
    assert numbers[0][::2] == numbers[1][::2]
    assert [float(x) for x in numbers[0][1::2]] == pytest.approx([float(x) for x in numbers[1][1::2]], rel=1e-14)


# What is read


def test_a_segmented_tower_is_the_chain_built_by_hand(write):
    foot = Segment(12.0, 500.0, 206e9 * 0.02, 150e6, 300.0, 0.6, 1.0, 3.0, 1.0)
    cut = MAST.split(8.0)
    bodies = {0: EndBody(100e3), 2: EndBody(2000.0, 3000.0, -0.4), 3: EndBody(5000.0, 0.0, 1.0)}
    ground = Foundation(2e9, 300e6)
    same(kept_tower(load_case(write(SEGMENTS)).checked), Chain((foot, *cut), bodies, ground, shear_theory="engesser"))


def test_every_key_of_the_tables_is_in_the_file_of_these_tests():
    for table in (TowerSegment, TowerBody, FoundationTable):
        assert all(f"{name} =" in SEGMENTS + MEMBERS or f".{name}]" in SEGMENTS for name in table.model_fields)
    elsewhere = {"height", "beam", "published_roots", *TowerSegment.model_fields}
    assert set(Tower.model_fields) - elsewhere == {
        "segments", "bodies", "shear_theory", "torsional_stiffness", "torsional_inertia_per_length",
    }  # fmt: skip


@pytest.mark.parametrize(
    ("key", "chain"),
    [
        ('shear_stiffness = "120 MN"', Chain((Segment(30.0, 300.0, E * 0.01, 120e6),))),
        ('rotary_inertia_per_length = "0.25 t m"', Chain((Segment(30.0, 300.0, E * 0.01, inf, 250.0),))),
        (
            '[[tower.bodies]]\nheight = "30 m"\nmass = "2 t"',
            Chain((Segment(30.0, 300.0, E * 0.01),), {1: EndBody(2e3)}),
        ),
        (
            '[foundation]\nrotation_stiffness = "2 GN m/rad"',
            Chain((Segment(30.0, 300.0, E * 0.01),), foundation=Foundation(2e9)),
        ),
        (
            '[foundation]\ntranslation_stiffness = "2 GN/m"',
            Chain((Segment(30.0, 300.0, E * 0.01),), foundation=Foundation(inf, 2e9)),
        ),
    ],
)
def test_each_effect_of_a_uniform_tower_makes_it_a_chain(write, key, chain):
    case = load_case(write(UNIFORM + key + "\n"))
    same(kept_tower(case.checked), chain)
    assert radial_crane(case.checked).tower == kept_tower(case.checked)


@pytest.mark.parametrize("nothing", ["", "[foundation]\n", "bodies = []\n", "segments = []\n", 'beam = "stated"\n'])
def test_a_plain_tower_is_a_beam(write, nothing):
    case = load_case(write(UNIFORM + nothing))
    assert kept_tower(case.checked) == Beam(30.0, 300.0, 210e9, 0.01)


def test_one_segment_is_a_chain_all_the_same(write):
    same(kept_tower(load_case(write(ONE_SEGMENT)).checked), Chain((Segment(30.0, 300.0, E * 0.01),)))


@pytest.mark.parametrize(("taper", "powers"), [("legs", (0, 2, 0)), ("wedge", (1, 3, 1)), ("cone", (2, 4, 2))])
def test_laws_of_taper(write, taper, powers):
    tower = ONE_SEGMENT + f'top_breadth_ratio = 0.5\ntaper = "{taper}"\n'
    (segment,) = kept_tower(load_case(write(tower)).checked).segments
    assert (segment.mass_power, segment.bending_power, segment.shear_power) == powers
    assert segment.end_ratio == 0.5


def test_bodies_at_one_height_are_one_body(write):
    two = "[[tower.bodies]]\nheight = 30\nmass = 1e3\n[[tower.bodies]]\nheight = 30\nmass = 3e3\noffset = 2\n"
    chain = kept_tower(load_case(write(UNIFORM + two)).checked)
    assert chain.bodies == {1: EndBody(4e3, 1e3 * 1.5**2 + 3e3 * 0.5**2, 1.5)}


# Which beam a lattice gives


def test_a_lattice_alone_is_a_shear_flexible_tower(write):
    stiffness = COLUMN.bending_stiffness.value, COLUMN.shear_stiffness.value, 300.0 * 0.85**2
    same(kept_tower(load_case(write(LACED)).checked), Chain((Segment(30.0, 300.0, *stiffness),)))
    case = load_case(write(LACED), ["crane.tower.beam=shear-flexible"])
    assert kept_tower(case.checked).segments[0].shear_stiffness == pytest.approx(stiffness[1], rel=1e-14)
    assert lattice_of(case.crane).panel_height == 1.4


def test_a_lattice_beside_a_stated_inertia_is_a_check_unless_asked_for(write):
    path = write(UNIFORM + "[tower.lattice]\n" + MEMBERS)
    assert kept_tower(load_case(path).checked) == Beam(30.0, 300.0, 210e9, 0.01)
    assert kept_tower(load_case(path, ["crane.tower.beam=stated"]).checked).second_moment_of_area == 0.01
    euler = kept_tower(load_case(path, ["crane.tower.beam=euler"]).checked)
    assert euler.bending_stiffness == pytest.approx(COLUMN.bending_stiffness.value, rel=1e-14)
    equivalent = kept_tower(load_case(path, ["crane.tower.beam=code-equivalent"]).checked)
    wanted = COLUMN.equivalent_second_moment_of_area(30.0).value
    assert equivalent.second_moment_of_area == pytest.approx(wanted, rel=1e-14)
    flexible = kept_tower(load_case(path, ["crane.tower.beam=shear-flexible"]).checked)
    assert flexible.segments[0].bending_stiffness == pytest.approx(COLUMN.bending_stiffness.value, rel=1e-14)


def test_laced_segments_follow_the_tower_and_stated_ones_do_not(write):
    case = load_case(write(SEGMENTS), ["crane.tower.beam=euler"])
    assert [segment.shear_stiffness for segment in kept_tower(case.checked).segments] == [150e6, inf, inf]
    tower = case.crane.tower
    assert [beam_choice(tower, segment) for segment in tower.segments] == ["stated", "euler"]


def test_what_a_run_rests_on(write):
    lattice = "[tower.lattice]\n" + MEMBERS.replace('"1.4 m"', '{ value = "1.4 m", assumed = "not printed" }')
    tower = UNIFORM.replace('"0.01 m^4"', '{ value = "0.01 m^4", assumed = "a guess" }') + lattice
    path = write(tower, ('counterweight = "10 t"', 'counterweight = "10 t"\n' + FLEXIBLE.replace(
        '"0.002 m^4"', '{ value = "0.002 m^4", assumed = "a guess" }')))  # fmt: skip
    stated, members = "crane.tower.second_moment_of_area", "crane.tower.lattice.panel_height"
    bends = "crane.counter_jib.second_moment_of_area"
    assert {a.key for a in load_case(path).assumed} == {stated, members, bends}
    assert [a.key for a in rests_on(load_case(path))] == [stated]
    assert [a.key for a in rests_on(load_case(path, ["crane.tower.beam=euler"]))] == [members]


FLEXIBLE = 'youngs_modulus = "210 GPa"\nsecond_moment_of_area = "0.002 m^4"\n'


def test_assumed_values_anywhere_in_a_tower_are_listed(write):
    def mark(match):
        return f'{match[1]} = {{ value = {match[2]}, assumed = "a guess" }}\n'

    tower = re.sub(r"(\w+) = (.*)\n", mark, SEGMENTS)
    case = load_case(write(tower))
    same(kept_tower(case.checked), kept_tower(load_case(write(SEGMENTS)).checked))
    keys = {a.key for a in case.assumed}
    assert len(keys) == len(case.assumed) == SEGMENTS.count(" = ")
    assert {
        "crane.tower.segments.1.lattice.lacing", "crane.tower.segments.0.taper", "crane.tower.bodies.1.offset",
        "crane.foundation.rotation_stiffness", "crane.tower.shear_theory",
    } <= keys  # fmt: skip
    assert rests_on(case) == case.assumed


# Accuracy and map


def test_accuracy_and_map_have_defaults(write):
    case = load_case(write(UNIFORM))
    assert case.checked.accuracy.frequency is None
    positions = map_of(case.checked).trolley_positions
    assert (len(positions), positions[0], positions[-1]) == (50, 0.0, 40.0)
    assert positions[7] == pytest.approx(40.0 * 7 / 49)
    assert map_of(case.checked).payload_masses == (400.0, 800.0, 1600.0)


def test_accuracy_and_map_as_written(write):
    tables = '[accuracy]\nfrequency = "0.1 %"\n[map]\nposition_count = 3\npayload_masses = ["0.5 t", 900]\n'
    case = load_case(write(UNIFORM, case=CASE + tables))
    assert case.checked.accuracy.frequency == pytest.approx(1e-3)
    assert map_of(case.checked).trolley_positions == (0.0, 20.0, 40.0)
    assert map_of(case.checked).payload_masses == (500.0, 900.0)
    changed = load_case(case.path, ['map.trolley_positions=["3 m", 40]'])
    assert map_of(changed.checked).trolley_positions == (3.0, 40.0)


@pytest.mark.parametrize("name", ["map", "accuracy"])
def test_slewing_cranes_have_neither(name):
    assert not hasattr(load_case("slewing/basic/example-1").checked, name)


@pytest.mark.parametrize(
    ("override", "key", "words"),
    [
        ("accuracy.frequency=0.9e-9", "accuracy.frequency", ["from 1e-09 to 0.1", "9e-10"]),
        ("accuracy.frequency=0.11", "accuracy.frequency", ["from 1e-09 to 0.1", "0.11"]),
        ("accuracy.frequency=1 Hz", "accuracy.frequency", ["a plain number"]),
        ("accuracy.freqency=1e-3", "accuracy.freqency", ["unknown key", '"frequency"']),
        ("map.position_count=1", "map.position_count", ["from 2 to 1000"]),
        ("map.position_count=1001", "map.position_count", ["from 2 to 1000"]),
        ("map.trolley_positions=[5, 41]", "map.trolley_positions.1", ["40 m", "41", "leaves the jib"]),
        ("map.payload_masses=[0]", "map.payload_masses.0", ["a mass", "above 0"]),
        ("map.payload_masses=[0.8]", "map.payload_masses.0", ["1 to 1e+06 kg", "t meant?"]),
        ("map.payload_masses=800", "map.payload_masses", ["a list"]),
    ],
)
def test_faults_of_accuracy_and_map(write, override, key, words):
    (fault,) = faults_of(write(UNIFORM), override)
    assert fault.key == key
    assert all(word in str(fault) for word in words)


@pytest.mark.parametrize("override", [
    "accuracy.frequency=1e-9", "accuracy.frequency=0.1", "map.position_count=2", "map.position_count=1000",
    "map.trolley_positions=[0, 40]", "map.payload_masses=[1]",
])  # fmt: skip
def test_limits_of_accuracy_and_map_may_be_reached(write, override):
    load_case(write(UNIFORM), [override])


# Faults: (tower, replacement in the crane file, key, words of the message)

SHEAR = ("mass_per_length", 'shear_stiffness = "1 MN"\nmass_per_length')
MEND = [
    (UNIFORM + ONE_SEGMENT, None, "tower.segments", ["not both", "mass_per_length, second_moment_of_area beside 1"]),
    (SEGMENTS, ("[tower]", '[tower]\nshear_stiffness = "1 MN"'), "tower.segments", ["not both", "beside 2 segments"]),
    (SEGMENTS, ("[tower]", "[tower]\npublished_roots = [0.7]"), "tower.segments", ["published_roots beside"]),
    (UNIFORM, ('height = "30 m"', ""), "tower.height", ["a length", "missing"]),
    (UNIFORM, ('youngs_modulus = "210 GPa"', ""), "tower.youngs_modulus", ["a stress or modulus", "missing"]),
    (UNIFORM, ("mass_per_length", "mass_per_lenght"), "tower.mass_per_lenght", ["unknown", '"mass_per_length"']),
    (UNIFORM, ("second_moment", "secnd_moment"), "tower.secnd_moment_of_area", ['"second_moment_of_area"']),
    (UNIFORM, ('second_moment_of_area = "0.01 m^4"', ""), "tower.second_moment_of_area", ["[tower.lattice]"]),
    (UNIFORM, ("height", 'beam = "euler"\nheight'), "tower.beam", ['"stated"', "[tower.lattice]", '"euler"']),
    (UNIFORM, ("height", 'beam = "eular"\nheight'), "tower.beam", ['one of "stated"', 'did you mean "euler"?']),
    (LACED, ("height", 'beam = "stated"\nheight'), "tower.second_moment_of_area", ['"stated" needs it', "missing"]),
    (LACED, SHEAR, "tower.shear_stiffness", ["from the lattice", '"1 MN"', "leave it out"]),
    (LACED, ("[tower.lattice]", "[tower.latice]"), "tower.latice", ["unknown key", '"lattice"']),
    (LACED, ('horizontal_area = "6 cm^2"\n', ""), None, []),
    (LACED.replace('"X"', '"N"'), ('horizontal_area = "6 cm^2"\n', ""), "tower.lattice.horizontal_area", ["needs"]),
    (ONE_SEGMENT, ('youngs_modulus = "210 GPa"', ""), "tower.segments.0.youngs_modulus", ["modulus", "missing"]),
    (ONE_SEGMENT, ('length = "30 m"\n', ""), "tower.segments.0.length", ["a length", "missing"]),
    (ONE_SEGMENT, ("[[tower.segments]]", "[tower.segments]"), "tower.segments", ["[[tower.segments]]", "a table"]),
    (ONE_SEGMENT, ("m^4", "m^3"), "tower.segments.0.second_moment_of_area", ["a second moment of area", "m^3"]),
    (ONE_SEGMENT, ('second_moment_of_area = "0.01 m^4"', ""), "tower.segments.0.second_moment_of_area",
     ["a lattice of the segment", "missing"]),
    (SEGMENTS, ('mass_per_length = "350 kg/m"', 'mass_per_length = 350\nsecond_moment_of_area = "0.01 m^4"'),
     "tower.segments.1.second_moment_of_area", ["one of", "beside a lattice"]),
    (SEGMENTS, ('mass_per_length = "350 kg/m"', 'mass_per_length = 350\nshear_stiffness = "100 MN"'),
     "tower.segments.1.shear_stiffness", ["from the lattice", '"100 MN"']),
    (SEGMENTS, ('mass_per_length = "350 kg/m"', 'mass_per_length = 350\ntaper = "cone"'),
     "tower.segments.1.taper", ['"legs"', '"cone"', "draw together"]),
    (SEGMENTS, ('taper = "wedge"', 'taper = "wege"'), "tower.segments.0.taper", ['did you mean "wedge"?']),
    (SEGMENTS, ('"60 %"', '"0 %"'), "tower.segments.0.top_breadth_ratio", ["above 0"]),
    (SEGMENTS, ("[tower]", '[tower]\nbeam = "code-equivalent"'), "tower.beam", ['"euler" for segments', "column"]),
    (SEGMENTS, ("[tower]", '[tower]\nbeam = "stated"'), "tower.beam", ['"shear-flexible" or "euler"', "a lattice"]),
    (ONE_SEGMENT, ("[[tower.s", '[tower]\nbeam = "euler"\n[[tower.s'), "tower.beam", ['"stated"', "none has"]),
    (SEGMENTS, ("[tower]", '[tower]\nheight = "30.0001 m"'), "tower.height", ["the segments, 30 m", "30.0001"]),
    (SEGMENTS, ("[tower]", '[tower]\nheight = "30.00002 m"'), None, []),
    (SEGMENTS, ('"engesser"', '"euler"'), "tower.shear_theory", ['"haringx"', '"engesser"', '"euler"']),
    (SEGMENTS, ('height = "20 m"', 'height = "31 m"'), "tower.bodies.1.height", ["from 0 to 30 m", "offset"]),
    (SEGMENTS, ('height = "20 m"', 'height = "-1 m"'), "tower.bodies.1.height", ["from 0"]),
    (SEGMENTS, ('height = "20 m"', 'height = "30.00002 m"'), None, []),
    (SEGMENTS, ('mass = "2 t"\n', ""), "tower.bodies.1.mass", ["a mass", "missing"]),
    (SEGMENTS, ('mass = "2 t"', "mass = -2"), "tower.bodies.1.mass", ["from 0", "-2"]),
    (SEGMENTS, ('"3 t m^2"', '"-3 t m^2"'), "tower.bodies.1.rotary_inertia", ["a moment of inertia", "from 0"]),
    (SEGMENTS, ('"2 GN m/rad"', "0"), "foundation.rotation_stiffness", ["a rotary stiffness", "above 0"]),
    (SEGMENTS, ('"2 GN m/rad"', '"2 GN/m"'), "foundation.rotation_stiffness", ["which is a stiffness"]),
    (SEGMENTS, ("[foundation]", "[fundation]"), "fundation", ["unknown key", '"foundation"']),
    (UNIFORM, ("[counter_jib]", '[counter_jib]\nyoungs_modulus = "210 GPa"'), "counter_jib.second_moment_of_area",
     ["that bends", "missing", "rigid"]),
    (UNIFORM, ("[counter_jib]", '[counter_jib]\nsecond_moment_of_area = "1e-3 m^4"'), "counter_jib.youngs_modulus",
     ["that bends", "missing", "rigid"]),
    (UNIFORM, ('mass_per_length = "150 kg/m"', 'mass_per_length = "0 kg/m"\n' + FLEXIBLE),
     "counter_jib.mass_per_length", ["above 0", "bends"]),
    (UNIFORM, ('length = "10 m"', 'length = "0 m"\n' + FLEXIBLE), "counter_jib.length", ["above 0", "bends"]),
    (UNIFORM, ('mass_per_length = "150 kg/m"', 'mass_per_length = "0 kg/m"'), None, []),
]  # fmt: skip


@pytest.mark.parametrize(("tower", "change", "key", "words"), MEND)
def test_one_slip_makes_one_message(write, tower, change, key, words):
    path = write(tower, *([change] if change else []))
    if key is None:
        load_case(path)
        return
    faults = faults_of(path)
    assert [fault.key for fault in faults] == [key], "\n".join(map(str, faults))
    assert Path(faults[0].file).name == "crane.toml"
    assert all(word in str(faults[0]) for word in words), str(faults[0])


def test_the_rope_ends_at_the_foot_of_the_segments(write):
    (fault,) = faults_of(write(SEGMENTS), "rope.length=30.1 m")
    assert (fault.key, "up to 30 m (the height of the tower)" in fault.wanted) == ("rope.length", True)
    assert load_case(write(SEGMENTS), ["rope.length=30 m"]).rope.length == 30.0


IMPLAUSIBLE = [
    ("crane.tower.segments.1.length", 18000, "mm meant?"),
    ("crane.tower.segments.0.mass_per_length", 0.5, "t/m meant?"),
    ("crane.tower.segments.0.youngs_modulus", 206, "GPa meant?"),
    ("crane.tower.segments.0.second_moment_of_area", 2e6, "cm^4 meant?"),
    ("crane.tower.segments.0.shear_stiffness", 150, "MN meant?"),
    ("crane.tower.segments.0.rotary_inertia_per_length", 3e5, "g m meant?"),
    ("crane.tower.segments.0.top_breadth_ratio", 60, "% meant?"),
    ("crane.tower.segments.1.lattice.leg_area", 50, "cm^2 meant?"),
    ("crane.tower.segments.1.lattice.panel_height", 1400, "mm meant?"),
    ("crane.tower.bodies.2.mass", 0.5, "t meant?"),
    ("crane.tower.bodies.2.offset", -400, "mm meant?"),
    ("crane.tower.bodies.1.rotary_inertia", 3e-3, "t m^2 meant?"),
    ("crane.foundation.rotation_stiffness", 2000, "MN m/rad meant?"),
    ("crane.foundation.translation_stiffness", 300, "MN/m meant?"),
]


@pytest.mark.parametrize(("key", "value", "meant"), IMPLAUSIBLE)
def test_implausible_values_name_the_likely_unit_and_can_be_allowed(write, key, value, meant):
    path, override = write(SEGMENTS), f"{key}={json.dumps(value)}"
    fault = faults_of(path, override)[0]
    assert (fault.file, fault.key) == (f"--set {override}", key)
    assert fault.hint.startswith(meant)
    allowed = f'allow_implausible = ["{key}"]'
    assert allowed in fault.hint
    load_case(path, [override, allowed])
