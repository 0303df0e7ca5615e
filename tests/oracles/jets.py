"""Truncated power series: exact derivatives of whatever is written in terms of them."""

import numpy as np


class Jet:
    """c0 + c1 e + c2 e^2 with arrays of equal shape as coefficients."""

    __array_priority__ = 1000

    def __init__(self, *coefficients):
        parts = [np.asarray(c, dtype=float) for c in coefficients]
        parts += [np.zeros(())] * (3 - len(parts))
        self.c = np.broadcast_arrays(*parts)

    @staticmethod
    def of(value):
        return value if isinstance(value, Jet) else Jet(value)

    def __add__(self, other):
        return Jet(*(a + b for a, b in zip(self.c, Jet.of(other).c, strict=True)))

    __radd__ = __add__

    def __neg__(self):
        return Jet(*(-a for a in self.c))

    def __sub__(self, other):
        return self + -Jet.of(other)

    def __rsub__(self, other):
        return -self + other

    def __mul__(self, other):
        a, b = self.c, Jet.of(other).c
        return Jet(a[0] * b[0], a[0] * b[1] + a[1] * b[0], a[0] * b[2] + a[1] * b[1] + a[2] * b[0])

    __rmul__ = __mul__

    def through(self, value, first, second):
        """A function of this with these derivatives at c0."""
        a = self.c
        return Jet(value, first * a[1], first * a[2] + 0.5 * second * a[1] ** 2)

    def sin(self):
        s, c = np.sin(self.c[0]), np.cos(self.c[0])
        return self.through(s, c, -s)

    def cos(self):
        s, c = np.sin(self.c[0]), np.cos(self.c[0])
        return self.through(c, -s, -c)


def total(jets):
    result = Jet(0.0)
    for jet in jets:
        result = result + jet
    return result


def product(a, b):
    """Matrix product of lists of rows."""
    return [[total(x * y for x, y in zip(row, column, strict=True)) for column in zip(*b, strict=True)] for row in a]


def rotation(x, y, z):
    """exp of the cross-product matrix of a vector of Jets, by its power series."""
    cross = [[Jet(0.0), -z, y], [z, Jet(0.0), -x], [-y, x, Jet(0.0)]]
    power = result = [[Jet(float(i == j)) for j in range(3)] for i in range(3)]
    for k in range(1, 22):
        power = [[v * (1.0 / k) for v in row] for row in product(power, cross)]
        result = [[a + b for a, b in zip(r, p, strict=True)] for r, p in zip(result, power, strict=True)]
    return result
