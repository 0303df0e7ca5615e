"""Runs, what they promise and what a richer model says of them, as tables on the terminal."""

from __future__ import annotations

from math import degrees
from typing import TYPE_CHECKING, Any

from towercrane.report.tables.layout import assumed_values as _assumed
from towercrane.report.tables.layout import by_table
from towercrane.report.tables.layout import console_of_reports as _console
from towercrane.report.tables.layout import report_table as _table

if TYPE_CHECKING:
    from rich.console import Console


def run_tables(summary: dict[str, Any]) -> None:
    """Summary of a run, as :func:`towercrane.runs.summary.summarise` gives it."""
    console = _console()
    table = _table(
        summary["title"]
        if summary["title"].startswith(summary["crane"])
        else f"{summary['crane']}: {summary['title']}",
        "variable",
        "maximum",
        "at [s]",
        "minimum",
        "at [s]",
        "unit",
    )
    for name, peak in summary["peaks"].items():
        table.add_row(
            name.replace("_", " "),
            f"{peak['maximum']:.5g}",
            f"{peak['maximum_time_s']:.2f}",
            f"{peak['minimum']:.5g}",
            f"{peak['minimum_time_s']:.2f}",
            peak["units"],
        )
    console.print(table)
    if risen := summary["evaluated_from_s"]:
        console.print(f"largest and smallest from {risen:.4g} s on, when the turbulence has risen")
    if summary["loads"]:
        _loads(console, summary["loads"])
    if "release" in summary:
        _release(console, summary["release"])
    for change in summary["changes"]:
        console.print(f"changed               {change}")
    period = summary["swing_period_s"]
    console.print(
        f"swing period          {f'{period:.4f} s' if period else 'none: no regular swing after the drives stopped'}"
    )
    _spectrum(console, summary)
    frequencies, kinds = summary["natural_frequencies_hz"], summary.get("natural_kinds")
    named = [f"{f:.4f}" + (f" {kinds[i]}" if kinds else "") for i, f in enumerate(frequencies[:5])]
    natural = ", ".join(named) or "none"
    console.print(f"natural frequencies   {natural} Hz where the run ended")
    balance, solver = summary["energy_balance"], summary["solver"]
    console.print(
        f"energy balance        {balance['largest_gap_j']:.2g} J off, {balance['relative_gap']:.1e} of the change"
    )
    console.print(
        f"solver                {solver['method']}, rtol {solver['rtol']:g}, {solver['evaluations']} evaluations, "
        f"{solver['solver_wall_seconds']:.3f} s in the solver, {summary['wall_seconds']:.3f} s in all"
    )
    if expected := summary["expected"]:
        for miss in expected["misses"] or ["met"]:
            console.print(f"expected by the case  {miss}", style="bold" if expected["misses"] else None)
    if "accuracy" in summary:
        _accuracy(console, summary["accuracy"])
    for notice in summary["notices"]:
        console.print(f"note     {notice}", style="bold")
    for left_out in summary["left_out"]:
        console.print(f"left out {left_out}")
    if summary["idle"]:
        unused = f"{by_table(summary['idle'])}: keys of the crane file that this run has no use for"
        console.print(f"unused   {unused}", markup=False)
    _assumed(console, summary["assumed"])


KILO = {"N": "kN", "N m": "kN m"}


def _loads(console: Console, loads: dict[str, dict[str, Any]]) -> None:
    """Design loads, as :func:`towercrane.runs.loads.loads_of` gives them."""
    table = _table("Loads and dynamic factors", "load", "unit", "largest", "at [s]", "static", "factor", left=2)
    for name, load in loads.items():
        most, static, factor = load[load["largest"]], load["static"], load["dynamic_factor"]
        # What is nothing but rounding at rest is nothing.
        resting = abs(static) > 1e-9 * abs(most["value"]) if static is not None else False
        table.add_row(
            name.replace("_", " "),
            KILO[load["units"]],
            f"{1e-3 * most['value']:.5g}",
            f"{most['time_s']:.2f}",
            "unknown" if static is None else f"{1e-3 * static if resting else 0.0:.4g}",
            f"{factor:.4g}" if factor else "",
        )
    console.print(table)
    console.print("static: at rest under the load, drives where they are at that time")
    if tips := loads.get("overturning_moment"):
        towards = round(degrees(tips[tips["largest"]]["direction_rad"]), 1) + 0.0
        console.print(f"largest overturning moment: tips towards {towards:.1f} deg from the x axis")


def _release(console: Console, released: dict[str, Any]) -> None:
    """Backward swing, as :func:`towercrane.runs.release.release_report` gives it."""
    what = f"{released['mass_kg']:g} kg ({released['fraction']:.0%} of the load)"
    title = f"After {what} let go at {released['time_s']:g} s"
    columns = "load", "unit", "before", "at rest after", "least", "at [s]", "largest", "at [s]", "1 + beta"
    table = _table(title, *columns, left=2)
    for name, load in released["swings_back"].items():
        after, factor = load["after"], load["one_plus_beta"]
        table.add_row(
            name.replace("_", " "),
            KILO[load["units"]],
            f"{1e-3 * load['before']:.5g}",
            "unknown" if after is None else f"{1e-3 * after:.5g}",
            f"{1e-3 * load['minimum']:.5g}",
            f"{load['minimum_time_s']:.2f}",
            f"{1e-3 * load['maximum']:.5g}",
            f"{load['maximum_time_s']:.2f}",
            f"{factor:.3g}" if factor else "",
        )
    console.print(table)
    standard, stability = released["standard"], released["stability"]
    console.print(
        f"{standard['name']}: 1 + beta_3 = {1 + standard['beta_slow']:g} for slow release, "
        f"{1 + standard['beta_rapid']:g} for rapid"
    )
    half = stability["half_width_m"]
    beside = f", {stability['used']:.0%} of half the base's width of {half:g} m" if half else ""
    tips = ": it tips over" if stability["tips"] else ""
    console.print(
        f"resultant at the base   {stability['eccentricity_m']:.3g} m from the axis, towards the jib positive, "
        f"at {stability['time_s']:.2f} s{beside}{tips}"
    )


def _spectrum(console: Console, summary: dict[str, Any]) -> None:
    """Peaks at frequencies of the crane, others, and how far the spectrum reaches."""

    def listed(key: str) -> str:
        return ", ".join(f"{f:.4f}" for f in summary[key])

    highest = summary["spectrum_to_hz"]
    reach = f", up to {highest:.4g} Hz" if highest else ""
    peaks = listed("spectrum_peaks_hz")
    peaks = f"{peaks} Hz" if peaks else "none"
    console.print(f"spectrum peaks        {peaks} in {summary['spectrum_of'].replace('_', ' ')}{reach}")
    if summary["spectrum_other_hz"]:
        console.print(
            f"                      {listed('spectrum_other_hz')} Hz too: no natural frequencies, "
            "they come from drives, wind or a wide swing"
        )
    if highest and (beyond := summary["spectrum_beyond_hz"]):
        last = f" to {beyond[-1]:.4g}" if len(beyond) > 1 else ""
        console.print(f"                      too fast to be seen: natural frequencies of {beyond[0]:.4g}{last} Hz")


def _accuracy(console: Console, promised: dict[str, Any]) -> None:
    """What was asked for, chosen and is expected, as :func:`towercrane.accuracy.promise.promise` gives it."""
    title = f"Error asked for: {promised['outcome']}"
    table = _table(title, "output", "allowed", "expected", "peak", "expected / peak", "unit")
    for name, found in promised["outputs"].items():
        expected = found["estimated"]
        table.add_row(
            name.replace("_", " "),
            f"{found['allowed']:.2g}",
            "unknown" if expected is None else f"{expected:.2g}",
            f"{found['peak']:.4g}",
            "" if expected is None or not found["peak"] else f"{expected / found['peak']:.1e}",
            found["units"],
        )
    console.print(table)
    console.print(f"chosen                {setting_words(promised['setting'])}")
    if promised["stated"]:
        keys = ", ".join(promised["stated"]).replace("_", " ")
        console.print(f"stated by the case    {keys}; what a case leaves out is chosen")
    for reason in promised["left_out"]:
        console.print(f"left out              {reason}")
    console.print(
        f"choice                {promised['tried']} settings looked at, {1e3 * promised['choice_cpu_seconds']:.0f} ms"
    )


def setting_words(setting: dict[str, Any]) -> str:
    """Model and solver of a run in words, as :func:`towercrane.accuracy.setting.Setting.provenance` gives them."""
    keys = [key for key in setting if key.endswith("_modes")]
    if setting.get("planar"):
        keys = ["tower_modes", "jib_vertical_modes", "counter_jib_vertical_modes"]
    # A counter-jib is rigid as a rule.
    counts = {key: setting.get(key) for key in keys if setting.get(key) or not key.startswith("counter")}
    counts = {key.removesuffix("_modes").replace("_", " "): count for key, count in counts.items()}
    modes = ", ".join(f"{count} {kind}" for kind, count in counts.items())
    cap = f" capped at {setting['cap']:.3g} Hz" if setting.get("cap") else ""
    planar = " in the plane," if setting.get("planar") else ""
    softened = "softened" if setting["weight_softening"] else "not softened"
    return (
        f"{modes} modes{cap},{planar} the tower {softened} by "
        f"the weight, {setting['method']} at rtol {setting['rtol']:.1e}, atol {setting['atol']:.1e}"
    )


def verification_tables(report: dict[str, Any]) -> None:
    """Expected beside actual errors, as :func:`towercrane.accuracy.promise.verification` gives them."""
    console = _console()
    columns = ("output", "expected error", "difference", "difference / peak", "unit")
    table = _table("Run beside a richer model", *columns)
    for name, found in report["outputs"].items():
        expected, peak = found["estimated"], found["peak"]
        table.add_row(
            name.replace("_", " "),
            "unknown" if expected is None else f"{expected:.2g}",
            f"{found['actual']:.2g}" + (" (!)" if expected is not None and found["actual"] > expected else ""),
            f"{found['actual'] / peak:.1e}" if peak else "",
            found["units"],
        )
    console.print(table)
    console.print(f"run                   {setting_words(report['setting'])}")
    ended = "" if report["outcome"] == "finished" else f"; it ended early: {report['outcome']}"
    console.print(f"richer                {setting_words(report['finer'])}{ended}")
    for doubt in report["doubts"]:
        console.print(f"note     the expected error may not hold: {doubt}", style="bold")
