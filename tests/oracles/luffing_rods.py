"""A crane with a jib that pivots as geometrically exact rods: ropes are springs without mass over its head.

As :mod:`oracles.exact_rods`, of which it is made. Only data and motions come from the crane.
"""

from dataclasses import dataclass

import numpy as np
from oracles import exact_rods
from oracles import rod_kernels as at
from oracles.rod_assembly import Assembly, turned

GYRATION = 0.4
"""Radius of gyration of the jib's sections, which the models leave out: nodes need some [m]."""

TWIST = 4e8
"""Of the jib to twist, which the models take for rigid [N m^2]."""

HOIST = 1e10
"""E A of the hoist rope, which the models take for inextensible [N]."""

FOOT = 1e10
"""Of the hinge at the jib's foot to turns that it does not allow [N m]."""


@dataclass(frozen=True, eq=False)
class LuffingRods:
    """Rods of a crane, and which of their nodes are the head, the jib's middle and its head; the load is the last."""

    rods: exact_rods.Rods
    crane: object
    head: int
    root: int
    middle: int
    tip: int

    def inputs(self, motions):
        """Of the rods over time."""
        own, length = self.crane.luffing, self.crane.jib.length

        def values(times):
            rope = own.falls * motions["rope"](times) + own.hoist_way(length, own.reference_angle)
            tied = np.array([own.head(length, angle, own.attachment) for angle in motions["luffing"](times)])
            held = np.hypot(*(tied - own.frame_head).T)
            slewing = [motions["slewing"](times, derivative) for derivative in range(3)]
            return np.stack([0.0 * times, rope, *slewing, held], axis=1)

        return values

    def at_rest(self, motions):
        """Equilibrium at heading 0 before the drives start."""
        own, length, rods = self.crane.luffing, self.crane.jib.length, self.rods
        angle, below = (float(motions[name](0.0)) for name in ("luffing", "rope"))
        below -= (own.hoist_way(length, angle) - own.hoist_way(length, own.reference_angle)) / own.falls
        state = rods.undeformed()
        jib = slice(self.root, self.tip + 1)
        half = np.array([np.cos(0.5 * angle), 0.0, -np.sin(0.5 * angle), 0.0])
        state[jib, at.TURN : at.TURN + 4] = half
        along = rods.places[jib] - rods.places[self.root]
        state[jib, :3] = rods.places[self.root] + turned(half, along)
        inputs = self.inputs(motions)(np.zeros(1))[0]
        weight = rods.nodes[-1, at.MASS] * rods.nodes[-1, at.GRAVITY] / own.falls**2
        state[-1, :3] = state[self.tip, :3] - [0.0, 0.0, below + weight * inputs[at.ROPE] / HOIST]
        return rods.at_rest(state, inputs)

    def seen(self, states):
        """What is compared: tower top, angle and bow of the jib, place of the load, tensions."""
        own = self.crane.luffing
        back = states[:, self.head, 3:7] * [1.0, -1.0, -1.0, -1.0]
        foot = np.array([own.foot[0], 0.0, own.foot[1]])
        tip, middle = (
            turned(back, states[:, node, :3] - states[:, self.head, :3]) - foot for node in (self.tip, self.middle)
        )
        chord = np.arctan2(tip[:, 2], tip[:, 0])
        bow = np.cos(chord) * middle[:, 2] - np.sin(chord) * middle[:, 0]
        return {"top": states[:, self.head, :3], "angle": chord, "bow": bow, "load": states[:, -1, :3],
                "tip": states[:, self.tip, :3]}  # fmt: skip

    def tension(self, states, inputs):
        """Of the luffing rope."""
        own = self.crane.luffing
        anchor, tied = np.array([own.frame_head[0], 0.0, own.frame_head[1]]), np.array([0.0, 0.0, own.attachment])
        ends = [
            states[:, node, :3] + turned(states[:, node, 3:7], np.broadcast_to(local, (len(states), 3)))
            for node, local in ((self.head, anchor), (self.tip, tied))
        ]
        return own.rope_stiffness * (np.linalg.norm(ends[1] - ends[0], axis=1) / inputs[:, at.HELD] - 1.0)


def luffing_rods(crane, load, tower=8, jib=16):
    """The crane, its tower inextensible."""
    made, own, shaft = Assembly(), crane.luffing, crane.shaft
    column, bars = made.tower(crane.tower, tower, shaft.torsional_stiffness, shaft.inertia_per_length)
    head = column[-1]
    made.nodes[head][at.SHAFT] = made.nodes[head][at.INERTIA + 2]
    made.elements[bars[-1]][at.JOINT] = 1.0
    for body in own.bodies:
        made.lump(head, body.mass, *body.place)
    arm, heavy = crane.uniform_jib, crane.jib.mass_per_length
    spin = heavy * GYRATION**2
    x, z = own.foot
    boom, _ = made.rod(
        (x, 0.0, z), (x + arm.length, 0.0, z), jib,
        (own.axial_stiffness, TWIST, arm.bending_stiffness, crane.jib_lateral.bending_stiffness), heavy, 3 * (spin,),
    )  # fmt: skip
    made.lump(boom[-1], own.tip_mass)
    hinges = [made.hinge(head, boom[0], x, z, FOOT)]
    hung = made.point(np.zeros(3), load)
    (u, w), (a, b) = own.frame_head, own.winch
    ropes = [[own.rope_stiffness, 1.0, at.HELD], [HOIST, 1.0, at.ROPE]]
    spans = [
        [0, head, boom[-1], 1.0, u, 0.0, w, 0.0, 0.0, own.attachment],
        [1, head, boom[-1], 1.0, a, 0.0, b, 0.0, 0.0, 0.0],
        [1, boom[-1], hung, own.falls, *6 * [0.0]],
    ]
    rods = made.rods(crane.gravity, -1, ropes, spans, hinges)
    return LuffingRods(rods, crane, head, boom[0], boom[len(boom) // 2], boom[-1])
