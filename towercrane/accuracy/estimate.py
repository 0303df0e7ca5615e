"""What errors are expected of a run, beside those that are allowed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from numpy.typing import NDArray

    from towercrane.accuracy.setting import Setting
    from towercrane.schema.targets import Tolerance

    Floats = NDArray[np.float64]

SMALLEST_PEAK = 1e-4
"""Peaks below this [m, rad or N] count as this."""


@dataclass(frozen=True, eq=False)
class Estimate:
    """Expected largest error of every output of a run, all arrays of shape (outputs,).

    Parameters
    ----------
    truncation : ndarray
        By what the model leaves out and the solver damps, in the output's unit.
    stepping : ndarray
        By the solver's steps, over the output's peak; infinite for methods that were not measured.
    """

    truncation: Floats
    stepping: Floats

    def errors(self, peaks: Floats) -> Floats:
        """Errors in the outputs' units, given their peaks."""
        return np.asarray(self.truncation + self.stepping * np.maximum(peaks, SMALLEST_PEAK))


@dataclass(frozen=True, eq=False)
class Choice:
    """A setting and what is expected of it.

    Parameters
    ----------
    setting : Setting
    estimate : Estimate
    peaks : ndarray, shape (outputs,)
        Expected.
    kept : bool
        Whether the estimate keeps the targets.
    doubts : tuple of str
        Why no error can be promised in this scene; empty where it can.
    tried : int
        Settings that were looked at.
    cpu_seconds : float
        What the choice took.
    left_out : tuple of str
        What the richest model has and this has not, and why, in sentences.
    """

    setting: Setting
    estimate: Estimate
    peaks: Floats
    kept: bool
    doubts: tuple[str, ...]
    tried: int
    cpu_seconds: float
    left_out: tuple[str, ...]


def check_targets(outputs: Iterable[str], targets: Iterable[str]) -> None:
    """Refuse targets of no output, or of another.

    Raises
    ------
    ValueError
    """
    names, wanted = list(outputs), list(targets)
    if not wanted or not set(wanted) <= set(names):
        raise ValueError(f"targets: wanted some of {', '.join(names)}, got {', '.join(wanted) or 'none'}")


def limits(outputs: Iterable[str], targets: Mapping[str, Tolerance], peaks: Floats) -> Floats:
    """Largest allowed errors in the outputs' units, infinite where none is set; shape (outputs,)."""
    found, names = np.full(len(peaks), np.inf), list(outputs)
    for name, (value, relative) in targets.items():
        index = names.index(name)
        found[index] = value * max(peaks[index], SMALLEST_PEAK) if relative else value
    return found
