"""Loads on slings below a hook, on every kind of crane: against closed forms, a second formulation and limits."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples import (
    hammerhead,
    jib_cranes,
    jointed_jib,
    lab_crane,
    luffing_crane,
    overhead_crane,
    qtz5613,
    space_crane,
)
from samples.case_files import only_fault
from scipy.integrate import solve_ivp

from towercrane.cases.case import load_case
from towercrane.cases.models import model_of, poses_of
from towercrane.cases.table_notices import table_notices
from towercrane.cranes.jib.model import DrivenJibCrane, PlannedJibCrane
from towercrane.cranes.overhead.model import OverheadModel
from towercrane.cranes.tower.equations.small_motions import natural_modes, plane_modes
from towercrane.cranes.tower.sway_frequencies import SwayFrequencies
from towercrane.kernels.elastic_rope import Elasticity
from towercrane.kernels.load import Load, Sling
from towercrane.linear.linearise import linearise
from towercrane.motions.motion import rest
from towercrane.motions.profiles import trapezoid
from towercrane.runs.run import record_case
from towercrane.simulation.simulate import record
from towercrane.simulation.starts.begin import begin
from towercrane.simulation.starts.start import Start
from towercrane.studies.space_modes import Place
from towercrane.studies.space_shapes import crane_lines

G = 9.81
SWUNG = Start(along=0.7, across=0.2, across_rate=0.3)
HOOKED = Load(1300.0, rope_damping=0.0, slings=(Sling(200.0, 4.0),))


def frequencies(model, drives) -> np.ndarray:
    """Of a linear model at rest, ascending [Hz]."""
    found = linearise(model, np.array(drives)[:, None], outputs=[])
    size = len(found.states) - 2 * len(drives)
    return np.sort(abs(np.linalg.eigvals(found.a[:size, :size]).imag))[::2] / (2.0 * np.pi)


def test_a_hook_and_its_load_swing_as_a_double_pendulum():
    load = Load(1500.0, slings=(Sling(200.0, 4.0),))
    crane = jib_cranes.HEAVY
    found = frequencies(PlannedJibCrane(crane, load), [0.0, 0.6, -0.2, 12.0])
    ratio = 1700.0 / 200.0 * (1.0 / 12.0 + 1.0 / 4.0)
    root = np.sqrt(ratio**2 - 4.0 * 1700.0 / 200.0 / 48.0)
    exact = np.sqrt(0.5 * crane.gravity * np.repeat([ratio - root, ratio + root], 2)) / (2.0 * np.pi)
    assert_allclose(found, exact, rtol=1e-9)
    if crane.gravity == G:
        assert_allclose(exact[::2], [0.126052, 0.829558], rtol=0, atol=5e-7)


def test_under_a_tower_crane_both_swings_are_among_its_frequencies():
    model = qtz5613.in_plane(qtz5613.CRANE, HOOKED)
    found, printed = frequencies(model, [30.0, 14.0]), [0.11884, 0.32261, 0.76414, 0.81078, 2.170, 2.806, 7.620]
    assert np.all(abs(found - printed) < [5.1e-6] * 4 + [5.1e-4] * 3)
    # In space the quick way and the linear model are the same.
    space = replace(space_crane.model(tower=1, torsion=1, lateral=1, vertical=1), load=HOOKED)
    modes = natural_modes(space, 30.0, 14.0)
    exact = frequencies(space, [30.0, 14.0, 0.0])
    assert_allclose([mode.frequency_hz for mode in modes], exact, rtol=1e-6)
    kinds = [mode.kind for mode in modes]
    assert {"radial sway", "radial sling", "lateral sling"} <= {*kinds}
    # Pictures of a mode have the hook between rope and load, each as far from the other as it is in the mode.
    stretched = replace(space, load=replace(HOOKED, elasticity=Elasticity(14e8, 32.5)))
    for model in (space, stretched):
        place = Place(30.0, 14.0, 0.0)
        mode = next(mode for mode in natural_modes(model, 30.0, 14.0) if mode.kind == "radial sling")
        rope = crane_lines(model, mode, place, 10.0, 1e-3)["rope"]
        assert_allclose(np.diff(rope, axis=0)[:, :2].ravel(), 1e-3 * mode.shape[-4:], atol=1e-15)
        assert_allclose(rope[1:, 2] - rope[0, 2], [-14.0, -18.0], atol=1e-2)
    sways = SwayFrequencies(space)
    by_kind = {mode.kind: mode.frequency_hz for mode in modes}
    assert sways("trolley", 30.0, 14.0) == pytest.approx((by_kind["radial sway"], by_kind["radial sling"]))
    assert len(sways("slewing", 30.0, 14.0)) == 3


def test_of_a_hook_without_slings_to_speak_of_nothing_is_seen():
    whole = plane_modes(qtz5613.in_plane(qtz5613.CRANE, Load(1500.0)), 30.0, 14.0)[0]
    short = plane_modes(qtz5613.in_plane(qtz5613.CRANE, Load(1300.0, slings=(Sling(200.0, 1e-6),))), 30.0, 14.0)[0]
    light = plane_modes(qtz5613.in_plane(qtz5613.CRANE, Load(1e-7, slings=(Sling(1500.0, 4.0),))), 30.0, 14.0)[0]
    assert_allclose(short[:-1], whole, rtol=1e-6)
    own = np.sqrt(qtz5613.CRANE.gravity / 4.0)
    assert_allclose(np.sort(np.append(whole, own)), light, rtol=1e-6)


def test_over_time_a_chain_goes_where_masses_held_at_their_distances_go():
    load = Load(60.0, drag_area=2.0, slings=(Sling(20.0, 3.0, 0.5), Sling(30.0, 2.0, 1.0)))
    motions = {"slew": rest(0.3), "luff": rest(0.6), "fold": rest(-0.2), "rope": trapezoid(8.0, 6.0, 0.5, 0.5)}
    model = PlannedJibCrane(jib_cranes.HEAVY, load)
    run = record(
        model, motions, 5.0, output_step=5.0, start=SWUNG, rtol=1e-11, atol=1e-12
    )  # fmt: skip
    inputs = np.array([[0.3, 0.0, 0.0], [0.6, 0.0, 0.0], [-0.2, 0.0, 0.0], [8.0, 0.0, 0.0]])
    top = np.array(model.suspended(np.zeros(model.system.size), inputs).place)
    masses, drags = np.array([20.0, 30.0, 60.0]), [0.5, 1.0, 2.0]

    def slope(t, y):
        places, velocities = y.reshape(2, 3, 3)
        far, hauled, hauling = (float(motions["rope"](t, order)) for order in range(3))
        mass, held, right = np.diag(np.repeat(masses, 3)), np.zeros((3, 9)), np.zeros(3)
        force = np.zeros((3, 3))
        for i in range(3):
            force[i] = -0.6125 * drags[i] * np.linalg.norm(velocities[i]) * velocities[i] - [0.0, 0.0, masses[i] * G]
            apart = places[i] - (places[i - 1] if i else top)
            parting = velocities[i] - (velocities[i - 1] if i else 0.0)
            held[i, 3 * i : 3 * i + 3] = apart
            right[i] = -parting @ parting
            if i:
                held[i, 3 * i - 3 : 3 * i] = -apart
            else:
                right[i] += hauled**2 + far * hauling
        whole = np.block([[mass, held.T], [held, np.zeros((3, 3))]])
        return np.concatenate(
            [velocities.ravel(), np.linalg.solve(whole, np.concatenate([force.ravel(), right]))[:9]]
        )

    state = begin(model, inputs, SWUNG)
    n, p = state[:9].reshape(3, 3), state[9:18].reshape(3, 3)
    far = np.array([[8.0], [3.0], [2.0]])
    start = np.concatenate([(top + np.cumsum(far * n, axis=0)).ravel(), np.cumsum(far * p, axis=0).ravel()])
    place = start
    for first, last in ((0.0, 1.0), (1.0, 4.0), (4.0, 5.0)):
        place = solve_ivp(slope, (first, last), place, method="DOP853", rtol=1e-11, atol=1e-12).y[:, -1]
    assert model.crane.gravity == G
    assert_allclose(run["payload_position"].values[-1], place[6:9], rtol=0, atol=2e-7)
    assert_allclose(run["hook_position"].values[-1], place[:3], rtol=0, atol=2e-7)


CRANES = {
    "space": (
        lambda load: replace(space_crane.model(tower=1, torsion=1, lateral=1, vertical=1), load=load),
        {"trolley": trapezoid(20.0, 21.0, 0.8, 2.0), "slewing": trapezoid(0.0, 0.3, 0.2, 0.5)},
        14.0,
    ),
    "joints": (
        lambda load: replace(jointed_jib.model(True), load=load), {"trolley": trapezoid(9.8, 13.0, 3.0, 4.0)}, 14.0,
    ),
    "ties": (
        lambda load: replace(hammerhead.model(1, 0, 0, 1, 0, 1, planes=1, slewing="fixed", axes=2), load=load),
        {"trolley": trapezoid(20.0, 21.0, 0.8, 2.0)},
        14.0,
    ),
    "luffing": (
        lambda load: replace(luffing_crane.model(0, 0, 1, 1), load=load),
        {"luffing": trapezoid(0.8, 0.82, 0.01, 0.01), "slewing": trapezoid(0.0, 0.3, 0.2, 0.5)},
        20.0,
    ),
    "overhead": (
        lambda load: OverheadModel(overhead_crane.SMALL, load),
        {"bridge": trapezoid(10.0, 12.0, 0.8, 1.0), "trolley": rest(8.0)},
        4.0,
    ),
    "lumped": (
        lambda load: replace(lab_crane.crane("enhanced"), load=load), {"shaft": trapezoid(0.0, 0.3, 0.2, 0.5)}, 2.0,
    ),
    "jib": (
        lambda load: PlannedJibCrane(jib_cranes.HEAVY, load),
        {"slew": trapezoid(0.0, 0.3, 0.2, 0.5), "luff": rest(0.6), "fold": rest(-0.2)},
        8.0,
    ),
}  # fmt: skip


@pytest.mark.parametrize("kind", CRANES)
def test_below_a_hook_the_balance_of_energy_holds_and_the_tensions_carry_the_bodies(kind):
    build, motions, length = CRANES[kind]
    heavy = 90.0 if kind == "luffing" else 900.0
    factor = 0.01 if kind == "lumped" else 1.0
    load = Load(
        heavy * factor, 50.0 * factor**3, 2.0 * factor, slings=(Sling(0.25 * heavy * factor, 0.25 * length, factor),)
    )
    if kind == "overhead":
        load = replace(load, elasticity=Elasticity(14e6, 10.0, 0.003))
    model = build(load)
    run = record(
        model, {**motions, "rope": trapezoid(length, 0.8 * length, 0.3, 0.3)}, 4.0,
        start=Start(along=0.3, across_rate=0.0 if getattr(model, "axes", 3) == 2 else 0.2), rtol=1e-11, atol=1e-13,
    )  # fmt: skip
    assert run.attrs["outcome"] == "finished"
    energy, work = run["total_energy"].values, run["input_work"].values
    assert abs(energy - energy[0] - work).max() < 1e-9 * max(np.ptp(energy), np.ptp(work))
    apart = run["payload_position"].values - run["hook_position"].values
    assert_allclose(np.linalg.norm(apart, axis=1), 0.25 * length, rtol=1e-12)
    # The sling begins in line with the rope.
    names = [name for name in run.data_vars if name.startswith("sling_sway")]
    assert len(names) == getattr(model, "axes", 3) - 1
    for name in names:
        assert run[name].values[0] == pytest.approx(run[name.removeprefix("sling_")].values[0], abs=1e-12)
    if kind in ("space", "jib"):
        # Newton's law of the load, from places alone.
        fine = record(
            model,
            {**motions, "rope": rest(length)},
            0.5,
            output_step=1e-3,
            start=Start(along=0.3),
            rtol=1e-12,
            atol=1e-14,
        )
        place, own = fine["payload_position"].values, fine["sling_force"].values
        speed = np.gradient(place, 1e-3, axis=0)
        air = -load.drag * np.linalg.norm(speed, axis=1, keepdims=True) * speed
        moved = np.diff(place, 2, axis=0) * 1e6
        down = (place - fine["hook_position"].values) / (0.25 * length)
        force = load.mass * (moved + np.array([0.0, 0.0, G])) - air[1:-1]
        # But where the drives' accelerations jump.
        smooth = abs(fine.times[1:-1] - 0.4) > 2e-3
        assert_allclose(-np.sum(force * down[1:-1], axis=1)[smooth], own[1:-1][smooth], rtol=2e-5)


def test_on_a_rope_that_hardly_stretches_a_chain_moves_as_on_one_that_does_not():
    rigid = qtz5613.in_plane(qtz5613.CRANE, HOOKED, 1, 1)
    elastic = replace(rigid, load=replace(HOOKED, elasticity=Elasticity(14e8, 32.5, 0.0003)))
    motions = {"trolley": trapezoid(20.0, 26.0, 0.8, 0.4), "rope": trapezoid(14.0, 12.0, 0.5, 0.5)}
    places, swings = zip(*(
        (run["payload_position"].values, run["sling_sway_radial"].values)
        for run in (record(one, motions, 6.0, output_step=0.5, rtol=1e-8, atol=1e-10) for one in (rigid, elastic))
    ), strict=True)  # fmt: skip
    assert 1e-6 < abs(places[1] - places[0]).max() < 2e-3
    assert abs(swings[1] - swings[0]).max() < 1e-4


def test_a_load_that_its_slings_would_push_ends_the_run():
    model = qtz5613.in_plane(qtz5613.CRANE, HOOKED, 1, 1)
    motions = {"trolley": rest(20.0), "rope": rest(14.0)}
    run = record(model, motions, 20.0, start=Start(along=2.2), rtol=1e-8, atol=1e-10)
    assert run.attrs["outcome"] in ("slack rope", "slack sling")
    hard = load_case("hard/slings-slack-below-the-hook")
    assert hard.expect is not None
    assert hard.expect.outcome == "slack sling"


CASE = "qtz5613/hook-and-slings"


@pytest.mark.parametrize(
    ("overrides", "key", "hint"),
    [
        (("slings.length=0 m",), "slings.length", ""),
        (("slings.length=4 km",), "slings.length", "implausible"),
        (("slings.stiffness=5 MN",), "slings.stiffness", "do not stretch"),
        (("hook.mass=-2 kg",), "hook.mass", ""),
        (("hook.weight=2 kg",), "hook.weight", ""),
        (('accuracy.target="1e-2"',), "accuracy.target", "one swing"),
    ],
)
def test_what_no_hook_can_be_is_said_once(overrides, key, hint):
    fault = only_fault(CASE, *overrides)
    assert fault.key == key
    assert hint in str(fault)


def test_a_hook_wants_slings_and_slings_a_hook():
    fault = only_fault("qtz5613/condition-3", "hook.mass=200 kg")
    assert fault.key == "hook"
    fault = only_fault("qtz5613/condition-3", "slings.length=4 m")
    assert fault.key == "slings"


def test_a_light_hook_is_merged_with_its_load_and_that_is_said():
    light = load_case(CASE, ["hook.mass=5 kg"])
    assert any("merged" in sentence for sentence in table_notices(light))
    load = model_of(light, tower_modes=0, jib_vertical_modes=0).load
    assert load.whole_mass == pytest.approx(1305.0, rel=1e-15)
    assert load.slings[0].mass == pytest.approx(0.01 * load.mass, rel=1e-12)
    assert not any("merged" in sentence for sentence in table_notices(load_case(CASE)))


def test_films_show_the_hook_between_rope_and_load():
    case = load_case(CASE, ["run.duration=2 s", "model.tower_modes=1", "model.jib_vertical_modes=1"])
    run = record_case(case)
    poses = poses_of(case, run, run["time"].values, run.model)
    hook, load = poses.hanging.transpose(1, 0, 2)
    assert_allclose(np.linalg.norm(load - hook, axis=1), 4.0, rtol=1e-12)
    assert_allclose(
        np.linalg.norm(hook - poses.members["suspension"][:, 0], axis=1), run["rope_length"].values, rtol=1e-9
    )


def test_joints_under_torques_take_no_slings():
    with pytest.raises(ValueError, match="below a hook"):
        DrivenJibCrane(jib_cranes.HEAVY, HOOKED, (0.0, 0.5, -0.2)).system  # noqa: B018
