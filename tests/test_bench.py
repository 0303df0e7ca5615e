"""The benchmark's logic: references agree, rivals solve the same equations, failures and absences show."""

import dataclasses
import json

import numpy as np
import pytest
from numpy.testing import assert_allclose

from towercrane import studies
from towercrane.bench import SUBJECTS, measure, rivals, workprecision
from towercrane.bench.clock import Timing, difference, interleaved
from towercrane.bench.growth import exponent
from towercrane.bench.plain import model_states, plain_rhs, plain_state
from towercrane.bench.scenes import jib_scene, lumped_scene, radial_scene
from towercrane.bench.stability import failure_map
from towercrane.case import load_case
from towercrane.models import radial_model
from towercrane.motion import phases


@pytest.fixture(scope="module")
def short():
    """Condition 3 for six seconds, with a switch point inside."""
    scene = radial_scene(1, 1)
    case = load_case("qtz5613/condition-3")
    cut = phases((case.trolley_motion(), case.rope_motion()), 10.0)
    assert len(cut.inputs) == 2
    return dataclasses.replace(scene, cut=cut, grid=np.linspace(0.0, 10.0, 101))


def test_plain_equations_are_the_compiled_ones_at_random_states():
    model = radial_model(load_case("qtz5613/condition-3"))
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


@pytest.mark.parametrize("scene", [lumped_scene("basic"), jib_scene()], ids=lambda scene: scene.name)
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
    assert [record["rtol"] for record in own] == [1e-3, 1e-4, 1e-6, 1e-8, 1e-10]
    assert own[-1]["error"] < 1e-8 < 1e-4 < own[0]["error"] < 1e-2
    assert subject["within"]["cpu_seconds"]["towercrane dop853"] > 0.0
    assert "weak" not in subject["within"]["cpu_seconds"]
    from towercrane.plots.bench import pictures

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


def test_a_report_with_failures_is_json():
    text = json.dumps(studies._finite({"rows": [1.0, float("inf"), float("nan")], "n": 3}), allow_nan=False)
    assert json.loads(text) == {"rows": [1.0, "inf", "nan"], "n": 3}


def test_the_map_shows_what_was_measured_failed_and_left_out(monkeypatch):
    from towercrane.bench import stability
    from towercrane.plots.bench import pictures

    monkeypatch.setattr(stability, "MAP_MODES", ((1, 1), (4, 6)))
    monkeypatch.setattr(stability, "MAP_SPAN", 5.0)
    monkeypatch.setattr(stability, "TOLERANCES", (1e-2, 1e-4))
    subject = failure_map(quick=True)
    cells = {(r["method"], r["rtol"], r["modes"]): r["change"] for r in subject["records"]}
    assert cells["scipy-radau", 1e-4, "1+1"] is None
    assert cells["dopri5", 1e-2, "1+1"] > 0.01
    assert -0.01 < cells["dop853", 1e-4, "1+1"] < 0.0
    assert set(pictures({"subjects": [subject]})) == {"failure-map.png"}
