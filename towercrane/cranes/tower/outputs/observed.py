"""What an engineer reads off a run of a flexible crane: sway, deflections, forces in its sections, drives, energy."""

from __future__ import annotations

from functools import cached_property, partial
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cranes.parts.base import BASE, Reaction, length
from towercrane.cranes.parts.hoisting.contact import REACTION
from towercrane.cranes.parts.hoisting.elastic import sling_force
from towercrane.cranes.parts.points import GROUND_FORCE, ROPE_STRETCH
from towercrane.cranes.tower.equations.constants import ROPE, SLEWING, TROLLEY
from towercrane.cranes.tower.equations.coordinates import ANGLES, BOWS
from towercrane.cranes.tower.equations.motion import SLEWING_TORQUE, TENSION, TROLLEY_FORCE
from towercrane.cranes.tower.outputs.cuts import cut_loads, cut_outputs, read_cut
from towercrane.cranes.tower.outputs.energy import total_energy
from towercrane.cranes.tower.outputs.kinematics import Kinematics
from towercrane.cranes.tower.outputs.sections import Sections
from towercrane.cranes.tower.outputs.support import Support, collar_outputs
from towercrane.cranes.tower.targets import absent
from towercrane.simulation.observed import About

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from towercrane.cranes.tower.equations.flexible import Equations
    from towercrane.cranes.tower.outputs.cut_sums import Cuts
    from towercrane.cranes.tower.outputs.seen import Seen
    from towercrane.simulation.observed import Instant


class Sight(Kinematics):
    """What outputs are read off."""

    @cached_property
    def sections(self) -> Sections:
        """What sections carry."""
        return Sections(self)

    @cached_property
    def support(self) -> Support:
        """What holds the crane."""
        return Support(self, self.sections)

    def speed(self, node: int) -> Any:
        """Horizontal wind at a place that sees a wind of its own."""
        east, north, _ = self.winds[node]
        return np.sqrt(east * east + north * north)

    @cached_property
    def cuts(self) -> dict[str, Reaction]:
        """What named sections bear."""
        return cut_loads(self.seen.cuts, self.support, self.sections)

    def shaken(self, axis: int) -> Any:
        """Acceleration of the ground along a fixed axis."""
        return self.instant.drives[self.seen.crane.ground + axis][2]

    @cached_property
    def sways(self) -> tuple[Any, Any, Any]:
        """Rope outward along the jib's root, to its left, and down."""
        return (*self.by_jib(*self.rope[:2]), -self.rope[2])

    @cached_property
    def swing_rate(self) -> Any:
        """Rate of the swing along the direction that the jib's root has at that time."""
        (outward, _, down), (rate, _) = self.sways, self.by_jib(*self.swing[:2])
        return (down * rate + outward * self.swing[2]) / (outward * outward + down * down)

    @cached_property
    def displacement(self) -> tuple[Any, Any]:
        """Of the tower's top, along the jib's root and to its left."""
        return self.by_jib(*self.placed[:2])

    @cached_property
    def tilt(self) -> tuple[Any, Any]:
        """Tilt vector along the same."""
        return self.by_jib(*self.placed[2:4])

    @cached_property
    def tip(self) -> tuple[Any, Any]:
        """Deflection of the jib's tip, to the left and up."""
        return self.deflection(self.seen.tip, self.state.coordinates)

    @cached_property
    def counter_tip(self) -> tuple[Any, Any]:
        """Deflection of the counter-jib's tip, to the left of who looks along the jib and up."""
        return self.deflection(self.seen.counter_tip, self.state.coordinates)

    def amplitudes(self, kind: str) -> Sequence[Any]:
        """Coordinates of a kind, the tower's along the fixed axes."""
        crane, q = self.seen.crane, self.state.coordinates
        if crane.axes == 2 and kind in ("tower_x", "tower_y"):
            return [self.from_plane(q[i], 0.0)[kind == "tower_y"] for i in crane.part("tower_x")]
        return [q[i] for i in crane.part(kind)]


BOW_NAMES = {
    "tie": "sag of a tie bar's middle beyond that under the crane's own weight",
    "tie_sideways": "bow of a tie bar's middle to the left",
}


def at_base(read: Callable[[Reaction], Any], at: Sight) -> Any:
    """An output of the base."""
    return read(at.support.base)


ORIGIN, TURNING_AXES = "the undeformed tower top", "outward along its jib, sideways, up"

OUTPUTS: dict[str, tuple[Callable[[Sight], Any], About]] = {
    "trolley_position": (lambda at: at.instant.drives[TROLLEY][0], About("m", "trolley position along the jib")),
    "trolley_speed": (lambda at: at.instant.drives[TROLLEY][1], About("m/s", "trolley speed")),
    "trolley_force": (
        lambda at: at.instant.guards[TROLLEY_FORCE],
        About("N", "force of the trolley's drive along the deflected jib, positive outward"),
    ),
    "rope_length": (lambda at: at.instant.drives[ROPE][0], About("m", "rope length")),
    "hoist_rope_force": (lambda at: at.instant.guards[TENSION], About("N", "rope tension, the force of the hoist")),
    "rope_stretch": (lambda at: at.stretch, ROPE_STRETCH),
    "load_ground_force": (lambda at: at.instant.guards[REACTION], GROUND_FORCE),
    "slewing_angle": (lambda at: at.slewing[0], About("rad", "angle of the head on the tower's top")),
    "slewing_speed": (lambda at: at.slewing[1], About("rad/s", "rate of that angle")),
    "slewing_torque": (
        lambda at: at.instant.guards[SLEWING_TORQUE],
        About("N m", "torque of the slewing drive on the head; of a coupling with its damper"),
    ),
    "shaft_angle": (
        lambda at: at.instant.drives[SLEWING][0], About("rad", "angle of the drive's shaft, referred to the head"),
    ),
    "shaft_speed": (lambda at: at.instant.drives[SLEWING][1], About("rad/s", "speed of the drive's shaft")),
    "wind_x": (lambda at: at.instant.drives[-3][0], About("m/s", "wind along x, at the load")),
    "wind_y": (lambda at: at.instant.drives[-2][0], About("m/s", "wind along y, at the load")),
    "wind_z": (lambda at: at.instant.drives[-1][0], About("m/s", "wind along z, at the load")),
    "wind_speed_tip": (
        lambda at: at.speed(at.seen.crane.head_nodes[-1]), About("m/s", "horizontal wind at the jib's tip"),
    ),
    "wind_speed_load": (lambda at: at.speed(-1), About("m/s", "horizontal wind at the load")),
    "ground_acceleration_x": (
        lambda at: at.shaken(0), About("m/s^2", "acceleration of the ground along x"),
    ),
    "ground_acceleration_y": (
        lambda at: at.shaken(1), About("m/s^2", "acceleration of the ground along y"),
    ),
    "ground_acceleration_z": (
        lambda at: at.shaken(2), About("m/s^2", "acceleration of the ground upward"),
    ),
    "sway_tangential": (
        lambda at: np.arctan2(at.sways[1], at.sways[2]),
        About("rad", "sway across the jib's root, atan2(across, down), positive in the turning sense"),
    ),
    "sway_radial": (
        lambda at: np.arctan2(at.sways[0], at.sways[2]),
        About("rad", "sway along the jib's root, atan2(along, down), positive outward"),
    ),
    "sling_sway_tangential": (
        lambda at: np.arctan2(at.by_jib(*at.sling[:2])[1], -at.sling[2]),
        About("rad", "sway of the load below the hook across the jib's root, atan2(across, down)"),
    ),
    "sling_sway_radial": (
        lambda at: np.arctan2(at.by_jib(*at.sling[:2])[0], -at.sling[2]),
        About("rad", "sway of the load below the hook along the jib's root, atan2(along, down), positive outward"),
    ),
    "sling_force": (
        lambda at: sling_force(at.seen.crane.load, at.instant.guards), About("N", "tension of the sling"),
    ),
    "hook_position": (
        lambda at: (*at.from_plane(*at.on_rope[0][:2]), at.on_rope[0][2]),
        About("m", f"hook from {ORIGIN} in fixed axes: x, y, up", ("fixed_axis",), 3),
    ),
    "swing_rate": (
        lambda at: at.swing_rate,
        About("rad/s", "rate of the swing along the direction that the jib's root has at that time"),
    ),
    "tower_tip_displacement": (
        lambda at: at.displacement[0],
        About("m", "horizontal displacement of the tower top along the jib's root, positive outward"),
    ),
    "tower_tip_displacement_sideways": (
        lambda at: at.displacement[1],
        About("m", "horizontal displacement of the tower top across the jib's root, positive in the turning sense"),
    ),
    "tower_tip_tilt": (
        lambda at: at.tilt[1], About("rad", "tilt of the tower top along the jib, positive: jib tip down"),
    ),
    "tower_tip_roll": (lambda at: at.tilt[0], About("rad", "tilt of the tower top about the jib's root")),
    "tower_tip_twist": (lambda at: at.twist, About("rad", "twist of the tower top, positive in the turning sense")),
    "jib_tip_deflection": (
        lambda at: at.tip[1], About("m", "deflection of the jib tip from the tilted straight jib, positive up"),
    ),
    "jib_tip_deflection_sideways": (
        lambda at: at.tip[0],
        About("m", "deflection of the jib tip from the straight jib, positive in the turning sense"),
    ),
    "jib_root_moment": (
        lambda at: at.sections.jib_root.moment[1],
        About("N m", "bending moment at the jib's root, positive under a load"),
    ),
    "jib_root_moment_sideways": (
        lambda at: -at.sections.jib_root.moment[2],
        About("N m", "bending moment at the jib's root, positive where it speeds the jib up in the turning sense"),
    ),
    "counter_jib_tip_deflection": (
        lambda at: at.counter_tip[1],
        About("m", "deflection of the counter-jib's tip from the tilted straight counter-jib, positive up"),
    ),
    "counter_jib_tip_deflection_sideways": (
        lambda at: -at.counter_tip[0],
        About("m", "deflection of the counter-jib's tip from where it is straight, positive in the turning sense"),
    ),
    "counter_jib_root_moment": (
        lambda at: -at.sections.counter_root.moment[1],
        About("N m", "bending moment at the counter-jib's root, positive under its ballast"),
    ),
    "counter_jib_root_moment_sideways": (
        lambda at: -at.sections.counter_root.moment[2],
        About("N m", "bending moment at the counter-jib's root, positive where it speeds up the turning"),
    ),
    **{name: (partial(at_base, read), shown) for name, (read, shown) in BASE.items()},
    "overturning_moment_first_order": (
        lambda at: length(at.support.upright.moment[:2]),
        About("N m", "the same of a tower that bears its loads where it stands undeformed", kink=True),
    ),
    **collar_outputs(),
    "total_energy": (total_energy, About("J", "kinetic and potential energy")),
    "input_work": (
        lambda at: at.instant.state[-1],
        About("J", "work of drives, wind and ground less what damping, friction and drag took, since the start"),
    ),
    "payload_position": (
        lambda at: (*at.from_plane(*at.load_in_space[0][:2]), at.load_in_space[0][2]),
        About("m", f"load from {ORIGIN} in fixed axes: x, y, up", ("fixed_axis",), 3),
    ),
    "payload_in_crane_axes": (
        lambda at: (*at.by_jib(*at.load_in_space[0][:2]), at.load_in_space[0][2]),
        About("m", f"load from {ORIGIN} in axes that turn with the crane: {TURNING_AXES}", ("axis",), 3),
    ),
}  # fmt: skip
"""How each output is read off and what it is, but for the amplitudes of modes."""


class Outputs(dict[str, Any]):
    """Outputs at an instant by name, each worked out when it is asked for; vectors are sequences of numbers."""

    def __init__(self, at: Sight, read: Mapping[str, tuple[Callable[[Any], Any], About]] = OUTPUTS) -> None:
        super().__init__()
        self.at, self.read = at, read

    def __missing__(self, name: str) -> Any:
        if name in self.read:
            found = self.read[name][0](self.at)
        elif name.endswith("_coordinate"):
            found = self.at.amplitudes(name.removesuffix("_coordinate"))
        else:
            found = read_cut(name, self.at.seen.cuts, self.at.cuts)
        self[name] = found
        return found


def outputs(seen: Seen, instant: Instant) -> Outputs:
    """Outputs at an instant."""
    return Outputs(Sight(seen, instant))


def about(
    model: Equations, cuts: Cuts, read: Mapping[str, tuple[Callable[[Any], Any], About]] = OUTPUTS
) -> dict[str, About]:  # fmt: skip
    """What the outputs are; where all stays in the jib's plane, without those that tell nothing there."""
    crane, counts = model.constants, dict(model.counts)
    if model.axes == 2:
        counts["tower_y"] = counts["tower_x"]
    there = {
        "shaft": crane.slewing == "driven",
        "wind": bool(crane.wind),
        "ground": bool(crane.ground),
        "counter": model.crane.counter_bends,
        "rope_stretch": crane.load.elasticity is not None,
        "load_ground_force": crane.load.ground is not None,
        "sling": bool(crane.load.slings),
        "hook": bool(crane.load.slings),
    }
    found = {
        name: shown
        for name, (_, shown) in read.items()
        if there.get(name.partition("_")[0], True) and there.get(name, True)
    }
    if crane.wind < 2:
        found = {name: shown for name, shown in found.items() if not name.startswith("wind_speed")}
    springs = [(1.0, own.rotation_stiffness, own.torsional_stiffness) for own in model.crane.collars]
    for name in [name for name in found if name.startswith("collar_")]:
        _, number, what, *_ = name.split("_")
        held = springs[int(number) - 1] if int(number) <= len(springs) else (0.0, 0.0, 0.0)
        if not held[("force", "moment", "torque").index(what)]:
            del found[name]
    for kind, count in counts.items():
        if count and kind in BOWS:
            found[f"{kind}_coordinate"] = About("m", BOW_NAMES[kind], (f"{kind}_number",), count)
        elif count and kind not in ANGLES:
            name = f"amplitude of the mass-normalised modes: {kind.replace('_', ' ')}"
            found[f"{kind}_coordinate"] = About("kg^0.5 m", name, (f"{kind}_mode",), count)
    missing = absent(model.heading) if model.axes == 2 else ()
    return {name: shown for name, shown in found.items() if name not in missing} | cut_outputs(
        cuts, model.axes, model.heading
    )
