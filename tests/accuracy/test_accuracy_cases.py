"""Cases that ask for an error: what the table takes, what a run says, the command line."""

from __future__ import annotations

import json

import numpy as np
import pytest
from samples.program import towercrane
from samples.qtz5613 import plane_setting
from typer.testing import CliRunner

from towercrane import load_case
from towercrane.accuracy.promise import (
    CANNOT_BE_PROMISED,
    KEPT,
    OUT_OF_REACH,
    finer,
    stated,
    targets_of,
    verification,
)
from towercrane.accuracy.scene import scene_of
from towercrane.cli import app
from towercrane.cranes.tower.targets import FORETOLD
from towercrane.report.tables.runs import run_tables, verification_tables
from towercrane.runs.run import record_case, run_case
from towercrane.runs.summary import summarise
from towercrane.schema.faults import CaseError
from towercrane.schema.targets import Tolerance

OPEN, STATED = "qtz5613/within-1e-3", "qtz5613/condition-3"
SHORT = ["run.duration=60 s"]


def promised(name, *changes):
    case = load_case(name, [*SHORT, *changes])
    result = record_case(case)
    return case, result, json.loads(result.attrs["accuracy"])


def test_a_target_takes_ratios_lengths_and_a_table():
    def targets(text):
        return targets_of(load_case(STATED, [f"accuracy.target={text}"]))

    assert set(targets("1e-3").values()) == {Tolerance(1e-3, relative=True)}
    assert len(targets('"0.1 %"')) == 4
    assert targets('"0.1 mm"') == {
        name: Tolerance(pytest.approx(1e-4), relative=False)
        for name in ("tower_tip_displacement", "jib_tip_deflection")
    }
    mixed = targets('{ sway_radial = "0.01 deg", hoist_rope_force = "50 N" }')
    assert mixed["sway_radial"].value == pytest.approx(np.radians(0.01))
    assert mixed["hoist_rope_force"] == Tolerance(50.0, relative=False)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("5", ("above 0 to 0.5", "got:    5", "50 % of the peak at most")),
        ("0", ("above 0 to 0.5", "got:    0")),
        ("-1e-3", ("got:    -0.001",)),
        ('"fast"', ('got:    "fast"', "a quantity begins with its number")),
        ('"3 kg"', ('such as "0.1 mm"', '"3 kg"')),
        ("{ swing_radial = 1e-3 }", ('unknown output "swing_radial"', 'did you mean "sway_radial"?')),
        ('{ sway_radial = "1 mm" }', ("an error of sway_radial in rad", '"1 mm"')),
        ("{}", ("an empty table",)),
    ],
)
def test_a_target_that_makes_no_sense(text, words):
    with pytest.raises(CaseError) as caught:
        load_case(STATED, [f"accuracy.target={text}"])
    assert "accuracy.target" in str(caught.value)
    for word in words:
        assert word in str(caught.value)


def test_outputs_without_a_target():
    with pytest.raises(CaseError, match=r"(?s)accuracy\.target.*an error of sway_radial in rad"):
        load_case(STATED, ['accuracy.target="1 mm"', 'accuracy.outputs=["sway_radial"]'])
    with pytest.raises(CaseError, match="none for sway_radial"):
        load_case(STATED, ["accuracy.target={ hoist_rope_force = 0.1 }", 'accuracy.outputs=["sway_radial"]'])
    with pytest.raises(CaseError, match=r'(?s)accuracy\.outputs.*got:    "swing_radial".*did you mean "sway_radial"'):
        load_case(STATED, ["accuracy.target=1e-3", 'accuracy.outputs=["swing_radial"]'])


def test_without_a_target_nothing_changes():
    result = run_case(load_case(STATED, SHORT))
    assert "accuracy" not in result.attrs
    assert (result.attrs["tower_x_modes"], result.attrs["jib_vertical_modes"], result.attrs["rtol"]) == (2, 3, 1e-8)
    assert result.attrs["frequency_cap"] == 0.0


def test_a_run_says_what_it_chose_and_promises(capsys):
    case, result, found = promised(OPEN)
    assert found["outcome"] == KEPT
    assert found["stated"] == []
    assert set(found["outputs"]) == {"tower_tip_displacement", "jib_tip_deflection", "sway_radial"}
    for output in found["outputs"].values():
        assert 0.0 < output["estimated"] <= output["allowed"] == pytest.approx(1e-3 * output["peak"])
    assert result.attrs["jib_vertical_modes"] == found["setting"]["jib_vertical_modes"]
    summary = summarise(case, result)
    assert summary["accuracy"] == found
    run_tables(summary)
    shown = capsys.readouterr().out
    for words in ("Error asked for: promised", "chosen ", "left out ", "jib tip deflection"):
        assert words in shown


def test_what_the_case_states_is_checked():
    case, result, found = promised(STATED, "accuracy.target=1e-4", "model.weight_softening=false")
    assert found["outcome"] == OUT_OF_REACH
    assert found["stated"] == ["atol", "jib_vertical_modes", "method", "rtol", "tower_modes", "weight_softening"]
    assert stated(case, scene_of(case))["jib_vertical_modes"] == 3
    assert result.attrs["rtol"] == 1e-8
    assert any("jib tip deflection" in reason and "wanted" in reason for reason in found["reasons"])
    assert any("softening" in part and "%" in part for part in found["left_out"])
    assert any("out of reach" in notice for notice in summarise(case, result)["notices"])


def test_a_run_that_ends_early_promises_nothing():
    _, result, found = promised("qtz5613/condition-4-zero", "accuracy.target=1e-2", "rope.slack=stop")
    assert result.attrs["outcome"] == "slack rope"
    assert found["outcome"] == CANNOT_BE_PROMISED
    assert any("ended early: slack rope" in reason for reason in found["reasons"])


def test_a_tower_that_buckles_is_named():
    result = run_case(load_case(OPEN, ["crane.tower.second_moment_of_area=0.00005 m^4", "run.duration=1 s"]))
    assert result.attrs["outcome"] == "tower buckled"


def test_verification_compares_with_a_richer_model(capsys):
    case, result, _ = promised(OPEN)
    report = verification(case, result)
    assert report["finer"]["jib_vertical_modes"] == report["setting"]["jib_vertical_modes"] + 4
    assert report["finer"]["rtol"] == pytest.approx(1e-8)
    scene = scene_of(case)
    assert finer(plane_setting(2, 3, rtol=1e-8), scene, foretold=True).rtol == pytest.approx(1e-10)
    for name in ("tower_tip_displacement", "jib_tip_deflection"):
        output = report["outputs"][name]
        assert 0.02 * output["estimated"] < output["actual"] < output["estimated"]
    verification_tables(report)
    assert "Run beside a richer model" in capsys.readouterr().out
    richer = finer(plane_setting(8, 14), scene, foretold=True)
    assert richer.counts == plane_setting(10, 18).counts


@pytest.mark.parametrize(
    ("name", "closest"),
    # The tapered tower's counter-jib bends: what is left out is measured there, not foretold.
    [("towers/laced", 0.05), ("towers/tapered", 0.01), (OPEN, 0.05)],
)
def test_verification_is_not_misled_by_fast_modes_of_the_richer_model(name, closest):
    case = load_case(name, ["run.duration=80 s", "accuracy.target=3e-2", 'accuracy.outputs=["hoist_rope_force"]'])
    found = verification(case, record_case(case))["outputs"]["hoist_rope_force"]
    assert closest * found["estimated"] < found["actual"] < found["estimated"]


def test_a_crane_of_segments_whose_counter_jib_bends_keeps_its_promise():
    case = load_case("flat-top/travel", ["run.duration=30 s", "accuracy.target=1e-2"])
    result = record_case(case)
    assert result.attrs["outcome"] == "finished"
    found = verification(case, result)
    assert all(own["actual"] < own["estimated"] < 0.02 * own["peak"] for own in found["outputs"].values())


def test_verify_on_the_command_line(tmp_path):
    arguments = ["run", STATED, "--verify", "--json", "--no-pictures", "--out", str(tmp_path), "--set", *SHORT]
    done = CliRunner().invoke(app, arguments)
    assert done.exit_code == 0
    report = json.loads(done.stdout)["verification"]
    for name in ("tower_tip_displacement", "jib_tip_deflection"):
        assert 0.0 < report["outputs"][name]["actual"] < report["outputs"][name]["estimated"]
    assert json.loads((tmp_path / "summary.json").read_text())["verification"] == report


def test_verify_knows_flexible_cranes_only(tmp_path, capsys):
    done = CliRunner().invoke(app, ["run", "jib-crane/plan", "--verify", "--out", str(tmp_path)])
    assert done.exit_code == 2
    assert "--verify: wanted a case of kind 'tower', got 'jib'" in done.stderr


def test_an_error_out_of_reach_is_not_what_was_asked_for(tmp_path):
    command = ["run", OPEN, "--no-pictures", "--out", str(tmp_path), "--set", "run.duration=5 s"]
    assert CliRunner().invoke(app, command).exit_code == 0
    done = CliRunner().invoke(app, [*command, "--set", "accuracy.target=1e-12"])
    assert done.exit_code == 1
    assert "error asked for: out of reach" in done.stderr


def test_interrupted_verification_keeps_the_run(tmp_path, monkeypatch):
    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("towercrane.accuracy.promise.verification", interrupted)
    done = CliRunner().invoke(app, ["run", OPEN, "--verify", "--out", str(tmp_path), "--set", "run.duration=5 s"])
    assert done.exit_code == 130
    assert "the run is kept, its verification is not" in done.stderr
    assert {path.name for path in tmp_path.iterdir()} == {"result.nc", "summary.json"}


def test_a_force_fits_the_tension_in_the_plane_and_in_space_only_outputs_that_are_named():
    assert targets_of(load_case(STATED, ['accuracy.target="50 N"'])) == {
        "hoist_rope_force": Tolerance(50.0, relative=False)
    }
    assert list(targets_of(load_case(STATED, ["accuracy.target=0.1"]))) == list(FORETOLD)
    force = 'accuracy.target="50 N"'
    named = load_case("qtz5613/manoeuvre", [force, 'accuracy.outputs=["hoist_rope_force"]'])
    assert targets_of(named) == {"hoist_rope_force": Tolerance(50.0, relative=False)}
    with pytest.raises(CaseError, match=r"(?s)accuracy\.target.*an error of motions where no outputs are named"):
        load_case("qtz5613/manoeuvre", [force])


@pytest.mark.parametrize(("target", "code"), [("3.5e-3", 1), ("2e-2", 0)])
def test_a_moment_in_space_is_promised_to_a_hundredth_of_its_peak_and_no_closer(target, code, tmp_path):
    """A richer model is 3.6e-3 of the peak off what is chosen for 3.5e-3, where 2.6e-3 are expected."""
    name = "jib_root_moment_sideways"
    targets = f"accuracy.target={{ {name} = {target} }}", f'accuracy.outputs=["{name}"]'
    options = [word for setting in targets for word in ("--set", setting)]
    done = towercrane("run", "qtz5613/manoeuvre-within-2e-2", "--no-pictures", "--out", str(tmp_path), *options)
    assert done.returncode == code
    said = " ".join(done.stdout.split())
    assert ("too little is known of jib root moment sideways" in said) is bool(code)
    # What small motions know nothing of has no number.
    assert "e-14" not in said
