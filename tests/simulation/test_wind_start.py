"""Starts at rest in the wind, and the linear model about them."""

import dataclasses

import numpy as np
import pytest
from numpy.testing import assert_allclose
from oracles.jets import Jet
from oracles.space_points import CraneCloud
from samples import lab_crane
from samples import space_crane as space
from samples.qtz5613 import in_plane
from scipy.linalg import expm

from towercrane.cases.case import load_case
from towercrane.cases.models import model_of, motions_of
from towercrane.cranes.parts.wind import WindAreas, gusts, steady
from towercrane.cranes.slewing.description import Drive
from towercrane.cranes.tower.modes.damping import ModalDamping
from towercrane.kernels.load import Load
from towercrane.linear.linearise import linearise
from towercrane.motions.motion import Motion, phases, rest
from towercrane.motions.profiles import trapezoid
from towercrane.runs.run import run_case
from towercrane.simulation.integrate import integrate
from towercrane.simulation.simulate import simulate
from towercrane.simulation.starts.begin import begin
from towercrane.simulation.starts.start import Start
from towercrane.simulation.system import start_inputs
from towercrane.studies.linear_report import linear_model, linear_report

AREAS = WindAreas(tower=3.0, jib=1.2, counter_jib=1.5, counterweight=8.0)
LOAD = Load(400.0, rope_damping=400.0, drag_area=7.2)
DRIVE = Drive("slewing", 4e6, 3e7, 0.002, 2e5, "tanh", 3e4, 0.01)
VELOCITY = np.array([11.0, -14.0, 4.0])
STANDING = space.standing(31.0, 9.0, 0.7)


def windy(**options):
    return space.model(2, 1, 2, 2, LOAD, AREAS, wind=True, weight_softening=True, **options)


def begun(model, motions, **options):
    cut = phases(tuple(motions[channel] for channel in model.channels), 1.0)
    return begin(model, start_inputs(model, motions, cut.inputs[0]), **options)


@pytest.mark.parametrize("drive", [None, DRIVE], ids=["held", "driven"])
def test_forces_on_points_balance_at_the_start_in_a_wind_from_anywhere(drive):
    model = windy() if drive is None else windy(slewing=drive, drive_inertia=2e5)
    motions = {**STANDING, "shaft": STANDING["slewing"]} | steady(VELOCITY)
    state, n = begun(model, motions), model.coordinates
    q, rope = state[:n], state[n : n + 3]
    angles = [np.arctan2(rope[0], -rope[2]), np.arcsin(rope[1])]
    cloud, still = CraneCloud(model, space.CRANE, AREAS), np.zeros(n + 2)
    drives = [Jet(0.7, 0.0, 0.0), Jet(31.0, 0.0, 0.0), Jet(9.0, 0.0, 0.0)]
    columns = cloud.displace(np.concatenate([q, angles]), drives)
    sums, sizes = cloud.left_over(np.concatenate([q, angles]), still, still, drives, columns, VELOCITY)
    given = np.zeros(n + 2)
    if drive is not None:
        at = model.parts["slewing"].start
        twist = q[at] - 0.7
        assert abs(twist) > drive.corner
        given[at] = -drive.stiff * twist + (drive.stiff - drive.soft) * drive.corner * np.sign(twist)
    assert np.max(abs(sums[: n + 2] - given) / (sizes[: n + 2] + abs(given))) < 1e-11


def test_each_component_of_the_wind_bends_the_tower_by_its_known_way():
    stiff = dataclasses.replace(space.CRANE, jib=dataclasses.replace(space.CRANE.jib, second_moment_of_area=1.0))
    model = space.model(8, 0, 0, 0, LOAD, WindAreas(tower=3.0), crane=stiff, wind=True)
    calm = begun(model, STANDING | steady([0.0, 0.0, 0.0]))
    tower = space.CRANE.tower
    bending, height = tower.youngs_modulus * tower.second_moment_of_area, tower.length
    for axis, velocity in enumerate(np.diag([12.0, -9.0, 7.0])):
        start = begun(model, STANDING | steady(velocity))
        pressed = 0.5 * 1.225 * abs(velocity) * velocity
        along, up = pressed[:2] @ [1.0, 1.0], pressed[2]
        expected = 3.0 * along * height**4 / (8 * bending) + 7.2 * along * height**3 / (3 * bending)
        tip = (start - calm)[:16].reshape(2, 8) @ model.crane.tower(height)
        if axis < 2:
            # The rope's pull leans with the tower: what it does then is of second order.
            assert_allclose(tip[axis], expected, rtol=2e-3)
            assert abs(tip[1 - axis]) < 2e-3 * abs(expected)
        else:
            turned = -7.2 * up * 31.0 * height**2 / (2 * bending)
            assert_allclose(tip, turned * np.array([np.cos(0.7), np.sin(0.7)]), rtol=2e-3)
        pull = np.array([7.2 * pressed[0], 7.2 * pressed[1], 7.2 * up - 400.0 * 9.81])
        assert_allclose(start[16:19], pull / np.linalg.norm(pull), rtol=1e-14, atol=1e-15)


def test_a_parked_crane_in_a_steady_wind_stands_still_under_its_static_torque():
    changes = ["wind.series=", "wind.speed=20 m/s", "wind.direction=90 deg", "motion.trolley.start=5 m"]
    changes += ["payload.mass=100 kg", "payload.drag_area=0", "rope.length=5 m", "run.duration=20 s"]
    result = run_case(load_case("qtz5613/gusts-parked", [*changes, "run.output_step=1 s"]))
    torque = result["base_torque"].values
    # Jib, counter-jib and counterweight, each with its arm; the twist of 1.2 degrees takes little of the wind away.
    straight = 0.5 * 1.225 * 20.0**2 * (0.5 * 55.6**2 / 2 - 0.6 * 12.3**2 / 2 - 4.0 * 12.3)
    assert_allclose(torque, straight, rtol=2e-3)
    for name in ("base_torque", "base_moment_x", "base_moment_y", "hoist_rope_force"):
        values = result[name].values
        assert np.ptp(values) < 1e-9 * abs(values).max() + 1e-6
    pressed = 0.8 * 23.8**2 / 2 + (0.5 * 55.6 + 0.6 * 12.3 + 4.0) * 23.8
    # What leans has weight: three per cent more.
    moment = result["base_moment_x"].values[0] / (-0.5 * 1.225 * 400.0 * pressed)
    assert 1.02 < moment < 1.035


def test_gusts_start_from_the_equilibrium_of_their_mean_whatever_the_runs_length():
    blown = gusts(2.0, [[0.0, 10.0, 0.0], [4.0, 16.0, -1.0], [2.0, 4.0, 1.0]])
    mean = [2.5, 11.5, -0.25]
    assert_allclose([blown[f"wind_{axis}"].mean for axis in "xyz"], mean, rtol=1e-14)
    model = windy()
    start = begun(model, STANDING | blown)
    assert np.array_equal(start, begun(model, STANDING | steady(mean)))
    first = [simulate(model, STANDING | blown, span, output_step=0.5)["base_torque"].values[0] for span in (1.0, 3.0)]
    assert first[0] == first[1]


def test_mean_of_a_motion_is_that_of_its_values():
    motion = trapezoid(2.0, 14.0, 0.7, 0.2)
    times = np.linspace(0.0, motion.duration, 200_001)
    assert_allclose(motion.mean, np.trapezoid(motion(times), times) / motion.duration, rtol=1e-9)
    assert rest(3.0).mean == 3.0
    assert Motion(np.array([0.0, 2.0]), np.array([[1.0, 3.0]])).mean == 4.0


def test_a_sway_that_is_not_stated_is_that_of_the_load_in_the_wind():
    motions = STANDING | steady(VELOCITY)
    model = windy()
    hung, swung = (begun(model, motions, start=start) for start in (Start(), Start(along=0.3)))
    n = model.coordinates
    assert np.array_equal(hung[:n], swung[:n])
    # The twisted head sees the rope a little from the side.
    seen = [simulate(model, motions, 0.1, start=start, output_step=0.1) for start in (Start(), Start(along=0.3))]
    before, after = ([run[f"sway_{way}"].values[0] for way in ("radial", "tangential")] for run in seen)
    assert abs(before[1]) > 0.1
    assert_allclose(after, [0.3, before[1]], rtol=1e-13)
    assert_allclose(begun(model, motions, start=Start("zero"))[n : n + 3], [0.0, 0.0, -1.0])


# --- the linear model ----------------------------------------------------------------------------------


def test_linear_model_answers_a_gust_as_the_crane_does():
    model = dataclasses.replace(windy(), damping=ModalDamping(0.02, 0.02, 0.02, 0.02))
    shown = ["sway_tangential", "tower_tip_twist", "jib_tip_deflection_sideways", "base_moment_x", "hoist_rope_force"]
    calm = STANDING | steady([0.0, 12.0, 0.0])
    linear = linearise(model, calm, outputs=shown)
    assert [signal.name for signal in linear.inputs[:3]] == ["wind_x", "wind_y", "wind_z"]
    assert not any("wind" in signal.name for signal in linear.states)
    assert linear.at_equilibrium
    terms = abs(linear.a) @ abs(linear.point.states) + abs(linear.b) @ abs(linear.point.inputs)
    assert np.max(abs(linear.point.slope) / (1.0 + terms)) < 1e-9
    size, span, rise = len(linear.states), 6.0, np.array([0.6, 1.0, -0.4])
    gaps = []
    for strength in (0.02, 0.01):
        blow = {
            f"wind_{axis}": Motion(np.array([0.0, span]), np.array([[v, strength * up / span]]))
            for axis, v, up in zip("xyz", [0.0, 12.0, 0.0], rise, strict=True)
        }
        # From the equilibrium of the steady wind the wind grows steadily.
        state = begun(model, calm)
        found = _course(model, STANDING | blow, state, span, shown)
        grown = np.zeros((size + 6, size + 6))
        grown[:size, :size], grown[:size, size : size + 3] = linear.a, linear.b[:, :3]
        grown[size : size + 3, size + 3 :] = np.eye(3)
        slope = strength * rise / span
        ahead = expm(span * grown) @ np.concatenate([np.zeros(size + 3), slope])
        answer = linear.c @ ahead[:size] + linear.d[:, :3] @ ahead[size : size + 3]
        gaps.append(abs(found - linear.point.outputs - answer) / abs(answer))
    assert np.max(gaps[0]) < 5e-3
    # Twice as near for half the gust: what is left is of second order.
    assert np.all(gaps[1] < 0.6 * gaps[0] + 1e-6)


def _course(model, motions, state, span, shown):
    from towercrane.simulation.integrate import evaluate, integrate

    cut = phases(tuple(motions[channel] for channel in model.channels), span)
    times = np.array([span])
    run = integrate(model.system, cut, state, times, rtol=1e-12, atol=1e-14)
    slopes, guards = evaluate(model.system, cut, times, run.states)
    # At the last instant, not after it, when the wind rests.
    seen = model.observe(motions, times, run.states, slopes, guards)
    return np.array([seen[name].values[0] for name in shown])


FEW = [f"model.{kind}=1" for kind in ("tower_modes", "jib_lateral_modes", "jib_vertical_modes")]


def test_a_case_in_wind_names_its_equilibrium_and_takes_the_wind_itself():
    changes = ["wind.speed=12 m/s", "wind.direction=90 deg", "payload.mass=400 kg", "payload.drag_area=7.2 m^2"]
    case = load_case("qtz5613/slewing", [*changes, *FEW])
    linear = linear_model(case, 0.0)
    report = linear_report(case, 0.0, linear)
    lean = np.arctan2(0.5 * 1.225 * 7.2 * 12.0**2, 400.0 * 9.81)
    assert_allclose(lean, 0.160, atol=5e-4)
    assert_allclose(report["rope_inclination_rad"], lean, rtol=1e-12)
    outputs = {signal["name"]: signal["value"] for signal in report["outputs"]}
    assert_allclose(outputs["sway_tangential"], lean, rtol=2e-3)
    assert report["equilibrium"]
    assert max(map(abs, report["slope"])) < 1e-8
    inputs = {signal["name"]: (signal["units"], signal["value"]) for signal in report["inputs"]}
    assert inputs["wind_y"] == ("m/s", pytest.approx(12.0))
    assert not any("wind" in name and "acceleration" in name for name in inputs)


def test_a_state_that_moves_is_no_equilibrium_and_its_slope_is_told():
    case = load_case("qtz5613/gusts-working", FEW)
    linear = linear_model(case, 20.0)
    assert linear.at_equilibrium
    assert [linear.point.inputs[k] for k in range(3)] == [motions_of(case)[f"wind_{axis}"].mean for axis in "xyz"]
    model = model_of(case)
    moving = linearise(model, motions_of(case), time=20.0, state=linear.point.full_state, outputs=[])
    assert not moving.at_equilibrium
    assert_allclose(moving.point.inputs[:3], [float(motions_of(case)[f"wind_{axis}"](20.0)) for axis in "xyz"])


# --- every kind that a wind blows on -------------------------------------------------------------------

DAMPED = {name: 40.0 * value for name, value in vars(lab_crane.BASIC).items() if name.startswith("damping")}
BLOWN = {
    "plane": (lambda: in_plane(space.CRANE, LOAD, 2, 2, areas=AREAS), ("trolley", "rope")),
    "driven": (lambda: windy(slewing=DRIVE, drive_inertia=2e5), ("trolley", "rope", "shaft")),
    "basic": (lambda: lumped_in_wind("basic"), ("shaft", "rope")),
    "multi-mass": (lambda: lumped_in_wind("multi-mass"), ("shaft", "rope")),
}


def lumped_in_wind(kind, **changes):
    drags = {f"drag_{place}": 3.0 for place in ("tower_top", "jib_tip", "counterweight")}
    crane = lab_crane.crane(kind, friction_law="none", **drags, **changes)
    return dataclasses.replace(crane, wind=1, load=Load(50.5, rope_damping=160.0, drag_area=0.5))


@pytest.mark.parametrize("kind", BLOWN)
def test_nothing_moves_at_the_start_in_the_wind(kind):
    make, drives = BLOWN[kind]
    model = make()
    places = {"trolley": 31.0, "rope": 9.0 if "trolley" in drives else 2.0}
    velocity = VELOCITY * [1.0, kind != "plane", 1.0] * (1.0 if "trolley" in drives else 0.4)
    motions = {name: rest(places.get(name, 0.7 if "slewing" in drives else 0.0)) for name in drives} | steady(
        velocity
    )
    cut = phases(tuple(motions[channel] for channel in model.channels), 1.0)
    still, blown = (begun(model, motions | air) for air in (steady([0.0, 0.0, 0.0]), {}))
    slope, weight = (model.system.slope(0.0, state, cut.inputs[0])[0][:-1] for state in (blown, still))
    assert np.max(abs(slope)) < 1e-10 * np.max(abs(weight))


def test_a_damped_crane_comes_to_rest_where_it_would_begin():
    drive = {"drive_soft_stiffness": 2e3, "drive_stiff_stiffness": 4e3, "drive_damping": 1500.0}
    model = lumped_in_wind("basic", **DAMPED, **drive)
    motions = {"shaft": rest(0.0), "rope": rest(2.0)} | steady([3.0, -5.0, 1.0])
    cut = phases(tuple(motions[channel] for channel in model.channels), 90.0)
    fallen = begun(model, motions, start=Start("zero"))
    end = integrate(model.system, cut, fallen, np.array([90.0]), rtol=1e-9, atol=1e-13).end_state
    wanted = begun(model, motions)
    assert np.max(abs(wanted - fallen)[:-1]) > 0.01
    assert_allclose(end[:-1], wanted[:-1], rtol=0, atol=1e-10)
