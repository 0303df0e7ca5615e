"""Commands that serve every kind of crane serve the overhead crane; slips in its file are one clear message."""

import json

import numpy as np
import pytest
from samples.program import towercrane
from typer.testing import CliRunner

from towercrane.cases.case import CaseError, load_case
from towercrane.cases.models import poses_of
from towercrane.cli import app
from towercrane.cranes.registry import KINDS
from towercrane.report.plots.runs.panels import run_pictures
from towercrane.results import files as results
from towercrane.runs.run import run_case

CASE = "overhead-crane/travel"
SHORT = ("--set", "run.duration=4 s", "--set", "solver.rtol=1e-6")


def done(*arguments):
    return CliRunner().invoke(app, [str(one) for one in arguments])


def test_cases_lists_its_cases():
    listed = done("cases")
    assert listed.exit_code == 0
    assert {"overhead-crane/travel", "overhead-crane/hoist"} <= set(listed.output.split())


def test_a_run_is_drawn_summed_up_and_filmed_from_its_file(tmp_path):
    ran = done("run", CASE, *SHORT, "--out", tmp_path, "--json")
    assert ran.exit_code == 0, ran.output
    summary = json.loads((tmp_path / "summary.json").read_text(encoding="utf-8"))
    assert summary["outcome"] == "finished"
    assert summary["energy_balance"]["relative_gap"] < 1e-6
    assert len(summary["natural_frequencies_hz"]) == 3
    assert len(summary["assumed"]) == 24
    files = {path.name for path in tmp_path.iterdir()}
    assert files == {"result.nc", "summary.json", "overview.png", "forces.png", "path.png", "base.png"}
    filmed = done("animate", tmp_path / "result.nc", "--out", tmp_path / "film.gif", "--frames-per-second", 3)
    assert filmed.exit_code == 0, filmed.output
    assert (tmp_path / "film.gif").read_bytes()[:6] == b"GIF89a"


def test_linearise_writes_its_linear_model(tmp_path):
    found = done("linearise", CASE, "--at", 30, "--out", tmp_path / "model.npz", "--json")
    assert found.exit_code == 0, found.output
    with np.load(tmp_path / "model.npz", allow_pickle=False) as saved:
        assert saved["A"].shape == (12, 12)
    report = json.loads(found.stdout)
    assert [state["name"] for state in report["states"]][:3] == ["bridge_uplift", "sway_x", "sway_y"]
    assert report["inputs"][0]["name"] == "bridge_acceleration"


def test_a_sweep_over_a_key_is_the_single_runs(tmp_path):
    vary = "crane.bridge.second_moment_of_area=0.01 m^4,0.02 m^4"
    swept = done("sweep", CASE, *SHORT, "--vary", vary, "--out", tmp_path, "--threads", 1)
    assert swept.exit_code == 0, swept.output
    peaks = results.load(tmp_path / "sweep.nc")["bridge_deflection_max"].values
    changes = ["run.duration=4 s", "solver.rtol=1e-6"]
    alone = [
        float(run_case(load_case(CASE, [*changes, f"crane.bridge.second_moment_of_area={i} m^4"]))[
            "bridge_deflection"
        ].max())
        for i in (0.01, 0.02)
    ]  # fmt: skip
    assert peaks.tolist() == alone


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ("crane.bridge.span=25 kg", ("crane.bridge.span", "a length", "which is a mass")),
        ("crane.bridge.spam=25 m", ("crane.bridge.spam", '"span"')),
        ("crane.bridge.span=25.5 km", ("crane.bridge.span", "from 1 to 200 m")),
        ("crane.trolley.mass=7 s", ("crane.trolley.mass", "a mass", "which is a time")),
        ("motion.bridge.end=61 m", ("motion.bridge.end", "from 0 to 60 m (the length of the runway)")),
        ("motion.trolley.start=-1 m", ("motion.trolley.start", "from 0 to 25.5 m (the length of the bridge)")),
        ("rope.length=12.5 m", ("rope.length", "up to 12 m (the height of the runway)")),
        ("motion.slew.start=1", ("motion.slew", "overhead")),
    ],
)
def test_slips_are_one_fault_each(change, words):
    with pytest.raises(CaseError) as refused:
        load_case(CASE, [change])
    (fault,) = refused.value.faults
    assert all(word in str(fault) for word in words), str(fault)


@pytest.mark.parametrize("slip", ["crane.bridge.span=25 kg", "crane.bridge.spam=25 m"])
def test_a_slip_ends_a_run_before_it_begins(tmp_path, slip):
    refused = towercrane("run", CASE, "--set", slip, "--out", str(tmp_path / "out"))
    assert (refused.returncode, refused.stdout) == (2, "")
    assert refused.stderr.count("wanted:") == 1
    assert "Traceback" not in refused.stderr
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("command", ["modes", "map", "lattice", "compare", "shape"])
def test_commands_for_other_kinds_say_so(command):
    refused = done(command, CASE)
    assert refused.exit_code == 2
    assert "overhead" in refused.output.replace(CASE, "")


def test_poses_are_the_run_s_own_places():
    case = load_case(CASE, ["run.duration=12 s"])
    result = run_case(case)
    poses = poses_of(case, result, result["time"].values)
    rope = poses.load - poses.members["suspension"][:, 0]
    np.testing.assert_allclose(np.linalg.norm(rope, axis=1), result["rope_length"].values, rtol=0, atol=1e-10)
    sag = poses.undeformed["bridge"][:, 20, 2] - poses.members["bridge"][:, 20, 2]
    np.testing.assert_allclose(sag, result["bridge_deflection"].values, rtol=0, atol=1e-14)
    assert not poses.planar


def test_what_is_nothing_but_rounding_is_drawn_as_none():
    case = load_case("overhead-crane/hoist", ["run.duration=3 s"])
    figures = run_pictures(run_case(case), KINDS[case.kind].pictures)
    drives, rails, tension = figures["forces.png"].axes
    assert drives.get_ylim() == (-0.05, 0.05)
    # What is small beside another unit's values is not: deflections beside lengths.
    for axes in (rails, tension, figures["overview.png"].axes[3]):
        low, high = axes.get_ylim()
        drawn = np.concatenate([line.get_ydata() for line in axes.get_lines()])
        assert low < drawn.min() < drawn.max() < high
    assert "20000 kg" in figures["forces.png"].get_suptitle()
