"""Runs that begin in the steady rotation of their head, against runs that keep it and against plain equations."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples import lab_crane, luffing_crane, space_crane
from samples.every_kind import COUPLING, flexible, jib_plan
from samples.jib_cranes import planned

from towercrane import Load, load_case
from towercrane.kernels.elastic_rope import Elasticity
from towercrane.motions.motion import Motion, phases, rest
from towercrane.runs.run import record_case
from towercrane.simulation.integrate import integrate
from towercrane.simulation.outcomes import SLACK_ROPE, UNSTABLE
from towercrane.simulation.simulate import record
from towercrane.simulation.starts import steady
from towercrane.simulation.starts.begin import begin, rope_direction
from towercrane.simulation.starts.steady import Frame, steady_rotation
from towercrane.simulation.system import NoEquilibrium

SPAN = 25.0


def turn(rate, angle=0.4):
    return Motion(np.array([0.0, SPAN]), np.array([[angle, rate]]), rate)


def inputs_of(model, motions):
    return phases(tuple(motions[channel] for channel in model.channels), SPAN)


def still(scene, **motions):
    """Motions of a scene, all at rest and in still air but for these."""
    rests = {name: rest(0.0 if name.startswith("wind") else float(own(0.0))) for name, own in scene.motions.items()}
    return rests | motions


SCENES = {
    "prescribed slewing": lambda: (lambda s: (s.model, still(s, slewing=turn(0.0733))))(flexible()),
    "slewing drive": lambda: (lambda s: (s.model, still(s, shaft=turn(0.0733))))(
        flexible(slewing=COUPLING, drive_inertia=5e4)
    ),
    "elastic rope": lambda: (
        space_crane.model(1, 1, 1, 1, Load(1500.0, 300.0, 2.0, Elasticity(14e6, 32.5, 3e-3))),
        {"trolley": rest(31.0), "rope": rest(12.0), "slewing": turn(0.0733)},
    ),
    "basic": lambda: (lab_crane.crane("basic"), {"shaft": turn(0.6), "rope": rest(2.0)}),
    "multi-mass": lambda: (lab_crane.crane("multi-mass"), {"shaft": turn(-0.6), "rope": rest(2.0)}),
    "stick-slip": lambda: (
        lab_crane.crane("enhanced", friction_law="stick-slip"), {"shaft": turn(0.6), "rope": rest(2.0)},
    ),
    "luffing crane": lambda: (
        luffing_crane.model(1, 1, 1, 1, Load(3000.0, drag_area=3.0)),
        {"luffing": rest(0.8), "rope": rest(25.0), "slewing": turn(0.09)},
    ),
    "planned jib crane": lambda: (
        planned(), {name: rest(float(own(0.0))) for name, own in jib_plan().items()} | {"slew": turn(0.15)},
    ),
}  # fmt: skip


@pytest.mark.parametrize("kind", SCENES)
def test_a_steady_rotation_is_kept_to_the_last_digits(kind):
    model, motions = SCENES[kind]()
    cut = inputs_of(model, motions)
    state, rate = begin(model, cut.inputs[0]), cut.inputs[0, model.turning.channel, 1]
    run = integrate(model.system, cut, state, np.array([SPAN]), rtol=1e-12, atol=1e-14)
    back = model.turning.turned(run.end_state, -rate * SPAN)
    size = np.where(np.isfinite(model.system.scale), model.system.scale, 1.0)
    assert np.max(abs(back - state)[:-1] / size[:-1]) < 2e-11
    # The load is thrown out, and what a static start would lack is no rounding.
    resting = model.start(cut.inputs[0])
    half = len(state) // 2
    assert np.max(abs(state - resting)[:half] / size[:half]) > 1e-3


def test_the_basic_crane_turns_as_its_forces_say():
    """Balance of forces in axes that turn, with the drag of still air; friction is what the drive must overcome."""
    model = lab_crane.crane("basic", drag_jib_tip=2.0)
    rate, length, own = 0.6, 2.0, lab_crane.BASIC
    state = begin(model, inputs_of(model, {"shaft": turn(rate), "rope": rest(length)}).inputs[0])
    mass, tip_mass, radius, g = model.load.mass, own.mass_jib_tip, own.geometry_jib_radius, 9.81

    def length_of(vector):
        return np.sqrt(vector @ vector)

    def left(unknowns):
        x, y, z, *load = unknowns
        tip, load = np.array([radius + x, y, z]), np.array(load)
        rope = load - tip
        pull = own.stiffness_rope * (length_of(rope) - length) * rope / length_of(rope)
        springs = -np.array(
            [own.stiffness_jib_radial * x, own.stiffness_jib_lateral * y, own.stiffness_jib_vertical * z]
        )
        velocity = rate * np.array([-tip[1], tip[0], 0.0])
        drag = -2.0 * length_of(velocity) * velocity
        inward = -(rate**2) * np.array([1.0, 1.0, 0.0])
        down = np.array([0.0, 0.0, -g])
        gone = rate * np.array([-load[1], load[0], 0.0])
        on_load = -model.load.drag * length_of(gone) * gone
        on_tip = springs + pull + drag + tip_mass * (down - inward * tip)
        return np.concatenate([on_tip, on_load - pull + mass * (down - inward * load)])

    found = np.array([0.0, 0.0, 0.0, radius, 0.0, -length - 1e-3])
    for _ in range(30):
        # Newton's method; derivatives by imaginary steps are exact.
        slopes = np.imag([left(found + 1e-30j * step) for step in np.eye(6)]).T / 1e-30
        found = found - np.linalg.solve(slopes, left(found))
    assert np.max(abs(left(found))) < 1e-8
    x, y, z, *load = found
    names = model.crane.coordinates
    found = dict(zip(names, state, strict=False))
    assert_allclose([found["jib_radial"], found["jib_lateral"], found["jib_vertical"]], [x, y, z], atol=1e-11)
    rope = np.array(load) - (radius + x, y, z)
    angle = found["platform_angle"]
    c, s = np.cos(angle), np.sin(angle)
    turned = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]) @ rope / np.linalg.norm(rope)
    inputs = inputs_of(model, {"shaft": turn(rate), "rope": rest(length)}).inputs[0]
    assert_allclose(rope_direction(model, state, inputs), turned, atol=1e-11)
    # The shaft is ahead by what friction and the air on the tip take.
    arm = np.hypot(radius + x, y)
    taken = own.friction_torque * np.tanh(rate / own.friction_rate) + 2.0 * (rate * arm) ** 2 * arm
    out = np.hypot(*load[:2])
    taken += model.load.drag * (rate * out) ** 2 * out
    ahead = 0.4 - angle
    stiff = own.drive_soft_stiffness * own.drive_corner + own.drive_stiff_stiffness * (ahead - own.drive_corner)
    assert_allclose(own.drive_soft_stiffness * ahead if ahead < own.drive_corner else stiff, taken, rtol=1e-9)


def test_false_equilibria_are_refused_by_name():
    model = lab_crane.crane("multi-mass")
    cut = inputs_of(model, {"shaft": turn(0.6), "rope": rest(2.0)})
    frame = Frame.of(model, cut.inputs[0])
    upright = model.start(cut.inputs[0])
    upright[model.rope + 2] = 1.0
    with pytest.raises(NoEquilibrium) as caught:
        steady_rotation(model, upright, frame)
    assert caught.value.outcome in (SLACK_ROPE, UNSTABLE)
    rod = lab_crane.crane("multi-mass", rope_as_rod=True)
    with pytest.raises(NoEquilibrium) as caught:
        steady_rotation(rod, upright, frame)
    assert caught.value.outcome == SLACK_ROPE
    # Beyond their critical speed the tower's springs do not hold what turns on it.
    fast = {"shaft": turn(60.0), "rope": rest(2.0)}
    with pytest.raises(NoEquilibrium) as caught:
        begin(model, inputs_of(model, fast).inputs[0])
    assert caught.value.outcome == UNSTABLE
    run = record(model, fast, 1.0)
    assert (run.attrs["outcome"], run.attrs["end_time"]) == (UNSTABLE, 0.0)
    assert "rpm" in run.attrs["message"]


def test_of_three_rotations_of_a_long_rope_the_one_that_is_left_is_refused(monkeypatch):
    """On a short arm a fast turn has three, one outward and two inward, of which the lower one is no saddle."""
    monkeypatch.setattr(steady, "SPEEDS", 1)
    model, rate, length = planned(), 1.0, 30.0
    plan = {"slew": turn(rate, 0.0), "luff": rest(1.5), "fold": rest(0.0), "rope": rest(length)}
    frame = Frame.of(model, inputs_of(model, plan).inputs[0])
    arm = 25.0 * np.cos(1.5)

    def found(sway):
        return steady_rotation(model, np.array([np.sin(sway), 0.0, -np.cos(sway), 0.0, 0.0, 0.0, 0.0]), frame)

    for guess in (-0.2, 1.2):
        state = found(guess)
        # The load's weight and what throws it out pull along the rope.
        assert_allclose(-state[0] / state[2], rate**2 * (arm + length * state[0]) / 9.81, rtol=1e-10)
    with pytest.raises(NoEquilibrium, match="is left at a rate"):
        found(-1.25)


def test_in_a_wind_nothing_turns_steadily():
    scene = flexible()
    motions = still(scene, slewing=turn(0.07), wind_x=rest(8.0))
    with pytest.raises(NoEquilibrium, match="in a wind nothing turns steadily"):
        begin(scene.model, inputs_of(scene.model, motions).inputs[0])


FEW = [f"model.{kind}=1" for kind in ("tower_modes", "jib_lateral_modes", "jib_vertical_modes")]
SPEEDS = "speed='0.7 rpm', start_speed='0.7 rpm', end_speed='0.7 rpm', ramp='2 s', hold='1 s'"


def test_a_case_whose_turn_begins_at_speed_shows_nothing_but_the_turn():
    changes = [*FEW, "motion.slewing={shape='speed-trapezoid', " + SPEEDS + "}", "run.duration=8 s"]
    changes += ["motion.trolley={shape='rest', start='30 m'}", "motion.hoist={shape='rest'}"]
    run = record_case(load_case("qtz5613/slewing", [*changes, "solver.rtol=1e-10", "solver.atol=1e-12"]))
    assert run.attrs["outcome"] == "finished"
    # It goes on at its speed after its last ramp.
    assert_allclose(run["slewing_speed"].values, 0.7 * 2 * np.pi / 60, rtol=1e-12)
    assert_allclose(run["slewing_angle"].values[-1], 8.0 * 0.7 * 2 * np.pi / 60, rtol=1e-12)
    for name in ("sway_radial", "sway_tangential", "jib_tip_deflection", "slewing_torque", "hoist_rope_force"):
        values = run[name].values
        assert np.ptp(values) < 1e-8 * max(abs(values).max(), 1e-2), name
    assert run["sway_radial"].values[0] > 0.01
