"""Plans of drives: ramps shaped for the crane as it is when they end, in Python and in case files."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples import qtz5613
from samples import space_crane as space
from samples.case_files import only_fault

from towercrane.cases.case import CaseError, load_case
from towercrane.cases.models import model_of, motions_of
from towercrane.cranes.tower.equations.small_motions import natural_modes
from towercrane.cranes.tower.sway_frequencies import PendulumFrequencies, SwayFrequencies
from towercrane.motions.motion import rest, sequence
from towercrane.motions.plans import Move, NotSettled, Plan, Shaping, shaped_motions
from towercrane.motions.profiles import trapezoid
from towercrane.motions.ramps import shape_ramps
from towercrane.motions.shaping import DESIGNS, boxes, zv, zvd
from towercrane.studies.rest_study import attempt

CASE = "qtz5613/condition-3"
TROLLEY = trapezoid(10.0, 40.0, 0.8, 0.2)
ROPE = trapezoid(20.0, 12.0, 0.4, 0.2)


def planned(**motions):
    """Plans of drives that are told a motion, or a motion and a shaping."""
    return {c: Plan((Move(*m),)) if isinstance(m, tuple) else Plan((Move(m),)) for c, m in motions.items()}


# --- frequencies ---------------------------------------------------------------------------------------


def test_slewing_excites_two_modes_across_and_the_trolley_one_along():
    scene = space.model(2, 1, 3, 3)
    sway = SwayFrequencies(scene)
    assert_allclose(sway("slewing", 40.0, 12.0), [0.10204, 0.17704], atol=1.5e-5)
    assert_allclose(sway("trolley", 40.0, 12.0), [0.14379], atol=1.5e-5)
    assert sway("rope", 40.0, 12.0) == sway("trolley", 40.0, 12.0)
    assert sway("shaft", 40.0, 12.0) == sway("slewing", 40.0, 12.0)
    found = {m.frequency_hz for m in natural_modes(scene, 25.0, 15.0)}
    assert {*sway("slewing", 25.0, 15.0), *sway("trolley", 25.0, 15.0)} <= found
    # A crane that does not give has one mode to each side.
    rigid = SwayFrequencies(space.model(0, 0, 0, 0))
    for channel in ("slewing", "trolley"):
        assert_allclose(rigid(channel, 25.0, 15.0), PendulumFrequencies(9.81)(channel, 25.0, 15.0), rtol=1e-12)


def test_crane_in_the_plane_has_the_mode_along_its_jib():
    plane, scene = qtz5613.model(2, 3, 1500.0), space.model(2, 1, 3, 3)
    along, beside = (SwayFrequencies(m)("trolley", 40.0, 12.0) for m in (plane, scene))
    assert_allclose(along, beside, rtol=1e-9)


# --- plans ---------------------------------------------------------------------------------------------


def test_ramps_are_shaped_for_where_they_end():
    plans = planned(trolley=(TROLLEY, Shaping(zvd)), rope=ROPE)
    sway = PendulumFrequencies(9.81)
    motions = shaped_motions(plans, sway)
    assert motions["rope"] is ROPE
    # The starting ramp ends while the rope is still being wound.
    shapers, ends = [], []
    for guess in (12.0, motions["trolley"].duration):
        for _ in range(60):
            shaper = zvd(sway("trolley", 0.0, float(ROPE(guess))))
            before, guess = guess, 4.0 + shaper.duration if not shapers else guess
            if before == guess:
                break
        shapers.append(shaper)
        ends.append(guess)
    assert 12.0 < float(ROPE(ends[0])) < 18.0
    expected, found = shape_ramps(TROLLEY, shapers)
    assert_allclose(found[0], ends[0], atol=1e-8)
    assert_allclose(motions["trolley"].switch_times, expected.switch_times, atol=1e-8)
    assert motions["trolley"].end == pytest.approx(40.0, abs=1e-12)


def test_known_frequencies_need_no_crane_and_no_other_drive():
    motions = shaped_motions(planned(shaft=(TROLLEY, Shaping(zv, (0.12, 0.2)))))
    assert_allclose(motions["shaft"].switch_times, zv([0.12, 0.2])(TROLLEY).switch_times, atol=1e-12)
    damped = shaped_motions(planned(shaft=(TROLLEY, Shaping(zv, (0.12,), 0.1))))["shaft"]
    assert_allclose(damped.duration, TROLLEY.duration + zv([0.12], 0.1).duration)
    with pytest.raises(ValueError, match="trolley wants frequencies of a crane, its trolley and its rope"):
        shaped_motions(planned(trolley=(TROLLEY, Shaping(zv))))


def test_moves_follow_each_other_when_the_one_before_has_ended():
    there, back = trapezoid(10.0, 20.0, 0.8, 0.2), trapezoid(20.0, 5.0, 0.8, 0.2)
    plan = Plan((Move(rest(10.0, 2.0)), Move(there, Shaping(zv, (0.1,))), Move(back, Shaping(boxes, (0.2,)))))
    motion = shaped_motions({"trolley": plan})["trolley"]
    expected = sequence(rest(10.0, 2.0), zv([0.1])(there), boxes([0.2])(back))
    t = np.linspace(0.0, expected.duration, 200)
    assert_allclose(motion(t), expected(t), atol=1e-11)
    assert_allclose(plan.commanded.duration, 2.0 + there.duration + back.duration)


def test_later_moves_are_shaped_for_when_they_happen():
    # The second move happens at the short rope, whose frequency is known.
    there, back = trapezoid(10.0, 20.0, 0.8, 0.2), trapezoid(20.0, 10.0, 0.8, 0.2)
    moves = (Move(there, Shaping(zv)), Move(rest(20.0, 30.0)), Move(back, Shaping(zv)))
    plan = Plan(moves)
    assert_allclose(plan.ramp_ends[0], [4.0, 16.5])
    assert_allclose(plan.ramp_ends[2], [46.5 + 4.0, 46.5 + 16.5])
    sway = PendulumFrequencies(9.81)
    motion = shaped_motions({"trolley": plan, **planned(rope=ROPE)}, sway)["trolley"]
    assert motion.duration < 80.0
    last = sequence(rest(20.0, 1.0), zv(sway("", 0.0, 12.0))(back))
    ends = np.linspace(0.0, 12.5 + zv(sway("", 0.0, 12.0)).duration, 50)
    assert_allclose(motion(motion.duration - ends), last(last.duration - ends), atol=1e-9)


def test_ramps_that_never_settle_are_named():
    calls = []

    def restless(channel, trolley, rope):
        calls.append(0.1 + 0.05 * (len(calls) // 2 % 2))
        return calls[-1:]

    with pytest.raises(NotSettled, match="have not settled in 50 rounds"):
        shaped_motions(planned(trolley=(TROLLEY, Shaping(zv)), rope=ROPE), restless)


# --- cases ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", DESIGNS)
def test_case_shapes_for_the_frequency_of_its_own_model(name):
    case = load_case(CASE, [f"motion.trolley.shape={name}"])
    # Loading asks no model; the motion does.
    assert "motions" not in vars(case)
    assert case.plans["trolley"].commanded.duration == pytest.approx(53.0)
    sway = SwayFrequencies(qtz5613.model())
    expected, _ = shape_ramps(
        trapezoid(5.0, 41.0, 0.8, 0.1), [DESIGNS[name](sway("trolley", x, 18.0), 0.0) for x in (X_END[name], 41.0)]
    )
    assert_allclose(motions_of(case)["trolley"].duration, expected.duration, atol=1e-4)
    assert motions_of(case)["trolley"].end == pytest.approx(41.0, abs=1e-12)


X_END = dict.fromkeys(DESIGNS, 12.0)
"""Where the starting ramp ends, nearly [m]."""


def test_case_in_space_shapes_slewing_for_two_modes_and_is_calm_then():
    case = load_case("qtz5613/slewing", ["motion.slewing.shape=zvd"])
    motions = motions_of(case)
    pair = SwayFrequencies(model_of(case))("slewing", 30.0, 15.0)
    assert_allclose(pair, [0.1061, 0.1546], atol=1e-4)
    assert_allclose(
        motions["slewing"].switch_times, zvd(pair)(case.plans["slewing"].commanded).switch_times, atol=1e-6
    )
    assert_allclose(motions["slewing"].end, np.pi / 2, rtol=1e-13)
    assert attempt(model_of(case), motions).residual < 0.0105
    # The wind is a motion too, and none that a shaper changes.
    windy = load_case("qtz5613/gusts-working", ["motion.slewing.shape=zvd", "motion.trolley.shape=zvd"])
    assert motions_of(windy)["wind_y"] is windy.plans["wind_y"].commanded
    assert motions_of(windy)["trolley"].duration > windy.plans["trolley"].commanded.duration


def test_case_shapes_for_given_frequencies_in_any_kind_of_crane():
    case = load_case(CASE, ["motion.trolley.shape=zvd", 'motion.trolley.frequencies=["0.1 Hz", 0.2]'])
    assert_allclose(motions_of(case)["trolley"].duration, 53.0 + 10.0 + 5.0)
    single = load_case(CASE, ["motion.trolley.shape=boxes", "motion.trolley.frequencies=125 mHz"])
    assert_allclose(motions_of(single)["trolley"].duration, 61.0)
    turn = (
        'motion.shaft={start="0 deg", shape="ei", end="60 deg", speed="6 deg/s", acceleration="3 deg/s^2", '
        'frequencies="0.25 Hz"}'
    )
    shaft = motions_of(load_case("slewing/basic/example-1", [turn]))["shaft"]
    assert_allclose([shaft.duration, shaft.end], [12.0 + 4.0, np.pi / 3], rtol=1e-12)


def test_case_knows_the_smoothest_motion_and_steps():
    smooth = load_case(CASE, ['motion.trolley={shape="minimum-jerk", start=5, end=41, duration="90 s"}'])
    assert_allclose(motions_of(smooth)["trolley"].range(1), (0.0, 1.875 * 36 / 90), rtol=1e-12)
    steps = (
        'motion.trolley={shape="sequence", start=5, delay=3, steps=['
        '{shape="zv", end=20, speed=0.8, acceleration=0.2, frequencies=0.1}, {shape="rest", duration=2},'
        '{shape="minimum-jerk", end=5, duration=40}]}'
    )
    motion = motions_of(load_case(CASE, [steps]))["trolley"]
    assert_allclose(motion.duration, 3 + (15 / 0.8 + 4) + 5 + 2 + 40)
    assert motion.end == pytest.approx(5.0, abs=1e-12)
    hoist = 'motion.hoist={shape="zv", end=12, speed=0.4, acceleration=0.2, frequencies=0.5}'
    assert_allclose(motions_of(load_case(CASE, [hoist]))["rope"].duration, 6 / 0.4 + 2 + 1)


def test_what_a_case_cannot_mean_is_refused_by_key():
    fault = only_fault(CASE, "motion.trolley.shape=zv", 'motion.trolley.frequencies=["0.1 m"]')
    assert fault.key == "motion.trolley.frequencies"
    assert '"model" or a list of frequencies' in fault.wanted
    assert "a length" in fault.got
    fault = only_fault(CASE, "motion.trolley.shape=zv", "motion.trolley.frequencies=[]")
    assert fault.got == "an empty list"
    fault = only_fault(CASE, "motion.trolley.shape=zv", "motion.trolley.frequencies=-0.1")
    assert fault.key == "motion.trolley.frequencies"
    fault = only_fault(CASE, "motion.trolley.shape=zv", "motion.trolley.frequencies=[0.1, 120]")
    assert (fault.key, fault.wanted) == ("motion.trolley.frequencies.1", "a value from 0.001 to 20 Hz")
    assert "mHz meant?" in fault.hint
    fault = only_fault(CASE, "motion.trolley.shape=zvv")
    assert fault.hint == 'did you mean "zv"?'
    turn = 'motion.shaft={shape="zv", end="60 deg", speed="6 deg/s", acceleration="3 deg/s^2"}'
    fault = only_fault("slewing/basic/example-1", turn)
    assert (fault.key, fault.got) == ("motion.shaft.frequencies", '"model"')
    assert 'a crane of kind "basic"' in fault.wanted
    fault = only_fault(CASE, 'motion.trolley={shape="minimum-jerk", start=5, end=41, duration="2 s"}')
    assert (fault.key, fault.wanted) == ("motion.trolley", "speeds up to 10 m/s")


def test_case_whose_model_buckles_names_it():
    weak = ["crane.tower.second_moment_of_area=0.00003", "model.weight_softening=true", "motion.trolley.shape=zv"]
    case = load_case(CASE, [*weak, 'allow_implausible=["crane.tower.second_moment_of_area"]'])
    with pytest.raises(CaseError, match="times the weight upon it"):
        motions_of(case)
