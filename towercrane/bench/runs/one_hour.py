"""What every method does to the energy of free vibration within an hour."""

from __future__ import annotations

from typing import Any

import numpy as np

from towercrane.bench.clock import signed
from towercrane.bench.scenes.free_vibration import CASE, FreeVibration
from towercrane.simulation.methods.method import ATOL_SHARE
from towercrane.simulation.methods.registry import METHODS

HOUR = 3600.0
"""[s]"""

ROW = 10.0
"""Time between two looks at the energy [s]."""

RTOLS = (1e-6, 1e-8)
"""The last is the default of a run."""

MODES = ((1, 1), (2, 3))

OMITTED = (
    "'-': not measured. Each evaluation of SciPy's methods goes through Python: one hour of 2+3 modes would take the "
    "explicit ones and LSODA one to two minutes each at 1e-8, Radau 5 minutes at 1e-6 and 14 at 1e-8; with 1+1 "
    "modes, whose highest frequency is a ninth, all are measured"
)
QUICK = "quick: without SciPy's methods ('-'), which take six minutes together"


def one_hour(quick: bool) -> dict[str, Any]:
    """Energy during one hour of free vibration.

    Returns
    -------
    dict
        A subject as in :func:`towercrane.bench.measure`; a record for each method, rtol and model that was measured,
        with ``change`` at the end, ``curve`` (``time_s``, ``change``), ``evaluations`` and ``cpu_seconds``.
    """
    records = []
    for modes in MODES:
        scene = FreeVibration(*modes)
        for method in METHODS:
            for rtol in RTOLS:
                if _measured(method, rtol, modes, quick):
                    records.append(_record(scene, f"{modes[0]}+{modes[1]}", method, rtol))
    models = [f"{tower}+{jib}" for tower, jib in MODES]
    found = {(r["method"], r["rtol"], r["modes"]): r for r in records}
    rows = []
    for method, rtol in ((method, rtol) for method in METHODS for rtol in RTOLS):
        cells = [found.get((method, rtol, model)) for model in models]
        shown = [["-", "-"] if r is None else [signed(r["change"]), f"{r['cpu_seconds']:.2g}"] for r in cells]
        rows.append([method, f"{rtol:.0e}", *(text for pair in shown for text in pair)])
    return {
        "name": "one-hour",
        "title": "Energy of undamped free vibration after one hour, relative change",
        "columns": ["method", "rtol", *(text for model in models for text in (f"{model} modes", "CPU [s]"))],
        "rows": rows,
        "records": records,
        "notes": [
            f"{CASE}, parked and ringing as in the hard case one-hour; atol is rtol / {1.0 / ATOL_SHARE:g}; "
            f"{RTOLS[-1]:g} is the default",
            QUICK if quick else OMITTED,
        ],
    }


def _measured(method: str, rtol: float, modes: tuple[int, int], quick: bool) -> bool:
    """Whether a run is made: SciPy's take minutes."""
    if METHODS[method].compiled:
        return True
    return not quick and (modes == MODES[0] or (method != "scipy-radau" and rtol == RTOLS[0]))


def _record(scene: FreeVibration, modes: str, method: str, rtol: float) -> dict[str, Any]:
    run = scene.run(method, rtol, HOUR, ROW)
    changes = scene.energy_changes(run.states)
    return {
        "method": method, "rtol": rtol, "modes": modes, "change": scene.energy_change(run),
        "curve": {"time_s": run.times.tolist(), "change": np.asarray(changes).tolist()},
        "evaluations": run.evaluations, "cpu_seconds": run.cpu_seconds,
    }  # fmt: skip
