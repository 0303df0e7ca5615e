"""A motion as the table that a drive is fed with."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from towercrane.results.recording import Quantity, Recording

if TYPE_CHECKING:
    from collections.abc import Mapping

    from towercrane.motions.motion import Motion


def drive_table(motion: Motion, step: float, unit: str, about: Mapping[str, str | float]) -> Recording:
    """Position, speed and acceleration at even times, from rest until the first row at which it rests again.

    Parameters
    ----------
    motion : Motion
    step : float
        Time between two rows [s]; at a switch time the acceleration is the one that begins.
    unit : str
        SI unit of the motion, "m" or "rad".
    about : dict
        What the table is of, for its attributes.

    Raises
    ------
    ValueError
        If the step is not positive.
    """
    if not 0.0 < step < np.inf:
        raise ValueError(f"drive_table: step wants a positive time, got {step!r}")
    rows = int(np.ceil(motion.duration / step * (1.0 - 1e-12))) + 1
    times = step * np.arange(rows, dtype=float)
    names = (("position", unit, 0), ("speed", f"{unit}/s", 1), ("acceleration", f"{unit}/s^2", 2))
    columns = {name: Quantity(("time",), motion(times, order), units, name) for name, units, order in names}
    return Recording(times, columns, {**about, "step": f"{step:g} s"})
