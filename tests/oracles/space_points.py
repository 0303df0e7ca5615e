"""A flexible crane as a cloud of points whose positions follow from its coordinates: nothing else is used here.

The acceleration of each point is the second derivative of its position along the motion. The virtual work of
inertia, weight, elasticity, damping, drag and wind, for a displacement of any coordinate or drive, is what holds it.
The load is written in two angles, the tilt as the exponential of a matrix.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.polynomial.legendre import leggauss
from oracles.jets import Jet, rotation, total

from modal.beams.beam import Beam

GAUSS, FEW = leggauss(40), leggauss(16)
DRIVES = ("slewing", "trolley", "rope")
ARM = 2.0
"""Distance of a rotor's points from its middle [m]."""


def on(length, begin=0.0):
    """Gauss points and weights on [begin, begin + length]."""
    return begin + 0.5 * length * (GAUSS[0] + 1), 0.5 * length * GAUSS[1]


def shaped(shapes, amplitudes):
    return total(s * a for s, a in zip(shapes, amplitudes, strict=True))


class Member:
    """Jib or counter-jib as points: masses [kg], lengths that the wind sees [m], inertia about e2 and e3 [kg m^2].

    It is uniform, or of segments with bodies on it; it lies along e1, or with ``side`` -1 to the other side. Its
    bases are of bending to the left and up; None does not bend.
    """

    def __init__(self, name, upright, sideways, bases, side=1.0):
        self.kinds, self.side = [f"{name}_lateral", f"{name}_vertical"], side
        if isinstance(upright, Beam):
            self.at, self.length = on(upright.length)
            self.mass, (self.pitch, self.yaw) = upright.mass_per_length * self.length, np.zeros((2, len(self.at)))
        else:
            self._of_segments(upright, sideways)
        self.shapes = [np.zeros((0, 1)) if basis is None else basis(self.at) for basis in bases]
        self.turns = [np.zeros((0, 1)) if basis is None else basis.rotation(self.at) for basis in bases]
        self.reach = upright.length
        self.end = [np.zeros((0, 1)) if basis is None else basis([self.reach]) for basis in bases]

    def _of_segments(self, upright, sideways):
        points, weights = 0.5 * (FEW[0] + 1.0), 0.5 * FEW[1]
        own = [own.length for own in upright.segments]
        at = (np.array(upright.nodes[:-1])[:, None] + np.outer(own, points)).ravel()
        length, none = np.outer(own, weights).ravel(), np.zeros(len(upright.bodies))
        self.at = np.append(at, [upright.nodes[node] for node in upright.bodies])
        self.length = np.append(length, none)

        def along(chain, of_segment, of_body):
            spread = np.repeat([getattr(segment, of_segment) for segment in chain.segments], len(points))
            return np.append(spread * length, [getattr(body, of_body) for body in chain.bodies.values()])

        self.mass = along(upright, "mass_per_length", "mass")
        self.pitch, self.yaw = (along(chain, "rotary_inertia", "rotary_inertia") for chain in (upright, sideways))

    def places(self, part):
        """Along e1, e2 and e3."""
        return [Jet(self.side * self.at), *map(shaped, self.shapes, [part.get(kind, []) for kind in self.kinds])]

    def tip(self, part):
        """Place of its end."""
        return [Jet(self.side * self.reach), *map(shaped, self.end, [part.get(kind, []) for kind in self.kinds])]

    def rotors(self, part):
        """Sections and bodies spin with the member; about its axis they only roll with the head."""
        left, up = map(shaped, self.turns, [part.get(kind, []) for kind in self.kinds])
        spins = (0, self.pitch + self.yaw, 0.0), (1, self.pitch, -self.side * up), (2, self.yaw, self.side * left)
        return [rotor(*spin) for spin in spins]


def rotor(axis, inertia, turn=0.0):
    """Points that spin about an axis of the head and have inertia about this axis alone: places, 3 Jets, and masses.

    ``turn`` is the angle that each of the rotors has turned by, a Jet. Their masses add up to nothing, so it does not
    matter where on the head they are.
    """
    inertia, turn = np.atleast_1d(inertia), Jet.of(turn)
    one, (c, s) = Jet(np.ones(inertia.shape)), (turn.cos(), turn.sin())
    rim = [[c, s], [-s, c], [-c, -s], [s, -c]]
    places = [[one * 0.0, *(ARM * part for part in spoke)] for spoke in rim]
    places += [[one * (sign * ARM), one * 0.0, one * 0.0] for sign in (1.0, -1.0)] + [[one * 0.0] * 3]
    shares = (1.0, 1.0, 1.0, 1.0, -1.0, -1.0, -2.0)
    along = [
        Jet(*(np.concatenate([(one * place[k]).c[order] for place in places]) for order in range(3)))
        for k in range(3)
    ]
    return along[-axis:] + along[:-axis], np.concatenate([inertia * share for share in shares]) / (4.0 * ARM**2)


@dataclass
class Points:
    """Positions (3 Jets of shape (p,)) with their masses [kg] and whether gravity pulls."""

    place: list
    mass: np.ndarray
    heavy: bool

    def felt(self, gravity):
        """Acceleration plus gravity, shape (p, 3)."""
        rows = [np.broadcast_to(2.0 * jet.c[2], self.mass.shape) for jet in self.place]
        felt = np.stack(rows, axis=1)
        felt[:, 2] += gravity if self.heavy else 0.0
        return felt

    def derivative(self, order=1):
        return np.stack([np.broadcast_to(jet.c[order], self.mass.shape) for jet in self.place], axis=1)


class CraneCloud:
    """Points of a crane model; ``crane`` is the TowerCrane that it was made of.

    Places are absolute: that of the ground, ``ground``, is added to all.
    """

    def __init__(self, model, crane, areas=None):
        self.model, self.crane, self.areas = model, crane, areas
        flexible = model.crane
        self.ground = [Jet(0.0)] * 3
        self.height, self.tower_weights = on(flexible.tower_height)
        self.bends, self.leans = flexible.tower(self.height), flexible.tower(self.height, 1)
        self.twists = flexible.torsion(self.height)

    @cached_property
    def members(self):
        """Jib and counter-jib by name."""
        crane, flexible = self.crane, self.model.crane
        standing = crane.counter_jib or Beam(crane.counter_jib_length, crane.counter_jib_mass_per_length, 1.0, 1.0)
        ways = flexible.counter_lateral, flexible.counter_vertical
        return {
            "jib": Member("jib", crane.jib, crane.jib_lateral, (flexible.lateral, flexible.vertical)),
            "counter-jib": Member("counter_jib", standing, crane.counter_jib_lateral, ways, -1.0),
        }

    def split(self, q):
        return {kind: q[part] for kind, part in self.model.parts.items()}

    def points(self, q, drives, angles):
        """Tower, jib, counter-jib, counterweight, head, trolley, load: Points by name; rope direction; head."""
        crane, flexible = self.crane, self.model.crane
        part = self.split(q)
        own = self.model.self_weight

        tip, slope = flexible.tower(flexible.tower_height), flexible.tower(flexible.tower_height, 1)
        ux, uy = shaped(tip, part["tower_x"]), shaped(tip[: len(part["tower_y"])], part["tower_y"])
        lean_x = shaped(slope, part["tower_x"])
        lean_y = shaped(slope[: len(part["tower_y"])], part["tower_y"])
        slewing = part["slewing"][0] if len(part["slewing"]) else drives[0]
        turn = shaped(flexible.torsion(flexible.tower_height), part["torsion"]) + slewing
        tilt = rotation(-lean_y, lean_x, Jet(0.0))
        c, s = turn.cos(), turn.sin()
        axes = [[row[0] * c + row[1] * s, row[1] * c - row[0] * s, row[2]] for row in tilt]

        def head(x, y, z):
            shift = (ux, uy, Jet(0.0))
            return [a[0] * x + a[1] * y + a[2] * z + b for a, b in zip(axes, shift, strict=True)]

        x, length = drives[1], drives[2]

        def at_trolley(basis, amplitudes):
            values = [basis(x.c[0], k) for k in range(3)]
            return total(
                x.through(values[0][i], values[1][i], values[2][i]) * a for i, a in enumerate(amplitudes)
            )  # fmt: skip

        hung = head(
            x, at_trolley(flexible.lateral, part["jib_lateral"]), at_trolley(flexible.vertical, part["jib_vertical"])
        )
        theta, phi = angles
        rope = [theta.sin() * phi.cos(), phi.sin(), -(theta.cos() * phi.cos())]
        nothing, one = Jet(0.0), np.ones(1)
        clouds = {
            "tower": Points(
                [shaped(self.bends, part["tower_x"]), shaped(self.bends[: len(part["tower_y"])], part["tower_y"]),
                 nothing],
                crane.tower.mass_per_length * self.tower_weights, own,
            ),
            "counterweight": Points(head(*self.members["counter-jib"].tip(part)), crane.counterweight * one, own),
            "trolley": Points(hung, crane.trolley_mass * one, True),
            "load": Points(
                [a + length * n for a, n in zip(hung, rope, strict=True)], self.model.load.mass * one, True
            ),
        }  # fmt: skip
        spins = [("head", rotor(0, crane.roll_inertia))]
        for name, member in self.members.items():
            clouds[name] = Points(head(*member.places(part)), member.mass, own)
            spins += [(f"{name}, rotor {k}", own) for k, own in enumerate(member.rotors(part))]
        clouds |= {name: Points(head(*places), mass, False) for name, (places, mass) in spins}
        for cloud in clouds.values():
            cloud.place = [own + base for own, base in zip(cloud.place, self.ground, strict=True)]
        return clouds, rope, axes, (ux, uy)

    def displace(self, q, drives):
        """How points, and the rope's direction, move with each coordinate, angle and drive: a list of dicts."""
        n, columns, ground = self.model.coordinates, [], self.ground
        # What is displaced is so at one time.
        self.ground = [Jet(0.0)] * 3
        for i in range(len(q) + len(drives)):
            unit = [Jet(a, float(k == i)) for k, a in enumerate(q)]
            pushed = [Jet(d.c[0], float(len(q) + k == i)) for k, d in enumerate(drives)]
            moved, turned, _, _ = self.points(unit[:n], pushed, unit[n:])
            column = {name: cloud.derivative() for name, cloud in moved.items()}
            columns.append(column | {"rope": np.array([jet.c[1] for jet in turned]).ravel()})
        self.ground = ground
        return columns

    def left_over(self, q, rate, acceleration, drives, columns, wind):
        """Work that inertia and all given forces leave over, per unit displacement of each of the ``columns``.

        ``q`` and its derivatives end with the load's two angles; ``drives`` are Jets of DRIVES. Returns the sums and
        the sums of absolute values. What every point resists stays in ``felt``, the points in ``now``.
        """
        model, load = self.model, self.model.load
        n, gravity = model.coordinates, self.crane.gravity
        moving = [Jet(a, b, 0.5 * c) for a, b, c in zip(q, rate, acceleration, strict=True)]
        self.now, rope, self.axes, _ = self.points(moving[:n], drives, moving[n:])
        self.felt = felt = {name: cloud.mass[:, None] * cloud.felt(gravity) for name, cloud in self.now.items()}
        wind = np.atleast_2d(wind)
        relative = self.now["load"].derivative() - wind[-1]
        felt["load"] = felt["load"] + load.drag * np.linalg.norm(relative) * relative
        if self.areas is not None:
            self.blow(felt, wind)
        swing = np.array([jet.c[1] for jet in rope]).ravel()
        sums, sizes = [], []
        for i, column in enumerate(columns):
            terms = [(felt[name] * column[name]).ravel() for name in felt]
            terms.append(load.rope_damping * swing * column["rope"])
            if i < n:
                terms.append(self._own(i, q[:n], rate[:n], acceleration[:n]))
            flat = np.concatenate(terms)
            sums.append(flat.sum())
            sizes.append(abs(flat).sum())
        return np.array(sums), np.array(sizes)

    def blow(self, felt, wind):
        """Let points resist winds."""
        across = np.array([row[1].c[0] for row in self.axes]).ravel()
        # Of several winds the first is the tower's, then those of the counter-jib's end, the jib's root and tip.
        turning = [wind[0]] * 3 if len(wind) == 1 else wind[1:4]
        pressing = [0.5 * 1.225 * abs(own @ across) * (own @ across) for own in turning]
        ends = -self.crane.counter_jib_length, 0.0, self.crane.jib.length

        def press(at):
            return np.interp(at, ends, pressing)[:, None] * across

        for name, area in (("jib", self.areas.jib), ("counter-jib", self.areas.counter_jib)):
            member = self.members[name]
            felt[name] = felt[name] - area * member.length[:, None] * press(member.side * member.at)
        felt["counterweight"] = felt["counterweight"] - self.areas.counterweight * press(ends[:1])
        along = 0.5 * 1.225 * self.areas.tower * np.linalg.norm(wind[0]) * wind[0]
        felt["tower"] = felt["tower"] - self.tower_weights[:, None] * along

    def _own(self, i, q, rate, acceleration):
        """Elasticity, damping, inertia of torsion and drive, and the weight's softening of one coordinate."""
        model, flexible = self.model, self.model.crane
        kind = next(k for k, part in model.parts.items() if part.start <= i < part.stop)
        first = model.parts[kind].start
        if kind == "slewing":
            return np.array([model.drive_inertia * acceleration[i]])
        basis = {
            "tower_x": flexible.tower, "tower_y": flexible.tower, "torsion": flexible.torsion,
            "jib_lateral": flexible.lateral, "counter_jib_lateral": flexible.counter_lateral,
            "jib_vertical": flexible.vertical, "counter_jib_vertical": flexible.counter_vertical,
        }[kind]  # fmt: skip
        ratio = getattr(model.damping, kind.replace("jib_", "").removesuffix("_x").removesuffix("_y"))
        omega = basis.angular_frequencies[i - first]
        terms = [omega**2 * q[i], 2.0 * ratio * omega * rate[i]]
        own = model.parts[kind]
        if kind == "torsion":
            per_length = flexible.torsion.shaft.inertia_per_length * self.tower_weights
            terms += list(per_length * self.twists[i - first] * (acceleration[own] @ self.twists))
        if kind.startswith("tower") and model.weight_softening:
            hung = self.crane.trolley_mass + model.load.mass + self.crane.slewing_mass
            above = hung + self.crane.tower.mass_per_length * (flexible.tower_height - self.height)
            lean = q[own] @ self.leans
            falls = self.crane.gravity + 2.0 * self.ground[2].c[2]
            terms += list(-falls * above * self.tower_weights * self.leans[i - first] * lean)
        return np.array(terms)

    def accelerations(self, q, rate, drives, columns, wind, given):
        """Second derivatives of coordinates and angles, and their mass matrix; ``given`` forces are a drive's."""
        size, n = len(q), self.model.coordinates
        rest, _ = self.left_over(q, rate, np.zeros(size), drives, columns, wind)
        mass = np.zeros((size, size))
        for name, cloud in self.now.items():
            moves = np.array([column[name] for column in columns[:size]])
            mass += np.einsum("ipk,p,jpk->ij", moves, cloud.mass, moves)
        for i in range(n):
            for j in range(n):
                unit, none = np.eye(n)[j], np.zeros(n)
                mass[i, j] += self._own(i, none, none, unit).sum()
        scale = 1.0 / np.sqrt(np.diag(mass))
        return scale * np.linalg.solve(mass * np.outer(scale, scale), scale * (given - rest[:size])), mass
