"""How still different motions leave the load, how surely, and at what cost; and which of them to take."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cranes.tower.modes.damping import ModalDamping
from towercrane.cranes.tower.sway_frequencies import PendulumFrequencies, SwayFrequencies
from towercrane.motions.motion import Motion, phases, rest
from towercrane.simulation.outcomes import FINISHED, INTERRUPTED
from towercrane.simulation.simulate import simulate
from towercrane.simulation.system import start_inputs
from towercrane.studies.candidates import Candidate, candidates, driven

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    import xarray as xr
    from numpy.typing import NDArray

    from towercrane.cranes.tower.model import FlexibleModel
    from towercrane.motions.plans import Plan

    Floats = NDArray[np.float64]

WATCHED = 40.0
"""Time after the last motion over which the load is watched [s]."""

DAMPING = 0.01
"""Of every mode of the structure, as a fraction of critical."""

ROPES = (0.8, 0.9, 1.0, 1.1, 1.2)
"""Rope lengths relative to the planned one."""

TORSIONS = (0.85, 1.15)
"""Torsional stiffnesses of the tower relative to the model's."""

ALLOWED = 0.1
"""Residual that counts as rest [m]."""

AS_LONG = 0.1
"""Durations that differ by less are the same [s]."""

RTOL = 1e-7


@dataclass(frozen=True, slots=True)
class Trial:
    """One motion on one crane.

    Parameters
    ----------
    residual : float or None
        Largest horizontal distance of the load from its final rest after the last motion [m]; None if the run ended
        before.
    torque, force : float
        Largest torque of the slewing drive [N m]; force of the trolley's, or in the luffing rope [N].
    outcome : str
        "finished", or what ended the run.
    """

    residual: float | None
    torque: float
    force: float
    outcome: str


@dataclass(frozen=True, eq=False)
class Row:
    """A candidate and what became of it.

    Parameters
    ----------
    candidate : Candidate
    ropes, torsions : dict of float to Trial
        By rope length and torsional stiffness relative to what was planned for.
    """

    candidate: Candidate
    ropes: dict[float, Trial]
    torsions: dict[float, Trial]

    @property
    def nominal(self) -> Trial:
        """On the crane that it was planned for."""
        return self.ropes[1.0]

    @property
    def worst(self) -> float:
        """Largest residual on all cranes [m]; infinite if a run ended early."""
        trials = (*self.ropes.values(), *self.torsions.values())
        return max(np.inf if t.residual is None else t.residual for t in trials)


@dataclass(frozen=True, eq=False)
class RestStudy:
    """Candidates beside each other.

    Parameters
    ----------
    rows : list of Row
    allowed : float
        Residual that counts as rest [m].
    frequencies : dict of str to tuple
        What each planned drive excites where the motion begins and where it ends [Hz].
    """

    rows: list[Row]
    allowed: float
    frequencies: dict[str, tuple[tuple[float, ...], tuple[float, ...]]]

    @property
    def recommended(self) -> Row:
        """Of those within the drives' limits: the shortest that leaves every load at rest, else what leaves least."""
        able = [row for row in self.rows if row.candidate.within_limits]
        calm = [row for row in able if row.worst <= self.allowed]
        if not calm:
            return min(able, key=lambda row: row.worst)
        shortest = min(row.candidate.duration for row in calm)
        return min((r for r in calm if r.candidate.duration < shortest + AS_LONG), key=lambda row: row.worst)

    @property
    def reason(self) -> str:
        """Why it is recommended."""
        row = self.recommended
        cranes = f"rope {_around(ROPES)}" + (f" and torsional stiffness {_around(TORSIONS)}" if row.torsions else "")
        if row.worst == np.inf:
            return f"no motion keeps its load to the end with {cranes}"
        left = f"{row.worst:.3g} m at worst with {cranes}"
        if row.worst > self.allowed:
            return f"none keeps the load within {self.allowed:g} m; this leaves least, {left}"
        return f"the shortest that keeps the load within {self.allowed:g} m: {left}"


def study(
    model: FlexibleModel,
    plans: Mapping[str, Plan],
    *,
    allowed: float = ALLOWED,
    progress: Callable[[float], None] | None = None,
) -> RestStudy:
    """Try every candidate on the crane and on cranes that differ from it.

    The start is at equilibrium in still air; every mode of the structure is damped by 1 % of critical.

    Parameters
    ----------
    model : FlexibleModel
    plans : dict of str to Plan
        By channel; wind and ground are left out.
    allowed : float
        Residual that counts as rest [m].
    progress : callable, optional
        Called with the fraction that is done.

    Raises
    ------
    NoEquilibrium
        If the crane cannot stand where a ramp ends.
    ValueError
        If no horizontal drive moves.
    """
    crane = _studied(model)
    plans = {channel: plans[channel] for channel in crane.channels}
    sway, below = SwayFrequencies(model), sum(sling.length for sling in model.load.slings)
    tried = candidates(plans, sway, PendulumFrequencies(crane.crane.gravity, crane.crane, below))
    torsions = TORSIONS if crane.crane.torsion.count else ()
    trials, rows = len(ROPES) + len(torsions), []
    for number, candidate in enumerate(tried):
        done: dict[tuple[float, float], Trial] = {}
        for place in [*((rope, 1.0) for rope in ROPES), *((1.0, torsion) for torsion in torsions)]:
            done[place] = attempt(crane, candidate.motions, *place)
            if progress is not None:
                progress((number * trials + len(done)) / (len(tried) * trials))
        ropes = {rope: done[rope, 1.0] for rope in ROPES}
        rows.append(Row(candidate, ropes, {torsion: done[1.0, torsion] for torsion in torsions}))
    first, last = zip(*(_ends(plans[channel]) for channel in crane.channels[:2]), strict=True)
    frequencies = {c: (sway(c, *first), sway(c, *last)) for c in driven(plans)}
    return RestStudy(rows, allowed, frequencies)


def attempt(model: FlexibleModel, motions: Mapping[str, Motion], rope: float = 1.0, torsion: float = 1.0) -> Trial:
    """Run motions on a crane whose rope and torsional stiffness differ by these factors from what was planned for."""
    if torsion != 1.0:
        model = replace(model, crane=replace(model.crane, torsion=model.crane.torsion.with_stiffness(torsion)))
    told = motions["rope"]
    run = {**motions, "rope": Motion(told.switch_times, rope * told.coefficients)}
    stop = max(motion.duration for motion in run.values())
    result = simulate(model, run, stop + WATCHED, rtol=RTOL, atol=0.01 * RTOL)
    outcome = str(result.attrs["outcome"])
    if outcome == INTERRUPTED:
        raise KeyboardInterrupt
    residual = None
    if outcome == FINISHED:
        after = result["payload_position"].values[result["time"].values >= stop, :-1]
        residual = float(np.linalg.norm(after - resting_place(model, run), axis=1).max())
    torque = _peak(result["slewing_torque"]) if "slewing_torque" in result else 0.0
    force = "trolley_force" if "trolley_force" in result else "luffing_rope_force"
    return Trial(residual, torque, _peak(result[force]), outcome)


def resting_place(model: FlexibleModel, motions: Mapping[str, Motion]) -> Floats:
    """Horizontal position of the load at rest after the motions [m], shape (2,)."""
    still = {channel: rest(motions[channel].end) for channel in model.channels}
    inputs = start_inputs(model, motions, phases(tuple(still.values()), 1.0).inputs[0])
    state = model.start(inputs)
    slope, guards = model.system.slope(0.0, state, inputs)
    seen = model.observe(still, np.zeros(1), state[None], slope[None], guards[None])
    return seen["payload_position"].values[0, :-1]


def report(done: RestStudy) -> dict[str, Any]:
    """A study, ready for JSON.

    Returns
    -------
    dict
        ``frequencies_hz`` (by drive: at_start, at_end), ``candidates`` (a list with name, title, duration_s,
        within_limits, residual_m, worst_residual_m, rope_residual_m and torsion_residual_m by relative rope length
        and stiffness, peak_slewing_torque_Nm, peak_trolley_force_N or of a jib that pivots
        peak_luffing_rope_force_N, outcome), ``recommended``, ``reason``, ``allowed_m``, ``watched_s``,
        ``damping_ratio``.
    """
    return {
        "frequencies_hz": {
            drive: {"at_start": list(first), "at_end": list(last)}
            for drive, (first, last) in done.frequencies.items()
        },
        "candidates": [_row(row) for row in done.rows],
        "recommended": done.recommended.candidate.name,
        "reason": done.reason,
        "allowed_m": done.allowed,
        "watched_s": WATCHED,
        "damping_ratio": DAMPING,
    }


def _ends(plan: Plan) -> tuple[float, float]:
    """First and last value."""
    return float(plan.commanded(0.0)), plan.commanded.end


def _row(row: Row) -> dict[str, Any]:
    return {
        "name": row.candidate.name,
        "title": row.candidate.title,
        "duration_s": row.candidate.duration,
        "within_limits": row.candidate.within_limits,
        "residual_m": row.nominal.residual,
        "worst_residual_m": row.worst if np.isfinite(row.worst) else None,
        "rope_residual_m": {f"{rope:g}": trial.residual for rope, trial in row.ropes.items()},
        "torsion_residual_m": {f"{torsion:g}": trial.residual for torsion, trial in row.torsions.items()},
        "peak_slewing_torque_Nm": row.nominal.torque,
        f"peak_{'luffing_rope' if 'luffing' in row.candidate.motions else 'trolley'}_force_N": row.nominal.force,
        "outcome": row.nominal.outcome,
    }


def _studied(model: FlexibleModel) -> FlexibleModel:
    """The crane in still air on a ground at rest, every mode of its structure damped."""
    damping = ModalDamping(DAMPING, DAMPING, DAMPING, DAMPING, DAMPING, DAMPING)
    return replace(model, damping=damping, wind=False, ground=False, floors=0)


def _peak(values: xr.DataArray) -> float:
    return float(abs(values.values).max())


def _around(factors: tuple[float, ...]) -> str:
    return f"+-{100 * (max(factors) - 1):.0f} %"
