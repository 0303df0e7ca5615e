"""Summary of a run: peaks, periods, spectrum, balance, and what deserves a second look."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.integrate import FINISHED
from towercrane.simulate import case_model
from towercrane.spectrum import spectrum_peaks, swing_period

if TYPE_CHECKING:
    import xarray as xr

    from towercrane.case import Case

TUNED = 0.05
"""Structure and twice the swing count as tuned when their frequencies differ by less than this fraction."""

GROWTH = 1.5
"""Growth of the swing after the drives have stopped that is named."""


def summarise(case: Case, result: xr.Dataset) -> dict[str, Any]:
    """Summary of a run of a case, ready for JSON.

    Returns
    -------
    dict
        ``outcome``, ``end_time_s``, ``peaks`` per variable (maximum, maximum_time_s, minimum, minimum_time_s,
        units), ``spectrum_peaks_hz`` of the tower top, ``swing_period_s`` after the drives have stopped (None without
        two passages), ``natural_frequencies_hz`` at the
        last trolley position, ``energy_balance``, ``notices``, ``assumed``, ``solver``, ``wall_seconds``.
    """
    attributes = result.attrs
    times = result["time"].values
    frequencies = case_model(case).natural_frequencies(
        float(result["trolley_position"][-1]), float(result["rope_length"][-1])
    ) / (2 * np.pi)
    free = _after_the_drives(case, times)
    return {
        "case": case.name,
        "title": case.title,
        "crane": attributes["crane"],
        "outcome": attributes["outcome"],
        "message": attributes["message"],
        "end_time_s": float(attributes["end_time"]),
        "peaks": peaks(result),
        "spectrum_peaks_hz": spectrum_peaks(times, result["tower_tip_displacement"].values),
        "swing_period_s": swing_period(times[free], result["swing_angle"].values[free]),
        "natural_frequencies_hz": frequencies.tolist(),
        "energy_balance": energy_balance(result),
        "notices": notices(case, result, frequencies, free),
        "assumed": [{"key": key, "value": value, "why": why} for key, value, why in assumed(result)],
        "solver": {
            key: attributes[key]
            for key in (
                "method", "rtol", "atol", "evaluations", "steps_accepted", "steps_rejected", "smallest_step",
                "solver_cpu_seconds", "solver_wall_seconds",
            )
        },
        "versions": json.loads(attributes["versions"]),
        "wall_seconds": attributes["wall_seconds"],
    }  # fmt: skip


def assumed(result: xr.Dataset) -> list[tuple[str, str, str]]:
    """Key, value and reason of every value that no source gives."""
    return [tuple(entry) for entry in json.loads(result.attrs.get("assumed", "[]"))]


def peaks(result: xr.Dataset) -> dict[str, dict[str, Any]]:
    """Extremes of every variable over time alone, with their times."""
    found = {}
    for name, variable in result.data_vars.items():
        if variable.dims != ("time",):
            continue
        values = variable.values
        high, low = int(np.argmax(values)), int(np.argmin(values))
        found[str(name)] = {
            "maximum": float(values[high]),
            "maximum_time_s": float(result["time"][high]),
            "minimum": float(values[low]),
            "minimum_time_s": float(result["time"][low]),
            "units": variable.attrs["units"],
        }
    return found


def energy_balance(result: xr.Dataset) -> dict[str, float]:
    """Gap between energy gained and work put in: the run's own check of its equations and steps."""
    energy, work = result["total_energy"].values, result["input_work"].values
    gap = abs(energy - energy[0] - work)
    scale = max(float(np.ptp(energy)), float(np.ptp(work)))
    return {
        "largest_gap_j": float(gap.max()),
        "relative_gap": float(gap.max() / scale) if scale > 0.0 else 0.0,
        "energy_change_j": float(energy[-1] - energy[0]),
        "input_work_j": float(work[-1]),
    }


def notices(case: Case, result: xr.Dataset, frequencies: Any, free: slice) -> list[str]:
    """What deserves a second look, in sentences."""
    found = []
    if result.attrs["outcome"] != FINISHED:
        reason = f": {result.attrs['message']}" if result.attrs["message"] else ""
        found.append(f"ended at {result.attrs['end_time']:.6g} s: {result.attrs['outcome']}{reason}")
    tension = result["rope_tension"].values
    if tension.min() < 0.0:
        first = float(result["time"][int(np.argmax(tension < 0.0))])
        found.append(
            f"the rope pushes from {first:.2f} s on (down to {tension.min():.0f} N): "
            "a real rope would be slack there; this case takes it as a rod"
        )
    return found + _parametric(result, frequencies, free)


def _parametric(result: xr.Dataset, frequencies: Any, free: slice) -> list[str]:
    """Structure at twice the swing frequency: a small ringing then pumps the swing."""
    swing = frequencies[0]
    tuned = [f for f in frequencies[1:] if abs(f / (2.0 * swing) - 1.0) < TUNED]
    if not tuned:
        return []
    ratio = f"structure at {tuned[0]:.3f} Hz, twice the swing's {swing:.3f} Hz within {TUNED:.0%}"
    angle = abs(result["swing_angle"].values[free])
    period = max(1, int(np.sum(result["time"].values[free] < result["time"].values[free][:1] + 1.0 / swing)))
    before, after = float(angle[:period].max(initial=0.0)), float(angle.max(initial=0.0))
    if before > 0.0 and after > GROWTH * before:
        return [
            f"parametric resonance ({ratio}): the swing grew from {before:.4f} to {after:.4f} rad "
            "after the drives had stopped"
        ]
    return [f"2:1 tuning ({ratio}): a ringing structure can pump the swing; in this run it did not"]


def _after_the_drives(case: Case, times: Any) -> slice:
    """Rows after the last drive has stopped."""
    stop = max(case.trolley_motion().duration, case.rope_motion().duration)
    return slice(int(np.searchsorted(times, stop)), None)
