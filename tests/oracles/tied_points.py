"""A crane whose jibs hang on ties as a cloud of points, the ties among them, and their energy from places alone.

As :mod:`oracles.space_points`: nothing but positions, and energies that follow from positions, is used here.
"""

from itertools import pairwise

import numpy as np
from oracles.jets import Jet, rotation, total
from oracles.luffing_points import apart, shaped
from oracles.space_points import CraneCloud, Points, on

SLOPE = 4


def along(chain, ends):
    """Quadrature points along a chain between these ends, with their mass; and its bodies, without rotary inertia."""
    places, masses = [], []
    for begin, until in pairwise(ends):
        at, weights = on(until - begin, begin)
        places.append(at)
        masses.append(chain.section(at, "mass_per_length") * weights)
    places += [np.array([chain.nodes[node] + body.offset]) for node, body in chain.bodies.items()]
    masses += [np.array([body.mass]) for body in chain.bodies.values()]
    return np.concatenate(places), np.concatenate(masses)


class TiedCloud(CraneCloud):
    """Points of a model whose ``crane`` is the TowerCrane that it was made of; drives as in the base."""

    def __init__(self, model, crane):
        super().__init__(model, crane)
        self.bars, flexible = crane.tie_bars, model.crane
        self.bases = {
            "jib_lateral": flexible.lateral, "jib_vertical": flexible.vertical,
            "counter_jib_lateral": flexible.counter_lateral, "counter_jib_vertical": flexible.counter_vertical,
            "tower_head": flexible.tied.column,
        }  # fmt: skip

        self.tables = {}
        ends = [self.ends(k)[2:] for k in range(len(self.bars.ties))]
        self.straight = [np.linalg.norm(low - top) for top, low in ends]
        self.stiffness = np.linalg.inv(self.compliance())

    def compliance(self):
        """Lengthening of each tie per tension of each, jibs and cat-head without mass."""
        bars, straight, count = self.bars, self.straight, len(self.bars.ties)
        found = np.zeros((count, count))
        for i in range(count):
            one, side, top, end = self.ends(i)
            for j in range(count):
                other, far, _, there = self.ends(j)
                sines = (top[2] - end[2]) / straight[i] * (top[2] - there[2]) / straight[j]
                found[i, j] = sines * top[2] / bars.head.axial_stiffness
                if side == far:
                    pieces = bars.jib_axial if side > 0 else bars.counter_jib_axial
                    joints = [0.0, *(end for end, _ in pieces)]
                    shorter = np.cumsum([0.0, *(np.diff(joints) / [stiffness for _, stiffness in pieces])])
                    cosines = one.position / straight[i] * other.position / straight[j]
                    found[i, j] += cosines * np.interp(min(one.position, other.position), joints, shorter)
            found[i, i] += straight[i] / one.axial_stiffness
        return found

    def table(self, kind, places, derivative):
        """Shapes or their slopes at places, of which no two sets are as many and as far."""
        known = kind, derivative, len(places), float(places[-1])
        if known not in self.tables:
            basis = self.bases[kind]
            self.tables[known] = basis.shapes.evaluate(places, SLOPE) if derivative else basis(places)
        return self.tables[known]

    def part_of(self, q):
        part = {kind: q[where] for kind, where in self.model.parts.items()}
        part.setdefault("tie_sideways", [])
        return part

    def ends(self, k):
        """A tie, its side, and the places of its straight ends."""
        bars = self.bars
        tie, side = (*bars.jib, *bars.counter_jib)[k], 1.0 if k < len(bars.jib) else -1.0
        return tie, side, np.array([0.0, 0.0, bars.head.height]), np.array([side * tie.position, 0.0, tie.height])

    def moved_ends(self, part, k):
        """How far its ends move, to first order in the coordinates."""
        tie, side, _, _ = self.ends(k)
        name, nothing = "jib" if side > 0 else "counter_jib", Jet(0.0)
        up, left = self.bases[f"{name}_vertical"], self.bases[f"{name}_lateral"]
        turn = shaped(up.rotation(tie.position), part[f"{name}_vertical"])
        upper = [shaped(self.bases["tower_head"](self.bars.head.height), part["tower_head"]), nothing, nothing]
        lower = [
            turn * (-side * tie.height), shaped(left(tie.position), part[f"{name}_lateral"]),
            shaped(up(tie.position), part[f"{name}_vertical"]),
        ]  # fmt: skip
        return upper, lower

    def forward(self, q, k):
        """Share of a tie's direction along the jib, from top to end."""
        reach = [float(np.squeeze(way.c[0])) for way in self.reach(self.part_of([Jet(value) for value in q]), k)]
        return reach[0] / np.linalg.norm(reach)

    def length(self, part, k):
        """Of a tie's chord."""
        return apart(self.reach(part, k), [Jet(0.0)] * 3)

    def reach(self, part, k):
        """A tie's chord from top to end, with the shortening of bent members and the turn of its end."""
        tie, side, top, end = self.ends(k)
        upper, lower = self.moved_ends(part, k)
        name = "jib" if side > 0 else "counter_jib"

        def nearer(kind, length):
            ends = [end for end in self.bases[kind].shapes.ends if end <= length * (1 + 1e-12)]
            at, weights = (np.concatenate(rows) for rows in zip(*(
                on(until - begin, begin) for begin, until in pairwise(ends)
            ), strict=True))  # fmt: skip
            slope = shaped(self.table(kind, at, 1), part[kind])
            square = slope * slope
            return 0.5 * Jet(*(np.sum(weights * c) for c in square.c))

        turn = shaped(self.bases[f"{name}_vertical"].rotation(tie.position), part[f"{name}_vertical"])
        shorter = nearer(f"{name}_vertical", tie.position) + nearer(f"{name}_lateral", tie.position)
        high = [upper[0], upper[1], Jet(top[2]) - nearer("tower_head", top[2])]
        low = [
            Jet(end[0]) + lower[0] - side * shorter, lower[1],
            Jet(end[2]) + lower[2] - (0.5 * tie.height) * (turn * turn),
        ]  # fmt: skip
        return [b - a for a, b in zip(high, low, strict=True)]

    def energy(self, q):
        """Of the ties and of jibs and cat-head under them."""
        part, tied, bars, straight = self.part_of(q), self.model.constants.tied, self.bars, self.straight
        given, count = [], len(straight)
        for k in range(count):
            sag = part["tie"][k]
            weight = bars.ties[k].mass_per_length * self.crane.gravity * bars.ties[k].position / straight[k]
            curve = np.pi**2 / (4.0 * straight[k])
            more = sag * (2.0 * weight * straight[k] / (np.pi * tied.pretension[k])) + curve * (sag * sag)
            if len(part["tie_sideways"]):
                more = more + curve * (part["tie_sideways"][k] * part["tie_sideways"][k])
            given.append(self.length(part, k) - tied.reference[k] + more)
        stiffness = self.stiffness
        self.tensions = [tied.pretension[k] + stiffness[k] @ [g.c[0] for g in given] for k in range(count)]
        quadratic = total(0.5 * stiffness[i, j] * (given[i] * given[j]) for i in range(count) for j in range(count))
        return total(tied.pretension[k] * given[k] for k in range(count)) + quadratic

    def points(self, q, drives, angles):
        crane, flexible, bars = self.crane, self.model.crane, self.bars
        part, nothing, one = self.part_of(q), Jet(0.0), np.ones(1)
        tip, slope = flexible.tower(flexible.tower_height), flexible.tower(flexible.tower_height, 1)
        count = len(part["tower_y"])
        ux, uy = shaped(tip, part["tower_x"]), shaped(tip[:count], part["tower_y"])
        lean_x, lean_y = shaped(slope, part["tower_x"]), shaped(slope[:count], part["tower_y"])
        slewing = part["slewing"][0] if len(part["slewing"]) else drives[0]
        turn = shaped(flexible.torsion(flexible.tower_height), part["torsion"]) + slewing
        tilt, c, s = rotation(-lean_y, lean_x, Jet(0.0)), turn.cos(), turn.sin()
        axes = [[row[0] * c + row[1] * s, row[1] * c - row[0] * s, row[2]] for row in tilt]

        def head(place):
            return [total(a * x for a, x in zip(row, place, strict=True)) + b
                    for row, b in zip(axes, (ux, uy, nothing), strict=True)]  # fmt: skip

        x, length = drives[1], drives[2]

        def at_trolley(kind):
            values = [self.bases[kind](x.c[0], k) for k in range(3)]
            return total(
                x.through(values[0][i], values[1][i], values[2][i]) * a for i, a in enumerate(part[kind])
            )  # fmt: skip

        hung = head([x, at_trolley("jib_lateral") + nothing, at_trolley("jib_vertical")])
        theta, phi = angles
        rope = [theta.sin() * phi.cos(), phi.sin(), -(theta.cos() * phi.cos())]
        clouds = {
            "tower": Points(
                [shaped(self.bends, part["tower_x"]), shaped(self.bends[:count], part["tower_y"]), nothing],
                crane.tower.mass_per_length * self.tower_weights, True,
            ),
            "trolley": Points(hung, crane.trolley_mass * one, True),
            "load": Points(
                [a + length * n for a, n in zip(hung, rope, strict=True)], self.model.load.mass * one, True
            ),
        }  # fmt: skip
        for name, chain, side in (("jib", crane.jib, 1.0), ("counter_jib", crane.counter_jib, -1.0)):
            at, mass = along(chain, self.bases[f"{name}_vertical"].shapes.ends)
            sides = shaped(self.table(f"{name}_lateral", at, 0), part[f"{name}_lateral"])
            rise = shaped(self.table(f"{name}_vertical", at, 0), part[f"{name}_vertical"])
            clouds[name] = Points(head([Jet(side * at), sides + nothing, rise]), mass, True)
        at, weights = on(bars.head.height)
        forward = shaped(self.bases["tower_head"](at), part["tower_head"])
        clouds["cat-head"] = Points(head([forward, nothing, Jet(at)]), bars.head.mass_per_length * weights, True)
        for k in range(len(bars.ties)):
            tie, side, top, end = self.ends(k)
            straight = np.linalg.norm(end - top)
            at, weights = on(1.0)
            upper, lower = self.moved_ends(part, k)
            way = end - top
            down = np.array([side * way[2], 0.0, -side * way[0]]) / straight
            wave = np.sin(np.pi * at)
            place = []
            for axis in range(3):
                own = Jet(top[axis] + at * way[axis]) + upper[axis] * (1.0 - at) + lower[axis] * at
                own = own + part["tie"][k] * (down[axis] * wave)
                if axis == 1 and len(part["tie_sideways"]):
                    own = own + part["tie_sideways"][k] * wave
                place.append(own)
            clouds[f"tie {k}"] = Points(head(place), tie.mass_per_length * straight * weights, True)
        return clouds, rope, axes, (ux, uy)

    def displace(self, q, drives):
        columns, n = super().displace(q, drives), self.model.coordinates
        for i, column in enumerate(columns):
            unit = [Jet(a, float(k == i)) for k, a in enumerate(q)]
            column["stored"] = self.energy(unit[:n]).c[1]
        return columns

    def left_over(self, q, rate, acceleration, drives, columns, wind):
        bare = [{name: moved for name, moved in column.items() if name != "stored"} for column in columns]
        sums, sizes = super().left_over(q, rate, acceleration, drives, bare, wind)
        stored = np.array([float(column["stored"]) for column in columns])
        return sums + stored, sizes + abs(stored)

    def _own(self, i, q, rate, acceleration):
        kind = next(kind for kind, part in self.model.parts.items() if part.start <= i < part.stop)
        if kind in ("tie", "tie_sideways"):
            return np.zeros(1)
        if kind in self.bases:
            omega = self.bases[kind].angular_frequencies[i - self.model.parts[kind].start]
            names = {"counter_jib_vertical": "counter_vertical", "counter_jib_lateral": "counter_lateral"}
            ratio = getattr(self.model.damping, names.get(kind, kind.removeprefix("jib_")), 0.0)
            return np.array([omega**2 * q[i], 2.0 * ratio * omega * rate[i]])
        return super()._own(i, q, rate, acceleration)
