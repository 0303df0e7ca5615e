"""Straight code of the smallest equation, in a cache of its own."""

import numpy as np

from towercrane.kernels.straight import code
from towercrane.kernels.straight.graph import Graph
from towercrane.kernels.straight.program import Program
from towercrane.simulation import stepper


def made(coefficient, folder, monkeypatch):
    """Code of y' = coefficient y with a cache in that folder."""
    monkeypatch.setattr(code, "cache_folder", lambda: folder)
    graph = Graph()
    (y,) = graph.given("y", 1)
    program = Program(graph, {("dy", 0): graph.place(coefficient * y)}, 0)
    return code.straight_code(program, {"y": (1,)}, 0)


def found(compiled):
    """What it computes at y = 1, as the solver calls it, and how often it was found in the cache."""
    slopes, guards, none = np.empty((1, 1)), np.empty((1, 0)), np.empty(0)
    stepper.evaluate(
        compiled, np.zeros(1), np.ones((1, 1)), slopes, guards, np.empty((0, 0)), none, np.empty((0, 0, 0))
    )
    return float(slopes[0, 0]), sum(compiled.stats.cache_hits.values())
