"""A crane on a ground that moves, tied to a building: against a mast in absolute coordinates, and known limits."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from oracles.mast import Mast
from samples import space_crane as space
from samples.qtz5613 import in_plane

from modal import Beam, Chain, Collar, EndBody, Foundation, Segment, Shaft
from towercrane.cranes.parts.ground import earthquake, floor
from towercrane.cranes.parts.wind import WindAreas, steady
from towercrane.cranes.tower.modes.left_out.effective_mass import effective_mass
from towercrane.cranes.tower.modes.parameters import TowerCrane
from towercrane.kernels.load import AIR_DENSITY, Load
from towercrane.linear.linearise import linearise
from towercrane.motions.motion import rest
from towercrane.simulation.simulate import simulate

PIECES = (30.0, 25.0, 25.0)
M, EI, S, RI = 700.0, 8e9, 2e8, 600.0
BLOCK, TOP = EndBody(120e3, 4e5, -0.6), EndBody(30e3, 2e5, 1.5)
GROUND, COLLARS = Foundation(1.5e10, 8e8, -4e8), {1: Collar(4e7), 2: Collar(4e7, 5e7)}
SEGMENTS = tuple(Segment(length, M, EI, S, RI) for length in PIECES)
TOWER = Chain(SEGMENTS, {0: BLOCK, 3: TOP}, GROUND, collars=COLLARS)

JIB, TAIL, HUNG, ROPE, G = Beam(40.0, 150.0, 2e11, 5e-3), 20.0, 3000.0, 12.0, 9.81
# Balanced: its weight does not bend the tower, and small motions are those of a line.
CRANE = TowerCrane("mast", TOWER, JIB, TAIL, 0.0, 150.0 * 40.0 * 20.0 / TAIL, 400.0, shaft=Shaft(80.0, 900.0, 2.5e8))

STEP = 0.05
SHAKING = np.random.default_rng(4).normal(size=81)
SHAKING[[0, -1]] = 0.0


def mast():
    turning, m = CRANE.end_body, CRANE.trolley_mass
    inertia = TOP.rotary_inertia + TOP.mass * TOP.offset**2 + turning.rotary_inertia
    mass = TOP.mass + turning.mass + m
    arm = TOP.mass * TOP.offset / mass
    bodies = {0: (BLOCK.mass, BLOCK.rotary_inertia, BLOCK.offset), 3: (mass, inertia - mass * arm**2, arm)}
    held = {node: (collar.stiffness, collar.rotation_stiffness) for node, collar in COLLARS.items()}
    springs = GROUND.translation_stiffness, GROUND.coupling, GROUND.rotation_stiffness
    return Mast(PIECES, M, EI, S, RI, springs, bodies, held, HUNG, HUNG * G / ROPE)


def shaken_run(model, motions, duration=4.0):
    return simulate(model, motions, duration, output_step=STEP, rtol=1e-11, atol=1e-14)


@pytest.fixture(scope="module")
def small():
    """A run of motions so small that they are linear, and the same in absolute coordinates."""
    size = 1e-4
    model = in_plane(CRANE, Load(HUNG), tower=14, jib=0, ground=True)
    motions = {"trolley": rest(0.0), "rope": rest(ROPE)}
    motions |= earthquake(STEP * np.arange(81), size * SHAKING[:, None] * (1.0, 0.0, 0.0))
    reference = mast()
    return shaken_run(model, motions), reference, *reference.shaken(STEP, size * SHAKING)


def test_the_top_moves_as_in_absolute_coordinates(small):
    run, reference, rows, ways = small
    top = rows @ reference.nodes[-1, 0] - ways
    assert np.max(abs(run["tower_tip_displacement"].values - top)) < 2e-5 * np.max(abs(top))
    # The load hangs from the top.
    swing = (rows[:, -1] - rows @ reference.nodes[-1, 0]) / ROPE
    assert np.max(abs(run["sway_radial"].values - swing)) < 2e-5 * np.max(abs(swing))


def test_collars_and_base_take_what_springs_do_in_absolute_coordinates(small):
    run, reference, rows, ways = small
    forces = []
    for number, node in enumerate(COLLARS, start=1):
        force = COLLARS[node].stiffness * (rows @ reference.nodes[node, 0] - ways)
        assert np.max(abs(run[f"collar_{number}_force_x"].values - force)) < 2e-3 * np.max(abs(force))
        forces.append(force)
    turned = COLLARS[2].rotation_stiffness * rows @ reference.nodes[2, 1]
    assert np.max(abs(run["collar_2_moment_y"].values - turned)) < 2e-3 * np.max(abs(turned))
    assert "collar_1_moment_y" not in run
    row, stiffness = reference.at_foot
    shear = rows @ row - stiffness * ways
    assert np.max(abs(run["base_force_x"].values - shear)) < 4e-3 * np.max(abs(shear))
    tilt = reference.nodes[0, 1]
    moment = GROUND.rotation_stiffness * rows @ tilt + GROUND.coupling * (rows @ reference.nodes[0, 0] - ways)
    # About the place of the undeformed foot, beside which weights stand now.
    beside = (rows - np.outer(ways, reference.along)) @ reference.mass @ reference.along
    moment += G * (beside + HUNG * (rows @ reference.nodes[-1, 0] - ways))
    assert np.max(abs(run["base_moment_y"].values - moment)) < 1e-2 * np.max(abs(moment))


def test_a_ground_that_rises_steadily_is_more_gravity():
    options = {"tower": 2, "torsion": 1, "lateral": 2, "vertical": 2, "weight_softening": True}
    heavy = space.model(**options, crane=replace(space.CRANE, gravity=2.0 * G))
    risen = space.model(**options, crane=space.CRANE, ground=True)
    rng = np.random.default_rng(6)
    n = risen.coordinates
    state = np.zeros(risen.size)
    state[:n], state[n + 3 : 2 * n + 3] = 0.1 * risen.system.scale[:n] * rng.normal(size=(2, n))
    state[n : n + 3] = -0.6, 0.0, -0.8
    inputs = np.zeros((6, 3))
    inputs[:3] = [20.0, 0.3, 0.1], [12.0, -0.2, 0.0], [0.4, 0.1, 0.05]
    there = np.vstack([inputs[:3], np.zeros((3, 3))])
    there[5, 2] = 0.5 * G
    sides = risen.system.slope(0.0, state, there), heavy.system.slope(0.0, state, inputs[:3])
    for found, wanted in zip(*sides, strict=True):
        size = max(np.max(abs(wanted[:-1])), 1.0)
        assert np.max(abs((found - wanted)[:-1])) < 1e-12 * size


def test_an_earthquake_in_the_jibs_plane_stays_there():
    times, rng = 0.1 * np.arange(21), np.random.default_rng(7)
    rows = rng.normal(size=(21, 3)) * (1.0, 0.0, 0.7)
    drives = {"trolley": rest(20.0), "rope": rest(12.0)} | earthquake(times, rows)
    flat = shaken_run(in_plane(space.CRANE, Load(1500.0, drag_area=5.0), 2, 2, ground=True), drives, 2.0)
    round_ = shaken_run(
        space.model(2, 1, 2, 2, load=Load(1500.0, drag_area=5.0), ground=True), drives | {"slewing": rest(0.0)}, 2.0
    )
    for name, shown in flat.data_vars.items():
        scale = abs(shown.values).max()
        assert np.max(abs(round_[name].values - shown.values)) <= 1e-8 * scale, name
    for name in ("sway_tangential", "tower_tip_twist", "base_force_y", "base_torque"):
        assert np.all(round_[name].values == 0.0)


def test_at_another_heading_the_plane_is_shaken_by_what_lies_in_it():
    times, rng = 0.1 * np.arange(11), np.random.default_rng(8)
    along = rng.normal(size=11)
    drives = {"trolley": rest(20.0), "rope": rest(12.0)}
    runs = []
    for heading, axes in ((0.0, (1.0, 0.0, 0.0)), (0.5 * np.pi, (0.0, 1.0, 0.0)), (np.pi, (-1.0, 0.0, 0.0))):
        model = in_plane(space.CRANE, Load(1500.0), 2, 2, ground=True, heading=heading)
        runs.append(shaken_run(model, drives | earthquake(times, along[:, None] * axes), 1.0))
    for other in runs[1:]:
        for name in ("sway_radial", "tower_tip_displacement", "hoist_rope_force"):
            assert_allclose(other[name], runs[0][name], atol=1e-9 * float(abs(runs[0][name]).max()))
    shear = float(abs(runs[0]["base_force_x"]).max())
    assert_allclose(runs[1]["base_force_y"], runs[0]["base_force_x"], atol=1e-8 * shear)
    assert_allclose(runs[2]["base_force_x"], -runs[0]["base_force_x"], atol=1e-8 * shear)


def test_ground_moves_as_its_acceleration_says_and_goes_on_as_it_was_left():
    motions = earthquake([0.0, 1.0, 3.0], [[0.0, 1.0, 0.0], [2.0, 1.0, 0.0], [2.0, 1.0, -4.0]], 10.0)
    x, y, z = (motions[f"ground_{axis}"] for axis in "xyz")
    assert_allclose([x(0.5, 2), x(2.0, 2), z(2.0, 2)], [1.0, 2.0, -2.0])
    assert_allclose([x(1.0, 1), x(1.0), x(3.0, 1), x(3.0)], [1.0, 1.0 / 3.0, 5.0, 1.0 / 3.0 + 2.0 + 4.0])
    assert_allclose([y(3.0, 1), y(3.0), y(5.0, 1), y(5.0), y(5.0, 2)], [3.0, 4.5, 3.0, 10.5, 0.0])
    moves = floor(2, [0.0, 2.0], [[0.0, 0.1], [0.2, 0.1]])
    assert set(moves) == {"floor_2_x", "floor_2_y"}
    assert_allclose([moves["floor_2_x"](1.0), moves["floor_2_x"](1.0, 1), moves["floor_2_x"](5.0)], [0.1, 0.1, 0.2])


def test_floors_push_by_their_springs_and_keep_the_balance():
    floors = (np.array([0.0, 0.5, 1.0, 2.0]), 1e-3 * np.array([[0.0, 0.0], [4.0, -2.0], [-3.0, 1.0], [5.0, 2.0]]))
    model = space.model(3, 2, 0, 0, load=Load(HUNG), crane=replace(CRANE, jib_lateral=JIB), ground=True, floors=2)
    motions = {"trolley": rest(10.0), "rope": rest(ROPE), "slewing": rest(0.3)}
    motions |= earthquake([0.0, 9.0], np.zeros((2, 3))) | floor(1, *floors) | floor(2, floors[0], 0.0 * floors[1])
    run = shaken_run(model, motions, 2.0)
    # At the start nothing bends but by weights: then the floor alone pulls, k u at once.
    energy, work = run["total_energy"].values, run["input_work"].values
    assert np.max(abs(energy - energy[0] - work)) < 1e-9 * np.max(abs(work))
    heights = np.cumsum(PIECES)[:2]
    bent = run["tower_x_coordinate"].values @ model.crane.tower(heights)
    for number in (1, 2):
        moved = bent[:, number - 1] - np.array([float(motions[f"floor_{number}_x"](t)) for t in run["time"].values])
        assert_allclose(run[f"collar_{number}_force_x"], COLLARS[number].stiffness * moved, rtol=1e-10, atol=1e-6)


def test_a_floor_pulls_the_tower_its_way():
    model = space.model(3, 2, 0, 0, load=Load(HUNG), crane=replace(CRANE, jib_lateral=JIB), ground=True, floors=2)
    n, state, inputs = model.coordinates, np.zeros(model.size), np.zeros((10, 3))
    state[n + 2], inputs[:2, 0] = -1.0, (10.0, ROPE)
    still, moved = model.system.slope(0.0, state, inputs)[0], []
    for row in (6, 9):
        pushed = inputs.copy()
        pushed[row, 0] = 1e-3
        moved.append((model.system.slope(0.0, state, pushed)[0] - still)[n + 3 : 2 * n + 3])
    at_rest = model.at_rest(np.zeros(n), inputs)
    along = -np.array(at_rest.jacobian[2], dtype=float)
    mass = at_rest.mass_matrix() + HUNG * np.outer(along, along)
    # The lowest floor along x, then the next along y.
    for acceleration, part, height, collar in zip(
        moved, ("tower_x", "tower_y"), np.cumsum(PIECES), COLLARS.values(), strict=False
    ):
        pull = np.zeros(n)
        pull[model.parts[part]] = collar.stiffness * 1e-3 * model.crane.tower(height)
        assert_allclose(acceleration, np.linalg.solve(mass, pull), atol=1e-9 * np.max(abs(acceleration)))


def test_a_steady_wind_is_held_by_base_and_collars_together():
    areas = WindAreas(tower=1.5, jib=0.8, counter_jib=0.0, counterweight=3.0)
    crane = replace(CRANE, jib_lateral=JIB, shaft=Shaft(80.0, 900.0, 2.5e8, ((30.0, 6e7), (55.0, 6e7))))
    model = space.model(10, 12, 2, 2, load=Load(HUNG, drag_area=2.0), areas=areas, crane=crane, wind=True)
    motions = {"trolley": rest(10.0), "rope": rest(ROPE), "slewing": rest(0.0)} | steady([0.0, 20.0, 0.0])
    run = simulate(model, motions, 0.02, output_step=0.01).isel(time=0)
    press = 0.5 * AIR_DENSITY * 400.0
    along = press * (1.5 * 80.0 + 0.8 * 40.0 + 3.0 + 2.0)
    held = sum(float(run[f"collar_{k}_force_y"]) for k in (1, 2))
    assert_allclose(float(run["base_force_y"]) + held, along, rtol=2e-4)
    weight = -G * (CRANE.tower_mass + CRANE.slewing_mass + CRANE.trolley_mass + HUNG)
    assert_allclose(float(run["base_force_z"]), weight, rtol=1e-5)
    # The torque on the head twists a shaft on two springs.
    torque = press * (0.8 * 40.0 * 20.0 + 2.0 * 10.0 - 3.0 * TAIL)
    springs, flexible = np.array([6e7, 6e7]), np.minimum.outer((30.0, 55.0), (30.0, 55.0)) / 2.5e8
    twist = np.linalg.solve(np.eye(2) + flexible * springs, np.array([30.0, 55.0]) / 2.5e8 * torque)
    found = [float(run[f"collar_{k}_torque"]) for k in (1, 2)]
    assert_allclose(found, springs * twist, rtol=2e-2)
    # Where the load and the deflected jib stand beside their places, forces have arms that this does not know.
    assert_allclose(float(run["base_torque"]), torque - sum(found), atol=3e-3 * torque)


def test_effective_mass_names_the_modes_that_are_missing():
    found = effective_mass(CRANE)
    assert 0.999 < found.carried(30) <= 1.0 + 1e-12
    enough = found.enough()
    assert found.carried(enough - 1) < 0.9 <= found.carried(enough)
    said = found.notice(3)
    assert f"3 tower modes carry {found.carried(3):.0%}" in said
    assert f"{enough} would carry" in said
    missing = int(np.argmax(found.shares[3:])) + 4
    assert f"missing most: mode {missing} ({found.frequencies[missing - 1]:.3g} Hz)" in said
    assert found.notice(enough) == ""
    # A block on a foot that is held is not shaken.
    held = replace(CRANE, tower=replace(TOWER, foundation=Foundation()))
    assert effective_mass(held).carried(30) == pytest.approx(0.996, abs=3e-3)


def test_a_linear_model_has_the_grounds_acceleration_as_input():
    model = space.model(1, 1, 1, 1, ground=True)
    motions = space.standing(20.0, 12.0) | earthquake([0.0, 1.0], np.zeros((2, 3)))
    linear = linearise(model, motions, outputs=["base_force_x", "tower_tip_displacement"])
    names = [signal.name for signal in linear.inputs]
    column = names.index("ground_x_acceleration")
    unit = 1e-3
    inputs = np.zeros((6, 3))
    inputs[:2, 0] = 20.0, 12.0
    state = model.start(inputs)
    still = model.system.slope(0.0, state, inputs)[0]
    inputs[3, 2] = 0.5 * unit
    pushed = (model.system.slope(0.0, state, inputs)[0] - still) / unit
    n = model.coordinates
    rows = [k for k, signal in enumerate(linear.states) if signal.name == "tower_x_mode_1_rate"]
    assert len(rows) == 1
    assert_allclose(linear.b[rows[0], column], pushed[n + 3], rtol=1e-6)
    assert linear.b[rows[0], column] < 0.0


@pytest.mark.parametrize(
    ("changes", "words"),
    [({"floors": 2}, "floors: wanted 0, or 0"), ({"floors": 1, "ground": True, "crane": CRANE}, "or 2 for a ground")],
)
def test_floors_without_collars_are_refused(changes, words):
    options = {"crane": space.CRANE} | changes
    crane = replace(options["crane"], jib_lateral=None)
    with pytest.raises(ValueError, match=words):
        in_plane(crane, Load(1e3), 1, 1, **{k: v for k, v in changes.items() if k != "crane"})
