"""Tie bars: how long they are, how strong they pull, and at what.

A tie goes from the top A of the cat-head to a point B above the axis of a jib. As the column bends its top sinks, as
the jib bends B nears the foot and turns about the axis: these second-order terms are the compression of column and
jib, and with the turning of the tie its transverse stiffness; all are here, or none may be. The tie sags; what it
sags more than under its own weight is a coordinate of its own, which gives way under a slow pull (Ernst) and not
under a fast one.
"""

from __future__ import annotations

from math import pi
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from towercrane.kernels.algebra import Row, Vector, dot

if TYPE_CHECKING:
    from towercrane.cranes.tower.equations.tied.constants import Tied


class Span(NamedTuple):
    """A tie from its upper to its lower end, length and direction; length per each coordinate of what is on the
    head."""

    length: Any
    direction: Vector
    slopes: list[Any]


class Taut(NamedTuple):
    """Ties that pull: their spans, tensions, what each gives, and forces on what is on the head."""

    spans: list[Span]
    tensions: list[Any]
    given: list[Any]
    forces: list[Any]


def span_of(tied: Tied, k: int, q: Row) -> Span:
    """A tie in a state of what is on the head."""
    nearer, higher = ([dot(row, q) for row in form] for form in (tied.along[k], tied.across[k]))
    x, z = tied.spans[k]
    (to_x, to_y, to_z) = (dot(tied.ends[k, :, axis], q) for axis in range(3))
    reach = x + to_x + 0.5 * dot(nearer, q), to_y, z + to_z + 0.5 * dot(higher, q)
    length = np.sqrt(dot(reach, reach))
    u, v, w = reach[0] / length, reach[1] / length, reach[2] / length
    slopes = [
        dot((u, v, w), (own[0] + near, own[1], own[2] + high))
        for own, near, high in zip(tied.ends[k], nearer, higher, strict=True)
    ]
    return Span(length, (u, v, w), slopes)


def pull_ties(tied: Tied, q: Row) -> Taut:
    """The ties; last of the coordinates are their sags, and after them, where ties have them, bows to the left."""
    ties, sags = range(tied.count), tied.sags
    spans = [span_of(tied, k, q) for k in ties]
    curves = [0.5 * pi * pi / length for length in tied.lengths]
    given = []
    for k, span in enumerate(spans):
        more = tied.slack[k] * q[sags + k]
        for bow in q[sags + k :: tied.count]:
            more = more + 0.5 * curves[k] * bow * bow
        given.append(span.length - tied.reference[k] + more)
    tensions = [tied.pretension[k] + dot(tied.stiffness[k], given) for k in ties]
    forces = [-dot([span.slopes[i] for span in spans], tensions) for i in range(sags)]
    for place, bow in enumerate(q[sags:]):
        k = place % tied.count
        forces.append(-tensions[k] * (curves[k] * bow + (tied.slack[k] if place == k else 0.0)))
    return Taut(spans, tensions, given, forces)


def stored(tied: Tied, taut: Taut) -> Any:
    """Energy of the ties, and of the compression with them, over that under the crane's own weight [J]."""
    mean = [0.5 * (now + then) for now, then in zip(taut.tensions, tied.pretension, strict=True)]
    return dot(mean, taut.given)
