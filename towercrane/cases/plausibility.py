"""What a case's numbers may be: one table of wide ranges, and the limits that values set for each other."""

from __future__ import annotations

from functools import lru_cache
from math import pi
from typing import TYPE_CHECKING, Any

from towercrane.cases.kinds import known_leaves
from towercrane.cranes.parts.load import check_ground, check_rope, check_slings, stretched
from towercrane.cranes.registry import KINDS
from towercrane.schema.faults import Fault, did_you_mean, shown
from towercrane.schema.ranges import (
    ANGLES,
    AREAS,
    LENGTHS,
    ROTARY_SPRINGS,
    SPRINGS,
    TURNS,
    Range,
    at,
    out_of_range,
    ranges_of,
    si_at,
)
from towercrane.simulation.methods.registry import METHODS

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator


MOST_SAMPLES = 5_000_000
FASTEST = 10.0
"""Largest plausible speed of trolley and hook [m/s]."""

FASTEST_TURN = 5.0
"""Largest plausible speed of shaft and joints [rad/s]."""

FARTHEST_TURN = {"shaft": 100.0, "slewing": 100.0, "slew": 100.0, "luff": 3.2, "fold": 6.4, "luffing": 3.2}
"""Largest plausible angle of each joint in either sense [rad]."""


RANGES = (
    Range("crane.gravity", "m/s^2", 1, 30, ("cm/s^2", "mm/s^2")),
    Range("crane.tower.height", "m", 2, 1000, LENGTHS),
    Range("crane.jib.length", "m", 1, 200, LENGTHS),
    Range("crane.counter_jib.length", "m", 0.5, 100, LENGTHS),
    Range("crane.*.mass_per_length", "kg/m", 1, 20e3, ("t/m", "kg/mm", "g/m")),
    Range("crane.*.youngs_modulus", "Pa", 1e9, 1e12, ("GPa", "MPa", "N/mm^2", "kPa")),
    Range("crane.*second_moment_of_area", "m^4", 1e-8, 10, ("cm^4", "mm^4")),
    Range("crane.tower*.lattice.*_area", "m^2", 1e-5, 0.5, AREAS),
    Range("crane.tower*.lattice.leg_spacing", "m", 0.05, 20, LENGTHS),
    Range("crane.tower*.lattice.panel_height", "m", 0.05, 20, LENGTHS),
    Range("crane.tower*.shear_stiffness", "N", 1e4, 1e12, ("MN", "kN")),
    Range("crane.tower*.rotary_inertia_per_length", "kg m^2/m", 1e-4, 1e5, ("t m", "g m")),
    Range("crane.tower.segments*.length", "m", 0.05, 1000, LENGTHS),
    Range("crane.tower.segments*.top_breadth_ratio", "1", 0.05, 10, ("%",)),
    Range("crane.tower.bodies*.height", "m", 1e-3, 1000, LENGTHS),
    Range("crane.tower.bodies*.mass", "kg", 1, 1e6, ("t", "g")),
    Range("crane.tower.bodies*.rotary_inertia", "kg m^2", 1e-2, 1e9, ("t m^2",)),
    Range("crane.tower.bodies*.offset", "m", 1e-3, 50, LENGTHS, signed=True),
    Range("crane.foundation.rotation_stiffness", "N m/rad", 1e4, 1e14, ("MN m/rad", "GN m/rad", "kN m/rad")),
    Range("crane.foundation.translation_stiffness", "N/m", 1e4, 1e13, ("MN/m", "GN/m", "kN/m")),
    Range("crane.foundation.coupling_stiffness", "N", 1e4, 1e14, ("MN", "GN", "kN"), signed=True),
    Range("crane.foundation.block.mass", "kg", 100, 1e7, ("t", "g")),
    Range("crane.foundation.block.rotary_inertia", "kg m^2", 1, 1e10, ("t m^2",)),
    Range("crane.foundation.block.offset", "m", 1e-3, 50, LENGTHS, signed=True),
    Range("crane.tower.collars*.height", "m", 1, 1000, LENGTHS),
    Range("crane.tower.collars*.stiffness", "N/m", 1e4, 1e12, ("MN/m", "GN/m", "kN/m")),
    Range("crane.tower.collars*.gap", "m", 1e-5, 0.5, LENGTHS),
    Range("crane.tower.collars*.rotation_stiffness", "N m/rad", 1e4, 1e13, ROTARY_SPRINGS),
    Range("crane.tower.collars*.torsional_stiffness", "N m/rad", 1e4, 1e13, ROTARY_SPRINGS),
    Range("crane.tower.torsional_stiffness", "N m^2", 1e4, 1e13, ("MN m^2", "kN m^2", "GN m^2")),
    Range("crane.tower.torsional_inertia_per_length", "kg m^2/m", 1e-3, 1e6, ("t m",)),
    Range("crane.*jib*shear_stiffness", "N", 1e4, 1e12, ("MN", "kN")),
    Range("crane.*jib*rotary_inertia_per_length", "kg m^2/m", 1e-4, 1e5, ("t m", "g m")),
    Range("crane.*jib.segments*.length", "m", 0.05, 200, LENGTHS),
    Range("crane.*jib.segments*.mass", "kg", 5, 1e6, ("t", "g")),
    Range("crane.*jib*.lattice.*_area", "m^2", 1e-5, 0.5, AREAS),
    *(
        Range(f"crane.*jib*.lattice.{name}", "m", 0.05, 20, LENGTHS)
        for name in ("height", "end_height", "breadth", "panel_length")
    ),
    Range("crane.*jib*.lattice.density", "kg/m^3", 500, 20e3, ("t/m^3", "g/cm^3")),
    Range("crane.*jib*.lattice.further_mass_per_length", "kg/m", 0.1, 5e3, ("t/m", "kg/mm", "g/m")),
    Range("crane.*jib.bodies*.position", "m", 1e-3, 200, LENGTHS),
    Range("crane.*jib.bodies*.mass", "kg", 1, 1e6, ("t", "g")),
    Range("crane.*jib.bodies*.rotary_inertia", "kg m^2", 1e-2, 1e9, ("t m^2",)),
    Range("crane.roll_inertia", "kg m^2", 1e-2, 1e9, ("t m^2",)),
    Range("crane.wind_areas.*", "m", 1e-3, 50, ("cm", "mm")),
    Range("crane.wind_areas.counterweight", "m^2", 1e-3, 1e3, AREAS),
    Range("crane.drive.inertia", "kg m^2", 1e-2, 1e9, ("t m^2",)),
    Range("wind.speed", "m/s", 1e-3, 80, ("km/h",)),
    Range("wind.upward", "m/s", 1e-3, 80, ("km/h",), signed=True),
    Range("wind.direction", "rad", 1e-9, 100, ANGLES, signed=True),
    Range("wind.reference_height", "m", 1, 500, LENGTHS),
    Range("wind.exponent", "1", 0.01, 1, ("%",)),
    Range("wind.roughness_length", "m", 1e-5, 5, LENGTHS),
    Range("wind.minimum_height", "m", 0.1, 50, LENGTHS),
    Range("wind.turbulence.intensity", "1", 1e-3, 1, ("%",)),
    Range("wind.turbulence.across_ratio", "1", 0.05, 3, ("%",)),
    Range("wind.turbulence.length_scale", "m", 1, 3e3, LENGTHS),
    Range("wind.turbulence.coherence_decay", "1", 0.5, 100),
    Range("wind.turbulence.coherence_length", "m", 1, 3e4, LENGTHS),
    Range("wind.turbulence.step", "s", 1e-3, 10, ("ms",)),
    Range("wind.turbulence.duration", "s", 1, 1e6, ("min", "h")),
    Range("wind.turbulence.ramp", "s", 1e-3, 1e5, ("min", "ms")),
    Range("earthquake.factor", "1", 1e-3, 100, ("%",)),
    Range("crane.counter_jib.counterweight", "kg", 50, 1e6, ("t", "g")),
    Range("crane.jib.luffing.*pivot*", "m", 1e-3, 50, LENGTHS, signed=True),
    Range("crane.jib.luffing.frame_head*", "m", 1e-3, 100, LENGTHS, signed=True),
    Range("crane.jib.luffing.hoist_winch*", "m", 1e-3, 100, LENGTHS, signed=True),
    Range("crane.jib.luffing.rope_attachment", "m", 1e-3, 10, LENGTHS, signed=True),
    Range("crane.jib.luffing.*_stiffness", "N", 1e5, 1e12, ("MN", "kN", "GN")),
    Range("crane.jib.luffing.tip_mass", "kg", 1, 1e5, ("t", "g")),
    Range("crane.jib.luffing.*_angle", "rad", 1e-9, 1.6, ANGLES, signed=True),
    Range("crane.*jib*axial_stiffness", "N", 1e6, 1e12, ("MN", "kN", "GN")),
    Range("crane.*jib.ties*.position", "m", 0.5, 200, LENGTHS),
    Range("crane.*jib.ties*.height", "m", 1e-3, 20, LENGTHS),
    Range("crane.*jib.ties*.mass_per_length", "kg/m", 0.5, 1e3, ("t/m", "kg/mm", "g/m")),
    Range("crane.*jib.ties*.pretension", "N", 100, 1e8, ("MN", "kN")),
    Range("crane.tower_head.height", "m", 0.5, 100, LENGTHS),
    Range("crane.tower_head.mass_per_length", "kg/m", 5, 2e4, ("t/m", "kg/mm", "g/m")),
    Range("crane.tower_head.axial_stiffness", "N", 1e6, 1e13, ("MN", "kN", "GN")),
    Range("crane.head.bodies*.mass", "kg", 1, 1e6, ("t", "g")),
    Range("crane.head.bodies*.place*", "m", 1e-3, 100, LENGTHS, signed=True),
    Range("modes.luffing_angles*", "rad", 1e-9, 1.6, ANGLES, signed=True),
    Range("map.luffing_angles*", "rad", 1e-9, 1.6, ANGLES, signed=True),
    Range("crane.trolley.mass", "kg", 5, 50e3, ("t", "g")),
    Range("crane.geometry.*", "m", 0.02, 1000, LENGTHS),
    Range("crane.mass.*", "kg", 0.05, 1e6, ("t", "g")),
    Range("crane.mass.counter_moment", "kg m", 0.05, 1e8, ("t m",)),
    Range("crane.*.inertia", "kg m^2", 1, 1e9, ("t m^2",)),
    Range("crane.inertia.*", "kg m^2", 1e-4, 1e9, ("t m^2", "g m^2")),
    Range("crane.stiffness.*", "N/m", 500, 1e12, SPRINGS),
    Range("crane.stiffness.tower_torsion", "N m/rad", 500, 1e13, ROTARY_SPRINGS),
    Range("crane.stiffness.*jib_lateral", "N m/rad", 500, 1e13, ROTARY_SPRINGS),
    Range("crane.damping.*", "N s/m", 1e-3, 1e9, ("kN s/m",)),
    Range("crane.damping.tower_torsion", "N m s/rad", 1e-3, 1e10, ("kN m s/rad",)),
    Range("crane.damping.*jib_lateral", "N m s/rad", 1e-3, 1e10, ("kN m s/rad",)),
    Range("crane.drive.*_stiffness", "N m/rad", 0.1, 1e12, ROTARY_SPRINGS),
    Range("crane.drive.corner", "rad", 1e-6, 1.6, ANGLES),
    Range("crane.drive.damping", "N m s/rad", 1e-3, 1e10, ("kN m s/rad",)),
    Range("crane.friction.torque", "N m", 1e-3, 1e7, ("kN m",)),
    Range("crane.friction.rate", "rad/s", 1e-9, 1, TURNS),
    Range("crane.drag.*", "N s^2/m^2", 1e-6, 1e4, ("g/m",)),
    Range("crane.post.height", "m", 0.1, 1000, LENGTHS),
    Range("crane.*_boom.length", "m", 0.1, 200, LENGTHS),
    Range("payload.mass", "kg", 1, 1e6, ("t", "g")),
    Range("payload.rope_damping", "N m s/rad", 1e-6, 1e8, ("kN m s/rad",)),
    Range("payload.drag_area", "m^2", 1e-4, 1e3, AREAS),
    Range("payload.drag", "N s^2/m^2", 1e-5, 1e3, ("g/m",)),
    Range("release.mass", "kg", 1, 1e6, ("t", "g")),
    Range("release.base_half_width", "m", 0.1, 100, LENGTHS),
    Range("map.payload_masses*", "kg", 1, 1e6, ("t", "g")),
    Range("hook.mass", "kg", 0.1, 1e5, ("t", "g")),
    Range("hook.drag_area", "m^2", 1e-4, 1e3, AREAS),
    Range("slings.length", "m", 0.05, 200, LENGTHS),
    Range("rope.length", "m", 0.1, 1000, LENGTHS),
    Range("ground.height", "m", 1e-3, 1000, LENGTHS, signed=True),
    Range("ground.friction", "1", 1e-3, 2.0, ("%",)),
    Range("start.slack", "m", 1e-5, 100, LENGTHS),
    Range("rope.stiffness", "N", 1e3, 1e12, ("MN", "kN")),
    Range("rope.axial_stiffness", "N", 1e3, 1e12, ("MN", "kN")),
    Range("rope.extra_length", "m", 1e-3, 1000, LENGTHS),
    Range("rope.relaxation_time", "s", 1e-7, 1.0, ("ms",)),
    Range("rope.damping_ratio", "1", 1e-5, 2.0, ("%",)),
    Range("motion.*.speed", "m/s", 1e-3, FASTEST, ("m/min", "mm/s", "km/h"), signed=True),
    Range("motion.*_speed", "m/s", 1e-3, FASTEST, ("m/min", "mm/s", "km/h"), signed=True),
    Range("motion.*.acceleration", "m/s^2", 1e-4, 20, ("cm/s^2", "mm/s^2")),
    Range("motion.*.jerk", "m/s^3", 1e-5, 1e3, ("cm/s^3", "mm/s^3")),
    *(
        row
        for joint, most in FARTHEST_TURN.items()
        for row in (
            Range(f"motion.{joint}.start", "rad", 1e-9, most, ANGLES, signed=True),
            Range(f"motion.{joint}*.end", "rad", 1e-9, most, ANGLES, signed=True),
            Range(f"motion.{joint}*.speed", "rad/s", 1e-5, FASTEST_TURN, TURNS, signed=True),
            Range(f"motion.{joint}*_speed", "rad/s", 1e-5, FASTEST_TURN, TURNS, signed=True),
            Range(f"motion.{joint}*.acceleration", "rad/s^2", 1e-7, 50, ("deg/s^2",)),
            Range(f"motion.{joint}*.jerk", "rad/s^3", 1e-8, 1e3, ("deg/s^3",)),
        )
    ),
    Range("motion.slewing.brake_torque", "N m", 1, 1e8, ("kN m", "MN m")),
    Range("motion.*.ramp", "s", 1e-3, 1e5, ("ms", "min")),
    Range("motion.*.hold", "s", 1e-3, 1e5, ("ms", "min")),
    Range("motion.*.frequencies*", "Hz", 1e-3, 20, ("mHz",)),
    Range("motion.*.delay", "s", 1e-3, 1e5, ("ms", "min")),
    Range("motion.*.duration", "s", 1e-3, 1e5, ("ms", "min")),
    Range("modes.rope_lengths*", "m", 0.1, 1000, LENGTHS),
    Range("modes.slewing_angles*", "rad", 1e-9, 100, ANGLES, signed=True),
    Range("model.*_damping_ratio", "1", 1e-6, 0.3, ("%",)),
    Range("start.sway_*", "rad", 1e-9, 1.6, ANGLES, signed=True),
    *(
        Range(f"start.{name}", "rad", 1e-9, 1.57, ANGLES, signed=True)
        for name in ("sway_tangential", "sway_lateral", "sway_along_bridge")
    ),
    Range("start.sway_*_rate", "rad/s", 1e-9, 10, TURNS, signed=True),
    Range("run.duration", "s", 0.01, 1e6, ("ms", "min", "h")),
    Range("run.output_step", "s", 1e-6, 1e4, ("ms",)),
    Range("solver.atol", "1", 1e-20, 1),
)
"""Of several rows that fit a key the last holds, or one of the crane's kind."""


@lru_cache(maxsize=64)
def ranges_in(keys: tuple[str, ...], kind: str) -> dict[str, Range]:
    """Ranges of those dotted keys of a kind of crane that have one."""
    return ranges_of(keys, (*RANGES, *KINDS[kind].ranges))


def implausible(tree: dict[str, Any], allowed: Collection[str], kind: str) -> Iterator[Fault]:
    """Values outside their range for this kind of crane, except where the case allows them."""
    values = known_leaves(tree, kind)
    ranges = ranges_in(tuple(values), kind)
    for key in allowed:
        if key not in ranges:
            wanted, hint = "keys of this case whose range is checked", did_you_mean(key, ranges)
            yield Fault("", "allow_implausible", wanted, shown(key), hint)
    yield from out_of_range(values, ranges, allowed)


def check_values(tree: dict[str, Any], kind: str) -> Iterator[Fault]:
    """Values that do not fit each other, motions and towers apart."""
    yield from _check_from(tree)
    yield from _check_sways(tree, *KINDS[kind].sways)
    hanging = _check_drag, check_rope, check_slings, check_ground
    for check in (_check_output, _check_elements, *hanging, _check_friction, _check_method):
        yield from check(tree)


SAYS_NOTHING = ("state", "equilibrium"), ("state", "zero-no-self-weight")
"""What of a start a run may say that goes on from another: the default, and that its crane has no weight."""


def _check_from(tree: dict[str, Any]) -> Iterator[Fault]:
    """Keys that say otherwise how a run begins that goes on from another."""
    start = at(tree, "start")
    if not isinstance(start, dict) or not start.get("from"):
        return
    others = [
        key for key, value in start.items() if key not in ("from", "slack") and (key, value) not in SAYS_NOTHING
    ]
    if others:
        yield Fault("", "start.from", "it alone in [start]", f"{', '.join(others)} beside it", "all states are saved")
    if at(tree, "accuracy.target") is not None:
        hint = "take the modes of the run that it goes on from"
        yield Fault("", "start.from", "the modes of that run", "[accuracy], which chooses some", hint)


def _check_sways(tree: dict[str, Any], first: str, second: str) -> Iterator[Fault]:
    """Two angles of sway that no rope has."""
    along, across = (si_at(tree, f"start.{name}", "rad", 0.0) for name in (first, second))
    if along is None or across is None or not across:
        return
    got, allowed = shown(at(tree, f"start.{second}")), at(tree, "allow_implausible")
    if abs(across) >= 0.5 * pi:
        # Its range says so too.
        if isinstance(allowed, list) and f"start.{second}" in allowed:
            yield Fault("", f"start.{second}", "an angle below 90 deg", got, f"start.{first} may be larger")
    elif abs(along) >= 0.5 * pi:
        wanted = f"0 beside a start.{first} of 90 deg and more"
        yield Fault("", f"start.{second}", wanted, got, "above the horizontal a rope is in one of both planes")


def _check_method(tree: dict[str, Any]) -> Iterator[Fault]:
    """A solver that is none, that cannot follow friction from sticking to slipping, or that feeds vibration."""
    law, name, stretches = at(tree, "crane.friction.law"), at(tree, "solver.method"), stretched(tree)
    if not isinstance(name, str):
        return
    if (method := METHODS.get(name)) is None:
        wanted = "one of " + ", ".join(map(shown, METHODS))
        yield Fault("", "solver.method", wanted, shown(name), did_you_mean(name, METHODS))
        return
    if (law == "stick-slip" or at(tree, "motion.slewing.shape") == "free") and not method.follows_switches:
        able = " or ".join(shown(own.name) for own in METHODS.values() if own.follows_switches)
        hint = 'friction that sticks and slips switches equations; "tanh" friction needs no switching'
        yield Fault("", "solver.method", f"{able} with stick-slip friction", shown(name), hint)
    elif stretches and not method.follows_switches:
        able = " or ".join(shown(own.name) for own in METHODS.values() if own.follows_switches)
        hint = "a rope that slackens and is caught switches equations"
        yield Fault("", "solver.method", f"{able} with an elastic rope", shown(name), hint)
    rtol, atol = si_at(tree, "solver.rtol", "1", 1e-8), si_at(tree, "solver.atol", "1", 1e-10)
    if rtol and atol and (reason := method.refusal(rtol, atol)):
        yield Fault("", "solver.rtol", f"tolerances at which {name} is stable", f"{rtol:g}, atol {atol:g}", reason)


def _check_output(tree: dict[str, Any]) -> Iterator[Fault]:
    """Output steps that do not fit the span."""
    duration, step = si_at(tree, "run.duration", "s"), si_at(tree, "run.output_step", "s", 0.05)
    if not (duration and step and duration > 0.0 and step > 0.0):
        return
    if step > duration:
        hint = "no output would fall into the run"
        yield Fault("", "run.output_step", f"at most run.duration, {duration:g} s", f"{step:g} s", hint)
    elif duration / step > MOST_SAMPLES:
        got = f"{step:g} s, which makes {duration / step:.3g}"
        yield Fault("", "run.output_step", f"at most {MOST_SAMPLES} output samples", got, "ms or s mixed up?")


def _check_elements(tree: dict[str, Any]) -> Iterator[Fault]:
    """Fewer unknowns than wanted modes."""
    count, elements = si_at(tree, "modes.count", "1", 4), si_at(tree, "modes.elements", "1", 32)
    if count and elements and count >= 2 * elements:
        wanted = f"more than {count / 2:g} elements for {count:g} modes"
        yield Fault("", "modes.elements", wanted, f"{elements:g}", "each element adds two unknowns")


def _check_drag(tree: dict[str, Any]) -> Iterator[Fault]:
    """Drag that is given twice."""
    area, force = at(tree, "payload.drag_area"), at(tree, "payload.drag")
    if area is not None and force is not None:
        wanted = "the load's drag once: drag_area (an area) or drag (a force per squared speed)"
        yield Fault("", "payload.drag", wanted, f"{shown(force)} beside drag_area = {shown(area)}", "leave one out")


def _check_friction(tree: dict[str, Any]) -> Iterator[Fault]:
    """A law of friction that lacks its numbers."""
    law = at(tree, "crane.friction.law")
    needs = {"tanh": (("torque", "N m", "22 N m"), ("rate", "rad/s", "0.01 rad/s")),
             "stick-slip": (("torque", "N m", "22 N m"),)}  # fmt: skip
    for name, unit, example in needs.get(law, ()) if isinstance(law, str) else ():
        key = f"crane.friction.{name}"
        if si_at(tree, key, unit, 0.0) == 0.0:
            wanted = f'a {name} above 0, such as "{example}": the law "{law}" needs it'
            got = at(tree, key)
            yield Fault("", key, wanted, "nothing: the key is missing" if got is None else shown(got))
