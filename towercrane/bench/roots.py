"""Benchmark of the characteristic roots against finite elements."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.bench.clock import interleaved, short
from towercrane.case import load_case

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

CASE = "qtz5613/condition-3"


def roots(repeats: int) -> dict[str, Any]:
    """Characteristic roots of the QTZ5613's tower, and finite elements for the same frequencies."""
    from modal import characteristic_roots, finite_element_frequencies

    case = load_case(CASE)
    tower, body = case.tower_beam(), case.radial_crane().end_body
    ratios = body.mass / tower.mass, body.rotary_inertia / (tower.mass * tower.length**2)
    unit = tower.length**2 * np.sqrt(tower.mass_per_length / tower.bending_stiffness)

    def elements(n: int) -> Callable[[], Floats]:
        return lambda: np.sqrt(unit * finite_element_frequencies(tower, 4, body, elements=n))

    contestants: dict[str, Callable[[], Floats]] = {
        "closed form, 4 roots": lambda: characteristic_roots(*ratios, 4),
        "closed form, 500 roots": lambda: characteristic_roots(*ratios, 500),
        "8 elements, 4 roots": elements(8),
        "16 elements, 4 roots": elements(16),
        "32 elements, 4 roots": elements(32),
        "64 elements, 4 roots": elements(64),
    }
    values, timings = interleaved(contestants, repeats)
    reference, note = _exact_roots(ratios, 500)
    records: list[dict[str, Any]] = []
    for name, found in values.items():
        error = None
        if reference is not None:
            error = float(np.max(abs(found / reference[: len(found)] - 1.0)))
        records.append({"method": name, "error": error, "milliseconds": 1e3 * timings[name].wall})
    return {
        "name": "roots",
        "title": "Roots of the tower: relative error of the worst root against wall time",
        "columns": ["method", "error", "median [ms]"],
        "rows": [[r["method"], short(r["error"]), f"{r['milliseconds']:.3f}"] for r in records],
        "records": records,
        "notes": [
            note,
            "the closed form is compiled; its first call of a process, which loads code, is not counted",
        ],
    }


def _exact_roots(ratios: tuple[float, float], count: int) -> tuple[Floats | None, str]:
    """Roots in 50-digit arithmetic, started from the closed form's; None without mpmath."""
    try:
        import mpmath as mp
    except ImportError:
        return None, "errors not measured: they need mpmath (pip install mpmath)"
    from modal import characteristic_roots

    with mp.workdps(50):
        a, j = (mp.mpf(r) for r in ratios)

        def scaled(x: Any) -> Any:
            # Gao et al. (2023), Eq. 26 with the boundary conditions' signs as printed, divided by cosh x.
            c, s, th, sech = mp.cos(x), mp.sin(x), mp.tanh(x), mp.sech(x)
            return (
                (sech + c - a * x * (s - c * th) - j * x**3 * (s + c * th) + a * j * x**4 * (sech - c))
                / (1 + a * x)
                / (1 + j * x**3)
            )

        exact = [float(mp.findroot(scaled, mp.mpf(x))) for x in characteristic_roots(*ratios, count)]
    return np.array(exact), "reference: the same roots in 50-digit arithmetic"
