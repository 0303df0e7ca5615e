"""The study of motions that leave the load at rest, and its command."""

import json
from dataclasses import FrozenInstanceError, replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples import qtz5613
from samples import space_crane as space
from typer.testing import CliRunner

from towercrane.cases.case import load_case
from towercrane.cases.models import model_of, motions_of
from towercrane.cli import app
from towercrane.cranes.tower.sway_frequencies import PendulumFrequencies, SwayFrequencies
from towercrane.motions.plans import Move, Plan, Shaping, shaped_motions
from towercrane.motions.profiles import trapezoid
from towercrane.motions.shaping import zv
from towercrane.report.drive_table import drive_table
from towercrane.report.plots.studies import shaping as pictured
from towercrane.studies import rest_study
from towercrane.studies.candidates import Candidate, candidates
from towercrane.studies.rest_study import RestStudy, Row, Trial, attempt, report, study

CASE = "qtz5613/condition-3"


# --- the study -----------------------------------------------------------------------------------------


def test_study_of_a_trolley_recommends_by_rule():
    plans = load_case(CASE).plans
    seen = []
    done = study(qtz5613.model(1, 1), plans, progress=seen.append)
    assert seen == sorted(seen)
    assert seen[-1] == 1.0
    found = {row.candidate.name: row for row in done.rows}
    assert list(found) == ["commanded", "zv-pendulum", "zv", "zvd", "ei", "boxes", "minimum-jerk"]
    assert_allclose([found["zv"].candidate.duration, found["zvd"].candidate.duration], [57.257, 61.514], atol=2e-3)
    assert found["commanded"].nominal.residual > 0.1
    damped = qtz5613.model(1, 1, damping=(0.01, 0.01))
    motions = found["commanded"].candidate.motions
    assert_allclose(found["commanded"].nominal.residual, attempt(damped, motions).residual, rtol=1e-12)
    assert abs(attempt(qtz5613.model(1, 1), motions).residual / found["commanded"].nominal.residual - 1) > 1e-6
    assert found["zvd"].worst < 5e-3 < found["zv"].worst
    # Least jerk in the same time goes beyond the commanded speed.
    assert [row.candidate.name for row in done.rows if not row.candidate.within_limits] == ["minimum-jerk"]
    assert done.recommended is found["zv"] or done.recommended is found["zv-pendulum"]
    assert done.reason.startswith("the shortest that keeps the load within 0.1 m: 0.0")
    strict = RestStudy(done.rows, 0.005, done.frequencies)
    assert strict.recommended is found["zvd"]
    hopeless = RestStudy(done.rows, 1e-6, done.frequencies)
    assert hopeless.recommended is found["zvd"]
    assert hopeless.reason.startswith("none keeps the load within 1e-06 m; this leaves least, 0.00")
    (first, last) = done.frequencies["trolley"]
    assert_allclose([first, last], 0.1174, atol=2e-4)
    written = report(done)
    assert json.loads(json.dumps(written, allow_nan=False)) == written
    assert {row["name"]: row["within_limits"] for row in written["candidates"]}["minimum-jerk"] is False


def test_runs_that_end_early_are_named_and_never_recommended():
    calm, lost = Trial(0.01, 0.0, 1.0, "finished"), Trial(None, 0.0, 1.0, "slack rope")
    plans = load_case(CASE).plans
    first, second, *_ = candidates(plans, PendulumFrequencies(9.81), PendulumFrequencies(9.81))
    rows = [Row(first, {1.0: calm, 1.2: lost}, {}), Row(second, {1.0: calm}, {})]
    done = RestStudy(rows, 0.1, {})
    assert done.recommended is rows[1]
    assert report(done)["candidates"][0]["worst_residual_m"] is None
    fast = Row(replace(second, within_limits=False), {1.0: replace(calm, residual=0.001)}, {})
    assert RestStudy([fast, *rows], 0.1, {}).recommended is rows[1]
    assert RestStudy([fast, *rows], 1e-4, {}).recommended is rows[1]
    assert RestStudy(rows[:1], 0.1, {}).reason == "no motion keeps its load to the end with rope +-20 %"
    fallen = attempt(
        space.model(1, 1, 1, 1), space.standing(20.0, 10.0) | {"trolley": trapezoid(20.0, 60.0, 2.0, 0.5)}
    )
    assert (fallen.residual, fallen.outcome) == (None, "trolley off the jib")


def test_interrupted_run_ends_the_study(monkeypatch):
    motions = space.standing(20.0, 10.0) | {"trolley": trapezoid(20.0, 22.0, 2.0, 0.5)}
    real = rest_study.simulate

    def interrupted(*arguments, **options):
        return real(*arguments, **options).assign_attrs(outcome="interrupted")

    monkeypatch.setattr(rest_study, "simulate", interrupted)
    with pytest.raises(KeyboardInterrupt):
        attempt(space.model(0, 0, 0, 0), motions)


def test_motions_are_candidates_by_identity_and_stay_as_they_are():
    motions = {"trolley": trapezoid(5.0, 9.0, 0.8, 0.2)}
    one, other = Candidate("a", "b", motions), Candidate("a", "b", motions)
    assert len({one, other}) == 2
    assert one.within_limits
    with pytest.raises(FrozenInstanceError):
        one.within_limits = False


def test_hoists_keep_their_own_shaping_and_shaped_cases_are_tried_too():
    hoist = 'motion.hoist={shape="zv", end=12, speed=0.4, acceleration=0.2, frequencies=0.5}'
    case = load_case(CASE, [hoist, "motion.trolley.shape=ei"])
    tried = candidates(case.plans, PendulumFrequencies(9.81), PendulumFrequencies(9.81))
    assert [c.name for c in tried][:3] == ["commanded", "case", "zv-pendulum"]
    assert_allclose([c.motions["rope"].duration for c in tried], 6 / 0.4 + 2 + 1)
    assert tried[0].duration == pytest.approx(53.0)
    assert tried[1].duration > 60.0
    with pytest.raises(ValueError, match="wanted a trolley, a luffing or a slewing drive that moves, got none"):
        candidates(
            load_case(CASE, ['motion.trolley={shape="rest", start=5}']).plans,
            PendulumFrequencies(9.81),
            PendulumFrequencies(9.81),
        )


def test_cases_shaped_for_the_model_are_calm():
    from towercrane.runs.run import run_case

    left = {}
    for shape in ("trapezoid", "zvd"):
        case = load_case(CASE, [f"motion.trolley.shape={shape}", "run.duration=100 s"])
        result = run_case(case)
        after = result["time"].values > motions_of(case)["trolley"].duration
        left[shape] = float(abs(result["sway_radial"].values[after]).max())
    assert left["trapezoid"] > 5e-3
    assert left["zvd"] < 1e-5


# --- what it writes ------------------------------------------------------------------------------------


def test_drive_tables_begin_and_end_at_rest():
    motion = shaped_motions({"trolley": Plan((Move(trapezoid(5.0, 9.0, 0.8, 0.2), Shaping(zv, (0.11,))),))})[
        "trolley"
    ]
    rows = drive_table(motion, 0.02, "m", {"crane": "QTZ5613"})
    assert_allclose(rows["position"].values[[0, -1]], [5.0, 9.0], atol=1e-12)
    assert_allclose(rows["speed"].values[[0, -1]], 0.0, atol=1e-12)
    assert rows["acceleration"].values[-1] == 0.0
    assert 0.0 <= rows["time"].values[-1] - motion.duration < 0.02
    assert rows["acceleration"].attrs["units"] == "m/s^2"
    assert rows.attrs == {"crane": "QTZ5613", "step": "0.02 s"}
    with pytest.raises(ValueError, match="step wants a positive time, got 0"):
        drive_table(motion, 0.0, "m", {})


def test_pictures_have_units_names_and_what_was_assumed(monkeypatch):
    monkeypatch.setattr(rest_study, "ROPES", (0.9, 1.0))
    monkeypatch.setattr(rest_study, "TORSIONS", (0.9,))
    plans = {c: Plan((Move(m),)) for c, m in space.manoeuvre().items()}
    done = study(space.model(0, 1, 1, 0), plans)
    notes = [("crane.jib.length", "55.6 m", "a guess")]
    left, moved = pictured.residuals(done, "QTZ5613", notes), pictured.profiles(done, "QTZ5613", notes)
    for figure in (left, moved):
        figure.canvas.draw()
        assert figure.axes[0].get_legend() is not None
        assert "crane.jib.length = 55.6 m" in figure.get_supxlabel()
    assert [axes.get_xlabel() for axes in left.axes] == [
        "rope length [of the planned]",
        "torsional stiffness [of the model's]",
    ]
    assert [axes.get_ylabel().replace("\n", " ") for axes in moved.axes] == [
        "trolley speed [m/s]",
        "trolley acceleration [m/s²]",
        "slewing speed [deg/s]",
        "slewing acceleration [deg/s²]",
    ]
    assert any("(recommended)" in text.get_text() for text in left.axes[0].get_legend().get_texts())


def test_command_writes_a_report_tables_for_drives_and_pictures(tmp_path):
    setting = ["--set", "model.tower_modes=1", "--set", "model.jib_vertical_modes=1"]
    done = CliRunner().invoke(app, ["shape", CASE, "--out", str(tmp_path), "--step", "0.1", *setting])
    assert done.exit_code == 0, done.output
    assert {path.name for path in tmp_path.iterdir()} == {
        "shape.json", "drive-trolley.csv", "residuals.png", "profiles.png",
    }  # fmt: skip
    summary = json.loads((tmp_path / "shape.json").read_text("utf-8"))
    name = summary["recommended"]
    assert f"recommended: {name}, the shortest" in done.output
    assert "crane.jib.second_moment_of_area = 0.0035 m^4" in done.output
    assert [entry["key"] for entry in summary["assumed"]] == [
        "crane.jib.youngs_modulus",
        "crane.jib.second_moment_of_area",
    ]
    lines = (tmp_path / "drive-trolley.csv").read_text("utf-8").splitlines()
    assert "# drive: trolley" in lines
    assert "time [s],position [m],speed [m/s],acceleration [m/s^2]" in lines
    assert lines[-1].split(",")[1:] == ["41", "0", "0"]
    if name == "zv":
        assert f"--set motion.trolley.shape={name}" in done.output.splitlines()[-1]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["slewing/basic/example-1"], "wanted a crane of kind tower"),
        (
            [CASE, "--set", 'motion.trolley={shape="rest", start=5}'],
            "wanted a trolley, a luffing or a slewing drive that moves",
        ),
        ([CASE, "--within", "0"], "--within 0: wanted a positive distance"),
        ([CASE, "--step", "20"], "--step 20: wanted seconds from 0.001 to 10"),
    ],
)
def test_command_refuses_what_it_cannot_study(arguments, said, tmp_path):
    done = CliRunner().invoke(app, ["shape", *arguments, "--out", str(tmp_path / "new")])
    assert done.exit_code == 2
    assert said in done.output
    assert not (tmp_path / "new").exists()


def test_model_of_a_radial_case_is_studied_as_it_is():
    case = load_case(CASE)
    assert_allclose(
        SwayFrequencies(model_of(case))("trolley", 41.0, 18.0),
        [np.sqrt(9.81 / 18.0) / (2 * np.pi)],
        rtol=1e-3,
    )
