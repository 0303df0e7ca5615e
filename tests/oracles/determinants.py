"""Characteristic determinant of a chain of uniform segments in 60-digit arithmetic, from transfer matrices."""

from __future__ import annotations

from math import isinf

import mpmath

DIGITS = 60


def state_matrix(segment, compression, omega2, theory="haringx"):
    """A of ``y' = A y`` for the state (v, theta, V, M)."""
    mass, bending, rotary = map(
        mpmath.mpf, (segment.mass_per_length, segment.bending_stiffness, segment.rotary_inertia)
    )
    p = mpmath.mpf(compression)
    flexibility = mpmath.mpf(0) if isinf(segment.shear_stiffness) else 1 / mpmath.mpf(segment.shear_stiffness)
    if theory == "haringx":
        a, b = 1 + p * flexibility, flexibility
    else:
        a = 1 / (1 - p * flexibility)
        b = a * flexibility
    g = mpmath.mpf(segment.coupling)
    slope = [0, a, b, b * g]
    return mpmath.matrix(
        [
            slope,
            [0, g * (a - 1), g * b, 1 / bending + g * b * g],
            [-mass * omega2, 0, 0, 0],
            [0, -p * a - rotary * omega2, -1 - p * b, -p * b * g],
        ]
    )


def determinant(chain, omega):
    """What vanishes at a natural circular frequency of a chain of uniform segments, whose own weight is left out."""
    omega2 = mpmath.mpf(omega) ** 2
    gravity = mpmath.mpf(chain.gravity)

    def past(node, states):
        if node not in chain.bodies:
            return states
        body = chain.bodies[node]
        m, j, h = map(mpmath.mpf, (body.mass, body.rotary_inertia, body.offset))
        jump = mpmath.eye(4)
        jump[2, 0], jump[2, 1] = -omega2 * m, -omega2 * m * h
        jump[3, 0], jump[3, 1] = -omega2 * m * h, -omega2 * (j + m * h * h) - m * gravity * h
        return jump * states

    states = mpmath.zeros(4, 2)
    stiffnesses = chain.foundation.translation_stiffness, chain.foundation.rotation_stiffness
    for column, stiffness in enumerate(stiffnesses):
        if isinf(stiffness):
            states[2 + column, column] = 1
        else:
            states[column, column], states[2 + column, column] = 1, mpmath.mpf(stiffness)
    states = past(0, states)
    force, compressions = mpmath.mpf(chain.axial_load), []
    if chain.pendulum is not None:
        force += gravity * chain.pendulum.mass
    for node in range(len(chain.segments), 0, -1):
        if node in chain.bodies:
            force += gravity * chain.bodies[node].mass
        compressions.insert(0, force)
    for node, (segment, compression) in enumerate(zip(chain.segments, compressions, strict=True), start=1):
        matrix = state_matrix(segment, compression, omega2, chain.shear_theory)
        states = past(node, mpmath.expm(matrix * mpmath.mpf(segment.length)) * states)
    if chain.pendulum is not None:
        k, m = mpmath.mpf(chain.pendulum.stiffness), mpmath.mpf(chain.pendulum.mass)
        for column in (0, 1):
            states[2, column] += (k - k * k / (k - omega2 * m)) * states[0, column]
    return states[2, 0] * states[3, 1] - states[2, 1] * states[3, 0]


def has_root_within(chain, omega, relative):
    """Whether the determinant changes sign within a relative distance of a frequency."""
    with mpmath.workdps(DIGITS):
        below, above = (mpmath.mpf(omega) * (1 + sign * mpmath.mpf(relative)) for sign in (-1, 1))
        return determinant(chain, below) * determinant(chain, above) < 0
