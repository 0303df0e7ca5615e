"""Loads lifted off the ground: dynamic factors against known runs, formulas by hand against a known table."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from towercrane import load_case
from towercrane.cases.models import model_of
from towercrane.runs.loads import static
from towercrane.simulation.outcomes import INTERRUPTED
from towercrane.simulation.simulate import record
from towercrane.studies.lift import study
from towercrane.studies.lift.hand import HOISTING_CLASSES, Classes, Yielding
from towercrane.studies.lift.hoisting import Hoisting, hoisting_of
from towercrane.studies.lift.place import stand
from towercrane.studies.lift.study import lift

G, SPRING = 9.81, 14e6 / (18.0 + 32.5)
SMALL = ["model.tower_modes=1", "model.jib_vertical_modes=1"]


def test_factors_of_the_rope_are_those_of_known_runs():
    case = load_case("qtz5613/lift-off", ["payload.mass=1500 kg"])
    found = lift(case, [0.2, 0.5, 1.0], [10.0, 25.0, 50.0], hoisting=Hoisting(0.05, 1.0))
    known = [1.238, 1.599, 1.656, 1.246, 1.496, 1.466, 1.150, 1.279, 1.329]
    rows = found["runs"]
    assert [row["outcome"] for row in rows] == ["finished"] * 9
    assert_allclose([row["dynamic_factor"]["rope"]["value"] for row in rows], known, rtol=0, atol=5.1e-4)
    # Under the load that hangs each place yields as a crane that was built by itself does.
    assert_allclose([1e6 * own["compliance_m_n"] for own in found["positions"]], [1.23, 12.3, 78.4], rtol=4e-3)
    assert [own["by_hand_with"] for own in found["positions"]] == ["k_eff", "k", "k"]
    # The rope alone bounded every run at a steady speed.
    assert all(row["dynamic_factor"]["rope"]["value"] < row["by_hand"]["k"] for row in rows)
    assert found["notices"] == []


@pytest.mark.parametrize(("compliance", "masses", "with_crane"), [
    (1.23e-6, (800, 1500, 3000), (1.638, 1.196, 0.846)),
    (12.34e-6, (800, 1500, 3000), (0.902, 0.659, 0.466)),
    (42.75e-6, (800, 1500), (0.529, 0.387)),
    (78.4e-6, (800, 1500), (0.398, 0.291)),
])  # fmt: skip
def test_formulas_by_hand(compliance, masses, with_crane):
    alone = {800: 1.898, 1500: 1.386, 3000: 0.980}
    for mass, slope in zip(masses, with_crane, strict=True):
        hand = Yielding(mass, SPRING, compliance, G)
        factors = hand.factors(0.5)
        assert factors["k_eff"] == pytest.approx(1.0 + 0.5 * slope, abs=4e-4)
        assert factors["k"] == pytest.approx(1.0 + 0.5 * alone[mass], abs=4e-4)
        assert hand.recommended == ("k_eff" if compliance < 2e-6 else "k")


def test_hoisting_classes_and_which_covers_a_factor():
    found = [own.factor(0.5) for own in HOISTING_CLASSES.values()]
    assert_allclose(found, [1.135, 1.27, 1.405, 1.54], rtol=1e-12)
    assert [Classes().covering(factor, 0.5) for factor in (1.135, 1.28, 1.6)] == ["HC1", "HC3", "beyond HC4"]


def test_a_study_says_what_single_runs_say():
    case = load_case("qtz5613/lift-off", SMALL)
    way = Hoisting(0.05, 1.0, 0.1)
    (row,) = lift(case, [0.5], [40.0], hoisting=way, window=3.0)["runs"]
    place = stand(case, model_of(case), 40.0, 0.05)
    motions = place.drives | {"rope": way.motion(18.0, place.yielding.sag, 0.5)}
    run = record(place.model, motions, row["lift_off_s"] + 3.0, output_step=1e-3)
    off = run.times[np.flatnonzero(run["load_ground_force"].values == 0.0)[0]]
    assert row["lift_off_s"] == pytest.approx(off, abs=study.LOOK)
    hanging = static(place.model, motions, [40.0, 18.0])
    assert hanging["hoist_rope_force"] == pytest.approx(800.0 * G, rel=1e-9)
    for name, short in (("hoist_rope_force", "rope"), ("base_moment_y", "base"), ("jib_root_moment", "jib_root")):
        values, rest = run[name].values, hanging[name]
        before = values[0]
        expected = (values[run.times >= off].max() - before) / (rest - before)
        assert row["dynamic_factor"][short]["value"] == pytest.approx(expected, abs=2e-4), name
    # The load's weight on its arm, and a little more where the crane yields.
    root = hanging["jib_root_moment"] - run["jib_root_moment"].values[0]
    assert root == pytest.approx(800.0 * G * 40.0, rel=1e-3)


def test_a_case_that_knows_no_ground_is_lifted_off_all_the_same():
    rope = ["rope.axial_stiffness=7 MN", "rope.falls=2", "rope.extra_length=32.5 m", "rope.relaxation_time=3 ms"]
    hangs = load_case("qtz5613/condition-3", [*SMALL, *rope, "rope.length=18 m", "payload.mass=800 kg"])
    found, known = (
        lift(case, [0.5], [40.0], hoisting=Hoisting(0.05, 1.0), window=3.0)["runs"][0]["dynamic_factor"]
        for case in (hangs, load_case("qtz5613/lift-off", SMALL))
    )
    assert found == known


def test_a_moment_is_that_in_the_plane_of_a_jib_that_is_turned():
    case = load_case("qtz5613/lift-off", [*SMALL, "motion.slewing.shape=rest", "motion.slewing.start=90 deg"])
    place = stand(case, model_of(case), 40.0, 0.05)
    forward = study._in_the_plane(place, place.hanging)["overturning_moment"]
    straight = load_case("qtz5613/lift-off", SMALL)
    assert forward == pytest.approx(
        stand(straight, model_of(straight), 40.0, 0.05).hanging["base_moment_y"], rel=1e-9
    )


def test_a_hoist_creeps_until_the_load_hangs():
    way, fastest = hoisting_of(load_case("qtz5613/lift-off"))
    assert (way.slack, way.creep, fastest) == (0.05, pytest.approx(0.1), pytest.approx(0.6))
    assert way.acceleration == pytest.approx(0.5 / 0.6)
    rope, sag = way.motion(18.0, 0.3, 0.6), 0.3
    hangs = way.time(0.05 + sag, 0.6)
    assert float(rope(hangs)) == pytest.approx(18.0 - 0.35, rel=1e-12)
    assert_allclose(-rope([hangs, hangs + 0.99, hangs + 2.0], 1), [0.1, 0.1, 0.6], rtol=1e-12)
    assert float(way.motion(18.0, 0.3, 0.05)(10.0, 1)) == -0.05
    assert hoisting_of(load_case("qtz5613/lift-off", ['motion.hoist={shape="rest"}']))[1] == 0.0


def test_an_interrupted_study_is_none(monkeypatch):
    class Interrupted:
        outcomes = (INTERRUPTED,)

    monkeypatch.setattr(study, "integrate_many", lambda *given, **more: Interrupted)
    with pytest.raises(KeyboardInterrupt):
        lift(load_case("qtz5613/lift-off", SMALL), [0.5], [40.0])
