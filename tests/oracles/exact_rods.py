"""A second crane for the tests: geometrically exact rods, which share no kinematics and no shapes with the models.

Shear stiffness is 12 E I / h^2, MacNeal's residual bending flexibility (1978): a row of elements then bends like an
Euler beam, and the rotation of a node is the slope there. Masses sit on the nodes in Simpson's weights, which keep
the moments of inertia exact. Trolley and load are free points: one on a stiff spring to the place on the bent jib
(cubic between nodes) that is so far along it, the other on a stiff spring as rope. Coriolis and centrifugal forces
of the drives appear nowhere: they follow from places. Only data and motions come from the crane.
"""

from dataclasses import dataclass, field, replace

import numpy as np
from oracles import rod_kernels as at
from scipy.sparse.linalg import eigs


@dataclass(frozen=True, eq=False)
class Rods:
    """Nodes and elements, undeformed with all axes along the fixed ones; the last two nodes hang where ``rail`` says.

    ``rail`` is the first of the elements that the trolley runs on, -1 without trolley and load. Nodes that neither an
    element nor a hinge holds are points.
    """

    places: np.ndarray
    nodes: np.ndarray
    ends: np.ndarray
    elements: np.ndarray
    rail: int = -1
    ropes: np.ndarray = field(default_factory=lambda: np.zeros((0, 3)))
    spans: np.ndarray = field(default_factory=lambda: np.zeros((0, 10)))
    hinges: np.ndarray = field(default_factory=lambda: np.zeros((0, 7)))

    def undeformed(self):
        state = np.zeros((len(self.nodes), 13))
        state[:, at.PLACE : at.PLACE + 3] = self.places
        state[:, at.TURN] = 1.0
        return state

    def rates(self, state, inputs):
        """Time derivative of the state, and the potential energy."""
        out, forces = np.zeros_like(state), np.zeros((len(state), 6))
        energy = at.rates(state, *self.parts, np.zeros(len(self.ropes)), self.rail, inputs, forces, out)
        return out, energy

    @property
    def parts(self):
        return self.ends, self.elements, self.nodes, self.ropes, self.spans, self.hinges

    def moved(self, state, way):
        """The state with its free places moved, and turned in the nodes' axes, by (free, 6)."""
        moved, free = state.copy(), self.free
        moved[free, at.PLACE : at.PLACE + 3] += way[:, :3]
        half = np.column_stack([np.ones(len(way)), 0.5 * way[:, 3:]])
        half /= np.linalg.norm(half, axis=1)[:, None]
        q0, q = state[free, at.TURN, None], state[free, at.TURN + 1 : at.TURN + 4]
        moved[free, at.TURN] = q0[:, 0] * half[:, 0] - (q * half[:, 1:]).sum(axis=1)
        moved[free, at.TURN + 1 : at.TURN + 4] = q0 * half[:, 1:] + half[:, :1] * q + np.cross(q, half[:, 1:])
        return moved

    @property
    def free(self):
        return np.flatnonzero(np.isfinite(self.nodes[:, at.MASS]))

    @property
    def points(self):
        held = np.concatenate([self.ends.ravel(), self.hinges[:, : at.HINGE].ravel().astype(int)])
        return np.flatnonzero(~np.isin(np.arange(len(self.nodes)), held))

    @property
    def idle(self):
        """Turns of points, which mean nothing, among the accelerations."""
        points = np.flatnonzero(np.isin(self.free, self.points))
        return (6 * points[:, None] + [3, 4, 5]).ravel()

    def accelerations(self, state, inputs):
        out = self.rates(state, inputs)[0][self.free]
        return np.concatenate([out[:, at.SPEED : at.SPEED + 3], out[:, at.SPIN : at.SPIN + 3]], axis=1).ravel()

    def gradient(self, state, inputs, small=1e-5):
        """Derivatives of the accelerations by places and turns, for a crane at rest."""
        return at.gradient(state, *self.parts, self.rail, inputs, self.free, small)

    def at_rest(self, state, inputs, loads=1):
        """Equilibrium by Newton's method, gravity put on in as many steps."""
        idle = self.idle
        for share in np.arange(1, loads + 1) / loads:
            nodes = self.nodes.copy()
            nodes[:, at.GRAVITY] *= share
            part = replace(self, nodes=nodes)
            for _ in range(20):
                slope, rest = part.gradient(state, inputs), part.accelerations(state, inputs)
                slope[idle], slope[:, idle], slope[idle, idle] = 0.0, 0.0, 1.0
                way = np.linalg.solve(slope, -rest)
                state = part.moved(state, way.reshape(-1, 6))
                if np.max(abs(way)) < 1e-7:
                    break
            else:
                raise RuntimeError(f"no equilibrium at {share:.0%} of the weight")
        return state

    def step_limit(self, state, inputs):
        """Largest stable step: the Runge-Kutta method holds the imaginary axis up to 2.83."""
        most = eigs(self.gradient(state, inputs), k=1, v0=np.ones(6 * len(self.free)), return_eigenvectors=False)
        return float(np.sqrt(8.0 / abs(most[0])))


def chain(first, places, stiffness, mass, inertias, axis, shearing=np.inf):
    """Nodes and elements of one straight uniform rod, of an even number of elements.

    ``stiffness`` is that to stretch [N], then to bending or twist about x, y and z [N m^2]; mass [kg/m] and
    ``inertias`` [kg m] about x, y and z are per length. The rod lies along ``axis``; its stiffness to shear [N] is
    the same both ways.
    """
    count = len(places) - 1
    h = np.linalg.norm(places[1] - places[0])
    simpson = h / 3.0 * np.array([1.0, *([4.0, 2.0] * (count // 2))[:-1], 1.0])
    nodes = np.zeros((count + 1, 9))
    nodes[:, at.MASS] = mass * simpson
    nodes[:, at.INERTIA : at.INERTIA + 3] = simpson[:, None] * np.asarray(inertias)
    elements = np.zeros((count, 12))
    elements[:, at.LENGTH] = h
    elements[:, at.AXIS + axis] = 1.0
    stretch, *bend = stiffness
    elements[:, at.BEND : at.BEND + 3] = bend
    # A force along one axis bends about the other.
    shear = 1.0 / (h**2 / (12.0 * np.array(bend)) + 1.0 / shearing)
    elements[:, at.SHEARED] = shear[(axis + 1) % 3] / shearing
    one, other = (k for k in range(3) if k != axis)
    elements[:, [at.STRETCH + axis, at.STRETCH + one, at.STRETCH + other]] = stretch, shear[other], shear[one]
    return nodes, np.array([[first + i, first + i + 1] for i in range(count)]), elements


TOWER_GYRATION = 0.4
"""Radius of gyration of the tower's sections in bending, which the models leave out: nodes need some [m]."""


def crane_rods(crane, load, tower=8, jib=16):
    """The crane as rods, inextensible and its jib rigid in torsion but for what the step allows.

    The sections of the jib get the crane's roll inertia about all axes; about the two others the head gives it back.
    """
    height, reach = crane.tower.length, crane.jib.length
    up = np.column_stack([np.zeros((tower + 1, 2)), np.linspace(-height, 0.0, tower + 1)])
    out = np.column_stack([np.linspace(0.0, reach, jib + 1), np.zeros((jib + 1, 2))])
    bending, lateral = crane.tower.bending_stiffness, crane.jib_lateral.bending_stiffness
    m, roll = crane.tower.mass_per_length, crane.roll_inertia / reach
    below, ends, column = chain(
        0, up, (16.0 * 12.0 * bending / (height / tower) ** 2, bending, bending, crane.shaft.torsional_stiffness), m,
        (m * TOWER_GYRATION**2, m * TOWER_GYRATION**2, crane.shaft.inertia_per_length), 2,
    )  # fmt: skip
    vertical = crane.jib.bending_stiffness
    beyond, boom_ends, boom = chain(
        tower, out, (16.0 * 12.0 * vertical / (reach / jib) ** 2, 2.0 * vertical, vertical, lateral),
        crane.jib.mass_per_length, (roll, roll, roll), 0,
    )  # fmt: skip
    column[-1, at.JOINT] = 1.0
    head = below[-1] + beyond[0]
    head[at.SHAFT] = below[-1, at.INERTIA + 2]
    head[at.MASS] += crane.counter_mass
    head[[at.INERTIA + 1, at.INERTIA + 2]] += crane.counter_inertia - crane.roll_inertia
    head[at.MOMENT] = crane.counter_moment
    below[0, at.MASS] = np.inf
    hung = np.zeros((2, 9))
    hung[:, at.MASS] = crane.trolley_mass, load
    hung[:, at.INERTIA : at.INERTIA + 3] = 1.0
    nodes = np.concatenate([below[:-1], head[None], beyond[1:], hung])
    nodes[:, at.GRAVITY] = crane.gravity
    places = np.concatenate([up, out[1:], np.zeros((2, 3))])
    return Rods(places, nodes, np.concatenate([ends, boom_ends]), np.concatenate([column, boom]), tower)


def inputs_at(motions, times):
    pairs = (("trolley", 0), ("rope", 0), ("slewing", 0), ("slewing", 1), ("slewing", 2))
    return np.stack([motions[name](times, derivative) for name, derivative in pairs], axis=1)


def at_rest(rods, inputs):
    """Equilibrium of a crane at heading 0, before the drives start."""
    inputs = np.array([inputs[at.WAY], inputs[at.ROPE], 0.0, 0.0, 0.0])
    state = rods.undeformed()
    state[-2:, at.PLACE] = inputs[at.WAY]
    # A taut rope.
    state[-1, at.PLACE + 2] = -inputs[at.ROPE] - 1e-6
    return rods.at_rest(state, inputs)


def states(rods, motions, duration, every=0.25):
    """Times and states from equilibrium at heading 0."""
    start = at_rest(rods, inputs_at(motions, np.zeros(1))[0])
    return march(rods, start, lambda times: inputs_at(motions, times), duration, every)


def march(rods, state, inputs, duration, every):
    """Times and states from one on; the step is 0.7 of the largest stable one."""
    count = int(np.ceil(every / (0.7 * rods.step_limit(state, inputs(np.zeros(1))[0]))))
    times = np.arange(round(duration / every) + 1) * every
    seen = [state]
    for begin in times[:-1]:
        state = state.copy()
        drives = inputs(begin + np.linspace(0.0, every, 2 * count + 1))
        at.march(state, *rods.parts, rods.rail, drives, every / count)
        seen.append(state)
    return times, np.array(seen)


def course(rods, motions, duration):
    """Times, and places of tower top, trolley and load from the undeformed top, (3, times, 3)."""
    times, seen = states(rods, motions, duration)
    head = rods.ends[rods.rail, 0]
    return times, seen[:, [head, -2, -1], :3].transpose(1, 0, 2)
