"""Which effects a case's results hold, by what it describes and by the tolerance it accepts."""

from __future__ import annotations

import json

import numpy as np
import pytest

from modal import Beam, Chain
from towercrane import load_case
from towercrane.cranes.tower.equations.small_motions import plane_modes
from towercrane.cranes.tower.file.build import tower_model
from towercrane.cranes.tower.file.effects import effects_in, effects_report, kept_tower
from towercrane.studies.natural import natural_frequencies

CASE = "qtz5613/condition-3"
SOFT = (
    "crane.tower.shear_stiffness=1.2e8 N",
    "crane.tower.rotary_inertia_per_length=250 kg m",
    "crane.foundation.rotation_stiffness=1e10 N m/rad",
)


def test_a_plain_case_keeps_nothing_but_tells_what_its_lattice_and_weight_would_do():
    effects = effects_in(load_case(CASE).checked)
    assert effects.kept == ()
    assert set(effects.left_out) == {"shear", "weight", "rotary inertia"}
    np.testing.assert_allclose(100 * effects.influence.changes["shear"], [-0.73, -17.7, -42.6, -57.5], atol=0.06)
    assert effects.actual("weight")[0] == pytest.approx(-0.00997, abs=2e-5)


def test_what_a_case_describes_is_in_its_results():
    case = load_case(CASE, (*SOFT, "model.weight_softening=true"))
    assert effects_in(case.checked).kept == ("shear", "weight", "rotary inertia", "foundation")
    assert isinstance(kept_tower(case.checked), Chain)
    assert tower_model(case.checked).weight_softening


@pytest.mark.parametrize(
    ("tolerance", "kept"),
    [
        (1e-6, {"shear", "weight", "rotary inertia", "foundation"}),
        (1e-3, {"shear", "weight", "foundation"}),
        (0.012, {"shear", "foundation"}),
    ],
)
def test_a_tolerance_keeps_what_matters_and_the_results_follow(tolerance, kept):
    case = load_case(CASE, (*SOFT, "modes.count=2", f"accuracy.frequency={tolerance}"))
    effects = effects_in(case.checked)
    assert set(effects.kept) == kept
    lost = sum(np.abs(effects.influence.changes[effect]) for effect in effects.left_out)
    assert np.max(lost) <= tolerance
    model = tower_model(case.checked)
    assert model.weight_softening == ("weight" in kept)
    assert kept_tower(case.checked).segments[0].rotary_inertia == (250.0 if "rotary inertia" in kept else 0.0)
    # All effects of this tower together, against the ones that are kept.
    whole = tower_model(load_case(CASE, (*SOFT, "modes.count=2", "accuracy.frequency=1e-9")).checked)
    gap = plane_modes(model, 41.0, 18.0)[0][:4] / plane_modes(whole, 41.0, 18.0)[0][:4] - 1.0
    assert np.abs(gap).max() < 2 * tolerance


def test_softening_that_a_case_asks_for_is_not_left_out():
    changes = ("model.weight_softening=true", "accuracy.frequency=0.05")
    assert "weight" in effects_in(load_case(CASE, changes).checked).kept
    stated = load_case(CASE, ("model.weight_softening=false", "accuracy.frequency=1e-6"))
    assert "weight" not in effects_in(stated.checked).kept


def test_a_uniform_clamped_tower_stays_a_beam():
    assert isinstance(kept_tower(load_case(CASE, ("accuracy.frequency=1e-3",)).checked), Beam)


def test_report_is_plain_json_with_both_values_when_asked():
    effects = effects_in(load_case(CASE).checked)
    report = json.loads(json.dumps(effects_report(effects, actual=True)))
    assert report["left_out"] == ["shear", "weight", "rotary inertia"]
    assert report["left_out_may_cost"] == pytest.approx(0.604, abs=1e-3)
    for rows in report["changes"].values():
        np.testing.assert_allclose(rows["predicted"], rows["actual"], rtol=0.06)
    assert "actual" not in effects_report(effects)["changes"]["shear"]


@pytest.mark.parametrize("softening", ["true", "false"])
def test_the_coupled_crane_stands_beside_the_exact_frame(softening):
    case = load_case(CASE, (*SOFT, f"model.weight_softening={softening}", "modes.trolley_positions=[41]"))
    report = natural_frequencies(case)
    (row,) = report["crane"]
    assert report["tower"]["method"] == "dynamic stiffness"
    assert np.abs(report["finite_elements"]["relative_difference"]).max() < 1e-5
    assert 0.0 < max(row["relative_difference"]) < 1e-3
    # Of the second frequency the jib's modes left out are nearly the whole error.
    assert row["predicted_difference"][1] == pytest.approx(row["relative_difference"][1], rel=0.3)
    assert 30.0 < report["buckling_factor"] < 50.0
