"""Static equilibrium by a guarded Newton method."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

MOST_STEPS = 50


SETTLED = 1e-8
"""Change of the coordinates, relative to their scale, below which no further progress is rounding."""


class Unstable(ArithmeticError):
    """No stable equilibrium was found."""


def stable_equilibrium(
    residual: Callable[[Floats], Floats],
    scale: Floats,
    contact: Callable[[Floats], tuple[Floats, Floats]] | None = None,
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
        Found from the undeformed state, to rounding.

    Raises
    ------
    Unstable
        If the tangent stiffness is not positive definite on the way, or the search does not settle.
    """
    q = np.zeros(len(scale))
    if not len(scale):
        return q
    n, steps = len(scale), np.diag(1e-5 * scale)
    around = np.hstack([-steps, steps, np.zeros((n, 1))])
    before = np.inf
    for _ in range(MOST_STEPS):
        forces = residual(q[:, None] + around)
        tangent, force = (forces[:, :n] - forces[:, n:-1]) / (2e-5 * scale), forces[:, -1]
        if contact is not None:
            pushed, held = contact(q)
            tangent, force = tangent + held, force + pushed
        if np.linalg.eigvalsh(tangent + tangent.T).min() <= 0.0:
            raise Unstable("the stiffness is not positive definite")
        change = np.linalg.solve(tangent, force)
        q = q + change
        size = float(np.max(abs(change) / scale))
        # Where a soft member holds a stiff crane, rounding ends the quadratic convergence earlier.
        if size < 1e-13 * (1.0 + np.max(abs(q) / scale)) or 0.5 * before < size < SETTLED:
            return q
        before = size
    raise Unstable("the search did not settle")
