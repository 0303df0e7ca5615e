"""What an engineer reads off a radial run: displacements, angles, tension and energy over time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from towercrane.cranes.tower.kernels import layout
from towercrane.cranes.tower.outputs.energy import total_energy
from towercrane.cranes.tower.outputs.kinematics import FlexibleMotion
from towercrane.results.recording import Quantity

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.cranes.tower.equations.flexible import Equations
    from towercrane.motions.motion import Motion

    Floats = NDArray[np.float64]


def observe(
    model: Equations, motions: dict[str, Motion], times: Floats, states: Floats, guards: Floats
) -> dict[str, Quantity]:
    """Outputs of a run in the plane or in space.

    Parameters
    ----------
    model : Equations
    motions : dict
        "trolley" and "rope".
    times, states, guards : ndarray, shapes (p,), (p, size) and (p, guards)

    Returns
    -------
    dict of str to Quantity
    """
    motion = FlexibleMotion(model, motions, times, states)
    u, tilt = motion.top(motion.coordinates)
    rope, swing, tower = motion.rope, motion.swing, model.counts["tower_x"]

    def over_time(values: Floats, units: str, name: str) -> Quantity:
        return Quantity(("time",), values, units, name)

    rate = (rope[:, 0] * swing[:, 2] - rope[:, 2] * swing[:, 0]) / (rope[:, 0] ** 2 + rope[:, 2] ** 2)
    outputs = {
        "trolley_position": over_time(motion.drive("trolley"), "m", "trolley position along the jib"),
        "trolley_speed": over_time(motion.drive("trolley", 1), "m/s", "trolley speed"),
        "rope_length": over_time(motion.drive("rope"), "m", "rope length"),
        "tower_tip_displacement": over_time(
            u[:, 0], "m", "horizontal displacement of the tower top, positive outward"
        ),
        "tower_tip_tilt": over_time(tilt[:, 1], "rad", "tilt of the tower top, positive: jib tip down"),
        "jib_tip_deflection": over_time(
            motion.deflection(motion.model.crane.tip_shapes, motion.coordinates)[:, 1],
            "m",
            "deflection of the jib tip from the tilted straight jib, positive up",
        ),
        "swing_angle": over_time(
            np.arctan2(rope[:, 0], -rope[:, 2]),
            "rad",
            "swing of the rope from the vertical in the jib's plane, positive outward",
        ),
        "swing_rate": over_time(rate, "rad/s", "rate of the swing angle"),
        "rope_tension": over_time(guards[:, layout.TENSION], "N", "rope tension"),
        "payload_position": Quantity(
            ("time", "axis"),
            motion.load_in_space[0],
            "m",
            "load from the undeformed tower top: outward along the jib, which does not turn, sideways, up",
        ),
        "total_energy": over_time(total_energy(motion), "J", "kinetic and potential energy"),
        "input_work": over_time(
            states[:, -1], "J", "work of trolley drive and winch less what damping and drag took, since the start"
        ),
    }
    for member, part in (("tower", slice(tower)), ("jib", slice(tower, None))):
        amplitudes = motion.coordinates[:, part]
        # A rigid member has none, and a file of results no empty variables.
        if amplitudes.shape[1]:
            outputs[f"{member}_coordinate"] = Quantity(
                ("time", f"{member}_mode"),
                amplitudes,
                "kg^0.5 m",
                f"amplitude of the mass-normalised {member} modes",
            )
    if model.axes == 3:
        sideways = np.arcsin(np.clip(rope[:, 1], -1.0, 1.0))
        outputs["swing_angle_sideways"] = over_time(sideways, "rad", "angle of the rope out of the jib's plane")
    return outputs
