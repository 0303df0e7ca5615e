"""The benchmark's logic: references agree, rivals solve the same equations, failures and absences show."""

import dataclasses
import json

import numpy as np
import pytest
from numpy.testing import assert_allclose

from towercrane.bench import SUBJECTS, measure
from towercrane.bench.clock import Timing, difference, interleaved
from towercrane.bench.rivals import solvers as rivals
from towercrane.bench.rivals import workprecision
from towercrane.bench.runs import heads, lanes, one_hour, space
from towercrane.bench.runs.growth import exponent
from towercrane.bench.runs.stability import failure_map
from towercrane.bench.scenes.plain import model_states, plain_rhs, plain_state
from towercrane.bench.scenes.prepared import jib_scene, lumped_scene, radial_scene, space_scene
from towercrane.cases.case import load_case
from towercrane.cases.models import motions_of
from towercrane.commands.shared.skeleton import as_text
from towercrane.cranes.tower.file.build import tower_model
from towercrane.motions.motion import phases
from towercrane.simulation.methods.registry import METHODS


@pytest.fixture(scope="module")
def short():
    """Condition 3 for six seconds, with a switch point inside."""
    scene = radial_scene(1, 1)
    case = load_case("qtz5613/condition-3")
    cut = phases((motions_of(case)["trolley"], motions_of(case)["rope"]), 10.0)
    assert len(cut.inputs) == 2
    return dataclasses.replace(scene, cut=cut, grid=np.linspace(0.0, 10.0, 101))


def test_plain_equations_are_the_compiled_ones_at_random_states():
    model = tower_model(load_case("qtz5613/condition-3").checked)
    rhs, n, rng = plain_rhs(model), model.coordinates, np.random.default_rng(3)
    inputs = np.array([[5.0, 0.3, 0.05], [12.0, -0.2, 0.03]])
    for _ in range(20):
        plain = 0.5 * rng.normal(size=2 * n + 2)
        state = model_states(model, plain[None])[0]
        compiled, _ = model.system.slope(3.1, state, inputs)
        found = rhs(3.1, plain, inputs)
        # The second derivative of the direction, seen along the swing, is that of the angle.
        swing = compiled[2 * n + 2 : 2 * n + 4] @ [np.cos(plain[n]), np.sin(plain[n])]
        wanted = np.concatenate([compiled[:n], [plain[-1]], compiled[n + 2 : 2 * n + 2], [swing]])
        assert_allclose(found, wanted, rtol=1e-11, atol=1e-11 * abs(wanted).max())
        assert_allclose(plain_state(model, state[None])[0][:n], plain[:n], rtol=0)


def test_expressions_are_the_plain_equations_at_random_states(short):
    heyoka = pytest.importorskip("heyoka")
    from towercrane.bench.rivals import taylor

    names = [f"y{i}" for i in range(len(short.plain.start))]
    states = heyoka.make_vars(*names)
    channels = [np.array([heyoka.par[i] for i in part], dtype=object) for part in ((0, 1, 2), (3,))]
    slopes = heyoka.cfunc(taylor.expressions(short.plain.model, np.array(states, dtype=object), channels), states)
    rng = np.random.default_rng(5)
    for inputs in short.cut.inputs:
        state = 0.5 * rng.normal(size=len(names))
        found = slopes(state, pars=taylor.coefficients(short, inputs), time=2.5)
        assert_allclose(found, short.plain.rhs(2.5, state, inputs), rtol=1e-11, atol=1e-13)


@pytest.mark.parametrize("family", [*rivals.OWN, *rivals.RIVALS], ids=lambda family: family.name)
def test_every_solver_meets_the_reference(family, short):
    if not family.installed:
        pytest.skip(f"{family.package} is an extra")
    reference = short.outputs(rivals.own("dop853")(short, 1e-12)[0])
    states, evaluations = family.solve(short, 1e-6)
    assert states.shape == (len(short.grid), short.system.size)
    assert evaluations > 50
    error = difference(short.outputs(states), reference)
    assert 1e-11 < error < 3e-4, error


@pytest.mark.parametrize(
    "scene", [lumped_scene("basic"), jib_scene(), space_scene(3.0)], ids=lambda scene: scene.name
)
def test_scenes_of_other_cranes_are_solved_alike(scene):
    first, second = (scene.outputs(rivals.own(method)(scene, 1e-9)[0]) for method in ("dop853", "dopri5"))
    assert difference(first, second) < 1e-6


def test_failures_and_absent_packages_stand_in_the_table(short, monkeypatch):
    def gives_up(scene, rtol):
        raise rivals.Failed("gave up at 3 s")

    families = (
        rivals.Family("weak", gives_up, (1e-6,)),
        rivals.Family("absent", gives_up, (1e-6,), package="no_such"),
    )
    monkeypatch.setattr(workprecision, "RIVALS", families)
    monkeypatch.setattr(workprecision, "OWN", rivals.OWN[:1])
    subject = workprecision.work_precision(short, 1)
    rows = {row[0]: row for row in subject["rows"]}
    assert rows["weak"][2] == "gave up at 3 s"
    assert rows["absent"][2].startswith("not installed: pip install 'towercrane-dynamics[rivals]'")
    own = [record for record in subject["records"] if record["family"] == "towercrane dop853"]
    assert [record["rtol"] for record in own] == [1e-3, 1e-4, 1e-6, 1e-7, 1e-8, 1e-10]
    assert own[-1]["error"] < 1e-8 < 1e-4 < own[0]["error"] < 1e-2
    assert subject["within"]["cpu_seconds"]["towercrane dop853"] > 0.0
    assert "weak" not in subject["within"]["cpu_seconds"]
    from towercrane.report.plots.bench.work import pictures

    assert set(pictures({"subjects": [subject]})) == {"radial.png"}


def test_cost_is_compared_at_equal_or_smaller_error_only():
    records = [
        {"family": "a", "error": 2e-6, "cpu_seconds": 1.0},
        {"family": "a", "error": 1e-6, "cpu_seconds": 3.0},
        {"family": "a", "error": 1e-9, "cpu_seconds": 5.0},
        {"family": "b", "error": 1.1e-6, "cpu_seconds": 1.0},
        {"family": "c", "failure": "none"},
    ]
    assert workprecision._cheapest(records, 1e-6) == {"a": 3.0}


def test_the_first_run_is_apart_and_long_runs_are_few():
    calls = {"short": 0}

    def count():
        calls["short"] += 1
        return calls["short"]

    results, timings = interleaved({"short": count}, 4)
    assert results == {"short": 1}
    assert calls["short"] == 5
    assert timings["short"].runs == 4
    assert timings["short"].low <= timings["short"].cpu <= timings["short"].high
    assert Timing(0.0, 0.0123, 0.0, 0.012, 0.014, 3).spread == "12.3 ± 1"


def test_exponents_are_those_of_a_power():
    x = [1.0, 2.0, 5.0]
    assert exponent(x, [3.0 * v**1.5 for v in x]) == pytest.approx(1.5, abs=1e-12)


def test_an_unknown_subject_is_named_with_those_there_are():
    with pytest.raises(ValueError, match=r"subject: wanted one of roots, .*growth, got 'speed'"):
        measure(subject="speed")
    assert {"roots", "radial", "multi-mass", "enhanced", "basic", "jib"} <= set(SUBJECTS)


def test_cost_of_ties_and_of_a_jib_that_pivots(monkeypatch):
    # Without compiling: how long each takes is no matter here.
    monkeypatch.setattr(
        "towercrane.bench.evaluations.interleaved",
        lambda contestants, _: (
            {},
            {name: Timing(0.0, 1.0 + k, 0.0, 0.0, 0.0, 1) for k, name in enumerate(contestants)},
        ),
    )
    table = heads.heads(1)
    records = table["records"]
    # Each tie brings three coordinates.
    assert [record["states"] for record in records] == [19, 37, 43, 25, 27]
    assert [record["ratio"] for record in records] == [1.0, 2.0, 3.0, 4.0, 5.0]
    assert "costs 1.25 times" in table["notes"][1]
    frequencies = [record["frequency"] for record in records]
    assert frequencies[:3] == pytest.approx([0.511, 0.773, 0.954], abs=1e-3)
    assert frequencies[3:] == [None, None]
    assert [row[-1] for row in table["rows"]] == ["-46 %", "-19 %", "+0 %", "-", "-"]
    assert all(len(row) == len(table["columns"]) for row in table["rows"])


def test_cost_of_a_right_hand_side_in_space(monkeypatch):
    monkeypatch.setattr(space, "EVALUATIONS", 50)
    table = space.space_right_hand_sides(1)
    # Twice each coordinate and the rope's direction in space, and the work.
    assert [record["states"] for record in table["records"]] == [2 * n + 7 for n in (0, 5, 5, 11)]
    assert all(record["nanoseconds"] > 0.0 for record in table["records"])


def test_one_hour_shows_what_was_measured(monkeypatch):
    monkeypatch.setattr(one_hour, "HOUR", 20.0)
    monkeypatch.setattr(one_hour, "MODES", ((1, 1),))
    table = one_hour.one_hour(quick=True)
    assert {row[0] for row in table["rows"]} == set(METHODS)
    assert {record["method"] for record in table["records"]} == {"dop853", "dopri5"}
    for record in table["records"]:
        assert record["change"] == record["curve"]["change"][-1]
        assert record["curve"]["time_s"] == [0.0, 10.0, 20.0]
        assert 1e-13 < abs(record["change"]) < 1e-4
    row = next(row for row in table["rows"] if row[0] == "scipy-radau")
    assert row[2:] == ["-", "-"]
    from towercrane.report.plots.bench.work import pictures

    assert set(pictures({"subjects": [table]})) == {"one-hour.png"}


def test_growth_of_the_error_is_drawn_with_its_exponents():
    from towercrane.report.plots.bench.work import pictures

    curves = {"dop853": [1e-9, 3e-8, 2e-7], "dopri5": [2e-6, 5e-6, 7e-5]}
    records = [
        {"method": method, "rtol": 1e-6, "exponent": exponent, "curve": {"time_s": [1.0, 10.0, 60.0], "error": error}}
        for exponent, (method, error) in zip((1.25, 0.5), curves.items(), strict=True)
    ]
    figures = pictures({"subjects": [{"name": "error-growth", "records": records}]})
    (axes,) = figures["error-growth.png"].axes
    for line, (method, error) in zip(axes.get_lines(), curves.items(), strict=True):
        assert_allclose(line.get_data(), ([1.0, 10.0, 60.0], error))
        assert line.get_linestyle() == ("-" if method == "dop853" else "--")
    names = [text.get_text() for text in axes.get_legend().get_texts()]
    assert names == ["dop853, rtol 1e-06: ~ t^1.25", "dopri5, rtol 1e-06: ~ t^0.50"]
    assert (axes.get_xscale(), axes.get_yscale()) == ("log", "log")
    assert "[s]" in axes.get_xlabel()
    assert "[1]" in axes.get_ylabel()


def test_many_runs_stand_in_a_report_under_their_name(monkeypatch):
    from towercrane.report.plots.bench.work import pictures

    monkeypatch.setattr(lanes, "FEW", 16)
    monkeypatch.setattr(lanes, "FEW_ALONE", 2)
    table = lanes.many_runs(1)
    assert table["name"] == "many"
    assert pictures({"subjects": [table]}) == {}
    assert [record["runs"] for record in table["records"]] == [2, 16, 16, 2, 16]


def test_a_report_with_failures_is_json():
    text = as_text({"rows": [1.0, float("inf"), float("nan")], "n": 3})
    assert json.loads(text) == {"rows": [1.0, "inf", "nan"], "n": 3}


def test_the_map_shows_what_was_measured_failed_and_left_out(monkeypatch):
    from towercrane.bench.runs import stability
    from towercrane.report.plots.bench.work import pictures

    monkeypatch.setattr(stability, "MAP_MODES", ((1, 1), (4, 6)))
    monkeypatch.setattr(stability, "MAP_SPAN", 5.0)
    monkeypatch.setattr(stability, "TOLERANCES", (1e-2, 1e-4))
    subject = failure_map(quick=True)
    cells = {(r["method"], r["rtol"], r["modes"]): r["change"] for r in subject["records"]}
    assert cells["scipy-radau", 1e-4, "1+1"] is None
    assert cells["dopri5", 1e-2, "1+1"] > 0.01
    assert -0.01 < cells["dop853", 1e-4, "1+1"] < 0.0
    assert set(pictures({"subjects": [subject]})) == {"failure-map.png"}
