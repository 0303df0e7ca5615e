"""What drives are to do: motions as commanded, and how their ramps are to be shaped."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, partial
from typing import TYPE_CHECKING

from towercrane.motions.motion import Motion, sequence
from towercrane.motions.ramps import ramps, shape_ramps

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from towercrane.motions.shaping import Shaper

    Times = tuple[tuple[float, ...], ...]
    FrequenciesAt = Callable[[str, float, float], Sequence[float]]

SETTLED = 1e-9
"""Change of a ramp's time from round to round that is none [s]."""

MOST_ROUNDS = 50
"""Rounds after which the times of the ramps have to have settled."""


class NotSettled(ArithmeticError):
    """Frequencies and times of the ramps that depend on each other found no agreement."""


@dataclass(frozen=True, slots=True)
class Shaping:
    """How the ramps of a motion are shaped.

    Parameters
    ----------
    design : callable
        Shaper from frequencies [Hz] and a damping ratio, such as :func:`towercrane.motions.shaping.zvd`.
    frequencies : tuple of float, optional
        [Hz]; without, those that the crane has when a ramp happens.
    damping_ratio : float
        Of the modes, as a fraction of critical.
    """

    design: Callable[[Sequence[float], float], Shaper]
    frequencies: tuple[float, ...] | None = None
    damping_ratio: float = 0.0


@dataclass(frozen=True, eq=False)
class Move:
    """One motion between two rests.

    Parameters
    ----------
    commanded : Motion
    shaping : Shaping, optional
        Without, the drive does what is commanded.
    """

    commanded: Motion
    shaping: Shaping | None = None

    @cached_property
    def ramp_ends(self) -> tuple[float, ...]:
        """When each ramp that is to be shaped ends as commanded [s]."""
        return tuple(ramp.end for ramp in ramps(self.commanded)) if self.shaping else ()

    def shaped(
        self, frequencies: Callable[[float], Sequence[float]], ramp_ends: Sequence[float]
    ) -> tuple[Motion, Sequence[float]]:
        """The motion, and when its ramps end [s].

        Parameters
        ----------
        frequencies : callable
            What the crane has at a time [Hz].
        ramp_ends : sequence of float
            When the ramps are thought to end [s].
        """
        if self.shaping is None:
            return self.commanded, ()
        s = self.shaping
        shapers = [s.design(s.frequencies or frequencies(time), s.damping_ratio) for time in ramp_ends]
        return shape_ramps(self.commanded, shapers)


@dataclass(frozen=True, eq=False)
class Plan:
    """Moves of one drive, one after the other.

    Parameters
    ----------
    moves : tuple of Move
        One or more.
    """

    moves: tuple[Move, ...]

    @cached_property
    def commanded(self) -> Motion:
        """The motion before shaping."""
        return self.moves[0].commanded if len(self.moves) == 1 else sequence(*(m.commanded for m in self.moves))

    @property
    def at_speed(self) -> bool:
        """Whether it begins at speed or goes on at speed."""
        return bool(self.commanded(0.0, 1)) or bool(self.commanded.end_rate)

    @property
    def needs_model(self) -> bool:
        """Whether a move is shaped for what the crane's frequencies are."""
        return any(m.shaping is not None and m.shaping.frequencies is None for m in self.moves)

    @property
    def ramp_ends(self) -> Times:
        """When each ramp that is to be shaped ends as commanded [s], by move."""
        found, now = [], 0.0
        for move in self.moves:
            found.append(tuple(now + end for end in move.ramp_ends))
            now += move.commanded.duration
        return tuple(found)

    def shaped(self, frequencies: Callable[[float], Sequence[float]], ramp_ends: Times) -> tuple[Motion, Times]:
        """The motion, and when its ramps end.

        Parameters
        ----------
        frequencies : callable
            What the crane has at a time [Hz].
        ramp_ends : tuple of tuple of float
            When the ramps are thought to end [s], by move.
        """
        motions: list[Motion] = []
        found, now = [], 0.0
        for move, times in zip(self.moves, ramp_ends, strict=True):
            motion, ends = move.shaped(frequencies, times)
            motions.append(motion)
            found.append(tuple(now + end for end in ends))
            now += motion.duration
        return motions[0] if len(motions) == 1 else sequence(*motions), tuple(found)


def shaped_motions(plans: Mapping[str, Plan], frequencies: FrequenciesAt | None = None) -> dict[str, Motion]:
    """Motions of all drives, each ramp shaped for where trolley and hook are as it ends.

    Shaping moves the ramps and so changes the places: this is repeated until the ends of the ramps have settled.

    Parameters
    ----------
    plans : dict of str to Plan
        By channel; "trolley" and "rope" among them, or the angle "luffing" in place of the trolley.
    frequencies : callable, optional
        What a drive excites [Hz], from its channel, the trolley's position [m] or that angle [rad], and the rope's
        length [m]; such as
        :class:`towercrane.cranes.tower.sway_frequencies.SwayFrequencies`.

    Raises
    ------
    NotSettled
        If they do not.
    ValueError
        If frequencies or the motions that they depend on are needed and missing.
    """
    motions = {channel: plan.commanded for channel, plan in plans.items()}
    ramp_ends = {channel: plan.ramp_ends for channel, plan in plans.items()}
    for _ in range(MOST_ROUNDS):

        def excited(channel: str, time: float, motions: dict[str, Motion] = motions) -> Sequence[float]:
            place = "luffing" if "luffing" in motions else "trolley"
            if frequencies is None or not {place, "rope"} <= set(motions):
                raise ValueError(f"shaped_motions: {channel} wants frequencies of a crane, its trolley and its rope")
            return frequencies(channel, float(motions[place](time)), float(motions["rope"](time)))

        found = {name: plan.shaped(partial(excited, name), ramp_ends[name]) for name, plan in plans.items()}
        motions = {name: motion for name, (motion, _) in found.items()}
        settled = {name: times for name, (_, times) in found.items()}
        changes = (
            abs(now - then)
            for name in plans
            for after, before in zip(settled[name], ramp_ends[name], strict=True)
            for now, then in zip(after, before, strict=True)
        )
        if max(changes, default=0.0) < SETTLED:
            return motions
        ramp_ends = settled
    raise NotSettled(f"the times of the ramps have not settled in {MOST_ROUNDS} rounds: {ramp_ends}")
