"""Tableaus of the compiled pairs: declared order and dense output, consistency, SciPy's coefficients."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from oracles.exact_systems import Exact, growth_and_decay, oscillator

from towercrane.motions.motion import phases
from towercrane.simulation.methods.registry import METHODS
from towercrane.simulation.methods.runge_kutta import RungeKutta

PAIRS = {name: method for name, method in METHODS.items() if method.compiled}


def fixed_steps(tableau: RungeKutta, exact: Exact, steps: int, x: float = 1.0) -> float:
    """Error with equal steps, written out in NumPy from the tableau alone; x < 1 looks at the dense output."""
    inputs = phases((exact.motion,), exact.duration).inputs[0]
    h, y, worst = exact.duration / steps, exact.solution(np.zeros(1))[0], 0.0
    for step in range(steps):
        k = np.zeros((len(tableau.a), len(y)))
        for i in range(len(tableau.a)):
            k[i] = exact.system.slope((step + tableau.c[i]) * h, y + h * tableau.a[i] @ k, inputs)[0]
        inner = y + h * (tableau.dense @ x ** np.arange(1, tableau.dense.shape[1] + 1)) @ k
        y = y + h * tableau.a[tableau.stages] @ k
        seen, at = (y, step + 1) if x == 1.0 else (inner, step + x)
        worst = max(worst, np.max(abs(seen - exact.solution(np.array([at * h]))[0])))
    return worst


@pytest.mark.parametrize(("name", "coarse", "bound"), [("dop853", 8, 1.2e-8), ("dopri5", 48, 1.5e-9)])
def test_declared_order_is_reached_and_not_exceeded(name, coarse, bound):
    tableau, exact = PAIRS[name], growth_and_decay(duration=4.0)
    errors = [fixed_steps(tableau, exact, coarse * 2**level) for level in range(3)]
    slopes = np.log2(np.array(errors[:-1]) / errors[1:])
    assert errors[0] < bound
    assert np.all((slopes > tableau.order - 0.25) & (slopes < tableau.order + 0.25)), slopes


@pytest.mark.parametrize("name", PAIRS)
def test_dense_output_has_its_declared_order(name):
    # The error inside a step is of order dense_order + 1 locally; over a run it meets the step ends' own error.
    tableau, exact = PAIRS[name], oscillator(omega=1.0, duration=4.0)
    errors = []
    for steps in (8, 16, 32):
        inputs = phases((exact.motion,), exact.duration).inputs[0]
        h, y = exact.duration / steps, exact.solution(np.zeros(1))[0]
        k = np.zeros((len(tableau.a), 2))
        for i in range(len(tableau.a)):
            k[i] = exact.system.slope(tableau.c[i] * h, y + h * tableau.a[i] @ k, inputs)[0]
        x = 0.37
        inner = y + h * (tableau.dense @ x ** np.arange(1, tableau.dense.shape[1] + 1)) @ k
        errors.append(np.max(abs(inner - exact.solution(np.array([x * h]))[0])))
    slopes = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.all((slopes > tableau.dense_order + 0.7) & (slopes < tableau.dense_order + 1.5)), slopes


@pytest.mark.parametrize("tableau", PAIRS.values(), ids=PAIRS)
def test_tableau_is_consistent(tableau):
    assert_allclose(tableau.a.sum(axis=1), tableau.c, atol=3e-15)
    assert_allclose(tableau.error.sum(axis=1), 0.0, atol=3e-15)
    # At the end of the step the dense output is the step.
    assert_allclose(tableau.dense.sum(axis=1), tableau.a[tableau.stages], atol=1e-13)


def test_coefficients_are_those_of_scipy():
    from scipy.integrate import DOP853, RK45

    dop853, dopri5 = PAIRS["dop853"], PAIRS["dopri5"]
    assert_allclose(dop853.a[:12, :12], DOP853.A, rtol=1e-16)
    assert_allclose(dop853.error, [DOP853.E5, DOP853.E3], rtol=1e-16)
    assert_allclose(dopri5.dense, RK45.P, rtol=1e-15)
    assert_allclose(dopri5.error[0], RK45.E, rtol=1e-15, atol=1e-18)
