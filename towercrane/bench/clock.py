"""The stop-watch of the benchmark: all contestants in turn, the first run apart, medians with their spread."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.simulation.outcomes import INTERRUPTED

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from numpy.typing import NDArray

    from towercrane.simulation.trajectory import Trajectory

    Floats = NDArray[np.float64]

LONG = 0.5
"""First run [s] beyond which one more has to do: the spread of long runs is small."""


@dataclass(frozen=True, slots=True)
class Timing:
    """Times of one contestant [s].

    Parameters
    ----------
    first : float
        CPU time of the first run, which compiles, loads and warms and is in none of the others.
    cpu, wall : float
        Medians of the runs after it.
    low, high : float
        Quartiles of the CPU time.
    runs : int
        Runs after the first.
    """

    first: float
    cpu: float
    wall: float
    low: float
    high: float
    runs: int

    @property
    def spread(self) -> str:
        """Median CPU time with half its interquartile range, in milliseconds."""
        return f"{1e3 * self.cpu:.4g}" + (f" ± {0.5e3 * (self.high - self.low):.1g}" if self.runs > 1 else "")


def interleaved(
    contestants: Mapping[str, Callable[[], Any]], repeats: int
) -> tuple[dict[str, Any], dict[str, Timing]]:
    """Result and times of each; all in turn, so that a change of the machine's clock meets all alike."""
    results: dict[str, Any] = {}
    first: dict[str, float] = {}
    for name, call in contestants.items():
        began = time.process_time()
        results[name] = call()
        first[name] = time.process_time() - began
    wall: dict[str, list[float]] = {name: [] for name in contestants}
    cpu: dict[str, list[float]] = {name: [] for name in contestants}
    for turn in range(repeats):
        for name, call in contestants.items():
            if turn and first[name] > LONG:
                continue
            began, began_cpu = time.perf_counter(), time.process_time()
            call()
            wall[name].append(time.perf_counter() - began)
            cpu[name].append(time.process_time() - began_cpu)
    timings = {}
    for name in contestants:
        low, middle, high = np.percentile(cpu[name], [25, 50, 75])
        timings[name] = Timing(
            first[name], float(middle), float(np.median(wall[name])), float(low), float(high), len(cpu[name])
        )
    return results, timings


def whole(run: Trajectory) -> Trajectory:
    """The run, unless somebody interrupted it."""
    if run.outcome == INTERRUPTED:
        raise KeyboardInterrupt
    return run


def differences(found: Floats, reference: Floats) -> list[float]:
    """Largest difference over largest value, per output."""
    return [float(e) for e in np.max(abs(found - reference), axis=0) / np.max(abs(reference), axis=0)]


def difference(found: Floats, reference: Floats) -> float:
    """Largest of the differences."""
    return max(differences(found, reference))


def short(error: float | None) -> str:
    """Error for a table."""
    return "-" if error is None else f"{error:.1e}"


def signed(change: float | None) -> str:
    """Relative change for a table; None was not measured, an infinite one is that of a run that failed."""
    if change is None:
        return "-"
    return "failed" if np.isinf(change) else f"{change:+.1e}"
