"""Geometrically exact rods put together to cranes: rods that share nodes, lumps, hinges, points."""

from itertools import pairwise

import numpy as np
from oracles import exact_rods
from oracles import rod_kernels as at

HELD = 3e9
"""Stiffness of the hinges [N/m]; the first element of a jib gives way the less."""

ALIGNED = 1e8
"""Of the hinges to turns but their own [N m]."""

STEP = 300.0
"""Mass of the head that each hinge moves with it: its springs are then no faster than the rods [kg]."""

STEPS = 3000.0
"""Angular frequency to which the springs against other turns are slowed so [rad/s]."""


class Assembly:
    """Rods that are put together, node after node."""

    def __init__(self):
        self.places, self.nodes, self.ends, self.elements = [], [], [], []

    def node(self, place, row):
        self.places.append(place)
        self.nodes.append(row)
        return len(self.nodes) - 1

    def rod(self, begin, end, count, *section, first=None, **shearing):
        """Nodes and elements of a rod, which begins at a node that is there or with one of its own."""
        way = np.subtract(end, begin)
        axis = int(np.argmax(abs(way)))
        places = begin + np.linspace(0.0, 1.0, count + 1)[:, None] * way
        nodes, _, elements = exact_rods.chain(0, places, *section, axis, **shearing)
        elements[:, at.AXIS : at.AXIS + 3] *= np.sign(way[axis])
        if first is None:
            row = [self.node(places[0], nodes[0])]
        else:
            row = [first]
            self.nodes[first] = self.nodes[first] + nodes[0]
        row += [self.node(place, node) for place, node in zip(places[1:], nodes[1:], strict=True)]
        bars = range(len(self.elements), len(self.elements) + count)
        self.ends += pairwise(row)
        self.elements += list(elements)
        return row, list(bars)

    def lump(self, node, mass, x=0.0, z=0.0, inertia=0.0):
        """Add a mass at a place in the axes of a node."""
        row = self.nodes[node]
        row[[at.MASS, at.MOMENT, at.RAISED, at.PRODUCT]] += mass, mass * x, mass * z, -mass * x * z
        row[at.INERTIA : at.INERTIA + 3] += [mass * z**2, mass * (x**2 + z**2) + inertia, mass * x**2 + inertia]

    def hinge(self, outer, inner, x=0.0, z=0.0, aligned=ALIGNED):
        """Hinge at a place in the axes of the outer node, whose springs move some mass of it with the inner one."""
        turning = aligned / STEPS**2
        self.lump(outer, -STEP, x, z, -turning)
        self.lump(inner, STEP, inertia=turning)
        self.nodes[inner][at.INERTIA] += turning
        self.nodes[outer][at.INERTIA] -= turning
        return [outer, inner, x, 0.0, z, HELD, aligned]

    def point(self, place, mass):
        """A node that no rod holds."""
        return self.node(place, np.array([mass, 1.0, 1.0, 1.0, *5 * [0.0]]))

    def nearest(self, x):
        """The node of the jibs at a place."""
        gap, node = min((abs(place[0] - x) + abs(place[2]), node) for node, place in enumerate(self.places))
        assert gap < 1e-9, "a node at each tie and body"
        return node

    def rods(self, gravity, rail, ropes, spans, hinges):
        nodes = np.array(self.nodes)
        nodes[:, at.GRAVITY] = gravity
        places, ends, elements = (np.array(rows) for rows in (self.places, self.ends, self.elements))
        return exact_rods.Rods(
            places, nodes, ends, elements, rail, np.array(ropes), np.array(spans), np.array(hinges)
        )

    def tower(self, beam, count, twist, inertia):
        """Nodes of an inextensible tower from its clamped foot to its top, and its elements."""
        length, bending, heavy = beam.length, beam.bending_stiffness, beam.mass_per_length
        stretch = 16.0 * 12.0 * bending / (length / count) ** 2
        spin = heavy * exact_rods.TOWER_GYRATION**2
        row, bars = self.rod(
            (0.0, 0.0, -length), (0.0, 0.0, 0.0), count, (stretch, bending, bending, twist), heavy,
            (spin, spin, inertia),
        )  # fmt: skip
        self.nodes[row[0]][at.MASS] = np.inf
        return row, bars


def turned(q, v):
    """Vectors turned by unit quaternions."""
    twice = 2.0 * np.cross(q[..., 1:], v)
    return v + q[..., :1] * twice + np.cross(q[..., 1:], twice)
