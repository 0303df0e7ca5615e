"""The door for jibs and counter-jibs of segments: one slip makes one message, and odd values name the likely unit."""

import json
from pathlib import Path

import pytest
from samples.case_files import faults_of
from samples.jib_files import JIB_LATTICE, SEGMENTS, UNIFORM

from towercrane.cases.assumptions import idle_in_file
from towercrane.cases.case import load_case

SECTION = 'second_moment_of_area = "0.015 m^4"\n'
IN_SPACE = 'motion.slewing={shape="trapezoid", end="90 deg", speed="2 deg/s", acceleration="0.5 deg/s^2"}'
SIDEWAYS = "lateral_second_moment_of_area"
FIRST, LACED, COUNTER = "jib.segments.0", "jib.segments.1", "counter_jib.segments.0"

MEND = [
    # which keys belong together
    (SEGMENTS, ("[jib]", '[jib]\nmass_per_length = "150 kg/m"'), "jib.segments", ["not both", "beside 2 segments"]),
    (SEGMENTS, ("[jib]", '[jib]\nlength = "41 m"'), "jib.length", ["sum of the segments, 40 m", "41 m"]),
    (SEGMENTS, ("[jib]", '[jib]\nlength = "40.00002 m"'), None, []),
    (SEGMENTS, ("[counter_jib]", '[counter_jib]\nshear_stiffness = "100 MN"'), "counter_jib.segments", ["not both"]),
    (SEGMENTS, ("[counter_jib]", '[counter_jib]\nlength = "12 m"'), "counter_jib.length", ["12.5 m", "12 m"]),
    (SEGMENTS, ('length = "25 m"\n', ""), f"{FIRST}.length", ["a length", "missing"]),
    (SEGMENTS, ('mass_per_length = "200 kg/m"\n', ""), f"{FIRST}.mass_per_length", ["missing"]),
    (SEGMENTS, ("[[jib.segments]]", '[[jib.segments]]\nmass = "5 t"'), f"{FIRST}.mass", ["one of", "beside"]),
    (SEGMENTS, ("[jib.segments.lattice]", 'mass = "1.5 t"\nmass_per_length = "100 kg/m"\n[jib.segments.lattice]'),
     f"{LACED}.mass", ["one of", "beside"]),
    (SEGMENTS, (SECTION, ""), f"{FIRST}.second_moment_of_area", ["or a lattice", "missing"]),
    (SEGMENTS, ("[jib.segments.lattice]", SECTION + "[jib.segments.lattice]"), f"{LACED}.second_moment_of_area",
     ["beside a lattice", "leave it out"]),
    (SEGMENTS, ("[jib.segments.lattice]", 'shear_stiffness = "60 MN"\n[jib.segments.lattice]'),
     f"{LACED}.shear_stiffness", ["beside a lattice", '"60 MN"']),
    (SEGMENTS, ('[counter_jib]\nyoungs_modulus = "206 GPa"', "[counter_jib]"), f"{COUNTER}.youngs_modulus",
     ["a stress or modulus", "missing"]),
    (UNIFORM, ('length = "40 m"\n', ""), "jib.length", ["a length", "missing"]),
    (UNIFORM, ("second_moment_of_area", SIDEWAYS), "jib.second_moment_of_area", ["or a lattice", "missing"]),
    # a lattice beside a stated beam is a check alone
    (UNIFORM + JIB_LATTICE, None, None, []),
    (UNIFORM + JIB_LATTICE, ('second_moment_of_area = "0.003 m^4"', 'shear_stiffness = "60 MN"'),
     "jib.shear_stiffness", ["beside a lattice", "state second_moment_of_area with it"]),
    (UNIFORM + JIB_LATTICE, ('second_moment_of_area = "0.003 m^4"\n', ""), None, []),
    (UNIFORM + JIB_LATTICE, ('mass_per_length = "100 kg/m"\n', ""), "jib.mass_per_length", ["missing"]),
    # bodies
    (SEGMENTS, ('position = "40 m"', 'position = "41 m"'), "jib.bodies.1.position", ["from 0 to 40 m", "outward"]),
    (SEGMENTS, ('position = "40 m"', 'position = "40.00002 m"'), None, []),
    (SEGMENTS, ('position = "40 m"', 'position = "-4 m"'), "jib.bodies.1.position", ["from 0"]),
    (SEGMENTS, ('position = "12 m"', 'position = "13 m"'), "counter_jib.bodies.0.position",
     ["from 0 to 12.5 m (the length of the counter-jib)"]),
    (SEGMENTS, ('position = "12 m"\n', ""), "counter_jib.bodies.0.position", ["missing"]),
    (SEGMENTS, ('mass = "20 t"\n', ""), "counter_jib.bodies.0.mass", ["a mass", "missing"]),
    (SEGMENTS, ('mass = "20 t"', 'mass = "-20 t"'), "counter_jib.bodies.0.mass", ["from 0"]),
    (SEGMENTS, ('mass = "20 t"', 'mass = "20 t/m"'), "counter_jib.bodies.0.mass", ["a mass", "mass per length"]),
    (SEGMENTS, ('"15 t m^2"', '"15 t m"'), "counter_jib.bodies.0.rotary_inertia", ["a moment of inertia"]),
    (SEGMENTS, ('"15 t m^2"', '"-15 t m^2"'), "counter_jib.bodies.0.rotary_inertia", ["from 0"]),
    (SEGMENTS, ("[[counter_jib.bodies]]", "[counter_jib.bodies]"), "counter_jib.bodies", ["[[counter_jib.bodies]]"]),
    (SEGMENTS, ("[[counter_jib.bodies]]", "[[counter_jib.body]]"), "counter_jib.body", ["unknown", '"bodies"']),
    # units, signs and spelling
    (SEGMENTS, ('shear_stiffness = "150 MN"', 'shear_stiffness = "150 MPa"'), f"{FIRST}.shear_stiffness",
     ["a force", "which is"]),
    (SEGMENTS, ('shear_stiffness = "150 MN"', "shear_stiffness = 0"), f"{FIRST}.shear_stiffness", ["above 0"]),
    (SEGMENTS, ('"130 kg m"', '"-130 kg m"'), f"{FIRST}.rotary_inertia_per_length", ["from 0"]),
    (SEGMENTS, ("rotary_inertia_per", "rotary_inertia_pr"), f"{FIRST}.rotary_inertia_pr_length", ["unknown key"]),
    (SEGMENTS, ('length = "25 m"', 'length = "-25 m"'), f"{FIRST}.length", ["above 0"]),
    (SEGMENTS, ("m^4", "m^3"), f"{FIRST}.second_moment_of_area", ["a second moment of area", "m^3"]),
    (SEGMENTS, (SIDEWAYS, "laterl_second_moment_of_area"), f"{FIRST}.laterl_second_moment_of_area",
     ["unknown key", f'"{SIDEWAYS}"']),
    (SEGMENTS.replace("[jib.segments", "[jib.segment"), None, "jib.segment", ["unknown", '"segments"']),
    (SEGMENTS.replace("[counter_jib.segments", "[counter_jib.segment"), None, "counter_jib.segment",
     ["unknown", '"segments"']),
    (SEGMENTS, ("[jib.segments.lattice]", "[jib.segments.latice]"), f"{LACED}.latice", ["unknown", '"lattice"']),
    # members
    (SEGMENTS, ('height = "1.2 m"', 'height = "0 m"'), f"{LACED}.lattice.height", ["above 0"]),
    (SEGMENTS, ('height = "1.2 m"\n', ""), f"{LACED}.lattice.height", ["a length", "missing"]),
    (SEGMENTS, ('height = "1.2 m"', 'end_height = "-1 m"\nheight = "1.2 m"'), f"{LACED}.lattice.end_height",
     ["above 0"]),
    (SEGMENTS, ('"60 cm^2"', '"60 cm"'), f"{LACED}.lattice.opposite_chord_area", ["an area", "a length"]),
    (SEGMENTS, ('base_lacing = "X"', 'base_lacing = "N"'), f"{LACED}.lattice.base_post_area",
     ["needs posts", "the key is missing"]),
    (SEGMENTS, ('base_lacing = "X"', 'base_lacing = "Y"'), f"{LACED}.lattice.base_lacing", ["one of", '"Y"']),
    (SEGMENTS, ('base_lacing = "X"', 'side_lacing = "N"'), f"{LACED}.lattice.side_post_area", ["needs posts"]),
    (SEGMENTS, ('base_lacing = "X"', 'shape = "rectangle"\nopposite_lacing = "N"'),
     f"{LACED}.lattice.opposite_post_area", ["needs posts"]),
    (SEGMENTS, ('base_lacing = "X"', 'shape = "rectangle"\nbase_lacing = "N"\nbase_post_area = "4 cm^2"'), None, []),
    (SEGMENTS, ('base_lacing = "X"', 'side_post_area = "4 cm^2"'), f"{LACED}.lattice.side_post_area",
     ["no posts", "zigzag"]),
    (SEGMENTS, ('base_lacing = "X"', 'opposite_lacing = "X"'), f"{LACED}.lattice.opposite_lacing",
     ["rectangle", '"X"']),
    (SEGMENTS, ('base_lacing = "X"', 'shape = "triangel"'), f"{LACED}.lattice.shape", ['"triangle"']),
    (SEGMENTS, ('base_lacing = "X"', 'side = "left"'), f"{LACED}.lattice.side", ['"up"', '"down"']),
    (UNIFORM + JIB_LATTICE.replace("jib.", "counter_jib."), None, "counter_jib.youngs_modulus", ["missing"]),
    (UNIFORM + JIB_LATTICE.replace('"zigzag"', '"N"'), None, "jib.lattice.side_post_area", ["needs posts"]),
]  # fmt: skip


@pytest.mark.parametrize(("jib", "change", "key", "words"), MEND)
def test_one_slip_makes_one_message(write_jib, jib, change, key, words):
    if change is not None:
        assert change[0] in jib
        jib = jib.replace(*change, 1)
    path = write_jib(jib)
    if key is None:
        load_case(path)
        return
    faults = faults_of(path)
    assert [fault.key for fault in faults] == [key], "\n".join(map(str, faults))
    assert Path(faults[0].file).name == "crane.toml"
    assert all(word in str(faults[0]) for word in words), str(faults[0])


SCENES = [
    (["motion.trolley.end=41 m"], ["motion.trolley.end"], "from 0 to 40 m"),
    (["modes.trolley_positions=[10, 41]"], ["modes.trolley_positions.1"], "40 m"),
    (["model.counter_jib_vertical_modes=-1"], ["model.counter_jib_vertical_modes"], "0"),
    (["model.counter_jib_lateral_modes=1.5"], ["model.counter_jib_lateral_modes"], "whole number"),
    (["model.counter_jib_vertical_damping_ratio=1.5"], ["model.counter_jib_vertical_damping_ratio"], "0.3"),
    (["model.counter_jib_modes=1"], ["model.counter_jib_modes"], "counter_jib_"),
]


@pytest.mark.parametrize(("changes", "keys", "word"), SCENES)
def test_a_scene_that_does_not_fit_its_jibs_is_one_message(write_jib, changes, keys, word):
    faults = faults_of(write_jib(SEGMENTS), *changes)
    assert [fault.key for fault in faults] == keys, "\n".join(map(str, faults))
    assert word in str(faults[0]), str(faults[0])


@pytest.mark.parametrize(("member", "key"), [("jib", FIRST), ("counter_jib", COUNTER)], ids=["jib", "counter-jib"])
def test_modes_to_the_sides_need_a_stiffness_to_the_sides(write_jib, member, key):
    text = SEGMENTS
    for stated in ("0.005", "0.004"):
        text = text.replace(f'{SIDEWAYS} = "{stated} m^4"\n', "")
    path, count = write_jib(text), f"model.{member}_lateral_modes"
    other = {"jib": "model.counter_jib_lateral_modes=0", "counter_jib": "model.jib_lateral_modes=0"}[member]
    space = [IN_SPACE, other, "model.torsion_modes=0"]
    (fault,) = faults_of(path, *space, f"{count}=1")
    assert (fault.key, f"{count} = 0 leaves it rigid" in fault.hint) == (f"{key}.{SIDEWAYS}", True)
    load_case(path, [*space, f"{count}=0"])
    load_case(path)


def test_a_rigid_counter_jib_has_no_modes(write_jib):
    (fault,) = faults_of(write_jib(UNIFORM), "model.counter_jib_vertical_modes=1")
    assert fault.key == "counter_jib.second_moment_of_area"
    assert "leaves it rigid" in fault.hint


SIDES = ("second_moment_of_area", "shear_stiffness", "rotary_inertia_per_length")
UP = ("second_moment_of_area", "shear_stiffness", "youngs_modulus")


@pytest.mark.parametrize(
    ("changes", "idle"),
    [
        ([], {f"crane.{key}.lateral_{name}" for key in (FIRST, COUNTER) for name in SIDES}),
        (["model.counter_jib_vertical_modes=0"],
         {f"crane.{key}.lateral_{name}" for key in (FIRST, COUNTER) for name in SIDES}
         | {f"crane.{COUNTER}.{name}" for name in UP} | {"crane.counter_jib.youngs_modulus"}),
        ([IN_SPACE, "model.torsion_modes=0"], set()),
        ([IN_SPACE, "model.torsion_modes=0", "model.jib_lateral_modes=0", "model.counter_jib_lateral_modes=0"],
         {f"crane.{key}.lateral_{name}" for key in (FIRST, COUNTER) for name in SIDES[:2]}),
        ([IN_SPACE, "model.torsion_modes=0", "model.counter_jib_vertical_modes=0"],
         {f"crane.{COUNTER}.{name}" for name in UP[:2]}),
    ],
)  # fmt: skip
def test_a_run_says_which_keys_of_jibs_it_has_no_use_for(write_jib, changes, idle):
    case = load_case(write_jib(SEGMENTS), changes)
    written = {key for key in idle if not _missing(case, key)}
    assert set(idle_in_file(case)) == written


def _missing(case, key):
    tree = case.as_written
    for name in key.split("."):
        tree = tree[int(name)] if isinstance(tree, list) else tree.get(name)
        if tree is None:
            return True
    return False


IMPLAUSIBLE = [
    ("crane.jib.segments.0.length", 25000, "mm meant?"),
    ("crane.jib.segments.0.mass_per_length", 0.2, "t/m meant?"),
    ("crane.counter_jib.segments.0.mass", 2.3, "t meant?"),
    ("crane.jib.segments.0.youngs_modulus", 206, "GPa meant?"),
    ("crane.jib.segments.0.second_moment_of_area", 1.5e6, "cm^4 meant?"),
    (f"crane.jib.segments.0.{SIDEWAYS}", 1.5e6, "cm^4 meant?"),
    ("crane.jib.segments.0.shear_stiffness", 150, "MN meant?"),
    ("crane.counter_jib.segments.0.lateral_shear_stiffness", 150, "MN meant?"),
    ("crane.jib.segments.0.rotary_inertia_per_length", 3e5, "g m meant?"),
    ("crane.jib.segments.0.lateral_rotary_inertia_per_length", 3e5, "g m meant?"),
    ("crane.jib.segments.1.lattice.height", 1200, "mm meant?"),
    ("crane.jib.segments.1.lattice.end_height", 1200, "mm meant?"),
    ("crane.jib.segments.1.lattice.breadth", 1400, "mm meant?"),
    ("crane.jib.segments.1.lattice.panel_length", 2000, "mm meant?"),
    ("crane.jib.segments.1.lattice.base_chord_area", 27.8, "cm^2 meant?"),
    ("crane.jib.segments.1.lattice.base_post_area", 4, "cm^2 meant?"),
    ("crane.jib.segments.1.lattice.density", 7.85, "t/m^3 meant?"),
    ("crane.jib.segments.1.lattice.further_mass_per_length", 0.03, "t/m meant?"),
    ("crane.counter_jib.bodies.0.position", 1e-4, "km meant?"),
    ("crane.counter_jib.bodies.0.mass", 0.5, "t meant?"),
    ("crane.counter_jib.bodies.0.rotary_inertia", 1e-3, "t m^2 meant?"),
    ("model.counter_jib_vertical_damping_ratio", 0.9, "% meant?"),
]


@pytest.mark.parametrize(("key", "value", "meant"), IMPLAUSIBLE)
def test_implausible_values_name_the_likely_unit_and_can_be_allowed(write_jib, key, value, meant):
    path, override = write_jib(SEGMENTS), f"{key}={json.dumps(value)}"
    fault = faults_of(path, override)[0]
    assert (fault.file, fault.key) == (f"--set {override}", key)
    assert fault.hint.startswith(meant), str(fault)
    assert f'allow_implausible = ["{key}"]' in fault.hint
