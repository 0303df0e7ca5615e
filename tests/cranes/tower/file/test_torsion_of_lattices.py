"""Torsion of a tower whose file gives no torsional stiffness but its members."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples.tower_files import MEMBERS, write_case

from modal import LacedColumn, Shaft, torsion_modes
from modal.lattices.column_section import column_section
from towercrane.cases.assumptions import rests_on
from towercrane.cases.case import load_case
from towercrane.cases.result_case import case_of
from towercrane.cranes.tower.file.build import crane_of

COLUMN = LacedColumn(50e-4, 1.7, 1.4, 8e-4, 210e9, "X", 6e-4)
LACED = f"""[tower]
height = "30 m"
mass_per_length = "300 kg/m"
youngs_modulus = "210 GPa"
[tower.lattice]
{MEMBERS}
"""
PIECES = f"""[tower]
youngs_modulus = "210 GPa"
[[tower.segments]]
length = "12 m"
mass_per_length = "500 kg/m"
top_breadth_ratio = "50 %"
[tower.segments.lattice]
{MEMBERS.replace("1.7 m", "3.4 m")}
[[tower.segments]]
length = "18 m"
mass_per_length = "300 kg/m"
[tower.segments.lattice]
{MEMBERS}
"""
KEYS = "crane.tower.torsional_inertia_per_length", "crane.tower.torsional_stiffness"
TURNING = """title = "A tower that twists"
crane = "crane.toml"
[payload]
mass = "1 t"
[rope]
length = "10 m"
[motion.trolley]
shape = "rest"
start = "20 m"
[motion.slewing]
shape = "trapezoid"
start = "0 deg"
end = "30 deg"
speed = "3 deg/s"
acceleration = "1 deg/s^2"
[model]
jib_lateral_modes = 0
[run]
duration = "20 s"
"""


@pytest.fixture
def turning(tmp_path):
    return lambda tower, *changes: load_case(write_case(tmp_path, tower, *changes, case=TURNING))


def named(case):
    return {a.key: str(a.value) for a in rests_on(case) if a.key in KEYS}


def test_a_uniform_lattice_twists_as_its_section_does_and_says_so(turning):
    case = turning(LACED)
    section = column_section(COLUMN)
    inertia = 300.0 * section.rotary_inertias[2] / section.mass_per_length
    shaft = crane_of(case.checked).shaft
    assert_allclose(
        [shaft.length, shaft.inertia_per_length, shaft.torsional_stiffness],
        [30.0, inertia, section.torsional_stiffness],
        rtol=1e-12,
    )
    assert shaft.steps == ()
    assert named(case) == {
        KEYS[0]: f"{inertia:.4g} kg m",
        KEYS[1]: f"{section.torsional_stiffness / 1e6:.4g} MN m^2",
    }
    assert all("computed from the tower's lattice" in a.why for a in rests_on(case) if a.key in KEYS)


def test_pieces_and_tapers_twist_piece_by_piece(turning):
    case = turning(PIECES)
    shaft = crane_of(case.checked).shaft
    assert isinstance(shaft, Shaft)
    wide, narrow = (column_section(COLUMN, breadth).torsional_stiffness for breadth in (3.4, 1.7))
    stiffnesses = shaft.pieces[1]
    assert stiffnesses[0] == pytest.approx(wide, rel=0.06)
    assert stiffnesses[-1] == pytest.approx(narrow, rel=1e-12)
    assert (np.diff(stiffnesses[:-1]) < 0.0).all()
    # Finer parts of the taper change nothing that counts.
    breadths = 3.4 - 1.7 * (np.arange(200) + 0.5) / 200.0
    exact = np.mean([1.0 / column_section(COLUMN, breadth).torsional_stiffness for breadth in breadths])
    twisted = 1.0 / stiffnesses[:-1] @ np.diff(shaft.nodes)[:-1] / 12.0
    assert twisted == pytest.approx(exact, rel=2e-4)
    assert named(case)[KEYS[1]] == f"{stiffnesses[0] / 1e6:.4g} to {narrow / 1e6:.4g} MN m^2"
    assert (torsion_modes(shaft, 2, 1e6).angular_frequencies > 0.0).all()


def test_what_is_stated_holds(turning):
    case = turning(LACED, ('height = "30 m"', 'height = "30 m"\ntorsional_stiffness = "170 MN m^2"'))
    assert crane_of(case.checked).shaft.torsional_stiffness == 170e6
    assert set(named(case)) == {KEYS[0]}


def test_a_scene_in_the_plane_and_one_without_such_modes_name_nothing(turning, tmp_path):
    assert not named(load_case(write_case(tmp_path, LACED)))
    path = write_case(tmp_path, LACED, case=TURNING)
    assert not named(load_case(path, ["model.torsion_modes=0"]))


def test_members_that_give_torsion_are_named_even_where_bending_is_stated(turning):
    stated = ('height = "30 m"', 'height = "30 m"\nsecond_moment_of_area = "0.01 m^4"')
    assumed = ('leg_area = "50 cm^2"', 'leg_area = { value = "50 cm^2", assumed = "test" }')
    keys = {a.key for a in rests_on(turning(LACED, stated, assumed))}
    assert "crane.tower.lattice.leg_area" in keys
    torsion = ("[tower]", '[tower]\ntorsional_stiffness = "170 MN m^2"\ntorsional_inertia_per_length = "400 kg m"')
    keys = {a.key for a in rests_on(turning(LACED, stated, assumed, torsion))}
    assert "crane.tower.lattice.leg_area" not in keys


def test_a_run_twists_and_its_result_names_what_it_rests_on(turning):
    from towercrane.runs.run import run_case

    result = run_case(turning(LACED))
    assert np.abs(result["tower_tip_twist"]).max() > 1e-4
    assert all(key in result.attrs["assumed"] for key in KEYS)
    assert set(KEYS) <= {a.key for a in case_of(result).assumed}
