"""What an engineer reads off an overhead crane: positions, deflection, sway, forces and energy over time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from towercrane.cranes.overhead import kernel
from towercrane.results.recording import Quantity

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from towercrane.cranes.overhead.parameters import OverheadCrane
    from towercrane.kernels.payload import Load
    from towercrane.motions.motion import Motion

    Floats = NDArray[np.float64]


def observe(
    crane: OverheadCrane, load: Load, motions: dict[str, Motion], times: Floats, states: Floats, guards: Floats
) -> dict[str, Quantity]:
    """Outputs of a run.

    Parameters
    ----------
    crane : OverheadCrane
    load : Load
    motions : dict
        "bridge", "trolley" and "rope".
    times, states, guards : ndarray, shapes (p,), (p, 9) and (p, 5)
    """
    (bridge, bridge_rate), (trolley, trolley_rate), (length, hauling) = (
        (motions[channel](times), motions[channel](times, 1)) for channel in ("bridge", "trolley", "rope")
    )
    uplift, rate = states[:, kernel.UPLIFT], states[:, kernel.RATE]
    direction = states[:, kernel.ROPE_DIRECTION : kernel.ROPE_DIRECTION + kernel.AXES]
    swing = states[:, kernel.SWAY : kernel.SWAY + kernel.AXES]
    wave = np.pi / crane.bridge_span
    shape, tilt = np.sin(wave * trolley), wave * np.cos(wave * trolley)
    hung = np.stack([bridge, trolley, crane.runway_height + shape * uplift], axis=1)
    moved = np.stack([bridge_rate, trolley_rate, shape * rate + tilt * trolley_rate * uplift], axis=1)
    place = hung + length[:, None] * direction
    velocity = moved + hauling[:, None] * direction + length[:, None] * swing

    energy = 0.5 * (crane.girder_mass + crane.bridge_end_carriage_mass) * bridge_rate**2
    energy += 0.25 * crane.girder_mass * rate**2 + 0.5 * crane.stiffness * uplift**2
    energy += crane.gravity * crane.girder_mass * (crane.runway_height + 2.0 / np.pi * uplift)
    energy += crane.trolley_mass * (0.5 * (moved**2).sum(axis=1) + crane.gravity * hung[:, 2])
    energy += load.mass * (0.5 * (velocity**2).sum(axis=1) + crane.gravity * place[:, 2])

    def over_time(values: Floats, units: str, name: str) -> Quantity:
        return Quantity(("time",), values, units, name)

    down = -direction[:, 2]
    return {
        "bridge_position": over_time(bridge, "m", "bridge along the runway"),
        "bridge_speed": over_time(bridge_rate, "m/s", "speed of the bridge"),
        "trolley_position": over_time(trolley, "m", "trolley along the bridge, from the first rail"),
        "trolley_speed": over_time(trolley_rate, "m/s", "speed of the trolley along the bridge"),
        "bridge_deflection": over_time(
            -uplift, "m", "deflection of the bridge at mid-span from the straight one without weight, positive down"
        ),
        "trolley_drop": over_time(-shape * uplift, "m", "deflection of the bridge under the trolley, positive down"),
        "rope_length": over_time(length, "m", "rope length"),
        "sway_along_runway": over_time(
            np.arctan2(direction[:, 0], down), "rad", "sway along the runway, atan2(along, down)"
        ),
        "sway_along_bridge": over_time(
            np.arctan2(direction[:, 1], down), "rad", "sway along the bridge, atan2(along, down)"
        ),
        "rope_tension": over_time(guards[:, kernel.TENSION], "N", "rope tension"),
        "bridge_force": over_time(
            guards[:, kernel.BRIDGE_FORCE], "N", "force of the bridge's drive; at a jump the right limit"
        ),
        "trolley_force": over_time(
            guards[:, kernel.TROLLEY_FORCE], "N", "force of the trolley's drive; at a jump the right limit"
        ),
        "first_rail_load": over_time(
            guards[:, kernel.FIRST_RAIL], "N", "wheel loads of the bridge on the rail where the trolley's zero is"
        ),
        "second_rail_load": over_time(
            guards[:, kernel.SECOND_RAIL], "N", "wheel loads of the bridge on the other rail"
        ),
        "payload_position": Quantity(
            ("time", "fixed_axis"), place, "m",
            "load from the floor where runway and first rail begin: along the runway, along the bridge, up",
        ),
        "total_energy": over_time(energy, "J", "kinetic and potential energy, zero level at the floor"),
        "input_work": over_time(
            states[:, kernel.WORK], "J", "work of drives and winch less what damping and drag took, since the start"
        ),
    }  # fmt: skip
