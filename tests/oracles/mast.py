"""A mast that shears, on springs, tied to a building, with a body and a swinging load on its top, shaken: by Ritz.

Deflection and rotation are polynomials of their own on every piece. Coordinates are absolute: what shakes the mast is
that the ground of its springs moves. Nothing of the program is used.
"""

from itertools import pairwise

import numpy as np
from numpy.polynomial import Legendre
from numpy.polynomial.legendre import leggauss
from scipy.linalg import eigh


class Mast:
    """Mass and stiffness in absolute coordinates; the last is the load's way.

    Parameters
    ----------
    pieces : list of float
        Lengths from the foot up [m]; bodies and collars are at their ends.
    mass, bending, shear, rotary : float
        Per length [kg/m], [N m^2], [N], [kg m].
    ground : (float, float, float)
        Springs under the foot: sideways, coupled, rotation.
    bodies : dict of int to (float, float, float)
        Mass, rotary inertia and offset by node.
    collars : dict of int to (float, float)
        Springs by node against deflection and rotation.
    load, pendulum : float
        Mass of a load that hangs from the top [kg], and what pulls it under it [N/m].
    """

    def __init__(self, pieces, mass, bending, shear, rotary, ground, bodies, collars, load, pendulum, degree=14):
        terms, count = degree + 1, len(pieces)
        size = 2 * terms * count + 1
        self.mass, self.stiffness = np.zeros((size, size)), np.zeros((size, size))
        points, weights = leggauss(degree + 2)
        basis = [Legendre.basis(k) for k in range(terms)]
        values, slopes = (np.array([f(points) for f in fs]) for fs in (basis, [f.deriv() for f in basis]))
        ends = np.array([[f(x) for f in basis] for x in (-1.0, 1.0)])
        self.nodes = np.zeros((count + 1, 2, size))
        joins = []
        for piece, length in enumerate(pieces):
            first = 2 * terms * piece
            v, t = slice(first, first + terms), slice(first + terms, first + 2 * terms)
            half = 0.5 * length
            self.mass[v, v] += mass * half * (values * weights) @ values.T
            self.mass[t, t] += rotary * half * (values * weights) @ values.T
            strain = np.vstack([slopes / half, -values])
            self.stiffness[first : first + 2 * terms, first : first + 2 * terms] += (
                shear * half * (strain * weights) @ strain.T
            )
            self.stiffness[t, t] += bending / half * (slopes * weights) @ slopes.T
            begin = np.zeros((2, size))
            begin[0, v], begin[1, t] = ends[0], ends[0]
            if piece:
                joins.append(begin - self.nodes[piece])
            else:
                self.nodes[0] = begin
            self.nodes[piece + 1, 0, v], self.nodes[piece + 1, 1, t] = ends[1], ends[1]
        for node, (own, inertia, offset) in bodies.items():
            moved, turned = self.nodes[node, 0] + offset * self.nodes[node, 1], self.nodes[node, 1]
            self.mass += own * np.outer(moved, moved) + inertia * np.outer(turned, turned)
        # What moves all but the load alike.
        self.along = np.zeros(size)
        self.along[[2 * terms * piece for piece in range(count)]] = 1.0
        self.mass[-1, -1] += load
        hangs = self.nodes[-1, 0].copy()
        hangs[-1] -= 1.0
        self.stiffness += pendulum * np.outer(hangs, hangs)
        # What a displacement of the ground pulls at.
        self.pulled = np.zeros(size)
        foot, tilt = self.nodes[0]
        sideways, coupled, rotation = ground
        self.stiffness += sideways * np.outer(foot, foot) + rotation * np.outer(tilt, tilt)
        self.stiffness += coupled * (np.outer(foot, tilt) + np.outer(tilt, foot))
        self.pulled += sideways * foot + coupled * tilt
        self.at_foot = sideways * foot + coupled * tilt, sideways
        self.collars = collars
        for node, (sideways, rotation) in collars.items():
            v, t = self.nodes[node]
            self.stiffness += sideways * np.outer(v, v) + rotation * np.outer(t, t)
            self.pulled += sideways * v
        joined = np.eye(size)
        if joins:
            joined = np.linalg.svd(np.concatenate(joins))[2][2 * len(joins) :].T
        reciprocal, shapes = eigh(joined.T @ self.mass @ joined, joined.T @ self.stiffness @ joined)
        self.omega = 1.0 / np.sqrt(reciprocal[::-1])
        # Of unit modal mass.
        self.shapes = joined @ shapes[:, ::-1] * self.omega

    def shaken(self, step, accelerations):
        """Absolute coordinates at the knots of a ground whose acceleration is linear between them; also its way.

        Each mode is solved exactly: under a cubic f its particular solution is (f - f''/w^2)/w^2.
        """
        omega, pull = self.omega, self.shapes.T @ self.pulled
        q, rate, way, speed = np.zeros_like(omega), np.zeros_like(omega), 0.0, 0.0
        rows, ways = [self.shapes @ q], [way]
        c, s = np.cos(omega * step), np.sin(omega * step)
        for a, b in pairwise(accelerations):
            cubic = np.polynomial.Polynomial([way, speed, 0.5 * a, (b - a) / (6.0 * step)])

            def particular(t, order=0, cubic=cubic):
                value = cubic.deriv(order) if order else cubic
                return pull / omega**2 * value(t) - pull / omega**4 * cubic.deriv(2 + order)(t)

            free, moving = q - particular(0.0), rate - particular(0.0, 1)
            q = free * c + moving / omega * s + particular(step)
            rate = moving * c - omega * free * s + particular(step, 1)
            way, speed = float(cubic(step)), float(cubic.deriv()(step))
            rows.append(self.shapes @ q)
            ways.append(way)
        return np.array(rows), np.array(ways)
