"""What more modes change, as small motions about a coarse run foretell it, beside runs of both models."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from samples.qtz5613 import standing as standing_plane
from samples.space_crane import CRANE, manoeuvre, standing

from towercrane.accuracy import mode_choice
from towercrane.accuracy.departures import LAST, Departures
from towercrane.accuracy.mode_choice import MOST, measured_choice
from towercrane.accuracy.scene import Scene
from towercrane.accuracy.setting import Setting
from towercrane.cranes.parts.wind import WindAreas, gusts, steady
from towercrane.cranes.tower.crane_model import moving
from towercrane.cranes.tower.modes.damping import ModalDamping
from towercrane.kernels.load import Load
from towercrane.motions.profiles import s_curve, trapezoid
from towercrane.results.measures import gap, peak
from towercrane.schema.targets import Tolerance
from towercrane.simulation.starts.start import Start

TURN = Scene(CRANE, Load(1500.0), {**standing(30.0, 15.0), "slewing": manoeuvre()["slewing"]}, 30.0, 0.1)
DAMPED = replace(TURN, damping=ModalDamping(0.01, 0.01, 0.01, 0.01))
AREAS = WindAreas(tower=0.5, jib=0.3, counter_jib=0.3, counterweight=4.0)
RELEASED = replace(TURN, motions=standing(40.0, 12.0), start=Start(along=0.2))
HOIST = replace(TURN, motions=standing(40.0, 12.0) | {"rope": s_curve(12.0, 8.0, 0.5, 2.0, 20.0)})
# Calm in the mean and at the start: nothing but what the run itself swings.
SPEEDS = np.array([[0.0, 0.0, 0.0], [0.0, 8.0, 0.0], [0.0, 0.0, 0.0], [0.0, -8.0, 0.0], [0.0, 0.0, 0.0]])
GUSTS = replace(
    TURN, load=Load(1500.0, drag_area=6.0), motions=standing(40.0, 12.0) | gusts(4.0, SPEEDS), areas=AREAS
)
PLANE = replace(TURN, motions={**standing_plane(20.0, 12.0), "trolley": trapezoid(20.0, 35.0, 0.8, 0.2)}, planar=True)


def ones(scene):
    kinds = [kind for kind in moving(scene.planar) if kind in scene.described]
    return Setting(planar=scene.planar, rtol=1e-7, atol=1e-9).with_counts(dict.fromkeys(kinds, 1))


@cache
def about(scene):
    single = ones(scene)
    richest = {kind: MOST[kind] + LAST[kind] for kind, count in single.counts.items() if count}
    return Departures(scene, scene.run(single), single.with_counts(richest))


def foretold_and_found(scene, name, kind, count):
    """What one mode more than so many of a kind changes, over the peak."""
    fewer, more = (ones(scene).with_counts({kind: number}) for number in (count, count + 1))
    runs = scene.run(fewer), scene.run(more)
    found = about(scene).between(fewer.counts, more.counts)[:, list(scene.outputs).index(name)]
    return found / peak(runs[0], name), gap(*runs, name) / peak(runs[0], name)


@pytest.mark.parametrize(
    ("scene", "name", "kind", "count", "low", "high"),
    [
        (TURN, "tower_tip_twist", "tower_modes", 1, 0.9, 1.6),
        (TURN, "sway_tangential", "jib_lateral_modes", 1, 0.7, 2.5),
        (TURN, "jib_tip_deflection_sideways", "jib_lateral_modes", 2, 0.7, 2.0),
        (DAMPED, "tower_tip_displacement_sideways", "tower_modes", 1, 0.9, 3.0),
        (RELEASED, "hoist_rope_force", "jib_vertical_modes", 2, 0.8, 2.0),
        (RELEASED, "base_moment_y", "tower_modes", 2, 0.5, 1.5),
        (RELEASED, "tower_tip_displacement", "tower_modes", 1, 0.9, 1.6),
        (HOIST, "jib_root_moment", "jib_vertical_modes", 1, 0.4, 2.5),
        (GUSTS, "tower_tip_displacement_sideways", "tower_modes", 1, 0.9, 2.5),
        (PLANE, "tower_tip_displacement", "tower_modes", 1, 0.9, 1.3),
    ],
    ids=["twist", "sway", "sideways", "damped", "tension", "moment", "swinging", "hoist", "gusts", "plane"],
)
def test_one_mode_more_changes_what_small_motions_foretell(scene, name, kind, count, low, high):
    foretold, found = foretold_and_found(scene, name, kind, count)
    assert found > 3e-4
    assert low < foretold.sum() / found < high


@pytest.mark.parametrize(
    ("name", "kind", "count"),
    [
        ("jib_tip_deflection", "jib_vertical_modes", 1),
        ("jib_tip_deflection", "jib_vertical_modes", 2),
        ("payload_position", "jib_vertical_modes", 0),
        ("jib_tip_deflection_sideways", "jib_lateral_modes", 1),
        ("trolley_force", "jib_vertical_modes", 1),
    ],
)
def test_modes_that_are_only_bent_are_foretold_closely(name, kind, count):
    blown = replace(
        TURN,
        load=Load(1500.0, drag_area=6.0),
        motions=standing(40.0, 12.0) | steady(np.array([3.0, 9.0, 0.0])),
        areas=AREAS,
        duration=5.0,
    )
    (rung, bent), found = foretold_and_found(blown, name, kind, count)
    assert rung < 0.1 * bent
    assert bent == pytest.approx(found, rel=0.05)


def test_a_mode_that_dies_out_forgets_its_phase():
    still, damped = about(TURN), about(DAMPED)
    fewer, more = ones(TURN).counts, ones(TURN).with_counts({"tower_modes": 2}).counts
    kept, lost = (one.between(fewer, more)[0] for one in (still, damped))
    twist = list(TURN.outputs).index("tower_tip_twist")
    assert lost[twist] < 0.8 * kept[twist]


def test_departures_from_oneself_are_none_and_further_modes_only_add():
    departures, counts = about(TURN), ones(TURN).counts
    assert not departures.between(counts, counts).any()
    richer = {kind: number + 1 for kind, number in counts.items()}
    assert (departures.beyond(richer).sum(axis=0)[:8] < departures.beyond(counts).sum(axis=0)[:8]).all()


def test_a_head_that_stands_turned_departs_in_the_same_way():
    turned = {kind: about(replace(RELEASED, motions=standing(40.0, 12.0, heading))) for kind, heading in
              (("straight", 0.0), ("turned", 1.1))}  # fmt: skip
    fewer, more = ones(RELEASED).counts, ones(RELEASED).with_counts({"tower_modes": 2}).counts
    straight, other = (turned[kind].between(fewer, more)[:, :8] for kind in ("straight", "turned"))
    np.testing.assert_allclose(other, straight, rtol=1e-3, atol=1e-7)


def test_a_run_that_is_further_from_the_coarse_one_than_foretold_is_not_believed(monkeypatch):
    targets = {"payload_position": Tolerance(0.01, relative=True), "sway_tangential": Tolerance(0.01, relative=True)}
    honest, _ = measured_choice(TURN, targets)
    plain = Departures._between
    monkeypatch.setattr(Departures, "_between", lambda *known: 0.02 * plain(*known))
    choice, run = measured_choice(TURN, targets)
    exact = TURN.run(
        ones(TURN).with_counts(
            {kind: count + 2 for kind, count in honest.setting.counts.items() if kind in TURN.described}
        )
    )
    for name in targets:
        within = gap(run, exact, name) < 0.01 * peak(exact, name)
        assert within or not choice.kept
    assert honest.kept
    monkeypatch.setattr(mode_choice, "_surprise", lambda *_: np.ones(len(TURN.outputs)))
    believed, run = measured_choice(TURN, targets)
    assert believed.kept
    assert any(gap(run, exact, name) > 0.01 * peak(exact, name) for name in targets)


def test_the_choice_runs_one_coarse_model_besides_its_own(monkeypatch):
    runs, plain = [], Scene.run

    def counted(scene, setting, **options):
        runs.append(setting)
        return plain(scene, setting, **options)

    monkeypatch.setattr(Scene, "run", counted)
    choice, _ = measured_choice(TURN, {"sway_tangential": Tolerance(0.01, relative=True)})
    assert choice.kept
    assert [one.counts for one in runs] == [ones(TURN).counts, choice.setting.counts]
