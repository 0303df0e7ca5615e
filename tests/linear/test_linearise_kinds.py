"""Linear models of slewing and jib cranes: known frequencies, a steady rotation, small motions of the full model."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples.lab_crane import PARAMETERS, crane

from towercrane.cases.case import load_case
from towercrane.cases.models import model_of, motions_of
from towercrane.linear.linearise import linearise
from towercrane.motions.motion import rest
from towercrane.motions.profiles import speed_trapezoid
from towercrane.runs.run import record_case
from towercrane.runs.summary import summarise
from towercrane.simulation.simulate import simulate
from towercrane.simulation.starts.start import Start

STILL = {"shaft": rest(0.0), "rope": rest(2.0)}


def undamped(kind: str):
    parameters = vars(PARAMETERS[kind])
    lossless = dict.fromkeys((name for name in parameters if "damping" in name or "drag" in name), 0.0)
    return crane(kind, **lossless, friction_law="none")


def frequencies(linear) -> np.ndarray:
    return np.sort([abs(e.value) for e in linear.eigenvalues() if e.value.imag > 1e-6])


def test_undamped_frequencies_of_the_multi_mass_crane():
    # rad/s, from an independent linearisation of the same data.
    known = [0.2371, 2.2130, 3.3742, 15.17, 24.17, 33.50, 68.17, 68.56, 85.68, 151.6]
    found = frequencies(linearise(undamped("multi-mass"), STILL, outputs=[]))
    assert_allclose(found, known, rtol=4e-4)


@pytest.mark.parametrize("kind", ["multi-mass", "enhanced", "basic"])
def test_states_are_named_and_minimal(kind):
    model = crane(kind)
    linear = linearise(model, STILL, outputs=["sway_radial", "drive_torque"])
    names = [signal.name for signal in linear.states]
    structural = list(model.state_names)
    assert names[: len(structural)] == structural
    assert len(names) == 2 * (model.freedoms + 2)  # coordinates, the load's, two drives, and their rates
    assert [signal.name for signal in linear.outputs] == ["sway_radial", "drive_torque"]


def test_sways_along_fixed_axes_have_their_names():
    for turning, sways in ((None, ("sway_x", "sway_y")), ("platform_angle", ("sway_outward", "sway_sideways"))):
        linear = linearise(crane("enhanced"), STILL, turning=turning, outputs=[])
        assert tuple(s.name for s in linear.states if "sway" in s.name and "rate" not in s.name) == sways
    for turning, places in ((None, "xy"), ("platform_angle", ("outward", "sideways"))):
        linear = linearise(crane("basic"), STILL, turning=turning, outputs=[])
        names = [s.name for s in linear.states if s.name.startswith("load_") and "rate" not in s.name]
        assert names == [f"load_{place}" for place in (*places, *("z" if turning is None else ("up",)))]


def test_small_motion_of_the_full_model_has_the_linear_frequency():
    model = undamped("basic")
    linear = frequencies(linearise(model, STILL, outputs=[]))
    result = simulate(model, STILL, 60.0, start=Start(along=1e-4), output_step=0.01, rtol=1e-11, atol=1e-14)
    angle = result["sway_radial"].values
    up = np.flatnonzero((angle[:-1] < 0) & (angle[1:] >= 0))
    crossings = 0.01 * (up - angle[up] / (angle[up + 1] - angle[up]))
    measured = 2 * np.pi * (len(crossings) - 1) / (crossings[-1] - crossings[0])
    assert np.min(abs(linear / measured - 1)) < 1e-5


def test_steady_rotation_is_an_equilibrium_of_the_turning_frame():
    model = crane("basic", drag_jib_tip=0.0)
    model = type(model)(model.crane, type(model.load)(50.5, rope_damping=60.0))
    drives = {"shaft": speed_trapezoid(0.0, 0.3, 5.0, 600.0), "rope": rest(2.0)}
    turned = simulate(model, drives, 300.0, output_step=1.0, rtol=1e-11, atol=1e-13)
    linear = linearise(
        model, drives, time=300.0, state=turned.attrs["end_state"], turning="platform_angle", outputs=[]
    )
    names = [signal.name for signal in linear.states]
    steady = [i for i, name in enumerate(names) if "angle" not in name and "shaft" not in name]
    assert np.max(abs(linear.point.slope[steady])) < 1e-7
    # Nothing grows: platform and load follow the shaft.
    assert max(e.value.real for e in linear.eigenvalues()) < 1e-6
    # The turning splits the two sways of the crane at rest.
    still = frequencies(linearise(model, STILL, outputs=[]))
    assert np.max(abs(frequencies(linear)[:2] - still[:2])) > 1e-3


def test_jib_crane_has_two_equal_sways():
    case = load_case("jib-crane/plan")
    found = frequencies(linearise(model_of(case), motions_of(case), outputs=[]))
    assert_allclose(found, np.sqrt(9.81 / 20.0), rtol=1e-9)
    assert len(found) == 2


HOIST_LATER = (
    "motion.hoist.shape=trapezoid", "motion.hoist.end=0.5 m", "motion.hoist.speed=0.5 m/s",
    "motion.hoist.acceleration=0.5 m/s^2", "motion.hoist.delay=10 s", "run.duration=10 s",
)  # fmt: skip


def test_a_summary_tells_the_frequencies_where_the_run_ended_though_motions_go_on():
    case = load_case("slewing/basic/example-1", HOIST_LATER)
    found = summarise(case, record_case(case))["natural_frequencies_hz"]
    assert found[0] == pytest.approx(0.350, abs=5e-4)


@pytest.mark.parametrize("name", ["qtz5613/condition-3", "qtz5613/manoeuvre"])
def test_a_summary_looks_at_the_end_of_the_run_not_at_its_last_row(name):
    end = 20.0
    rows = [load_case(name, [f"run.duration={end} s", f"run.output_step={step} s"]) for step in (20.0, 15.0)]
    found = [summarise(case, record_case(case))["natural_frequencies_hz"] for case in rows]
    assert_allclose(found[1], found[0], rtol=1e-12)
    before = load_case(name, ["run.duration=15 s", "run.output_step=15 s"])
    earlier = np.array(summarise(before, record_case(before))["natural_frequencies_hz"])
    assert np.max(abs(earlier / found[0] - 1.0)) > 1e-3
