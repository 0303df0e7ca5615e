"""Collars with play in a case's file: the crane that they make, what is said of it, and what is not promised."""

import json

import numpy as np
import pytest

from modal import Collar
from towercrane import load_case
from towercrane.accuracy.scene import scene_of
from towercrane.cases.case import case_folder
from towercrane.cases.models import model_of, motions_of
from towercrane.cranes.tower.equations.small_motions import leans_on
from towercrane.cranes.tower.file.build import crane_of
from towercrane.cranes.tower.file.requests import of_play
from towercrane.cranes.tower.modes.collars import TowerCollar
from towercrane.runs.run import record_case
from towercrane.simulation.simulate import simulate
from towercrane.simulation.starts.start import Start
from towercrane.studies.map_report import provenance
from towercrane.studies.natural import natural_frequencies
from towercrane.studies.space_modes import space_frequencies

LOOSE = "hard/collars-with-gaps"
GAP = 'gap = { value = "10 mm", assumed = "wedges not driven" }\n'


@pytest.fixture
def lower_alone(tmp_path):
    """The loose tower in still air without an earthquake, its upper collar without play; in the plane of its jib."""
    crane = (case_folder() / "hard" / "crane-with-gaps.toml").read_text("utf-8")
    lower, upper = crane.split("thirteenth floor")
    (tmp_path / "crane-with-gaps.toml").write_text(lower + "thirteenth floor" + upper.replace(GAP, "", 1), "utf-8")
    case = (case_folder() / f"{LOOSE}.toml").read_text("utf-8")
    begin, end = case.index("# Building"), case.index("[model]")
    path = tmp_path / "case.toml"
    path.write_text(case[:begin] + case[end:], "utf-8")
    return path


def test_a_collar_with_play_is_no_part_of_the_tower_that_stands_within_it(lower_alone):
    crane = crane_of(load_case(lower_alone).checked)
    assert crane.gapped == (TowerCollar(30.0, 40e6, gap=0.010),)
    assert list(crane.tower.collars.values()) == [Collar(40e6)]
    assert [(own.height, own.gap) for own in crane.collars] == [(30.0, 0.010), (55.0, 0.0)]
    # A shape more, for the one that has play.
    assert model_of(load_case(lower_alone)).crane.tower.count == 4


def test_natural_frequencies_say_that_they_do_not_feel_an_open_collar(lower_alone):
    open_ = (
        "the play of collar 1 (10 mm) is open: natural frequencies are of motions within it, which no collar feels"
    )
    case = load_case(lower_alone, ["modes.count=2", "modes.elements=4", "model.jib_vertical_modes=0"])
    for said in (natural_frequencies(case)["left_out"], json.loads(provenance(case)["left_out"])):
        assert said[-1] == open_
    run = record_case(load_case(lower_alone, ["run.duration=0.1 s"]))
    assert open_ in json.loads(run.attrs["notices"])


def test_in_space_they_are_of_the_tower_as_it_stands_and_say_which_collar_it_leans_on():
    said = space_frequencies(load_case(LOOSE, ["model.tower_modes=1"]))["left_out"]
    assert said == [
        "the play of collar 1 (10 mm) is open: natural frequencies are of motions within it, which no collar feels",
        "the play of collar 2 (10 mm) is used up at rest: natural frequencies are of motions that stay in contact",
    ]
    # A collar farther away than the tower leans.
    wide = load_case(LOOSE, ["crane.tower.collars.1.gap=0.3 m"])
    assert leans_on(model_of(wide), 30.0, 25.0) == []
    assert of_play(wide.checked) == [
        "the play of collars 1 (10 mm) and 2 (300 mm) is open: "
        "natural frequencies are of motions within it, which no collar feels"
    ]


def test_an_error_is_told_by_runs_of_richer_models_as_small_motions_know_no_contact(lower_alone):
    asked = ["accuracy.target=2e-2", 'accuracy.outputs=["sway_radial"]', "run.duration=10 s"]
    swings = ["start.sway_radial=0.1", "crane.tower.collars.0.gap=0.1 mm"]
    case = load_case(lower_alone, [*asked, *swings])
    assert scene_of(case).laddered
    assert not scene_of(case).foretells(["sway_radial"])
    run = record_case(case)
    assert np.count_nonzero(run["collar_1_force_x"].values) > 20
    said = json.loads(run.attrs["accuracy"])
    assert said["outcome"] == "promised"
    assert any("a run with more" in sentence for sentence in said["left_out"])


@pytest.mark.parametrize("name", ["luffing/manoeuvre", "hammerhead/manoeuvre"])
def test_jibs_that_pivot_or_hang_on_ties_let_their_towers_meet_collars(name):
    few = [f"model.{kind}_modes={count}" for kind, count in
           (("tower", 1), ("torsion", 0), ("jib_lateral", 0), ("jib_vertical", 1))]  # fmt: skip
    collar = 'crane.tower.collars=[{height="20 m", stiffness="20 MN/m", gap="2 mm"}]'
    case = load_case(name, [collar, *few])
    model = model_of(case)
    run = simulate(model, motions_of(case, model), 2.0, start=Start("zero"), output_step=0.02, rtol=1e-11, atol=1e-13)
    energy, work = run["total_energy"].values, run["input_work"].values
    assert np.max(abs(energy - energy[0] - work)) < 1e-11 * np.max(abs(work))
    push = np.hypot(run["collar_1_force_x"], run["collar_1_force_y"]).values
    assert np.count_nonzero(np.diff(push > 0.0)) > 3
