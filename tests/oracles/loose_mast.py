"""A mast that collars hold with play, in its plane: exact between contacts, whose instants are found as roots.

Which collars the mast presses on, and to which side, is its state; in each it is linear, and solved by the modes of
the mast on those collars. Nothing of the program is used.
"""

from functools import cache
from itertools import pairwise

import numpy as np
from scipy.optimize import brentq


class LooseMast:
    """A mast and its collars.

    Parameters
    ----------
    make : callable
        The :class:`oracles.mast.Mast` on collars: a mapping of nodes to springs against deflection and rotation.
    collars : dict of int to (float, float)
        Stiffness and play by node.
    """

    def __init__(self, make, collars):
        self.collars = collars
        self.mast = cache(lambda held: make({node: (collars[node][0], 0.0) for node in held}))
        self.contacts = 0

    def way(self, mast, node, x, ground):
        """Of the mast from the middle of a collar."""
        return x @ mast.nodes[node, 0] - ground

    def run(self, step, accelerations, looks=200):
        """Absolute coordinates at the knots of a ground whose acceleration is linear between them; also its way."""
        sides = dict.fromkeys(self.collars, 0)
        mast = self.mast(())
        q, rate, way, speed = np.zeros_like(mast.omega), np.zeros_like(mast.omega), 0.0, 0.0
        rows, ways = [mast.shapes @ q], [way]
        for a, b in pairwise(accelerations):
            cubic = np.polynomial.Polynomial([way, speed, 0.5 * a, (b - a) / (6.0 * step)])
            q, rate, mast, sides = self.through(cubic, step, looks, q, rate, mast, sides)
            way, speed = float(cubic(step)), float(cubic.deriv()(step))
            rows.append(mast.shapes @ q)
            ways.append(way)
        return np.array(rows), np.array(ways)

    def through(self, ground, step, looks, q, rate, mast, sides):
        """State after a step of the ground."""
        begin = 0.0
        while begin < step:
            flow = self.flow(mast, sides, ground, begin, q, rate)
            times = np.linspace(begin, step, max(2, round(looks * (step - begin) / step)) + 1)[1:]
            found = [self.parting(flow, ground, node, sides, begin, times) for node in self.collars]
            end = min(time for time, _, _ in found)
            q, rate = flow(end)
            if end < step:
                node, side = min(found)[1:]
                sides = {**sides, node: side}
                self.contacts += side != 0
                after = self.mast(tuple(node for node, side in sides.items() if side))
                change = after.shapes.T @ after.mass @ mast.shapes
                q, rate, mast = change @ q, change @ rate, after
            begin = end
        return q, rate, mast, sides

    def flow(self, mast, sides, ground, begin, q, rate):
        """Modal coordinates and rates at times since the step began, from those at its beginning."""
        omega, pull = mast.omega, mast.shapes.T @ mast.pulled
        push = np.zeros(len(mast.shapes))
        for node, (stiffness, gap) in self.collars.items():
            push += sides[node] * stiffness * gap * mast.nodes[node, 0]
        steady = mast.shapes.T @ push / omega**2

        def particular(t, order=0):
            value = ground.deriv(order) if order else ground
            found = np.multiply.outer(value(t), pull / omega**2)
            found -= np.multiply.outer(ground.deriv(2 + order)(t), pull / omega**4)
            return found if order else found + steady

        free, moving = q - particular(begin), rate - particular(begin, 1)

        def at(t):
            c, s = (f(np.multiply.outer(np.subtract(t, begin), omega)) for f in (np.cos, np.sin))
            places = c * free + s * (moving / omega) + particular(t)
            return places, c * moving - s * (omega * free) + particular(t, 1)

        at.row = lambda node: mast.nodes[node, 0] @ mast.shapes
        return at

    def parting(self, flow, ground, node, sides, begin, times):
        """When the mast meets a collar or leaves it, the collar, and to which side it is then."""
        row, gap, side = flow.row(node), self.collars[node][1], sides[node]

        def margin(t):
            way = flow(t)[0] @ row - ground(t)
            return side * way - gap if side else gap - abs(way)

        below = np.flatnonzero(margin(times) < 0.0)
        if not len(below):
            return times[-1], 0, 0
        high = float(times[below[0]])
        low = float(times[below[0] - 1]) if below[0] else begin + 1e-9 * (high - begin)
        time = brentq(margin, low, high, xtol=1e-15) if margin(low) > 0.0 else low
        way = float(flow(time)[0] @ row - ground(time))
        return time, node, 0 if side else int(np.sign(way))
