"""State of a model at the start of a run, as it is asked for."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.simulation.starts.start import HANGING, SEEN_FROM_TWO_SIDES, Start, Sways
from towercrane.simulation.starts.steady import Frame, quiet, steady_rotation

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.simulation.system import Model

    Floats = NDArray[np.float64]

TINY = 1e-200
"""Imaginary part that stands for a rate."""


def begin(model: Model, inputs: Floats, start: Start = HANGING) -> Floats:
    """State at the start of a run.

    Parameters
    ----------
    model : Model
        Where they are not those of a rope of prescribed length it has methods ``rope_direction(state, inputs)`` and
        ``hang(state, inputs, direction, rate)`` for the load, ``jib_heading(state, inputs)`` for the angle of its jib
        from the fixed x axis, ``sways`` for what its angles of sway are, and ``turning`` for what turns with it.
    inputs : ndarray
        Polynomials of the first phase, the wind's at the value that counts, see
        :func:`towercrane.simulation.system.start_inputs`.
    start : Start

    Returns
    -------
    ndarray, shape (size,)

    Raises
    ------
    NoEquilibrium
        If there is none that is stable.
    ValueError
        If the sways are of no rope, or what was saved is no state of the model.

    Notes
    -----
    Where the drive of the head turns already, "equilibrium" and "quiet" are those of a steady rotation at its rate.
    """
    if start.saved:
        if len(start.saved) != model.system.size:
            raise ValueError(f"saved: wanted {model.system.size} states, got {len(start.saved)}")
        return np.array(start.saved)
    asked: Any = model
    state = asked.start(inputs, "zero" if start.state == "zero" else "equilibrium")
    frame = Frame.of(model, inputs)
    if frame.spin and start.state != "zero":
        state = steady_rotation(model, state, frame)
    state = frame.carried(state)
    if frame.spin and model.system.rope is not None:
        # The load of an elastic rope moves with what its winch lets out, too.
        rope = rope_direction(model, state, inputs)
        state = asked.hang(state, inputs, rope, frame.spin * np.array([-rope[1], rope[0], 0.0]))
    if start.swings:
        state = swung(model, state, inputs, start, frame.spin)
        if start.state == "quiet":
            state = quiet(model, state, frame)
    return np.asarray(state)


def swung(model: Model, state: Floats, inputs: Floats, start: Start, spin: float) -> Floats:
    """The state with its load at the sways and with the rates that are asked for, seen from a head that turns so."""
    asked: Any = model
    heading = float(asked.jib_heading(state, inputs)) if hasattr(asked, "jib_heading") else 0.0
    sways: Sways = getattr(asked, "sways", SEEN_FROM_TWO_SIDES)
    c, s = np.cos(heading), np.sin(heading)
    outward, left = np.array([c, s, 0.0]), np.array([-s, c, 0.0])
    before = rope_direction(model, state, inputs)
    hanging = sways.angles(before @ outward, before @ left, before[2])
    along = hanging[0] if start.along is None else start.along
    across = hanging[1] if start.across is None else start.across
    if start.across is None and abs(along) > 0.5 * np.pi:
        across = 0.0
    if abs(across) >= 0.5 * np.pi or (across and abs(along) >= 0.5 * np.pi):
        raise ValueError(f"along, across: wanted sways below 90 deg, or one of them 0, got {along:g}, {across:g} rad")
    parts = sways.direction(along + 1j * TINY * start.along_rate, across + 1j * TINY * start.across_rate)
    moving = np.column_stack([outward, left, [0.0, 0.0, 1.0]]) @ np.array(parts)
    direction, rate = moving.real, moving.imag / TINY
    rate = rate + spin * np.array([-direction[1], direction[0], 0.0])
    found = np.array(asked.hang(state, inputs, direction, rate) if hasattr(asked, "hang") else state)
    # Slings are held in line with the rope.
    for first, moved, count in model.system.directions:
        kept = [0, 1, 2] if count == 3 else [0, 2]
        found[first : first + count], found[moved : moved + count] = direction[kept], rate[kept]
    return found


def rope_direction(model: Model, state: Floats, inputs: Floats) -> Floats:
    """Unit vector from where the rope hangs to the load; shape (3,)."""
    asked: Any = model
    if hasattr(asked, "rope_direction"):
        return np.asarray(asked.rope_direction(state, inputs))
    first, _, count = model.system.directions[0]
    rope = state[first : first + count]
    return np.array([rope[0], rope[1] if count == 3 else 0.0, rope[-1]])
