"""The table of a case that says when how much of the load lets go."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

from towercrane.kernels.load import AIR_DENSITY, Release
from towercrane.schema.faults import Fault, shown
from towercrane.schema.fields import AreaIfAny, LengthIfAny, MassIfAny, Quantity, Ratio, Table, Time, Wait
from towercrane.schema.ranges import at, si_at

if TYPE_CHECKING:
    from collections.abc import Iterator

    from towercrane.schema.fields import Payload

STANDARD = "EN 13001-2:2014"
"""Where the factors beta_3 are from: its phi_3 = 1 - (dm / m) (1 + beta_3)."""


class Released(Table):
    """What of the load lets go, all of it where neither a mass nor a fraction is stated; a standard's beta_3 of slow
    release (grabs) and of rapid release (magnets). Half the width of the base says when the crane tips backward."""

    time: Time
    mass: MassIfAny = None
    fraction: Annotated[float | None, Quantity("1", above=0, most=1)] = None
    duration: Wait = 0.0
    drag_area: AreaIfAny = None
    base_half_width: LengthIfAny = None
    standard: str = STANDARD
    slow_beta: Ratio = 0.5
    rapid_beta: Ratio = 1.0


def release_of(payload: Payload, released: Released) -> Release:
    """What lets go; its drag is in proportion to its mass where none is stated."""
    mass = released.mass or payload.mass * (1.0 if released.fraction is None else released.fraction)
    area = released.drag_area
    if area is None:
        area = (payload.drag_area or 2.0 * payload.drag / AIR_DENSITY) * (mass / payload.mass)
    return Release(mass, area)


REFUSED = ("compare", "shape", "verify")
"""Studies that know no load that lets go."""


def refused(released: Released | None) -> dict[str, str]:
    """Uses that a case cannot serve whose load lets go, and why."""
    return dict.fromkeys(REFUSED if released is not None else (), "the load lets go: it takes the load as it is")


def check_release(tree: dict[str, Any]) -> Iterator[Fault]:
    """Faults of what is to let go, beside the load, the run and the model."""
    if not isinstance(at(tree, "release"), dict):
        return
    written = tree["release"]

    def fault(key: str, wanted: str, hint: str = "") -> Fault:
        return Fault("", f"release.{key}", wanted, shown(written[key]), hint)

    time, end = si_at(tree, "release.time", "s"), si_at(tree, "run.duration", "s")
    if time is not None and end is not None and time >= end:
        yield fault("time", f"a time before the run's end, {end:g} s", "the load would hang on all along")
    whole, mass = si_at(tree, "payload.mass", "kg"), si_at(tree, "release.mass", "kg")
    if "mass" in written and "fraction" in written:
        yield fault("fraction", "no key beside mass", "what lets go is stated once")
    elif whole is not None and mass is not None and mass > whole:
        yield fault("mass", f"up to {whole:g} kg, the mass of the load", "more would go than there is")
    fraction = si_at(tree, "release.fraction", "1", 1.0)
    everything = mass == whole if "mass" in written else fraction == 1.0
    if everything and si_at(tree, "release.duration", "s", 0.0):
        yield fault(
            "duration", "no duration where all of the load goes", "state mass: the hook stays, or let go at once"
        )
    area = si_at(tree, "release.drag_area", "m^2")
    if area is not None:
        force = si_at(tree, "payload.drag", "N s^2/m^2", 0.0) or 0.0
        load = si_at(tree, "payload.drag_area", "m^2", 0.0) or 2.0 * force / AIR_DENSITY
        if everything:
            yield fault("drag_area", "no key where all of the load goes", "all of its drag goes too")
        elif area > load:
            yield fault("drag_area", f"up to {load:g} m^2, that of the load", "more would go than there is")
    betas = {"slow_beta", "rapid_beta"} & set(written)
    if betas and "standard" not in written:
        yield fault(min(betas), "the standard that it is from, release.standard, beside it", f"else it is {STANDARD}")
    if isinstance(at(tree, "ground"), dict):
        hint = "the load would stand there with a mass that changes"
        yield Fault("", "ground", "no ground under a load that lets go", "[ground] beside [release]", hint)
    if at(tree, "model.weight_softening") is True or at(tree, "accuracy.frequency") is not None:
        key = "model.weight_softening" if at(tree, "model.weight_softening") is True else "accuracy.frequency"
        hint = "a tower that weights soften would be stiffer after it; overturning_moment has their moments anyway"
        yield Fault("", key, "no key beside [release]", shown(at(tree, key)), hint)
    if (target := at(tree, "accuracy.target")) is not None:
        hint = "small motions do not tell of a load that goes; state modes and solver.rtol instead"
        yield Fault("", "accuracy.target", "no error to ask for beside [release]", shown(target), hint)
