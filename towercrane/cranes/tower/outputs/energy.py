"""Kinetic and potential energy of a flexible crane with its load."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from towercrane.cranes.tower.kernels import layout

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.cranes.tower.outputs.kinematics import FlexibleMotion

    Floats = NDArray[np.float64]


def total_energy(motion: FlexibleMotion) -> Floats:
    """Kinetic and potential energy, zero level at the undeformed tower top; shape (p,) [J]."""
    return kinetic_energy(motion) + potential_energy(motion)


def kinetic_energy(motion: FlexibleMotion) -> Floats:
    """Kinetic energy of crane and load, shape (p,) [J]."""
    model = motion.model
    sums, own, rates = model.crane.slewing, model.system.matrices[layout.OWN], motion.rates
    jib = model.parts["jib_lateral"].start
    energy = 0.5 * np.einsum("ti,ij,tj->t", rates[:, :jib], own[:jib, :jib], rates[:, :jib])
    energy += 0.5 * rates**2 @ model.added_mass
    velocity, spin = np.zeros((len(rates), 3)), motion.spin
    velocity[:, :2] = motion.top(rates)[0]
    velocity = motion.to_head(velocity)
    moment, moment_rate = motion.first_moment(sums), motion.jib_sum(sums.first, rates)
    squares = motion.products(sums, rates, rates)
    energy += 0.5 * sums.mass * (velocity**2).sum(axis=1) + 0.5 * (squares[:, 0, 0] + squares[:, 1, 1])
    energy += (velocity * (np.cross(spin, moment) + moment_rate)).sum(axis=1)
    energy += 0.5 * np.einsum("ti,tij,tj->t", spin, motion.inertia(sums), spin)
    energy += (spin * _own_momentum(motion)).sum(axis=1)
    for mass, speed in (
        (model.crane.trolley_mass, motion.trolley_in_space[1]),
        (model.load.mass, motion.load_in_space[1]),
    ):
        energy += 0.5 * mass * (speed**2).sum(axis=1)
    return np.asarray(energy)


def potential_energy(motion: FlexibleMotion) -> Floats:
    """Elastic energy, and weights over the undeformed tower top; shape (p,) [J]."""
    model, q, crane = motion.model, motion.coordinates, motion.model.crane
    energy = 0.5 * np.einsum("ti,ij,tj->t", q, model.system.matrices[layout.STIFFNESS], q)
    weight = crane.gravity if model.self_weight else 0.0
    energy += weight * motion.to_fixed(motion.first_moment(crane.slewing))[:, 2]
    energy += crane.gravity * crane.trolley_mass * motion.trolley_in_space[0][:, 2]
    energy += crane.gravity * model.load.mass * motion.load_in_space[0][:, 2]
    if (drive := model.drive) is not None:
        twist = abs(motion.slewing[0] - motion.drive("shaft"))
        beyond, within = np.maximum(twist - drive.corner, 0.0), np.minimum(twist, drive.corner)
        energy += 0.5 * drive.soft * within**2 + drive.soft * drive.corner * beyond + 0.5 * drive.stiff * beyond**2
    return np.asarray(energy)


def _own_momentum(motion: FlexibleMotion) -> Floats:
    """Angular momentum of the jib's bending in the head's axes, sum of m s x s'; shape (p, 3)."""
    sums = motion.model.crane.slewing
    mixed = motion.products(sums, motion.coordinates, motion.rates)
    second = motion.jib_sum(sums.second, motion.rates)
    return np.stack([mixed[:, 0, 1] - mixed[:, 1, 0], -second[:, 2], second[:, 1]], axis=1)
