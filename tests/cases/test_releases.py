"""The door for loads that let go, and what a run of one tells."""

import json
from functools import partial

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples.case_files import MULTI, copy_case, faults_of, only_fault

from towercrane.cases.case import load_case
from towercrane.cranes.registry import KINDS
from towercrane.report.plots.runs.panels import BASE, over_times
from towercrane.runs.run import record_case
from towercrane.runs.summary import summarise

CASE = "qtz5613/release"


@pytest.fixture
def written(tmp_path):
    """The shipped case with another table of what lets go."""

    def write(table: str, *changes: tuple[str, str]):
        path = copy_case(tmp_path, CASE, *changes)
        head, _, tail = path.read_text("utf-8").partition("[release]")
        path.write_text(f"{head}[release]\n{table}\n\n[run]{tail.partition('[run]')[2]}", "utf-8")
        return path

    return partial(write)


FAULTS = [
    ('time = "14 s"', "time", ["before the run's end, 13 s", '"14 s"']),
    ('time = "-1 s"', "time", ["above 0"]),
    ('time = "1 m"', "time", ["a time", "which is a length"]),
    ('mass = "500 kg"', "time", ["the key is missing"]),
    ('time = "1 s"\nmass = "1600 kg"', "mass", ["up to 1500 kg", "more would go than there is"]),
    ('time = "1 s"\nmass = "-5 kg"', "mass", ["above 0"]),
    ('time = "1 s"\nmass = "0.5 t"\nfraction = 0.5', "fraction", ["no key beside mass"]),
    ('time = "1 s"\nfraction = 1.5', "fraction", ["to 1"]),
    ('time = "1 s"\nduration = "1 s"', "duration", ["no duration where all of the load goes"]),
    ('time = "1 s"\nmass = "1.5 t"\nduration = "1 s"', "duration", ["no duration where all of the load goes"]),
    ('time = "1 s"\nfraction = 0.5\ndrag_area = "2 m^2"', "drag_area", ["up to 0 m^2"]),
    ('time = "1 s"\ndrag_area = "2 m^2"', "drag_area", ["all of its drag goes too"]),
    ('time = "1 s"\nrapid_beta = 0.8', "rapid_beta", ["release.standard", "else it is EN 13001-2:2014"]),
    ('time = "1 s"\nbase_half_width = "4.5 mm"', "base_half_width", ["a value from"]),
    ('time = "1 s"\nfracton = 0.5', "fracton", ['closest known key: "fraction"']),
]


@pytest.mark.parametrize(("table", "key", "words"), FAULTS)
def test_one_slip_makes_one_message(written, table, key, words):
    fault = only_fault(written(table))
    assert fault.key == f"release.{key}"
    for word in words:
        assert word in str(fault)


def test_what_needs_the_load_as_it_was_is_refused(tmp_path):
    assert only_fault(CASE, "model.weight_softening=true").key == "model.weight_softening"
    assert only_fault(CASE, "accuracy.frequency=0.01").key == "accuracy.frequency"
    assert {fault.key for fault in faults_of(CASE, "accuracy.target=0.01")} == {"accuracy.target"}
    assert only_fault(CASE, 'ground.height="0 m"').key == "ground"
    assert "of kind" in str(only_fault(MULTI, 'release.time="1 s"'))
    checked = load_case(CASE).checked
    for study in ("compare", "shape", "verify"):
        assert "the load lets go" in KINDS["tower"].refusal(study, checked)


def test_a_run_tells_how_far_it_swings_back_and_whether_it_tips():
    case = load_case(CASE)
    run = record_case(case)
    told = summarise(case, run)
    found = told["release"]
    base, root, rope = found["swings_back"].values()
    assert_allclose([base["one_plus_beta"], root["one_plus_beta"]], [2.707, 2.060], atol=2e-3)
    assert rope["one_plus_beta"] == 1.0
    assert_allclose([base["before"], base["after"], base["minimum"]], [676.8e3, 72.5e3, -959.3e3], atol=200.0)
    assert found["standard"] == {
        "name": "EN 13001-2:2014", "beta_slow": 0.5, "beta_rapid": 1.0, "phi_3_slow": -0.5, "phi_3_rapid": -1.0,
    }  # fmt: skip
    moment, weight = run["base_moment_y"].values, -run["base_force_z"].values
    rows = run.times >= 1.0
    stability = found["stability"]
    assert stability["eccentricity_m"] <= (moment / weight)[rows].min() < stability["eccentricity_m"] + 0.05
    assert stability["tips"]
    assert_allclose(stability["used"], -stability["eccentricity_m"] / 2.25, rtol=1e-12)
    # The free crane's frequencies, no slack rope, no swing.
    assert told["swing_mode"] is None
    assert told["rope"]["slack_phases"] == 0
    assert not any("slack" in notice for notice in told["notices"])
    assert len(told["natural_frequencies_hz"]) == 5
    run.attrs["release"] = json.dumps(found)
    (figure,) = over_times(run.rows.dataset(), BASE).values()
    for axes in figure.axes:
        marks = [line for line in axes.lines if line.get_label() == "1500 kg let go"]
        assert [list(mark.get_xdata()) for mark in marks] == [[1.0, 1.0]]


def test_a_standard_of_the_case_takes_the_place_of_the_one_that_is_known(written):
    case = load_case(written('time = "1 s"\nmass = "600 kg"\nstandard = "DIN 15018:1984"\nrapid_beta = 0.8'))
    run = record_case(load_case(case.path, ["run.duration=3 s"]))
    found = summarise(case, run)["release"]
    assert found["standard"]["name"] == "DIN 15018:1984"
    assert_allclose(found["standard"]["phi_3_rapid"], 1.0 - 0.4 * 1.8, rtol=1e-12)
    assert found["stability"]["half_width_m"] is None
    assert found["stability"]["used"] is None
    assert np.isclose(found["fraction"], 0.4)
