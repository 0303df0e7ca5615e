"""What an engineer reads off a run of a flexible crane: sway, deflections, forces in its sections, drives, energy."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from towercrane.cranes.tower.kernels import layout
from towercrane.cranes.tower.outputs.energy import total_energy
from towercrane.cranes.tower.outputs.kinematics import FlexibleMotion
from towercrane.cranes.tower.outputs.sections import SectionLoads
from towercrane.cranes.tower.targets import absent
from towercrane.results.recording import Quantity, load_places

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.cranes.tower.equations.flexible import Equations
    from towercrane.motions.motion import Motion

    Floats = NDArray[np.float64]


def observe(
    model: Equations, motions: dict[str, Motion], times: Floats, states: Floats, guards: Floats
) -> dict[str, Quantity]:
    """Outputs of a run; where all stays in the jib's plane, without those that tell nothing there.

    Parameters
    ----------
    model : Equations
    motions : dict
        One for each of the model's channels.
    times, states, guards : ndarray, shapes (p,), (p, size) and (p, guards)

    Returns
    -------
    dict of str to Quantity
    """
    motion = FlexibleMotion(model, motions, times, states)
    outputs = {
        name: Quantity(("time",), values, units, long_name)
        for name, (values, units, long_name) in {
            **_drives(motion, guards),
            **_load(motion),
            **_deflections(motion),
            **_sections(motion, guards[:, layout.TENSION]),
            "total_energy": (total_energy(motion), "J", "kinetic and potential energy"),
            "input_work": (
                states[:, -1],
                "J",
                "work of drives and wind less what damping, friction and drag took, since the start",
            ),
        }.items()
    }
    outputs |= load_places(motion.load_in_space[0], motion.heading, "the undeformed tower top")
    for kind, amplitudes in motion.amplitudes.items():
        outputs[f"{kind}_coordinate"] = Quantity(
            ("time", f"{kind}_mode"),
            amplitudes,
            "kg^0.5 m",
            f"amplitude of the mass-normalised modes: {kind.replace('_', ' ')}",
        )
    missing = absent(model.heading) if model.axes == 2 else ()
    return {name: quantity for name, quantity in outputs.items() if name not in missing}


Entries = dict[str, tuple["Floats", str, str]]


def _drives(motion: FlexibleMotion, guards: Floats) -> Entries:
    angle, speed = motion.slewing
    entries: Entries = {
        "trolley_position": (motion.drive("trolley"), "m", "trolley position along the jib"),
        "trolley_speed": (motion.drive("trolley", 1), "m/s", "trolley speed"),
        "trolley_force": (
            guards[:, layout.TROLLEY_FORCE],
            "N",
            "force of the trolley's drive along the deflected jib, positive outward",
        ),
        "rope_length": (motion.drive("rope"), "m", "rope length"),
        "rope_tension": (guards[:, layout.TENSION], "N", "rope tension, the force of the hoist"),
        "slewing_angle": (angle, "rad", "angle of the head on the tower's top"),
        "slewing_speed": (speed, "rad/s", "rate of that angle"),
        "slewing_torque": (
            guards[:, layout.SLEWING_TORQUE],
            "N m",
            "torque of the slewing drive on the head; of a coupling with its damper",
        ),
    }
    if motion.model.drive is not None:
        entries["shaft_angle"] = (motion.drive("shaft"), "rad", "angle of the drive's shaft, referred to the head")
        entries["shaft_speed"] = (motion.drive("shaft", 1), "rad/s", "speed of the drive's shaft")
    if motion.model.wind:
        for axis in "xyz":
            entries[f"wind_{axis}"] = (motion.drive(f"wind_{axis}"), "m/s", f"wind along {axis}")
    return entries


def _load(motion: FlexibleMotion) -> Entries:
    rope, swing = motion.rope, motion.swing
    c, s = np.cos(motion.heading), np.sin(motion.heading)
    outward, sideways, down = rope[:, 0] * c + rope[:, 1] * s, rope[:, 1] * c - rope[:, 0] * s, -rope[:, 2]
    rate = (down * swing[:, 0] + rope[:, 0] * swing[:, 2]) * c + (down * swing[:, 1] + rope[:, 1] * swing[:, 2]) * s
    return {
        "sway_tangential": (
            np.arctan2(sideways, down),
            "rad",
            "sway across the jib's root, atan2(across, down), positive in the turning sense",
        ),
        "sway_radial": (
            np.arctan2(outward, down),
            "rad",
            "sway along the jib's root, atan2(along, down), positive outward",
        ),
        "swing_rate": (
            rate / (outward**2 + down**2),
            "rad/s",
            "rate of the swing along the direction that the jib's root has at that time",
        ),
    }


def _deflections(motion: FlexibleMotion) -> Entries:
    (u, tilt), c, s = motion.top(motion.coordinates), np.cos(motion.heading), np.sin(motion.heading)
    tip = motion.deflection(motion.model.crane.tip_shapes, motion.coordinates)
    return {
        "tower_tip_displacement": (
            u[:, 0] * c + u[:, 1] * s,
            "m",
            "horizontal displacement of the tower top along the jib's root, positive outward",
        ),
        "tower_tip_displacement_sideways": (
            u[:, 1] * c - u[:, 0] * s,
            "m",
            "horizontal displacement of the tower top across the jib's root, positive in the turning sense",
        ),
        "tower_tip_tilt": (
            tilt[:, 1] * c - tilt[:, 0] * s,
            "rad",
            "tilt of the tower top along the jib, positive: jib tip down",
        ),
        "tower_tip_roll": (tilt[:, 0] * c + tilt[:, 1] * s, "rad", "tilt of the tower top about the jib's root"),
        "tower_tip_twist": (motion.twist, "rad", "twist of the tower top, positive in the turning sense"),
        "jib_tip_deflection": (tip[:, 1], "m", "deflection of the jib tip from the tilted straight jib, positive up"),
        "jib_tip_deflection_sideways": (
            tip[:, 0],
            "m",
            "deflection of the jib tip from the straight jib, positive in the turning sense",
        ),
    }


def _sections(motion: FlexibleMotion, tension: Floats) -> Entries:
    loads = SectionLoads(motion, tension)
    root, base = loads.jib_root[1], -loads.base[1]
    return {
        "jib_root_moment": (-root[:, 1], "N m", "bending moment at the jib's root, positive under a load"),
        "jib_root_moment_sideways": (
            root[:, 2],
            "N m",
            "bending moment at the jib's root, positive where it speeds the jib up in the turning sense",
        ),
        "base_moment_x": (base[:, 0], "N m", "moment of the crane on its base about x, positive: tips towards -y"),
        "base_moment_y": (base[:, 1], "N m", "moment of the crane on its base about y, positive: tips towards +x"),
        "base_torque": (base[:, 2], "N m", "moment of the crane on its base about the vertical"),
    }
