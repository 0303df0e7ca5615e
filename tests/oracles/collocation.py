"""Natural frequencies by Chebyshev collocation of the first-order beam equations: nothing in common with `modal`.

Every segment has the fields v, theta, V, M of one polynomial degree each; the equations hold at Gauss points, one
fewer than the coefficients of a field, and the four conditions a segment is left with join it to its neighbours.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg
from numpy.polynomial import chebyshev, legendre

DEFLECTION, ROTATION, FORCE, MOMENT = range(4)


class Collocation:
    """A matrix pencil ``A x = lambda B x`` with lambda the square of the circular frequency."""

    def __init__(self, degree=40):
        self.degree, self.blocks, self.size = degree, [], 0
        self.conditions = []

    def unknown(self):
        """Index of a further scalar unknown."""
        self.size += 1
        return self.size - 1

    def beam(self, segment, top_compression, gravity=0.0, theory="haringx"):
        """Add a segment; functions that give a row picking a field at its near and at its far end."""
        n = self.degree
        first = self.size
        self.size += 4 * (n + 1)
        self.blocks.append((first, segment, top_compression, gravity, theory))

        def pick(field, end):
            row = np.zeros(self.size)
            row[first + field * (n + 1) : first + (field + 1) * (n + 1)] = (
                1.0 if end == "far" else (-1.0) ** np.arange(n + 1)
            )
            return row

        return pick

    def matrices(self):
        n, size = self.degree, self.size
        points = np.cos(np.pi * (np.arange(n) + 0.5) / n)
        value = chebyshev.chebvander(points, n)
        slope = np.array([chebyshev.chebval(points, chebyshev.chebder(row)) for row in np.eye(n + 1)]).T
        stiffness, inertia = [], []
        for first, segment, top, gravity, theory in self.blocks:
            z = 0.5 * segment.length * (1.0 + points)
            breadth = 1.0 + (segment.end_ratio - 1.0) * z / segment.length
            mass = segment.mass_per_length * breadth**segment.mass_power
            bending = segment.bending_stiffness * breadth**segment.bending_power
            flexibility = 1.0 / (segment.shear_stiffness * breadth**segment.shear_power)
            rotary = segment.rotary_inertia * breadth**segment.bending_power
            compression = top + gravity * np.array([mass_between(segment, start, segment.length) for start in z])
            if theory == "haringx":
                a, b = 1.0 + compression * flexibility, flexibility
            else:
                a = 1.0 / (1.0 - compression * flexibility)
                b = a * flexibility
            d = slope * 2.0 / segment.length
            zero = np.zeros_like(d)
            # v' = a theta + b (V + g M), theta' = M / EI + g (v' - theta), V' = -lambda m v,
            # M' + V + P v' = -lambda rho I theta
            g = segment.inclined_chords * (segment.end_ratio - 1.0) / (segment.length * breadth) + segment.coupling
            left = [
                [d, -a[:, None] * value, -b[:, None] * value, -(b * g)[:, None] * value],
                [-g[:, None] * d, d + g[:, None] * value, zero, -value / bending[:, None]],
                [zero, zero, d, zero],
                [compression[:, None] * d, zero, value, d],
            ]
            right = [
                [zero] * 4,
                [zero] * 4,
                [-mass[:, None] * value, zero, zero, zero],
                [zero, -rotary[:, None] * value, zero, zero],
            ]
            for blocks, out in ((left, stiffness), (right, inertia)):
                rows = np.zeros((4 * n, size))
                rows[:, first : first + 4 * (n + 1)] = np.block(blocks)
                out.append(rows)
        for k, m in self.conditions:
            stiffness.append(widened(k, size))
            inertia.append(widened(m, size))
        return np.vstack(stiffness), np.vstack(inertia)

    def frequencies(self, count):
        """Lowest circular frequencies."""
        stiffness, inertia = self.matrices()
        assert stiffness.shape == (self.size, self.size)
        rows = np.abs(stiffness).max(axis=1)
        reciprocal = scipy.linalg.eigvals(np.linalg.solve(stiffness / rows[:, None], inertia / rows[:, None]))
        reciprocal = reciprocal[np.abs(reciprocal) > 1e-13 * np.abs(reciprocal).max()]
        real = reciprocal[(np.abs(reciprocal.imag) < 1e-6 * np.abs(reciprocal)) & (reciprocal.real > 0.0)].real
        return 1.0 / np.sqrt(np.sort(real)[::-1][:count])


def widened(row, size):
    out = np.zeros((1, size))
    out[0, : np.size(row)] = row
    return out


def mass_between(segment, near, far):
    points, weights = legendre.leggauss(40)
    z = near + 0.5 * (far - near) * (1.0 + points)
    breadth = 1.0 + (segment.end_ratio - 1.0) * z / segment.length
    return 0.5 * (far - near) * float(weights @ (segment.mass_per_length * breadth**segment.mass_power))


def node_conditions(problem, v, theta, force, moment, *, body=None, gravity=0.0, springs=(0.0, 0.0), coupling=0.0):
    """Balance of a node: what the beams pull at it with, ``force`` and ``moment``, its springs and its body."""
    size = problem.size
    v, theta, force, moment = (widened(row, size)[0] for row in (v, theta, force, moment))
    inertia_v, inertia_theta = np.zeros(size), np.zeros(size)
    if body is not None:
        m, j, h = body.mass, body.rotary_inertia, body.offset
        inertia_v = m * v + m * h * theta
        inertia_theta = m * h * v + (j + m * h * h) * theta
        moment = moment - m * gravity * h * theta
    problem.conditions.append((force + springs[0] * v + coupling * theta, inertia_v))
    problem.conditions.append((moment + springs[1] * theta + coupling * v, inertia_theta))


def collocated_chain(chain, count, degree=40):
    """Lowest circular frequencies of a `modal.beams.chain.Chain`."""
    problem = Collocation(degree)
    g, above = chain.gravity, chain.axial_load
    if chain.pendulum is not None:
        above += g * chain.pendulum.mass
    tops = []
    for k in range(len(chain.segments), 0, -1):
        above += g * chain.bodies[k].mass if k in chain.bodies else 0.0
        tops.append(above)
        above += g * mass_between(chain.segments[k - 1], 0.0, chain.segments[k - 1].length)
    beams = [
        problem.beam(segment, top, g, chain.shear_theory)
        for segment, top in zip(chain.segments, tops[::-1], strict=True)
    ]
    load = problem.unknown() if chain.pendulum is not None else None
    for node in range(len(beams) + 1):
        pick, end = (beams[node], "near") if node < len(beams) else (beams[-1], "far")
        v, theta = pick(DEFLECTION, end), pick(ROTATION, end)
        force, moment = np.zeros(problem.size), np.zeros(problem.size)
        if node > 0:
            below = [beams[node - 1](field, "far") for field in range(4)]
            force, moment = (widened(row, problem.size)[0] for row in below[2:])
            if node < len(beams):
                for row, other in ((v, below[0]), (theta, below[1])):
                    problem.conditions.append((widened(row, problem.size) - widened(other, problem.size), 0.0))
        if node < len(beams):
            force = force - widened(pick(FORCE, end), problem.size)[0]
            moment = moment - widened(pick(MOMENT, end), problem.size)[0]
        if node == len(beams) and load is not None:
            hook = np.eye(problem.size)[load]
            stretch = chain.pendulum.stiffness * (widened(v, problem.size)[0] - hook)
            force = force + stretch
            problem.conditions.append((-stretch, chain.pendulum.mass * hook))
        springs, coupling = (0.0, 0.0), 0.0
        if node in chain.collars:
            springs = chain.collars[node].stiffness, chain.collars[node].rotation_stiffness
        if node == 0:
            springs = chain.foundation.translation_stiffness, chain.foundation.rotation_stiffness
            coupling = chain.foundation.coupling
        held = [np.isinf(k) for k in springs]
        finite = [0.0 if h else k for h, k in zip(held, springs, strict=True)]
        body = chain.bodies.get(node)
        node_conditions(problem, v, theta, force, moment, body=body, gravity=g, springs=finite, coupling=coupling)
        for which, row in enumerate((v, theta)):
            if held[which]:
                problem.conditions[which - 2] = (row, 0.0)
    return problem.frequencies(count)


def collocated_crane(crane, trolley_position, count, degree=40):
    """Lowest circular frequencies of a `modal.structures.crane_frame.CraneFrame` of one uniform tower and one uniform
    jib."""
    problem = Collocation(degree)
    (tower,), (whole,) = crane.tower.segments, crane.jib.segments
    carried = crane.trolley_mass + crane.payload_mass
    head = crane.tower.bodies[1]
    weight = crane.tower.gravity * (whole.mass + head.mass + carried)
    column = problem.beam(tower, weight, crane.tower.gravity)
    near, far = (problem.beam(part, 0.0) for part in whole.split(trolley_position))
    load, size = problem.unknown(), problem.size

    def row(beam, field, end):
        return widened(beam(field, end), size)[0]

    u, gamma = row(column, DEFLECTION, "far"), row(column, ROTATION, "far")
    hook = np.eye(size)[load]
    stiffness = crane.payload_mass * crane.gravity / crane.rope_length
    along = crane.trolley_mass + whole.mass + head.mass
    problem.conditions += [
        (row(column, DEFLECTION, "near"), 0.0),
        (row(column, ROTATION, "near"), 0.0),
        (row(column, FORCE, "far") + stiffness * (u - hook), along * u),
        (row(column, MOMENT, "far") + row(near, MOMENT, "near"), head.rotary_inertia * gamma),
        (stiffness * (hook - u), crane.payload_mass * hook),
        (row(near, DEFLECTION, "near"), 0.0),
        (row(near, ROTATION, "near") + gamma, 0.0),
        (row(near, DEFLECTION, "far") - row(far, DEFLECTION, "near"), 0.0),
        (row(near, ROTATION, "far") - row(far, ROTATION, "near"), 0.0),
        (row(near, FORCE, "far") - row(far, FORCE, "near"), carried * row(far, DEFLECTION, "near")),
        (row(near, MOMENT, "far") - row(far, MOMENT, "near"), 0.0),
        (row(far, FORCE, "far"), 0.0),
        (row(far, MOMENT, "far"), 0.0),
    ]
    return problem.frequencies(count)
