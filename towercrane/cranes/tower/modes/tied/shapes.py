"""Shapes of members that ties hold: free bending, and how the member bends under each tie.

Natural modes alone converge slowly: the couple of a tie above the axis bends the member sharply, which they hardly
can. With one static shape more for each tie two modes are worth a dozen.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.polynomial import Chebyshev, Polynomial

from modal.beams.chain import Foundation
from modal.structures.chain_modes import ChainModes, chain_modes

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from modal import Chain
    from modal.structures.part_shapes import PartShapes

    Floats = NDArray[np.float64]

SOFT = 1e-7
"""Stiffness of a hinge's spring over E I / L: the modes on it are those of a free hinge but for so much."""

DEGREE = 7
"""Of polynomials in a piece: exact where it is uniform."""


@dataclass(frozen=True, slots=True)
class Pull:
    """What pulls at a member: force up [N] and couple that bends it up beyond [N m] at a place [m]."""

    place: float
    force: float
    couple: float


def hinged_shapes(chain: Chain, count: int, pulls: Sequence[Pull]) -> ChainModes:
    """Shapes of a member on a hinge: its turning, so many free modes, and one shape for each pull.

    Parameters
    ----------
    chain : Chain
        With a node at the place of each pull.
    count : int
        Number of free modes.
    pulls : sequence of Pull

    Returns
    -------
    ChainModes
        Orthonormal in the member's mass and each with its stiffness; the first one turns and has none.
    """
    spring = SOFT * chain.segments[0].bending_stiffness / chain.length
    free = chain_modes(replace(chain, foundation=Foundation(rotation_stiffness=spring)), count + 1)
    ends = free.shapes.ends
    turning = np.zeros((len(ends) - 1, 2, 5))
    turning[:, 0, 0], turning[:, 1, 0] = ends[:-1], np.diff(ends)
    turning[:, 0, [1, 4]] = 1.0
    bent = [static_shape(chain, ends, pull, hinged=True) for pull in pulls]
    found = orthonormal(chain, free.shapes, [turning, *free.shapes.coefficients[1:], *bent])
    omega = found.angular_frequencies.copy()
    omega[0] = 0.0
    return replace(found, angular_frequencies=omega)


def column_shapes(chain: Chain, count: int) -> ChainModes:
    """Shapes of a member that is clamped: so many modes, and that of a force on its end."""
    free = chain_modes(chain, max(count, 1))
    bent = static_shape(chain, free.shapes.ends, Pull(chain.length, 1.0, 0.0), hinged=False)
    return orthonormal(chain, free.shapes, [*free.shapes.coefficients[:count], bent])


def static_shape(chain: Chain, ends: Floats, pull: Pull, *, hinged: bool) -> Floats:
    """Bending under a pull, as coefficients of :class:`modal.structures.part_shapes.PartShapes`.

    On a hinge the member turns under it with constant acceleration, and its inertia bends it: without bending the
    shape would be a turn. V' = -p, M' = -V - c, E I theta' = M, w' = theta + V / S, with the inertia's force p and
    couple c per length.
    """
    turned = 0.0
    if hinged:
        _, _, second, rotary = chain.inertia
        turned = (pull.force * pull.place + pull.couple) / (second + rotary)
    loads = {pull.place: (pull.force, pull.couple)}
    for node, body in chain.bodies.items():
        centre = chain.nodes[node] + body.offset
        force = -turned * body.mass * centre
        before, couple = loads.get(chain.nodes[node], (0.0, 0.0))
        more = force * body.offset - turned * body.rotary_inertia
        loads[chain.nodes[node]] = before + force, couple + more
    shear, moment, pieces = 0.0, 0.0, []
    nodes = 0.5 - 0.5 * np.cos(np.pi * (np.arange(DEGREE + 1) + 0.5) / (DEGREE + 1))
    for begin, end in zip(ends[-2::-1], ends[:0:-1], strict=True):
        width = end - begin
        for place, (force, couple) in loads.items():
            if abs(place - end) < 1e-9 * ends[-1]:
                shear, moment = shear + force, moment + couple

        places = begin + width * nodes
        mass, spun = (chain.section(places, name) for name in ("mass_per_length", "rotary_inertia"))
        v = _beyond(_through(nodes, -turned * mass * places), width, shear)
        m = _beyond(v + _through(nodes, -turned * spun), width, moment)
        lean = chain.incline(places)
        strain = (v(nodes) + lean * m(nodes)) / chain.section(places, "shear_stiffness")
        curved = m(nodes) / chain.section(places, "bending_stiffness") + lean * strain
        pieces.append((width, (v, m, _through(nodes, strain), _through(nodes, curved))))
        shear, moment = float(v(0.0)), float(m(0.0))
    deflection, rotation, rows = 0.0, 0.0, []
    for width, (v, m, strain, curved) in reversed(pieces):
        turn = rotation + width * curved.integ(lbnd=0.0)
        slope = turn + strain
        w = deflection + width * slope.integ(lbnd=0.0)
        deflection, rotation = float(w(1.0)), float(turn(1.0))
        row = np.zeros((DEGREE + 3, 5))
        for quantity, polynomial in enumerate((w, turn, v, m, slope)):
            powers = polynomial.convert(kind=Polynomial).coef
            row[: len(powers), quantity] = powers
        rows.append(row)
    return np.array(rows)


def orthonormal(chain: Chain, properties: PartShapes, shapes: Sequence[Floats]) -> ChainModes:
    """Shapes that span the same, orthonormal in the chain's mass, each with a stiffness of its own."""
    from scipy.linalg import eigh

    pieces, terms = len(properties.ends) - 1, max(shape.shape[1] for shape in shapes)
    coefficients = np.zeros((len(shapes), pieces, terms, 5))
    for row, shape in zip(coefficients, shapes, strict=True):
        row[:, : shape.shape[1]] = shape
    raw = ChainModes(chain, np.zeros(len(shapes)), replace(properties, coefficients=coefficients))
    scale = 1.0 / np.sqrt(np.diag(raw.mass_matrix()))
    raw = replace(raw, shapes=replace(properties, coefficients=scale[:, None, None, None] * coefficients))
    squared, mix = eigh(raw.stiffness_matrix(), raw.mass_matrix())
    mixed = np.tensordot(mix.T, raw.shapes.coefficients, 1)
    found = ChainModes(chain, np.sqrt(np.maximum(squared, 0.0)), replace(properties, coefficients=mixed))
    # Positive is up at the end.
    mixed = np.sign(found(chain.length))[:, None, None, None] * mixed
    return replace(found, shapes=replace(properties, coefficients=mixed))


def _through(places: Floats, values: Floats) -> Chebyshev:
    """The polynomial through values at the Chebyshev points of (0, 1)."""
    return Chebyshev.fit(places, values, DEGREE, domain=[0.0, 1.0])


def _beyond(density: Chebyshev, width: float, end: float) -> Chebyshev:
    """What is beyond a place of a piece: what is beyond its end, and the density between."""
    return end - width * density.integ(lbnd=1.0)
