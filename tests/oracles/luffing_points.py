"""A crane with a jib that pivots as a cloud of points, its ropes and their energies written as functions of places.

As :mod:`oracles.space_points`: nothing but positions, and energies that follow from positions, is used here.
"""

import numpy as np
from oracles.jets import Jet, rotation, total
from oracles.space_points import CraneCloud, Points, on, shaped


def power(jet, exponent):
    v = jet.c[0]
    return jet.through(
        v**exponent, exponent * v ** (exponent - 1.0), exponent * (exponent - 1.0) * v ** (exponent - 2.0)
    )


def apart(a, b):
    """Distance of two points."""
    return power(total((x - y) * (x - y) for x, y in zip(a, b, strict=True)), 0.5)


class LuffingCloud(CraneCloud):
    """Points of a model whose ``crane`` is the TowerCrane that it was made of; drives: slewing, luffing, rope."""

    def __init__(self, model, crane, areas=None):
        super().__init__(model, crane, areas)
        self.own = crane.luffing
        self.jib, self.jib_weights = on(crane.jib.length)

    def on_jib(self, angle, x, y, z):
        """A point of the jib in the head's plane: forward, left, up from the tower's top."""
        c, s = angle.cos(), angle.sin()
        fx, fz = self.own.foot
        return [x * c - z * s + fx, y + Jet(0.0), x * s + z * c + fz]

    def shortened(self, part):
        """Half the integral of the squared slopes, by quadrature of the squares."""
        flexible = self.model.crane
        slopes = [
            shaped(basis(self.jib, 1), part[kind])
            for basis, kind in ((flexible.lateral, "jib_lateral"), (flexible.vertical, "jib_vertical"))
        ]
        return [0.5 * (slope * slope) for slope in slopes]

    def summed(self, jet, weights):
        return Jet(*(np.sum(weights * c) for c in jet.c))

    def tied(self, part, above):
        """A point so far above the chord at the head of the bent jib, from the foot along the jib's axes."""
        flexible, length = self.model.crane, self.crane.jib.length
        nearer = total(self.summed(half, self.jib_weights) for half in self.shortened(part))
        slope = shaped(flexible.vertical(length, 1), part["jib_vertical"])
        return (
            length - nearer - above * slope,
            shaped(flexible.lateral(length), part["jib_lateral"]),
            above * (1.0 - 0.5 * (slope * slope)),
        )

    def ways(self, part, angle):
        """Lengths of luffing rope and hoist rope to the jib's head."""
        found = []
        for anchor, above in ((self.own.frame_head, self.own.attachment), (self.own.winch, 0.0)):
            head = self.on_jib(angle, *self.tied(part, above))
            found.append(apart(head, [Jet(anchor[0]), Jet(0.0), Jet(anchor[1])]))
        return found

    def energy(self, q, drives):
        """Of the luffing rope, with the jib's compression, and of weight on the shortened jib."""
        part, own, length = self.split(q), self.own, self.crane.jib.length
        angle = part["luffing"][0]
        anchor = [Jet(own.frame_head[0]), Jet(0.0), Jet(own.frame_head[1])]
        unstretched = apart(self.on_jib(drives[1], length, Jet(0.0), own.attachment), anchor)
        straight = self.on_jib(angle, length, Jet(0.0), own.attachment)
        along = (straight[0] - anchor[0]) * angle.cos() + (straight[2] - anchor[2]) * angle.sin()
        slant = along * along * power(apart(straight, anchor), -2.0)
        flexibility = unstretched * (1.0 / own.rope_stiffness) + slant * (length / own.axial_stiffness)
        stretch = self.ways(part, angle)[0] - unstretched
        energy = 0.5 * (stretch * stretch) * power(flexibility, -1.0)
        self.holding = (stretch * power(flexibility, -1.0)).c[0]
        if self.model.self_weight:
            beyond = self.crane.jib.mass_per_length * (length - self.jib) + own.tip_mass
            sinking = total(self.summed(half, self.jib_weights * beyond) for half in self.shortened(part))
            energy = energy - self.crane.gravity * (angle.sin() * sinking)
        return energy

    def points(self, q, drives, angles):
        crane, flexible, own = self.crane, self.model.crane, self.own
        part, heavy, nothing, one = self.split(q), self.model.self_weight, Jet(0.0), np.ones(1)
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
                    for row, b in zip(axes, (ux, uy, Jet(0.0)), strict=True)]  # fmt: skip

        angle, length = part["luffing"][0], crane.jib.length
        self.angle = float(np.squeeze(angle.c[0]))
        below = drives[2] - (self.ways(part, angle)[1] - own.hoist_way(length, own.reference_angle)) * (1 / own.falls)
        theta, phi = angles
        rope = [theta.sin() * phi.cos(), phi.sin(), -(theta.cos() * phi.cos())]
        hung = head(self.on_jib(angle, *self.tied(part, 0.0)))
        sides, rises = flexible.lateral(self.jib), flexible.vertical(self.jib)
        bent = self.on_jib(
            angle, Jet(self.jib), shaped(sides, part["jib_lateral"]), shaped(rises, part["jib_vertical"])
        )
        sheaves = self.on_jib(
            angle, Jet(length), shaped(flexible.lateral(length), part["jib_lateral"]), nothing
        )  # fmt: skip
        clouds = {
            "tower": Points(
                [shaped(self.bends, part["tower_x"]), shaped(self.bends[:count], part["tower_y"]), nothing],
                crane.tower.mass_per_length * self.tower_weights, heavy,
            ),
            "jib": Points(head(bent), crane.jib.mass_per_length * self.jib_weights, heavy),
            "sheaves": Points(head(sheaves), own.tip_mass * one, heavy),
            "load": Points(
                [a + below * n for a, n in zip(hung, rope, strict=True)], self.model.load.mass * one, True
            ),
        }  # fmt: skip
        counter, weights = on(crane.counter_jib_length, -crane.counter_jib_length)
        for name, x, z, mass in (
            ("counter-jib", counter, 0.0, crane.counter_jib_mass_per_length * weights),
            ("counterweight", -crane.counter_jib_length * one, 0.0, crane.counterweight * one),
            *(
                (f"body {i}", body.place[0] * one, body.place[1], body.mass * one)
                for i, body in enumerate(own.bodies)
            ),
        ):
            clouds[name] = Points(head([Jet(x), nothing, Jet(z)]), mass, heavy)
        return clouds, rope, axes, (ux, uy)

    def displace(self, q, drives):
        columns, n = super().displace(q, drives), self.model.coordinates
        for i, column in enumerate(columns):
            unit = [Jet(a, float(k == i)) for k, a in enumerate(q)]
            pushed = [Jet(d.c[0], float(len(q) + k == i)) for k, d in enumerate(drives)]
            column["stored"] = self.energy(unit[:n], pushed).c[1]
        return columns

    def left_over(self, q, rate, acceleration, drives, columns, wind):
        bare = [{name: moved for name, moved in column.items() if name != "stored"} for column in columns]
        sums, sizes = super().left_over(q, rate, acceleration, drives, bare, wind)
        stored = np.array([float(column["stored"]) for column in columns])
        return sums + stored, sizes + abs(stored)

    def blow(self, felt, wind):
        """Let points resist one wind: the jib across its chord, the counter-jib across the head."""
        (wind,) = wind
        head = np.array([[float(np.squeeze(part.c[0])) for part in row] for row in self.axes])
        c, s = np.cos(self.angle), np.sin(self.angle)
        chord = head @ [c, 0.0, s]
        across, side = wind - (wind @ chord) * chord, head[:, 1]
        press = 0.6125 * abs(wind @ side) * (wind @ side) * side
        _, weights = on(self.crane.counter_jib_length)
        felt["jib"] = (
            felt["jib"] - 0.6125 * self.areas.jib * self.jib_weights[:, None] * np.linalg.norm(across) * across
        )
        felt["counter-jib"] = felt["counter-jib"] - self.areas.counter_jib * weights[:, None] * press
        felt["counterweight"] = felt["counterweight"] - self.areas.counterweight * press
        along = 0.6125 * self.areas.tower * np.linalg.norm(wind) * wind
        felt["tower"] = felt["tower"] - self.tower_weights[:, None] * along

    def _own(self, i, q, rate, acceleration):
        return np.zeros(1) if i == self.model.parts["luffing"].start else super()._own(i, q, rate, acceleration)
