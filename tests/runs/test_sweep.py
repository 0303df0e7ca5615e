"""Sweeps: values in, extremes per run out, whatever runs them; and the command for them."""

import csv
import json

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples.case_files import write_case
from samples.program import towercrane

from towercrane import load_case, run_case, sweep
from towercrane.results import files as results
from towercrane.runs.summary import peaks
from towercrane.runs.sweep import grid
from towercrane.schema.faults import CaseError

SHORT = [
    "run.duration=8 s",
    "solver.rtol=1e-5",
    "solver.atol=1e-7",
    "model.jib_vertical_modes=1",
    "model.tower_modes=1",
]


@pytest.fixture(scope="module")
def case():
    return load_case("qtz5613/condition-3", SHORT)


def assert_run(data, run, case, *changes):
    """The run's extremes are those of a single run of the changed case."""
    single = run_case(load_case(case.path, [*case.changes, *changes]))
    at = data.isel(run=run)
    assert str(at["outcome"].values) == single.attrs["outcome"]
    assert float(at["end_time"]) == single.attrs["end_time"]
    assert int(at["evaluations"]) == single.attrs["evaluations"]
    found = peaks(single)
    for name in json.loads(data.attrs["outputs"]):
        size = max(abs(found[name]["maximum"]), abs(found[name]["minimum"]))
        assert_allclose(at[f"{name}_max"], found[name]["maximum"], rtol=0, atol=1e-12 * size)
        assert_allclose(at[f"{name}_min"], found[name]["minimum"], rtol=0, atol=1e-12 * size)
        assert data[f"{name}_max"].attrs["units"] == found[name]["units"]


def test_loads_and_ropes_of_a_radial_case(case):
    data = sweep(case, {"payload.mass": [300, "1.2 t", 900.0], "rope.length": np.array([6.0, 12.0, 20.0])})
    assert_allclose(data["payload_mass"], [300.0, 1200.0, 900.0])
    assert data["rope_length"].attrs["units"] == "m"
    for run, (mass, rope) in enumerate([(300.0, 6.0), (1200.0, 12.0), (900.0, 20.0)]):
        assert_run(data, run, case, f"payload.mass={mass}", f"rope.length={rope}")
    assert_allclose(data["hoist_rope_force_max"], np.array([300, 1200, 900]) * 9.81, rtol=0.02)


def test_any_key_may_vary_also_one_that_changes_modes_motion_or_rows(case):
    data = sweep(
        case,
        {
            "model.jib_vertical_modes": [0, 1, 2, 1],
            "motion.trolley.speed": ["0.4 m/s", 0.6, 0.8, 0.8],
            "crane.jib.length": ["50 m", "55.6 m", "55.6 m", "50 m"],
            "run.duration": [5, 5, 6, 7],
        },
    )
    rows = [(0, 0.4, 50, 5), (1, 0.6, 55.6, 5), (2, 0.8, 55.6, 6), (1, 0.8, 50, 7)]
    for run, (modes, speed, length, duration) in enumerate(rows):
        assert_run(
            data, run, case, f"model.jib_vertical_modes={modes}", f"motion.trolley.speed={speed}",
            f"crane.jib.length={length}", f"run.duration={duration}",
        )  # fmt: skip


def test_a_hauled_rope_starts_its_motion_at_the_varied_length(case):
    hauled = load_case(
        case.path,
        [*case.changes, 'motion.hoist={shape="trapezoid", end="5 m", speed="0.5 m/s", acceleration="0.2 m/s^2"}'],
    )
    data = sweep(hauled, {"rope.length": [8.0, 14.0]})
    assert_run(data, 1, hauled, "rope.length=14.0")


def test_other_cranes_and_methods_run_in_the_loop_with_the_same_answer(case):
    slewing = load_case("slewing/basic/example-1", ["run.duration=2 s"])
    done = []
    data = sweep(slewing, {"payload.mass": [30.0, 60.0]}, progress=done.append)
    assert done == [1, 2]
    assert_run(data, 0, slewing, "payload.mass=30.0")
    assert "sway_radial" in json.loads(data.attrs["outputs"])
    scipy = sweep(case, {"payload.mass": [500.0], "solver.method": ["scipy-dop853"]})
    lanes = sweep(case, {"payload.mass": [500.0]})
    assert set(lanes.data_vars) == set(scipy.data_vars)
    assert_allclose(scipy["sway_radial_min"], lanes["sway_radial_min"], rtol=1e-3)


def test_series_on_demand(case):
    data = sweep(case, {"payload.mass": [500.0, 700.0]}, series=True)
    assert data["sway_radial"].dims == ("run", "time")
    single = run_case(load_case(case.path, [*case.changes, "payload.mass=700.0"]))
    assert_allclose(data["sway_radial"][1], single["sway_radial"], rtol=0, atol=1e-14)
    # Methods and tolerances may differ.
    methods = sweep(case, {"solver.method": ["dop853", "dopri5"], "solver.rtol": [1e-5, 1e-6]}, series=True)
    single = run_case(load_case(case.path, [*case.changes, "solver.method=dopri5", "solver.rtol=1e-6"]))
    assert_allclose(methods["sway_radial"][1], single["sway_radial"], rtol=0, atol=1e-14)
    with pytest.raises(ValueError, match="series: wanted the same duration"):
        sweep(case, {"run.duration": [5, 6]}, series=True)
    with pytest.raises(ValueError, match="series: wanted the same duration"):
        sweep(case, {"run.output_step": [0.04, 0.08]}, series=True)


@pytest.mark.parametrize(
    ("vary", "words"),
    [
        ({}, "wanted keys with equally many values"),
        ({"payload.mass": [1.0, 2.0], "rope.length": [5.0]}, "wanted keys with equally many values"),
        ({"payload.mass": [0.0, -1.0]}, "payload.mass=0.0: payload.mass\n  wanted: a mass"),
        ({"payload.mass": [float("nan")]}, "wanted: a mass"),
        ({"rope.length": [30.0, 40.0]}, "the height of the tower"),
        ({"payload.mas": [500.0]}, 'closest known key: "mass"'),
        ({"payload.mass": ["5 m"]}, "which is a length"),
    ],
)
def test_values_that_do_not_fit_are_named(case, vary, words):
    with pytest.raises(ValueError, match="(?s)" + words):
        sweep(case, vary)


def test_what_a_case_lacks_by_itself_may_vary(tmp_path):
    path = write_case(tmp_path, ('mass = "800 kg"\n', ""), ("60 s", "2 s"))
    data = sweep(path, {"payload.mass": [500.0, 900.0], "rope.length": [5.0, 99.0]})
    assert (list(data["outcome"].values), data.attrs["changes"]) == (["finished", "bad input"], "[]")
    assert_run(data, 0, load_case(path, ["payload.mass=500", "rope.length=5"]))
    with pytest.raises(CaseError, match=r"^1 fault.*\n\n.*\n  wanted: a mass, .*\n  got:    \"5 m\""):
        sweep(path, {"payload.mass": ["5 m"]})


def test_the_command_varies_what_a_table_needs_that_another_option_makes(tmp_path):
    options = ["--vary", "wind.speed=1,2", "--set", "wind.direction=180deg", "--set", "run.duration=1 s"]
    done = towercrane("sweep", "qtz5613/condition-3", *options, "--out", str(tmp_path / "x"), "--json")
    assert json.loads(done.stdout)["outcomes"] == {"finished": 2}
    done = towercrane("sweep", "qtz5613/condition-3", *options, "--vary", "wind.upwards=1")
    assert (done.returncode, done.stderr.count("got:")) == (2, 1)


def test_grid_takes_all_combinations_the_last_key_fastest():
    assert grid({"a": [1, 2], "b": [3, 4, 5]}) == {"a": [1, 1, 1, 2, 2, 2], "b": [3, 4, 5, 3, 4, 5]}


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    folder = tmp_path_factory.mktemp("sweep")
    settings = [part for change in SHORT for part in ("--set", change)]
    done = towercrane(
        "sweep", "qtz5613/condition-3", "--vary", "payload.mass=100kg:2t:4", "--vary", "rope.length=5m,10m,20m",
        "--out", str(folder), "--threads", "2", "--json", *settings,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return folder, json.loads(done.stdout)


def test_command_answers_in_json(written):
    _, report = written
    assert report["runs"] == 12
    assert report["outcomes"] == {"finished": 12}
    assert_allclose(report["varied"][0]["values"], [100.0, 2200.0 / 3 + 0.0, 4100.0 / 3, 2000.0], rtol=1e-12)
    tension = report["extremes"]["hoist_rope_force"]
    assert tension["units"] == "N"
    assert tension["largest"]["at"]["payload.mass"] == 2000.0
    assert_allclose(tension["largest"]["value"], 2000 * 9.81, rtol=0.02)


def test_command_writes_data_table_and_picture(written):
    folder, report = written
    assert {path.name for path in folder.iterdir()} == {"sweep.nc", "sweep.csv", "sweep.png"}
    data = results.load(folder / "sweep.nc")
    assert_allclose(float(data["sway_radial_max"].max()), report["extremes"]["sway_radial"]["largest"]["value"])
    with open(folder / "sweep.csv", encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["rope_length [m]"]) for row in rows[:4]] == [5.0, 10.0, 20.0, 5.0]
    assert_allclose([float(row["sway_radial_max [rad]"]) for row in rows], data["sway_radial_max"], rtol=1e-11)
    assert {row["outcome"] for row in rows} == {"finished"}


def test_command_shows_a_table_and_the_next_command(tmp_path):
    settings = [part for change in SHORT for part in ("--set", change)]
    done = towercrane(
        "sweep", "qtz5613/condition-3", "--vary", "model.jib_vertical_modes=1:2:2", "--out", str(tmp_path), *settings
    )
    assert done.returncode == 0, done.stderr
    assert "model.jib_vertical_modes" in done.stdout
    assert "assumed  crane.jib.second_moment_of_area" in done.stdout
    assert "next: towercrane run qtz5613/condition-3" in done.stdout


@pytest.mark.parametrize(
    ("option", "words"),
    [
        ("payload.mass", "wanted KEY=FROM:TO:COUNT"),
        ("payload.mass=1kg:2kg", "wanted FROM:TO:COUNT with a count of two or more"),
        ("payload.mass=1kg:2kg:x", "wanted FROM:TO:COUNT"),
        ("payload.mass=1m:2kg:3", "which is a length"),
        ("payload.mass=0kg:0kg:3", "above 0"),
        ("payload.mas=1kg:2kg:3", 'closest known key: "mass"'),
        ("model.jib_vertical_modes=1:4:3", "steps that are whole numbers"),
        ("payload.mass=1kg:2kg:2000000", "at most 1000000"),
    ],
)
def test_command_refuses_bad_input(option, words, tmp_path):
    done = towercrane("sweep", "qtz5613/condition-3", "--vary", option, "--out", str(tmp_path / "x"))
    assert done.returncode == 2
    assert words in done.stderr
    assert "Traceback" not in done.stderr
    assert not (tmp_path / "x").exists()


def test_runs_that_ask_for_an_error_choose_for_themselves(tmp_path):
    case = load_case("qtz5613/within-1e-3", ["run.duration=8 s"])
    data = sweep(case, {"payload.mass": [500.0, 900.0]})
    for run, mass in enumerate((500.0, 900.0)):
        assert_run(data, run, case, f"payload.mass={mass}")
    assert data["accuracy"].values.tolist() == ["promised", "promised"]
    assert "rtol" not in data.attrs
    changes = ("--set", "run.duration=8 s", "--vary", "payload.mass=500,900")
    done = towercrane("sweep", "qtz5613/within-1e-3", *changes, "--json", "--no-pictures", "--out", str(tmp_path))
    assert json.loads(done.stdout)["notices"][1:] == ["error asked for: 2 promised"]
