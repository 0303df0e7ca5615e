"""Benchmark of the characteristic roots against dynamic stiffness and finite elements."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.bench.clock import interleaved, short
from towercrane.cases.case import load_case
from towercrane.cranes.tower.file.build import crane_of
from towercrane.cranes.tower.file.case_tables import TowerCase

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

CASE = "qtz5613/condition-3"


def roots(repeats: int) -> dict[str, Any]:
    """Characteristic roots of the QTZ5613's tower, dynamic stiffness and finite elements for the same frequencies."""
    from modal import Beam, Chain, Segment, chain_frequencies, characteristic_roots, finite_element_frequencies

    case = load_case(CASE)
    crane = crane_of(case.tables(TowerCase))
    tower, body = crane.tower, crane.end_body
    assert isinstance(tower, Beam), "uniform and clamped"
    ratios = body.mass / tower.mass, body.rotary_inertia / (tower.mass * tower.length**2)
    unit = tower.length**2 * np.sqrt(tower.mass_per_length / tower.bending_stiffness)

    chain = Chain((Segment(tower.length, tower.mass_per_length, tower.bending_stiffness),), {1: body})

    def stiffness(count: int) -> Callable[[], Floats]:
        return lambda: np.sqrt(unit * chain_frequencies(chain, count))

    def elements(n: int) -> Callable[[], Floats]:
        return lambda: np.sqrt(unit * finite_element_frequencies(tower, 4, body, elements=n))

    contestants: dict[str, Callable[[], Floats]] = {
        "closed form, 4 roots": lambda: characteristic_roots(*ratios, 4),
        "closed form, 500 roots": lambda: characteristic_roots(*ratios, 500),
        "dynamic stiffness, 4 roots": stiffness(4),
        "dynamic stiffness, 50 roots": stiffness(50),
    }
    contestants |= {f"{n} elements, 4 roots": elements(n) for n in (4, 8, 16, 32, 64)}
    values, timings = interleaved(contestants, repeats)
    reference, note = _exact_roots(ratios, 500)
    records: list[dict[str, Any]] = []
    for name, found in values.items():
        error = None
        if reference is not None:
            error = float(np.max(abs(found / reference[: len(found)] - 1.0)))
        records.append(
            {"method": name, "family": family(name), "error": error, "milliseconds": 1e3 * timings[name].wall}
        )
    return {
        "name": "roots",
        "title": "Roots of the tower: relative error of the worst root against wall time",
        "columns": ["method", "error", "median [ms]"],
        "rows": [[r["method"], short(r["error"]), f"{r['milliseconds']:.3f}"] for r in records],
        "records": records,
        "notes": [
            note,
            "closed form and dynamic stiffness are compiled; the first call, which loads code, is not counted",
        ],
    }


def family(method: str) -> str:
    """What a contestant's method is, for a picture: its name up to the comma, or finite elements."""
    return "finite elements" if " element" in method else method.partition(",")[0]


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
