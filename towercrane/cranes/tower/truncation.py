"""What the jib modes left out of a model in the plane cost, estimated without computing them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from towercrane.cranes.tower.equations.small_motions import plane_matrices
from towercrane.cranes.tower.modes.parameters import as_chain

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from modal import Chain
    from towercrane.cranes.tower.equations.flexible import Equations
    from towercrane.cranes.tower.modes.parameters import TowerCrane

    Floats = NDArray[np.float64]

POINTS = 12
"""Of the quadrature along a section of the jib."""

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
    the static flexibility of the modes left out, that of the jib less that of the kept modes, they do work that
    lowers lambda = omega^2. Modes of the counter-jib that are left out are not counted.
    """
    from scipy.linalg import eigh

    kept, bent, first = model.crane.vertical, model.crane.tower, model.parts["jib_vertical"].start
    mass, stiffness = plane_matrices(model, trolley_position, rope_length)
    squared, vectors = eigh(stiffness, mass)
    tower, jib = bent.count, slice(first, first + kept.count)
    slope = model.crane.top_slope
    at_trolley, moment = kept(trolley_position), kept.mass_moments()[1] + kept.rotary_moments()
    tilt = slope @ vectors[:tower]
    rise = at_trolley @ vectors[jib] - trolley_position * tilt
    force = squared * (crane.trolley_mass + model.load.whole_mass) * rise
    turning = -squared * tilt

    soft = 1.0 / kept.angular_frequencies**2
    whole = flexibility(as_chain(crane.jib), trolley_position)
    parts = at_trolley**2, moment * at_trolley, moment**2
    trolley, mixed, along = (own - part @ soft for own, part in zip(whole, parts, strict=True))
    # Half, as this is the change of omega^2.
    change: Floats = (trolley * force**2 + 2 * mixed * force * turning + along * turning**2) / squared
    return 0.5 * change


def flexibility(jib: Chain, place: float) -> tuple[float, float, float]:
    """Static flexibility of a clamped jib to two loads: a unit force at a place, and its own inertia as it turns.

    Returns
    -------
    tuple of 3 float
        Work of the force on its own way, of one load on the other's, and of the inertia under a unit angular
        acceleration on its own; from bending moments and shear forces.
    """
    jib = jib.with_node(place)[0] if place > 0.0 else jib
    points, weights = np.polynomial.legendre.leggauss(POINTS)
    points, weights = 0.5 * (points + 1.0), 0.5 * weights
    found, shear, moment = np.zeros((2, 2)), 0.0, 0.0
    for k in range(len(jib.segments), 0, -1):
        segment, near, far = jib.segments[k - 1], jib.nodes[k - 1], jib.nodes[k]
        if k in jib.bodies:
            shear, moment = shear + jib.bodies[k].mass * far, moment + jib.bodies[k].rotary_inertia
        # The near end, where the next segment goes on, comes last and weighs nothing.
        x, weight = np.append(points, 0.0) * segment.length, np.append(weights, 0.0) * segment.length
        beyond = (segment.length - x)[:, None]
        inner = x[:, None] + beyond * points
        pushed = segment.section("mass_per_length", inner) * (near + inner) * beyond * weights
        turned = segment.section("rotary_inertia", inner) * beyond * weights
        shears = np.array([np.full(len(x), 1.0 * (far <= place)), shear + pushed.sum(axis=1)])
        moments = np.array([
            np.maximum(place - near - x, 0.0),
            moment + shear * beyond[:, 0] + (pushed * (inner - x[:, None]) + turned).sum(axis=1),
        ])  # fmt: skip
        strained = shears + moments * jib.incline(near + x)
        bent = moments * (weight / segment.section("bending_stiffness", x))
        slid = strained * (weight / segment.section("shear_stiffness", x))
        found += bent @ moments.T + slid @ strained.T
        shear, moment = float(shears[1, -1]), float(moments[1, -1])
    return float(found[0, 0]), float(found[0, 1]), float(found[1, 1])
