"""The stop-watch of the benchmark: all contestants in turn, the first round not counted, medians quoted."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.integrate import INTERRUPTED

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from numpy.typing import NDArray

    from towercrane.integrate import Trajectory

    Floats = NDArray[np.float64]


def interleaved(
    contestants: Mapping[str, Callable[[], Any]], repeats: int
) -> tuple[dict[str, Any], dict[str, float], dict[str, float]]:
    """Result, median wall and median CPU seconds of each; all in turn, the first round not counted."""
    results = {name: call() for name, call in contestants.items()}
    wall: dict[str, list[float]] = {name: [] for name in contestants}
    cpu: dict[str, list[float]] = {name: [] for name in contestants}
    for _ in range(repeats):
        for name, call in contestants.items():
            began, began_cpu = time.perf_counter(), time.process_time()
            call()
            wall[name].append(time.perf_counter() - began)
            cpu[name].append(time.process_time() - began_cpu)

    def medians(times: dict[str, list[float]]) -> dict[str, float]:
        return {name: float(np.median(t)) for name, t in times.items()}

    return results, medians(wall), medians(cpu)


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
