"""Determinant of a crane in the plane of its jib by transfer matrices: nothing in common with `modal`."""

import numpy as np
from scipy.linalg import expm


def past(body, omega2):
    """Over a body: what its inertia adds to shear force and moment."""
    jump, m, j, h = np.eye(4), body.mass, body.rotary_inertia, body.offset
    jump[2, :2], jump[3, :2] = (-omega2 * m, -omega2 * m * h), (-omega2 * m * h, -omega2 * (j + m * h * h))
    return jump


def along(segment, length, omega2):
    """Over a length of a segment, of the state (v, theta, V, M)."""
    shear = 0.0 if np.isinf(segment.shear_stiffness) else 1.0 / segment.shear_stiffness
    slopes = np.zeros((4, 4))
    slopes[0, 1:3], slopes[1, 3] = (1.0, shear), 1.0 / segment.bending_stiffness
    slopes[2, 0], slopes[3, 1:3] = -omega2 * segment.mass_per_length, (-omega2 * segment.rotary_inertia, -1.0)
    return expm(slopes * length)


def carried(chain, omega2, state, trolley=None, mass=0.0):
    """State at the end of a chain, its last body counted, from that at its begin; a mass on it at a place."""
    for node, (segment, begin) in enumerate(zip(chain.segments, chain.nodes[:-1], strict=True)):
        if node in chain.bodies:
            state = past(chain.bodies[node], omega2) @ state
        inside = trolley is not None and begin <= trolley < begin + segment.length
        first = trolley - begin if inside else segment.length
        state = along(segment, first, omega2) @ state
        if inside:
            jump = np.eye(4)
            jump[2, 0] = -omega2 * mass
            state = along(segment, segment.length - first, omega2) @ jump @ state
    last = chain.bodies.get(len(chain.segments))
    return state if last is None else past(last, omega2) @ state


def determinant(frame, trolley, omega):
    """What vanishes at a frequency of a `modal.structures.crane_frame.CraneFrame` that has no weight along itself."""
    omega2, (tower, jib, counter) = omega**2, (frame.tower, frame.jib, frame.counter_jib)
    load = frame.payload_mass
    # Shear force and moment at the tower's foot, at the jib's and at the counter-jib's.
    start = np.zeros((4, 6))
    start[2, 0] = start[3, 1] = 1.0
    top = carried(tower, omega2, start)
    u, gamma, rows = top[0], top[1], []
    roots = []
    for chain, sense, first in ((jib, -1.0, 2), (counter, 1.0, 4)):
        root = np.zeros((4, 6))
        root[1], root[2, first], root[3, first + 1] = sense * gamma, 1.0, 1.0
        place, mass = (trolley, frame.trolley_mass + load) if chain is jib else (None, 0.0)
        rows += list(carried(chain, omega2, root, place, mass)[2:])
        roots.append(root)
    spring = load * frame.gravity / frame.rope_length
    hung = spring - spring**2 / (spring - omega2 * load)
    masses = frame.trolley_mass + sum(
        sum(own.mass_per_length * own.length for own in chain.segments) + sum(b.mass for b in chain.bodies.values())
        for chain in (jib, counter)
    )
    rows += [top[2] + (hung - omega2 * masses) * u, top[3] + roots[0][3] - roots[1][3]]
    scale = np.abs(rows).max(axis=1)
    return np.linalg.det(np.array(rows) / scale[:, None])
