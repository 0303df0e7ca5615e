"""Runs that go on from the saved end of another."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples import jointed_jib
from samples.qtz5613 import CRANE, in_plane

from towercrane import Load, load_case
from towercrane.cases.models import model_of, motions_of
from towercrane.cases.result_case import start_of
from towercrane.kernels.elastic_rope import Elasticity
from towercrane.linear.linearise import linearise
from towercrane.motions.motion import phases, rest
from towercrane.motions.profiles import trapezoid
from towercrane.results import files
from towercrane.results.files import load, save
from towercrane.runs.run import record_case
from towercrane.runs.variants import Variants
from towercrane.schema.faults import CaseError
from towercrane.simulation.integrate import integrate
from towercrane.simulation.outcomes import ON_THE_GROUND, ROPE_SLACK, SLACK_ROPE
from towercrane.simulation.simulate import record
from towercrane.simulation.starts.begin import begin
from towercrane.simulation.starts.end import end_of, leaps, other_side
from towercrane.simulation.starts.start import Start
from towercrane.simulation.system import NoEquilibrium
from towercrane.studies.linear_report import linear_model

FEW = ["model.tower_modes=1", "model.jib_vertical_modes=1"]
TIGHT = ["solver.rtol=1e-10", "solver.atol=1e-12"]
OUT = ["motion.trolley.start=10 m", "motion.trolley.end=13 m", "motion.trolley.speed=1 m/s"]
STANDS = ["motion.trolley={shape='rest', start='13 m'}"]
PLANE = "qtz5613/condition-3"


@pytest.fixture(scope="module")
def ended(tmp_path_factory):
    """Result of a run of six seconds in which the trolley comes to rest, and the run itself."""
    run = record_case(
        load_case(PLANE, [*FEW, *TIGHT, *OUT, "motion.trolley.acceleration=1 m/s^2", "run.duration=6 s"])
    )
    path = tmp_path_factory.mktemp("ended") / "result.nc"
    save(run, path)
    return path, run


def going_on(path, changes=(), stands=STANDS):
    return load_case(PLANE, [*FEW, *TIGHT, *stands, "run.duration=5 s", f"start.from={path}", *changes])


def test_a_run_goes_on_to_the_last_bit_and_is_the_run_that_never_stopped(ended):
    path, before = ended
    after = record_case(going_on(path))
    cut = phases(tuple(after.motions[channel] for channel in after.model.channels), 5.0)
    straight = integrate(after.model.system, cut, before.attrs["end_state"], np.array([5.0]), rtol=1e-10, atol=1e-12)
    assert np.array_equal(after.attrs["end_state"], straight.end_state)
    whole = record_case(
        load_case(PLANE, [*FEW, *TIGHT, *OUT, "motion.trolley.acceleration=1 m/s^2", "run.duration=11 s"])
    )
    size = np.where(np.isfinite(after.model.system.scale), after.model.system.scale, 1.0)
    gap = abs(after.attrs["end_state"] - whole.attrs["end_state"])[:-1] / size[:-1]
    assert gap.max() < 3e-10
    place = after["payload_position"].values[-1] - whole["payload_position"].values[-1]
    assert np.max(abs(place)) < 3e-12
    assert_allclose(after["input_work"].values[-1], whole["input_work"].values[-1], rtol=1e-8)
    assert "after 6 s" in after.attrs["notices"]


def test_lanes_go_on_too(ended):
    path, before = ended
    variants = Variants(going_on(path), {"payload.drag_area": ["1 m^2", "3 m^2"]})
    for number in range(2):
        state, refusal = variants[number].run.start()
        assert np.array_equal(state, before.attrs["end_state"])
        assert not refusal


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        (["start.from=nowhere.nc"], ["a result.nc of `towercrane run`, nowhere.nc", "No such file"]),
        (["crane.jib.length=50 m"], ["a run of this crane", "crane.jib.length = 55.6", "50.0"]),
        (["model.jib_vertical_modes=2"], ["a run in these modes", "jib_vertical_mode_2"]),
        (["rope.stiffness=14 MN"], ["on this rope", "another rope", "[14000000.0"]),
        (["motion.trolley.start=11 m"], ["motions that begin as", "trolley at 13 m, not 11 m"]),
        (["rope.length=17 m"], ["motions that begin as", "rope at 18 m, not 17 m"]),
    ],
)
def test_what_does_not_fit_is_told_in_one_message(ended, changes, words):
    path, _ = ended
    case = going_on(path, changes)
    model = model_of(case)
    with pytest.raises(CaseError) as caught:
        start_of(case, model, motions_of(case))
    (fault,) = caught.value.faults
    assert fault.key == "start.from"
    for word in words:
        assert word in str(fault)


@pytest.mark.parametrize(
    ("changes", "got"),
    [
        (["start.sway_radial=1 deg", "start.state=zero"], "state, sway_radial beside it"),
        (["accuracy.target=1e-3"], "[accuracy], which chooses some"),
    ],
)
def test_nothing_else_says_how_a_run_begins_that_goes_on(changes, got):
    with pytest.raises(CaseError) as caught:
        going_on("result.nc", changes)
    (fault,) = caught.value.faults
    assert (fault.key, fault.got) == ("start.from", got)


def test_modes_of_another_sign_and_ends_that_are_none_are_refused(ended, monkeypatch):
    path, before = ended
    result, case = load(path), going_on(path)
    others = [
        ("end", result.attrs["end"].replace('"basis": [', '"basis": [-'), "modes of other shapes or signs"),
        ("outcome", "slack rope", 'one that ended as "slack rope"'),
        ("end_state", np.full_like(result.attrs["end_state"], np.nan), "finite states"),
        ("end", None, "one that does not hold its end"),
    ]
    for attribute, value, said in others:
        attrs = {k: v for k, v in result.attrs.items() if k != attribute}
        if value is not None:
            attrs[attribute] = value
        monkeypatch.setattr(files, "load", lambda _, attrs=attrs: result.drop_attrs().assign_attrs(attrs))
        with pytest.raises(CaseError, match=said):
            start_of(case, before.model, before.motions)


def test_another_model_of_the_crane_does_not_go_on(ended):
    case = going_on(ended[0])
    model = model_of(case, tower_modes=2)
    with pytest.raises(CaseError, match="a run in these modes"):
        record_case(case, model=model)
    with pytest.raises(ValueError, match=r"saved: wanted 11 states, got 2"):
        record(model, motions_of(case), 1.0, start=Start(saved=(0.0, 1.0)))


def test_a_crane_may_be_renamed_and_its_load_changed(ended):
    case = going_on(ended[0], ["crane.name=another", "payload.mass=900 kg", "run.duration=1 s"])
    run = record_case(case)
    assert run.attrs["outcome"] == "finished"
    assert run["hoist_rope_force"].values[0] == pytest.approx(900 * 9.81, rel=0.02)


def test_a_trolley_between_two_sections_goes_on_where_it_came_from_alone():
    model = jointed_jib.model(True)
    joint = float(model.constants.sections[2])
    out = {"trolley": trapezoid(joint - 0.3, joint, 0.5, 0.5), "rope": rest(9.0)}
    end = end_of(model, out, 2.0)
    for onward, other in ((rest(joint), True), (trapezoid(joint, joint - 0.2, 0.5, 0.5), False)):
        assert other_side(end, model, {**out, "trolley": onward}) is other


@pytest.mark.parametrize(("rope", "outcome"), [(None, SLACK_ROPE), (Elasticity(14e6, 32.5), ROPE_SLACK)])
def test_linear_models_are_of_no_state_in_which_a_rope_is_slack(rope, outcome):
    model = in_plane(CRANE, Load(800.0, elasticity=rope), 1, 1)
    motions = {"trolley": rest(20.0), "rope": rest(12.0)}
    inputs = phases(tuple(motions.values()), 1.0).inputs[0]
    with pytest.raises(NoEquilibrium) as caught:
        linearise(model, motions, state=begin(model, inputs, Start(along=2.0)), outputs=[])
    assert caught.value.outcome == outcome


def test_a_load_that_flies_goes_on_flying():
    model = in_plane(CRANE, Load(800.0, elasticity=Elasticity(14e6, 32.5, 3e-3)), 1, 1)
    motions = {"trolley": rest(20.0), "rope": rest(12.0)}
    tight = {"rtol": 1e-10, "atol": 1e-12, "output_step": 0.1}
    before = record(model, motions, 0.4, start=Start(along=2.0, along_rate=0.2), **tight)
    assert before["hoist_rope_force"].values[-1] == 0.0
    after = record(model, motions, 3.0, start=Start(saved=tuple(before.attrs["end_state"].tolist())), **tight)
    whole = record(model, motions, 3.4, start=Start(along=2.0, along_rate=0.2), **tight)
    assert whole["hoist_rope_force"].values.max() > 8e3
    gap = after["payload_position"].values - whole["payload_position"].values[4:]
    assert np.max(abs(gap)) < 1e-8


def test_a_run_in_the_plane_goes_on_in_space_and_one_in_space_stays_there(ended, tmp_path):
    path, _ = ended
    turns = "motion.slewing={shape='speed-trapezoid', speed='0.5 rpm', ramp='2 s', hold='1 s'}"
    few = ["model.jib_lateral_modes=1", "model.torsion_modes=1"]
    case = going_on(path, [*few, turns, "run.duration=3 s"])
    run = record_case(case)
    assert run.model.axes == 3
    flat = record_case(going_on(path, ["run.duration=3 s"]))
    for name in (
        "sway_radial",
        "tower_tip_displacement",
        "jib_tip_deflection",
        "payload_position",
        "hoist_rope_force",
    ):
        assert_allclose(run[name].values[0], flat[name].values[0], rtol=1e-11, atol=1e-11, err_msg=name)
    assert abs(run["sway_tangential"].values).max() > 1e-3
    save(run, tmp_path / "result.nc")
    angle = float(run["slewing_angle"].values[-1])
    stands = f"motion.slewing={{shape='rest', start={angle!r}}}"
    moving = going_on(tmp_path / "result.nc", [*few, stands, "run.duration=1 s"])
    with pytest.raises(CaseError, match=r"slewing at .* rad/s, not 0 rad/s"):
        record_case(moving)
    calm = f"motion.slewing={{shape='speed-trapezoid', start={angle!r}, start_speed='0.5 rpm', speed='0.2 rpm', "
    again = record_case(
        going_on(tmp_path / "result.nc", [*few, calm + "ramp='1 s', hold='1 s'}", "run.duration=1 s"])
    )
    assert again.model.axes == 3
    assert_allclose(again["sway_tangential"].values[0], run["sway_tangential"].values[-1], rtol=1e-12)


def test_a_head_that_is_free_goes_on_where_it_is_whatever_its_motion_says():
    case = load_case("qtz5613/weathervane", [*FEW, "model.jib_lateral_modes=1"])
    model, motions = model_of(case), motions_of(case)
    end = end_of(model, motions, 0.0)
    assert set(end["drives"]) == {"trolley", "rope"}
    assert not list(leaps(end, model, {**motions, "slewing": rest(1.0)}))


def test_a_load_on_the_ground_has_no_linear_model_and_no_turning_start():
    few = ["model.tower_modes=1", "model.jib_vertical_modes=1"]
    with pytest.raises(NoEquilibrium) as caught:
        linear_model(load_case("qtz5613/lift-off", few), 0.0)
    assert caught.value.outcome == ON_THE_GROUND
    turns = "motion.slewing={shape='speed-trapezoid', speed='1 rpm', start_speed='1 rpm', ramp='2 s', hold='1 s'}"
    with pytest.raises(CaseError) as refused:
        load_case("qtz5613/lift-off", [*few, turns])
    (fault,) = refused.value.faults
    assert fault.key == "start.slack"
