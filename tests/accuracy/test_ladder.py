"""Error-controlled runs of cranes on ties and with a jib that pivots: what a ladder of runs promises, and says."""

import json
from dataclasses import replace

import numpy as np
import pytest
from samples import luffing_crane

from towercrane import load_case
from towercrane.accuracy.ladder import RUNG, SAFETY, laddered_choice
from towercrane.accuracy.promise import AS_ASKED, KEPT, OUT_OF_REACH, finer, settle, targets_of, verification
from towercrane.accuracy.scene import Scene
from towercrane.accuracy.setting import Setting
from towercrane.cases.models import model_of, poses_of
from towercrane.cranes.tower.modes.damping import ModalDamping
from towercrane.cranes.tower.targets import ALL, ANY_MOTION
from towercrane.kernels.load import Load
from towercrane.motions.motion import rest
from towercrane.motions.profiles import trapezoid
from towercrane.results.measures import gap, peak
from towercrane.runs.run import record_case
from towercrane.schema.faults import CaseError
from towercrane.schema.targets import Tolerance

PLANE = {"duration": 5.0, "output_step": 0.1, "planar": True, "damping": ModalDamping(0.01, 0.01, 0.01, 0.01)}
LUFFING = ["run.duration=6 s", "run.output_step=0.1 s", "motion.slewing.speed=0 rad/s", "motion.hoist.delay=10 s"]


def luffed(rng):
    """A drawn luffing move in the jib's plane."""
    start, end = np.radians(rng.uniform(25.0, 75.0, 2))
    move = trapezoid(start, end, np.radians(rng.uniform(1.0, 2.0)), np.radians(rng.uniform(0.5, 1.0)))
    motions = {"luffing": move, "rope": rest(float(rng.uniform(8.0, 30.0)))}
    crane = luffing_crane.crane(reference_angle=float(start))
    return Scene(crane, Load(rng.uniform(1000.0, 5000.0)), motions, **PLANE)


def every(target, scene):
    return {name: Tolerance(target, relative=True) for name in scene.outputs if name in ANY_MOTION}


@pytest.mark.parametrize("target", [5e-3, 3e-2])
def test_a_promise_of_a_drawn_scene_holds_against_a_model_that_is_two_rungs_richer(target):
    scene = luffed(np.random.default_rng(int(1e3 * target)))
    choice, run = laddered_choice(scene, every(target, scene))
    assert (choice.kept, choice.doubts, run.attrs["outcome"]) == (True, (), "finished")
    richer = scene.run(finer(choice.setting, scene, foretold=False, rungs=2))
    wanted = every(target, scene)
    peaks = {name: peak(richer, name) for name in wanted}
    errors = {name: gap(run, richer, name) for name in wanted}
    expected = dict(zip(scene.outputs, choice.estimate.errors(choice.peaks), strict=True))
    assert max(errors[name] / peaks[name] for name in wanted) < target
    assert all(errors[name] <= expected[name] for name in wanted)
    # No promise is had by expecting far too much.
    assert max(errors[name] / expected[name] for name in wanted) > 0.2


def test_what_is_expected_is_what_the_next_rung_finds_and_what_is_stated_stays():
    scene = luffed(np.random.default_rng(5))
    given = {"tower_modes": 2, "jib_vertical_modes": 2, "rtol": 1e-7, "atol": 1e-9}
    choice, run = laddered_choice(scene, every(1e-6, scene), given)
    assert {key: getattr(choice.setting, key) for key in given} == given
    assert (choice.kept, choice.tried) == (False, 2)
    richer = scene.run(finer(choice.setting, scene, foretold=False))
    found = np.array([gap(run, richer, name) for name in scene.outputs])
    assert np.allclose(choice.estimate.truncation, SAFETY * found, rtol=1e-3, atol=1e-9)
    assert "a run with more, 3 of bending of the tower, 4 of bending of the jib up and down" in choice.left_out[0]


def test_a_ladder_that_does_not_help_ends_on_its_lowest_rung():
    """A tower that is stated to be rigid is what is wrong, however many modes the jib has."""
    scene = luffed(np.random.default_rng(5))
    choice, _ = laddered_choice(scene, every(1e-4, scene), {"tower_modes": 0})
    assert (choice.kept, choice.tried, choice.setting.jib_vertical_modes) == (False, 4, 1)


def test_a_crane_is_drawn_in_the_modes_that_were_picked_of_its_counter_jib_too():
    case = load_case("hammerhead/travel", ["run.duration=0.5 s"])
    picked = {"tower_modes": 1, "jib_vertical_modes": 1, "counter_jib_vertical_modes": 1}
    run = record_case(case, model=model_of(case, **picked))
    run.attrs["accuracy"] = json.dumps({"setting": Setting(planar=True).with_counts(picked).provenance()})
    times = np.array([0.0, 0.3])
    drawn, known = (poses_of(case, run, times, model) for model in (None, run.model))
    assert drawn.members.keys() == known.members.keys()
    assert all(np.array_equal(line, known.members[name]) for name, line in drawn.members.items())


def test_rungs_are_richer_in_every_kind_that_the_crane_has():
    scene = replace(luffed(np.random.default_rng(5)), planar=False)
    assert scene.laddered
    assert not scene.foretells(["sway_radial"])
    kinds = {"tower_modes", "torsion_modes", "jib_lateral_modes", "jib_vertical_modes"}
    assert set(scene.described) == kinds
    once, twice = (finer(Setting(), scene, foretold=False, rungs=rungs).counts for rungs in (1, 2))
    assert all(once[kind] == RUNG[kind] and twice[kind] == 2 * RUNG[kind] for kind in kinds)


def test_a_case_promises_and_a_verification_two_rungs_up_decides():
    case = load_case("luffing/manoeuvre", [*LUFFING, "accuracy.target=2e-2"])
    assert {"luffing_angle", "jib_deflection"} <= set(targets_of(case))
    assert not {"jib_tip_deflection", "slewing_torque"} & set(targets_of(case))
    run = record_case(case)
    said = json.loads(run.attrs["accuracy"])
    assert said["outcome"] in (KEPT, OUT_OF_REACH)
    report = verification(case, run)
    assert (
        report["finer"]["jib_vertical_modes"]
        == said["setting"]["jib_vertical_modes"] + 2 * RUNG["jib_vertical_modes"]
    )
    assert report["outputs"]["sway_radial"]["estimated"] == said["outputs"]["sway_radial"]["estimated"]
    assert report["outputs"]["luffing_rope_force"]["estimated"] is None
    settle(run, report)
    assert json.loads(run.attrs["accuracy"])["outcome"] in AS_ASKED


def test_a_run_without_a_target_is_verified_by_the_next_rung():
    case = load_case("luffing/manoeuvre", LUFFING)
    report = verification(case, record_case(case))
    assert (report["outcome"], report["doubts"]) == ("finished", [])
    assert [report["finer"][kind] for kind in ("tower_modes", "jib_vertical_modes")] == [3, 4]
    assert all(found["estimated"] is None and found["actual"] > 0.0 for found in report["outputs"].values())


def test_a_trolley_on_a_jib_on_ties_keeps_its_promise():
    """Small motions of the counter-jib that its ties do not bend are among what the richer models have."""
    few = ["tower_modes=1", "jib_vertical_modes=1", "counter_jib_vertical_modes=0"]
    outputs = ["payload_position", "tower_tip_displacement", "jib_tie_1_tension"]
    changes = ["run.duration=2 s", "accuracy.target=0.3", f"accuracy.outputs={outputs}"]
    case = load_case("hammerhead/travel", [*changes, *(f"model.{count}" for count in few)])
    run = record_case(case)
    assert json.loads(run.attrs["accuracy"])["outcome"] == KEPT
    report = verification(case, run)
    kinds = "tower_modes", "jib_vertical_modes", "counter_jib_vertical_modes"
    assert [report["finer"][kind] for kind in kinds] == [3, 5, 2]
    for name in outputs:
        found = report["outputs"][name]
        assert 0.2 * found["estimated"] < found["actual"] < found["estimated"], name
    assert not {"jib_tie_3_tension", "jib_root_moment", "luffing_angle"} & report["outputs"].keys()


def test_a_force_is_no_target_without_its_output():
    with pytest.raises(CaseError) as refused:
        load_case("hammerhead/travel", ["accuracy.target=1 kN"])
    assert "names the forces" in refused.value.faults[0].hint
    assert len(targets_of(load_case("hammerhead/travel", ["accuracy.target=1e-2"]))) == 4


@pytest.mark.parametrize(
    ("name", "asked", "said"),
    [
        ("luffing/manoeuvre", "jib_tip_deflection", "jib_deflection"),
        ("hammerhead/manoeuvre", "jib_tie_3_tension", "jib_tie_2_tension"),
        ("hammerhead/travel", "jib_root_moment", "jib_compression"),
        ("qtz5613/condition-3", "luffing_angle", "jib_tip_deflection"),
    ],
)
def test_outputs_that_such_a_crane_has_not_are_refused_with_those_that_it_has(name, asked, said):
    assert {asked, said} <= ALL.keys()
    with pytest.raises(CaseError) as refused:
        load_case(name, ["accuracy.target=1e-2", f'accuracy.outputs=["{asked}"]'])
    (fault,) = refused.value.faults
    offered = fault.wanted.removeprefix("one of ").split(", ")
    assert (fault.key, said in offered, asked in offered) == ("accuracy.outputs", True, False)
    assert "no such output" in fault.hint
