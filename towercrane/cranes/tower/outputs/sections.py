"""Forces and moments in sections of a flexible crane: root of the jib, top and base of the tower.

They follow from the acceleration of every mass beyond the section (d'Alembert), not from curvatures, which need many
more modes for the same accuracy. Weights act where the deflected crane carries them.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from towercrane.cranes.tower.kernels import layout
from towercrane.motions.motion import phases
from towercrane.simulation.integrate import evaluate

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.cranes.tower.modes.mass_sums import MassSums
    from towercrane.cranes.tower.outputs.kinematics import FlexibleMotion

    Floats = NDArray[np.float64]

SHORTEST = 1e-6
"""Span [s] that stands for none, in a run that ended at its start."""


@dataclass(frozen=True, eq=False)
class SectionLoads:
    """What sections carry over the times of a run, as force and moment on the part beyond; rows for p times.

    Parameters
    ----------
    motion : FlexibleMotion
    tension : ndarray, shape (p,)
        Of the rope [N].
    """

    motion: FlexibleMotion
    tension: Floats

    @cached_property
    def accelerations(self) -> Floats:
        """Second derivatives of the structural coordinates, shape (p, n)."""
        motion, model = self.motion, self.motion.model
        span = max(float(motion.times[-1]), SHORTEST)
        driven = phases(tuple(motion.motions[channel] for channel in model.channels), span)
        slopes, _ = evaluate(model.system, driven, motion.times, motion.states)
        n, rates = model.coordinates, model.coordinates + model.axes
        return slopes[:, rates : rates + n]

    @cached_property
    def head_acceleration(self) -> tuple[Floats, Floats]:
        """Of the tower's top and the angular one, in the head's axes; shapes (p, 3)."""
        motion = self.motion
        straight, tilting = motion.top(self.accelerations)
        turning = motion.along(layout.TURN, ("torsion", "slewing"), self.accelerations)
        head = motion.head
        spin = head.spin_bias + tilting[:, :1] * head.turn_x + tilting[:, 1:] * head.turn_y
        spin[:, 2] += turning
        return motion.to_head(np.column_stack([straight, np.zeros(len(spin))])), spin

    @cached_property
    def hung(self) -> tuple[Floats, Floats]:
        """Force that the jib exerts on trolley and load, and its moment about the tower's top, in the head's axes."""
        motion, crane = self.motion, self.motion.model.crane
        (place, rate), (_, xd), xdd = motion.suspension, motion.trolley, motion.drive("trolley", 2)
        q, qd = motion.coordinates, motion.rates
        own = np.zeros_like(place)
        own[:, 0] = xdd
        shapes, slopes = motion.shapes
        own[:, 1:] = motion.deflection(shapes, self.accelerations) + 2.0 * xd[:, None] * motion.deflection(slopes, qd)
        bent = motion.deflection(motion.shapes_at_trolley(2), q)
        own[:, 1:] += xdd[:, None] * motion.deflection(slopes, q) + xd[:, None] ** 2 * bent
        straight, turning = self.head_acceleration
        spin = motion.spin
        acceleration = straight + np.cross(turning, place) + np.cross(spin, np.cross(spin, place))
        acceleration += 2.0 * np.cross(spin, rate) + own
        force = crane.trolley_mass * (acceleration + crane.gravity * motion.axes[:, 2])
        load, length = motion.model.load, motion.drive("rope")
        # The damper where the rope hangs pulls the load back and the trolley along, and its couple turns the jib.
        across = motion.swing - (motion.swing * motion.rope).sum(axis=1)[:, None] * motion.rope
        pull = self.tension[:, None] * motion.rope + load.rope_damping / length[:, None] * across
        force -= motion.to_head(pull)
        couple = -load.rope_damping * motion.to_head(np.cross(motion.rope, across))
        return force, np.cross(place, force) + couple

    def turning_part(self, sums: MassSums, exposure: MassSums | None) -> tuple[Floats, Floats]:
        """Force on a part of the head, and moment about the tower's top, in the head's axes; shapes (p, 3)."""
        motion, model = self.motion, self.motion.model
        q, qd, qdd = motion.coordinates, motion.rates, self.accelerations
        (straight, turning), spin = self.head_acceleration, motion.spin
        weight = model.crane.gravity if model.self_weight else 0.0
        felt = straight + weight * motion.axes[:, 2]
        moment, inertia = motion.first_moment(sums), motion.inertia(sums)
        rate, second = motion.jib_sum(sums.first, qd), motion.jib_sum(sums.first, qdd)
        force = sums.mass * felt + np.cross(turning, moment) + np.cross(spin, np.cross(spin, moment))
        force += 2.0 * np.cross(spin, rate) + second
        torque = np.einsum("tij,tj->ti", inertia, turning) + np.cross(moment, felt)
        torque += np.cross(spin, np.einsum("tij,tj->ti", inertia, spin))
        mixed, momentum = motion.products(sums, qd, q), motion.jib_sum(sums.second, qd)
        swell = (mixed[:, 0, 0] + mixed[:, 1, 1])[:, None] * spin - momentum * spin[:, :1]
        swell[:, 1:] -= np.einsum("tij,tj->ti", mixed, spin[:, 1:])
        torque += 2.0 * swell
        product, far = motion.products(sums, q, qdd), motion.jib_sum(sums.second, qdd)
        torque += np.stack([product[:, 0, 1] - product[:, 1, 0], -far[:, 2], far[:, 1]], axis=1)
        if exposure is not None:
            normal = (self.wind * motion.axes[:, :, 1]).sum(axis=1)
            press = abs(normal) * normal
            force[:, 1] -= exposure.mass * press
            torque[:, 2] -= exposure.moment * press
            torque[:, 0] += motion.jib_sum(exposure.first, q)[:, 2] * press
        return force, torque

    @property
    def wind(self) -> Floats:
        """Velocity of the air [m/s], shape (p, 3)."""
        return np.stack([self.motion.drive(f"wind_{axis}") for axis in "xyz"], axis=1)

    @cached_property
    def jib_root(self) -> tuple[Floats, Floats]:
        """Force and moment at the root of the jib, in the head's axes; shapes (p, 3)."""
        crane = self.motion.model.crane
        force, moment = self.turning_part(crane.jib, crane.jib_exposure)
        return force + self.hung[0], moment + self.hung[1]

    @cached_property
    def tower_top(self) -> tuple[Floats, Floats]:
        """Force and moment at the top of the tower, in the head's axes; shapes (p, 3)."""
        crane = self.motion.model.crane
        force, moment = self.turning_part(crane.counter, crane.counter_exposure)
        return force + self.jib_root[0], moment + self.jib_root[1]

    @cached_property
    def base(self) -> tuple[Floats, Floats]:
        """Force of the ground on the crane, and moment about the tower's foot, in fixed axes; shapes (p, 3)."""
        motion, model, crane = self.motion, self.motion.model, self.motion.model.crane
        force, moment = (motion.to_fixed(part) for part in self.tower_top)
        top = np.column_stack([motion.top(motion.coordinates)[0], np.full(len(force), crane.tower_height)])
        moment = moment + np.cross(top, force)
        (zeroth, first), spin = crane.tower_moments, crane.tower.rotary_moments()
        parts, mass = model.parts, model.system.matrices[layout.OWN]
        weight = crane.gravity if model.self_weight else 0.0
        height = crane.tower_height
        q, qdd = motion.coordinates, self.accelerations
        force[:, 2] += weight * crane.tower_mass
        force[:, :2] += motion.of_tower(zeroth, qdd)
        tipping = motion.of_tower(first + spin, qdd) - weight * motion.of_tower(zeroth, q)
        moment[:, 0] -= tipping[:, 1]
        moment[:, 1] += tipping[:, 0]
        if model.counts["tower_y"]:
            x, y = parts["tower_x"], parts["tower_y"]
            moment[:, 2] += np.einsum("ti,ij,tj->t", q[:, x], mass[y, y], qdd[:, y])
            moment[:, 2] -= np.einsum("ti,ij,tj->t", q[:, y], mass[x, x], qdd[:, x])
        moment[:, 2] += qdd[:, parts["torsion"]] @ crane.torsion.mass_moment()
        press = crane.tower_drag * np.linalg.norm(self.wind, axis=1)[:, None] * self.wind
        swayed = motion.of_tower(crane.tower.deflection_integrals(), q)
        swept = np.column_stack([swayed, np.full(len(force), 0.5 * height**2)])
        return force - height * press, moment - np.cross(swept, press)
