"""Cases that come with the program: found by name anywhere, and the published ones as they were printed."""

import tomllib
from dataclasses import replace

import pytest
from samples.case_files import only_fault

from modal.beams.beam import Beam
from modal.lattices.jib import JibLattice
from modal.structures.chain_modes import chain_modes
from towercrane.cases import shipped
from towercrane.cases.case import case_folder, list_cases, load_case
from towercrane.cases.models import motions_of
from towercrane.cranes.tower.file.build import crane_of
from towercrane.cranes.tower.file.members import lattice_of
from towercrane.schema.provenance import split_provenance


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
    assert motions_of(case)["rope"].range() == (rope, rope)
    assert motions_of(case)["trolley"].range() == pytest.approx((5.0, 41.0))
    cruise = motions_of(case)["trolley"](motions_of(case)["trolley"].duration / 2, 1)
    assert float(cruise) == pytest.approx(speed)
    assert float(motions_of(case)["trolley"](0.0, 2)) == pytest.approx(0.1)
    assert (case.run.duration, case.solver.rtol, case.solver.atol) == (120.0, 1e-8, 1e-10)
    assert (case.checked.model.tower_modes, case.checked.model.jib_vertical_modes) == (2, 3)
    states = {"": "equilibrium", "-paper": "zero-no-self-weight", "-zero": "zero"}
    assert case.start.state == states[variant]
    assumed = {a.key for a in case.assumed}
    assert ("payload.mass" in assumed) == (number < 3)
    assert {"crane.jib.second_moment_of_area", "crane.tower.lattice.lacing"} <= assumed


def test_shipped_crane_is_the_published_one():
    crane = crane_of(load_case("qtz5613/condition-3").checked)
    assert crane.tower == Beam(23.8, 350.0, 206e9, 0.014)
    assert crane.jib == Beam(55.6, 123.8, 206e9, 0.0035)
    assert (crane.counter_jib_length, crane.counter_jib_mass_per_length) == (12.3, 159.3)
    assert (crane.counterweight, crane.trolley_mass) == (15130.0, 350.0)
    column = lattice_of(load_case("qtz5613/condition-3").crane)
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


def test_installed_cases_come_first(tmp_path, monkeypatch):
    package = tmp_path / "towercrane"
    (package / "_cases").mkdir(parents=True)
    monkeypatch.setattr(shipped, "__file__", str(package / "cases" / "shipped.py"))
    assert case_folder() == package / "_cases"
    (package / "_cases").rmdir()
    assert case_folder() == tmp_path / "cases"


def test_the_members_of_the_published_jib_fit_its_beam():
    jib = load_case("qtz5613/condition-3").crane.jib
    lattice = JibLattice(**dict(jib.lattice), youngs_modulus=jib.youngs_modulus)
    (upright,), (sideways,) = (lattice.segments(jib.length, plane, None) for plane in ("vertical", "lateral"))
    assert upright.bending_stiffness == pytest.approx(206e9 * 0.0035, rel=3e-3)
    assert sideways.bending_stiffness == pytest.approx(206e9 * 0.0020, rel=1e-3)
    assert upright.mass_per_length == pytest.approx(123.8, rel=3e-3)


def test_the_flat_top_is_balanced_for_half_its_largest_load():
    crane = crane_of(load_case("flat-top/manoeuvre").checked)
    assert crane.static_moment == pytest.approx(-125e3, rel=0.08)
    assert crane.jib.length == 60.0
    # Member by member the bare jib weighs 10855 kg and swings at 0.7451 Hz up and down, at 0.4340 Hz to its sides.
    # Its top chord ends a metre before the tip, 19 kg that sections have: half a per cent.
    bare = [replace(chain, bodies={}) for chain in (crane.jib, crane.jib_lateral)]
    assert bare[0].mass == pytest.approx(10855.0 + 18.7, abs=2.0)
    frequencies = [float(chain_modes(chain, 1).frequencies_hz[0]) for chain in bare]
    assert frequencies == pytest.approx([0.995 * 0.7451, 0.995 * 0.4340], rel=1e-3)
