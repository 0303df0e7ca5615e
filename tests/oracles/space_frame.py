"""Tower and jib as a frame of Euler-Bernoulli beam elements in space, 12 freedoms each: frequencies without gravity.

Only the crane's data enter. Nodes have displacements x, y, z and rotations about them.
"""

import numpy as np
from scipy.linalg import eigh

STIFF = 1e12
"""Axial stiffness E A [N]: what the crane's equations take as rigid."""

SLIM = 1e-4
"""Moment of inertia about a jib element's axis per length [kg m], its torsional stiffness far above: no torsion."""


def bending(length, mass, stiffness):
    """Mass and stiffness of transverse motion, freedoms (w, w', w, w') at both ends."""
    h = length
    k = stiffness / h**3 * np.array(
        [[12, 6 * h, -12, 6 * h], [6 * h, 4 * h**2, -6 * h, 2 * h**2], [-12, -6 * h, 12, -6 * h],
         [6 * h, 2 * h**2, -6 * h, 4 * h**2]]
    )  # fmt: skip
    m = mass * h / 420 * np.array(
        [[156, 22 * h, 54, -13 * h], [22 * h, 4 * h**2, 13 * h, -3 * h**2], [54, 13 * h, 156, -22 * h],
         [-13 * h, -3 * h**2, -22 * h, 4 * h**2]]
    )  # fmt: skip
    return m, k


def element(length, mass, along_2, along_3, torsion, polar):
    """Mass and stiffness in local axes (1 along the element); along_2: E I for displacements in direction 2."""
    m, k = np.zeros((12, 12)), np.zeros((12, 12))
    bar = np.array([[1.0, -1.0], [-1.0, 1.0]]) / length
    even = np.array([[2.0, 1.0], [1.0, 2.0]]) * length / 6
    for dofs, stiff, heavy in (([0, 6], STIFF, mass), ([3, 9], torsion, polar)):
        k[np.ix_(dofs, dofs)] += stiff * bar
        m[np.ix_(dofs, dofs)] += heavy * even
    for dofs, signs, stiff in (([1, 5, 7, 11], [1, 1, 1, 1], along_2), ([2, 4, 8, 10], [1, -1, 1, -1], along_3)):
        mass_part, stiff_part = bending(length, mass, stiff)
        sign = np.outer(signs, signs)
        m[np.ix_(dofs, dofs)] += sign * mass_part
        k[np.ix_(dofs, dofs)] += sign * stiff_part
    return m, k


def turned(matrix, axes):
    """From local axes (rows of ``axes``) to fixed ones."""
    t = np.kron(np.eye(4), axes)
    return t.T @ matrix @ t


def frequencies(crane, heading, trolley, load, count, tower_elements=16, jib_elements=32):
    """Lowest frequencies [rad/s]; the load hangs on the trolley, so only its vertical motion takes part."""
    nodes = 1 + tower_elements + jib_elements
    m, k = np.zeros((6 * nodes, 6 * nodes)), np.zeros((6 * nodes, 6 * nodes))
    c, s = np.cos(heading), np.sin(heading)
    up = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    out = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    # A node of the jib stands where the trolley does.
    inner = max(1, min(jib_elements - 1, round(jib_elements * trolley / crane.jib.length)))
    stations = np.r_[
        np.linspace(0, trolley, inner + 1), np.linspace(trolley, crane.jib.length, jib_elements - inner + 1)[1:]
    ]
    tower = crane.tower
    spans = [(tower.length / tower_elements, i, i + 1, True) for i in range(tower_elements)]
    spans += [(h, tower_elements + i, tower_elements + i + 1, False) for i, h in enumerate(np.diff(stations))]
    for h, a, b, upright in spans:
        if upright:
            shaft, stiff = crane.shaft, tower.bending_stiffness
            parts = element(
                h, tower.mass_per_length, stiff, stiff, shaft.torsional_stiffness, shaft.inertia_per_length
            )
        else:
            jib = crane.jib
            parts = element(
                h, jib.mass_per_length, crane.jib_lateral.bending_stiffness, jib.bending_stiffness, 1e9, SLIM
            )
        dofs = [*range(6 * a, 6 * a + 6), *range(6 * b, 6 * b + 6)]
        for whole, part in zip((m, k), parts, strict=True):
            whole[np.ix_(dofs, dofs)] += turned(part, up if upright else out)
    head = 6 * tower_elements
    rigid = np.zeros((6, 6))
    rigid[:3, :3] = crane.counter_mass * np.eye(3)
    # Mass on the axis e1 behind the tower: v = u + w x (x e1).
    cross = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
    rigid[:3, 3:] = -crane.counter_moment * cross
    rigid[3:, :3] = rigid[:3, 3:].T
    rigid[3:, 3:] = np.diag([0.0, crane.counter_inertia, crane.counter_inertia])
    t = np.kron(np.eye(2), out)
    m[head : head + 6, head : head + 6] += t.T @ rigid @ t
    at = 6 * (tower_elements + inner)
    m[at : at + 3, at : at + 3] += np.diag([crane.trolley_mass, crane.trolley_mass, crane.trolley_mass + load])
    free = slice(6, None)
    reciprocal = eigh(m[free, free], k[free, free], eigvals_only=True)
    return 1.0 / np.sqrt(reciprocal[::-1][:count])
