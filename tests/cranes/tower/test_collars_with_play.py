"""A tower that collars hold with play: against exact motion between contacts, static pushes, and its limits."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from oracles.loose_mast import LooseMast
from oracles.mast import Mast
from samples import space_crane as space
from samples.qtz5613 import in_plane

from modal import Beam, Chain, Collar, EndBody, Foundation, Segment, Shaft
from modal.structures.chain_modes import chain_modes
from towercrane.cranes.parts.ground import earthquake, floor
from towercrane.cranes.tower.equations.play import contact_stiffness
from towercrane.cranes.tower.modes.collars import TowerCollar
from towercrane.cranes.tower.modes.gap_shapes import gap_shapes
from towercrane.cranes.tower.modes.parameters import TowerCrane
from towercrane.kernels.load import Load
from towercrane.motions.motion import rest
from towercrane.simulation.simulate import simulate

PIECES = (30.0, 25.0, 25.0)
M, EI, S, RI = 700.0, 8e9, 2e8, 600.0
BLOCK, TOP = EndBody(120e3, 4e5, -0.6), EndBody(30e3, 2e5, 1.5)
GROUND = Foundation(1.5e10, 8e8, -4e8)
TOWER = Chain(tuple(Segment(length, M, EI, S, RI) for length in PIECES), {0: BLOCK, 3: TOP}, GROUND)
HEIGHTS, STIFF = (30.0, 55.0), (4e6, 2e6)

JIB, TAIL, HUNG, ROPE, G = Beam(40.0, 150.0, 2e11, 5e-3), 20.0, 3000.0, 12.0, 9.81
# Balanced: its weight does not bend the tower, and small motions are those of a line.
BARE = TowerCrane("mast", TOWER, JIB, TAIL, 0.0, 150.0 * 40.0 * 20.0 / TAIL, 400.0, jib_lateral=JIB,
                  shaft=Shaft(80.0, 900.0, 2.5e8))  # fmt: skip
STEP = 0.05
SHAKING = np.random.default_rng(4).normal(size=81)
SHAKING[[0, -1]] = 0.0


def loose(*gaps, crane=BARE):
    collars = zip(HEIGHTS, STIFF, gaps, strict=False)
    return replace(crane, gapped=tuple(TowerCollar(height, k, gap=gap) for height, k, gap in collars))


def mast(collars):
    turning, m = BARE.end_body, BARE.trolley_mass
    inertia = TOP.rotary_inertia + TOP.mass * TOP.offset**2 + turning.rotary_inertia
    mass = TOP.mass + turning.mass + m
    arm = TOP.mass * TOP.offset / mass
    bodies = {0: (BLOCK.mass, BLOCK.rotary_inertia, BLOCK.offset), 3: (mass, inertia - mass * arm**2, arm)}
    springs = GROUND.translation_stiffness, GROUND.coupling, GROUND.rotation_stiffness
    return Mast(PIECES, M, EI, S, RI, springs, bodies, collars, HUNG, HUNG * G / ROPE)


def run_of(model, motions, duration=4.0, **options):
    options = {"output_step": STEP, "rtol": 1e-11, "atol": 1e-14} | options
    return simulate(model, motions, duration, **options)


def shaken(size, axes=(1.0, 0.0, 0.0)):
    motions = {"trolley": rest(0.0), "rope": rest(ROPE), "slewing": rest(0.0)}
    return motions | earthquake(STEP * np.arange(81), size * SHAKING[:, None] * axes)


def test_a_shaken_tower_meets_its_collars_as_one_that_is_solved_exactly_between_contacts():
    size, gaps = 1e-4, (4e-7, 2e-6)
    exact = LooseMast(mast, {node: (k, gap) for node, k, gap in zip((1, 2), STIFF, gaps, strict=True)})
    rows, ways = exact.run(STEP, size * SHAKING)
    assert exact.contacts > 20
    run = run_of(in_plane(loose(*gaps), Load(HUNG), tower=9, jib=0, ground=True), shaken(size))
    nodes = mast({}).nodes
    top = rows @ nodes[-1, 0] - ways
    assert np.max(abs(run["tower_tip_displacement"].values - top)) < 1e-4 * np.max(abs(top))
    swing = (rows[:, -1] - rows @ nodes[-1, 0]) / ROPE
    assert np.max(abs(run["sway_radial"].values - swing)) < 5e-5 * np.max(abs(swing))
    for number, (k, gap) in enumerate(zip(STIFF, gaps, strict=True), start=1):
        way = rows @ nodes[number, 0] - ways
        force = k * np.sign(way) * np.maximum(abs(way) - gap, 0.0)
        shown = run[f"collar_{number}_force_x"].values
        assert np.max(abs(shown - force)) < 1.5e-2 * np.max(abs(force))
        assert 40 < np.count_nonzero(force) < 60
        inside = shown[abs(way) < 0.99 * gap]
        assert np.all(inside == 0.0)
        assert not np.signbit(inside).any()


def test_the_energy_is_kept_through_contacts_in_space_with_floors_that_move():
    model = space.model(3, 1, 0, 0, load=Load(HUNG), crane=loose(4e-3, 8e-3), ground=True, floors=2)
    times = 0.2 * np.arange(21)
    ways = 4e-3 * np.random.default_rng(5).normal(size=(2, 21, 2))
    ways[:, 0] = 0.0
    motions = shaken(1.0, (1.0, 0.6, 0.4)) | floor(1, times, ways[0]) | floor(2, times, ways[1])
    run = run_of(model, motions, output_step=0.01, rtol=1e-12)
    energy, work = run["total_energy"].values, run["input_work"].values
    assert np.max(abs(energy - energy[0] - work)) < 1e-10 * np.max(abs(work))
    bent = [run[f"tower_{axis}_coordinate"].values @ model.crane.tower(HEIGHTS) for axis in "xy"]
    for number in (1, 2):
        moved = np.array([[float(motions[f"floor_{number}_{axis}"](t)) for t in run["time"].values] for axis in "xy"])
        x, y = (own[:, number - 1] - floor for own, floor in zip(bent, moved, strict=True))
        way = np.hypot(x, y)
        push = STIFF[number - 1] * np.maximum(way - model.crane.collars[number - 1].gap, 0.0)
        # How often the tower comes to the collar.
        assert np.count_nonzero(np.diff(push > 0.0)) > 10
        for axis, along in zip("xy", (x, y), strict=True):
            wanted = push * along / np.maximum(way, 1e-300)
            assert_allclose(run[f"collar_{number}_force_{axis}"], wanted, atol=1e-9 * push.max())


def test_a_floor_that_moves_farther_than_its_play_pushes_by_the_rest():
    """At rest: u = gap + F / k + F / k_tower, along the floor's way."""
    model = space.model(2, 1, 0, 0, load=Load(HUNG), crane=loose(4e-3, 8e-3), ground=True, floors=2)
    exact = mast({})
    inputs = np.zeros((10, 3))
    inputs[1, 0] = ROPE
    for number, k, gap in zip((1, 2), STIFF, (4e-3, 8e-3), strict=True):
        row = exact.nodes[number, 0] @ exact.shapes
        gives = float(row / exact.omega**2 @ row)
        for way in (0.5 * gap, gap + 1e-6, gap + 1e-4):
            moved = inputs.copy()
            moved[4 + 2 * number : 6 + 2 * number, 0] = 0.6 * way, -0.8 * way
            q = model.equilibrium(moved)
            force = max(way - gap, 0.0) / (1.0 / k + gives)
            bent = [q[model.parts[part]] @ model.crane.tower(HEIGHTS[number - 1]) for part in ("tower_x", "tower_y")]
            assert_allclose(bent, force * gives * np.array([0.6, -0.8]), rtol=1e-8, atol=1e-16)


def test_a_tower_finds_its_rest_among_collars_however_they_stand():
    """Corners of the forces lie within the steps of differences, and Newton's steps pass several."""
    model = space.model(2, 1, 0, 0, load=Load(HUNG), crane=loose(1e-5, 5e-3), ground=True, floors=2)
    rng, pressed, n = np.random.default_rng(9), [], model.coordinates
    for _ in range(30):
        inputs = np.zeros((10, 3))
        inputs[:3, 0] = rng.uniform(0.0, 40.0), ROPE, rng.uniform(0.0, 6.0)
        inputs[6:, 0] = 10.0 ** rng.uniform(-6, -2) * rng.normal(size=4)
        q = model.equilibrium(inputs)
        forces, stiffness = model.contact(q, inputs)
        left = model.static_forces(q[:, None], inputs)[:, 0] + forces
        assert np.max(abs(left)) < 1e-9 * np.max(abs(forces))
        pressed.append(np.linalg.matrix_rank(stiffness))
        step = 1e-9 * rng.normal(size=n)
        change = model.contact(q - step, inputs)[0] - model.contact(q + step, inputs)[0]
        assert np.max(abs(change - 2.0 * stiffness @ step)) < 1e-3 * np.max(abs(change))
    # Each collar that is met resists in two directions.
    assert {2, 4} == set(pressed)


@pytest.mark.parametrize("height", HEIGHTS)
def test_a_shape_for_each_collar_makes_a_slow_push_exact(height):
    body, exact = BARE.end_body, mast({})
    shapes = gap_shapes(TOWER, 2, body, HEIGHTS)
    free = chain_modes(TOWER, 2, body)
    assert_allclose(shapes.angular_frequencies[:2], free.angular_frequencies, rtol=1e-12)
    assert_allclose(shapes([10.0, 80.0])[:2], free([10.0, 80.0]), rtol=1e-12)
    turned, moved = shapes.rotation(80.0), shapes(80.0)
    mass = shapes.mass_matrix() + body.mass * np.outer(moved, moved) + body.rotary_inertia * np.outer(turned, turned)
    assert_allclose(mass, np.eye(4), atol=1e-11)
    found = shapes([*HEIGHTS, 80.0]).T @ np.linalg.solve(shapes.stiffness_matrix(), shapes(height))
    row = exact.nodes[1 + HEIGHTS.index(height), 0] @ exact.shapes
    # The pendulum takes nothing at rest.
    wanted = [exact.nodes[node, 0] @ exact.shapes / exact.omega**2 @ row for node in (1, 2, 3)]
    assert_allclose(found, wanted, rtol=1e-9)


def test_collars_that_always_hold_bend_with_the_tower():
    """A static shape beside springs: the stiffness of both as that of the chain that has them all."""
    held = replace(TOWER, collars={1: Collar(4e7, 3e8)})
    shapes = gap_shapes(held, 1, BARE.end_body, HEIGHTS[1:])
    pushed = shapes.stiffness_matrix() + 2e7 * np.outer(shapes(55.0), shapes(55.0))
    own = float(shapes(55.0) @ np.linalg.solve(pushed, shapes(55.0)))
    exact = mast({1: (4e7, 3e8), 2: (2e7, 0.0)})
    row = exact.nodes[2, 0] @ exact.shapes
    assert own == pytest.approx(float(row / exact.omega**2 @ row), rel=1e-9)


def test_frequencies_on_closed_collars_are_near_those_of_the_tower_on_its_springs_as_printed():
    tower = Chain((Segment(80.0, M, EI, S, RI),))
    body = EndBody(60e3, 1e7, 1.5)
    for modes, errors in ((2, (2e-6, 8e-3)), (3, (1e-6, 5e-4))):
        shapes = gap_shapes(tower, modes, body, HEIGHTS)
        bends = shapes(HEIGHTS)
        stiffness = shapes.stiffness_matrix() + 4e7 * bends @ bends.T
        found = np.sqrt(np.linalg.eigvalsh(stiffness)[:2]) / (2.0 * np.pi)
        for own, exact, error in zip(found, (0.40024, 1.65497), errors, strict=True):
            # Printed to five digits.
            assert -8e-6 < own / exact - 1.0 < 1.2 * error + 8e-6


def test_without_gap_a_collar_is_a_spring_and_with_a_wide_one_there_is_none():
    def top(model):
        return run_of(model, shaken(1.0), 1.0)["tower_tip_displacement"].values

    def held(*gaps):
        return in_plane(loose(*gaps), Load(HUNG), tower=2, jib=0, ground=True)

    sprung, unheld, wide = (held(1.0, 1.0) for _ in range(3))
    vars(sprung)["constants"] = replace(
        sprung.constants, play=None, stiffness=sprung.constants.stiffness + contact_stiffness(sprung)
    )
    coarse, fine = (np.max(abs(top(held(gap, gap)) - top(sprung))) for gap in (1e-5, 5e-6))
    # What a gap does is of first order in it.
    assert 1.8 < coarse / fine < 2.2
    assert fine < 5e-6
    unheld = replace(unheld, crane=replace(unheld.crane, collars=()))
    assert np.array_equal(top(wide), top(unheld))


@pytest.mark.parametrize(
    "collar",
    [
        TowerCollar(30.0, 4e7),
        TowerCollar(30.0, 4e7, gap=np.nan),
        TowerCollar(30.0, 0.0, gap=0.01),
        TowerCollar(90.0, 4e7, gap=0.01),
        TowerCollar(30.0, 4e7, 1e8, gap=0.01),
        TowerCollar(30.0, 4e7, 0.0, 1e8, 0.01),
    ],
)
def test_collars_with_play_hold_a_place_of_the_tower_and_nothing_else(collar):
    with pytest.raises(ValueError, match=r"TowerCrane.gapped: wanted heights above 0 to 80 m, a gap"):
        replace(BARE, gapped=(collar,))
