"""Motions among which a planner may choose: as commanded, shaped in several ways, and of least jerk."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from towercrane.cranes.tower.sway_frequencies import TURNS
from towercrane.motions.plans import Move, Plan, Shaping, shaped_motions
from towercrane.motions.ramps import ramps
from towercrane.motions.shaping import boxes, ei, minimum_jerk, zv, zvd

if TYPE_CHECKING:
    from collections.abc import Mapping

    from towercrane.motions.motion import Motion
    from towercrane.motions.plans import FrequenciesAt

ROUNDING = 1e-9
"""Relative excess of a limit that is none."""

HORIZONTAL = ("trolley", "luffing", *TURNS)
"""Drives whose ramps make a load sway. A hoist makes it sway by its speed, which shaping does not lessen."""


@dataclass(frozen=True, eq=False)
class Candidate:
    """Motions of all drives, ready to run.

    Parameters
    ----------
    name : str
        As short as a case's shape, such as "zvd".
    title : str
        For people.
    motions : dict of str to Motion
        By channel.
    within_limits : bool
        Whether no drive is faster or accelerates more than commanded.
    """

    name: str
    title: str
    motions: dict[str, Motion]
    within_limits: bool = True

    @property
    def duration(self) -> float:
        """When the last drive stops [s]."""
        return max(motion.duration for motion in self.motions.values())


def candidates(plans: Mapping[str, Plan], model: FrequenciesAt, pendulum: FrequenciesAt) -> list[Candidate]:
    """Motions for the same ways: horizontal drives are replanned, the others do as they are told.

    Parameters
    ----------
    plans : dict of str to Plan
        By channel; "trolley" or "luffing" and "rope" among them.
    model : callable
        What a drive excites [Hz], see :func:`towercrane.motions.plans.shaped_motions`.
    pendulum : callable
        The same of a load on a crane that does not give.

    Raises
    ------
    ValueError
        If no horizontal drive moves.
    """
    if not driven(plans):
        raise ValueError("candidates: wanted a trolley, a luffing or a slewing drive that moves, got none")
    plain = _replanned(plans, None)
    found = [Candidate("commanded", "as commanded", shaped_motions(plain, model))]
    if any(move.shaping for channel in driven(plans) for move in plans[channel].moves):
        found.append(Candidate("case", "as in the case", shaped_motions(plans, model)))
    rigid = shaped_motions(_replanned(plans, Shaping(zv)), pendulum)
    found.append(Candidate("zv-pendulum", "ZV, sqrt(g/l)", rigid))
    for name, title, design in (
        ("zv", "ZV", zv),
        ("zvd", "ZVD", zvd),
        ("ei", "EI 5 %", ei),
        ("boxes", "boxes", boxes),
    ):
        shaped = shaped_motions(_replanned(plans, Shaping(design)), model)
        found.append(Candidate(name, title, shaped))
    as_long = next(c for c in found if c.name == "zvd").motions
    smooth = shaped_motions(_smoothest(plans, as_long), model)
    kept = all(_keeps(smooth[channel], plans[channel].commanded) for channel in driven(plans))
    title = "minimum jerk" if kept else "minimum jerk, too fast"
    found.append(Candidate("minimum-jerk", title, smooth, kept))
    return found


def driven(plans: Mapping[str, Plan]) -> list[str]:
    """Horizontal drives that move."""
    return [c for c, plan in plans.items() if c in HORIZONTAL and any(map(_moves, plan.moves))]


def _keeps(motion: Motion, limits: Motion) -> bool:
    """Whether a motion is never faster and never accelerates more than another."""
    largest = ((max(map(abs, m.range(order))) for m in (motion, limits)) for order in (1, 2))
    return all(mine <= bound * (1.0 + ROUNDING) for mine, bound in largest)


def _moves(move: Move) -> bool:
    return bool(ramps(move.commanded))


def _replanned(plans: Mapping[str, Plan], shaping: Shaping | None) -> dict[str, Plan]:
    """Plans whose horizontal drives are shaped like this and not otherwise."""
    return {
        channel: Plan(tuple(replace(m, shaping=shaping if _moves(m) else None) for m in plan.moves))
        if channel in HORIZONTAL
        else plan
        for channel, plan in plans.items()
    }


def _smoothest(plans: Mapping[str, Plan], as_long: Mapping[str, Motion]) -> dict[str, Plan]:
    """Plans of least jerk, each drive taking as long as another motion of it."""
    smooth = dict(plans)
    for channel in driven(plans):
        plan = plans[channel]
        longer = as_long[channel].duration - plan.commanded.duration
        share = longer / sum(map(_moves, plan.moves))
        smooth[channel] = Plan(tuple(_smooth(m.commanded, share) if _moves(m) else m for m in plan.moves))
    return smooth


def _smooth(motion: Motion, longer: float) -> Move:
    start = float(motion.coefficients[0, 0])
    return Move(minimum_jerk(start, motion.end, motion.duration + longer))
