"""Radial equations as one would first write them in NumPy: matrices, a general solve, the swing as an angle.

The same model as :class:`towercrane.cranes.radial.RadialModel` in other coordinates and without its shortcuts. It
shows what the compiled right-hand side saves, and checks it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from towercrane.cranes import flexible_layout as layout

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from towercrane.cranes.radial import RadialModel

    Floats = NDArray[np.float64]
    Rhs = Callable[[float, Floats, Floats], Floats]


def plain_rhs(model: RadialModel) -> Rhs:
    """Right-hand side f(t, y, inputs) in y = (q, theta, q', theta'); without damping, drag and work.

    Parameters
    ----------
    model : RadialModel
        In the plane, undamped.
    """
    crane, system = model.crane, model.system
    tower, n = model.tower_modes, model.coordinates
    tip, slope, jib_mass, jib_moment = np.zeros((4, n))
    tip[:tower], slope[:tower] = model.tower(crane.tower.length), model.tower.rotation(crane.tower.length)
    jib_mass[tower:], jib_moment[tower:] = model.jib.mass_moments()
    base, stiffness = np.zeros((n, n)), system.matrices[layout.STIFFNESS]
    base[:tower, :tower], base[tower:, tower:] = model.tower.mass_matrix(), model.jib.mass_matrix()
    base += crane.slewing_mass * np.outer(tip, tip) + crane.slewing_inertia * np.outer(slope, slope)
    base -= np.outer(slope, jib_moment) + np.outer(jib_moment, slope)
    weight = crane.gravity if model.self_weight else 0.0
    static, trolley, load, gravity = crane.static_moment, crane.trolley_mass, model.load.mass, crane.gravity
    tables, width = system.tables, crane.jib.length / len(system.tables)
    powers = np.arange(tables.shape[2])
    jib = np.zeros(n, dtype=bool)
    jib[tower:] = True

    def rhs(t: float, y: Floats, inputs: Floats) -> Floats:
        q, theta, rates, turning = y[:n], y[n], y[n + 1 : -1], y[-1]
        x, xd, xdd = (np.polynomial.polynomial.polyval(t, c) for c in _derivatives(inputs[0]))
        rope, winding, hauling = (np.polynomial.polynomial.polyval(t, c) for c in _derivatives(inputs[1]))
        cell = min(max(int(x / width), 0), len(tables) - 1)
        xi = x - (cell + 0.5) * width
        phi, phi1, phi2 = np.zeros((3, n))
        phi[tower:] = tables[cell] @ xi**powers
        phi1[tower:] = tables[cell][:, 1:] @ (powers[1:] * xi ** powers[:-1])
        phi2[tower:] = tables[cell][:, 2:] @ (powers[2:] * powers[1:-1] * xi ** powers[:-2])

        gamma, turn = slope @ q, slope @ rates
        s, c = np.sin(gamma), np.cos(gamma)
        w, wd = phi @ q, phi @ rates + xd * (phi1 @ q)
        moment, moment_rate = jib_mass @ q, jib_mass @ rates
        jib_inertia = base * np.outer(jib, jib)
        coupling = -static * s + moment * c
        mass = base + (q @ jib_inertia @ q) * np.outer(slope, slope)
        mass = mass + coupling * (np.outer(tip, slope) + np.outer(slope, tip))
        mass += s * (np.outer(jib_mass, tip) + np.outer(tip, jib_mass))
        force = -stiffness @ q + turn**2 * jib_inertia @ q - weight * c * jib_mass
        force -= tip * turn * (-static * turn * c + 2.0 * moment_rate * c - moment * turn * s)
        force -= slope * (2.0 * turn * (q @ jib_inertia @ rates) - weight * (static * c + moment * s))

        e1, e3, up = np.array([c, -s]), np.array([s, c]), np.array([0.0, gravity])
        jacobian = np.outer([1.0, 0.0], tip) + np.outer(w * e1 - x * e3, slope) + np.outer(e3, phi)
        bias = (xdd + 2.0 * wd * turn - x * turn**2) * e1
        bias = bias + (2.0 * xd * (phi1 @ rates) + xdd * (phi1 @ q) + xd**2 * (phi2 @ q)) * e3
        bias -= (2.0 * xd * turn + w * turn**2) * e3
        along, across = np.array([np.sin(theta), -np.cos(theta)]), np.array([np.cos(theta), np.sin(theta)])
        swinging = np.column_stack([jacobian, rope * across])
        load_bias = bias + (hauling - rope * turning**2) * along + 2.0 * winding * turning * across

        whole, forces = np.zeros((n + 1, n + 1)), np.zeros(n + 1)
        whole[:n, :n] = mass + trolley * jacobian.T @ jacobian
        whole += load * swinging.T @ swinging
        forces[:n] = force - trolley * jacobian.T @ (bias + up)
        forces -= load * swinging.T @ (load_bias + up)
        return np.concatenate([rates, [turning], np.linalg.solve(whole, forces)])

    return rhs


def plain_state(model: RadialModel, states: Floats) -> Floats:
    """The model's states with the rope's direction as an angle, without the work; shape (p, 2 n + 2)."""
    n = model.coordinates
    q, direction, rates, swing = (
        states[:, :n],
        states[:, n : n + 2],
        states[:, n + 2 : 2 * n + 2],
        states[:, 2 * n + 2 :],
    )
    theta = np.arctan2(direction[:, 0], -direction[:, 1])
    turning = direction[:, 0] * swing[:, 1] - direction[:, 1] * swing[:, 0]
    return np.column_stack([q, theta, rates, turning])


def model_states(model: RadialModel, plain: Floats) -> Floats:
    """The reverse of :func:`plain_state`, with no work done."""
    n = model.coordinates
    theta, turning = plain[:, n], plain[:, -1]
    sine, cosine = np.sin(theta), np.cos(theta)
    return np.column_stack(
        [plain[:, :n], sine, -cosine, plain[:, n + 1 : -1], turning * cosine, turning * sine, np.zeros(len(plain))]
    )


def _derivatives(coefficients: Floats) -> tuple[Floats, Floats, Floats]:
    k = np.arange(len(coefficients))
    return coefficients, (coefficients * k)[1:], (coefficients * k * (k - 1))[2:]
