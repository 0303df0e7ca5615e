"""The door for general towers: one slip makes one message, and implausible values name the likely unit."""

import json
from pathlib import Path

import pytest
from samples.case_files import faults_of
from samples.tower_files import FLEXIBLE, LACED, ONE_SEGMENT, SEGMENTS, TIED, UNIFORM

from towercrane.cases.case import load_case

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
    (ONE_SEGMENT, ("[[tower.segments]]", "[[tower.segment]]"), "tower.segment", ["unknown key", '"segments"']),
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
    (TIED, ('"-200 MN"', '"-200 MN/m"'), "foundation.coupling_stiffness", ["a force", "which is a stiffness"]),
    (TIED, ('"-200 MN"', '"-800 MN"'), "foundation.coupling_stiffness", ["less than 7.746e+08 N", "-800 MN"]),
    (TIED, ('translation_stiffness = "300 MN/m"\n', ""), "foundation.coupling_stiffness",
     ["translation_stiffness beside it", "missing"]),
    (TIED, ('"-200 MN"', "0"), None, []),
    (TIED, ('mass = "40 t"\n', ""), "foundation.block.mass", ["a mass", "missing"]),
    (TIED, ('mass = "40 t"', 'mass = "-40 t"'), "foundation.block.mass", ["from 0"]),
    (TIED, ('"300 t m^2"', '"300 t m"'), "foundation.block.rotary_inertia", ["a moment of inertia"]),
    (TIED, ("[foundation.block]", "[foundation.bloc]"), "foundation.bloc", ["unknown key", '"block"']),
    (TIED, ('height = "8 m"', 'height = "31 m"'), "tower.collars.0.height", ["from 0 to 30 m", "holds"]),
    (TIED, ('height = "8 m"', 'height = "0 m"'), "tower.collars.0.height", ["above 0"]),
    (TIED, ('height = "8 m"', 'height = "20 m"'), "tower.collars.1.height", ["that differ", '"20 m" twice']),
    (TIED, ('height = "8 m"\n', ""), "tower.collars.0.height", ["a length", "missing"]),
    (TIED, ('stiffness = "10 MN/m"\n', ""), "tower.collars.0.stiffness", ["a stiffness", "missing"]),
    (TIED, ('"10 MN/m"', '"0 MN/m"'), "tower.collars.0.stiffness", ["above 0"]),
    (TIED, ('"30 MN m/rad"', '"-30 MN m/rad"'), "tower.collars.1.rotation_stiffness", ["from 0"]),
    (TIED, ('"400 MN m/rad"', '"400 MN m^2"'), "tower.collars.1.torsional_stiffness",
     ["a rotary stiffness", "which is"]),
    (TIED, ('stiffness = "10 MN/m"', 'stifness = "10 MN/m"'), "tower.collars.0.stifness",
     ["unknown key", '"stiffness"']),
    (TIED, ('"0 mm"', '"-5 mm"'), "tower.collars.0.gap", ["a length", "from 0"]),
    (TIED, ('"0 mm"', '"5 kN"'), "tower.collars.0.gap", ["a length", "which is a force"]),
    (TIED, ("gap =", "gapp ="), "tower.collars.0.gapp", ["unknown key", '"gap"']),
    (TIED.replace("rotation_stiffness = \"30 MN m/rad\"\n", ""), ('"20 MN/m"', '"20 MN/m"\ngap = "5 mm"'),
     "tower.collars.1.torsional_stiffness", ["nothing for a collar with a gap", '"400 MN m/rad"', "twists freely"]),
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
def test_one_slip_makes_one_message(write_tower, tower, change, key, words):
    path = write_tower(tower, *([change] if change else []))
    if key is None:
        load_case(path)
        return
    faults = faults_of(path)
    assert [fault.key for fault in faults] == [key], "\n".join(map(str, faults))
    assert Path(faults[0].file).name == "crane.toml"
    assert all(word in str(faults[0]) for word in words), str(faults[0])


def test_the_rope_ends_at_the_foot_of_the_segments(write_tower):
    (fault,) = faults_of(write_tower(SEGMENTS), "rope.length=30.1 m")
    assert (fault.key, "up to 30 m (the height of the tower)" in fault.wanted) == ("rope.length", True)
    assert load_case(write_tower(SEGMENTS), ["rope.length=30 m"]).rope.length == 30.0


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
    ("crane.foundation.coupling_stiffness", -200, "MN meant?"),
    ("crane.foundation.block.mass", 40, "t meant?"),
    ("crane.tower.collars.0.stiffness", 10, "MN/m meant?"),
    ("crane.tower.collars.0.gap", 5, "mm meant?"),
    ("crane.tower.collars.1.torsional_stiffness", 400, "kN m/rad meant?"),
    ("crane.tower.collars.1.rotation_stiffness", 30, "kN m/rad meant?"),
]


@pytest.mark.parametrize(("key", "value", "meant"), IMPLAUSIBLE)
def test_implausible_values_name_the_likely_unit_and_can_be_allowed(write_tower, key, value, meant):
    uncoupled = TIED if "coupling" in key else TIED.replace('"-200 MN"', "0")
    path, override = write_tower(uncoupled), f"{key}={json.dumps(value)}"
    fault = faults_of(path, override)[0]
    assert (fault.file, fault.key) == (f"--set {override}", key)
    assert fault.hint.startswith(meant)
    allowed = f'allow_implausible = ["{key}"]'
    assert allowed in fault.hint
    load_case(path, [override, allowed])
