"""Characteristic roots of a clamped beam with a rigid body at its end: none missed, none counted twice.

A uniform beam of mass mL, clamped at one end, carries a rigid body of mass M and own inertia J_G at the
other, its centre of mass H beyond the end. With x^4 = m omega^2 L^4 / (E I), ``a = M / (m L)``,
``j = J_G / (m L^3)``, ``h = H / L`` the roots x solve F = 0,

    F = (1 + cC) - a x (sC - cS) - (j + a h^2) x^3 (sC + cS) - 2 a h x^2 sS + a j x^4 (1 - cC),

c, s, C, S = cos, sin, cosh, sinh of x: the determinant of the two end conditions of Gao et al. 2023
(Eqs. 26 to 28 and A4, with the signs and powers of A4 corrected), extended by the offset h.

Signs of F alone do not find all roots, for two of them can lie closer than any step. The number of roots
below x is counted instead (Wittrick and Williams, Q. J. Mech. Appl. Math. 24 (1971)): as many as the beam
clamped at both ends has, plus the negative eigenvalues of the 2 x 2 dynamic stiffness at the end. The count
isolates a root, the sign of F then refines it.
"""

from __future__ import annotations

from math import inf
from typing import TYPE_CHECKING

import numpy as np

from modal.beams.basis import shares
from modal.checks import check_not_negative, number_in, whole_number
from modal.compiler.native import native

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from modal.compiler.kinds import Row

LARGEST_RATIO = 1e100


def characteristic_roots(
    mass_ratio: float, inertia_ratio: float, count: int, *, offset_ratio: float = 0.0
) -> NDArray[np.float64]:
    """First characteristic roots of a clamped beam with a rigid body at its end.

    Parameters
    ----------
    mass_ratio : float
        Mass of the body over that of the beam, M / (m L) [1]; ``inf`` holds its centre of mass in place.
    inertia_ratio : float
        Inertia of the body about its own centre of mass, J_G / (m L^3) [1]; ``inf`` keeps it from rotating.
    count : int
        Number of roots wanted.
    offset_ratio : float
        Distance of the centre of mass beyond the end of the beam over the beam's length [1].

    Returns
    -------
    ndarray, shape (count,)
        Roots beta L in ascending order [rad]. With an infinite ratio these are the roots of the constrained
        beam; the zero that each infinite ratio leaves behind is not among them.

    Raises
    ------
    ValueError
        If a ratio is negative, not a number or finite but above 1e100, the offset is not finite, or the
        count is below one.

    Notes
    -----
    Relative error below 2e-15, for pairs of roots that a heavy body brings next to each other too.
    """
    roots = np.empty(whole_number("count", count, 1))
    _check_ratios(mass_ratio, inertia_ratio, offset_ratio)
    _find_roots(*shares(mass_ratio), *shares(inertia_ratio), float(offset_ratio), roots)
    return roots


def count_roots_below(x: float, mass_ratio: float, inertia_ratio: float, *, offset_ratio: float = 0.0) -> int:
    """Number of characteristic roots below x, without computing them.

    Parameters
    ----------
    x : float
        Upper end of the counted range [rad].
    mass_ratio, inertia_ratio, offset_ratio : float
        As in `characteristic_roots` [1].

    Returns
    -------
    int
        Number of roots in (0, x); the zeros that infinite ratios leave behind are not counted.

    Raises
    ------
    ValueError
        If x is negative or not finite, or a ratio is out of range.
    """
    check_not_negative("x", x)
    _check_ratios(mass_ratio, inertia_ratio, offset_ratio)
    return int(_count_roots(float(x), *shares(mass_ratio), *shares(inertia_ratio), float(offset_ratio)))


def _check_ratios(mass_ratio: float, inertia_ratio: float, offset_ratio: float) -> None:
    for name, value in (("mass_ratio", mass_ratio), ("inertia_ratio", inertia_ratio)):
        number_in(name, value, "zero or more", least=0.0, most=inf)
        if LARGEST_RATIO < value < inf:
            raise ValueError(f"{name}: wanted at most {LARGEST_RATIO:g}, or inf for a fixed end, got {value!r}")
    number_in("offset_ratio", offset_ratio, "a finite number")


def _products(x: float) -> tuple[float, float, float, float, float]:
    """1 + cC, 1 - cC, sC - cS, sC + cS and sS of x, all divided by cosh x.

    Below 1.2 by power series in y = -4 x^4, since 1 - cC and sC - cS vanish there like x^4 and x^3.
    """
    if x < 1.2:
        y = -4.0 * x * x * x * x
        plus = minus = difference = total = product = 0.0
        power = 1.0  # y^k / (4k)!
        for k in range(8):
            n = 4.0 * k
            total += power / (n + 1.0)
            product += power / ((n + 1.0) * (n + 2.0))
            difference += power / ((n + 1.0) * (n + 2.0) * (n + 3.0))
            plus += power
            power *= y / ((n + 1.0) * (n + 2.0) * (n + 3.0) * (n + 4.0))
            minus -= power
        scale = 1.0 / np.cosh(x)
        return (
            scale * (1.0 + plus),
            scale * minus,
            scale * 4.0 * x * x * x * difference,
            scale * 2.0 * x * total,
            scale * 2.0 * x * x * product,
        )
    c, s, decay = np.cos(x), np.sin(x), np.exp(-x)
    t = np.tanh(x)
    sech = 2.0 * decay / (1.0 + decay * decay)
    return sech + c, sech - c, s - c * t, s + c * t, s * t


def _characteristic(x: float, a_body: float, a_beam: float, j_body: float, j_beam: float, h: float) -> float:
    """F over cosh x, (1 + a), (1 + j) and its growth with x, all of them positive.

    Where a heavy body makes two roots meet, F has almost a double zero and its rounding would blur them to
    1e-8. There the determinant is taken from the entries of the dynamic stiffness, each of which passes
    through zero singly: ``F = det(D) (1 - cC) / x^4``, D in terms of the motion of the body's centre of mass.
    """
    plus, minus, difference, total, product = _products(x)
    a_x, j_x = a_body * x, j_body * x * x * x
    if 0.0 < x < 2.0:
        force = x * x * x * total / minus
        couple = x * x * product / minus + h * force
        moment = (x * difference + h * x * x * (2.0 * product + h * x * total)) / minus
        D_11 = a_beam * force - a_x * x * x * x
        D_22 = j_beam * moment - j_x * x
        if abs(D_11) < 0.1 * a_beam * force and abs(D_22) < 0.1 * j_beam * moment:
            determinant = D_11 * D_22 - a_beam * j_beam * couple * couple
            value = determinant * minus / (x * x * x * x)
            return float(value / ((a_beam + a_x) * (j_beam + j_x)))
    value = a_beam * (j_beam * plus - j_x * total) + a_x * (j_x * minus - j_beam * difference)
    value -= a_x * j_beam * h * x * (h * x * total + 2.0 * product)
    return float(value / ((a_beam + a_x) * (j_beam + j_x)))


def _count(x: float, a_body: float, a_beam: float, j_body: float, j_beam: float, h: float) -> int:
    """Number of roots below x, those at zero that infinite ratios leave behind excepted."""
    if x == 0.0:
        return 0
    _, minus, _, total, _ = _products(x)
    # The beam clamped at both ends has one root in each (n pi, (n + 1) pi), n >= 1: 1 - cC changes sign.
    # That sign serves here and below alike, so that rounding next to such a root cannot upset the sum.
    interval = int(x / np.pi)
    pole_side = 1.0 if minus >= 0.0 else -1.0
    both_clamped = 0
    if interval >= 1:
        before = 1.0 if interval % 2 == 1 else -1.0
        both_clamped = interval - 1 if pole_side == before else interval
    determinant = _characteristic(x, a_body, a_beam, j_body, j_beam, h) * pole_side
    if determinant < 0.0:
        negative = 1
    elif a_beam * total * pole_side - a_body * x * abs(minus) < 0.0:
        negative = 2
    else:
        negative = 0
    at_zero = (1 if a_beam == 0.0 else 0) + (1 if j_beam == 0.0 else 0)
    below = both_clamped + negative - at_zero
    return below if below > 0 else 0


def _refine(low: float, high: float, a_body: float, a_beam: float, j_body: float, j_beam: float, h: float) -> float:
    """Root of F between two points of opposite sign (Brent 1973, Algorithms for Minimization, ch. 4)."""
    a, b = low, high
    fa = _characteristic(a, a_body, a_beam, j_body, j_beam, h)
    fb = _characteristic(b, a_body, a_beam, j_body, j_beam, h)
    c, fc, step, before = a, fa, b - a, b - a
    for _ in range(200):
        if (fb > 0.0) == (fc > 0.0):
            c, fc, step, before = a, fa, b - a, b - a
        if abs(fc) < abs(fb):
            a, fa, b, fb, c, fc = b, fb, c, fc, b, fb
        tolerance = 2.0 * 2.3e-16 * abs(b)
        half = 0.5 * (c - b)
        if abs(half) <= tolerance or fb == 0.0:
            break
        if abs(before) >= tolerance and abs(fa) > abs(fb):
            ratio = fb / fa
            if a == c:
                p, q = 2.0 * half * ratio, 1.0 - ratio
            else:
                q, r = fa / fc, fb / fc
                p = ratio * (2.0 * half * q * (q - r) - (b - a) * (r - 1.0))
                q = (q - 1.0) * (r - 1.0) * (ratio - 1.0)
            if p > 0.0:
                q = -q
            p = abs(p)
            if 2.0 * p < min(3.0 * half * q - abs(tolerance * q), abs(before * q)):
                before, step = step, p / q
            else:
                before = step = half
        else:
            before = step = half
        a, fa = b, fb
        b += step if abs(step) > tolerance else (tolerance if half > 0.0 else -tolerance)
        fb = _characteristic(b, a_body, a_beam, j_body, j_beam, h)
    return b


def _find(a_body: float, a_beam: float, j_body: float, j_beam: float, h: float, roots: Row) -> None:
    """Write the first roots in ascending order."""
    at_zero = (1 if a_beam == 0.0 else 0) + (1 if j_beam == 0.0 else 0)
    for k in range(1, roots.size + 1):
        # A body changes the stiffness by rank two: root n is not below root n - 2 with both ends clamped nor
        # above root n with a free end, both close to odd multiples of pi / 2.
        n = k + at_zero
        low = (n - 1.5) * np.pi - 0.2 if n >= 3 else 0.0
        high = (n - 0.5) * np.pi + 0.31
        below_low = _count(low, a_body, a_beam, j_body, j_beam, h)
        below_high = _count(high, a_body, a_beam, j_body, j_beam, h)
        middle = 0.5 * (low + high)
        while low < middle < high:
            if low > 0.0 and below_low == k - 1 and below_high == k:
                at_low = _characteristic(low, a_body, a_beam, j_body, j_beam, h)
                at_high = _characteristic(high, a_body, a_beam, j_body, j_beam, h)
                if (at_low > 0.0 > at_high) or (at_low < 0.0 < at_high):
                    middle = _refine(low, high, a_body, a_beam, j_body, j_beam, h)
                    break
            below = _count(middle, a_body, a_beam, j_body, j_beam, h)
            if below >= k:
                high, below_high = middle, below
            else:
                low, below_low = middle, below
            middle = 0.5 * (low + high)
        roots[k - 1] = middle


_find_roots, _count_roots = native("roots", _find, _count)
