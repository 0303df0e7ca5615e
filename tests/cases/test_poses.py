"""Where a crane is drawn: lengths, known deflections and the run's own outputs, met to rounding."""

import json
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from towercrane.cases.assumptions import rests_on
from towercrane.cases.case import load_case
from towercrane.cases.models import poses_of
from towercrane.cases.result_case import case_of
from towercrane.cranes.jib.build import parameters_of as jib_parameters
from towercrane.cranes.parts.poses import SHOWN, Poses
from towercrane.cranes.slewing.build import parameters_of
from towercrane.cranes.tower.file.members import jib_of, tower_of
from towercrane.results import files as results
from towercrane.runs.run import record_case, run_case
from towercrane.runs.summary import summarise

CASES = {
    "radial": ("qtz5613/condition-3", "run.duration=12 s"),
    "space": ("qtz5613/soft-drive", "run.duration=12 s"),
    "multi-mass": ("slewing/multi-mass/example-1", "run.duration=4 s"),
    "enhanced": ("slewing/enhanced/example-1", "run.duration=4 s"),
    "basic": ("slewing/basic/example-1", "run.duration=4 s"),
    "jib": ("jib-crane/combined", "run.duration=40 s"),
    "overhead": ("overhead-crane/travel", "run.duration=12 s"),
}


@pytest.fixture(scope="module")
def posed():
    """Case, result and poses on the result's rows, of each kind of crane."""
    found = {}
    for kind, (name, *changes) in CASES.items():
        case = load_case(name, changes)
        result = run_case(case)
        found[kind] = case, result, poses_of(case, result, result["time"].values)
    return found


def lengths(lines):
    return np.linalg.norm(np.diff(lines, axis=1), axis=-1).sum(axis=1)


def rope(poses):
    return np.linalg.norm(poses.load - poses.members["suspension"][:, 0], axis=1)


@pytest.mark.parametrize("kind", CASES)
def test_load_is_where_the_result_has_it_on_a_rope_as_long_as_it_says(posed, kind):
    case, result, poses = posed[kind]
    height = tower_of(case.crane).length if kind in ("radial", "space") else 0.0
    assert_allclose(poses.load - [0.0, 0.0, height], result["payload_position"].values, rtol=0, atol=1e-13)
    if kind == "basic":
        # Its rope stretches: by the load's weight over the stiffness at rest.
        weight = case.payload.mass * case.crane.gravity
        stiffness = parameters_of(case.crane).stiffness_rope
        assert_allclose(rope(poses)[0] - result["rope_length"].values[0], weight / stiffness, rtol=1e-9)
    else:
        assert_allclose(rope(poses), result["rope_length"].values, rtol=0, atol=1e-10)


def test_undeformed_tower_crane_keeps_its_lengths_and_follows_its_drives(posed):
    _, result, poses = posed["space"]
    for name, length in {"tower": 23.8, "jib": 55.6, "counter-jib": 12.3}.items():
        assert_allclose(lengths(poses.undeformed[name]), length, rtol=1e-13)
    tip = poses.undeformed["jib"][:, -1]
    assert_allclose(np.unwrap(np.arctan2(tip[:, 1], tip[:, 0])), result["slewing_angle"].values, atol=1e-13)
    assert_allclose(tip[:, 2], 23.8, rtol=1e-14)
    hung = poses.undeformed["suspension"][:, 0]
    assert_allclose(np.hypot(hung[:, 0], hung[:, 1]), result["trolley_position"].values, rtol=1e-13)
    assert not poses.planar
    # The counter-jib is rigid: only turned and shifted.
    assert_allclose(lengths(poses.members["counter-jib"]), 12.3, rtol=1e-13)


def test_deformed_crane_in_the_plane_is_that_of_the_outputs(posed):
    _, result, poses = posed["radial"]
    top, gamma, w = (result[f"{name}"].values for name in ("tower_tip_displacement", "tower_tip_tilt",
                                                           "jib_tip_deflection"))  # fmt: skip
    assert_allclose(poses.members["tower"][:, -1, 0], top, rtol=0, atol=1e-14)
    x = top + 55.6 * np.cos(gamma) + w * np.sin(gamma)
    z = 23.8 - 55.6 * np.sin(gamma) + w * np.cos(gamma)
    assert_allclose(poses.members["jib"][:, -1, [0, 2]], np.stack([x, z], axis=1), rtol=0, atol=1e-12)
    assert poses.planar
    assert_allclose(poses.members["tower"][:, 0], 0.0, rtol=0, atol=1e-18)


def test_twist_and_lateral_bending_carry_the_jib_tip_sideways(posed):
    _, result, poses = posed["space"]
    seen = poses.turned_back(poses.members["jib"])[:, -1]
    twist = result["tower_tip_twist"].values
    angle = np.arctan2(seen[:, 1] - poses.turned_back(poses.members["tower"])[:, -1, 1], seen[:, 0])
    first_order = twist + result["jib_tip_deflection_sideways"].values / 55.6
    assert abs(first_order).max() > 0.02
    assert_allclose(angle, first_order, rtol=0, atol=3e-3 * abs(first_order).max() + 1e-4)


def test_jib_at_rest_hangs_as_a_cantilever_does():
    changes = ["model.tower_modes=0", "model.jib_vertical_modes=14", "run.duration=0.1 s"]
    case = load_case("qtz5613/condition-3", changes)
    result = run_case(case)
    poses = poses_of(case, result, np.zeros(1))
    jib, g = jib_of(case.crane), case.crane.gravity
    ei, length = jib.youngs_modulus * jib.second_moment_of_area, jib.length
    force = (case.payload.mass + case.crane.trolley.mass) * g
    at = float(result["trolley_position"][0])
    x = poses.undeformed["jib"][0, :, 0]
    by_weight = -jib.mass_per_length * g * x**2 * (6 * length**2 - 4 * length * x + x**2) / (24 * ei)
    near, far = force * x**2 * (3 * at - x) / (6 * ei), force * at**2 * (3 * x - at) / (6 * ei)
    known = by_weight - np.where(x < at, near, far)
    assert known[-1] < -2.0
    assert_allclose(poses.members["jib"][0, :, 2] - 23.8, known, rtol=0, atol=1e-5)


def test_a_counter_jib_that_bends_is_drawn_bent_and_its_ballast_hangs_on_it():
    case = load_case("flat-top/manoeuvre", ["run.duration=8 s", "model.tower_modes=0", "model.torsion_modes=0"])
    result = run_case(case)
    poses = poses_of(case, result, result["time"].values)
    seen = {name: poses.turned_back(line) for name, line in poses.members.items()}
    up, sideways = (result[f"counter_jib_tip_deflection{way}"].values for way in ("", "_sideways"))
    assert -0.28 < up.max() < -0.26
    assert abs(sideways).max() > 2e-3
    assert_allclose(seen["counter-jib"][:, -1, 2], 48.0 + up, rtol=0, atol=1e-12)
    assert_allclose(seen["counter-jib"][:, -1, 1], -sideways, rtol=0, atol=1e-12)
    assert_allclose(seen["counter-jib"][:, 0], [[0.0, 0.0, 48.0]] * len(up), rtol=0, atol=1e-12)
    # Winch and ballast are on the bent line, and sections meet on the jib.
    assert_allclose(poses.undeformed["ballast"][0, :, 0], [-9.0, -14.0], rtol=1e-13)
    assert_allclose(poses.undeformed["joints"][0, :, 0], [10.0, 20.0, 30.0, 40.0, 50.0], rtol=1e-13)
    for points, line in (("ballast", "counter-jib"), ("joints", "jib")):
        for row in (0, len(up) - 1):
            places, along = seen[points][row], seen[line][row]
            order = np.argsort(along[:, 0])
            for axis in (1, 2):
                on_line = np.interp(places[:, 0], along[order, 0], along[order, axis])
                assert_allclose(places[:, axis], on_line, rtol=0, atol=1e-3)


@pytest.mark.parametrize("counts", [(0, 0), (1, 0), (0, 1)])
def test_a_counter_jib_has_outputs_where_a_model_has_modes_of_it(counts):
    ways = ("lateral", "vertical")
    changes = [f"model.counter_jib_{way}_modes={count}" for way, count in zip(ways, counts, strict=True)]
    others = ["model.tower_modes=0", "model.torsion_modes=0", "model.jib_lateral_modes=0", "run.duration=0.5 s"]
    case = load_case("flat-top/manoeuvre", [*changes, *others])
    recording = record_case(case)
    # Its report, too, asks for what is there.
    peaks = summarise(case, recording)["peaks"]
    expected = {f"counter_jib_{what}{way}" for what in ("tip_deflection", "root_moment") for way in ("", "_sideways")}
    assert {name for name in peaks if name.startswith("counter_jib")} == (expected if any(counts) else set())
    poses = poses_of(case, recording.dataset(), np.zeros(1))
    bent = poses.members["counter-jib"] - poses.undeformed["counter-jib"]
    assert (abs(bent[..., 2]).max() > 0.2) == bool(counts[1])


def test_multi_mass_crane_hangs_on_its_points(posed):
    case, result, poses = posed["multi-mass"]
    p = parameters_of(case.crane)
    up = p.suspension_height
    assert_allclose(lengths(poses.undeformed["jib"]), p.geometry_jib_radius, rtol=1e-13)
    assert_allclose(lengths(poses.undeformed["counter-jib"]), p.geometry_counterweight_radius, rtol=1e-13)
    x, y, turned = (result[name].values for name in ("tower_x", "tower_y", "tower_angle"))
    top = np.exp(1j * turned) * (x + 1j * y)
    assert_allclose(poses.members["tower"][:, -1], np.stack([top.real, top.imag, up + 0 * x], axis=1), atol=1e-15)
    fall = 2.0 * x * p.geometry_jib_radius / p.geometry_tower_height
    assert_allclose(poses.members["suspension"][:, 0, 2], up + result["jib_vertical"].values - fall, atol=1e-14)
    # The parabola's slope at the tower's top is the model's tilt.
    tower = poses.members["tower"][:, :-1]
    slope = np.gradient(tower[-1, :, 0], tower[-1, :, 2], edge_order=2)[-1]
    assert_allclose(slope, 2.0 * top.real[-1] / p.geometry_tower_height, rtol=1e-9)
    assert "counter-jib" not in posed["enhanced"][2].members


def test_jib_crane_is_rigid(posed):
    case, result, poses = posed["jib"]
    p, angles = jib_parameters(case.crane), result["joint_angle"].values
    assert poses.deformation == 0.0
    assert poses.fitting_magnification() == 1.0
    assert_allclose(lengths(poses.members["booms"]), p["primary_length"] + p["secondary_length"], rtol=1e-13)
    rise = p["primary_length"] * np.sin(angles[:, 1]) + p["secondary_length"] * np.sin(angles[:, 1] + angles[:, 2])
    assert_allclose(poses.members["suspension"][:, 0, 2], p["post_height"] + rise, rtol=1e-13)


@pytest.mark.parametrize("kind", ["space", "multi-mass"])
def test_magnified_once_is_true_and_ten_times_is_ten_times_as_far(posed, kind):
    _, _, poses = posed[kind]
    once, tenfold = poses.magnified(1.0), poses.magnified(10.0)
    for name, line in poses.members.items():
        assert_allclose(once[name], line, rtol=0, atol=1e-14)
        still = poses.undeformed[name]
        assert_allclose(tenfold[name] - still, 10.0 * (line - still), rtol=0, atol=1e-12)


@pytest.mark.parametrize("deformation", [1e-9, 1.99e-3, 2.01e-3, 0.3, 1.9, 7.0])
def test_fitting_magnification_is_the_largest_round_one_that_fits(deformation):
    still = np.array([[[0.0, 0.0, 0.0], [0.0, 0.0, 10.0]]])
    moved = still.copy()
    moved[0, 1, 0] = deformation
    poses = Poses(np.zeros(1), np.zeros(1), {"tower": moved}, {"tower": still}, np.zeros((1, 3)))
    chosen = poses.fitting_magnification()
    assert np.log10(chosen) % 1 in (pytest.approx(0.0), pytest.approx(np.log10(2)), pytest.approx(np.log10(5)))
    assert chosen == 1.0 or chosen * deformation <= SHOWN * 10.0
    assert chosen == 5e4 or 2.5 * chosen * deformation > SHOWN * 10.0


def test_between_rows_the_load_is_on_a_straight_line(posed):
    case, result, _ = posed["radial"]
    rows = result["time"].values[[40, 41]]
    poses = poses_of(case, result, np.array([rows[0], 0.75 * rows[0] + 0.25 * rows[1], rows[1]]))
    assert_allclose(poses.load[1], 0.75 * poses.load[0] + 0.25 * poses.load[2], rtol=1e-14)
    assert np.ptp(poses.load[:, 0]) > 1e-3


@pytest.mark.parametrize("kind", CASES)
def test_finished_result_gives_the_same_poses_as_its_case(posed, kind, tmp_path):
    case, result, poses = posed[kind]
    results.save(result, tmp_path / "result.nc")
    read = results.load(tmp_path / "result.nc")
    found = case_of(read)
    assert (found.kind, found.name, found.title) == (case.kind, case.name, case.title)
    assert rests_on(found) == rests_on(case)
    again = poses_of(found, read, poses.times)
    for name, line in poses.members.items():
        assert np.array_equal(again.members[name], line)


def test_results_without_a_case_or_of_another_version_are_refused(posed):
    _, result, _ = posed["radial"]
    bare = result.copy()
    bare.attrs = {name: value for name, value in result.attrs.items() if name != "case_text"}
    with pytest.raises(ValueError, match="wanted a result that holds its case"):
        case_of(bare)
    foreign = result.copy()
    written = json.loads(result.attrs["case_text"])
    written["crane"]["jib"]["wings"] = "3 m"
    foreign.attrs = {**result.attrs, "case_text": json.dumps(written)}
    with pytest.raises(ValueError, match=r"cannot be read by this version, at crane\.jib\.wings"):
        case_of(foreign)


def test_result_that_lacks_a_coordinate_is_refused(posed):
    case, result, _ = posed["multi-mass"]
    with pytest.raises(ValueError, match="wanted a result with tower_x, got one without"):
        poses_of(case, result.drop_vars("tower_x"), np.zeros(1))


def test_planar_sees_what_leaves_the_plane(posed):
    _, _, poses = posed["radial"]
    aside = poses.load.copy()
    aside[-1, 1] = 1e-3
    assert not replace(poses, load=aside).planar


def test_collars_stand_where_their_floors_hold_the_tower_whatever_it_does():
    case = load_case("towers/tied-wind", ["run.duration=1 s", "model.tower_modes=2"])
    result = run_case(case)
    poses = poses_of(case, result, result["time"].values)
    assert abs(poses.members["tower"][..., :2]).max() > 1e-3
    for lines in (poses.members, poses.undeformed):
        assert_allclose(lines["collars"], np.broadcast_to([[0.0, 0.0, 30.0], [0.0, 0.0, 55.0]], (21, 2, 3)))
