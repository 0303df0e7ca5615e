"""Linear models against closed forms, frequencies of the undeformed crane, and small motions of the simulator."""

import dataclasses
import json
import os
import subprocess
import sys

import numpy as np
import pytest
from numpy.testing import assert_allclose
from qtz5613 import CRANE, model, standing
from scipy.io import loadmat
from scipy.linalg import expm

from towercrane import load_case
from towercrane.cranes.radial import RadialModel
from towercrane.differences import jacobian
from towercrane.linear_report import linear_model
from towercrane.linearise import linearise
from towercrane.motion import rest, trapezoid
from towercrane.payload import Load
from towercrane.recording import Quantity
from towercrane.simulate import simulate
from towercrane.statespace import OperatingPoint, Signal, StateSpace
from towercrane.system import plain_system

G = 9.81
TIGHT = {"rtol": 1e-13, "atol": 1e-16}


def weightless(gravity: float, **options) -> RadialModel:
    return RadialModel(dataclasses.replace(CRANE, gravity=gravity), Load(800.0), **options)


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
    tension = names(linear.outputs).index("rope_tension")
    assert_allclose(linear.d[tension], [0.0, -800.0], rtol=1e-12)
    assert_allclose(linear.point.outputs[tension], 800.0 * G, rtol=1e-14)
    assert linear.outputs[tension] == ("rope_tension", "N")
    assert not {"total_energy", "input_work", "payload_position"} & set(names(linear.outputs))
    assert [signal.units for signal in linear.states] == ["rad", "rad/s", "m", "m", "m/s", "m/s"]
    assert [str(signal) for signal in linear.inputs] == [f"{n}_acceleration [m/s^2]" for n in ("trolley", "rope")]


def test_spatial_pendulum_sways_alike_both_ways_and_has_no_state_too_many():
    linear = linearise(model(0, 0, axes=3), standing(20.0, 18.0), inputs="motion", outputs=[])
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
    linear = linearise(model(*modes, axes=axes), standing(20.0, 18.0), outputs=[])
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
    crane = model(0, 0, axes=axes)
    inputs = np.array([[20.0, 0.0, 0.0], [18.0, 0.0, 0.0]])
    state = crane.start(inputs, "zero", angle)
    state[axes], state[2 * axes - 1] = rate * np.cos(angle), rate * np.sin(angle)
    linear = linearise(crane, inputs, state=state, outputs=["swing_angle", "swing_rate"])
    assert_allclose(linear.a[axes - 1, 0], -G * np.cos(angle) / 18.0 - rate**2, rtol=1e-11)
    assert_allclose(linear.a[axes - 1, axes - 1], 0.0, atol=1e-12)
    assert_allclose(linear.c[:, [0, axes - 1]], np.eye(2), rtol=1e-11, atol=1e-12)
    assert_allclose(linear.point.states[[0, axes - 1]], [0.0, rate], atol=1e-14)
    assert_allclose(linear.point.slope[[0, axes - 1]], [rate, -G * np.sin(angle) / 18.0], rtol=1e-12)


def test_air_drag_at_rest_is_of_second_order():
    linear = linearise(RadialModel(CRANE, Load(800.0, drag_area=5.0), 0, 0), standing(20.0, 18.0), outputs=[])
    assert abs(linear.a[1, 1]) < 1e-11
    assert linear.error < 1e-9


# --- the flexible crane --------------------------------------------------------------------------------


@pytest.mark.parametrize("axes", [2, 3])
def test_without_gravity_the_matrices_are_those_of_the_undeformed_crane(axes):
    crane = weightless(0.0, axes=axes)
    linear = linearise(crane, standing(23.0, 18.0), inputs="motion", outputs=[])
    mass, stiffness = crane.linear_matrices(23.0, 18.0)
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
        return found / crane.natural_frequencies(23.0, 18.0) - 1.0

    gaps = np.array([gap(gravity) for gravity in (G, G / 100, G / 1000)])
    assert 1e-3 < np.max(abs(gaps[0])) < 3e-2
    assert np.max(abs(gaps[2])) < 3e-5
    assert_allclose(gaps[1, 1:] / gaps[2, 1:], 10.0, rtol=0.05)
    # The pendulum hangs on a structure that is bent at first order, and feels it at second.
    assert_allclose(gaps[1, 0] / gaps[2, 0], 100.0, rtol=0.05)


def test_frequencies_with_all_weights_beside_the_undeformed_crane():
    crane = model(2, 3, self_weight=False)
    found = 2 * np.pi * linearise(crane, standing(20.0, 18.0), outputs=[]).frequencies
    assert_allclose(found, crane.natural_frequencies(20.0, 18.0), rtol=1e-2)
    assert_allclose(found[0], crane.natural_frequencies(20.0, 18.0)[0], rtol=1e-4)


def test_damping_ratios_are_recovered():
    crane = weightless(0.0, tower_modes=1, jib_modes=0, tower_damping_ratio=0.03)
    light = dataclasses.replace(crane, crane=dataclasses.replace(crane.crane, trolley_mass=1e-6), load=Load(1e-6))
    [row] = [e for e in linearise(light, standing(0.0, 18.0)).eigenvalues() if e.state == "tower_mode_1"]
    assert_allclose(row.damping_ratio, 0.03, rtol=1e-8)
    assert_allclose(row.frequency, light.tower.frequencies_hz[0], rtol=1e-8)
    # On the whole crane the two ratios bracket what the structure's modes have.
    whole = linearise(model(2, 3, tower_damping_ratio=0.02, jib_damping_ratio=0.01), standing(20.0, 18.0))
    structure = [e.damping_ratio for e in whole.eigenvalues()[5:]]
    assert len(structure) == 5
    assert 0.005 < min(structure) < max(structure) < 0.03


def test_dominant_states_do_not_depend_on_units():
    linear = linearise(model(2, 3, axes=3), standing(20.0, 18.0))
    found = [e.state for e in linear.eigenvalues()][4:]
    wanted = "sway_outward sway_sideways jib_mode_1 tower_mode_1 jib_mode_2 tower_mode_2 jib_mode_3"
    assert found == wanted.split()
    size = 10.0 ** np.random.default_rng(1).uniform(-6, 6, 9)
    by_name = dict(zip(dict.fromkeys(n.removesuffix("_rate") for n in names(linear.states)), size, strict=True))
    units = np.array([by_name[n.removesuffix("_rate")] for n in names(linear.states)])
    other = dataclasses.replace(linear, a=linear.a * units / units[:, None])
    assert [e.state for e in other.eigenvalues()][4:] == found


# --- against the simulator -----------------------------------------------------------------------------

SHOWN = ("swing_angle", "tower_tip_displacement", "jib_tip_deflection", "rope_tension")


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
        rtol = 1e-5 if name == "rope_tension" else 1e-7
        largest = np.max(abs(expected[:, column]))
        assert np.max(abs(found[name] - expected[:, column])) < rtol * largest, name


def test_free_sway_of_the_simulator():
    crane, step = model(2, 3, tower_damping_ratio=0.01), 0.05
    runs = [
        simulate(crane, standing(20.0, 18.0), 30.0, swing_angle=angle, output_step=step, **TIGHT)
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


# --- a steady rotation ---------------------------------------------------------------------------------

LENGTH, RADIUS, MASS = 2.0, 2.0, 50.0


class Arm:
    """Rigid arm that slews and carries a load: by a prescribed angle, or free with an inertia of its own."""

    axes = 3

    def __init__(self, inertia=None):
        self.inertia = inertia
        self.n = 0 if inertia is None else 1
        self.channels = ("slew",) if inertia is None else ()
        self.state_names = {} if inertia is None else {"platform": "rad"}
        self.system = dataclasses.replace(
            plain_system(self.rhs, 2 * self.n + 7), scale=np.full(2 * self.n + 7, np.inf)
        )

    def rhs(self, t, y, dy, inputs, *_):
        n = self.n
        direction, swing = y[n : n + 3], y[2 * n + 3 : 2 * n + 6]
        if n:
            angle, rate = y[0], y[n + 3]
        else:
            c = inputs[0]
            angle, rate, turn = c[0] + t * (c[1] + t * c[2]), c[1] + 2 * t * c[2], 2 * c[2]
        out, side = np.array([np.cos(angle), np.sin(angle), 0]), np.array([-np.sin(angle), np.cos(angle), 0])
        inward = -RADIUS * rate**2 * out + [0, 0, G]
        if n:
            # I phi'' = R T side.n with the tension T = m (l p.p - n.(a_D + g e_z)).
            across = RADIUS * (side @ direction)
            turn = MASS * across * (LENGTH * swing @ swing - direction @ inward) / (self.inertia + MASS * across**2)
            dy[0], dy[n + 3] = rate, turn
        pull = inward + RADIUS * turn * side
        dy[n : n + 3] = swing
        dy[2 * n + 3 : 2 * n + 6] = -(pull - (pull @ direction) * direction) / LENGTH - swing @ swing * direction
        dy[-1] = 0.0

    def start(self, inputs, state="equilibrium", swing_angle=0.0):
        y = np.zeros(self.system.size)
        y[self.n + 2] = -1.0
        return y

    def observe(self, motions, times, states, guards):
        return {"payload": Quantity(("time", "axis"), states[:, self.n : self.n + 3], "m", "rope direction")}


def cone(rate):
    """Tilt of the rope in steady rotation."""
    tilt = 0.1
    for _ in range(200):
        tilt = np.arctan(rate**2 * (RADIUS + LENGTH * np.sin(tilt)) / G)
    return tilt


def turning_state(rate, angle, leading=()):
    tilt = cone(rate)
    across, along = np.array([np.cos(angle), np.sin(angle), 0]), np.array([-np.sin(angle), np.cos(angle), 0])
    return np.concatenate([
        leading[:1], np.sin(tilt) * across - [0, 0, np.cos(tilt)], leading[1:], np.sin(tilt) * rate * along, [0.0],
    ])  # fmt: skip


@pytest.mark.parametrize("angle", [0.0, 0.7, 4.0])
def test_steady_rotation_of_a_prescribed_arm(angle):
    rate, tilt = 0.738, cone(0.738)
    inputs = np.array([[angle, rate, 0.0]])
    linear = linearise(Arm(), inputs, state=turning_state(rate, angle), turning="slew", inputs="motion", outputs=[])
    # Hessian of the effective potential and the Coriolis term, per mass and length.
    s, c, reach = np.sin(tilt), np.cos(tilt), RADIUS + LENGTH * np.sin(tilt)
    pull = G * c + rate**2 * reach * s
    expected = np.zeros((4, 4))
    expected[:2, 2:] = np.eye(2)
    expected[2, 0] = -(pull - rate**2 * LENGTH * c**2) / LENGTH
    expected[3, 1] = -(pull - rate**2 * LENGTH) / LENGTH
    expected[2, 3], expected[3, 2] = 2 * rate * c, -2 * rate * c
    assert_allclose(linear.a, expected, rtol=1e-10, atol=1e-12)
    assert_allclose(linear.point.slope, 0.0, atol=1e-12)
    # Which way the arm points is nothing to the load; faster turning throws it out; a push leaves it behind.
    thrown = 2 * rate * reach * c / LENGTH
    assert_allclose(linear.b, [[0, 0, 0], [0, 0, 0], [0, thrown, 0], [0, 0, -reach / LENGTH]], rtol=1e-10, atol=1e-12)


def test_inertial_directions_are_no_equilibrium_of_a_rotation():
    state = turning_state(0.738, 0.0)
    linear = linearise(Arm(), np.array([[0.0, 0.738, 0.0]]), state=state, inputs="motion", outputs=[])
    assert np.max(abs(linear.point.slope)) > 0.09


def test_free_platform_turns_without_resistance():
    inertia = 151.0
    linear = linearise(Arm(inertia), {}, outputs=["payload"])
    assert [s.name for s in linear.outputs] == ["payload_outward", "payload_sideways", "payload_up"]
    assert linear.inputs == ()
    table = linear.eigenvalues()
    assert [e.value for e in table[:2]] == [0.0, 0.0]
    assert [e.state for e in table] == ["platform", "platform", "sway_outward", "sway_sideways"]
    both = np.sqrt(G / LENGTH * np.array([1.0, 1.0 + MASS * RADIUS**2 / inertia]))
    assert_allclose(2 * np.pi * linear.frequencies, both, rtol=1e-10)


def test_free_platform_in_steady_rotation_keeps_its_momentum():
    rate, angle = 0.738, 0.7
    state = turning_state(rate, angle, leading=(angle, rate))
    linear = linearise(Arm(151.0), {}, state=state, turning="platform", outputs=[])
    assert_allclose(linear.point.slope, [rate, 0, 0, 0, 0, 0], atol=1e-12)
    assert np.all(linear.a[:, 0] == 0.0)
    # Angle and momentum are free: two zero eigenvalues, and two oscillations.
    values = np.sort(abs(np.linalg.eigvals(linear.a)))
    assert np.max(values[:2]) < 1e-5 < 1.0 < values[2]
    assert_allclose(np.linalg.eigvals(linear.a).real, 0.0, atol=1e-5)
    # A whole turn of the frame is no other frame.
    again = turning_state(rate, angle + 2.0, leading=(angle + 2.0, rate))
    assert_allclose(linearise(Arm(151.0), {}, state=again, turning="platform", outputs=[]).a, linear.a, atol=1e-11)


def test_a_sway_far_from_the_vertical():
    # At an angle the rope swings with its tangent: l s'' = -g sin, so -g cos / l; sideways the tension remains.
    tilt = 2.5
    state = np.array([np.sin(tilt), 0, -np.cos(tilt), 0, 0, 0, 0.0])
    linear = linearise(Arm(), np.array([[0.0, 0.0, 0.0]]), state=state, inputs="motion", outputs=[])
    assert_allclose(np.diag(linear.a[2:, :2]), -G * np.cos(tilt) / LENGTH * np.ones(2), rtol=1e-10)
    assert_allclose(linear.point.slope, [0, 0, -G * np.sin(tilt) / LENGTH, 0], atol=1e-13)
    upright = linearise(Arm(), np.zeros((1, 3)), state=np.array([0, 0, 1.0, 0, 0, 0, 0]), inputs="motion", outputs=[])
    assert_allclose(np.sort(np.linalg.eigvals(upright.a).real), np.sqrt(G / LENGTH) * np.array([-1, -1, 1, 1]))


def test_frame_must_turn_with_something_known():
    with pytest.raises(ValueError, match="turning: wanted one of slew, got 'tilt'"):
        linearise(Arm(), np.zeros((1, 3)), turning="tilt", outputs=[])


# --- differences ---------------------------------------------------------------------------------------


def test_derivatives_of_smooth_sharp_and_kinked_functions():
    def function(x):
        u, v = x
        return np.array([np.exp(u), u**7 + v, np.tanh(v / 0.01), abs(v) * v + 3 * v, max(v, 0.0), 1e6 * np.sin(u)])

    values, errors = jacobian(function, np.array([1.0, 0.0]), np.array([1.0, 1.0]))
    expected = [[np.e, 0], [7, 1], [0, 100], [0, 3], [0, 0.5], [1e6 * np.cos(1), 0]]
    assert_allclose(values, expected, rtol=1e-10, atol=1e-12)
    assert np.all(abs(values - expected) <= 100 * errors + 1e-11 * np.max(np.abs(expected), axis=1)[:, None])


# --- files and wrong arguments -------------------------------------------------------------------------


@pytest.mark.parametrize("ending", [".mat", ".npz"])
def test_saved_file_is_read_back(tmp_path, ending):
    linear, path = linearise(model(1, 1), standing(20.0, 18.0)), tmp_path / f"crane{ending}"
    linear.save(path)
    assert [p.name for p in tmp_path.iterdir()] == [path.name]
    read = loadmat(path, squeeze_me=True) if ending == ".mat" else np.load(path)
    for name in "ABCD":
        assert_allclose(read[name], getattr(linear, name.lower()), rtol=0)
    for kind in ("states", "inputs", "outputs"):
        assert read[kind].tolist() == [signal.name for signal in getattr(linear, kind)]
        assert read[f"{kind[:-1]}_units"].tolist() == [signal.units for signal in getattr(linear, kind)]
    assert_allclose(read["x0"], linear.point.states, rtol=0)
    assert_allclose(read["y0"], linear.point.outputs, rtol=0)


def test_a_file_that_cannot_be_written_leaves_the_old_one(tmp_path, monkeypatch):
    linear, path = linearise(model(0, 0), standing(20.0, 18.0)), tmp_path / "crane.npz"
    path.write_bytes(b"old")

    def fail(file, **_):
        file.write(b"half")
        raise OSError("disk full")

    monkeypatch.setattr(np, "savez", fail)
    with pytest.raises(OSError, match="disk full"):
        linear.save(path)
    assert [(p.name, p.read_bytes()) for p in tmp_path.iterdir()] == [("crane.npz", b"old")]
    with pytest.raises(ValueError, match=r"\.mat or \.npz"):
        linear.save(tmp_path / "crane.txt")


def test_eigenvalues_of_a_given_matrix():
    def states(matrix, *called):
        n, nothing = len(called), np.empty(0)
        point = OperatingPoint(nothing, nothing, nothing, nothing, nothing)
        signals = tuple(Signal(name, "") for name in called)
        return StateSpace(
            np.array(matrix), np.zeros((n, 0)), np.zeros((0, n)), np.zeros((0, 0)), signals, (), (), point
        )

    oscillator = states([[0.0, 1.0, 0.0], [-4.0, -0.4, 0.0], [0.0, 0.0, -3.0]], "x", "x_rate", "lag")
    pair, real = oscillator.eigenvalues()
    assert_allclose([pair.frequency, pair.damping_ratio], [1 / np.pi, 0.1], rtol=1e-12)
    assert (pair.state, real.state, real.value, real.damping_ratio) == ("x", "lag", -3.0, 1.0)
    assert_allclose(oscillator.frequencies, [1 / np.pi])
    assert states([[2.0]], "fall").eigenvalues()[0].damping_ratio == -1.0
    with pytest.raises(ValueError, match=r"StateSpace\.a: wanted shape \(1, 1\)"):
        states([[1.0, 2.0]], "x")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"inputs": "force"}, "inputs: wanted 'acceleration' or 'motion', got 'force'"),
        ({"outputs": ["sing_angle"]}, "outputs: 'sing_angle' is none of trolley_position"),
        ({"state": np.zeros(3)}, r"state: wanted shape \(5,\), got \(3,\)"),
        ({"turning": "trolley"}, "turning: wanted a load that swings in space"),
        ({"motions": {"trolley": rest(1.0)}}, "motions: wanted trolley, rope; 'rope' is missing"),
        ({"motions": np.zeros((1, 3))}, "motions: wanted a row for each"),
    ],
)
def test_wrong_arguments_are_named(change, message):
    motions = change.pop("motions", standing(20.0, 18.0))
    with pytest.raises(ValueError, match=message):
        linearise(model(0, 0), motions, **change)


# --- the command ---------------------------------------------------------------------------------------


def towercrane(*arguments, cwd):
    command = [sys.executable, "-m", "towercrane.cli", "linearise", *arguments]
    environment = {**os.environ, "NO_COLOR": "1", "PYTHONIOENCODING": "utf-8"}
    return subprocess.run(command, capture_output=True, encoding="utf-8", cwd=cwd, env=environment, check=False)


def test_command_prints_writes_and_says_what_is_next(tmp_path):
    done = towercrane("qtz5613/condition-3", "--at", "20", "--out", "out/crane.mat", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    linear = linear_model(load_case("qtz5613/condition-3"), 20.0)
    assert "trolley 17.8 m, rope 18 m" in done.stdout
    for frequency in linear.frequencies:
        assert f" {frequency:.6f} " in done.stdout
    assert "sway outward" in done.stdout
    assert "│ trolley " not in done.stdout  # a drive is no motion of the crane
    assert "-0.000000" not in done.stdout
    assert done.stdout.splitlines()[-2:] == ["written to out/crane.mat", "next: towercrane run qtz5613/condition-3"]
    assert_allclose(loadmat(tmp_path / "out" / "crane.mat")["A"], linear.a, rtol=1e-12, atol=1e-12)


def test_command_in_json(tmp_path):
    done = towercrane("qtz5613/condition-3", "--json", cwd=tmp_path)
    report = json.loads(done.stdout)
    assert report["states"][0] == {"name": "tower_mode_1", "units": "kg^0.5 m", "value": report["states"][0]["value"]}
    assert np.shape(report["A"]) == (16, 16)
    assert [e["damping_ratio"] for e in report["eigenvalues"][:4]] == [None] * 4
    assert_allclose(report["eigenvalues"][4]["frequency_hz"], 0.1174, atol=1e-4)
    assert list(tmp_path.iterdir()) == []


def test_command_refuses_what_it_cannot_do(tmp_path):
    done = towercrane("qtz5613/condition-3", "--out", "crane.txt", cwd=tmp_path)
    assert (done.returncode, done.stderr) == (2, "--out crane.txt: wanted a file that ends in .mat or .npz\n")
    assert towercrane("qtz5613/condition-3", "--at", "nan", cwd=tmp_path).returncode == 2
    soft = ("--set", "model.weight_softening=true", "--set", "crane.tower.second_moment_of_area=0.0002 m^4")
    done = towercrane("qtz5613/condition-3", *soft, cwd=tmp_path)
    assert done.returncode == 3, done.stderr
    assert "tower buckled" in done.stderr
