"""Tower and jib as a plane frame with trolley and hanging payload: linear natural frequencies."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from modal.elements import hermite_matrices, lowest_eigenvalues, require_elements

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from modal.beam import Beam


def frame_frequencies(
    tower: Beam,
    jib: Beam,
    *,
    head_mass: float,
    head_inertia: float,
    trolley_position: float,
    trolley_mass: float,
    payload_mass: float,
    rope_length: float,
    gravity: float = 9.81,
    count: int = 6,
    tower_elements: int = 20,
    jib_elements: int = 40,
) -> NDArray[np.float64]:
    """Natural angular frequencies of a tower and its jib in their common vertical plane.

    The tower is clamped at its foot and rigid along its axis. Its top, with deflection u and rotation gamma,
    is a rigid node that carries the jib and the rest of the slewing part. The jib leaves it level, deflects
    vertically, ``w(0) = 0`` and ``w'(0) = -gamma``, and moves along with u as a whole, as does the trolley.
    Trolley and payload weigh on the jib vertically; horizontally the payload is a pendulum hung from u.

    Parameters
    ----------
    tower, jib : Beam
        The two beams.
    head_mass : float
        Mass of what turns with the jib but for the jib itself: counter-jib, counterweight [kg].
    head_inertia : float
        Moment of inertia of the same about the top of the tower [kg m^2].
    trolley_position : float
        Distance of the trolley from the tower's axis along the jib [m].
    trolley_mass, payload_mass : float
        Masses [kg]; without a payload there is no pendulum.
    rope_length : float
        Length from trolley to payload [m].
    gravity : float
        Gravitational acceleration [m/s^2].
    count : int
        Number of frequencies.
    tower_elements, jib_elements : int
        Numbers of Hermite elements.

    Returns
    -------
    ndarray, shape (count,)
        Angular frequencies in ascending order [rad/s].

    Raises
    ------
    ValueError
        If a mass or inertia is negative or not finite, rope length or gravity is not positive, the trolley
        is off the jib, the elements are too many for the round-off floor, or too few for the count.

    Notes
    -----
    Small motions about the undeformed crane, without the effect of weight on stiffness. The first moment of
    the slewing part about the tower's axis does not enter: its weight bends the tower statically, and its
    inertia would couple to a vertical motion of the top that the rigid axis excludes.
    Kinetic energy as Gao et al. 2023, Eq. 8, with the inertial coupling of tower rotation and jib deflection
    (``-gamma' int m x w' dx`` with w measured from the tilted axis) that it lacks.
    """
    masses = {
        "head_mass": head_mass,
        "head_inertia": head_inertia,
        "trolley_mass": trolley_mass,
        "payload_mass": payload_mass,
    }
    for name, value in masses.items():
        if not 0.0 <= value < float("inf"):
            raise ValueError(f"{name}: wanted a finite number, zero or more, got {value!r}")
    for name, value in {"rope_length": rope_length, "gravity": gravity}.items():
        if not 0.0 < value < float("inf"):
            raise ValueError(f"{name}: wanted a positive finite number, got {value!r}")
    if not 0.0 <= trolley_position <= jib.length:
        raise ValueError(f"trolley_position: wanted 0 to {jib.length!r} m, got {trolley_position!r}")
    if count < 0:
        raise ValueError(f"count: wanted zero or more, got {count!r}")
    require_elements("tower_elements", tower_elements)
    require_elements("jib_elements", jib_elements)

    # Unknowns: tower nodes above the foot, jib nodes beyond the root, payload; two each for a node.
    top, rotation = 2 * tower_elements - 2, 2 * tower_elements - 1
    jib_start = 2 * tower_elements
    payload = jib_start + 2 * jib_elements
    size = payload + (1 if payload_mass > 0.0 else 0)

    stiffness, mass = np.zeros((size, size)), np.zeros((size, size))
    bending, inertia = hermite_matrices(np.linspace(0.0, tower.length, tower_elements + 1))
    stiffness[:jib_start, :jib_start] = tower.bending_stiffness * bending[2:, 2:]
    mass[:jib_start, :jib_start] = tower.mass_per_length * inertia[2:, 2:]
    mass[top, top] += head_mass + jib.mass + trolley_mass
    mass[rotation, rotation] += head_inertia

    nodes = _nodes_through(trolley_position, jib.length, jib_elements)
    bending, inertia = hermite_matrices(nodes)
    inertia = jib.mass_per_length * inertia
    at_trolley = _hermite_values(trolley_position, nodes)
    inertia += (trolley_mass + payload_mass) * np.outer(at_trolley, at_trolley)
    joint = np.zeros((2 * jib_elements + 2, size))
    joint[1, rotation] = -1.0
    joint[2:, jib_start:payload] = np.eye(2 * jib_elements)
    stiffness += joint.T @ (jib.bending_stiffness * bending) @ joint
    mass += joint.T @ inertia @ joint

    if payload_mass > 0.0:
        swing = np.zeros(size)
        swing[payload], swing[top] = 1.0, -1.0
        stiffness += payload_mass * gravity / rope_length * np.outer(swing, swing)
        mass[payload, payload] += payload_mass
    return np.sqrt(lowest_eigenvalues(stiffness, mass, count))


def _nodes_through(position: float, length: float, elements: int) -> NDArray[np.float64]:
    """Nodes of equal spacing, the inner one nearest to a position moved onto it.

    A point mass puts a jump into the beam's shear, which only a node can follow. A position within half
    an element of an end stays between nodes instead, lest an element be too short for its neighbours.
    """
    nodes = np.linspace(0.0, length, elements + 1)
    nearest = int(np.argmin(np.abs(nodes - position)))
    if 0 < nearest < elements:
        nodes[nearest] = position
    return nodes


def _hermite_values(position: float, nodes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Weights of all nodal deflections and slopes in the deflection at a position, shape (2 n + 2,)."""
    element = min(int(np.searchsorted(nodes, position, side="right")) - 1, len(nodes) - 2)
    h = float(nodes[element + 1] - nodes[element])
    s = (position - float(nodes[element])) / h
    values = np.zeros(2 * len(nodes))
    values[2 * element : 2 * element + 4] = (
        (1.0 + 2.0 * s) * (1.0 - s) ** 2,
        h * s * (1.0 - s) ** 2,
        (3.0 - 2.0 * s) * s**2,
        h * (s - 1.0) * s**2,
    )
    return values
