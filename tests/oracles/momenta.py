"""A crane of the tower kind by Lagrange's equations with its momenta dT/dq' as states.

Momenta go on through a joint of the jib as they were: nothing here knows of a jump, nor of curvatures of the jib.
Kinetic energy is a sum of squares of speeds of points, and of rotors; derivatives are complex steps.
"""

from functools import cached_property
from itertools import pairwise
from math import factorial

import numpy as np
from numpy.polynomial.chebyshev import chebder, chebfit, chebpts1, chebval
from oracles.space_points import CraneCloud
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicHermiteSpline

STEP = 1e-30
DEGREE = 24
"""Of the polynomials that stand for shapes of the jib between two joints."""


def spin_matrix(vector):
    """Cross-product matrices, shape (..., 3, 3)."""
    x, y, z = np.moveaxis(vector, -1, 0)
    none = np.zeros_like(x)
    return np.stack([np.stack([none, -z, y], -1), np.stack([z, none, -x], -1), np.stack([-y, x, none], -1)], -2)


def turned(vector, rate):
    """exp of cross-product matrices and its rate, by power series in the squared angle."""
    k, k_rate = spin_matrix(vector), spin_matrix(rate)
    s, s_rate = (vector * vector).sum(-1)[..., None, None], 2.0 * (vector * rate).sum(-1)[..., None, None]
    values = []
    for first in (1, 2):
        terms = [(-1.0) ** m / factorial(2 * m + first) for m in range(12)]
        values.append((sum(c * s**m for m, c in enumerate(terms)),
                       s_rate * sum(c * m * s ** (m - 1) for m, c in enumerate(terms) if m)))  # fmt: skip
    (c0, d0), (c1, d1) = values
    return (
        np.eye(3) + c0 * k + c1 * k @ k,
        d0 * k + c0 * k_rate + d1 * k @ k + c1 * (k_rate @ k + k @ k_rate),
    )


class Rail:
    """Shapes of a jib, those to the left and those up, as polynomials between its joints.

    Within ``blend`` of a joint they are cubics, which have no kink.
    """

    def __init__(self, crane, blend=0.0):
        self.bases = crane.lateral, crane.vertical
        self.ends = np.array([0.0, *np.ravel([(at - blend, at + blend) for at in crane.joints]), crane.jib_length])
        self.pieces = [self._piece(k) for k in range(len(self.ends) - 1)]

    def _piece(self, k):
        begin, end = self.ends[k : k + 2]
        if end == begin:
            return None
        points = chebpts1(DEGREE + 1)
        if k % 2:
            (a, b), (c, d) = (
                np.concatenate([basis(np.array([begin, end]), order) for basis in self.bases]).T for order in (0, 1)
            )
            rows = CubicHermiteSpline([-1.0, 1.0], [a, b], 0.5 * (end - begin) * np.array([c, d]))(points)
        else:
            middle, half = 0.5 * (begin + end), 0.5 * (end - begin)
            rows = np.concatenate([basis(middle + half * points) for basis in self.bases]).T
        values = chebfit(points, rows, DEGREE)
        return values, chebder(values) * 2.0 / (end - begin)

    def at(self, x, piece):
        """Shapes and slopes, as of this piece, at a position; each as a pair, to the left and up."""
        begin, end = self.ends[piece : piece + 2]
        split, u = [self.bases[0].count], (2.0 * x - begin - end) / (end - begin)
        return [np.split(chebval(u, rows), split) for rows in self.pieces[piece]]


class Momenta:
    """A model whose ``crane`` is the TowerCrane that it was made of, with motions; its head does not turn freely."""

    def __init__(self, model, crane, motions, blend=0.0):
        self.model, self.crane, self.motions = model, crane, motions
        self.cloud, self.rail = CraneCloud(model, crane), Rail(model.crane, blend)
        self.n, self.size = model.coordinates, model.coordinates + model.axes - 1
        height = model.crane.tower_height
        self.top = model.crane.tower(height), model.crane.top_slope, model.crane.torsion(height)

    @cached_property
    def masses(self):
        """Of the speeds, in their order."""
        members = self.cloud.members.values()
        own = [np.ones(self.n), [self.crane.roll_inertia]]
        own += [np.concatenate([np.tile(m.mass, 3), m.pitch + m.yaw, m.pitch, m.yaw]) for m in members]
        hung = np.repeat([self.crane.counterweight, self.crane.trolley_mass, self.model.load.mass], 3)
        return np.concatenate([*own, hung])

    @cached_property
    def own(self):
        """What makes speeds of unit mass of the coordinates' rates: of the tower in bending and torsion."""
        found, crane = np.zeros((self.n, self.n)), self.model.crane
        matrices = {"tower_x": crane.tower.mass_matrix(), "tower_y": crane.tower.mass_matrix(),
                    "torsion": crane.torsion.mass_matrix()}  # fmt: skip
        for kind, matrix in matrices.items():
            part = self.model.parts[kind]
            found[part, part] = np.linalg.cholesky(matrix).T if part.stop > part.start else 0.0
        return found

    def moved(self, q, rates, drives, piece):
        """Speeds, and heights of what has weight with its masses: coordinates in the last axis of q and its rates."""
        crane, parts, n = self.crane, self.model.parts, self.n

        def of(kind, shapes, values):
            own = values[..., parts[kind]]
            return own @ np.asarray(shapes)[: own.shape[-1]]

        tip, slope, twist = self.top
        (x, x_rate), (length, hauled), (psi, psi_rate) = drives
        zero = 0.0 * (q[..., 0] + rates[..., 0])
        slide, slide_rate = (np.stack([of("tower_x", tip, v), of("tower_y", tip, v), zero], -1) for v in (q, rates))
        lean, lean_rate = (
            np.stack([-of("tower_y", slope, v), of("tower_x", slope, v), zero], -1) for v in (q, rates)
        )
        angle, angle_rate = of("torsion", twist, q) + psi, of("torsion", twist, rates) + psi_rate
        tilt, tilt_rate = turned(lean, lean_rate)
        c, s, one = np.cos(angle), np.sin(angle), zero + 1.0
        flat = np.stack([c, -s, zero, s, c, zero, zero, zero, one], -1)
        side = np.stack([-s, -c, zero, c, -s, zero, zero, zero, zero], -1) * angle_rate[..., None]
        around, around_rate = (rows.reshape(*zero.shape, 3, 3) for rows in (flat, side))
        axes, axes_rate = tilt @ around, tilt_rate @ around + tilt @ around_rate
        spin = np.swapaxes(axes, -1, -2) @ axes_rate
        wx, wy, wz = spin[..., 2, 1], spin[..., 0, 2], spin[..., 1, 0]

        def head(place, rate):
            """In space, of what is so in the head's axes; shape (..., 3, points)."""
            return slide[..., None] + axes @ place, slide_rate[..., None] + axes_rate @ place + axes @ rate

        shapes, slopes = self.rail.at(x, piece)
        speeds, heights, weights = [rates[..., :n] @ self.own.T, (wx + 0.0 * zero)[..., None]], [], []
        for member in self.cloud.members.values():
            both = list(zip(member.kinds, member.shapes, member.turns, strict=True))
            at = zero[..., None] + member.side * member.at
            bent, bent_rate = (
                [of(kind, s, v) if kind in parts and s.size else 0.0 * at for kind, s, _ in both] for v in (q, rates)
            )
            place, rate = head(np.stack([at, *bent], -2), np.stack([0.0 * at, *bent_rate], -2))
            left, up = (of(kind, s, rates) if kind in parts and s.size else 0.0 * at for kind, _, s in both)
            speeds += [*np.moveaxis(rate, -2, 0), wx[..., None] + 0.0 * at]
            speeds += [wy[..., None] - member.side * up, wz[..., None] + member.side * left]
            heights.append(place[..., 2, :])
            weights.append(member.mass)
        end = zero - crane.counter_jib_length
        one = np.stack([end, zero, zero], -1)[..., None]
        place, rate = head(one, 0.0 * one)
        speeds.append(rate[..., 0])
        heights.append(place[..., 2, :])
        weights.append([crane.counterweight])

        def hung(values, given):
            return [of(kind, s, values) for kind, s in zip(("jib_lateral", "jib_vertical"), given, strict=True)]

        bent, tangent = hung(q, shapes), hung(q, slopes)
        way = np.stack([zero + x, *bent], -1)[..., None]
        ran = [own + x_rate * along for own, along in zip(hung(rates, shapes), tangent, strict=True)]
        place, rate = head(way, np.stack([zero + x_rate, *ran], -1)[..., None])
        (theta, theta_rate) = q[..., n], rates[..., n]
        phi, phi_rate = (q[..., n + 1], rates[..., n + 1]) if self.model.axes == 3 else (zero, zero)
        s, c, sp, cp = np.sin(theta), np.cos(theta), np.sin(phi), np.cos(phi)
        rope = np.stack([s * cp, sp, -c * cp], -1)
        swing = np.stack([c * cp * theta_rate - s * sp * phi_rate, cp * phi_rate,
                          s * cp * theta_rate + c * sp * phi_rate], -1)  # fmt: skip
        speeds += [rate[..., 0], rate[..., 0] + hauled * rope + length * swing]
        heights += [place[..., 2, :], (place[..., 0] + length * rope)[..., 2:]]
        weights += [[crane.trolley_mass], [self.model.load.mass]]
        return np.concatenate(speeds, -1), np.concatenate(heights, -1), np.concatenate(weights)

    def drives(self, t):
        """Values and rates of trolley, rope and slewing."""
        found = [[self.motions[name](t, k) for k in (0, 1)] for name in ("trolley", "rope")]
        return [*found, [self.motions["slewing"](t, k) for k in (0, 1)] if "slewing" in self.motions else [0.0, 0.0]]

    def mass(self, q, drives, piece):
        """Mass matrix, and momenta of a crane whose coordinates stand still."""
        unit = np.vstack([np.zeros(self.size), np.eye(self.size)])
        speeds, _, _ = self.moved(np.broadcast_to(q, unit.shape), unit, drives, piece)
        columns = speeds[1:] - speeds[0]
        return (columns * self.masses) @ columns.T, columns @ (self.masses * speeds[0])

    def slope(self, t, y, piece):
        """Rates of coordinates, of the load's angles and of all momenta, the trolley on this piece of its rail."""
        q, momenta, drives = y[: self.size], y[self.size :], self.drives(t)
        matrix, carried = self.mass(q, drives, piece)
        rates = np.linalg.solve(matrix, momenta - carried)
        there = q + 1j * STEP * np.eye(self.size)
        speeds, heights, weights = self.moved(there, np.broadcast_to(rates, there.shape), drives, piece)
        energy = 0.5 * (speeds * speeds) @ self.masses - self.crane.gravity * heights @ weights
        force = energy.imag / STEP
        force[: self.n] -= self.model.angular_frequencies**2 * q[: self.n]
        return np.concatenate([rates, force])

    def run(self, q, rates, times, breaks, rtol=1e-12):
        """Coordinates and their rates at the end of a time, from those at its begin; ``breaks`` are in between."""
        ends, state = np.unique([*times, *breaks]), None
        for begin, end in pairwise(ends):
            piece = int(np.searchsorted(self.rail.ends, self.motions["trolley"](0.5 * (begin + end)), "right")) - 1
            if state is None:
                matrix, carried = self.mass(q, self.drives(begin), piece)
                state = np.concatenate([q, matrix @ rates + carried])
            found = solve_ivp(
                self.slope, (begin, end), state, method="DOP853", rtol=rtol, atol=1e-3 * rtol, args=(piece,)
            )
            state = found.y[:, -1]
        return state[: self.size], self.slope(ends[-1], state, piece)[: self.size]
