"""The balance of energy of a run: what is off it, and how much of that the tolerances of its steps explain."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.simulation.methods.method import effective_tolerance

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

NOT_CONSERVED = "energy not conserved"
"""Outcome of a run whose balance is off by more than its tolerances explain."""

SHARE = 0.5
"""Part of what its steps may do to the energy that a run is given.

All shipped cases with all methods stay below a hundredth at tolerances from 1e-10 to 1e-2, LSODA in a wide swing
below a twentieth, dopri5 with a stiff drive below a third. A vibration that a method feeds until it slackens the rope
comes to 0.8.
"""

FEW = 10
"""Steps that are added, for rows between the steps of short runs: dense output has errors of its own."""

UNSTEERED = 1e-3
"""Part of the energy that work may be off by in a run of `FEW` steps.

Steps are long where nothing but the work moves, as for a load that hangs while its rope is let out: rows between
their ends are as good as steps are many, by the fifth power at least.
"""

ROUNDING = 1e-10
"""Rounding of an energy, relative to the largest; a trolley that runs off its jib is seen a nanometre late."""


def explained(steps: Any, rtol: float, atol: float, energy: Any) -> Any:
    """Gap in the balance that the tolerances explain [J].

    Each step may change each state by its tolerance: the direction of the rope, of length one, by as much as moves an
    energy m g l by the tolerance, and others by as much of the energy that the drives have put into them. The steps
    add up at worst.

    Parameters
    ----------
    steps : int or ndarray
        Accepted steps.
    rtol, atol : float
        Tolerances per step.
    energy : float or ndarray
        Load's weight times the length of its rope, and the work put in [J].
    """
    unsteered = UNSTEERED * (FEW / np.maximum(steps, 1)) ** 5
    return (SHARE * (steps + FEW) * effective_tolerance(rtol, atol) + unsteered) * energy


def first_off(values: Mapping[str, Floats], weight: float, steps: int, rtol: float, atol: float) -> tuple[int, str]:
    """First row at which a run's balance is off, and by how much in words; -1 if it never is.

    Parameters
    ----------
    values : mapping of str to ndarray, shape (p,)
        With ``total_energy``, ``input_work`` [J] and ``rope_length`` [m].
    weight : float
        Weight of the load [N].
    steps, rtol, atol
        As in :func:`explained`.
    """
    energy, work = values["total_energy"], values["input_work"] - values["input_work"][0]
    with np.errstate(invalid="ignore"):
        gap = abs(energy - energy[0] - work)
    # What is wrong in the balance would itself widen a range over all rows; up to a row it is not yet.
    scale = weight * np.max(values["rope_length"]) + np.maximum.accumulate(abs(work))
    limit = explained(steps, rtol, atol, scale) + ROUNDING * np.maximum.accumulate(abs(energy))
    off = np.flatnonzero(gap > limit)
    if len(off) == 0:
        return -1, ""
    row = int(off[0])
    return row, (
        f"energy and work differ by {gap[row]:.2g} J, of which {limit[row]:.2g} J come from {steps} steps at rtol "
        f'{rtol:g} and atol {atol:g}; set solver.method = "dop853", solver.rtol and solver.atol a hundredth: what '
        "then stays is a fault of the equations"
    )
