"""Case files of cranes whose jib pivots: what they may say, what is refused, and how their runs end."""

import tomllib

import numpy as np
import pytest
from samples.program import towercrane

from towercrane.cases.case import CaseError, case_folder, load_case
from towercrane.cases.models import model_of
from towercrane.cranes.tower.file.case_tables import TowerCase
from towercrane.cranes.tower.file.members import luffing_of
from towercrane.cranes.tower.luffing_model import LuffingModel
from towercrane.runs.run import run_case
from towercrane.studies.lattice import lattice_report
from towercrane.studies.space_modes import space_frequencies

SHIPPED = case_folder() / "luffing"

REST = """
title = "Jib at rest"
crane = "crane.toml"
[payload]
mass = "5 t"
[rope]
length = "20 m"
[motion.luffing]
shape = "rest"
start = "45 deg"
[run]
duration = "2 s"
"""
REST_AT_45 = 'shape = "rest"\nstart = "45 deg"'
TRAPEZOID = (
    'shape = "trapezoid"\nstart = "45 deg"\nend = "{end} deg"\nspeed = "{speed} deg/s"\nacceleration = "15 deg/s^2"'
)


@pytest.fixture
def written(tmp_path):
    """Write the crane and a case at rest, with replacements, and give the case's path."""

    def write(*crane, case=()):
        text = (SHIPPED / "crane.toml").read_text("utf-8")
        body = REST
        for old, new in crane:
            assert old in text, old
            text = text.replace(old, new, 1)
        for old, new in case:
            assert old in body, old
            body = body.replace(old, new, 1)
        (tmp_path / "crane.toml").write_text(text, "utf-8")
        (tmp_path / "case.toml").write_text(body, "utf-8")
        return tmp_path / "case.toml"

    return write


def faults(path):
    with pytest.raises(CaseError) as refused:
        load_case(path)
    return [(f.key, f.wanted, f.got, f.hint) for f in refused.value.faults]


def test_the_shipped_manoeuvre_says_that_all_its_values_are_assumed():
    case = load_case("luffing/manoeuvre")
    assert isinstance(model_of(case), LuffingModel)
    # Quantities of the files, titles, shapes and counts apart.
    assert len(case.assumed) == 44
    crane = tomllib.loads((SHIPPED / "crane.toml").read_text("utf-8"))
    assert crane["jib"]["luffing"]["falls"] == 2


def test_a_jib_stands_where_its_rope_stretches_to(written):
    case = load_case(written())
    run = run_case(case)
    assert run.attrs["outcome"] == "finished"
    angle, command = (run[name].values for name in ("luffing_angle", "luffing_command"))
    assert np.ptp(angle) < 1e-9
    assert np.all(command == np.radians(45.0))
    assert 0.2 < np.degrees(command[0] - angle[0]) < 0.6
    # Moments about the foot of a straight jib: weights of jib, sheaves and load, and the hoist rope to its winch.
    chord, load = float(angle[0]), 5000.0 * 9.81
    jib = luffing_of(case.tables(TowerCase))
    weights = (150.0 * 50.0**2 / 2 + 700.0 * 50.0) * 9.81 + load * 50.0
    head, winch = np.subtract(jib.head(50.0, chord), jib.foot), np.subtract(jib.winch, jib.foot)
    led = abs(winch[0] * head[1] - winch[1] * head[0]) / np.linalg.norm(head - winch) * load / 2.0
    # The tower leans towards the load.
    held = (weights * np.cos(chord - run["tower_tip_tilt"].values) - led) / jib.lever(50.0, chord)
    # Its bow takes a few tenths of a per cent off.
    assert run["luffing_rope_force"].values == pytest.approx(held, rel=5e-3)
    assert run["hoist_rope_force"].values == pytest.approx(load, rel=1e-9)


@pytest.mark.parametrize(
    ("crane", "case", "key", "said"),
    [
        ([('value = "240 MN"', 'value = "240 kg"')], (), "jib.luffing.rope_stiffness", "which is a mass"),
        ([('value = "240 MN"', "value = 240.0")], (), "jib.luffing.rope_stiffness", "MN meant?"),
        ([("\nrope_attachment", "\nrope_attachement")], (), "jib.luffing.rope_attachement", "closest known key"),
        ([('{ value = "11 m"', '{ value = "-11 m"')], (), "jib.luffing.frame_head", "sign?"),
        ([('"15 deg"', '"86 deg"')], (), "jib.luffing.highest_angle", "mixed up?"),
        ([("falls = 2", "falls = 0")], (), "jib.luffing.falls", "from 1 to 16"),
        ([("[jib.luffing]", '[trolley]\nmass = "300 kg"\n[jib.luffing]')], (), "trolley", "tip_mass"),
        ([("[jib.luffing]", '[[jib.bodies]]\nposition = 3\nmass = 30\n[jib.luffing]')], (), "jib.bodies", "uniform"),
        ((), [('"45 deg"', '"10 deg"')], "motion.luffing", "from 15 to 85 deg"),
        ((), [('"45 deg"', '"45 m"')], "motion.luffing.start", "which is a length"),
        ((), [('start = "45 deg"', "")], "motion.luffing.start", "from 15 to 85 deg"),
        ((), [(f"[motion.luffing]\n{REST_AT_45}", "")], "motion.luffing", "a table"),
        ((), [(REST_AT_45, TRAPEZOID.format(end=95, speed=1))], "motion.luffing", "from 15 to 85 deg"),
        ((), [("[run]", '[motion.trolley]\nshape = "rest"\nstart = 3\n[run]')], "motion.trolley", "[motion.luffing]"),
        ((), [("[run]", "[model]\ncounter_jib_lateral_modes = 1\n[run]")], "model.counter_jib_lateral_modes", ""),
        ((), [("[run]", "[modes]\nluffing_angles = [0.7, 1.5]\n[run]")], "modes.luffing_angles.1", "15 to 85"),
        ((), [('"20 m"', '"90 m"')], "rope.length", "jib's head"),
    ],
)  # fmt: skip
def test_each_slip_has_one_message(written, crane, case, key, said):
    found = faults(written(*crane, case=case))
    assert [own[0] for own in found] == [key]
    assert said in " ".join(found[0])


def test_a_jib_that_does_not_pivot_has_no_luffing_motion(tmp_path):
    path = case_folder() / "qtz5613" / "condition-3.toml"
    with pytest.raises(CaseError) as refused:
        load_case(path, ["motion.luffing.shape=rest", "motion.luffing.start=0.5"])
    assert [f.key for f in refused.value.faults] == ["motion.luffing"]


def test_a_rope_that_would_push_ends_the_run(written):
    """At one fall the hoist rope pulls a steep jib back harder than load and weight pull it forward."""
    path = written(("falls = 2", "falls = 1"), ('"85 deg"', '"89 deg"'), case=[('"45 deg"', '"87 deg"')])
    run = run_case(load_case(path))
    assert run.attrs["outcome"] == "jib over backwards"
    assert float(run.attrs["end_time"]) == 0.0
    assert "would push by" in run.attrs["message"]
    report = space_frequencies(load_case(path))
    assert report["outcome"] == "jib over backwards"
    assert report["modes"] == []


def test_a_jib_that_swings_beyond_its_stop_ends_the_run(written):
    path = written(
        ('"85 deg"', '"59.9 deg"'),
        case=[(REST_AT_45, TRAPEZOID.format(end=59.9, speed=2.5)), ('"2 s"', '"10 s"'), ('"5 t"', '"500 kg"')],
    )
    run = run_case(load_case(path))
    assert run.attrs["outcome"] == "jib at its stop"
    assert np.degrees(run["luffing_angle"].values[-1]) == pytest.approx(59.9, abs=1e-6)


def test_a_jib_that_its_load_buckles_has_no_equilibrium(written):
    run = run_case(load_case(written(case=[('"5 t"', '"90 t"')])))
    assert run.attrs["outcome"] == "no stable equilibrium"
    assert "buckles" in run.attrs["message"]


def test_modes_go_over_the_luffing_angle(written):
    path = written(case=[("[run]", '[modes]\nluffing_angles = ["30 deg", "60 deg"]\n[run]')])
    report = space_frequencies(load_case(path))
    assert report["at"]["luffing_angle_rad"] == np.radians(45.0)
    assert [row["value"] for row in report["sweeps"]["luffing_angle"]] == pytest.approx(np.radians([30.0, 60.0]))
    assert len(report["modes"]) == 8
    assert all(abs(mode["relative_difference"]) < 2e-3 for mode in report["modes"])


def test_a_laced_tower_under_a_jib_that_pivots_is_checked_as_a_truss(tmp_path):
    """The slewing part with its centre of mass above the tower's top is on the truss and on the beam."""
    laced = (
        'crane.tower={height=40, mass_per_length=600, youngs_modulus="206 GPa", torsional_inertia_per_length=700, '
        'lattice={leg_area="90 cm^2", leg_spacing=2, panel_height=1.6, lacing="zigzag", diagonal_area="12 cm^2", '
        'horizontal_area="12 cm^2"}}'
    )
    report = lattice_report(load_case("luffing/manoeuvre", [laced]))
    truss, beam, *_ = report["models"]
    assert [truss["name"], beam["name"]] == ["truss", "shear-flexible"]
    bodies = (model["answers"]["body_frequencies_hz"][:2] for model in (truss, beam))
    assert np.allclose(*bodies, rtol=5e-4)
    done = towercrane("lattice", "luffing/manoeuvre", cwd=tmp_path)
    assert (done.returncode, "wanted all members of the tower" in done.stderr) == (2, True)
