"""How the cost grows: with the simulated time, and with the number of modes."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.bench.clock import interleaved, whole
from towercrane.bench.scenes.prepared import unwatched
from towercrane.cases.case import load_case
from towercrane.cranes.tower.equations.small_motions import plane_modes
from towercrane.cranes.tower.file.build import tower_model
from towercrane.cranes.tower.file.case_tables import TowerCase
from towercrane.motions.motion import phases, rest
from towercrane.simulation.integrate import evaluate, integrate
from towercrane.simulation.starts.begin import begin
from towercrane.simulation.starts.start import Start

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from towercrane.cranes.tower.model import FlexibleModel

SPANS = (15.0, 30.0, 60.0, 120.0, 240.0, 480.0)
"""Simulated times [s]."""

MODES = ((1, 1), (2, 2), (2, 3), (3, 4), (4, 4), (4, 6), (6, 8))
"""Numbers of tower and jib modes."""

RTOL = 1e-6

EVALUATIONS = 10_000
"""Right-hand sides in one measurement."""


def growth(repeats: int) -> dict[str, Any]:
    """CPU time against simulated time, and against the number of modes, with fitted exponents."""
    spans = _against_time(repeats)
    modes = _against_modes(repeats)
    time_exponent = exponent([r["seconds"] for r in spans], [r["cpu_seconds"] for r in spans])
    evaluation_exponent = exponent([r["frequency_hz"] for r in modes], [r["evaluations"] for r in modes])
    size_exponent = exponent([r["states"] for r in modes], [r["nanoseconds"] for r in modes])
    rows = [
        [f"{r['seconds']:g} s, 2+3 modes", "", f"{1e3 * r['cpu_seconds']:.2f}", str(r["evaluations"]), ""]
        for r in spans
    ]
    rows += [
        [
            f"30 s, {r['modes']} modes", f"{r['frequency_hz']:.1f}", f"{1e3 * r['cpu_seconds']:.2f}",
            str(r["evaluations"]), f"{r['nanoseconds']:.0f}",
        ]
        for r in modes
    ]  # fmt: skip
    return {
        "name": "growth",
        "title": "Growth of the cost: free vibration at rtol 1e-6",
        "columns": ["run", "highest f [Hz]", "CPU [ms]", "evaluations", "ns per evaluation"],
        "rows": rows,
        "records": [*spans, *modes],
        "spans": spans,
        "modes": modes,
        "exponents": {"time": time_exponent, "frequency": evaluation_exponent, "size": size_exponent},
        "notes": [
            f"fitted: CPU time ~ (simulated time)^{time_exponent:.2f}",
            f"fitted: evaluations ~ (highest frequency)^{evaluation_exponent:.2f}, "
            f"time per evaluation ~ (states)^{size_exponent:.2f}",
        ],
    }


def exponent(x: Sequence[float], y: Sequence[float]) -> float:
    """Slope of the straight line through the logarithms."""
    return float(np.polyfit(np.log(x), np.log(y), 1)[0])


def _model(modes: tuple[int, int]) -> FlexibleModel:
    """The crane in so many tower and jib modes."""
    tables = load_case("qtz5613/condition-3").tables(TowerCase)
    return tower_model(tables, tower_modes=modes[0], jib_vertical_modes=modes[1])


def _run(modes: tuple[int, int], span: float) -> Callable[[], Any]:
    model = _model(modes)
    cut = phases((rest(23.0), rest(18.0)), span)
    start, grid = begin(model, cut.inputs[0], Start("zero", along=0.1)), np.linspace(0.0, span, round(20 * span) + 1)
    return lambda: whole(integrate(unwatched(model.system), cut, start, grid, rtol=RTOL, atol=1e-2 * RTOL))


def _against_time(repeats: int) -> list[dict[str, Any]]:
    contestants = {f"{span:g}": _run((2, 3), span) for span in SPANS}
    found, timings = interleaved(contestants, repeats)
    return [
        {"seconds": span, "cpu_seconds": timings[f"{span:g}"].cpu, "evaluations": found[f"{span:g}"].evaluations}
        for span in SPANS
    ]


def _against_modes(repeats: int) -> list[dict[str, Any]]:
    names = {f"{tower}+{jib}": (tower, jib) for tower, jib in MODES}
    found, timings = interleaved({name: _run(modes, 30.0) for name, modes in names.items()}, repeats)
    models = {
        name: tower_model(
            load_case("qtz5613/condition-3").tables(TowerCase), tower_modes=modes[0], jib_vertical_modes=modes[1]
        )
        for name, modes in names.items()
    }
    _, single = interleaved({name: _right_hand_side(model) for name, model in models.items()}, 2 * repeats)
    return [
        {
            "modes": name,
            "states": model.size,
            "frequency_hz": float(plane_modes(model, 23.0, 18.0)[0][-1] / (2.0 * np.pi)),
            "cpu_seconds": timings[name].cpu,
            "evaluations": found[name].evaluations,
            "nanoseconds": 1e9 * single[name].cpu / EVALUATIONS,
        }
        for name, model in models.items()
    ]


def _right_hand_side(model: FlexibleModel) -> Callable[[], Any]:
    """Many right-hand sides in one compiled loop."""
    cut = phases((rest(23.0), rest(18.0)), 30.0)
    states = np.repeat(model.start(cut.inputs[0])[None], EVALUATIONS, axis=0)
    return partial(evaluate, model.system, cut, np.full(EVALUATIONS, 10.0), states)
