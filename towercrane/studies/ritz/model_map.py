"""Frequency map of a crane on ties or with a jib that pivots, in the modes of a rich model."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from towercrane.simulation.outcomes import FINISHED, TOWER_BUCKLED
from towercrane.studies.frequency_map import MODES, SPARE, ascending, mapped
from towercrane.studies.ritz.plane_crane import counts_in_words

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import xarray as xr
    from numpy.typing import NDArray

    from towercrane.studies.ritz.plane_crane import RitzCrane

    Floats = NDArray[np.float64]


def model_map(
    crane: RitzCrane,
    richer: RitzCrane,
    positions: Sequence[float] | Floats,
    payloads: Sequence[float],
    *,
    modes: int = MODES,
    progress: Callable[[float], None] | None = None,
) -> xr.Dataset:
    """Natural frequencies over payload and trolley position, or the angle of a jib that pivots, as branches.

    Parameters
    ----------
    crane : RitzCrane
    richer : RitzCrane
        The same in more modes.
    positions, payloads, modes, progress
        As of :func:`towercrane.studies.frequency_map.frequency_map`; angles in radians.

    Returns
    -------
    xarray.Dataset
        As there, without what modes add to static outputs. A payload with which the crane cannot stand at one of the
        positions has its outcome and no numbers; the buckling factor is that of the tower alone.
        ``change_by_more_modes``: largest relative change of each branch's frequency by the richer model, at the ends.

    Raises
    ------
    ValueError
        If positions or payloads are none or not ascending.
    """
    places, masses = ascending("positions", positions), ascending("payloads", payloads)
    cranes = [crane.loaded(float(mass)) for mass in masses]
    factors = [one.model.buckling_factor() for one in cranes]
    outcomes = [
        one.outcome(places.tolist()) if factor > 1.0 else TOWER_BUCKLED
        for one, factor in zip(cranes, factors, strict=True)
    ]
    result = mapped(crane.loaded, factors, outcomes, places, masses, modes, crane.members, progress)
    pivots = crane.model.channels[0] == "luffing"
    if pivots:
        result["position"].attrs = {"units": "rad", "long_name": "angle of the jib, as its winch has it"}
    change = _change_by_more_modes(result, crane, richer)
    result["change_by_more_modes"] = (
        "mode", change, {"units": "1", "long_name": "largest relative change of the frequency by a richer model"},
    )  # fmt: skip
    result.attrs |= {
        "rope_length": crane.rope_length,
        "trolley_mass": crane.model.crane.trolley_mass,
        "gravity": crane.model.crane.gravity,
        "weight_softening": int(crane.model.weight_softening),
        "shapes": counts_in_words(crane),
        "shapes_of_the_richer": counts_in_words(richer),
    }
    return result


def _change_by_more_modes(result: xr.Dataset, crane: RitzCrane, richer: RitzCrane) -> Floats:
    """At the first and the last place with every load, of frequencies of equal rank; shape (modes,)."""
    frequency, found = result["frequency"].values, np.zeros(result.sizes["mode"])
    for i, mass in enumerate(result["payload"].values):
        if result["outcome"].values[i] != FINISHED:
            continue
        both = [one.loaded(float(mass)) for one in (crane, richer)]
        for j in {0, result.sizes["position"] - 1}:
            place, count = float(result["position"][j]), result.sizes["mode"] + SPARE
            own, theirs = (one.modes(place, count).frequencies for one in both)
            ranks = abs(frequency[i, j][:, None] - own).argmin(axis=1)
            found = np.maximum(found, abs(own / theirs - 1.0)[ranks])
    return found
