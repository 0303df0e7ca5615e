"""Summary of a run: peaks, periods, spectrum, balance, and what deserves a second look."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cases.assumptions import idle_in_file, left_out
from towercrane.cranes.kind import Natural
from towercrane.cranes.parts.hoisting.letting_go import CHANNEL
from towercrane.cranes.registry import KINDS
from towercrane.runs.extremes import extremes_of
from towercrane.runs.loads import loads_of
from towercrane.runs.release import release_report
from towercrane.runs.slack import rope_notice, rope_report
from towercrane.runs.vibration import vibration
from towercrane.simulation.arguments import TIGHTEST
from towercrane.simulation.energy_balance import NOT_CONSERVED
from towercrane.simulation.methods.registry import method_of
from towercrane.simulation.outcomes import FINISHED, SLACK_ROPE
from towercrane.simulation.system import NoEquilibrium

if TYPE_CHECKING:
    from towercrane.cases.case import Case
    from towercrane.results.recording import Result
    from towercrane.simulation.run import Run

TUNED = 0.05
"""Structure and twice the swing count as tuned when their frequencies differ by less than this fraction."""

GROWTH = 1.5
"""Growth of the swing after the drives have stopped that is named."""

LOOSE = 1e-3
"""Gap in the energy balance, relative to the change, that is named."""

REMEDIES = {SLACK_ROPE: "a rope that does not stretch cannot be caught; with rope.stiffness it goes on"}
"""What is said of outcomes that a case can avoid."""

SMALL = 0.1
"""Tip deflection over length beyond which slopes are not small."""


def summarise(case: Case, run: Run) -> dict[str, Any]:
    """Summary of a run of a case, ready for JSON.

    Returns
    -------
    dict
        ``outcome``, ``end_time_s``, ``peaks`` per variable (maximum, maximum_time_s, minimum, minimum_time_s,
        units) between the looks ``look_step_s`` apart from ``evaluated_from_s`` on, when turbulence has risen,
        ``loads`` (see :func:`towercrane.runs.loads.loads_of`),
        ``spectrum_peaks_hz`` of the structure (of its free vibration where that is long enough) at frequencies of
        the crane, ``spectrum_other_hz`` (at none of them), ``spectrum_to_hz`` (None without a spectrum),
        ``spectrum_beyond_hz`` (natural frequencies out of its sight), ``swing_period_s`` after the drives have
        stopped (None without a regular swing),
        ``natural_frequencies_hz`` where the run ended, in space their ``natural_kinds``, ``energy_balance``,
        ``rope`` of one that stretches (see :func:`towercrane.runs.slack.rope_report`),
        ``release`` where the load lets go (see :func:`towercrane.runs.release.release_report`),
        ``expected``, ``notices``, ``assumed``, ``idle`` (what the crane file holds for other cases), ``solver``,
        ``wall_seconds``; ``accuracy`` where the case asks for an error, see
        :func:`towercrane.accuracy.promise.promise`.
    """
    attributes, found = run.attrs, extremes_of(run)
    free = _after_the_drives(run)
    natural = _natural(case, run, float(attributes["end_time"]))
    frequencies = natural.frequencies
    swings = [frequencies[index] for index in natural.swings.values()]
    shown = vibration(
        KINDS[case.kind].signals, run, free, swings, frequencies, lambda: _at_the_start(case, run, natural)
    )
    return {
        "case": case.name,
        "title": case.title,
        "changes": list(case.changes),
        "crane": attributes["crane"],
        "outcome": attributes["outcome"],
        "message": attributes["message"],
        "end_time_s": float(attributes["end_time"]),
        "output_step_s": float(attributes["output_step"]),
        "look_step_s": shown.step,
        "evaluated_from_s": float(attributes["evaluated_from"]),
        "peaks": {
            name: {
                "maximum": highest.value,
                "maximum_time_s": highest.time,
                "minimum": found.lowest[name].value,
                "minimum_time_s": found.lowest[name].time,
                "units": run[name].units,
            }
            for name, highest in found.highest.items()
        },
        "loads": loads_of(run, found),
        **shown.report(),
        "natural_frequencies_hz": frequencies,
        **({"natural_kinds": natural.kinds} if natural.kinds else {}),
        "swing_mode": natural.swing_mode,
        "energy_balance": energy_balance(run),
        "expected": expected(case, run),
        "notices": [*notices(case, run, natural, free), *rope_notice(run, found), *shown.unseen],
        "assumed": [{"key": key, "value": value, "why": why} for key, value, why in assumed(run)],
        "left_out": left_out(case),
        "idle": list(idle_in_file(case)),
        "solver": {
            key: attributes[key]
            for key in (
                "method", "rtol", "atol", "evaluations", "steps_accepted", "steps_rejected", "smallest_step",
                "solver_cpu_seconds", "solver_wall_seconds",
            )
        },
        "versions": json.loads(attributes["versions"]),
        "wall_seconds": attributes["wall_seconds"],
        **({"rope": rope} if (rope := rope_report(run)) else {}),
        **({"release": released} if (released := release_report(case, run, found)) else {}),
        **({"accuracy": promised} if (promised := accuracy(run)) else {}),
    }  # fmt: skip


def accuracy(result: Result) -> dict[str, Any] | None:
    """What a run promises of its errors; None where none was asked for."""
    found: dict[str, Any] | None = json.loads(result.attrs.get("accuracy", "null"))
    return found


def assumed(result: Result) -> list[tuple[str, str, str]]:
    """Key, value and reason of every value that no source gives."""
    return [tuple(entry) for entry in json.loads(result.attrs.get("assumed", "[]"))]


def peaks(result: Result) -> dict[str, dict[str, Any]]:
    """Extremes of every variable over time alone among the looks at a run, with their times.

    While turbulence rises none are taken; of a run that ended before then its end counts.
    """
    found, times = {}, result["time"].values
    first = min(int(np.searchsorted(times, result.attrs.get("evaluated_from", 0.0))), len(times) - 1)
    times = times[first:]
    for name, variable in result.data_vars.items():
        if variable.dims != ("time",):
            continue
        values = variable.values[first:]
        high, low = int(np.argmax(values)), int(np.argmin(values))
        found[str(name)] = {
            "maximum": float(values[high]),
            "maximum_time_s": float(times[high]),
            "minimum": float(values[low]),
            "minimum_time_s": float(times[low]),
            "units": variable.attrs["units"],
        }
    return found


def energy_balance(result: Result) -> dict[str, float]:
    """Gap between energy gained and work put in: the run's own check of its equations and steps."""
    energy, work = result["total_energy"].values, result["input_work"].values
    # A run that goes on from another begins with that one's work.
    work = work - work[0]
    gap = abs(energy - energy[0] - work)
    # Where nothing is put in, the load's height and speed still exchange energy. A crane at rest exchanges none; its
    # gap is judged by the load's energy at a small swing.
    weight = result.attrs["payload_mass"] * result.attrs["gravity"]
    lifted = weight * float(np.ptp(result["payload_position"].values[:, -1]))
    pendulum = 1e-3 * weight * float(result["rope_length"].values[0])
    scale = max(float(np.ptp(energy)), float(np.ptp(work)), lifted, pendulum)
    return {
        "largest_gap_j": float(gap.max()),
        "relative_gap": float(gap.max() / scale),
        "energy_change_j": float(energy[-1] - energy[0]),
        "input_work_j": float(work[-1]),
    }


def expected(case: Case, result: Result) -> dict[str, Any] | None:
    """What the case expects beside what the run came to; None for a case that expects nothing.

    Returns
    -------
    dict
        ``met``, and ``misses``, a sentence for each expectation that was not met.
    """
    if case.expect is None:
        return None
    misses = []
    if result.attrs["outcome"] != case.expect.outcome:
        misses.append(f'expected the outcome "{case.expect.outcome}", got "{result.attrs["outcome"]}"')
    gap, most = energy_balance(result)["relative_gap"], case.expect.energy_gap
    if most is not None and not gap <= most:
        misses.append(f"expected an energy balance within {most:g}, got {gap:.2g}")
    return {"met": not misses, "misses": misses}


def notices(case: Case, run: Run, natural: Natural, free: slice) -> list[str]:
    """What deserves a second look, in sentences."""
    found = []
    if run.attrs["outcome"] != FINISHED:
        said = run.attrs["message"] or REMEDIES.get(run.attrs["outcome"], "")
        reason = f": {said}" if said else ""
        found.append(f"ended at {run.attrs['end_time']:.6g} s: {run.attrs['outcome']}{reason}")
    if (promised := accuracy(run)) and promised["reasons"]:
        found.append(f"error asked for: {promised['outcome']}: {'; '.join(promised['reasons'])}")
    found += json.loads(run.attrs["notices"])
    tension = run["hoist_rope_force"].values
    if case.rope.slack == "rod" and tension.min() < 0.0:
        first = float(run["time"].values[int(np.argmax(tension < 0.0))])
        found.append(
            f"the rope pushes from {first:.2f} s on (down to {tension.min():.0f} N): "
            "a real rope would be slack there; this case takes it as a rod"
        )
    said = method_of(run.attrs["method"]).notice(run.attrs["rtol"], run.attrs["atol"])
    if said and not _as_asked(run):
        found.append(said)
    gap = energy_balance(run)["relative_gap"]
    if gap > LOOSE and run.attrs["outcome"] != NOT_CONSERVED:
        tight = [max(run.attrs[name] * LOOSE / gap, TIGHTEST) for name in ("rtol", "atol")]
        remedy = "with solver.rtol {:.0e} and solver.atol {:.0e} it would be about a thousandth".format(*tight)
        found.append(f"the energy balance is off by {gap:.1e} of the change: {remedy}")
    kind = KINDS[case.kind]
    for name, length in (kind.lengths(run.model) if kind.lengths else {}).items():
        share = float(abs(run[name].values).max()) / length
        if share > SMALL:
            what = name.replace("_", " ")
            found.append(f"{what} reaches {share:.0%} of the beam's length: beyond the small slopes of the model")
    for signal, swing in natural.swings.items():
        found += _parametric(run, natural.frequencies, signal, swing, free)
    return found


def _parametric(result: Result, frequencies: list[float], signal: str, swing: int, free: slice) -> list[str]:
    """Structure at twice the swing frequency: a small ringing then pumps the swing."""
    own = frequencies[swing]
    tuned = [f for f in frequencies if abs(f / (2.0 * own) - 1.0) < TUNED]
    if not tuned:
        return []
    ratio = f"structure at {tuned[0]:.3f} Hz, twice the swing's {own:.3f} Hz within {TUNED:.0%}"
    angle, times = abs(result[signal].values[free]), result["time"].values[free]
    first = angle[: max(1, int(np.sum(times < times[:1] + 1.0 / own)))]
    before, after = float(first.max(initial=0.0)), float(angle.max(initial=0.0))
    if before > 0.0 and after > GROWTH * before:
        return [
            f"parametric resonance ({ratio}): the swing grew from {before:.4f} to {after:.4f} rad "
            "after the drives had stopped"
        ]
    return [f"2:1 tuning ({ratio}): a ringing structure can pump the swing; in this run it did not"]


def _natural(case: Case, run: Run, at: float) -> Natural:
    """Natural frequencies where the drives are at a time of a run [s]; nothing for a tower that buckles."""
    natural = KINDS[case.kind].natural
    try:
        if natural is None:
            return Natural(_linearised(run, at), [], {})
        return natural(run.model, {channel: float(motion(at)) for channel, motion in run.motions.items()})
    except NoEquilibrium:
        return Natural([], [], {})


def _at_the_start(case: Case, run: Run, at_the_end: Natural) -> list[float]:
    """Natural frequencies [Hz] where the run began."""
    ways = [run[name].values for name in ("trolley_position", "luffing_command", "rope_length") if name in run]
    if KINDS[case.kind].natural is None or (CHANNEL not in run.motions and all(way[0] == way[-1] for way in ways)):
        return at_the_end.frequencies
    return _natural(case, run, 0.0).frequencies


def _linearised(run: Run, at: float) -> list[float]:
    """Frequencies [Hz] about the equilibrium with the drives where they are at a time [s]."""
    from towercrane.linear.linearise import linearise

    found = linearise(run.model, run.motions, time=at, outputs=[]).eigenvalues()
    return sorted(e.frequency for e in found if e.value.imag > 0.0)


def _after_the_drives(run: Run) -> slice:
    """Rows after the last drive has stopped."""
    stop = max(motion.stop for motion in run.motions.values())
    return slice(int(np.searchsorted(run.times, stop)), None)


def _as_asked(run: Run) -> bool:
    """Whether a run keeps the error that was asked for: what the solver damps is within it."""
    if (promised := accuracy(run)) is None:
        return False
    from towercrane.accuracy.promise import AS_ASKED

    return promised["outcome"] in AS_ASKED
