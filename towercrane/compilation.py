"""The first compilation of the kernels, spread over processes."""

from __future__ import annotations

import subprocess
import sys
from importlib import import_module

from modal.compiled import is_compiled

STEPPER = "towercrane.stepper"

FLEXIBLE = "towercrane.cranes.flexible_rhs", "modal.roots", "towercrane.cranes.head_motions"
LUMPED = ("towercrane.cranes.lumped_kernel",)

EQUATIONS = {
    "radial": FLEXIBLE,
    "space": FLEXIBLE,
    "jib": ("towercrane.cranes.jib_crane_kernel",),
    "lanes": ("towercrane.cranes.radial_lane_rhs", "towercrane.cranes.radial_lanes"),
}
"""Modules whose import compiles what a kind of crane needs; all other kinds are lumped."""

AHEAD = {"towercrane.cranes.flexible_rhs": "towercrane.cranes.flexible_load"}
"""Modules whose import compiles a part of another's kernels, so that a process beside it can be ahead with that."""


def missing_kernels(kind: str, *needed: str) -> tuple[str, ...]:
    """Modules of kernels that a kind of crane, or a command besides, needs and that are not compiled yet."""
    modules = dict.fromkeys((*EQUATIONS.get(kind, LUMPED), *needed))
    return tuple(module for module in modules if not is_compiled(module))


def compile_kernels(modules: tuple[str, ...]) -> None:
    """Import modules of kernels, the first here, the others in two processes beside: all leave code in the cache."""
    here, *others = modules
    groups: list[list[str]] = [[AHEAD[here]] if here in AHEAD else [], []]
    for module in others:
        # The integrator takes about as long as the other parts of the equations; what is left is small.
        groups[0 if module == STEPPER else 1].append(module)
    # A process that fails does no harm: what it should have compiled is compiled where it is used.
    beside = [
        subprocess.Popen(
            [sys.executable, "-c", f"import {', '.join(group)}"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
        for group in groups
        if group
    ]
    try:
        import_module(here)
    finally:
        for process in beside:
            process.wait()
