"""A crane in the plane as one would first write it in NumPy: matrices, a general solve, the swing as an angle.

The same model as :class:`towercrane.cranes.tower.model.FlexibleModel` in other coordinates and without its shortcuts.
It shows what the compiled right-hand side saves, and checks it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from towercrane.cranes.tower.model import FlexibleModel

    Floats = NDArray[np.float64]
    Rhs = Callable[[float, Floats, Floats], Floats]


class Balance:
    """Balance of forces of a plane, undamped crane in (q, theta): M (q'', theta'') = f.

    Parameters
    ----------
    model : FlexibleModel
    """

    def __init__(self, model: FlexibleModel) -> None:
        crane, tower, n = model.crane, model.counts["tower_x"], model.coordinates
        tip, slope, jib_mass, jib_moment = np.zeros((4, n))
        tip[:tower], slope[:tower] = crane.tower(crane.tower_height), crane.top_slope
        jib_mass[tower:], jib_moment[tower:] = crane.vertical.mass_moments()
        base = np.zeros((n, n))
        base[:tower, :tower], base[tower:, tower:] = crane.tower.mass_matrix(), crane.vertical.mass_matrix()
        base += crane.slewing.mass * np.outer(tip, tip) + crane.slewing.pitch * np.outer(slope, slope)
        base -= np.outer(slope, jib_moment) + np.outer(jib_moment, slope)
        jib = np.arange(n) >= tower
        self.tip, self.slope, self.jib_mass, self.base = tip, slope, jib_mass, base
        self.jib_inertia = base * np.outer(jib, jib)
        self.stiffness = model.constants.stiffness
        self.weight = crane.gravity if model.self_weight else 0.0
        self.static, self.gravity = crane.slewing.moment, crane.gravity
        self.trolley, self.load = crane.trolley_mass, model.load.mass

    def __call__(self, y: Any, tilt: Any, swing: Any, trolley: Any, hoist: Any, shapes: Any) -> tuple[Any, Any]:
        """Mass matrix and forces at a state (q, theta, q', theta'), of numbers or of expressions alike.

        Parameters
        ----------
        y : ndarray, shape (2 n + 2,)
        tilt, swing : tuple
            Sine and cosine of the head's tilt, ``slope @ q``, and of theta.
        trolley, hoist : tuple
            Position of the trolley and length of the rope, each with two derivatives.
        shapes : ndarray, shape (3, n)
            Shapes of the jib at the trolley and two derivatives; zero for those of the tower.

        Returns
        -------
        tuple of ndarray, shapes (n + 1, n + 1) and (n + 1,)
        """
        tip, slope, jib_mass, jib_inertia = self.tip, self.slope, self.jib_mass, self.jib_inertia
        n, static, weight = len(tip), self.static, self.weight
        q, rates, turning = y[:n], y[n + 1 : -1], y[-1]
        (s, c), (sine, cosine), (x, xd, xdd), (rope, winding, hauling) = tilt, swing, trolley, hoist
        phi, phi1, phi2 = shapes
        turn = slope @ rates
        w, wd = phi @ q, phi @ rates + xd * (phi1 @ q)
        moment, moment_rate = jib_mass @ q, jib_mass @ rates
        coupling = -static * s + moment * c
        mass = self.base + (q @ jib_inertia @ q) * np.outer(slope, slope)
        mass = mass + coupling * (np.outer(tip, slope) + np.outer(slope, tip))
        mass = mass + s * (np.outer(jib_mass, tip) + np.outer(tip, jib_mass))
        force = -self.stiffness @ q + turn**2 * (jib_inertia @ q) - weight * c * jib_mass
        force = force - tip * (turn * (-static * turn * c + 2.0 * moment_rate * c - moment * turn * s))
        force = force - slope * (2.0 * turn * (q @ jib_inertia @ rates) - weight * (static * c + moment * s))

        e1, e3, up = np.array([c, -s]), np.array([s, c]), np.array([0.0, self.gravity])
        jacobian = np.outer([1.0, 0.0], tip) + np.outer(w * e1 - x * e3, slope) + np.outer(e3, phi)
        bias = (xdd + 2.0 * wd * turn - x * turn**2) * e1
        bias = bias + (2.0 * xd * (phi1 @ rates) + xdd * (phi1 @ q) + xd**2 * (phi2 @ q)) * e3
        bias = bias - (2.0 * xd * turn + w * turn**2) * e3
        along, across = np.array([sine, -cosine]), np.array([cosine, sine])
        swinging = np.column_stack([jacobian, rope * across])
        load_bias = bias + (hauling - rope * turning**2) * along + 2.0 * winding * turning * across

        whole = self.load * (swinging.T @ swinging)
        whole[:n, :n] += mass + self.trolley * (jacobian.T @ jacobian)
        forces = -self.load * (swinging.T @ (load_bias + up))
        forces[:n] += force - self.trolley * (jacobian.T @ (bias + up))
        return whole, forces


def plain_rhs(model: FlexibleModel) -> Rhs:
    """Right-hand side f(t, y, inputs) in y = (q, theta, q', theta'); without damping, drag and work.

    Parameters
    ----------
    model : FlexibleModel
        In the plane, undamped.
    """
    balance, tower, n = Balance(model), model.counts["tower_x"], model.coordinates
    tables, width = model.system.table, model.crane.jib_length / len(model.system.table)
    powers = np.arange(tables.shape[2])

    def rhs(t: float, y: Floats, inputs: Floats) -> Floats:
        trolley, hoist = (
            [np.polynomial.polynomial.polyval(t, c) for c in derivatives(channel)] for channel in inputs[:2]
        )
        cell = min(max(int(trolley[0] / width), 0), len(tables) - 1)
        xi = trolley[0] - (cell + 0.5) * width
        shapes = np.zeros((3, n))
        shapes[0, tower:] = tables[cell] @ xi**powers
        shapes[1, tower:] = tables[cell][:, 1:] @ (powers[1:] * xi ** powers[:-1])
        shapes[2, tower:] = tables[cell][:, 2:] @ (powers[2:] * powers[1:-1] * xi ** powers[:-2])
        gamma, theta = balance.slope @ y[:n], y[n]
        tilt, swing = (np.sin(gamma), np.cos(gamma)), (np.sin(theta), np.cos(theta))
        return np.concatenate([y[n + 1 :], np.linalg.solve(*balance(y, tilt, swing, trolley, hoist, shapes))])

    return rhs


def plain_state(model: FlexibleModel, states: Floats) -> Floats:
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


def model_states(model: FlexibleModel, plain: Floats) -> Floats:
    """The reverse of :func:`plain_state`, with no work done."""
    n = model.coordinates
    theta, turning = plain[:, n], plain[:, -1]
    sine, cosine = np.sin(theta), np.cos(theta)
    return np.column_stack(
        [plain[:, :n], sine, -cosine, plain[:, n + 1 : -1], turning * cosine, turning * sine, np.zeros(len(plain))]
    )


def derivatives(coefficients: Any) -> tuple[Any, Any, Any]:
    """Coefficients of a polynomial, lowest power first, and of its first two derivatives."""
    k = np.arange(len(coefficients))
    return coefficients, (coefficients * k)[1:], (coefficients * k * (k - 1))[2:]
