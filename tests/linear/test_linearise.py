"""Linear models against closed forms, frequencies of the undeformed crane, and small motions of the simulator."""

import dataclasses

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples.qtz5613 import CRANE, in_plane, model, standing
from scipy.linalg import expm

from towercrane.cranes.tower.equations.small_motions import plane_matrices, plane_modes
from towercrane.kernels.load import Load
from towercrane.linear.linearise import linearise
from towercrane.motions.motion import rest
from towercrane.motions.profiles import trapezoid
from towercrane.simulation.simulate import simulate
from towercrane.simulation.starts.begin import begin
from towercrane.simulation.starts.start import Start

G = 9.81
TIGHT = {"rtol": 1e-13, "atol": 1e-16}


def weightless(gravity: float, **options):
    return in_plane(dataclasses.replace(CRANE, gravity=gravity), Load(800.0), **options)


def names(signals) -> list[str]:
    return [signal.name for signal in signals]


# --- the rope alone ------------------------------------------------------------------------------------


def test_rigid_crane_is_a_pendulum_driven_by_the_trolley():
    linear = linearise(model(0, 0), standing(20.0, 18.0))
    assert names(linear.states) == [
        "sway_outward",
        "sway_outward_rate",
        "trolley",
        "rope",
        "trolley_rate",
        "rope_rate",
    ]
    assert names(linear.inputs) == ["trolley_acceleration", "rope_acceleration"]
    a, b = np.zeros((6, 6)), np.zeros((6, 2))
    a[0, 1], a[1, 0], a[2:4, 4:] = 1.0, -G / 18.0, np.eye(2)
    b[1, 0], b[4:] = -1.0 / 18.0, np.eye(2)
    assert_allclose(linear.a, a, rtol=1e-12, atol=0)
    assert_allclose(linear.b, b, rtol=1e-12, atol=0)
    assert_allclose(2 * np.pi * linear.frequencies, np.sqrt(G / 18.0), rtol=1e-12)
    tension = names(linear.outputs).index("hoist_rope_force")
    assert_allclose(linear.d[tension], [0.0, -800.0], rtol=1e-12)
    assert_allclose(linear.point.outputs[tension], 800.0 * G, rtol=1e-14)
    assert linear.outputs[tension] == ("hoist_rope_force", "N")
    assert not {"total_energy", "input_work", "payload_position"} & set(names(linear.outputs))
    assert [signal.units for signal in linear.states] == ["rad", "rad/s", "m", "m", "m/s", "m/s"]
    assert [str(signal) for signal in linear.inputs] == [f"{n}_acceleration [m/s^2]" for n in ("trolley", "rope")]


def test_spatial_pendulum_sways_alike_both_ways_and_has_no_state_too_many():
    linear = linearise(dataclasses.replace(model(0, 0), axes=3), standing(20.0, 18.0), inputs="motion", outputs=[])
    assert names(linear.states) == ["sway_outward", "sway_sideways", "sway_outward_rate", "sway_sideways_rate"]
    assert_allclose(2 * np.pi * linear.frequencies, np.sqrt(G / 18.0) * np.ones(2), rtol=1e-12)
    assert {e.state for e in linear.eigenvalues()} == {"sway_outward", "sway_sideways"}
    assert names(linear.inputs)[:3] == ["trolley", "rope", "trolley_rate"]
    expected = np.zeros((4, 6))
    expected[2, 4] = -1.0 / 18.0
    assert_allclose(linear.b, expected, rtol=1e-12, atol=0)


@pytest.mark.parametrize("axes", [2, 3])
@pytest.mark.parametrize("modes", [(0, 0), (2, 3)])
def test_only_the_drives_have_zero_eigenvalues(axes, modes):
    linear = linearise(dataclasses.replace(model(*modes), axes=axes), standing(20.0, 18.0), outputs=[])
    at_zero = [e for e in linear.eigenvalues() if abs(e.value) < 1e-3]
    assert [e.value for e in at_zero] == [0.0] * 4
    assert sorted(e.state for e in at_zero) == ["rope", "rope", "trolley", "trolley"]
    assert len(linear.frequencies) == sum(modes) + axes - 1
    assert len(linear.states) == 2 * len(linear.frequencies) + 4


def test_hoisting_rate_damps_or_drives_the_sway():
    # l s'' + 2 l' s' + g s = 0 for a rope at this length and rate.
    crane, inputs = model(0, 0), np.array([[20.0, 0.0, 0.0], [18.0, -0.5, 0.0]])
    linear = linearise(crane, inputs, state=crane.start(inputs), outputs=[])
    assert_allclose(linear.a[1, :2], [-G / 18.0, 2 * 0.5 / 18.0], rtol=1e-12)
    assert_allclose(linear.point.slope[3], -0.5)
    halted = linearise(crane, inputs, outputs=[])
    assert halted.a[1, 1] == 0.0
    assert np.all(halted.point.slope == 0.0)


def test_motion_at_a_time():
    motions = {"trolley": trapezoid(5.0, 41.0, 0.8, 0.1), "rope": rest(18.0)}
    crane = model(0, 0)
    moving = linearise(crane, motions, time=4.0, state=crane.start(np.array([[5.8, 0, 0], [18.0, 0, 0]])), outputs=[])
    assert_allclose(moving.point.states, [0, 0, 5.8, 18.0, 0.4, 0.0], atol=1e-14)
    assert_allclose(moving.point.inputs, [0.1, 0.0])
    assert_allclose(moving.point.slope, [0, -0.1 / 18.0, 0.4, 0.0, 0.1, 0.0], atol=1e-14)
    rows = np.array([[5.0, 0.0, 0.05], [18.0, 0.0, 0.0]])
    same = linearise(crane, rows, time=4.0, state=moving.point.full_state, outputs=[])
    assert_allclose(same.point.states, moving.point.states, atol=1e-14)
    assert_allclose(same.a, moving.a, atol=1e-14)


@pytest.mark.parametrize(("axes", "angle", "rate"), [(2, 0.4, 0.3), (3, 0.4, 0.3), (3, -1.2, 0.8)])
def test_a_rope_in_mid_swing(axes, angle, rate):
    # s = sin(theta - theta0), so s'' = -g cos(theta0) / l s - theta0'^2 s at first order.
    crane = dataclasses.replace(model(0, 0), axes=axes)
    inputs = np.array([[20.0, 0.0, 0.0], [18.0, 0.0, 0.0]])
    state = begin(crane, inputs, Start("zero", along=angle))
    state[axes], state[2 * axes - 1] = rate * np.cos(angle), rate * np.sin(angle)
    linear = linearise(crane, inputs, state=state, outputs=["sway_radial", "swing_rate"])
    assert_allclose(linear.a[axes - 1, 0], -G * np.cos(angle) / 18.0 - rate**2, rtol=1e-11)
    assert_allclose(linear.a[axes - 1, axes - 1], 0.0, atol=1e-12)
    assert_allclose(linear.c[:, [0, axes - 1]], np.eye(2), rtol=1e-11, atol=1e-12)
    assert_allclose(linear.point.states[[0, axes - 1]], [0.0, rate], atol=1e-14)
    assert_allclose(linear.point.slope[[0, axes - 1]], [rate, -G * np.sin(angle) / 18.0], rtol=1e-12)


def test_air_drag_at_rest_is_of_second_order():
    linear = linearise(in_plane(CRANE, Load(800.0, drag_area=5.0), 0, 0), standing(20.0, 18.0), outputs=[])
    assert abs(linear.a[1, 1]) < 1e-11
    assert linear.error < 1e-9


# --- the flexible crane --------------------------------------------------------------------------------


@pytest.mark.parametrize("axes", [2, 3])
def test_without_gravity_the_matrices_are_those_of_the_undeformed_crane(axes):
    crane = dataclasses.replace(weightless(0.0), axes=axes)
    linear = linearise(crane, standing(23.0, 18.0), inputs="motion", outputs=[])
    mass, stiffness = plane_matrices(weightless(0.0), 23.0, 18.0)
    to_distance = np.diag([1.0] * 5 + [18.0])
    expected = -np.linalg.solve(mass @ to_distance, stiffness @ to_distance)
    half = 5 + axes - 1
    found = linear.a[half : half + 6, :6]
    assert_allclose(found, expected, rtol=1e-9, atol=1e-11 * abs(expected).max())
    assert_allclose(linear.a[:half, half:], np.eye(half), rtol=0, atol=0)
    assert linear.error < 1e-10


def test_the_weights_shift_the_frequencies_at_first_order():
    def gap(gravity):
        crane = weightless(gravity)
        found = 2 * np.pi * linearise(crane, standing(23.0, 18.0), outputs=[]).frequencies
        return found / plane_modes(crane, 23.0, 18.0)[0] - 1.0

    gaps = np.array([gap(gravity) for gravity in (G, G / 100, G / 1000)])
    assert 1e-3 < np.max(abs(gaps[0])) < 3e-2
    assert np.max(abs(gaps[2])) < 3e-5
    assert_allclose(gaps[1, 1:] / gaps[2, 1:], 10.0, rtol=0.05)
    # The pendulum hangs on a structure that is bent at first order, and feels it at second.
    assert_allclose(gaps[1, 0] / gaps[2, 0], 100.0, rtol=0.05)


def test_frequencies_with_all_weights_beside_the_undeformed_crane():
    crane = model(2, 3, self_weight=False)
    found = 2 * np.pi * linearise(crane, standing(20.0, 18.0), outputs=[]).frequencies
    assert_allclose(found, plane_modes(crane, 20.0, 18.0)[0], rtol=1e-2)
    assert_allclose(found[0], plane_modes(crane, 20.0, 18.0)[0][0], rtol=1e-4)


def test_damping_ratios_are_recovered():
    bare = dataclasses.replace(CRANE, gravity=0.0, trolley_mass=1e-6)
    light = in_plane(bare, Load(1e-6), tower=1, jib=0, damping=(0.03, 0.0))
    [row] = [
        e for e in linearise(light, standing(0.0, 18.0), outputs=[]).eigenvalues() if e.state == "tower_x_mode_1"
    ]
    assert_allclose(row.damping_ratio, 0.03, rtol=1e-8)
    assert_allclose(row.frequency, light.crane.tower.frequencies_hz[0], rtol=1e-8)
    # On the whole crane the two ratios bracket what the structure's modes have.
    whole = linearise(model(2, 3, damping=(0.02, 0.01)), standing(20.0, 18.0), outputs=[])
    structure = [e.damping_ratio for e in whole.eigenvalues()[5:]]
    assert len(structure) == 5
    assert 0.005 < min(structure) < max(structure) < 0.03


def test_dominant_states_do_not_depend_on_units():
    linear = linearise(dataclasses.replace(model(2, 3), axes=3), standing(20.0, 18.0), outputs=[])
    found = [e.state for e in linear.eigenvalues()][4:]
    structure = "jib_vertical_mode_1 tower_x_mode_1 jib_vertical_mode_2 tower_x_mode_2 jib_vertical_mode_3"
    assert found == ["sway_outward", "sway_sideways", *structure.split()]
    size = 10.0 ** np.random.default_rng(1).uniform(-6, 6, 9)
    by_name = dict(zip(dict.fromkeys(n.removesuffix("_rate") for n in names(linear.states)), size, strict=True))
    units = np.array([by_name[n.removesuffix("_rate")] for n in names(linear.states)])
    other = dataclasses.replace(linear, a=linear.a * units / units[:, None])
    assert [e.state for e in other.eigenvalues()][4:] == found


# --- against the simulator -----------------------------------------------------------------------------

SHOWN = ("sway_radial", "tower_tip_displacement", "jib_tip_deflection", "hoist_rope_force")


def response(linear, start, accelerations, step):
    """Outputs under accelerations of the trolley that are constant over each step, first row the start's."""
    n, m = linear.b.shape
    block = np.zeros((n + m, n + m))
    block[:n, :n], block[:n, n:] = linear.a, linear.b
    carry = expm(block * step)
    x, rows = start, []
    for pull in accelerations:
        u = np.array([pull, 0.0])
        rows.append(linear.c @ x + linear.d @ u)
        x = carry[:n, :n] @ x + carry[:n, n:] @ u
    return np.array(rows)


def odd_part(forward, backward, name):
    """Half the difference of two mirrored runs: what is even in the amplitude drops out."""
    return 0.5 * (forward[name].values - backward[name].values)


def assert_responses_agree(found, expected):
    for column, name in enumerate(SHOWN):
        # The change of tension is a millionth of the tension, which is what the simulator resolves to 1e-12.
        rtol = 1e-5 if name == "hoist_rope_force" else 1e-7
        largest = np.max(abs(expected[:, column]))
        assert np.max(abs(found[name] - expected[:, column])) < rtol * largest, name


def test_free_sway_of_the_simulator():
    crane, step = model(2, 3, damping=(0.01, 0.0)), 0.05
    runs = [
        simulate(crane, standing(20.0, 18.0), 30.0, start=Start(along=angle), output_step=step, **TIGHT)
        for angle in (1e-4, -1e-4)
    ]
    linear = linearise(crane, standing(20.0, 18.0), outputs=SHOWN)
    start = np.zeros(len(linear.states))
    start[names(linear.states).index("sway_outward")] = 1e-4
    expected = response(linear, start, np.zeros(len(runs[0].time)), step)
    assert_responses_agree({name: odd_part(*runs, name) for name in SHOWN}, expected)


def test_driven_response_of_the_simulator():
    crane, step, way = model(2, 3), 0.05, 2e-4
    # Four seconds up and four down: switch times fall on rows.
    runs = [
        simulate(crane, {"trolley": trapezoid(20.0, 20.0 + s * way, 5e-5, 1.25e-5), "rope": rest(18.0)}, 30.0,
                 output_step=step, **TIGHT)
        for s in (1, -1)
    ]  # fmt: skip
    linear = linearise(crane, standing(20.0, 18.0), outputs=SHOWN)
    time = np.arange(len(runs[0].time)) * step
    pull = np.where(time < 4.0 - 1e-6, 1.25e-5, np.where(time < 8.0 - 1e-6, -1.25e-5, 0.0))
    expected = response(linear, np.zeros(len(linear.states)), pull, step)
    assert_responses_agree({name: odd_part(*runs, name) for name in SHOWN}, expected)
