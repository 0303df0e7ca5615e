"""Speed against error, measured on this machine: reference first, runs interleaved, medians quoted."""

from __future__ import annotations

import os
import platform
from typing import TYPE_CHECKING, Any

from towercrane.bench.lanes import many_runs
from towercrane.bench.radial import modes_left_out, radial_run, right_hand_side
from towercrane.bench.roots import roots
from towercrane.bench.slewing import example_runs, right_hand_sides
from towercrane.simulate import versions

if TYPE_CHECKING:
    from collections.abc import Callable

SUBJECTS = (roots, right_hand_side, radial_run, modes_left_out, right_hand_sides, example_runs, many_runs)
"""Each takes the number of repeats and gives a table."""


def measure(*, quick: bool = False, say: Callable[[str], None] = print) -> dict[str, Any]:
    """All subjects of the benchmark.

    Parameters
    ----------
    quick : bool
        Fewer repeats.
    say : callable
        Told what is being measured.

    Returns
    -------
    dict
        ``machine``, ``versions`` and ``subjects``, each with title, columns, rows (text), records and notes.
    """
    repeats = 3 if quick else 9
    subjects = []
    for subject in SUBJECTS:
        say(f"measuring: {subject.__doc__.splitlines()[0] if subject.__doc__ else subject.__name__}")
        subjects.append(subject(repeats))
    machine = {"processor": platform.processor() or platform.machine(), "cores": os.cpu_count()}
    return {"machine": machine, "versions": versions(), "subjects": subjects}
