"""Predicted changes of frequencies against the actual ones."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from samples.qtz5613 import CRANE

from modal import Chain, EndBody, Foundation, Segment, chain_frequencies, chain_structure, crane_structure
from modal.structures.influence import EFFECTS, Influence, effects_of, influence, keeping
from modal.structures.structure_modes import structure_modes
from towercrane import load_case
from towercrane.cranes.tower.equations.small_motions import plane_modes
from towercrane.cranes.tower.file.build import crane_frame, crane_of, tower_model
from towercrane.cranes.tower.truncation import TRUSTED, truncation_error

TOWER, END_BODY = CRANE.tower, CRANE.end_body
ROTARY = TOWER.mass_per_length * 0.84**2


def tower(length, shear_stiffness, body):
    segment = Segment(length, TOWER.mass_per_length, TOWER.bending_stiffness, shear_stiffness, ROTARY)
    return Chain((segment,), {1: body} if body else {}, Foundation(1e10), gravity=9.81)


TOWERS = {
    "QTZ5613": tower(23.8, 1.24e8, END_BODY),
    "bare": tower(23.8, 1.24e8, None),
    "tall": tower(60.0, 6e7, END_BODY),
    "stubby": tower(8.0, 1.24e8, END_BODY),
    "tapered": replace(
        tower(40.0, 1e8, EndBody(3000.0, 1e5, 1.5)),
        segments=(Segment(40.0, 500.0, 4e9, 1.5e8, 500.0, 0.6, 0.0, 2.0, 1.0),),
    ),
}
PRINTED = {  # shear, weight, rotary inertia in per cent: predicted and actual, modes 1 and 2
    "QTZ5613": {"shear": (-0.72, -0.74, -17.6, -17.4), "weight": (-0.95, -0.96, -0.16, -0.16)},
    "bare": {"shear": (-8.4, -8.5, -34.5, -34.3), "rotary inertia": (-0.29, -0.29, -1.96, -1.96)},
    "tall": {"shear": (-1.40, -1.41, -5.95, -5.81), "weight": (-7.76, -7.77, -0.67, -0.67)},
    "stubby": {"shear": (-0.12, -0.13, -56.7, -56.7), "weight": (-0.09, -0.09, -0.03, -0.03)},
}


def prediction(chain, count=2):
    plain = structure_modes(chain_structure(keeping(chain, ())), count)
    return plain.angular_frequencies, influence(plain, chain)


@pytest.mark.parametrize("name", TOWERS)
def test_each_effect_is_predicted_from_the_plain_modes(name):
    """Within 6 % of the change, however large it is."""
    omega, predicted = prediction(TOWERS[name])
    assert set(predicted.changes) == set(effects_of(TOWERS[name])) == set(EFFECTS)
    for effect, change in predicted.changes.items():
        actual = chain_frequencies(keeping(TOWERS[name], (effect,)), 2) / omega - 1.0
        assert (actual < 0.0).all()
        np.testing.assert_allclose(change, actual, rtol=0.06)


@pytest.mark.parametrize("name", PRINTED)
def test_known_figures(name):
    omega, predicted = prediction(TOWERS[name])
    for effect, (first, first_actual, second, second_actual) in PRINTED[name].items():
        actual = 100.0 * (chain_frequencies(keeping(TOWERS[name], (effect,)), 2) / omega - 1.0)
        np.testing.assert_allclose(100.0 * predicted.changes[effect], (first, second), atol=0.06)
        np.testing.assert_allclose(actual, (first_actual, second_actual), atol=0.06)


def test_effects_are_left_out_as_long_as_they_cost_less_than_the_tolerance_together():
    found = Influence(
        {"shear": np.array([-0.02, -0.3]), "weight": np.array([-6e-4, 0.0]), "foundation": np.array([0.0, -7e-4])}
    )
    assert found.negligible(1e-4) == ()
    assert found.negligible(6.5e-4) == ("weight",)
    assert found.negligible(7.5e-4) == ("weight", "foundation")
    together = Influence({"weight": np.array([-6e-4]), "foundation": np.array([-7e-4])})
    assert together.negligible(1e-3) == ("weight",)
    np.testing.assert_allclose(found.together(("shear", "weight")), [0.98 * (1 - 6e-4) - 1.0, -0.3])


def test_a_tower_that_would_buckle_is_predicted_to_lose_all():
    slender = replace(tower(60.0, 6e7, EndBody(1e6)), foundation=Foundation())
    assert prediction(slender)[1].changes["weight"][0] == -1.0


@pytest.mark.parametrize("position", [5.0, 41.0, 55.0])
@pytest.mark.parametrize("jib_vertical_modes", [2, 3, 6])
def test_the_cost_of_missing_jib_modes_is_estimated(position, jib_vertical_modes):
    """Against the exact frame; so many tower modes that only the jib's truncation is left."""
    case = load_case("qtz5613/condition-3")
    model = tower_model(case.checked, tower_modes=12, jib_vertical_modes=jib_vertical_modes)
    exact = crane_structure(crane_frame(case.checked), position).angular_frequencies(4)
    actual = plane_modes(model, position, 18.0)[0][:4] / exact - 1.0
    estimate = truncation_error(model, crane_of(case.checked), position, 18.0)[:4]
    judged = actual > 1e-7
    ratio = estimate[judged] / actual[judged]
    assert judged.sum() >= 2
    assert ratio.min() > 0.85
    assert ratio.max() < 1.01


def test_a_mode_that_cannot_be_represented_is_not_trusted():
    case = load_case("qtz5613/condition-3")
    model = tower_model(case.checked, tower_modes=12, jib_vertical_modes=1)
    assert truncation_error(model, crane_of(case.checked), 41.0, 18.0)[3] > TRUSTED
