"""A hammerhead crane as geometrically exact rods: jibs on hinges, ties that are strings of bars with mass and sag.

As :mod:`oracles.exact_rods`, of which it is made. Jibs and cat-head are as long as drawn while the ties pull as under
the crane's own weight, as in the models.
"""

from dataclasses import dataclass, replace

import numpy as np
from oracles import exact_rods
from oracles import rod_kernels as at
from oracles.rod_assembly import HELD, Assembly, turned

BARS = 12
"""Of the longest tie."""


@dataclass(frozen=True, eq=False)
class TiedRods:
    """Rods of a crane, and which of their nodes are what: the head, tips and ends of ties; which ropes are a tie."""

    rods: exact_rods.Rods
    head: int
    tip: int
    tied: list
    ties: list

    def tensions(self, states):
        """Mean of the bars of each tie, at any number of instants."""
        spans, ropes, found = self.rods.spans, self.rods.ropes, []
        for own in self.ties:
            rows = spans[own]
            ends = [
                states[..., node.astype(int), :3] + turned(states[..., node.astype(int), 3:7], local)
                for node, local in (
                    (rows[:, at.UPPER], rows[:, at.FROM : at.FROM + 3]), (rows[:, at.LOWER], rows[:, at.TO :]),
                )
            ]  # fmt: skip
            length = np.linalg.norm(ends[1] - ends[0], axis=-1)
            found.append(np.mean(ropes[own, at.STRENGTH] * (length / ropes[own, at.SLACK] - 1.0), axis=-1))
        return np.array(found)

    def above(self, states, node):
        """How far a node is above the axis of the head."""
        way = states[..., node, :3] - states[..., self.head, :3]
        return turned(states[..., self.head, 3:7] * [1.0, -1.0, -1.0, -1.0], way)[..., 2]

    def levelled(self, tries=20):
        """The crane with ties that hold it level where they end, and its state, the tower straight and no load."""
        ropes, points = self.rods.ropes.copy(), self.rods.points
        nodes = self.rods.nodes.copy()
        nodes[: self.head + 1, at.MASS] = nodes[points[-2:], at.MASS] = np.inf
        alone = replace(self.rods, nodes=nodes, ropes=ropes, rail=-1)
        state, still, idle = self.rods.undeformed(), np.zeros(6), alone.idle
        for own in self.ties:
            # From the straight line: the sag then makes them longer.
            inner = self.rods.spans[own[1:], at.UPPER].astype(int)
            state[inner, :3] = self.rods.places[inner]
        size, rows = 6 * len(alone.free), [6 * int(np.searchsorted(alone.free, node)) + 2 for node in self.tied]
        for _ in range(tries):
            matrix = np.eye(size + len(rows))
            slope = alone.gradient(state, still)
            slope[idle], slope[:, idle], slope[idle, idle] = 0.0, 0.0, 1.0
            matrix[:size, :size] = slope
            for k, own in enumerate(self.ties):
                matrix[size + k] = 0.0
                matrix[size + k, rows[k]] = 1.0
                moved = []
                for sign in (1e-7, -1e-7):
                    other = ropes.copy()
                    other[own, at.SLACK] *= 1.0 + sign
                    moved.append(replace(alone, ropes=other).accelerations(state, still))
                matrix[:size, size + k] = (moved[0] - moved[1]) / 2e-7
            rest = np.concatenate([alone.accelerations(state, still), state[self.tied, 2]])
            way = np.linalg.solve(matrix, -rest)
            state = alone.moved(state, way[:size].reshape(-1, 6))
            for k, own in enumerate(self.ties):
                ropes[own, at.SLACK] *= 1.0 + way[size + k]
            if np.max(abs(way)) < 1e-7:
                return replace(self, rods=replace(self.rods, ropes=ropes)), state
        raise RuntimeError("no level equilibrium")


def tied_rods(crane, load, tensions, tower=8, finer=1):
    """The crane, its tower inextensible, with ties that pull about so much under its own weight [N]."""
    made, bars, beam = Assembly(), crane.tie_bars, crane.tower
    column, _ = made.tower(beam, tower, beam.bending_stiffness, 100.0)
    head, cat = column[-1], bars.head
    heavy, bending = cat.mass_per_length, 3 * (cat.bending_stiffness,)
    upright, pressed = made.rod(
        (0.0, 0.0, 0.0), (0.0, 0.0, cat.height), 4 * finer, (cat.axial_stiffness, *bending), heavy,
        3 * (heavy * exact_rods.TOWER_GYRATION**2,), first=head,
    )  # fmt: skip
    straight = np.hypot(*bars.spans.T)
    cosines, sines = abs(bars.spans).T / straight
    for row in pressed:
        made.elements[row][at.AXIS : at.AXIS + 3] *= 1.0 + tensions @ sines / cat.axial_stiffness
    hinges, tips = [], []
    for side, chain, lateral, axial in (
        (1.0, crane.jib, crane.jib_lateral, bars.jib_axial),
        (-1.0, crane.counter_jib, crane.counter_jib_lateral, bars.counter_jib_axial),
    ):
        begin, last = 0.0, None
        ends = [end for end, _ in axial]
        for own, sides in zip(chain.segments, lateral.segments, strict=True):
            end = begin + own.length
            stiffness = axial[int(np.searchsorted(ends, end - 1e-9))][1]
            row, elements = made.rod(
                (side * begin, 0.0, 0.0), (side * end, 0.0, 0.0), 2 * finer * max(1, round(0.25 * own.length)),
                (stiffness, own.bending_stiffness, own.bending_stiffness, sides.bending_stiffness),
                own.mass_per_length, 3 * (own.rotary_inertia,), first=last, shearing=own.shear_stiffness,
            )  # fmt: skip
            if last is None:
                hinges.append(made.hinge(head, row[0]))
                soft = made.elements[elements[0]]
                given = 1.0 / soft[at.STRETCH] - 1.0 / (HELD * soft[at.LENGTH])
                soft[at.STRETCH] = 1.0 / given if given > 0.0 else soft[at.STRETCH]
            for bar in elements:
                middle = abs(sum(made.places[node][0] for node in made.ends[bar])) / 2.0
                beyond = [k for k, tie in enumerate(bars.ties)
                          if bars.sides[k] == side and tie.position > middle]  # fmt: skip
                made.elements[bar][at.AXIS] *= 1.0 + tensions[beyond] @ cosines[beyond] / stiffness
            begin, last = end, row[-1]
        for node, body in chain.bodies.items():
            made.lump(made.nearest(side * chain.nodes[node]), body.mass, inertia=body.rotary_inertia)
        tips.append(last)
    ropes, spans, ties, tied = [], [], [], []
    for k, (side, tie) in enumerate(zip(bars.sides, bars.ties, strict=True)):
        low, high = np.array([side * tie.position, 0.0, tie.height]), np.array([0.0, 0.0, cat.height])
        end = made.nearest(side * tie.position)
        count = max(4, round(BARS * straight[k] / straight.max()))
        mass = tie.mass_per_length * straight[k] / count
        inner = [made.point(high + i / count * (low - high), mass) for i in range(1, count)]
        made.lump(upright[-1], 0.5 * mass)
        made.lump(end, 0.5 * mass, z=tie.height)
        row = [upright[-1], *inner, end]
        ties.append(list(range(len(spans), len(spans) + count)))
        tied.append(end)
        for i in range(count):
            ropes.append([tie.axial_stiffness, straight[k] / count / (1.0 + tensions[k] / tie.axial_stiffness), -1.0])
            to = tie.height if i == count - 1 else 0.0
            spans.append([len(spans), row[i], row[i + 1], 1.0, *5 * [0.0], to])
    for mass in (crane.trolley_mass, load):
        made.point(np.zeros(3), mass)
    rods = made.rods(crane.gravity, tower + 4 * finer, ropes, spans, hinges)
    return TiedRods(rods, head, tips[0], tied, ties)


def loaded(rods, state, inputs):
    """A state with the trolley on the bent jib and the load on its taut rope below."""
    state = state.copy()
    for _ in range(2):
        state[-1, :3] = state[-2, :3] - [0.0, 0.0, inputs[at.ROPE]]
        felt = rods.rates(state, inputs)[0][-2, at.SPEED : at.SPEED + 3] + [0.0, 0.0, rods.nodes[-2, at.GRAVITY]]
        state[-2:, :3] += felt * rods.nodes[-2, at.MASS] / at.STIFF
    return state
