"""Static equilibrium by a guarded Newton method."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Residual = Callable[[Floats], Floats]
    Contact = Callable[[Floats], tuple[Floats, Floats]]

MOST_STEPS = 50

SHORTEST = 1.0 / 1024.0
"""Share of the forces by which they grow at least, where they do not act all at once."""

FAR = 0.5
"""Distance from where the stiffness leads, beside the way there, beyond which a place is another one."""

SETTLED = 1e-8
"""Change of the coordinates, relative to their scale, below which no further progress is rounding."""


class Unstable(ArithmeticError):
    """No stable equilibrium was found."""


def stable_equilibrium(
    residual: Residual,
    scale: Floats,
    contact: Contact | None = None,
) -> Floats:
    """Coordinates at which the forces vanish and any small displacement is resisted.

    Parameters
    ----------
    residual : callable
        Generalised forces at coordinates; both of shape (n, p), a column for each of p places.
    scale : ndarray, shape (n,)
        Size of each coordinate that belongs to about a metre or a radian.
    contact : callable, optional
        Forces besides, shape (n,), of springs that are met at a way, and their stiffness, shape (n, n), at
        coordinates of shape (n,): their corners are no place for differences.

    Returns
    -------
    ndarray, shape (n,)
        Found from the undeformed state, to rounding; where the whole of the forces leads astray, as they grow.

    Raises
    ------
    Unstable
        If the tangent stiffness is not positive definite on the way, or the search does not settle.
    """
    q = np.zeros(len(scale))
    if not len(scale):
        return q
    first, share, step = None, 0.0, 1.0
    while share < 1.0:
        grown = min(share + step, 1.0)
        tangent, force = _tangent(residual, scale, contact, q)
        _check(tangent)
        first = force[:, None] if first is None else first
        expected = np.linalg.solve(tangent, (grown - share) * first[:, 0])
        try:
            found = _settled(partial(_less, residual, (1.0 - grown) * first), scale, contact, q)
            # A place far from the expected one is another: beyond a load that buckles, a crane may stand somewhere.
            if np.max(abs(found - q - expected) / scale) > FAR * np.max(abs(expected) / scale) + SETTLED:
                raise Unstable("no equilibrium is near as the forces grow")
        except Unstable:
            step = 0.5 * step
            if step < SHORTEST:
                raise
        else:
            q, share, step = found, grown, 2.0 * step
    return q


def _less(residual: Residual, missing: Floats, q: Floats) -> Floats:
    return residual(q) - missing


def _settled(residual: Residual, scale: Floats, contact: Contact | None, q: Floats) -> Floats:
    """Coordinates to which Newton's steps lead, all of them where the stiffness is positive definite."""
    before = np.inf
    for _ in range(MOST_STEPS):
        tangent, force = _tangent(residual, scale, contact, q)
        _check(tangent)
        change = np.linalg.solve(tangent, force)
        q = q + change
        size = float(np.max(abs(change) / scale))
        # Where a soft member holds a stiff crane, rounding ends the quadratic convergence earlier.
        if size < 1e-13 * (1.0 + np.max(abs(q) / scale)) or 0.5 * before < size < SETTLED:
            return q
        before = size
    raise Unstable("the search did not settle")


def _tangent(residual: Residual, scale: Floats, contact: Contact | None, q: Floats) -> tuple[Floats, Floats]:
    """Tangent stiffness and forces at coordinates."""
    n, steps = len(scale), np.diag(1e-5 * scale)
    forces = residual(q[:, None] + np.hstack([-steps, steps, np.zeros((n, 1))]))
    tangent, force = (forces[:, :n] - forces[:, n:-1]) / (2e-5 * scale), forces[:, -1]
    if contact is None:
        return tangent, force
    pushed, held = contact(q)
    return tangent + held, force + pushed


def _check(tangent: Floats) -> None:
    if np.linalg.eigvalsh(tangent + tangent.T).min() <= 0.0:
        raise Unstable("the stiffness is not positive definite")
