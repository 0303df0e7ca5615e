"""The jib crane's balances and symmetries: energy, momentum about the post, turned plans."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from oracles.balance import imbalance
from samples.jib_cranes import (
    HEAVY,
    LOAD,
    TIGHT,
    G,
    constant,
    peak,
    planned,
    smooth_plan,
    standing,
    trapezoid_plan,
)

from towercrane.cranes.jib.linear import static_matrices
from towercrane.cranes.jib.model import TORQUES, DrivenJibCrane
from towercrane.kernels.load import Load
from towercrane.motions.motion import Motion, phases, rest
from towercrane.simulation.integrate import integrate
from towercrane.simulation.simulate import simulate
from towercrane.simulation.starts.begin import begin
from towercrane.simulation.starts.start import Start


@pytest.mark.parametrize("motions", [smooth_plan(), trapezoid_plan()], ids=["smooth", "trapezoids"])
@pytest.mark.parametrize("load", [LOAD, Load(5000.0, rope_damping=2e4, drag_area=30.0)], ids=["lossless", "lossy"])
def test_energy_gained_is_the_work_of_joints_and_winch_less_losses(motions, load):
    result = simulate(planned(load=load), motions, 100.0, output_step=0.5, **TIGHT)
    assert imbalance(result) < 5e-12
    assert peak(result["input_work"]) > 1e5


def momentum_about_the_post(states, crane, load, length):
    """J theta' of post and booms (rods: their points move across their plane by slewing alone), and the load's."""
    theta, n, rates, p = states[:, :3], states[:, 3:6], states[:, 6:9], states[:, 9:12]
    first, second = crane.primary_length, crane.secondary_length
    h2, h3 = first * np.cos(theta[:, 1]), second * np.cos(theta[:, 1] + theta[:, 2])
    primary, secondary = crane.primary_mass_per_length * first, crane.secondary_mass_per_length * second
    inertia = crane.post_inertia + primary * h2**2 / 3 + secondary * (h2**2 + h2 * h3 + h3**2 / 3)
    reach = h2 + h3
    drawn_in = -first * np.sin(theta[:, 1]) * rates[:, 1]
    drawn_in -= second * np.sin(theta[:, 1] + theta[:, 2]) * (rates[:, 1] + rates[:, 2])
    turn = np.exp(1j * theta[:, 0])
    place = reach * turn + length * (n[:, 0] + 1j * n[:, 1])
    speed = (drawn_in + 1j * reach * rates[:, 0]) * turn + length * (p[:, 0] + 1j * p[:, 1])
    return inertia * rates[:, 0] + load.mass * (place.conj() * speed).imag


def test_free_booms_keep_energy_and_momentum_about_the_post():
    model = DrivenJibCrane(HEAVY, LOAD, (0.3, 0.9, -0.4), (0.3, 0.2, -0.3), rope_as_rod=True)
    idle = dict(zip(model.channels, constant(0.0, 0.0, 0.0, 20.0), strict=True))
    cut, times = phases(tuple(idle.values()), 3.0), np.linspace(0.0, 3.0, 31)
    start = begin(model, cut.inputs[0], Start("zero", along=0.3))
    run = integrate(model.system, cut, start, times, rtol=1e-13, atol=1e-15)
    momentum = momentum_about_the_post(run.states, HEAVY, LOAD, 20.0)
    assert peak(momentum) > 1e5
    assert np.ptp(momentum) < 1e-11 * peak(momentum)
    assert np.ptp(run.states[:, 1]) > 0.5
    assert np.all(run.states[:, -1] == 0.0)
    result = simulate(model, idle, 3.0, start=Start(along=0.3), rtol=1e-13, atol=1e-15)
    energy = result["total_energy"].values
    assert np.ptp(energy) < 1e-12 * peak(energy)


def test_every_joint_gets_its_own_torque():
    times, shares = np.array([0.0, 2.0]), np.array([1.0, 0.02, -0.003])
    torques = {
        name: Motion(times, size * shares[None]) for name, size in zip(TORQUES, (3e4, 1.7e6, 5e5), strict=False)
    }
    model = DrivenJibCrane(HEAVY, LOAD, (0.3, 0.6, -0.2))
    result = simulate(model, torques | {"rope": rest(20.0)}, 2.0, output_step=0.25)
    wanted = np.stack([torque(result.time.values) for torque in torques.values()], axis=1)
    assert_allclose(result["joint_torque"], wanted, rtol=1e-14)
    # And each moves its own joint: at the start by the masses alone.
    start = model.start(np.zeros((4, 3)))
    inputs = phases((*torques.values(), rest(20.0)), 1.0).inputs[0]
    bare = inputs.copy()
    bare[:3] = 0.0
    slopes = [model.system.slope(0.0, start, row)[0] for row in (inputs, bare)]
    mass, _ = static_matrices(HEAVY, LOAD, 0.6, -0.2, 20.0)
    condensed = mass[:3, :3] - mass[:3, 3:] @ np.linalg.solve(mass[3:, 3:], mass[3:, :3])
    rates = slice(6, 9)
    assert_allclose(condensed @ (slopes[0] - slopes[1])[rates], inputs[:3, 0], rtol=1e-9)


@pytest.mark.parametrize("swing_angle", [0.0, 0.4])
def test_energy_at_rest_counts_from_the_foot_of_the_post(swing_angle):
    luff, fold, rope = 0.6, -0.2, 20.0
    result = simulate(
        planned(), standing(0.7, luff, fold, rope), 0.1, output_step=0.1, start=Start(along=swing_angle)
    )
    hinge = HEAVY.post_height + 15.0 * np.sin(luff)
    heights = {
        200.0 * 15.0: HEAVY.post_height + 7.5 * np.sin(luff),
        120.0 * 10.0: hinge + 5.0 * np.sin(luff + fold),
        LOAD.mass: hinge + 10.0 * np.sin(luff + fold) - rope * np.cos(swing_angle),
    }
    wanted = G * sum(mass * height for mass, height in heights.items())
    assert_allclose(result["total_energy"][0], wanted, rtol=1e-14)


def test_slewing_the_whole_plan_turns_the_whole_answer():
    options = {"output_step": 0.5, **TIGHT}
    straight = simulate(planned(), smooth_plan(), 80.0, start=Start(along=0.05), **options)
    turned = simulate(planned(), smooth_plan(2.3), 80.0, start=Start(along=0.05), **options)
    for name in ("sway_in_plane", "sway_lateral", "hoist_rope_force", "total_energy", "joint_torque"):
        assert peak(turned[name] - straight[name]) < 1e-9 * peak(straight[name])
    c, s = np.cos(2.3), np.sin(2.3)
    rotated = straight["payload_position"].values @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
    assert_allclose(turned["payload_position"], rotated, atol=1e-8)
