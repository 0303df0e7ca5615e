"""What an engineer reads off a radial run: displacements, angles, tension and energy over time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from towercrane.cranes import radial_kernel as kernel
from towercrane.results import Quantity

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.cranes.radial import RadialModel
    from towercrane.motion import Motion

    Floats = NDArray[np.float64]


def observe(
    model: RadialModel, motions: dict[str, Motion], times: Floats, states: Floats, tension: Floats
) -> dict[str, Quantity]:
    """Outputs of a run in the plane or in space.

    Parameters
    ----------
    model : RadialModel
    motions : dict
        "trolley" and "rope".
    times, states : ndarray, shapes (p,) and (p, size)
    tension : ndarray, shape (p,)

    Returns
    -------
    dict of str to Quantity
    """
    n, tower, axes = model.coordinates, model.tower_modes, model.axes
    q = states[:, :n]
    direction = states[:, n : n + axes]
    x, length = motions["trolley"](times), motions["rope"](times)
    vectors = model.system.vectors
    u, tilt = q @ vectors[kernel.TIP], q @ vectors[kernel.SLOPE]
    at_trolley = _along(model.jib(np.clip(x, 0.0, model.crane.jib.length)), q[:, tower:])
    trolley = np.stack([u + x * np.cos(tilt) + at_trolley * np.sin(tilt), np.zeros_like(x),
                        -x * np.sin(tilt) + at_trolley * np.cos(tilt)], axis=1)  # fmt: skip
    rope = np.zeros_like(trolley)
    rope[:, 0], rope[:, 2] = direction[:, 0], direction[:, -1]
    if axes == 3:
        rope[:, 1] = direction[:, 1]
    outputs = {
        "trolley_position": Quantity(("time",), x, "m", "trolley position along the jib"),
        "trolley_speed": Quantity(("time",), motions["trolley"](times, 1), "m/s", "trolley speed"),
        "rope_length": Quantity(("time",), length, "m", "rope length"),
        "tower_tip_displacement": Quantity(
            ("time",), u, "m", "horizontal displacement of the tower top, positive outward"
        ),
        "tower_tip_tilt": Quantity(("time",), tilt, "rad", "tilt of the tower top, positive: jib tip down"),
        "jib_tip_deflection": Quantity(
            ("time",),
            q[:, tower:] @ model.jib(model.crane.jib.length),
            "m",
            "deflection of the jib tip from the tilted straight jib, positive up",
        ),
        "swing_angle": Quantity(
            ("time",),
            np.arctan2(rope[:, 0], -rope[:, 2]),
            "rad",
            "swing of the rope from the vertical in the jib's plane, positive outward",
        ),
        "swing_rate": Quantity(("time",), _swing_rate(states, n, axes), "rad/s", "rate of the swing angle"),
        "rope_tension": Quantity(("time",), tension, "N", "rope tension"),
        "payload_position": Quantity(
            ("time", "axis"),
            trolley + length[:, None] * rope,
            "m",
            "load from the undeformed tower top: outward, sideways, up",
        ),
        "tower_coordinate": Quantity(
            ("time", "tower_mode"), q[:, :tower], "kg^0.5 m", "amplitude of the mass-normalised tower modes"
        ),
        "jib_coordinate": Quantity(
            ("time", "jib_mode"), q[:, tower:], "kg^0.5 m", "amplitude of the mass-normalised jib modes"
        ),
        "total_energy": Quantity(
            ("time",), total_energy(model, motions, times, states), "J", "kinetic and potential energy"
        ),
        "input_work": Quantity(
            ("time",),
            states[:, -1],
            "J",
            "work of trolley drive and winch less what damping and drag took, since the start",
        ),
    }
    if axes == 3:
        sideways = np.arcsin(np.clip(rope[:, 1], -1.0, 1.0))
        outputs["swing_angle_sideways"] = Quantity(
            ("time",), sideways, "rad", "angle of the rope out of the jib's plane"
        )
    return outputs


def total_energy(model: RadialModel, motions: dict[str, Motion], times: Floats, states: Floats) -> Floats:
    """Kinetic and potential energy of crane and load, zero level at the undeformed tower top; shape (p,) [J]."""
    n, tower, axes = model.coordinates, model.tower_modes, model.axes
    crane, system = model.crane, model.system
    base, stiffness = system.matrices[kernel.BASE], system.matrices[kernel.STIFFNESS]
    q, rates = states[:, :n], states[:, n + axes : 2 * n + axes]
    tip, slope, jib_mass = (system.vectors[row] for row in (kernel.TIP, kernel.SLOPE, kernel.JIB_MASS))
    ud, tilt, tilt_rate = rates @ tip, q @ slope, rates @ slope
    sg, cg = np.sin(tilt), np.cos(tilt)
    moment = q @ jib_mass
    square = _along((q[:, tower:] @ base[tower:, tower:]).T, q[:, tower:])
    coupling = -crane.static_moment * sg + moment * cg
    kinetic = 0.5 * _along((rates @ base).T, rates) + 0.5 * square * tilt_rate**2
    kinetic += ud * tilt_rate * coupling + ud * sg * (rates @ jib_mass)
    weight = crane.gravity if model.self_weight else 0.0
    potential = 0.5 * _along((q @ stiffness).T, q)
    potential += weight * (-crane.static_moment * sg + moment * cg)

    x, xd = np.clip(motions["trolley"](times), 0.0, crane.jib.length), motions["trolley"](times, 1)
    length, hauling = motions["rope"](times), motions["rope"](times, 1)
    w = _along(model.jib(x), q[:, tower:])
    wd = _along(model.jib(x), rates[:, tower:]) + xd * _along(model.jib(x, 1), q[:, tower:])
    along, across = xd + w * tilt_rate, wd - x * tilt_rate
    velocity = np.zeros((len(times), axes))
    velocity[:, 0] = ud + along * cg + across * sg
    velocity[:, -1] = -along * sg + across * cg
    height = -x * sg + w * cg
    direction, swing = states[:, n : n + axes], states[:, 2 * n + axes : -1]
    load_velocity = velocity + hauling[:, None] * direction + length[:, None] * swing
    trolley, load = crane.trolley_mass, model.load.mass
    kinetic += 0.5 * trolley * (velocity**2).sum(axis=1) + 0.5 * load * (load_velocity**2).sum(axis=1)
    load_height = height + length * direction[:, -1]
    potential += crane.gravity * (trolley * height + load * load_height)
    return np.asarray(kinetic + potential)


def _along(shapes: Floats, amplitudes: Floats) -> Floats:
    """sum_i shapes[i, t] amplitudes[t, i]; shape (p,)."""
    return np.asarray(np.einsum("it,ti->t", shapes, amplitudes))


def _swing_rate(states: Floats, n: int, axes: int) -> Floats:
    nx, nz = states[:, n], states[:, n + axes - 1]
    px, pz = states[:, 2 * n + axes], states[:, 2 * n + 2 * axes - 1]
    return np.asarray((nx * pz - nz * px) / (nx**2 + nz**2))
