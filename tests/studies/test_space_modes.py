"""Natural modes of cases in space: known frequencies, lines of the deformed crane, tables, pictures, command."""

import json

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples.space_crane import kinematics
from typer.testing import CliRunner

from towercrane.cases.case import load_case
from towercrane.cli import app
from towercrane.cranes.tower.file.build import tower_model
from towercrane.cranes.tower.file.case_tables import TowerCase
from towercrane.motions.motion import rest
from towercrane.report.plots.studies import space_modes as pictured
from towercrane.studies.space_modes import (
    RICHER,
    Place,
    drawn_sweeps,
    modes_at,
    modes_rest_on,
    place_at,
    richer_model,
    space_frequencies,
)
from towercrane.studies.space_shapes import crane_lines

NAME = "qtz5613/manoeuvre"
# Two lateral modes on either side of the pendulum, of an independent program [Hz].
LATERAL = {
    (10.0, 20.0): (0.1094, 0.1319),
    (25.0, 15.0): (0.1100, 0.1499),
    (40.0, 12.0): (0.1020, 0.1770),
    (40.0, 20.0): (0.0927, 0.1511),
    (50.0, 15.0): (0.0915, 0.1729),
}


@pytest.fixture(scope="module")
def case():
    return load_case(NAME)


@pytest.fixture(scope="module")
def report(case):
    return space_frequencies(case)


def in_plane(shares):
    return shares["radial"] + shares["radial sway"]


@pytest.mark.parametrize(("place", "expected"), LATERAL.items())
def test_lateral_pair_is_that_of_another_program(case, place, expected):
    modes = modes_at(tower_model(case.checked), Place(*place), 6)
    lateral = [mode.frequency_hz for mode in modes if in_plane(mode.shares) < 0.5]
    assert_allclose(lateral[:2], expected, atol=1e-4)
    radial = next(mode.frequency_hz for mode in modes if in_plane(mode.shares) > 0.5)
    assert radial == pytest.approx(np.sqrt(9.81 / place[1]) / (2 * np.pi), rel=1e-3)


def test_report_sweeps_each_drive_by_itself(case, report):
    assert report["at"] == {"trolley_position_m": 10.0, "rope_length_m": 20.0, "slewing_angle_rad": 0.0}
    assert report["pendulum_hz"] == pytest.approx(np.sqrt(9.81 / 20.0) / (2 * np.pi))
    assert [row["value"] for row in report["sweeps"]["trolley_position"]] == [10.0, 25.0, 40.0, 55.0]
    assert len(report["modes"]) == 8
    first = [mode["frequency_hz"] for mode in report["modes"]]
    assert_allclose(report["sweeps"]["trolley_position"][0]["frequencies_hz"], first, rtol=1e-12)
    assert_allclose(report["sweeps"]["rope_length"][-1]["frequencies_hz"], first, rtol=1e-12)
    # An equal tower in all directions: turning the head changes nothing.
    for row in report["sweeps"]["slewing_angle"]:
        assert_allclose(row["frequencies_hz"], first, rtol=1e-9)
        assert row["kinds"] == [mode["kind"] for mode in report["modes"]]
    for mode in report["modes"]:
        assert sum(mode["energy_shares"].values()) == pytest.approx(1.0)
    # What the case's modes leave out of the lowest six.
    assert 1e-8 < max(abs(mode["relative_difference"]) for mode in report["modes"][:6]) < 1e-4
    keys = {entry["key"] for entry in report["assumed"]}
    assert "crane.tower.torsional_stiffness" in keys
    assert not any(key.startswith(("motion.", "crane.drive.", "crane.wind_areas.")) for key in keys)


def test_modes_are_paired_by_shape_and_those_a_model_cannot_have_are_named(report):
    bare = ["model.torsion_modes=0", "model.jib_lateral_modes=0", "modes.crane_count=6"]
    found = space_frequencies(load_case(NAME, bare))
    full = {mode["frequency_hz"]: mode for mode in report["modes"]}
    missing = [(mode["kind"], mode["frequency_hz"]) for mode in found["missing_from_the_model"]]
    assert [kind for kind, _ in missing] == ["torsion", "lateral", "lateral"]
    # Those of the case itself, with more modes of its kinds, are the torsion and the two lateral ones that it has.
    own = [f for f, mode in full.items() if mode["kind"] in ("torsion", "lateral")]
    assert_allclose([frequency for _, frequency in missing], own, rtol=3e-3)
    lateral = next(mode for mode in found["modes"] if mode["kind"] == "lateral")
    assert lateral["relative_difference"] is None
    # A lateral sway beside the one that torsion slows, whatever stands between them in the order.
    sway = next(mode for mode in found["modes"] if mode["kind"] == "lateral sway")
    slowed = next(f for f, mode in full.items() if mode["kind"] == "lateral sway")
    assert sway["frequency_hz"] / (1.0 + sway["relative_difference"]) == pytest.approx(slowed, rel=1e-4)
    radial = [(a["kind"], a["frequency_hz"]) for a in found["modes"] if a["kind"].startswith("radial")]
    assert_allclose([f for _, f in radial], [f for f, mode in full.items() if mode["kind"].startswith("radial")])
    assert report["missing_from_the_model"] == []


def test_a_rigid_crane_is_told_what_its_flexibility_would_change():
    rigid = [f"model.{kind}_modes=0" for kind in ("tower", "torsion", "jib_lateral", "jib_vertical")]
    found = space_frequencies(load_case(NAME, rigid))
    assert_allclose([mode["frequency_hz"] for mode in found["modes"]], found["pendulum_hz"], rtol=1e-9)
    changes = {mode["kind"]: mode["relative_difference"] for mode in found["modes"]}
    assert changes["lateral sway"] == pytest.approx(0.018595, abs=1e-4)
    assert changes["radial sway"] == pytest.approx(5.9e-4, abs=2e-5)


def test_a_richer_model_has_more_modes_of_every_kind_than_the_case():
    own = {"tower": 3, "torsion": 1, "jib_lateral": 0, "jib_vertical": 4}
    case = load_case(NAME, [f"model.{kind}_modes={count}" for kind, count in own.items()])
    found = richer_model(case.tables(TowerCase)).counts
    # The tower bends in two directions.
    of_kinds = {kind: found[{"tower": "tower_x"}.get(kind, kind)] for kind in own}
    assert of_kinds == {kind: count + RICHER for kind, count in own.items()}
    assert found["tower_y"] == found["tower_x"]


def test_places_default_to_the_ends_of_the_ways():
    sweeps = space_frequencies(load_case("qtz5613/gentle"))["sweeps"]
    assert [row["value"] for row in sweeps["trolley_position"]] == [10.0, 40.0]
    assert [row["value"] for row in sweeps["rope_length"]] == pytest.approx([12.0, 20.0])
    assert [row["value"] for row in sweeps["slewing_angle"]] == pytest.approx([0.0, np.pi / 2])


def test_a_tower_that_buckles_is_an_outcome(case):
    weak = ["model.weight_softening=true", 'crane.tower.second_moment_of_area="0.0002 m^4"']
    found = space_frequencies(load_case(NAME, weak))
    assert (found["outcome"], found["modes"]) == ("tower buckled", [])
    assert {row["outcome"] for row in found["sweeps"]["rope_length"]} == {"tower buckled"}


def test_lines_of_the_undeformed_crane(case):
    model, place = tower_model(case.checked), Place(30.0, 15.0, 1.0)
    mode = modes_at(model, place, 1)[0]
    lines = crane_lines(model, mode, place, 12.3)
    assert_allclose(lines["tower"][[0, -1]], [[0, 0, 0], [0, 0, 23.8]], atol=1e-12)
    assert_allclose(lines["jib"][[0, -1]], [[0, 0, 23.8], [55.6, 0, 23.8]], atol=1e-12)
    assert_allclose(lines["counter-jib"][[0, -1]], [[-12.3, 0, 23.8], [0, 0, 23.8]], atol=1e-12)
    assert_allclose(lines["rope"], [[30, 0, 23.8], [30, 0, 8.8]], atol=1e-12)


@pytest.mark.parametrize("driven", [False, True])
@pytest.mark.parametrize("heading", [0.0, 2.1])
def test_lines_join_and_do_not_depend_on_the_heading(driven, heading):
    model = tower_model(load_case("qtz5613/soft-drive" if driven else NAME).checked)
    moved, straight = [], []
    for angle, found in ((heading, moved), (0.0, straight)):
        place = Place(30.0, 15.0, angle)
        for mode in modes_at(model, place, 6):
            found.append(crane_lines(model, mode, place, 12.3, 1.0))
    for lines, same in zip(moved, straight, strict=True):
        for name, line in lines.items():
            # Shapes come with either sign.
            mirrored = 2.0 * crane_lines(model, mode, place, 12.3)[name] - line
            gap = min(abs(line - same[name]).max(), abs(mirrored - same[name]).max())
            assert gap < 1e-6 * max(1.0, abs(line).max()), name
        assert_allclose(lines["tower"][-1], lines["jib"][0], atol=1e-12)
        assert_allclose(lines["counter-jib"][-1], lines["jib"][0], atol=1e-12)
        # The trolley stays on the jib, whose points keep their distance from the axis.
        out = lines["jib"][:, 0] - lines["tower"][-1, 0]
        for axis in (1, 2):
            on_jib = np.interp(30.0, out, lines["jib"][:, axis])
            assert lines["rope"][0, axis] == pytest.approx(on_jib, abs=2e-3 * abs(lines["jib"] - 23.8).max())


def test_jib_leaves_the_head_along_its_slope(case):
    # A clamped jib: next to the head it goes on where the rigid counter-jib points.
    model, place = tower_model(case.checked), Place(30.0, 15.0, 0.7)
    for mode in modes_at(model, place, 8):
        lines = crane_lines(model, mode, place, 12.3, 1.0)
        jib, counter = lines["jib"], lines["counter-jib"]
        still = crane_lines(model, mode, place, 12.3)
        behind = (counter[-1] - counter[0] - (still["counter-jib"][-1] - still["counter-jib"][0])) / 12.3
        step = still["jib"][1, 0]
        ahead = (jib[1] - jib[0] - (still["jib"][1] - still["jib"][0])) / step
        size = abs(jib - still["jib"]).max() / 55.6
        assert_allclose(ahead[1:], behind[1:], atol=0.6 * size)


def test_pictures_show_units_kinds_and_assumptions(case):
    model, place = tower_model(case.checked), place_at(case)
    notes = [(a.key, str(a.value), a.why) for a in modes_rest_on(case)]
    figure = pictured.shapes(model, modes_at(model, place, 3), place, 12.3, "title", notes)
    figure.canvas.draw()
    shown = [axes for axes in figure.axes if axes.get_visible()]
    assert len(shown) == 6
    assert all("[m]" in axes.get_ylabel() and "Hz" in shown[0].get_title() for axes in shown)
    assert "energy" in shown[1].get_title()
    for side, above in zip(shown[::2], shown[1::2], strict=True):
        # Grey and coloured lines in turn, then the load; what moves most moves by a known part of the longest length.
        both = [
            np.array([line.get_xydata() for line in axes.get_lines()[:-1]], dtype=object) for axes in (side, above)
        ]
        moved = [[b - a for a, b in zip(lines[::2], lines[1::2], strict=True)] for lines in both]
        largest = max(max(abs(up).max(), abs(across).max()) for up, across in zip(*moved, strict=True))
        assert largest == pytest.approx(pictured.LARGEST * 55.6, rel=1e-9)
    sweeps = {name: rows[::8] for name, rows in drawn_sweeps(case).items()}
    figure = pictured.frequencies(sweeps, "title", notes)
    figure.canvas.draw()
    assert [axes.get_xlabel().rpartition(" ")[2] for axes in figure.axes] == ["[m]", "[m]", "[deg]"]
    assert [text.get_text() for text in figure.legends[0].get_texts()] == list(pictured.MOTION_KINDS)
    assert "torsional" in figure._supxlabel.get_text()


def test_command_prints_tables_or_json_and_draws(tmp_path):
    runner = CliRunner()
    done = runner.invoke(app, ["modes", NAME, "--out", str(tmp_path)])
    assert done.exit_code == 0, done.output
    assert "lateral sway" in done.output
    assert "the rope by itself swings at 0.111465 Hz" in done.output
    assert f"next: towercrane run {NAME}" in done.output
    assert {path.name for path in tmp_path.iterdir()} == {"modes.png", "frequencies.png"}
    report = json.loads(runner.invoke(app, ["modes", NAME, "--json", "--set", "modes.crane_count=2"]).stdout)
    assert len(report["modes"]) == 2
    told = runner.invoke(app, ["map", NAME, "--out", str(tmp_path)])
    assert told.exit_code == 0, told.output
    assert "leaves the jib's plane" in told.output
    # Lattices are shown in space.
    assert "leaves the jib's plane" not in runner.invoke(app, ["lattice", NAME]).output


@pytest.mark.parametrize("heading", [0.0, 0.9])
def test_lines_move_as_the_model_does(case, heading):
    # Trolley and load of the model itself, moved a little along the mode from the undeformed crane.
    model, place = tower_model(case.checked), Place(30.0, 15.0, heading)
    motions = {"trolley": rest(30.0), "rope": rest(15.0), "slewing": rest(heading)}
    turn = np.array([[np.cos(heading), np.sin(heading)], [-np.sin(heading), np.cos(heading)]])
    n = model.coordinates
    for mode in modes_at(model, place, 8):
        lines, still = (crane_lines(model, mode, place, 12.3, scale) for scale in (1.0, 0.0))
        small = 1e-5 / abs(lines["rope"] - still["rope"]).max()
        states = np.zeros((2, model.size))
        # Both ways: what is of second order cancels.
        states[:, :n] = np.outer([-small, small], mode.shape[:n])
        states[:, n : n + 2] = np.outer([-small, small], mode.shape[n:] / 15.0)
        states[:, n + 2] = -1.0
        motion = kinematics(model, motions, np.zeros(2), states)
        for end, (place_in_space, _) in enumerate((motion.trolley_in_space, motion.load_in_space)):
            moved = np.diff(place_in_space)[:, 0] / (2.0 * small)
            moved[:2] = turn @ moved[:2]
            wanted = (lines["rope"] - still["rope"])[end]
            assert_allclose(moved, wanted, atol=1e-4 * abs(wanted).max())
