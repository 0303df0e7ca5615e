"""Error-controlled runs in space: what is expected against what richer models find, and what a case says of it."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
from samples.space_crane import CRANE, manoeuvre, standing
from typer.testing import CliRunner

from towercrane import load_case
from towercrane.accuracy.mode_choice import measured_choice
from towercrane.accuracy.promise import CANNOT_BE_PROMISED, KEPT, OUT_OF_REACH, finer, verification
from towercrane.accuracy.scene import Scene, scene_of
from towercrane.cases.models import targets_of
from towercrane.cli import app
from towercrane.cranes.parts.wind import WindAreas, gusts
from towercrane.cranes.tower.modes.damping import ModalDamping
from towercrane.cranes.tower.targets import MOTIONS
from towercrane.kernels.load import Load
from towercrane.motions.profiles import trapezoid
from towercrane.report.tables.runs import run_tables, verification_tables
from towercrane.results.measures import gap, peak
from towercrane.runs.run import record_case, run_case
from towercrane.runs.summary import summarise
from towercrane.schema.faults import CaseError
from towercrane.schema.targets import Tolerance
from towercrane.simulation.starts.start import Start

NAME = "qtz5613/manoeuvre-within-2e-2"
SHORT = ["run.duration=25 s", "run.output_step=0.1 s"]

SLEW = Scene(CRANE, Load(1500.0), manoeuvre(), 40.0, 0.1)
GUSTS = gusts(4.0, np.array([[3.0, 8.0, 0.0], [9.0, 2.0, 0.5], [-4.0, 6.0, 0.0], [5.0, -5.0, 0.0], [0.0, 0.0, 0.0]]))
SCENES = {
    "manoeuvre": SLEW,
    "turn": replace(SLEW, motions={**standing(30.0, 15.0), "slewing": manoeuvre()["slewing"]}),
    "gusts": replace(
        SLEW,
        load=Load(1500.0, drag_area=6.0),
        motions=standing(40.0, 12.0) | GUSTS,
        areas=WindAreas(tower=0.5, jib=0.3, counter_jib=0.3, counterweight=4.0),
        damping=ModalDamping(0.01, 0.01, 0.01, 0.01),
    ),
}
PLANE = replace(
    SLEW,
    motions={**standing(20.0, 12.0), "trolley": trapezoid(20.0, 35.0, 0.8, 0.2)},
    start=Start(along=0.05),
    duration=30.0,
    planar=True,
)


def every(target, names=MOTIONS):
    return {name: Tolerance(target, relative=True) for name in names}


def actual(scene, setting, result):
    better = scene.run(finer(setting, scene, foretold=False))
    return {name: gap(result, better, name) for name in scene.outputs}


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("target", [0.1, 0.01])
def test_the_run_keeps_the_target_and_the_estimate_bounds_it_closely(name, target):
    scene = SCENES[name]
    choice, result = measured_choice(scene, every(target, ("payload_position", "sway_tangential")))
    assert choice.kept
    assert not choice.doubts
    estimated = dict(zip(scene.outputs, choice.estimate.errors(choice.peaks), strict=True))
    found = actual(scene, choice.setting, result)
    for output in ("payload_position", "sway_tangential"):
        assert 0.5 < estimated[output] / found[output] < 15.0
        assert 0.005 * target < found[output] / peak(result, output) < target


def test_less_error_takes_more_modes_and_the_kinds_that_matter_first():
    loose, tight = (measured_choice(SLEW, every(target))[0].setting.counts for target in (0.2, 0.01))
    assert all(tight[kind] >= count for kind, count in loose.items())
    assert sum(tight.values()) > sum(loose.values())
    heights = measured_choice(PLANE, every(0.3, ("jib_tip_deflection",)))[0].setting
    assert (heights.tower_modes, heights.jib_vertical_modes) == (0, 1)


def test_a_scene_that_stays_in_the_plane_is_integrated_there():
    moving = [name for name in MOTIONS if name in PLANE.outputs]
    choice, _ = measured_choice(PLANE, every(0.01, moving))
    assert choice.setting.planar
    assert (choice.setting.torsion_modes, choice.setting.jib_lateral_modes) == (0, 0)
    assert any("out of it" in part for part in choice.left_out)
    planar = choice.setting.tightened(1e-5)
    runs = [PLANE.run(replace(planar, planar=flat)) for flat in (True, False)]
    for output in PLANE.outputs:
        assert gap(*runs, output) < 1e-10 * max(peak(runs[0], output), 1.0)
    assert len(moving) == 4
    assert scene_of(load_case("qtz5613/condition-3")).planar
    assert not scene_of(load_case(NAME)).planar


def test_a_crane_without_data_for_its_sides_says_so():
    bare = replace(SLEW, crane=replace(CRANE, shaft=None, jib_lateral=None))
    choice, _ = measured_choice(bare, every(0.1))
    assert choice.setting.counts["torsion_modes"] == choice.setting.counts["jib_lateral_modes"] == 0
    assert sum("does not describe it" in part for part in choice.left_out) == 2


def test_what_is_stated_is_kept_and_judged():
    stated = {"tower_modes": 1, "torsion_modes": 1, "jib_lateral_modes": 0, "jib_vertical_modes": 1, "rtol": 1e-7}
    choice, result = measured_choice(SLEW, every(0.01), stated)
    assert {key: getattr(choice.setting, key) for key in stated} == stated
    assert not choice.kept
    found = actual(SLEW, choice.setting, result)
    estimated = dict(zip(SLEW.outputs, choice.estimate.errors(choice.peaks), strict=True))
    # A jib that is rigid to its sides is far from what small motions are about.
    assert 1.0 < estimated["payload_position"] / found["payload_position"] < 12.0


def test_an_unknown_output():
    with pytest.raises(ValueError, match=r"targets: wanted some of payload_position.*got swing_angle"):
        measured_choice(SLEW, every(0.1, ("swing_angle",)))


def test_targets_of_a_case_in_space():
    def targets(*changes):
        return targets_of(load_case(NAME, [*SHORT, *changes]))

    assert set(targets()) == {"payload_position", "sway_radial", "sway_tangential", "slewing_torque"}
    whole = targets_of(load_case("qtz5613/manoeuvre", ["accuracy.target=0.01"]))
    assert list(whole) == list(MOTIONS)
    lengths = targets_of(load_case("qtz5613/manoeuvre", ['accuracy.target="5 cm"']))
    assert lengths["payload_position"] == Tolerance(pytest.approx(0.05), relative=False)
    assert "sway_radial" not in lengths
    assert targets('accuracy.target="5 kN m"', 'accuracy.outputs=["slewing_torque"]') == {
        "slewing_torque": Tolerance(5000.0, relative=False)
    }
    with pytest.raises(CaseError, match="an error of sway_radial in rad"):
        targets('accuracy.target="5 cm"')


def test_a_case_says_what_it_chose_and_a_richer_model_agrees(capsys):
    case = load_case(NAME, SHORT)
    result = record_case(case)
    found = json.loads(result.attrs["accuracy"])
    assert found["outcome"] == KEPT
    assert found["stated"] == []
    assert len(found["left_out"]) == 4
    assert any(part.startswith("torsion of the tower beyond 1 mode: ") for part in found["left_out"])
    for output in found["outputs"].values():
        assert 0.0 < output["estimated"] <= output["allowed"] == pytest.approx(0.02 * output["peak"])
    report = verification(case, result)
    assert report["finer"]["jib_lateral_modes"] == found["setting"]["jib_lateral_modes"] + 2
    for name in found["outputs"]:
        assert 0.0 < report["outputs"][name]["actual"] < found["outputs"][name]["allowed"]
    summary = summarise(case, result)
    assert {"torsion", "radial sway"} <= set(summary["natural_kinds"])
    run_tables(summary)
    verification_tables(report)
    shown = capsys.readouterr().out
    for words in ("Error asked for: promised", "1 torsion, ", "Run beside a richer model"):
        assert words in shown


def test_modes_that_a_case_states_are_checked():
    case = load_case(NAME, [*SHORT, "model.torsion_modes=0", "model.weight_softening=false"])
    found = json.loads(run_case(case).attrs["accuracy"])
    assert found["outcome"] == OUT_OF_REACH
    assert found["stated"] == ["torsion_modes", "weight_softening"]
    assert found["setting"]["torsion_modes"] == 0
    assert any("payload position" in reason and "wanted" in reason for reason in found["reasons"])
    assert any("softening" in part for part in found["left_out"])


def test_a_run_that_ends_early_promises_nothing():
    case = load_case("hard/space-gust-slackens-the-rope", ["accuracy.target=0.1"])
    found = json.loads(run_case(case).attrs["accuracy"])
    assert found["outcome"] == CANNOT_BE_PROMISED
    assert any("slack rope" in reason for reason in found["reasons"])


def test_a_tower_that_buckles_is_named():
    result = run_case(load_case(NAME, ["crane.tower.second_moment_of_area=0.00005 m^4", "run.duration=1 s"]))
    assert result.attrs["outcome"] == "tower buckled"


def test_verify_on_the_command_line(tmp_path):
    arguments = ["run", NAME, "--verify", "--json", "--no-pictures", "--out", str(tmp_path)]
    done = CliRunner().invoke(app, [*arguments, *(part for change in SHORT for part in ("--set", change))])
    assert done.exit_code == 0
    report = json.loads(done.stdout)
    for name, output in report["accuracy"]["outputs"].items():
        assert report["verification"]["outputs"][name]["actual"] < output["allowed"]
