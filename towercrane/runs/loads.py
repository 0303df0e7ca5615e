"""Loads for design: extremes of forces and moments, what acts beside them, and how many times the static value."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.motions.motion import Phases
from towercrane.motions.motion import rest as motion_at_rest
from towercrane.simulation.integrate import evaluate
from towercrane.simulation.system import NoEquilibrium, start_inputs

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from towercrane.motions.motion import Motion
    from towercrane.runs.extremes import Extreme, Extremes
    from towercrane.simulation.run import Run

BESIDE = (
    "base_force_x", "base_force_y", "base_force_z", "base_shear",
    "base_moment_x", "base_moment_y", "overturning_moment", "base_torque",
    "jib_root_moment", "jib_root_moment_sideways", "hoist_rope_force",
)  # fmt: skip
"""Outputs that are told at the time of another's extreme."""

DRIVES = ("trolley_force", "slewing_torque", "drive_torque", "drive_torque_elastic", "bridge_force")
"""Forces of drives, which carry nothing at rest."""

GROUND = ("ground_", "floor_")
"""Beginnings of the channels of an earthquake: at rest there is none."""

RESTS = 1e-2
"""Static value, beside the extreme, below which there is no dynamic factor."""

DIGITS = 6
"""Of places of drives that count as the same."""


def loads_of(run: Run, found: Extremes) -> dict[str, dict[str, Any]]:
    """Design loads of a run, ready for JSON.

    Parameters
    ----------
    run : Run
    found : Extremes
        Of its outputs.

    Returns
    -------
    dict
        For each force and moment but those of drives ``maximum`` and ``minimum``, each with ``value``, ``time_s`` and
        the other components ``beside`` it; ``largest``, which of them is larger in size; ``static``, the value of the
        crane at rest under its load with the drives where they are at that time; ``dynamic_factor``, largest over
        static (None where there is nothing at rest, or something the other way); ``units``. Both extremes of the
        overturning moment have the ``direction_rad`` in which it tips, from the x axis.
    """
    names = [
        name
        for name, own in run.data_vars.items()
        if own.dims == ("time",) and own.units in ("N", "N m") and name not in DRIVES
    ]
    at_rest: dict[tuple[float, ...], dict[str, float]] = {}
    loads: dict[str, dict[str, Any]] = {}
    for name in names:
        beside = [other for other in BESIDE if other in names and other != name]
        told = {
            "maximum": _told(found, found.highest[name], beside),
            "minimum": _told(found, found.lowest[name], beside),
        }
        if name == "overturning_moment":
            for own in told.values():
                own["direction_rad"] = tipped(*(own["beside"].get(f"base_moment_{axis}", 0.0) for axis in "xy"))
        largest = max(told, key=lambda which, told=told: abs(told[which]["value"]))  # type: ignore[misc]
        peak, time = told[largest]["value"], told[largest]["time_s"]
        places = tuple(
            0.0 if channel.startswith(GROUND) else round(float(run.motions[channel](time)), DIGITS)
            for channel in run.model.channels
        )
        if places not in at_rest:
            at_rest[places] = static(run.model, run.motions, places)
        resting = at_rest[places].get(name)
        factor = peak / resting if resting is not None and abs(resting) > RESTS * abs(peak) else 0.0
        loads[name] = {
            **told,
            "largest": largest,
            "static": resting,
            "dynamic_factor": factor if factor > 0.0 else None,
            "units": run[name].units,
        }
    return loads


def tipped(moment_x: float, moment_y: float) -> float:
    """Direction in which a moment tips a crane, from the x axis [rad]: what turns about +y tips towards +x."""
    return float(np.arctan2(-moment_x, moment_y))


def static(model: Any, motions: Mapping[str, Motion], values: Sequence[float]) -> dict[str, float]:
    """Outputs of the crane at rest under its load, its drives at these values and a wind at its mean; none if it
    falls."""
    # Under its load it hangs, whatever that stands on now and then.
    model = getattr(model, "lifted", model)
    # As wide as those of the run: for others the equations would be written anew.
    width = max(3, *(motions[channel].coefficients.shape[1] for channel in model.channels))
    inputs = np.zeros((len(values), width))
    inputs[:, 0] = values
    inputs = start_inputs(model, motions, inputs)
    try:
        state = model.start(inputs)
    except NoEquilibrium:
        return {}
    cut = Phases(np.array([0.0, 1.0]), inputs[None], inputs)
    places = zip(model.channels, inputs[:, 0], strict=True)
    rest = {channel: motion_at_rest(float(value)) for channel, value in places}
    alone = np.zeros(1), state[None]
    quantities = model.observe(rest, *alone, *evaluate(model.system, cut, *alone))
    return {name: float(own.values[0]) for name, own in quantities.items() if own.dims == ("time",)}


def _told(found: Extremes, extreme: Extreme, beside: list[str]) -> dict[str, Any]:
    return {"value": extreme.value, "time_s": extreme.time, "beside": found.at(extreme.time, beside)}
