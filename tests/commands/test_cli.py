"""The command line as a newcomer meets it: answers, files, exit codes, and no traceback."""

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


def test_help_and_version_name_every_command():
    text = towercrane("--help").stdout
    for command in (
        "modes",
        "run",
        "animate",
        "linearise",
        "shape",
        "sweep",
        "map",
        "lattice",
        "compare",
        "figures",
        "bench",
        "cases",
    ):
        assert command in text
    assert towercrane("--version").stdout.startswith("towercrane 0.")


def test_help_loads_nothing_heavy():
    heavy = {"numpy", "numba", "scipy", "skfem", "xarray", "pint", "pydantic", "matplotlib"}
    check = f"import sys, towercrane.cli; print(sorted({heavy} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", check], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


@pytest.mark.parametrize(
    ("arguments", "idle"),
    [
        (
            ("run", "qtz5613/condition-3", "--no-pictures"),
            {"pint", "matplotlib", "scipy.optimize", "scipy.sparse", "xarray", "pandas"},
        ),
        (("modes", "qtz5613/condition-3"), {"pint", "matplotlib", "scipy.optimize", "xarray", "pandas"}),
    ],
    ids=["run", "modes"],
)
def test_commands_load_only_what_they_use(arguments, idle, tmp_path):
    check = f"""if True:
        import atexit, sys, towercrane.cli
        atexit.register(lambda: print(sorted({idle} & set(sys.modules)), file=sys.stderr))
        towercrane.cli.main()"""
    command = [sys.executable, "-c", check, *arguments]
    done = subprocess.run(command, capture_output=True, text=True, check=True, cwd=tmp_path)
    assert done.stderr.splitlines()[-1] == "[]"


def test_cases_are_listed_with_the_next_command():
    lines = towercrane("cases").stdout.splitlines()
    names = [line.split()[0] for line in lines[:-1]]
    assert {f"qtz5613/condition-{n}{kind}" for n in (1, 2, 3, 4) for kind in ("", "-paper")} <= set(names)
    assert "qtz5613/condition-4-zero" in names
    assert lines[-1].startswith("next: towercrane modes ")


def test_cases_are_handed_out_once_and_run_where_they_are(tmp_path):
    assert towercrane("cases", "copy", str(tmp_path / "mine")).returncode == 0
    case = tmp_path / "mine" / "qtz5613" / "condition-4.toml"
    text = case.read_text(encoding="utf-8").replace('length = "10 m"', 'length = "12 m"')
    case.write_text(text, encoding="utf-8")
    again = towercrane("cases", "copy", str(tmp_path / "mine"))
    assert again.returncode == 2
    assert "would be overwritten" in again.stderr
    assert case.read_text(encoding="utf-8") == text
    done = towercrane("run", str(case), "--no-pictures", "--json", "--set", "run.duration=2 s", cwd=tmp_path)
    assert done.returncode == 0
    assert (tmp_path / "results" / "condition-4" / "result.nc").exists()


def test_modes_answers_in_the_documented_json():
    report = json.loads(towercrane("modes", "qtz5613/condition-3", "--json").stdout)
    roots = report["tower"]["roots"]
    assert_allclose(roots, [0.769077, 1.512129, 4.799683, 7.896404], atol=1e-6)
    printed = np.array([0.765, 1.508, 4.780, 7.896])
    assert_allclose(np.delete(roots, 2), np.delete(printed, 2), atol=0.005)
    assert roots[2] - printed[2] > 0.015
    assert_allclose(report["tower"]["frequencies_hz"][0], 0.477056, atol=1e-6)
    assert_allclose(report["jib"]["frequencies_hz"][0], 0.436846, atol=1e-6)
    # The worst of four at 32 elements.
    differences = np.array(report["finite_elements"]["relative_difference"])
    assert_allclose(report["finite_elements"]["frequencies_hz"], report["tower"]["frequencies_hz"], rtol=3e-6)
    assert np.max(abs(differences[:3])) < 1e-6
    assert [row["trolley_position_m"] for row in report["crane"]] == [5.0, 23.0, 41.0]
    assert_allclose(report["crane"][2]["frequencies_hz"][:3], [0.117452, 0.311804, 0.794508], atol=1e-6)
    assert np.max(np.abs(report["crane"][2]["relative_difference"][:3])) < 2e-5
    assert report["lattice"]["equivalent_second_moment_of_area"]["use"]
    assert any(entry["key"] == "crane.jib.second_moment_of_area" for entry in report["assumed"])


def test_modes_table_names_the_discrepancy_and_the_assumed_values():
    text = towercrane("modes", "qtz5613/condition-3").stdout
    assert "(!) discrepancy" in text
    assert "f [Hz]" in text
    assert "trolley [m]" in text
    assert "assumed  crane.jib.second_moment_of_area = 0.0035 m^4" in text
    assert "next: towercrane run qtz5613/condition-3" in text


def test_run_answers_in_the_documented_json(run):
    assert run["outcome"] == "finished"
    assert_allclose(run["peaks"]["swing_angle"]["minimum"], -0.020412, atol=2e-6)
    assert_allclose(run["peaks"]["swing_angle"]["minimum_time_s"], 4.25, atol=0.051)
    assert run["peaks"]["rope_tension"]["units"] == "N"
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
    pictures = {"overview", "motion", "swing", "phase", "tower", "jib", "spectrum", "modes"}
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
    assert_allclose(max(abs(summary["peaks"]["swing_angle"][k]) for k in ("maximum", "minimum")), 0.603, atol=5e-3)
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


def test_sensitivity_writes_ranking_surfaces_and_reduced_crane(tmp_path):
    done = towercrane(
        "sensitivity", "slewing/basic/cycle", "--vary", "stiffness_rope", "--step", "100", "--out", str(tmp_path),
        "--json", "--set", "run.duration=12 s",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    report = json.loads(done.stdout)
    assert report["degrees_of_freedom"] == 7
    assert {path.name for path in tmp_path.iterdir()} == {
        "sensitivity.nc", "sensitivity.json", "ranking.png", "surface-stiffness_rope.png",
    }  # fmt: skip
    for wrong in (("--vary", "nonsense"), ("--step", "0"), ("--tolerance", "3")):
        refused = towercrane("sensitivity", "slewing/basic/cycle", "--out", str(tmp_path / "no"), *wrong)
        assert refused.returncode == 2
        assert "wanted" in refused.stderr
    assert towercrane("sensitivity", "qtz5613/condition-3", "--out", str(tmp_path / "no")).returncode == 2
    assert not (tmp_path / "no").exists()


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


def test_brackets_in_names_are_text(tmp_path):
    odd = ("--set", 'title="load [/b] 800 kg"', "--set", 'crane.name="A [red]"')
    done = towercrane("run", "qtz5613/condition-3", "--out", str(tmp_path), "--no-pictures", *odd)
    assert done.returncode == 0
    assert "A [red]: load [/b] 800 kg" in done.stdout
    assert "at [s]" in done.stdout
    assert 'title="load [/b] 800 kg"' in done.stdout


def test_files_of_an_earlier_run_do_not_stay_beside_another_result(tmp_path):
    short = ("--out", str(tmp_path), "--set", "run.duration=1 s")
    assert towercrane("run", "qtz5613/condition-3", *short, "--csv").returncode == 0
    (tmp_path / "mine.txt").write_text("keep", encoding="utf-8")
    done = towercrane("run", "qtz5613/condition-3", *short, "--no-pictures")
    assert "removed, of an earlier run: result.csv" in done.stdout
    assert {path.name for path in tmp_path.iterdir()} == {"result.nc", "summary.json", "mine.txt"}


def test_next_command_works_as_printed(tmp_path):
    folder = tmp_path / "my cases"
    copied = towercrane("cases", "copy", str(folder)).stdout.splitlines()[-1]
    import shlex

    command = shlex.split(copied.removeprefix("next: "))
    assert command[:2] == ["towercrane", "run"]
    assert Path(command[2]).is_file()
    done = towercrane("modes", command[2], "--set", "payload.mass=900 kg").stdout.splitlines()[-1]
    again = shlex.split(done.removeprefix("next: "))
    assert again == ["towercrane", "run", command[2], "--set", "payload.mass=900 kg"]


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


BAD = {
    "missing file": (["run", "condition-9"], ["condition-9", "wanted"]),
    "misspelt key": (
        ["run", "qtz5613/condition-3", "--set", "payload.mas=3 kg"],
        ["payload.mas", 'closest known key: "mass"'],
    ),
    "wrong unit": (["modes", "qtz5613/condition-3", "--set", "rope.length=18 s"], ["rope.length", "18 s"]),
    "absurd modulus": (
        ["modes", "qtz5613/condition-3", "--set", "crane.tower.youngs_modulus=206"],
        ["youngs_modulus", "206", "GPa"],
    ),
    "off the jib": (
        ["run", "qtz5613/condition-3", "--set", "motion.trolley.end=60 m"],
        ["motion.trolley", "60", "55.6"],
    ),
    "too few elements": (
        ["modes", "qtz5613/condition-3", "--set", "modes.elements=2"],
        ["modes.elements", "4 modes"],
    ),
    "unknown method": (["run", "qtz5613/condition-3", "--set", "solver.method=euler"], ["solver.method", "dop853"]),
    "unknown option": (["run", "qtz5613/condition-3", "--setx", "a=b"], ["--setx"]),
}


@pytest.mark.parametrize(("arguments", "words"), BAD.values(), ids=BAD)
def test_bad_input_is_one_clear_message_and_exit_code_2(arguments, words, tmp_path):
    done = towercrane(*arguments, cwd=tmp_path)
    assert done.returncode == 2
    assert "Traceback" not in done.stderr + done.stdout
    assert done.stdout == ""
    for word in words:
        assert word in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_output_folder_that_is_a_file_is_refused_before_the_run(tmp_path):
    target = tmp_path / "taken"
    target.write_text("mine", encoding="utf-8")
    done = towercrane("run", "qtz5613/condition-3", "--out", str(target))
    assert done.returncode == 2
    assert "wanted a folder" in done.stderr
    assert target.read_text(encoding="utf-8") == "mine"
