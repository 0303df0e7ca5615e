"""The first compilation of the kernels, spread over two processes."""

from __future__ import annotations

import subprocess
import sys
from importlib import import_module

from modal.compiled import is_compiled

FLEXIBLE = "towercrane.cranes.flexible_rhs", "modal.roots"
LUMPED = ("towercrane.cranes.lumped_kernel",)

EQUATIONS = {
    "radial": FLEXIBLE,
    "space": FLEXIBLE,
    "jib": ("towercrane.cranes.jib_crane_kernel",),
    "lanes": ("towercrane.cranes.radial_lane_rhs", "towercrane.cranes.radial_lanes"),
}
"""Modules whose import compiles what a kind of crane needs; all other kinds are lumped."""


def missing_kernels(kind: str, *needed: str) -> tuple[str, ...]:
    """Modules of kernels that a kind of crane, or a command besides, needs and that are not compiled yet."""
    modules = dict.fromkeys((*EQUATIONS.get(kind, LUMPED), *needed))
    return tuple(module for module in modules if not is_compiled(module))


def compile_kernels(here: str, *beside: str) -> None:
    """Import modules of kernels, the first here, the others in a process beside: all leave code in the cache."""
    # Without looking for garbage it is a twentieth faster, and it does not live long.
    command = [sys.executable, "-c", f"import gc; gc.disable(); import {', '.join(beside)}"]
    # If it fails, it does no harm: what it should have compiled is compiled where it is used.
    other = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) if beside else None
    try:
        import_module(here)
    finally:
        if other:
            other.wait()
