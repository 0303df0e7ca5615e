"""Linear model of a case about its equilibrium or steady rotation, and its report."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cases.assumptions import as_entries, left_out, rests_on
from towercrane.cases.models import model_of, motions_of
from towercrane.linear.chart import TURNING

if TYPE_CHECKING:
    from towercrane.cases.case import Case
    from towercrane.linear.statespace import StateSpace


def linear_model(case: Case, at: float) -> StateSpace:
    """Linear model of a case about its equilibrium, the drives at rest where they are ``at`` a time [s].

    Where the head turns then in still air, it is about the steady rotation at that rate. A wind that blows is at its
    mean, as in :func:`towercrane.simulation.system.start_inputs`.

    Raises
    ------
    NoEquilibrium
        If the crane has none.
    """
    from towercrane.linear.linearise import linearise

    model = model_of(case)
    model = getattr(model, "held", model)
    known = (*getattr(model, "state_names", ()), *model.channels)
    # Outward is along the jib, wherever that points.
    turning = next((angle for angle in TURNING if angle in known), None)
    return linearise(model, motions_of(case, model), time=at, turning=turning)


def linear_report(case: Case, at: float, linear: StateSpace) -> dict[str, Any]:
    """Linear model of a case, ready for JSON.

    Returns
    -------
    dict
        ``eigenvalues`` (real, imaginary, frequency_hz, damping_ratio, dominant_state; the ratio of a zero is None),
        ``states``, ``inputs`` and ``outputs`` (name, units, value at the operating point), ``slope`` of
        the states there and ``equilibrium`` (whether it is zero but for a steady rotation), ``about`` in words,
        ``rope_inclination_rad``, ``A``, ``B``, ``C``, ``D``, ``differentiation_error``, ``at_s``, ``left_out``,
        ``assumed``.
    """
    point = linear.point
    report: dict[str, Any] = {"case": case.name, "name": case.crane.name, "at_s": at}
    report["eigenvalues"] = [
        {
            "real": value.real,
            "imaginary": value.imag,
            "frequency_hz": frequency,
            "damping_ratio": ratio if np.isfinite(ratio) else None,
            "dominant_state": state,
        }
        for value, frequency, ratio, state in linear.eigenvalues()
    ]
    listed = {
        "states": (linear.states, point.states),
        "inputs": (linear.inputs, point.inputs),
        "outputs": (linear.outputs, point.outputs),
    }
    for name, (signals, values) in listed.items():
        pairs = zip(signals, values.tolist(), strict=True)
        report[name] = [{"name": signal.name, "units": signal.units, "value": value} for signal, value in pairs]
    report["slope"] = point.slope.tolist()
    report["equilibrium"], report["rope_inclination_rad"] = linear.at_equilibrium, point.inclination
    report["about"] = about(linear)
    for name in "ABCD":
        report[name] = getattr(linear, name.lower()).tolist()
    report["differentiation_error"] = linear.error
    report["left_out"] = left_out(case)
    report["assumed"] = as_entries(rests_on(case))
    return report


def about(linear: StateSpace) -> str:
    """What a linear model is about, in words."""
    if not linear.at_equilibrium:
        return "a state that is no equilibrium"
    if spin := linear.point.spin:
        return f"the steady rotation at {spin * 30.0 / np.pi:.4g} rpm"
    pairs = zip(linear.inputs, linear.point.inputs.tolist(), strict=True)
    blown = [value for signal, value in pairs if signal.name.startswith("wind")]
    return f"the equilibrium{' in the mean wind' if any(blown) else ''}"
