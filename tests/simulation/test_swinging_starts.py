"""Loads that swing as a run begins: both sways and their rates are what the outputs then show."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples.every_kind import KINDS, lumped

from towercrane import load_case
from towercrane.accuracy.scene import scene_of
from towercrane.cases.models import model_of
from towercrane.cases.result_case import start_of
from towercrane.motions.motion import Motion, phases, rest
from towercrane.schema.faults import CaseError
from towercrane.simulation.simulate import record
from towercrane.simulation.starts.begin import begin, rope_direction
from towercrane.simulation.starts.start import Start

SWAYS = {
    "radial": ("sway_radial", None),
    "prescribed slewing": ("sway_radial", "sway_tangential"),
    "basic": ("sway_radial", "sway_tangential"),
    "planned jib crane": ("sway_in_plane", "sway_lateral"),
    "overhead crane": ("sway_along_runway", "sway_along_bridge"),
}
"""Outputs of each kind along and across its jib."""

STEP = 2e-4
ONE_SIDED = np.array([-25.0, 48.0, -36.0, 16.0, -3.0]) / (12.0 * STEP)


@pytest.mark.parametrize("kind", SWAYS)
def test_sways_and_their_rates_are_what_the_outputs_show(kind):
    scene, (along, across) = KINDS[kind](), SWAYS[kind]
    motions = {name: rest(float(motion(0.0))) for name, motion in scene.motions.items()}
    if scene.turned:
        # Rates are those that a turning head sees.
        motions[scene.turned] = Motion(np.array([0.0, 9.0]), np.array([[0.4, 0.07]]))
        motions |= {name: rest(0.0) for name in motions if name.startswith("wind")}
    wanted = Start(along=-0.3, along_rate=0.2)
    if across:
        wanted = Start(along=-0.3, across=0.2, along_rate=0.2, across_rate=-0.1)
    run = record(scene.model, motions, 4 * STEP, output_step=STEP, start=wanted, rtol=1e-12, atol=1e-14)
    assert_allclose([run[along].values[0], run[along].values @ ONE_SIDED], [-0.3, 0.2], rtol=1e-7)
    if across:
        assert_allclose([run[across].values[0], run[across].values @ ONE_SIDED], [0.2, -0.1], rtol=1e-7)
        # What is not stated is as it hangs.
        one = record(scene.model, motions, STEP, output_step=STEP, start=Start(across=0.2))
        hung = record(scene.model, motions, STEP, output_step=STEP)
        assert_allclose(one[along].values[0], hung[along].values[0], atol=1e-13)


@pytest.mark.parametrize("kind", ["radial", "prescribed slewing", "basic", "multi-mass", "overhead crane"])
def test_a_quiet_structure_is_not_accelerated_by_the_load_that_swings(kind):
    scene = KINDS[kind]()
    inputs = phases(tuple(rest(float(scene.motions[c](0.0))) for c in scene.model.channels), 1.0).inputs[0]
    swing = {"along": 0.3, "along_rate": 0.4, "across": None if kind == "radial" else -0.2}
    loud, state = (begin(scene.model, inputs, Start(name, **swing)) for name in ("equilibrium", "quiet"))
    half, axes = len(state) // 2, 2 if kind == "radial" else 3
    structure = slice(half, 2 * half - axes)
    slopes = [scene.model.system.slope(0.0, own, inputs)[0][structure] for own in (loud, state)]
    assert np.max(abs(slopes[0])) > 0.1
    assert np.max(abs(slopes[1])) < 1e-9
    assert np.all(state[structure] == 0.0)
    seen = [rope_direction(scene.model, own, inputs) for own in (loud, state)]
    assert_allclose(seen[1], seen[0], atol=1e-14)


def test_an_elastic_rope_of_a_quiet_crane_pulls_as_one_that_does_not_stretch():
    elastic = lumped("basic").model
    stiff = replace(elastic, crane=replace(elastic.crane, rope=None))
    start = Start("quiet", along=0.3, across=-0.2, along_rate=0.4)
    inputs = phases((rest(0.4), rest(2.0)), 1.0).inputs[0]
    state = begin(elastic, inputs, start)
    load = slice(elastic.rope, elastic.rope + 3)
    reach = float(np.linalg.norm(state[load] - np.array(elastic.suspended(state, inputs).place)))
    assert 2.0002 < reach < 2.002
    as_long = phases((rest(0.4), rest(reach)), 1.0).inputs[0]
    other = begin(stiff, as_long, start)
    assert_allclose(state[: elastic.rope], other[: stiff.rope], rtol=1e-9, atol=1e-13)
    pulls = [
        float(model.system.slope(0.0, own, given)[1][0])
        for model, own, given in ((elastic, state, inputs), (stiff, other, as_long))
    ]
    assert_allclose(pulls[0], pulls[1], rtol=1e-9)


def test_a_case_names_the_sways_as_its_kind_does():
    names = {
        "qtz5613/slewing": ("sway_radial", "sway_tangential"),
        "slewing/basic/example-1": ("sway_radial", "sway_tangential"),
        "jib-crane/plan": ("sway_in_plane", "sway_lateral"),
        "overhead-crane/travel": ("sway_along_runway", "sway_along_bridge"),
    }
    for name, (along, across) in names.items():
        values = {along: "2 deg", across: "-1 deg", f"{along}_rate": "0.1 rad/s", f"{across}_rate": "1 deg/s"}
        case = load_case(name, [f"start.{key}={value}" for key, value in values.items()])
        found = start_of(case)
        assert_allclose(np.rad2deg([found.along, found.across]), [2.0, -1.0])
        assert_allclose([found.along_rate, np.rad2deg(found.across_rate)], [0.1, 1.0])


def test_a_load_that_swings_across_the_jib_leaves_its_plane():
    plane = ["motion.trolley.end=12 m", "model.tower_modes=1", "model.jib_vertical_modes=1"]
    assert model_of(load_case("qtz5613/condition-3", plane)).axes == 2
    for change in ("start.sway_tangential=1 deg", "start.sway_tangential_rate=0.1 rad/s"):
        case = load_case("qtz5613/slewing", ["motion.slewing.shape=rest", "motion.slewing={shape='rest'}", change])
        assert model_of(case).axes == 3


def test_motions_at_the_start_are_not_foretold_but_run():
    case = load_case("qtz5613/condition-3", ["start.sway_radial=2 deg"])
    assert scene_of(case).foretells({"sway_radial"})
    moving = load_case("qtz5613/condition-3", ["start.sway_radial_rate=2 deg/s"])
    assert not scene_of(moving).foretells({"sway_radial"})


@pytest.mark.parametrize(
    ("name", "changes", "words"),
    [
        ("qtz5613/condition-3", ["start.swing_angle=2 deg"], ['now called "sway_radial"']),
        ("jib-crane/plan", ["start.swing_angle=2 deg"], ['now called "sway_in_plane"']),
        ("overhead-crane/travel", ["start.swing_angle=2 deg"], ['now called "sway_along_runway"']),
        ("qtz5613/condition-3", ["start.sway_radial=2 m"], ["start.sway_radial", "rad"]),
        ("qtz5613/condition-3", ["start.sway_radial=20"], ["start.sway_radial", "deg meant?"]),
        ("qtz5613/condition-3", ["start.sway_radial_rate=20"], ["start.sway_radial_rate", "rad/s"]),
        ("qtz5613/condition-3", ["start.sway_tangential=100 deg"], ["start.sway_tangential", "to 1.57 rad"]),
        (
            "qtz5613/condition-3",
            ["start.sway_tangential=100 deg", 'allow_implausible=["start.sway_tangential"]'],
            ["start.sway_tangential", "below 90 deg"],
        ),
        (
            "qtz5613/condition-3",
            ["start.sway_radial=91 deg", "start.sway_tangential=1 deg"],
            ["start.sway_tangential", "0 beside a start.sway_radial of 90 deg"],
        ),
        ("qtz5613/condition-3", ["start.state=quite"], ["start.state", 'did you mean "quiet"?']),
        ("jib-crane/plan", ["start.state=quiet"], ["start.state", '"equilibrium"']),
    ],
)
def test_a_start_that_cannot_be_is_told_in_one_message(name, changes, words):
    with pytest.raises(CaseError) as caught:
        load_case(name, changes)
    assert len(caught.value.faults) == 1, caught.value
    for word in words:
        assert word in str(caught.value)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"state": "flying"}, "state: wanted 'equilibrium' or 'quiet' or 'zero', got 'flying'"),
        ({"along": np.nan}, "along: wanted a finite number, got nan"),
        ({"across_rate": "fast"}, "across_rate: wanted a finite number, got 'fast'"),
    ],
)
def test_arguments_of_a_start_are_judged(options, words):
    with pytest.raises(ValueError, match=words):
        Start(**options)
