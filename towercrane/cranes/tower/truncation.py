"""What the jib modes left out of a model in the plane cost, estimated without computing them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from towercrane.cranes.tower.equations.small_motions import plane_matrices

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from towercrane.cranes.tower.equations.flexible import Equations
    from towercrane.cranes.tower.modes.parameters import TowerCrane

    Floats = NDArray[np.float64]

TRUSTED = 1e-2
"""Estimate above which a mode is not representable at all and the true error may be many times larger [1]."""


def truncation_error(model: Equations, crane: TowerCrane, trolley_position: float, rope_length: float) -> Floats:
    """Estimated relative error of each natural frequency for want of further jib modes.

    Parameters
    ----------
    model : Equations
        Of the crane in the jib's plane.
    crane : TowerCrane
        That it is of.
    trolley_position, rope_length : float
        Where the trolley stands and how long the rope is [m].

    Returns
    -------
    ndarray, shape (coordinates + 1,)
        By how much each frequency is too high, relative [1]. Measured on the QTZ5613: 0.85 to 1.0 times the true
        error below 1e-3, 0.8 up to 1e-2; above `TRUSTED` the true error may be many times larger.

    Notes
    -----
    A Ritz mode leaves forces on the jib that the kept modes cannot balance: at the trolley ``lambda m_k z_c`` with
    its mass m_k and its vertical motion z_c, and along the jib ``-lambda m gamma x`` from the tower's tilt. Through
    the static flexibility of the modes left out, that is the closed form of the cantilever less the kept modes, they
    do work that lowers lambda = omega^2.
    """
    from scipy.linalg import eigh

    jib, kept, bent = crane.jib, model.crane.vertical, model.crane.tower
    mass, stiffness = plane_matrices(model, trolley_position, rope_length)
    squared, vectors = eigh(stiffness, mass)
    tower, n = bent.count, model.coordinates
    slope = model.crane.top_slope
    at_trolley, moment = kept(trolley_position), kept.mass_moments()[1]
    tilt = slope @ vectors[:tower]
    rise = at_trolley @ vectors[tower:n] - trolley_position * tilt
    force = squared * (crane.trolley_mass + model.load.mass) * rise
    turning = -squared * tilt

    x, L, EI, m = trolley_position, jib.length, jib.bending_stiffness, jib.mass_per_length
    soft = 1.0 / kept.angular_frequencies**2
    trolley = x**3 / (3 * EI) - at_trolley**2 @ soft
    mixed = m * (x**5 - 10 * L**2 * x**3 + 20 * L**3 * x**2) / (120 * EI) - (moment * at_trolley) @ soft
    along = 11 * m**2 * L**7 / (420 * EI) - moment**2 @ soft
    # Half, as this is the change of omega^2.
    change: Floats = (trolley * force**2 + 2 * mixed * force * turning + along * turning**2) / squared
    return 0.5 * change
