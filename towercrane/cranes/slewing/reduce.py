"""Lumped cranes with members made rigid: degrees of freedom leave by substitution in the data."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping

    from towercrane.cranes.slewing.description import LumpedCrane, Row


def make_rigid(crane: LumpedCrane, members: Collection[str]) -> LumpedCrane:
    """The crane with these springs infinitely stiff: the coordinate that each stretches follows the others.

    Parameters
    ----------
    crane : LumpedCrane
    members : collection of str
        Names of springs; "rope" for an elastic rope.

    Raises
    ------
    ValueError
        If a name is not a spring's, or the member's stretch is not one coordinate alone or the difference of two.
    """
    known = [spring.name for spring in crane.springs] + (["rope"] if crane.rope else [])
    for name in members:
        if name not in known:
            raise ValueError(f"make_rigid: wanted springs among {', '.join(known)}, got {name!r}")
        if name == "rope":
            crane = replace(crane, rope=None)
            continue
        # Each spring is looked up anew: an earlier substitution may have changed its stretch.
        spring = next(s for s in crane.springs if s.name == name)
        crane = _without(replace(crane, springs=tuple(s for s in crane.springs if s.name != name)), spring.stretch)
    return crane


def _without(crane: LumpedCrane, stretch: Row) -> LumpedCrane:
    """Take out the first coordinate of a stretch that is held at zero."""
    forms = {name: value for name, value in stretch.items() if value}
    gone, factor = next(iter(forms.items()))
    others = {name: -value / factor for name, value in forms.items() if name != gone}
    if len(others) > 1 or any(value != 1.0 for value in others.values()):
        raise ValueError(
            f"make_rigid: wanted one coordinate or the difference of two, got the stretch {dict(stretch)}"
        )
    follows = next(iter(others), "")
    if not follows and crane.jib_angle == gone:
        raise ValueError(f"make_rigid: the jib's angle {gone!r} cannot be fixed in space")

    def row(form: Row) -> Mapping[str, float]:
        kept = {name: value for name, value in form.items() if name != gone}
        if gone in form and follows:
            kept[follows] = kept.get(follows, 0.0) + form[gone]
        return kept

    def name_of(coordinate: str) -> str:
        return follows if coordinate == gone else coordinate

    points = {
        label: replace(
            point,
            links=tuple(
                replace(link, turns_with=name_of(link.turns_with), ahead=row(link.ahead), across=row(link.across))
                for link in point.links
            ),
            height=row(point.height),
        )
        for label, point in crane.points.items()
    }
    linear_outputs = {
        label: replace(output, of=row(output.of), of_rates=row(output.of_rates))
        for label, output in crane.linear_outputs.items()
    }
    return replace(
        crane,
        coordinates=tuple(name for name in crane.coordinates if name != gone),
        points=points,
        springs=tuple(replace(spring, stretch=row(spring.stretch)) for spring in crane.springs),
        drive=replace(crane.drive, on=name_of(crane.drive.on)),
        inertias=row(crane.inertias),
        steady_force=row(crane.steady_force),
        counter_moments=row(crane.counter_moments),
        jib_angle=name_of(crane.jib_angle),
        # What was read off the stretch of a member that is rigid now has no output any more.
        linear_outputs={
            label: r for label, r in linear_outputs.items() if any(r.of.values()) or any(r.of_rates.values())
        },
    )
