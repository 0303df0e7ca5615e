"""Indicators against actual errors, and runs that are asked for an error."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from samples.qtz5613 import CRANE, motions, plane_setting, standing

from towercrane.accuracy.choice import choose
from towercrane.accuracy.foretold import Indicators
from towercrane.accuracy.indicators import drift, vibration
from towercrane.accuracy.instants import OUTPUTS, RICHEST, nodes_of
from towercrane.accuracy.scene import Scene
from towercrane.cranes.tower.equations.small_motions import plane_matrices, plane_modes
from towercrane.cranes.tower.modes.damping import ModalDamping
from towercrane.kernels.load import Load
from towercrane.motions.profiles import s_curve, smooth_ramps
from towercrane.schema.targets import Tolerance
from towercrane.simulation.starts.start import Start

POSITIONS = OUTPUTS[:3]
SCENE = Scene(CRANE, Load(800.0), motions(), 80.0, planar=True)
SCENES = {
    "trapezoid": SCENE,
    "s-curve": replace(SCENE, motions={**motions(), "trolley": s_curve(5.0, 41.0, 0.8, 0.2, 0.2)}),
    "smooth": replace(SCENE, motions={**motions(), "trolley": smooth_ramps(41.0, -0.6, 2.5, 40.0)}),
    "hoist": replace(SCENE, motions={**standing(30.0, 18.0), "rope": s_curve(18.0, 9.0, 0.5, 0.3, 0.6)}),
    "swinging": replace(SCENE, start=Start(along=0.2), damping=ModalDamping(tower=0.01, vertical=0.01)),
    "let fall": replace(SCENE, start=Start("zero"), self_weight=False, rope_as_rod=True),
}


def actual(scene, setting, *, rtol=1e-9, rich=None):
    """Largest differences of the outputs from the richest model's, capped where nothing is heard."""
    rich = rich or replace(RICHEST, cap=40.0, weight_softening=setting.weight_softening)
    runs = [scene.run(replace(one, rtol=rtol, atol=1e-2 * rtol)) for one in (rich, setting)]
    return np.array([abs(runs[0][name].values - runs[1][name].values).max() for name in OUTPUTS])


def errors(scene, choice):
    """Actual errors of a choice over the peaks."""
    found = scene.run(choice.setting)
    exact = scene.run(replace(RICHEST, cap=40.0, rtol=1e-8, atol=1e-10))
    return np.array([abs(found[n].values - exact[n].values).max() / abs(exact[n].values).max() for n in OUTPUTS])


def test_nodes_hold_the_models_own_small_motions():
    nodes = nodes_of(SCENE)
    end = nodes.place[-1]
    mass, stiffness = plane_matrices(SCENE.model(RICHEST), 41.0, 18.0)
    np.testing.assert_allclose(nodes.mass[end], mass, rtol=1e-12, atol=1e-12 * mass.max())
    assert nodes.pendulum[end] == pytest.approx(stiffness[-1, -1], rel=1e-12)
    inputs = np.zeros((2, 3))
    inputs[:, 0] = 41.0, 18.0
    straight = np.zeros((RICHEST.tower_modes + RICHEST.jib_vertical_modes, 1))
    weight = SCENE.model(RICHEST).static_forces(straight, inputs)[:, 0]
    np.testing.assert_allclose(nodes.weight[end, :-1], weight, atol=1e-12 * abs(weight).max())


@pytest.mark.parametrize(
    "setting", [plane_setting(2, 3), plane_setting(4, 8, cap=8.0), plane_setting(0, 2), plane_setting(1, 0)]
)
def test_modes_at_a_node_are_the_coarser_models(setting):
    found = vibration(nodes_of(SCENE), replace(setting, weight_softening=False))
    exact = plane_modes(SCENE.model(replace(setting, weight_softening=False)), 41.0, 18.0)[0]
    np.testing.assert_allclose(found.frequencies[-1], exact, rtol=1e-9)


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("setting", [plane_setting(2, 2), plane_setting(3, 4, cap=6.0)], ids=["2+2", "3+4 capped"])
def test_the_expected_error_bounds_the_actual_one_closely(name, setting):
    scene = SCENES[name]
    expected = Indicators(scene).truncation(setting)
    ratio = (expected / actual(scene, setting))[:2]
    assert (ratio > 0.7).all()
    assert (ratio < 8.0).all()


def test_what_the_weights_softening_changes_is_foretold():
    changed = Indicators(SCENE).softening()
    rich = replace(RICHEST, cap=40.0)
    found = actual(SCENE, replace(rich, weight_softening=False), rich=rich, rtol=1e-8)
    assert (found[:3] / changed[:3] > 0.3).all()
    assert (found[:3] / changed[:3] < 3.0).all()


def test_the_richest_model_differs_from_itself_in_nothing():
    nodes = nodes_of(SCENE)
    rich = vibration(nodes, RICHEST)
    static, ringing = drift(rich, vibration(nodes, RICHEST))
    assert (static == 0.0).all()
    assert (ringing < 1e-12).all()


def test_modes_that_only_one_model_has_count_in_full():
    nodes = nodes_of(SCENE)
    rich, poor = vibration(nodes, RICHEST), vibration(nodes, plane_setting(0, 0))
    swing = rich.frequencies[0].argmin()
    # The trolley's ramps are many cycles of every bending mode apart.
    alone = (abs(np.delete(rich.left, swing, axis=2)) ** 2).sum(axis=(2, 3)).max(axis=0)
    for one, other in ((rich, poor), (poor, rich)):
        ringing = drift(one, other)[1]
        assert ringing[1] == pytest.approx(np.sqrt(alone[1]), rel=1e-2)
        # The load's swing bends the tower besides.
        assert np.sqrt(alone[0]) < ringing[0] < 2.0 * np.sqrt(alone[0])


def test_an_estimate_does_not_depend_on_what_was_asked_before():
    asked = Indicators(SCENE)
    full = plane_setting(3, 4)
    for setting in (
        full,
        replace(full, cap=5.0),
        replace(full, weight_softening=False),
        plane_setting(3, 3),
        plane_setting(2, 3),
    ):
        np.testing.assert_array_equal(asked.truncation(setting), Indicators(SCENE).truncation(setting))


@pytest.mark.parametrize(
    ("name", "target"),
    [
        ("trapezoid", 1e-2),
        ("trapezoid", 3e-4),
        ("smooth", 1e-3),
        ("hoist", 1e-3),
        ("swinging", 1e-3),
        ("let fall", 3e-3),
    ],
)
def test_the_chosen_run_keeps_the_target_without_wasting(name, target):
    choice = choose(SCENES[name], {output: Tolerance(target, relative=True) for output in POSITIONS})
    assert choice.kept
    assert not choice.doubts
    reached = errors(SCENES[name], choice)[:3].max()
    assert 0.01 * target < reached < target


def test_a_looser_target_takes_fewer_modes_and_an_output_that_feels_little_fewer_still():
    tight, loose = (
        choose(SCENE, {name: Tolerance(target, True) for name in POSITIONS}).setting for target in (3e-4, 3e-2)
    )
    swing = choose(SCENE, {"sway_radial": Tolerance(3e-2, True)}).setting
    assert tight.tower_modes + tight.jib_vertical_modes > loose.tower_modes + loose.jib_vertical_modes
    assert (loose.tower_modes, loose.jib_vertical_modes) == (2, 2)
    assert swing.tower_modes + swing.jib_vertical_modes < 2
    assert tight.rtol < loose.rtol


def test_an_absolute_target():
    choice = choose(SCENE, {"tower_tip_displacement": Tolerance(2e-5, relative=False)})
    assert choice.kept
    assert errors(SCENE, choice)[0] * choice.peaks[0] < 2e-5


def test_what_is_stated_is_kept_and_checked():
    targets = {name: Tolerance(1e-4, relative=True) for name in POSITIONS}
    choice = choose(SCENE, targets, {"tower_modes": 1, "jib_vertical_modes": 1, "weight_softening": False})
    assert (choice.setting.tower_modes, choice.setting.jib_vertical_modes) == (1, 1)
    assert not choice.setting.weight_softening
    assert not choice.kept


def test_a_method_that_was_not_measured_promises_nothing():
    choice = choose(SCENE, {"sway_radial": Tolerance(0.1, relative=True)}, {"method": "dopri5"})
    assert not choice.kept


def test_parametric_resonance_cannot_be_promised():
    tuned = replace(SCENE, motions=motions(rope=10.0), start=Start("zero"), rope_as_rod=True, duration=120.0)
    (doubt,) = choose(tuned, {"sway_radial": Tolerance(1e-2, relative=True)}).doubts
    assert "twice the swing's 0.15" in doubt
    wide = choose(replace(SCENE, start=Start(along=0.8)), {"sway_radial": Tolerance(1e-2, relative=True)}).doubts
    assert "the load swings 0.74" in wide[0]


def test_a_crane_at_rest():
    choice = choose(
        replace(SCENE, motions=standing(20.0, 18.0)), {name: Tolerance(1e-2, relative=True) for name in POSITIONS}
    )
    assert choice.kept


@pytest.mark.parametrize("targets", [{}, {"swing": Tolerance(1e-3, relative=True)}])
def test_targets_of_nothing_known(targets):
    with pytest.raises(ValueError, match=r"targets: wanted some of tower_tip_displacement, .*, got (none|swing)"):
        choose(SCENE, targets)
