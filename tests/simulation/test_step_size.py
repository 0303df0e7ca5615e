"""Step control: how steps shrink and grow, and that hardly any is tried in vain."""

import numpy as np
import pytest
from samples.qtz5613 import model, motions

from towercrane.simulation.methods.step_size import FREELY, GROW, SAFETY, SHRINK, SLOWLY, step_factor
from towercrane.simulation.simulate import simulate


@pytest.mark.parametrize("growth", [FREELY, SLOWLY])
@pytest.mark.parametrize("error_order", [4, 7])
def test_steps_shrink_as_far_as_the_estimate_says_and_grow_by_a_power_of_that(error_order, growth):
    for length in (1e-3, 0.3, 0.9):
        # Where an error of the estimate's order would have been met with the margin.
        norm = (SAFETY / length) ** (error_order + 1)
        assert step_factor(norm, error_order, growth) == pytest.approx(max(SHRINK, length), rel=1e-12)
    for length in (1.1, 3.0, 9.0):
        norm = (SAFETY / length) ** (error_order + 1)
        assert step_factor(norm, error_order, growth) == pytest.approx(length**growth, rel=1e-12)


@pytest.mark.parametrize("growth", [FREELY, SLOWLY])
def test_steps_shrink_and_grow_by_no_more_than_their_bounds(growth):
    assert step_factor(1e300, 7, growth) == SHRINK
    assert step_factor(np.nan, 7, growth) == step_factor(np.inf, 7, growth) == SHRINK
    assert step_factor(1e-300, 4, growth) == GROW


@pytest.mark.parametrize(("method", "modes"), [("dop853", (2, 3)), ("dop853", (4, 4)), ("dopri5", (2, 3))])
@pytest.mark.parametrize("rtol", [1e-8, 1e-9])
def test_few_steps_are_rejected_while_the_crane_rings(method, modes, rtol):
    attrs = simulate(model(*modes), motions(), 30.0, method=method, rtol=rtol, atol=1e-2 * rtol).attrs
    assert attrs["outcome"] == "finished"
    assert attrs["steps_accepted"] > 500
    assert attrs["steps_rejected"] < 0.15 * attrs["steps_accepted"]
