"""Kinetic and potential energy of a flexible crane with its load.

The kinetic energy is summed from velocities, without the equations' mass matrix: the balance of energy tests both.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from towercrane.cranes.parts.coupling import coupling_energy
from towercrane.cranes.parts.hoisting.slackening import STORED
from towercrane.cranes.tower.equations.actions.collars import meet
from towercrane.cranes.tower.equations.constants import SLEWING
from towercrane.kernels.algebra import dot, form

if TYPE_CHECKING:
    from towercrane.cranes.tower.equations.head import Head
    from towercrane.cranes.tower.modes.mass_sums import Straight
    from towercrane.cranes.tower.outputs.kinematics import Kinematics


def total_energy(at: Kinematics) -> Any:
    """Kinetic and potential energy, zero level at the undeformed tower top [J]."""
    return kinetic_energy(at) + potential_energy(at)


def kinetic_energy(at: Kinematics) -> Any:
    """Kinetic energy of crane and load [J]."""
    crane = at.seen.crane
    energy = own_energy(at) + turning_energy(at, at.head, crane.straight)
    for mass, (_, speed) in ((crane.trolley_mass, at.trolley_in_space), *at.hung):
        energy = energy + 0.5 * mass * dot(speed, speed)
    return energy


def potential_energy(at: Kinematics) -> Any:
    """Elastic energy, and weights over the undeformed tower top [J]."""
    crane, q = at.seen.crane, at.state.coordinates
    moment = crane.static_moment, *at.deflection(crane.jib_mass[crane.movers :], q)
    energy = elastic_energy(at) + crane.self_gravity * dot(at.head.rows[2], moment)
    for mass, (place, _) in ((crane.trolley_mass, at.trolley_in_space), *at.hung):
        energy = energy + crane.gravity * mass * place[2]
    return energy


def own_energy(at: Kinematics) -> Any:
    """Kinetic energy of the tower, of the drive and of what a cap adds [J]."""
    crane, rates = at.seen.crane, at.state.rates
    own = rates[: crane.movers]
    energy = 0.5 * form(own, crane.own_mass[: len(own), : len(own)], own)
    return energy + 0.5 * dot(crane.cap, [rate * rate for rate in rates])


def elastic_energy(at: Kinematics) -> Any:
    """Energy of modes, of a rope that stretches, of the drive's coupling and of collars with play [J]."""
    crane, q = at.seen.crane, at.state.coordinates
    energy = 0.5 * form(q, crane.stiffness, q)
    if crane.load.elasticity is not None:
        energy = energy + at.instant.guards[STORED]
    if (drive := crane.drive) is not None:
        twist = at.slewing[0] - at.instant.drives[SLEWING][0]
        energy = energy + coupling_energy(twist, drive.soft, drive.stiff, drive.corner)
    for met in meet(crane, q, at.instant.drives):
        energy = energy + met.energy
    return energy


def turning_energy(at: Kinematics, head: Head, straight: Straight) -> Any:
    """Kinetic energy of what turns, without trolley, in a head that moves so.

    Along each axis of the head its points at x move with v = constant + slope x + sum of bent phi(x).
    """
    crane, (wx, wy, wz), (vx, vy, vz) = at.seen.crane, head.spin, head.top
    mass, moment, roll, pitch, yaw = straight
    (left, up), (left_rates, up_rates) = at.of_jib(at.state.coordinates), at.of_jib(at.state.rates)
    jib = slice(crane.movers, crane.vertical.stop)
    energy = roll * wx * wx
    for constant, slope, inertia, bent in (
        (vx, 0.0, 0.0, [*(-wz * q for q in left), *(wy * q for q in up)]),
        (vy, wz, yaw, [*left_rates, *(-wx * q for q in up)]),
        (vz, -wy, pitch, [*(wx * q for q in left), *up_rates]),
    ):
        # Sums of m (constant + slope x)^2, of twice that times the bending, and of its square.
        energy = energy + (mass * constant * constant + 2.0 * moment * constant * slope + inertia * slope * slope)
        energy = energy + 2.0 * (constant * dot(crane.jib_mass[jib], bent) + slope * dot(crane.jib_moment[jib], bent))
        energy = energy + form(bent, crane.own_mass[jib, jib], bent)
    # The sections' own turning, beside that of the straight jib.
    turned, middle, rates = crane.jib_turning[jib], len(left), [*left_rates, *up_rates]
    energy = energy + 2.0 * (wz * dot(turned[:middle], left_rates) - wy * dot(turned[middle:], up_rates))
    energy = energy + form(rates, crane.rotary_mass[jib, jib], rates)
    return 0.5 * energy
