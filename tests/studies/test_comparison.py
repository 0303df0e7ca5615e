"""Models of a case from rigid to rich: which there are, what each costs, which kinds of modes a target needs."""

import json

import numpy as np
import pytest
from numpy.testing import assert_allclose
from typer.testing import CliRunner

from towercrane.cases.case import load_case
from towercrane.cli import app
from towercrane.cranes.tower.file.members import luffing_of
from towercrane.report.plots.studies.comparison import paths
from towercrane.results.measures import departures
from towercrane.runs.run import record_case, run_case
from towercrane.studies.comparison import ONE_OF_EACH, OWN, RICHEST, compare, gaps, slowest, variants

NAME, RADIAL = "qtz5613/manoeuvre", "qtz5613/condition-3"
SHORT = ["run.duration=12 s", "run.output_step=0.1 s", "motion.trolley.start=30 m"]


@pytest.fixture(scope="module")
def compared():
    return compare(load_case(NAME, SHORT), 0.02)


def row_of(report, name):
    return next(row for row in report["rows"] if row["name"] == name)


def test_variants_are_every_choice_of_kinds():
    found = variants(load_case(NAME))
    assert len(found) == 16 + 2
    assert [found[0].name, *(v.name for v in found[-3:])] == ["rigid", ONE_OF_EACH, OWN, RICHEST]
    assert len({v.kinds for v in found}) == 16
    own = {"tower_modes": 2, "torsion_modes": 1, "jib_lateral_modes": 2, "jib_vertical_modes": 2}
    assert found[-2].counts == own
    assert found[-1].counts == {"tower_modes": 3, "torsion_modes": 2, "jib_lateral_modes": 4, "jib_vertical_modes": 4}
    model = found[5].model(load_case(NAME))
    assert (found[5].name, model.counts["tower_y"], model.counts["torsion"]) == ("tower + torsion", 2, 1)
    assert model.counts["jib_lateral"] == model.counts["jib_vertical"] == 0


def test_a_counter_jib_bends_in_the_models_whose_jib_does():
    case = load_case("flat-top/travel")
    for variant in variants(case):
        model = variant.model(case)
        assert bool(model.counts["counter_jib_vertical"]) == ("jib_vertical_modes" in variant.kinds)
    assert model.counts["counter_jib_vertical"] == 2
    assert sum(variants(case)[0].model(case).counts.values()) == 0


def test_variants_leave_out_what_the_case_does():
    names = [v.name for v in variants(load_case(NAME, ["model.torsion_modes=0", "model.tower_modes=14"]))]
    assert len(names) == 8 + 2
    assert not any("torsion" in name for name in names)
    assert variants(load_case(NAME, ["model.tower_modes=14"]))[-1].counts["tower_modes"] == 14
    assert [v.name for v in variants(load_case(RADIAL))] == ["rigid", "tower", "vertical", ONE_OF_EACH, OWN, RICHEST]
    one = ["model.tower_modes=1", "model.jib_vertical_modes=1"]
    assert [v.name for v in variants(load_case(RADIAL, one))] == ["rigid", "tower", "vertical", OWN, RICHEST]


def test_errors_are_distances_from_the_richest(compared):
    report, results = compared
    richest = results[RICHEST]
    assert report["rows"][-1]["relative_error"] == 0.0
    for row in report["rows"]:
        gap = results[row["name"]]["payload_position"].values - richest["payload_position"].values
        assert row["horizontal_error_m"] == pytest.approx(np.linalg.norm(gap[:, :2], axis=1).max())
        assert row["vertical_error_m"] == pytest.approx(abs(gap[:, 2]).max())
        assert row["relative_error"] == pytest.approx(np.linalg.norm(gap, axis=1).max() / report["departure_m"])
        assert row["slewing_torque_nm"] == pytest.approx(float(abs(results[row["name"]].slewing_torque).max()))
    own = record_case(load_case(NAME, SHORT))
    assert_allclose(results[OWN]["payload_position"].values, own["payload_position"].values, rtol=0.0, atol=1e-12)
    errors = [row_of(report, name)["relative_error"] for name in ("rigid", ONE_OF_EACH, OWN)]
    assert errors == sorted(errors, reverse=True)


def test_departure_counts_from_where_the_load_would_hang_on_a_rigid_crane():
    still = load_case(
        "qtz5613/slewing", ["motion.slewing.end=0.001 deg", "run.duration=5 s", "motion.slewing.delay=4 s"]
    )
    counts = dict.fromkeys(("tower_modes", "torsion_modes", "jib_lateral_modes", "jib_vertical_modes"), 0)
    from towercrane.cranes.tower.file.build import tower_model

    rigid = run_case(still, model=tower_model(still.checked, **counts))
    assert np.linalg.norm(departures(rigid)[:70], axis=1).max() < 1e-9
    # The elastic crane has sunk by the tilt of its tower and its jib's sag.
    assert departures(run_case(still))[0, 2] == pytest.approx(-1.2, abs=0.3)


def test_target_decides_which_kinds_are_needed(compared):
    report, _ = compared
    best = row_of(report, report["recommended"])
    assert best["relative_error"] <= 0.02
    kept = {name for name, count in zip(report["kinds_of_modes"], best["modes"].values(), strict=True) if count}
    assert set(report["needed"]) == kept
    # No other model with as few kinds is within the target at fewer calls.
    for row in report["rows"][:-1]:
        if row["relative_error"] <= 0.02:
            kinds = sum(count > 0 for count in row["modes"].values())
            assert (len(kept), best["evaluations"]) <= (kinds, row["evaluations"])
    assert len(report["reasons"]) == 4
    torsion = next(reason for reason in report["reasons"] if reason.startswith("torsion"))
    without = row_of(report, "tower + lateral + vertical")
    assert f"{without['relative_error']:.2g}" in torsion
    assert "slowest motion across the jib" in torsion
    assert "needed" in torsion


def test_the_slowest_motions_are_those_of_the_pendulum_on_a_rigid_crane(compared):
    report, results = compared
    case = load_case(NAME, SHORT)
    rigid = slowest(case, variants(case)[0], results["rigid"])
    pendulum = np.sqrt(9.81 / float(results["rigid"].rope_length[-1])) / (2 * np.pi)
    assert_allclose([rigid["along"], rigid["across"]], pendulum, rtol=1e-9)
    rich = row_of(report, RICHEST)["slowest_hz"]
    assert rich["along"] == pytest.approx(pendulum, rel=2e-3)
    assert rich["across"] < 0.9 * pendulum


def test_a_model_that_ends_early_has_no_error():
    # The heavy zero start lets the rope go slack once the jib is flexible.
    case = load_case("qtz5613/condition-4-zero", ["rope.slack=stop", "run.duration=20 s"])
    report, results = compare(case, 0.01)
    assert results[RICHEST].attrs["outcome"] == "slack rope"
    assert all(row["relative_error"] is None for row in report["rows"])
    assert (report["recommended"], report["needed"]) == (None, ["tower", "vertical"])
    assert any("slack rope" in reason or "finished" in reason for reason in report["reasons"])
    assert len(gaps(results["rigid"], results[RICHEST])) <= len(results["rigid"].time)
    paths(report, results).canvas.draw()


def test_what_cannot_be_compared_is_refused():
    with pytest.raises(ValueError, match="wanted a case of kind tower, got 'jib'"):
        compare(load_case("jib-crane/plan"), 0.01)
    with pytest.raises(ValueError, match="wanted one mode or more"):
        compare(load_case(RADIAL, ["model.tower_modes=0", "model.jib_vertical_modes=0"]), 0.01)


def test_picture_shows_paths_and_distances_with_units(compared):
    report, results = compared
    figure = paths(report, results)
    figure.canvas.draw()
    assert all("[" in axes.get_xlabel() for axes in figure.axes)
    assert [axes.get_ylabel() for axes in figure.axes[-2:]] == ["horizontal distance [m]", "vertical distance [m]"]
    named = {text.get_text() for text in figure.subfigs[1].legends[0].get_texts()}
    assert {"rigid", OWN} <= named
    assert "assumed" in figure._supxlabel.get_text()


def test_command_answers_for_space_and_for_the_plane(tmp_path):
    runner = CliRunner()
    options = [part for change in [*SHORT, "accuracy.target=0.05"] for part in ("--set", change)]
    done = runner.invoke(app, ["compare", NAME, "--out", str(tmp_path), *options])
    assert done.exit_code == 0, done.output
    assert {path.name for path in tmp_path.iterdir()} == {"compare.json", "paths.png"}
    # The case's own target.
    assert "for an error of 0.05 it needs" in done.output
    report = json.loads((tmp_path / "compare.json").read_text("utf-8"))
    assert report["target"] == 0.05
    plane = ["compare", RADIAL, "--out", str(tmp_path), "--no-pictures", "--json", "--set", "run.duration=20 s"]
    report = json.loads(runner.invoke(app, [*plane, "--target", "0.1"]).stdout)
    assert (report["target"], report["kinds_of_modes"]) == (0.1, ["tower", "vertical"])
    assert json.loads(runner.invoke(app, plane).stdout)["target"] == 0.01
    for wrong, words in (
        (["compare", "jib-crane/plan"], "wanted a case of kind 'tower'"),
        (["compare", NAME, "--target", "3"], "wanted a fraction between 0 and 1"),
        (
            ["compare", RADIAL, "--set", "model.tower_modes=0", "--set", "model.jib_vertical_modes=0"],
            "one mode or more",
        ),
    ):
        refused = runner.invoke(app, [*wrong, "--out", str(tmp_path)])
        assert refused.exit_code == 2
        assert words in refused.output


def test_cranes_that_hang_on_ties_or_pivot_are_compared_without_modes_too():
    """Without modes they still move in what holds the jib; the richest has modes that ties stand for otherwise."""
    case = load_case(
        "luffing/manoeuvre", ["run.duration=6 s", "run.output_step=0.1 s", "motion.slewing.speed=0 rad/s"]
    )
    report, results = compare(case, 0.05)
    names = [row["name"] for row in report["rows"]]
    assert names == ["no modes", "tower", "vertical", ONE_OF_EACH, OWN, RICHEST]
    assert report["rows"][-1]["modes"] == {"tower_modes": 3, "jib_vertical_modes": 4}
    # Where the load would hang on a rigid crane follows the winches alone, and the rope that luffing pays out.
    hung = results["no modes"]["payload_position"].values - departures(results["no modes"])
    assert_allclose(hung, results[RICHEST]["payload_position"].values - departures(results[RICHEST]), atol=1e-12)
    own, without = (row_of(report, name) for name in (OWN, "no modes"))
    assert own["relative_error"] < 0.02 < without["relative_error"]
    assert 0.9 < own["slowest_hz"]["along"] / report["rows"][-1]["slowest_hz"]["along"] < 1.01
    paths(report, results).canvas.draw()
    tied = variants(load_case("hammerhead/travel"))
    assert [v.name for v in tied] == names
    assert [v.counter["counter_jib_vertical_modes"] for v in tied] == [0, 0, 0, 0, 0, 1]


def test_the_load_of_a_luffing_crane_is_told_from_where_it_would_hang_on_a_rigid_one():
    """By hand: the jib's straight head at the commanded angle, and the rope that its winch has left below it."""
    rigid = [f"model.{kind}_modes=0" for kind in ("tower", "torsion", "jib_lateral", "jib_vertical")]
    stiff = [f"crane.jib.luffing.{key}_stiffness=100 GN" for key in ("rope", "axial")]
    case = load_case("luffing/manoeuvre", ["run.duration=3 s", "motion.hoist.delay=10 s", *rigid, *stiff])
    run = record_case(case)
    assert np.linalg.norm(departures(run)[0]) < 2e-3
    place = run["commanded_place"].values
    jib = luffing_of(case.checked)
    for row, angle in zip(place, run["luffing_command"].values, strict=True):
        x, z = jib.head(50.0, angle)
        paid = (jib.hoist_way(50.0, angle) - jib.hoist_way(50.0, np.radians(30.0))) / 2.0
        assert_allclose(row, [x, 0.0, z - 30.0 + paid], atol=1e-9)
