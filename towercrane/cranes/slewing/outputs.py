"""What an engineer reads off a lumped crane: sway, moments, torques and energy over time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from towercrane.cranes.slewing import kernel
from towercrane.cranes.tower.kernels.drive import coupling_torque
from towercrane.results.recording import Quantity, load_places

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.cranes.slewing.description import Point
    from towercrane.cranes.slewing.equations import Equations
    from towercrane.motions.motion import Motion

    Floats = NDArray[np.float64]


def observe(
    model: Equations, motions: dict[str, Motion], times: Floats, states: Floats, tension: Floats
) -> dict[str, Quantity]:
    """Outputs of a run.

    Parameters
    ----------
    model : Equations
    motions : dict
        "shaft" and "rope".
    times, states : ndarray, shapes (p,) and (p, size)
    tension : ndarray, shape (p,)
    """
    crane, drive, n = model.crane, model.crane.drive, model.coordinates
    rates = (model.size - 1) // 2
    q, qd = states[:, :n], states[:, rates : rates + n]
    direction = states[:, model.rope : model.rope + 3]
    direction = direction / np.linalg.norm(direction, axis=1)[:, None]
    heading = q[:, crane.coordinates.index(crane.jib_angle)]
    outward = direction[:, 0] * np.cos(heading) + direction[:, 1] * np.sin(heading)
    sideways = direction[:, 1] * np.cos(heading) - direction[:, 0] * np.sin(heading)
    down = -direction[:, 2]
    driven = crane.coordinates.index(drive.on)
    shaft, shaft_rate = motions["shaft"](times), motions["shaft"](times, 1)
    elastic = -coupling_torque(q[:, driven] - shaft, drive.soft, drive.stiff, drive.corner)
    total = elastic - drive.damping * (qd[:, driven] - shaft_rate)
    length = motions["rope"](times)
    stretched = length + states[:, n] if model.elastic else length
    hung, _ = position(model, crane.points[crane.suspension], q, qd)

    def over_time(values: Floats, units: str, name: str) -> Quantity:
        return Quantity(("time",), values, units, name)

    outputs = {
        "sway_tangential": over_time(
            np.arctan2(sideways, down),
            "rad",
            "sway across the jib, atan2(across, down), positive in the turning sense",
        ),
        "sway_radial": over_time(
            np.arctan2(outward, down), "rad", "sway along the jib, atan2(along, down), positive outward"
        ),
        "shaft_angle": over_time(shaft, "rad", "angle of the drive's shaft, referred to the platform"),
        "shaft_speed": over_time(shaft_rate, "rad/s", "speed of the drive's shaft, referred to the platform"),
        "drive_torque": over_time(total, "N m", "torque through the coupling with its damper, positive driving"),
        "drive_torque_elastic": over_time(elastic, "N m", "torque of the coupling's spring alone, positive driving"),
        "rope_length": over_time(length, "m", "length of the unstretched rope"),
        "rope_tension": over_time(tension, "N", "rope tension"),
    }
    for name, output in crane.linear_outputs.items():
        values = q @ crane.row(output.of)[:-1] + qd @ crane.row(output.of_rates)[:-1]
        outputs[name] = over_time(values, output.units, output.long_name)
    for i, name in enumerate(crane.coordinates):
        unit = "rad" if name in crane.angles else "m"
        outputs[name] = over_time(q[:, i], unit, f"coordinate: {name.replace('_', ' ')}")
    outputs |= {
        **load_places(hung + stretched[:, None] * direction, heading, "the slewing axis"),
        "total_energy": over_time(total_energy(model, motions, times, states), "J", "kinetic and potential energy"),
        "input_work": over_time(
            states[:, -1], "J", "work of shaft and winch less what dampers, friction and drag took, since the start"
        ),
    }
    return outputs


def position(model: Equations, point: Point, q: Floats, qd: Floats) -> tuple[Floats, Floats]:
    """Position and velocity of a point over time; shapes (p, 3)."""
    crane = model.crane
    place, velocity = np.zeros((len(q), 3)), np.zeros((len(q), 3))
    for link in point.links:
        ahead, across = crane.row(link.ahead), crane.row(link.across)
        arm = q @ ahead[:-1] + ahead[-1] + 1j * (q @ across[:-1] + across[-1])
        rate = qd @ ahead[:-1] + 1j * (qd @ across[:-1])
        turned = crane.coordinates.index(link.turns_with) if link.turns_with else None
        unit = np.exp(1j * q[:, turned]) if turned is not None else np.ones(len(q), dtype=complex)
        turning = qd[:, turned] if turned is not None else np.zeros(len(q))
        w, wd = unit * arm, unit * (rate + 1j * turning * arm)
        place[:, 0] += w.real
        place[:, 1] += w.imag
        velocity[:, 0] += wd.real
        velocity[:, 1] += wd.imag
    height = crane.row(point.height)
    place[:, 2], velocity[:, 2] = q @ height[:-1] + height[-1], qd @ height[:-1]
    return place, velocity


def total_energy(model: Equations, motions: dict[str, Motion], times: Floats, states: Floats) -> Floats:
    """Kinetic and potential energy of crane, coupling and load; shape (p,) [J]."""
    crane, drive, n = model.crane, model.crane.drive, model.coordinates
    rates = (model.size - 1) // 2
    q, qd = states[:, :n], states[:, rates : rates + n]
    energy = 0.5 * qd**2 @ crane.row(crane.inertias)[:-1] - q @ crane.row(crane.steady_force)[:-1]
    stiffness = model.system.matrices[kernel.STIFFNESS]
    energy = energy + 0.5 * np.einsum("ti,ij,tj->t", q, stiffness, q)
    for point in crane.points.values():
        place, velocity = position(model, point, q, qd)
        energy += point.mass * (0.5 * (velocity**2).sum(axis=1) + crane.gravity * place[:, 2])
    place, velocity = position(model, crane.points[crane.suspension], q, qd)
    length, haul = motions["rope"](times), motions["rope"](times, 1)
    if model.elastic:
        stretch, stretching = states[:, n], states[:, rates + n]
        energy += 0.5 * crane.rope_stiffness * stretch**2
        length, haul = length + stretch, haul + stretching
    rope = model.rope
    direction, swing = states[:, rope : rope + 3], states[:, rates + rope : rates + rope + 3]
    place = place + length[:, None] * direction
    velocity = velocity + haul[:, None] * direction + length[:, None] * swing
    energy += model.load.mass * (0.5 * (velocity**2).sum(axis=1) + crane.gravity * place[:, 2])
    twist = abs(q[:, crane.coordinates.index(drive.on)] - motions["shaft"](times))
    beyond = np.maximum(twist - drive.corner, 0.0)
    within = np.minimum(twist, drive.corner)
    coupling = 0.5 * drive.soft * within**2 + drive.soft * drive.corner * beyond + 0.5 * drive.stiff * beyond**2
    return np.asarray(energy + coupling)
