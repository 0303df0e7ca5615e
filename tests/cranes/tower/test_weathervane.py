"""A head that is free to turn in the wind: torque of the air against it, brake, ends of its swings."""

import dataclasses

import numpy as np
import pytest
from numpy.testing import assert_allclose
from oracles.weathervane import Weathervane
from samples import space_crane as space
from samples.case_files import only_fault
from scipy.integrate import quad

from towercrane.cases.case import load_case
from towercrane.cases.models import model_of
from towercrane.cranes.parts.wind import WindAreas, WindNodes, steady
from towercrane.cranes.slewing.description import Drive
from towercrane.cranes.tower.crane_model import tower_crane_model
from towercrane.cranes.tower.equations.actions.wind import panel_pressures
from towercrane.cranes.tower.modes.mode_counts import ModeCounts
from towercrane.kernels.load import Load
from towercrane.motions.motion import rest
from towercrane.runs.run import record_case
from towercrane.runs.summary import peaks
from towercrane.runs.sweep import sweep
from towercrane.simulation.simulate import simulate
from towercrane.studies.linear_report import linear_model

AREAS = WindAreas(tower=0.8, jib=0.5, counter_jib=0.6, counterweight=4.0)
HALF = 0.6125
BARE = dataclasses.replace(space.CRANE, trolley_mass=0.0)
BRAKE = 20e3
VANE = Weathervane(
    BARE.slewing_inertia, BRAKE, 20.0, [(0.0, 55.6, HALF * 0.5), (-12.3, 0.0, HALF * 0.6)], [(-12.3, HALF * 4.0)]
)  # fmt: skip
RIGID = ModeCounts(0, 0, 0, 0)


def free(brake=BRAKE, areas=AREAS, crane=BARE, modes=RIGID, load=1.0, **options):
    drive = Drive("slewing", 0.0, 0.0, 1.0, 0.0, "stick-slip", brake)
    return tower_crane_model(crane, Load(load), modes, areas=areas, drive=drive, **options)


def run(model, angle, speed, duration, **options):
    """A run of a head that begins at an angle, the load on the tower's axis, in a wind towards x."""
    motions = {"trolley": rest(0.0), "rope": rest(5.0), "slewing": rest(angle)} | steady([speed, 0.0, 0.0])
    return simulate(model, motions, duration, rtol=1e-10, atol=1e-12, **options)


@pytest.mark.parametrize(("begin", "end"), [
    (3.0, 7.0), (-4.0, -1.0), (5.0, -2.0), (-1.0, 9.0), (0.0, 2.0), (4.0, 0.0), (-3.0, -3.0), (0.0, 0.0), (2.0, -2.0),
])  # fmt: skip
def test_a_panel_has_the_force_and_the_moment_of_the_squared_wind_along_it(begin, end):
    first, last = panel_pressures(begin, end)

    def squared(s, power):
        r = begin + (end - begin) * s
        return abs(r) * r * s**power

    turns = [begin / (begin - end)] if begin * end < 0.0 else None
    force, moment = (quad(squared, 0.0, 1.0, args=(power,), points=turns)[0] for power in (0, 1))
    assert 0.5 * (first + last) == pytest.approx(force, abs=1e-13)
    assert first / 6.0 + last / 3.0 == pytest.approx(moment, abs=1e-13)


@pytest.fixture(scope="module")
def swings():
    return run(free(), 2.0, 20.0, 80.0, output_step=0.02)


def test_a_rigid_head_swings_and_stops_as_a_program_of_one_coordinate_has_it(swings):
    (first, turned), (stopped, rests) = VANE.swing(2.0)
    angle, times = swings["slewing_angle"].values, swings["time"].values
    assert (np.degrees(rests), stopped) == (pytest.approx(8.30, abs=0.01), pytest.approx(69.0, abs=0.02))
    assert angle[-1] == pytest.approx(rests, abs=1e-6)
    assert angle.min() == pytest.approx(turned, abs=1e-6)
    assert times[angle.argmin()] == pytest.approx(first, abs=0.02)
    still = times[swings["slewing_speed"].values != 0.0][-1]
    assert still == pytest.approx(stopped, abs=0.03)
    # At rest the brake takes what the wind asks for.
    assert swings["slewing_torque"].values[-1] == pytest.approx(-VANE.torque(rests, 0.0), rel=1e-5)
    assert swings["base_torque"].values[-1] == pytest.approx(VANE.torque(rests, 0.0), rel=1e-5)


def test_work_of_wind_and_brake_is_all_that_the_head_gains(swings):
    gained = swings["total_energy"].values - swings["total_energy"].values[0]
    assert abs(gained - swings["input_work"].values).max() < 1e-8 * np.ptp(gained)
    # By hand: torque of the air and of the brake along the way.
    angle, rate, times = (swings[name].values for name in ("slewing_angle", "slewing_speed", "time"))
    power = [VANE.torque(a, w) * w - BRAKE * abs(w) for a, w in zip(angle[::10], rate[::10], strict=True)]
    work = np.concatenate([[0.0], np.cumsum(0.5 * np.diff(times[::10]) * (np.array(power[1:]) + power[:-1]))])
    assert abs(work - gained[::10]).max() < 2e-3 * np.ptp(gained)


@pytest.mark.parametrize(("angle", "speed", "holds"), [
    (np.radians(20.2), 20.0, True), (np.radians(20.4), 20.0, False),
    (0.5 * np.pi, 6.9, True), (0.5 * np.pi, 6.97, False),
])  # fmt: skip
def test_the_brake_holds_near_downwind_and_in_light_winds_and_nowhere_else(angle, speed, holds):
    moved = run(free(), angle, speed, 2.0)["slewing_angle"].values - angle
    assert not moved.any() if holds else moved[-1] < -1e-6


def test_nodes_of_the_wind_have_the_same_torque_of_a_uniform_one():
    lateral = dataclasses.replace(BARE)
    one, many = (
        free(crane=lateral, modes=ModeCounts(1, 1, 1, 1), nodes=nodes) for nodes in (None, WindNodes())
    )  # fmt: skip
    rng = np.random.default_rng(4)
    state = 0.1 * rng.normal(size=one.size)
    n = one.coordinates
    state[n : n + 3] = 0.0, 0.0, -1.0
    slopes = []
    for model in (one, many):
        inputs = np.zeros((len(model.channels), 3))
        inputs[0, 0], inputs[1, 0] = 20.0, 5.0
        inputs[3:, 0] = [(9.0, 4.0)[k % 2] for k in range(len(inputs) - 4)] + [0.0]
        slopes.append(model.system.slope(0.0, state, inputs)[0])
    assert_allclose(slopes[1], slopes[0], rtol=1e-10, atol=1e-10)


STORM = "qtz5613/weathervane"


def test_a_head_that_gives_way_stops_twice_and_keeps_its_balance():
    case = load_case(STORM)
    found = record_case(case)
    assert found.attrs["outcome"] == "finished"
    speed, times = found["slewing_speed"].values, found["time"].values
    # Two half swings, far past downwind and back; then rest for good.
    assert found["slewing_angle"].values.min() < -0.7
    assert 50.0 < times[np.flatnonzero(speed)[-1]] < 80.0
    assert abs(np.degrees(found["slewing_angle"].values[-1])) < 20.3
    gained = found["total_energy"].values - found["total_energy"].values[0]
    assert abs(gained - found["input_work"].values).max() < 1e-8 * np.ptp(gained)
    said = found.attrs["notices"]
    assert "int c x = 415.4 kg, the jib's: it comes to rest with its jib downwind" in said
    assert "holds the head within 20.2 deg" in said
    assert "with its brake holding it" in said


def test_a_stronger_counter_jib_is_named_and_turns_downwind():
    said = []
    for area in (0.0, 20.0, 90.0):
        changes = ["run.duration=0.1 s", "crane.wind_areas.counter_jib=12 m", f"payload.drag_area={area} m^2"]
        said.append(record_case(load_case(STORM, changes)).attrs["notices"])
    # 473.4 kg of the jib against 556.0 kg and 30.1 kg; the load at 5 m.
    assert "int c x = -112.8 kg, the counter-jib's: the weathervane is reversed" in said[0]
    assert "comes to rest 180 deg from downwind" in said[0]
    assert "comes to rest 147 deg from downwind" in said[1]
    assert "but the load's drag, 275.6 kg, still turns the jib downwind" in said[2]
    areas = dataclasses.replace(AREAS, counter_jib=12.0)
    found = run(free(5e3, areas), 2.0, 20.0, 250.0, output_step=0.5)
    assert found["slewing_speed"].values[-1] == 0.0
    assert abs(np.pi - found["slewing_angle"].values[-1]) < np.arcsin(np.sqrt(5e3 / (112.8 * 400.0)))


def test_lanes_of_free_heads_are_the_single_runs():
    rigid = [f"model.{kind}_modes=0" for kind in ("tower", "torsion", "jib_lateral", "jib_vertical")]
    changes = [*rigid, "run.duration=40 s", "solver.rtol=1e-9", "solver.atol=1e-11"]
    angles = np.radians(np.arange(40.0, 130.0, 10.0)).tolist()
    names = ["slewing_angle", "slewing_torque"]
    found = sweep(load_case(STORM, changes), {"motion.slewing.start": angles}, outputs=names)
    for run_number in (2, 7):
        single = record_case(load_case(STORM, [*changes, f"motion.slewing.start={angles[run_number - 1]!r} rad"]))
        for name in names:
            peak, row = peaks(single)[name], found.sel(run=run_number)
            assert float(row[f"{name}_min"]) == pytest.approx(peak["minimum"], rel=1e-6, abs=1e-9)
            assert float(row[f"{name}_max"]) == pytest.approx(peak["maximum"], rel=1e-6, abs=1e-9)


def test_small_motions_are_of_the_head_that_its_brake_holds():
    case = load_case(STORM)
    frequencies = [own.frequency for own in linear_model(case, 0.0).eigenvalues() if own.value.imag > 0.0]
    assert min(frequencies) > 0.1
    assert len(frequencies) == model_of(case).coordinates - 1 + 2


@pytest.mark.parametrize(("change", "key", "wanted"), [
    ("motion.slewing.brake_torque=-3 kN m", "motion.slewing.brake_torque", "from 0"),
    ("motion.slewing.brake_torque=20 kN", "motion.slewing.brake_torque", "a torque"),
    ("motion.slewing.brake=3", "motion.slewing.brake", "one of the keys start, shape, brake_torque"),
    ("accuracy.target=1e-3", "accuracy.target", "no error for a head that is free to turn"),
    ("solver.method=scipy-radau", "solver.method", "with stick-slip friction"),
])  # fmt: skip
def test_what_a_free_head_cannot_have_is_one_message(change, key, wanted):
    fault = only_fault(STORM, change)
    assert fault.key == key
    assert wanted in fault.wanted


def test_a_brake_alone_sticks_and_slips_and_a_coupling_does_not():
    with pytest.raises(ValueError, match=r"wanted friction .none. or .tanh., got .stick-slip."):
        space.model(slewing=Drive("slewing", 1e6, 1e6, 0.1, 0.0, "stick-slip", 1e3))
