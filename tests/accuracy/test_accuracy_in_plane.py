"""Scenes in the jib's plane: small motions foretell four outputs, all others are measured, there as well."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
from samples import jointed_jib
from samples.qtz5613 import CRANE, motions, plane_setting, standing

from towercrane import load_case
from towercrane.accuracy.choice import choose
from towercrane.accuracy.instants import OUTPUTS, nodes_of
from towercrane.accuracy.mode_choice import measured_choice
from towercrane.accuracy.promise import KEPT, finer, verification
from towercrane.accuracy.scene import Scene, scene_of
from towercrane.cranes.parts.wind import WindAreas, steady
from towercrane.cranes.tower.equations.small_motions import linear_matrices
from towercrane.cranes.tower.modes.damping import ModalDamping
from towercrane.cranes.tower.targets import ALL, FORETOLD, absent, lacking
from towercrane.kernels.load import Load
from towercrane.motions.profiles import s_curve, trapezoid
from towercrane.results.measures import gap, peak
from towercrane.runs.run import record_case
from towercrane.schema.targets import Tolerance
from towercrane.simulation.starts.start import Start

OPEN = "qtz5613/within-1e-3"
SCENE = Scene(CRANE, Load(800.0), motions(), 80.0, planar=True)
SHORT = replace(SCENE, motions={**standing(20.0, 12.0), "trolley": trapezoid(20.0, 35.0, 0.8, 0.2)}, duration=30.0)
BLOWN = replace(
    SHORT,
    load=Load(800.0, drag_area=6.0),
    motions={**SHORT.motions, **steady(np.array([8.0, 0.0, 0.0]))},
    areas=WindAreas(tower=0.5, jib=0.3, counter_jib=0.3, counterweight=4.0),
)
STILL_AIR = {
    "trapezoid": SCENE,
    "hoist": replace(SCENE, motions={**standing(30.0, 18.0), "rope": s_curve(18.0, 9.0, 0.5, 0.3, 0.6)}),
    "swinging": replace(SCENE, start=Start(along=0.2), damping=ModalDamping(tower=0.01, vertical=0.01)),
    "let fall": replace(SCENE, start=Start("zero"), self_weight=False, rope_as_rod=True),
}


def over(value, *names):
    return {name: Tolerance(value, relative=True) for name in names}


def test_small_motions_foretell_four_outputs_of_a_plane_in_still_air():
    assert SCENE.foretells(FORETOLD)
    assert SCENE.foretells(["hoist_rope_force"])
    for name in set(ALL) - set(FORETOLD):
        assert not SCENE.foretells([*FORETOLD, name])
    assert not BLOWN.foretells(["sway_radial"])
    assert not replace(SCENE, planar=False).foretells(["sway_radial"])
    assert set(SCENE.outputs) == set(ALL) - set(absent(0.0)) - lacking(False, 0, 0)


def test_small_motions_of_a_jib_of_segments_are_those_of_its_equations():
    written = jointed_jib.CRANE
    rigid = replace(
        written, counter_jib=None, counter_jib_lateral=None, counter_jib_mass_per_length=159.3, counterweight=15130.0
    )
    scene = replace(SHORT, crane=rigid)
    assert scene.foretells(FORETOLD)
    # What knows of tower and jib alone says nothing of a counter-jib that bends.
    assert not replace(scene, crane=written).foretells(FORETOLD)
    nodes = nodes_of(scene)
    model = scene.model(nodes.richest)
    for place, drives in ((0, [20.0, 12.0]), (-1, [35.0, 12.0])):
        mass, _ = linear_matrices(model, np.array(drives))
        assert nodes.mass[place] == pytest.approx(mass, rel=1e-11, abs=1e-11 * abs(mass).max())


@pytest.mark.parametrize(
    ("scene", "name", "target"),
    [
        (SHORT, "base_moment_y", 1e-2),
        (SHORT, "payload_position", 1e-4),
        (BLOWN, "payload_position", 1e-4),
        (BLOWN, "tower_tip_displacement", 1e-2),
    ],
    ids=["moment", "load", "load in a wind", "tower in a wind"],
)
def test_what_is_not_foretold_is_measured_in_the_plane_and_keeps_its_promise(scene, name, target):
    choice, run = measured_choice(scene, over(target, name))
    assert choice.kept
    assert not choice.doubts
    setting = choice.setting
    assert setting.planar
    assert (setting.torsion_modes, setting.jib_lateral_modes) == (0, 0)
    assert choice.left_out[0] == "motion out of the jib's plane: nothing drives the crane or its load out of it"
    assert not any("torsion" in part or "sides" in part for part in choice.left_out)
    rich = plane_setting(setting.tower_modes + 3, setting.jib_vertical_modes + 5, rtol=1e-9, atol=1e-11)
    exact = scene.run(rich)
    lost = gap(run, exact, name)
    allowed = target * peak(exact, name)
    estimated = dict(zip(scene.outputs, choice.estimate.errors(choice.peaks), strict=True))[name]
    assert 0.0 < lost < estimated <= allowed


# What the choice was before a planar scene was one of the tower crane's scenes.
CHOSEN = {
    ("trapezoid", 1e-2, 3): (2, 2, np.inf, 0.0006, 0.0040423060298669915),
    ("trapezoid", 1e-3, 3): (2, 3, 2.737668710407854, 6e-05, 0.0008369129611915005),
    ("trapezoid", 3e-3, 1): (0, 0, np.inf, 0.00018, 2.823836869176287),
    ("hoist", 1e-2, 3): (2, 3, 2.737668710407854, 2e-05, 0.0005320482904128819),
    ("hoist", 1e-3, 3): (3, 6, 13.688343552039271, 6e-05, 3.075015630238779e-05),
    ("hoist", 3e-3, 1): (2, 4, 5.475337420815708, 3.167751346606299e-06, 0.0001922440324786479),
    ("swinging", 1e-2, 3): (2, 2, np.inf, 0.0006, 0.004374589452953127),
    ("swinging", 1e-3, 3): (2, 3, 2.737668710407854, 6e-05, 0.0009043899968220006),
    ("let fall", 1e-2, 3): (2, 3, 5.475337420815708, 2e-05, 0.005793489492310701),
    ("let fall", 3e-3, 1): (3, 4, 13.688343552039271, 6.659177266033986e-08, 0.004996877805447087),
}
"""By scene, target and number of outputs (positions, or the tension): modes of tower and jib, cap [Hz], rtol, and the
expected error of the jib's tip for want of modes and by damping [m]."""


@pytest.mark.parametrize(("name", "target", "count"), CHOSEN)
def test_known_choices(name, target, count):
    tower, jib, cap, rtol, lost = CHOSEN[name, target, count]
    outputs = OUTPUTS[:3] if count == 3 else OUTPUTS[3:]
    choice = choose(STILL_AIR[name], over(target, *outputs))
    assert choice.setting.counts == plane_setting(tower, jib).counts
    assert choice.setting.planar
    assert choice.setting.cap == pytest.approx(cap, rel=1e-9)
    assert choice.setting.rtol == pytest.approx(rtol, rel=1e-6)
    assert choice.estimate.truncation[1] == pytest.approx(lost, rel=1e-6)


def test_a_case_in_the_plane_that_asks_for_a_moment_measures_and_verifies_it():
    asked = ['accuracy.outputs=["base_moment_y", "payload_position"]', "accuracy.target=1e-2"]
    case = load_case(OPEN, ["run.duration=30 s", *asked])
    assert not scene_of(case).foretells(["base_moment_y", "payload_position"])
    result = record_case(case)
    found = json.loads(result.attrs["accuracy"])
    assert found["outcome"] == KEPT
    assert found["setting"]["planar"]
    assert list(found["outputs"]) == ["base_moment_y", "payload_position"]
    report = verification(case, result)
    assert report["finer"]["planar"]
    assert report["finer"]["tower_modes"] == found["setting"]["tower_modes"] + 1
    assert report["finer"]["jib_vertical_modes"] == found["setting"]["jib_vertical_modes"] + 2
    assert (report["finer"]["torsion_modes"], report["finer"]["jib_lateral_modes"]) == (0, 0)
    assert set(report["outputs"]) == set(ALL) - set(absent(0.0)) - lacking(False, 0, 0)
    for name, output in found["outputs"].items():
        assert 0.0 < report["outputs"][name]["actual"] < output["estimated"] <= output["allowed"]


def test_what_is_foretold_and_what_is_measured_are_verified_beside_models_of_their_own():
    setting = plane_setting(2, 3, cap=5.0, rtol=1e-6, atol=1e-8)
    foretold, measured = (finer(setting, SCENE, foretold=known) for known in (True, False))
    assert foretold == plane_setting(4, 7, rtol=1e-8, atol=1e-10)
    assert measured == plane_setting(3, 5, rtol=1e-8, atol=1e-10)
    space = finer(replace(setting, planar=True), replace(SCENE, planar=False), foretold=False)
    some = {kind: count for kind, count in space.counts.items() if count}
    assert some == {"tower_modes": 3, "jib_vertical_modes": 5}
    assert not space.planar
