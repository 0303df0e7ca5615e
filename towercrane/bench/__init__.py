"""Speed against error, measured on this machine: reference first, runs interleaved, medians quoted.

Never imports reports or commands.
"""

from __future__ import annotations

import os
import platform
from typing import TYPE_CHECKING, Any

from towercrane.bench.rivals.workprecision import work_precision
from towercrane.bench.runs.accuracy import error_controlled
from towercrane.bench.runs.events import event_runs
from towercrane.bench.runs.growth import growth
from towercrane.bench.runs.heads import heads
from towercrane.bench.runs.radial import modes_left_out, right_hand_side
from towercrane.bench.runs.slewing import right_hand_sides
from towercrane.bench.runs.space import space_right_hand_sides
from towercrane.bench.runs.space_accuracy import error_controlled_in_space
from towercrane.bench.scenes.prepared import jib_scene, lumped_scene, radial_scene, space_scene
from towercrane.bench.structures.lattice import lattice
from towercrane.bench.structures.roots import roots
from towercrane.bench.structures.segments import segments
from towercrane.bench.structures.structure import crane_map, stepped_tower
from towercrane.results.versions import versions

if TYPE_CHECKING:
    from collections.abc import Callable

    Subject = Callable[[int, bool], dict[str, Any]]

SUBJECTS: dict[str, tuple[str, Subject]] = {
    "roots": (
        "roots of the tower in closed form, by dynamic stiffness, by finite elements",
        lambda repeats, quick: roots(repeats),
    ),
    "tower": ("tower of three segments against finite elements", lambda repeats, quick: stepped_tower(repeats)),
    "segments": ("towers of 5 to 80 different segments", lambda repeats, quick: segments(repeats)),
    "lattice": ("lattice tower as a truss and as beams", lambda repeats, quick: lattice(repeats)),
    "map": ("frequency map against finite elements", lambda repeats, quick: crane_map(repeats)),
    "radial-rhs": ("right-hand side of the crane in its plane", lambda repeats, quick: right_hand_side(repeats)),
    "radial": ("crane in its plane", lambda repeats, quick: work_precision(radial_scene(), repeats, quick=quick)),
    "radial-modes": ("modes left out", lambda repeats, quick: modes_left_out(repeats)),
    "space-rhs": ("right-hand side of the crane in space", lambda repeats, quick: space_right_hand_sides(repeats)),
    "space": ("crane in space", lambda repeats, quick: _space(repeats, quick)),
    "heads-rhs": ("right-hand side with tie bars, with a jib that pivots", lambda repeats, quick: heads(repeats)),
    "slewing-rhs": ("right-hand sides of the slewing cranes", lambda repeats, quick: right_hand_sides(repeats)),
    "multi-mass": ("slewing crane, multi-mass", lambda repeats, quick: _lumped("multi-mass", repeats, quick)),
    "enhanced": ("slewing crane, enhanced", lambda repeats, quick: _lumped("enhanced", repeats, quick)),
    "basic": ("slewing crane, basic", lambda repeats, quick: _lumped("basic", repeats, quick)),
    "jib": ("jib crane", lambda repeats, quick: work_precision(jib_scene(), repeats, quick=quick)),
    "accuracy": ("error-controlled runs of drawn scenes", lambda repeats, quick: error_controlled(repeats)),
    "space-accuracy": (
        "error-controlled runs of drawn scenes in space",
        lambda repeats, quick: error_controlled_in_space(quick),
    ),
    "events": ("random short runs full of events", lambda repeats, quick: event_runs(quick)),
    "many": ("many runs at once", lambda repeats, quick: _many(repeats)),
    "growth": ("growth of the cost", lambda repeats, quick: growth(repeats)),
}
"""What is measured, by name; each takes the number of repeats and whether to be quick, and gives a table."""


def measure(*, quick: bool = False, subject: str = "", say: Callable[[str], None] = print) -> dict[str, Any]:
    """Subjects of the benchmark.

    Parameters
    ----------
    quick : bool
        Fewer repeats and scenes, one tolerance for each rival.
    subject : str
        Name of a single subject; empty: all.
    say : callable
        Told what is being measured.

    Returns
    -------
    dict
        ``machine``, ``versions`` and ``subjects``, each with name, title, columns, rows (text), records and notes.

    Raises
    ------
    ValueError
        If there is no such subject.
    """
    if subject and subject not in SUBJECTS:
        raise ValueError(f"subject: wanted one of {', '.join(SUBJECTS)}, got {subject!r}")
    subjects = []
    for name, (about, run) in SUBJECTS.items():
        if name == subject or not subject:
            say(f"measuring: {about}")
            subjects.append(run(1 if quick else 9, quick))
    machine = {"processor": platform.processor() or platform.machine(), "cores": os.cpu_count()}
    return {"machine": machine, "versions": versions(), "subjects": subjects}


def _many(repeats: int) -> dict[str, Any]:
    # Imported here: its import compiles.
    from towercrane.bench.runs.lanes import many_runs

    return many_runs(repeats)


def _space(repeats: int, quick: bool) -> dict[str, Any]:
    return work_precision(space_scene(10.0 if quick else 30.0), repeats, quick=quick)


def _lumped(kind: str, repeats: int, quick: bool) -> dict[str, Any]:
    return work_precision(lumped_scene(kind), repeats, quick=quick)
