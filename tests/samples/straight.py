"""Straight code of the smallest equation, in a cache of its own."""

import numpy as np

from modal.compiler import machine_code
from towercrane.kernels.straight.code import StraightCode
from towercrane.kernels.straight.graph import Graph
from towercrane.kernels.straight.program import Program
from towercrane.simulation import stepper


def made(coefficient, folder, monkeypatch):
    """Code of y' = coefficient y with a cache in that folder, and how often it was compiled."""
    compiled, compile_it = [], machine_code._compiled
    monkeypatch.setattr(machine_code, "cache_folder", lambda: folder)
    monkeypatch.setattr(machine_code, "_compiled", lambda *own: compiled.append(own) or compile_it(*own))
    graph = Graph()
    (y,) = graph.given("y", 1)
    program = Program(graph, {("dy", 0): graph.place(coefficient * y)}, 0)
    code = StraightCode(program, {"y": (1,)}, lanes=False)
    monkeypatch.setattr(machine_code, "_compiled", compile_it)
    return code, len(compiled)


def found(code, compiled):
    """What it computes at y = 1, as the solver calls it, and how often it was compiled."""
    slopes, guards, none = np.empty((1, 1)), np.empty((1, 0)), np.empty(0)
    stepper.evaluate(code, np.zeros(1), np.ones((1, 1)), slopes, guards, np.empty((0, 0)), none, np.empty((0, 0, 0)))
    return float(slopes[0, 0]), compiled
