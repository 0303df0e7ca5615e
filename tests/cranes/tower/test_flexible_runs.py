"""The flexible crane over time: planes, energy, power, angular momentum, and a manoeuvre with known answers."""

import dataclasses

import numpy as np
import pytest
from numpy.polynomial.legendre import leggauss
from numpy.testing import assert_allclose
from oracles.balance import imbalance
from samples import space_crane as space
from samples.qtz5613 import in_plane
from samples.space_crane import manoeuvre, standing

from modal.beams.beam import Beam
from towercrane.cranes.parts.ground import earthquake
from towercrane.cranes.parts.wind import WindAreas, gusts, steady
from towercrane.cranes.slewing.description import Drive
from towercrane.cranes.tower.equations.constants import SLEWING
from towercrane.cranes.tower.modes.damping import ModalDamping
from towercrane.kernels.algebra import cross
from towercrane.kernels.load import Load
from towercrane.motions.motion import phases, rest, sequence
from towercrane.motions.profiles import trapezoid
from towercrane.simulation.integrate import evaluate, integrate
from towercrane.simulation.simulate import simulate
from towercrane.simulation.starts.start import Start

TIGHT = {"rtol": 1e-12, "atol": 1e-14}
RINGING = {"tower": 1, "torsion": 1, "lateral": 2, "vertical": 2}


def ringing(scene, motions):
    """Every coordinate away from the equilibrium with its drives held, load 29 degrees off the vertical."""
    rng, n = np.random.default_rng(3), scene.coordinates
    state = space.start(scene, motions, start=Start(along=0.5))
    state[:n] += 0.01 * scene.system.scale[:n] * rng.normal(size=n)
    state[n + 3 : 2 * n + 3] = 0.02 * scene.system.scale[:n] * rng.normal(size=n)
    return state


def course(scene, motions, state, duration, step=0.5):
    """Motion over time from a state of one's own, and the outputs."""
    cut = phases(tuple(motions[c] for c in scene.channels), duration)
    times = np.minimum(np.arange(round(duration / step) + 1) * step, duration)
    run = integrate(scene.system, cut, state, times, **TIGHT)
    assert run.outcome == "finished"
    slopes, guards = evaluate(scene.system, cut, run.times, run.states)
    seen = scene.observe(motions, run.times, run.states, slopes, guards)
    return space.kinematics(scene, motions, run.times, run.states), {name: q.values for name, q in seen.items()}


# --- the plane -----------------------------------------------------------------------------------------


def test_crane_started_in_its_plane_stays_there_exactly_and_is_the_crane_of_the_plane():
    motions = {"trolley": trapezoid(5.0, 41.0, 0.8, 0.1), "rope": trapezoid(18.0, 12.0, 0.4, 0.2)}
    options = {"output_step": 0.5, "start": Start(along=0.1), "rtol": 1e-11, "atol": 1e-13}
    space_run = simulate(space.model(2, 1, 2, 3, load=800.0), motions | {"slewing": rest(0.0)}, 60.0, **options)
    plane_run = simulate(in_plane(space.CRANE, Load(800.0), 2, 3), motions, 60.0, **options)
    for name in (
        "sway_tangential",
        "tower_tip_twist",
        "jib_tip_deflection_sideways",
        "slewing_torque",
        "base_torque",
    ):
        assert np.all(space_run[name].values == 0.0), name
    for name in ("tower_y_coordinate", "torsion_coordinate", "jib_lateral_coordinate"):
        assert np.all(space_run[name].values == 0.0), name
    # All that a run in the plane shows is what the run in space shows, to rounding; it leaves out what is zero.
    gone = set(space_run.data_vars) - set(plane_run.data_vars)
    assert all(np.all(space_run[name].values == 0.0) for name in gone - {"payload_in_crane_axes"})
    assert {"trolley_force", "jib_root_moment", "base_moment_y"} < set(plane_run.data_vars)
    for name, shown in plane_run.data_vars.items():
        scale = abs(shown.values).max()
        assert np.max(abs(space_run[name].values - shown.values)) < 1e-9 * scale, name


def test_heading_does_not_change_the_motion_in_the_jibs_plane():
    # Equal tower in all directions: a run at 2.2 rad is the run at zero, turned.
    motions = {"trolley": trapezoid(5.0, 25.0, 0.8, 0.2), "rope": rest(12.0)}
    runs = [
        simulate(
            space.model(2, 1, 2, 2),
            motions | {"slewing": rest(a)},
            30.0,
            start=Start(along=0.2),
            rtol=1e-11,
            atol=1e-13,
        )
        for a in (0.0, 2.2)
    ]
    for name in ("sway_radial", "tower_tip_displacement", "jib_tip_deflection", "hoist_rope_force"):
        assert_allclose(runs[0][name], runs[1][name], atol=1e-9 * float(abs(runs[0][name]).max()))
    assert float(abs(runs[1]["tower_y_coordinate"]).max()) > 1.0


# --- balance -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("softening", [False, True])
def test_energy_stays_while_the_drives_are_held(softening):
    scene = space.model(**RINGING, weight_softening=softening)
    motions = standing(25.0, 12.0, 0.7)
    _, seen = course(scene, motions, ringing(scene, motions), 60.0)
    energy = seen["total_energy"]
    assert np.max(abs(energy - energy[0])) < 1e-13 * 1500 * 9.81 * 12


@pytest.mark.parametrize(("stiff", "bound"), [(4e7, 1e-12), (9e7, 3e-9)])
def test_energy_stays_while_a_springy_drive_is_held(stiff, bound):
    # At a corner the run goes on from the dense output, which is less accurate than a step.
    scene = space.model(**RINGING, slewing=Drive("slewing", 4e7, stiff, 0.002, 0.0, "none"), drive_inertia=1e6)
    motions = {"trolley": rest(25.0), "rope": rest(12.0), "shaft": rest(0.7)}
    motion, seen = course(scene, motions, ringing(scene, motions), 40.0)
    energy, twist = seen["total_energy"], abs(motion.slewing[0] - 0.7)
    assert twist.min() < 0.002 < twist.max()
    assert np.max(abs(energy - energy[0])) < bound * 1500 * 9.81 * 12


def test_power_balance_with_every_drive_loss_and_wind():
    lossy = Load(1500.0, rope_damping=800.0, drag_area=8.0)
    damping = ModalDamping(0.005, 0.005, 0.01, 0.01)
    areas = WindAreas(tower=2.5, jib=1.0, counter_jib=1.2, counterweight=10.0)
    scene = space.model(2, 1, 2, 2, load=lossy, areas=areas, damping=damping, wind=True, weight_softening=True)
    rng = np.random.default_rng(2)
    motions = manoeuvre() | gusts(1.0, [12.0, 5.0, 0.0] + 3.0 * rng.normal(size=(40, 3)))
    _, seen = course(scene, motions, space.start(scene, motions, start=Start(along=0.3)), 46.0)
    assert imbalance(seen) < 1e-10
    assert abs(seen["input_work"][-1]) > 1e4


def test_power_balance_on_a_ground_that_moves_every_way():
    lossy = Load(1500.0, rope_damping=800.0, drag_area=8.0)
    damping = ModalDamping(0.005, 0.005, 0.01, 0.01)
    scene = space.model(2, 1, 2, 2, load=lossy, damping=damping, ground=True, weight_softening=True)
    rng = np.random.default_rng(2)
    times = np.linspace(0.0, 20.0, 101)
    motions = manoeuvre() | earthquake(times, 0.8 * rng.normal(size=(101, 3)), 60.0)
    _, seen = course(scene, motions, space.start(scene, motions, start=Start(along=0.1)), 30.0)
    assert imbalance(seen) < 1e-10
    held = {name: rest(motion.end) if name.startswith("ground") else motion for name, motion in motions.items()}
    _, still = course(scene, held, space.start(scene, held, start=Start(along=0.1)), 30.0)
    assert abs(seen["input_work"] - still["input_work"]).max() > 1e4


def test_power_balance_with_a_drive_that_turns_the_head():
    drive = Drive("slewing", 4e6, 2e7, 0.01, 4e5, "tanh", 5e4, 0.005)
    scene = space.model(**RINGING, load=Load(1500.0, drag_area=6.0), slewing=drive, drive_inertia=1e6)
    motions = manoeuvre()
    motions["shaft"] = motions.pop("slewing")
    motion, seen = course(scene, motions, space.start(scene, motions), 46.0)
    assert imbalance(seen) < 1e-9
    assert abs(motion.slewing[0][-1] - np.pi / 2) < 0.02
    # The shaft leads while it speeds the head up, by more than the corner.
    assert np.max(motion.instant.drives[SLEWING][0] - motion.slewing[0]) > 0.01


def angular_momentum(model, motion):
    """About the vertical through the tower's foot, of everything but the tower's own torsion; shape (p,)."""
    crane, head, (q, rates) = space.CRANE, motion.head, (motion.state.coordinates, motion.state.rates)
    points, weights = leggauss(32)
    spans = [(0.0, crane.jib.length, crane.jib.mass_per_length)]
    spans.append((-crane.counter_jib_length, crane.counter_jib_length, crane.counter_jib_mass_per_length))
    masses = [
        (begin + 0.5 * span * (s + 1), 0.5 * span * w * m)
        for begin, span, m in spans
        for s, w in zip(points, weights, strict=True)
    ]
    masses.append((-crane.counter_jib_length, crane.counterweight))
    (u_x, u_y, *_), (v_x, v_y, *_) = motion.top(q), motion.top(rates)
    moving = [(crane.trolley_mass, *motion.trolley_in_space), (model.load.mass, *motion.load_in_space)]
    for x, mass in masses:
        bent = model.crane.jib_shapes(max(x, 0.0))
        (left, up), (left_rate, up_rate) = motion.deflection(bent, q), motion.deflection(bent, rates)
        turned = cross(head.spin, (x, left, up))
        (x, y, z), speed = (
            head.to_fixed(vector)
            for vector in ((x, left, up), (turned[0], turned[1] + left_rate, turned[2] + up_rate))
        )
        moving.append((mass, (x + u_x, y + u_y, z), (speed[0] + v_x, speed[1] + v_y, speed[2])))
    total = sum(mass * cross(place, speed)[2] for mass, place, speed in moving)
    own = model.crane.tower.mass_matrix()
    x, y = model.parts["tower_x"], model.parts["tower_y"]
    total += np.einsum("it,ij,jt->t", q[x], own, rates[y]) - np.einsum("it,ij,jt->t", q[y], own, rates[x])
    return total + model.drive_inertia * motion.slewing[1]


def test_angular_momentum_stays_where_the_joint_carries_no_torque():
    spring = space.model(**RINGING, slewing=Drive("slewing", 1e6, 1e6, 1.0, 0.0, "none"))
    scene = space.model(**RINGING, slewing=Drive("slewing", 0.0, 0.0, 1.0, 0.0, "none"), drive_inertia=1e5)
    motions = {"trolley": trapezoid(20.0, 35.0, 1.0, 0.2), "rope": trapezoid(12.0, 8.0, 0.4, 0.2), "shaft": rest(0.0)}
    motions["slewing"] = motions["shaft"]
    # No equilibrium without a torque: begin as if a spring held the head.
    state = ringing(spring, motions)
    state[scene.parts["slewing"].start + scene.coordinates + 3] = 0.05
    motion, _ = course(scene, motions, state, 30.0)
    momentum = angular_momentum(scene, motion)
    # Where a head without a coupling turns back, a brake might hold it: its last 1e-11 rad/s are taken for none.
    assert np.max(abs(momentum - momentum[0])) < 1e-10 * abs(momentum[0])
    # Held, the joint carries torque and the ringing head's momentum changes sign.
    held = space.model(**RINGING)
    motions["slewing"] = motions.pop("shaft")
    motion, _ = course(held, motions, ringing(held, motions), 30.0)
    momentum = angular_momentum(held, motion)
    assert momentum.min() < 0.0 < momentum.max()


# --- equilibrium and wind ------------------------------------------------------------------------------


def test_start_from_equilibrium_stays_there_at_any_heading():
    scene = space.model(2, 1, 3, 3, weight_softening=True)
    result = simulate(scene, standing(40.0, 12.0, 1.1), 30.0)
    for name in ("tower_tip_displacement", "jib_tip_deflection"):
        assert np.ptp(result[name].values) < 1e-10
    assert float(abs(result["sway_radial"]).max()) < 1e-10
    moment = 9.81 * (space.CRANE.static_moment + 40.0 * 1850.0)
    lean = result["tower_tip_displacement"].values[0]
    # About the foot: the moments of weights about the tilted tower's top, and what leaning adds.
    assert_allclose(
        np.hypot(result["base_moment_x"][0], result["base_moment_y"][0]),
        moment + 9.81 * (space.CRANE.slewing_mass + 1850.0) * lean,
        rtol=0.03,
    )
    assert abs(float(result["slewing_torque"][0])) < 1e-6


def test_steady_wind_holds_the_load_at_its_known_angle():
    # Rigid crane, heavily damped rope: tan(angle) = c w^2 / m g.
    load = Load(800.0, rope_damping=5e4, drag_area=10.0)
    scene = space.model(0, 0, 0, 0, load=load, wind=True)
    result = simulate(scene, standing(20.0, 10.0) | steady([0.0, 15.0, 0.0]), 200.0, output_step=1.0)
    expected = np.arctan2(0.5 * 1.225 * 10.0 * 15.0**2, 800.0 * 9.81)
    assert_allclose(result["sway_tangential"].values[-1], expected, rtol=1e-6)
    assert_allclose(result["sway_radial"].values[-1], 0.0, atol=1e-9)


def test_steady_wind_turns_the_joint_and_bends_the_tower_by_known_moments():
    areas = WindAreas(tower=2.0, jib=1.0, counter_jib=1.5, counterweight=8.0)
    scene = space.model(0, 0, 0, 0, areas=areas, wind=True)
    result = simulate(scene, standing(20.0, 10.0) | steady([0.0, 20.0, 0.0]), 1.0, output_step=0.5)
    press = 0.5 * 1.225 * 20.0**2
    turning = press * (55.6**2 / 2 - 1.5 * 12.3**2 / 2 - 8.0 * 12.3)
    assert_allclose(result["slewing_torque"], -turning, rtol=1e-9)
    side = press * (55.6 + 1.5 * 12.3 + 8.0)
    assert_allclose(result["base_moment_x"], -(side * 23.8 + press * 2.0 * 23.8**2 / 2), rtol=1e-9)
    assert_allclose(result["jib_root_moment_sideways"], -press * 55.6**2 / 2, rtol=1e-9)


def test_gusts_are_linear_between_their_values():
    wind = gusts(0.5, [[1.0, 0.0, 0.0], [3.0, 1.0, 0.0], [2.0, 1.0, -1.0]])
    assert_allclose(wind["wind_x"]([0.0, 0.25, 0.5, 0.75, 1.0, 9.0]), [1.0, 2.0, 3.0, 2.5, 2.0, 2.0])
    assert_allclose(wind["wind_z"]([0.4, 0.9]), [0.0, -0.8])
    with pytest.raises(ValueError, match="step: wanted a positive time, got 0"):
        gusts(0.0, np.zeros((3, 3)))
    with pytest.raises(ValueError, match="velocities: wanted two or more rows of 3"):
        gusts(0.5, np.zeros((3, 2)))
    with pytest.raises(ValueError, match="velocity: wanted 3 finite components"):
        steady([1.0, 2.0])


# --- the manoeuvre -------------------------------------------------------------------------------------


def manoeuvred(*modes, rtol=1e-9, duration=120.0, **options):
    """Sway in the frame of the commanded angle [deg], torque [kN m] and load's place of the manoeuvre."""
    result = simulate(space.model(*modes, **options), manoeuvre(), duration, rtol=rtol, atol=1e-2 * rtol)
    assert result.attrs["outcome"] == "finished"
    radial, lateral = np.tan(result["sway_radial"].values), np.tan(result["sway_tangential"].values)
    c, s = np.cos(result["tower_tip_twist"].values), np.sin(result["tower_tip_twist"].values)
    sway = np.degrees(np.arctan([radial * c - lateral * s, radial * s + lateral * c]))
    return abs(sway).max(axis=1), float(abs(result["slewing_torque"]).max()) / 1e3, result["payload_position"].values


def test_rigid_and_single_mode_cranes_sway_as_computed_elsewhere():
    # Figures of an independent program for the same crane, to the digits that it prints.
    sway, torque, _ = manoeuvred(0, 0, 0, 0)
    assert np.all(abs(np.array([*sway, torque]) - [4.09, 7.63, 183]) < [0.006, 0.006, 0.6])
    sway, torque, one = manoeuvred(1, 1, 1, 1)
    assert np.all(abs(np.array([*sway, torque]) - [15.10, 15.20, 333]) < [0.006, 0.006, 0.6])
    sway, torque, more = manoeuvred(2, 1, 2, 2, rtol=1e-8)
    assert np.all(abs(np.array([*sway, torque]) - [14.97, 15.24, 333]) < [0.02, 0.02, 0.6])
    # What one mode of each kind leaves out, over 120 s.
    gap = one - more
    assert_allclose(np.max(np.hypot(gap[:, 0], gap[:, 1])), 0.12, atol=0.02)


def test_model_refuses_what_it_cannot_be():
    with pytest.raises(ValueError, match="axes: wanted 3 for a crane that moves out of its plane, got 2"):
        space.model(1, 0, 0, 1, axes=2)
    with pytest.raises(ValueError, match="wanted friction 'none' or 'tanh', got 'stick-slip'"):
        space.model(slewing=Drive("slewing", 1.0, 1.0, 1.0, 0.0, "stick-slip"))
    with pytest.raises(ValueError, match="wanted 'prescribed', 'fixed' or a Drive, got 'free'"):
        space.model(slewing="free")
    with pytest.raises(ValueError, match=r"drive_inertia: wanted 0 without a drive, got 5.0"):
        space.model(drive_inertia=5.0)
    with pytest.raises(ValueError, match=r"ModalDamping.torsion: wanted a finite number, zero or more, got -0.1"):
        ModalDamping(torsion=-0.1)
    with pytest.raises(ValueError, match=r"FlexibleCrane.planes: wanted 1 or 2, got 3"):
        space.model(planes=3)
    with pytest.raises(
        ValueError, match=r"TowerCrane.jib_lateral: wanted lengths and masses as in the plane, got .*50.0"
    ):
        dataclasses.replace(space.CRANE, jib_lateral=Beam(50.0, 123.8, 206e9, 0.002))
    with pytest.raises(ValueError, match=r"ModeCounts.torsion: wanted zero or more, got -1"):
        space.model(1, -1, 0, 0)
    planar = dataclasses.replace(space.CRANE, shaft=None)
    with pytest.raises(ValueError, match=r"TowerCrane.shaft: wanted for 1 torsion modes, got None"):
        space.model(1, 1, 0, 0, crane=planar)
    with pytest.raises(ValueError, match=r"WindAreas.jib: wanted a finite number, zero or more, got -1.0"):
        WindAreas(jib=-1.0)


def test_ends_of_the_jib_and_slack_ropes_end_a_run_by_name():
    out = standing(20.0, 10.0) | {"trolley": trapezoid(20.0, 60.0, 2.0, 0.5)}
    result = simulate(space.model(1, 1, 1, 1), out, 40.0)
    assert result.attrs["outcome"] == "trolley off the jib"
    dropped = standing(20.0, 10.0) | {"rope": sequence(rest(5.0, 1.0), trapezoid(5.0, 25.0, 8.0, 14.0))}
    result = simulate(space.model(1, 1, 1, 1), dropped, 5.0)
    assert (result.attrs["outcome"], result.attrs["end_time"]) == ("slack rope", pytest.approx(1.0, abs=0.01))
