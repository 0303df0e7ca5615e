"""Run as a newcomer meets it: answers, files, exit codes of each outcome, an interrupt."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples.program import towercrane

from towercrane.results import files as results


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    return tmp_path_factory.mktemp("run")


@pytest.fixture(scope="module")
def run(folder):
    done = towercrane(
        "run", "qtz5613/condition-3", "--out", str(folder), "--json", "--csv", "--set", "run.duration=60 s"
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_run_answers_in_the_documented_json(run):
    assert run["outcome"] == "finished"
    assert_allclose(run["peaks"]["sway_radial"]["minimum"], -0.020412, atol=2e-6)
    assert_allclose(run["peaks"]["sway_radial"]["minimum_time_s"], 4.25, atol=0.051)
    assert run["peaks"]["hoist_rope_force"]["units"] == "N"
    assert run["wall_seconds"] > 0.0
    assert run["swing_period_s"] is None  # seven seconds after the stop are less than a period
    assert run["spectrum_peaks_hz"] == sorted(run["spectrum_peaks_hz"])
    assert run["energy_balance"]["relative_gap"] < 1e-10
    assert [entry["key"] for entry in run["assumed"]] == [
        "crane.jib.youngs_modulus",
        "crane.jib.second_moment_of_area",
    ]


def test_run_writes_result_summary_and_pictures(run, folder):
    files = {path.name for path in folder.iterdir()}
    pictures = {"overview", "motion", "swing", "phase", "tower", "jib", "spectrum", "torque", "base", "modes"}
    assert files == {"result.nc", "result.csv", "summary.json"} | {f"{name}.png" for name in pictures}
    assert json.loads((folder / "summary.json").read_text(encoding="utf-8")) == run
    data = results.load(folder / "result.nc")
    assert len(data.time) == 1201
    assert json.loads(data.attrs["case_text"])["payload"]["mass"] == "800 kg"


def test_swing_period_of_the_source(tmp_path):
    done = towercrane("run", "qtz5613/condition-3", "--out", str(tmp_path), "--json", "--no-pictures")
    summary = json.loads(done.stdout)
    # Printed: 8.52 s.
    assert_allclose(summary["swing_period_s"], 8.514, atol=2e-3)
    # Free vibration after the stop: the swing, and the structure within the weight's second-order effect.
    peaks = np.array(summary["spectrum_peaks_hz"])
    for natural in summary["natural_frequencies_hz"][:3]:
        assert np.min(abs(peaks / natural - 1)) < 0.02
    assert summary["swing_mode"] == 1


def test_parametric_resonance_is_named(tmp_path):
    done = towercrane("run", "qtz5613/condition-4-zero", "--out", str(tmp_path), "--json", "--no-pictures")
    summary = json.loads(done.stdout)
    assert_allclose(max(abs(summary["peaks"]["sway_radial"][k]) for k in ("maximum", "minimum")), 0.603, atol=5e-3)
    notices = " ".join(summary["notices"])
    assert "parametric resonance" in notices
    assert "twice the swing" in notices
    assert "the rope pushes" in notices


@pytest.mark.parametrize("case", ["slewing/basic/example-1", "jib-crane/plan"])
def test_other_kinds_run_and_suggest_what_works(case, tmp_path):
    import shlex

    done = towercrane("run", case, "--out", str(tmp_path), "--set", "run.duration=6 s")
    assert done.returncode == 0, done.stderr
    summary = json.loads((tmp_path / "summary.json").read_text(encoding="utf-8"))
    assert summary["outcome"] == "finished"
    assert summary["energy_balance"]["relative_gap"] < 1e-8
    assert summary["natural_frequencies_hz"]
    assert (tmp_path / "path.png").exists()
    following = shlex.split(done.stdout.splitlines()[-1].removeprefix("next: towercrane "))
    assert towercrane(*following).returncode == 0
    refused = towercrane("modes", case)
    assert refused.returncode == 2
    assert f"towercrane linearise {case}" in refused.stderr


def test_slack_rope_ends_the_run_with_exit_code_3_and_keeps_what_is_finished(tmp_path):
    done = towercrane(
        "run", "qtz5613/condition-4-zero", "--out", str(tmp_path), "--set", "rope.slack=stop", "--no-pictures"
    )
    assert done.returncode == 3
    assert "slack rope" in done.stderr
    data = results.load(tmp_path / "result.nc")
    assert data.attrs["outcome"] == "slack rope"
    assert float(data.time[-1]) <= data.attrs["end_time"] < 120.0


def test_buckling_tower_is_an_outcome_of_run_and_modes(tmp_path):
    weak = ("--set", "model.weight_softening=true", "--set", 'crane.tower.second_moment_of_area="0.0002 m^4"')
    run = towercrane("run", "qtz5613/condition-3", "--out", str(tmp_path), *weak)
    assert run.returncode == 3
    assert "tower buckled" in run.stderr
    assert json.loads((tmp_path / "summary.json").read_text(encoding="utf-8"))["natural_frequencies_hz"] == []
    found = towercrane("modes", "qtz5613/condition-3", *weak)
    assert found.returncode == 3
    assert "tower buckled" in found.stdout
    assert "Traceback" not in run.stderr + found.stderr


def test_files_of_an_earlier_run_do_not_stay_beside_another_result(tmp_path):
    short = ("--out", str(tmp_path), "--set", "run.duration=1 s")
    assert towercrane("run", "qtz5613/condition-3", *short, "--csv").returncode == 0
    (tmp_path / "mine.txt").write_text("keep", encoding="utf-8")
    done = towercrane("run", "qtz5613/condition-3", *short, "--no-pictures")
    assert "removed, of an earlier run: result.csv" in done.stdout
    assert {path.name for path in tmp_path.iterdir()} == {"result.nc", "summary.json", "mine.txt"}


@pytest.mark.skipif(os.name == "nt", reason="signals")
def test_interrupt_keeps_what_is_finished(tmp_path):
    import signal

    endless = ("--set", "run.duration=200 h", "--set", "run.output_step=10 s", "--no-pictures")
    command = [sys.executable, "-m", "towercrane.cli", "run", "qtz5613/condition-3", "--out", str(tmp_path), *endless]
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, encoding="utf-8") as process:
        # One signal may fall into a library's loading, which swallows it; a person would press again.
        for _ in range(60):
            try:
                message = process.communicate(timeout=3.0)[1]
                break
            except subprocess.TimeoutExpired:
                process.send_signal(signal.SIGINT)
        else:
            process.kill()
            pytest.fail("the run did not stop")
    assert process.returncode == 130
    assert "Traceback" not in message
    if (tmp_path / "result.nc").exists():  # it may have come before the first step on a slow machine
        data = results.load(tmp_path / "result.nc")
        assert data.attrs["outcome"] == "interrupted"
        assert 0.0 < float(data.time[-1]) < 720_000.0
