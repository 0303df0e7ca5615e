"""What is known of the end of a run beside its state, so that another run can go on from there."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.motions.motion import phases

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from numpy.typing import NDArray

    from towercrane.motions.motion import Motion
    from towercrane.simulation.system import Model

    Floats = NDArray[np.float64]

SAME = 1e-6
"""Relative difference below which numbers of two runs are equal: files may state a millionth less."""


def end_of(model: Model, motions: Mapping[str, Motion], time: float) -> dict[str, Any]:
    """End of a run, ready for JSON.

    Returns
    -------
    dict
        ``axes`` of the load's space, ``coordinates`` by name, ``basis`` (numbers that tell modes from those of
        another crane or of other signs), ``rope`` (stiffness, further length and relaxation time), ``drives``: value
        and rate of each [m or rad, and per s], by channel;
        ``between``: what crossings have told its last phase, as on which side of a joint the trolley is.
    """
    by_value = getattr(model, "value_channels", ())
    # A head that is free is where its state says, wherever its motion lets it begin.
    led = getattr(getattr(model, "drive", None), "free", False)
    drives = [name for name in model.channels if name not in by_value and not (led and name == "slewing")]
    return _described(model) | {
        "drives": {name: [float(motions[name](time, order)) for order in range(2)] for name in drives},
        "between": _between(model, motions, time, -1),
    }


def other_states(end: Mapping[str, Any], model: Model) -> str:
    """In what the states of a model are others than those of a run that ended so; nothing where they are the same."""
    own = _described(model)
    if own["coordinates"] != end["coordinates"]:
        there, here = (", ".join(names) or "none" for names in (end["coordinates"], own["coordinates"]))
        return f"the coordinates {there}, where this run has {here}"
    if len(own["rope"]) != len(end["rope"]) or not np.allclose(own["rope"], end["rope"], rtol=SAME, atol=0.0):
        return f"another rope: stiffness, further length, relaxation time {end['rope']}, here {own['rope']}"
    if own["slings"] != (hung := end.get("slings", [])):
        lengths = (" and ".join(f"{length:g} m" for length in found) for found in (hung, own["slings"]))
        there, here = (said or "no length" for said in lengths)
        return f"slings of {there}, where this run has such of {here}"
    before, now = (np.array(found["basis"], dtype=float) for found in (end, own))
    if before.shape != now.shape or np.any(abs(before - now) > SAME * abs(now).max(initial=1.0)):
        return "modes of other shapes or signs"
    return ""


def other_side(end: Mapping[str, Any], model: Model, motions: Mapping[str, Motion]) -> bool:
    """Whether a run would begin on another side of a joint than that on which one ended."""
    all_of_them = max(motions[channel].duration for channel in model.channels) + 1.0
    return bool(end["between"] != _between(model, motions, all_of_them, 0))


def leaps(end: Mapping[str, Any], model: Model, motions: Mapping[str, Motion]) -> Iterator[tuple[str, str, str]]:
    """Drives that begin elsewhere, or at another speed, than a run ended: name, where that was, where this is."""
    for channel, (value, rate) in end["drives"].items():
        if channel not in model.channels:
            continue
        unit = dict(zip(model.channels, getattr(model, "channel_units", ()), strict=False)).get(channel, "")
        begins = [float(motions[channel](0.0, order)) for order in range(2)]
        for was, now, per in zip((value, rate), begins, (unit, f"{unit}/s"), strict=True):
            if abs(was - now) > SAME * max(1.0, abs(was)):
                yield channel, f"{was:.9g} {per}", f"{now:.9g} {per}"


def lifted(state: Floats, end: Mapping[str, Any], model: Model, heading: float) -> Floats:
    """State in space of one in the vertical plane at a heading [rad]: nothing moves across the plane."""
    asked: Any = model
    names, found, turning = list(asked.state_names), np.zeros(model.system.size), asked.turning
    before, half = len(state) // 2, len(found) // 2
    for first, own in ((0, 0), (before, half)):
        for k, name in enumerate(end["coordinates"]):
            found[own + names.index(name)] = state[first + k]
        ropes = state[first + len(end["coordinates"]) : first + before].reshape(-1, 2)
        found[own + len(names) : own + half] = np.insert(ropes, 1, 0.0, axis=1).ravel()
    found[-1] = state[-1]
    return np.asarray(turning.turned(found, heading))


def _between(model: Model, motions: Mapping[str, Motion], duration: float, phase: int) -> list[Any]:
    """What crossings add to the inputs of a phase of motions that go on for so long [s]."""
    crossings = model.system.crossings
    if crossings is None or not duration > 0.0:
        return []
    cut = crossings.cut(phases(tuple(motions[channel] for channel in model.channels), duration))
    return list(cut.inputs[phase, len(model.channels) :].tolist())


def _described(model: Model) -> dict[str, Any]:
    rope = getattr(getattr(model, "carried", None), "elasticity", None)
    return {
        "rope": [] if rope is None else [rope.stiffness, rope.extra_length, rope.relaxation_time],
        "axes": int(getattr(model, "axes", 3)),
        "coordinates": list(getattr(model, "state_names", ())),
        "basis": np.asarray(getattr(model, "basis", ())).tolist(),
        "slings": [own.length for own in getattr(getattr(model, "load", None), "slings", ())],
    }
