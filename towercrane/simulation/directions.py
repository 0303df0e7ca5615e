"""Directions among the states: unit vectors with their rates, and how a solver keeps them so.

A vector n with its rate p stands for a direction when |n| = 1 and n.p = 0. Errors of steps break both, and what is
broken does not stay as it is. The equations of :func:`towercrane.kernels.hanging.hang_load` make of n = N u and p = w
+ c u, with u a unit vector and w at right angles to it, N' = c and c' = |w|^2 (1 / N - 1): small errors follow
N'' = -|w|^2 (N - 1), and |w|^2 pulses with twice the frequency of the swing. Where its mean comes near the square of
that frequency, which is so from about 1.15 rad of swing on, they grow without bound.

So both are put back after every step. Of all slopes only n' = p depends on N and c, the others see u and w alone:
the next step begins with the slopes that this one has ended with, and keeps its order.

Within the plane at right angles errors stay errors. The estimate of a step says how large they are, not that they all
have one sign: what an explicit method takes from the energy of a swing adds up, and the period of a wide swing hangs
on its energy, so that the error of the position grows with the square of time. What steps take falls by two orders
more than the estimate where they are short beside the motion itself, which :func:`longest_turn` sees to.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from modal.compiler.kinds import Number, NumberRow, NumberTable, Whole

FIRST, RATE, COMPONENTS = range(3)
"""Columns of the table of directions: first state of the vector, first state of its rate, number of components."""

STEEPEST = 4.0
"""Largest change in the square of an acceleration that is expected to go on into the next step."""

NOTHING = 1e-300
"""Square of an acceleration that is none, so that nothing is divided by zero."""


def restore_state(y: NumberRow, directions: Whole) -> None:
    """Put the directions of a state back to unit length and their rates at right angles to them, in place."""
    for number in range(directions.shape[0]):
        first, rate = directions[number, FIRST], directions[number, RATE]
        square: Number = 0.0
        along: Number = 0.0
        for i in range(directions[number, COMPONENTS]):
            square += y[first + i] * y[first + i]
        norm = np.sqrt(square)
        for i in range(directions[number, COMPONENTS]):
            y[first + i] = y[first + i] / norm
            along += y[first + i] * y[rate + i]
        for i in range(directions[number, COMPONENTS]):
            y[rate + i] -= along * y[first + i]


def restore(y: NumberRow, k: NumberTable, row: int, directions: Whole) -> None:
    """:func:`restore_state` with the slope there.

    Parameters
    ----------
    y : ndarray, shape (size,)
    k : ndarray, shape (m, size)
    row : int
        Of k, the slope at y, which becomes that at the new y.
    directions : ndarray of int, shape (count, 3)
    """
    restore_state(y, directions)
    for number in range(directions.shape[0]):
        first, rate = directions[number, FIRST], directions[number, RATE]
        for i in range(directions[number, COMPONENTS]):
            k[row, first + i] = y[rate + i]


def longest_turn(k: NumberTable, row: int, directions: Whole, turn: float) -> Number:
    """Longest next step in which no direction turns by more than an angle, as if it went on round a circle.

    A point on a unit circle with the acceleration a turns at the rate sqrt(a). Seen so, a load that hangs still or
    vibrates with its rope's upper end by a hair turns slowly, however short its period: such steps are left to the
    error estimate. The acceleration is that at the end of the next step, if it goes on to change as in this one: a
    step bounded by where it begins would be longer on the way down from the top than on the way up, and the energy
    that steps take on the one would not be given back on the other.

    Parameters
    ----------
    k : ndarray, shape (m, size)
        Slopes of a step, of which the first is the one where it began; numbers or lane vectors.
    row : int
        Of k, the slope where it ended.
    directions : ndarray of int, shape (count, 3)
    turn : float
        The angle [rad].

    Returns
    -------
    float or lane vector
        [s]
    """
    largest: Number = NOTHING
    for number in range(directions.shape[0]):
        rate = directions[number, RATE]
        began: Number = 0.0
        ended: Number = 0.0
        for i in range(directions[number, COMPONENTS]):
            began += k[0, rate + i] * k[0, rate + i]
            ended += k[row, rate + i] * k[row, rate + i]
        change = min(max(ended / (began + NOTHING), 1.0 / STEEPEST), STEEPEST)
        largest = max(largest, ended * change)
    return turn / np.sqrt(np.sqrt(largest))


def restore_rows(states: Any, directions: Any) -> float:
    """The same for states alone, the last axis of an array, in place; the largest error of a length before."""
    error = 0.0
    for first, rate, components in directions:
        # Column by column: sums over so short an axis take NumPy five times as long.
        n, p = ([states[..., begin + i] for i in range(components)] for begin in (first, rate))
        norm = np.sqrt(sum(part * part for part in n))
        error = max(error, float(abs(norm - 1.0).max(initial=0.0)))
        for part in n:
            part /= norm
        along = sum(part * turn for part, turn in zip(n, p, strict=True))
        for part, turn in zip(n, p, strict=True):
            turn -= along * part
    return error
