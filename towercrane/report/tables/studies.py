"""Studies and benchmarks as tables on the terminal."""

from __future__ import annotations

from typing import Any

from towercrane.report.tables.layout import assumed_values as _assumed
from towercrane.report.tables.layout import console_of_reports as _console
from towercrane.report.tables.layout import report_table as _table

MOST_FAULTS = 3
"""Runs of a sweep whose faults are told in full."""


def sensitivity_tables(summary: dict[str, Any]) -> None:
    """Ranked parameters, members and the reduced crane, as :func:`towercrane.studies.sensitivity.report` gives
    them."""
    console = _console()
    outputs = summary["outputs"]
    heads = [name.replace("_", " ") for name in outputs]

    def cells(change: dict[str, float | None]) -> list[str]:
        return ["lost" if change[name] is None else f"{change[name]:.1%}" for name in outputs]

    table = _table(
        f"{summary['crane']}: largest change within 50 to 150 % of nominal, of each output's peak",
        "parameter",
        *heads,
    )
    for entry in summary["influence"]:
        table.add_row(entry["parameter"].replace("_", " "), *cells(entry["near"]))
    console.print(table)
    table = _table("Members made rigid one at a time", "member", *heads)
    for entry in summary["members"]:
        table.add_row(entry["member"].replace("_", " "), *cells(entry["change"]))
    console.print(table)
    console.print("lost: the output is read off that member, which has to stay")
    reduced = summary["reduced"]
    table = _table(
        f"Reduced crane, rigid in {', '.join(reduced['rigid']).replace('_', ' ') or 'nothing'}, beside the full one",
        "degrees of freedom", *heads, "evaluations",
    )  # fmt: skip
    table.add_row(
        f"{reduced['degrees_of_freedom']} of {summary['degrees_of_freedom']}",
        *cells(reduced["change"]),
        f"{reduced['cost']:.0%}",
    )
    console.print(table)
    for ended in summary["ended"]:
        console.print(f"note     {ended}")
    _assumed(console, summary["assumed"])


FORCES = {"trolley": "trolley", "luffing": "luffing rope"}
"""Where the force of a drive along the jib is, by the drive."""


def shape_tables(report: dict[str, Any]) -> None:
    """Motions beside each other, as :func:`towercrane.studies.rest_study.report` gives them."""
    console = _console()
    drives = list(report["frequencies_hz"])
    first = report["candidates"][0]
    ropes, torsions = (
        [f"{100 * float(f):.0f} %" for f in first[key]] for key in ("rope_residual_m", "torsion_residual_m")
    )
    slews = any(drive not in FORCES for drive in drives)
    force = next((FORCES[drive] for drive in drives if drive in FORCES), "")
    columns = ["motion", "time [s]", "left [m]", *(f"rope {percent}" for percent in ropes if percent != "100 %")]
    columns += [f"GJ {percent}" for percent in torsions]
    columns += ["torque [kN m]"] if slews else []
    columns += ["force [kN]"] if force else []
    title = (
        f"{report['crane']}: largest distance of the load from its rest in {report['watched_s']:g} s after the last "
        f"motion, {report['damping_ratio']:.0%} modal damping; peaks of torque and {force or 'trolley'} force"
    )
    table = _table(title, *columns)
    table.columns[0].no_wrap = True
    for row in report["candidates"]:
        ropes = [value for factor, value in row["rope_residual_m"].items() if factor != "1"]
        left = [row["residual_m"], *ropes, *row["torsion_residual_m"].values()]
        cells = [
            row["title"],
            f"{row['duration_s']:.2f}",
            *("ended early" if v is None else f"{v:.4f}" for v in left),
        ]
        cells += [f"{1e-3 * row['peak_slewing_torque_Nm']:.1f}"] if slews else []
        cells += [f"{1e-3 * row[f'peak_{force}_force_N'.replace(' ', '_')]:.2f}"] if force else []
        table.add_row(*cells, style="bold" if row["name"] == report["recommended"] else None)
    console.print(table)
    for drive, found in report["frequencies_hz"].items():
        ends = " to ".join(", ".join(f"{f:.4f}" for f in found[end]) for end in ("at_start", "at_end"))
        console.print(f"{drive} excites {ends} Hz, from where the motion begins to where it ends")
    console.print("ZV, ZVD, EI and boxes are for these modes where each ramp ends; ZV, sqrt(g/l) for a rigid crane")
    if not all(row["within_limits"] for row in report["candidates"]):
        console.print("too fast: faster or with more acceleration than commanded, and so never recommended")
    console.print(f"recommended: {report['recommended']}, {report['reason']}", style="bold")
    _assumed(console, report["assumed"])


def sweep_tables(report: dict[str, Any]) -> None:
    """Extremes over all runs, as :func:`towercrane.runs.sweep_report.report` gives them."""
    console = _console()
    keys = [varied["key"] for varied in report["varied"]]
    units = {varied["key"]: varied["units"] for varied in report["varied"]}
    ended = ", ".join(f"{count} {outcome}" for outcome, count in report["outcomes"].items())
    table = _table(
        f"{report['crane']}: {report['title']}; {report['runs']} runs, {ended}",
        "output", "", "value", "unit", *(f"{key} [{units[key]}]" for key in keys), left=2,
    )  # fmt: skip
    for name, found in report["extremes"].items():
        for extreme in ("largest", "smallest"):
            value = found[extreme]
            at = [f"{v:.5g}" if isinstance(v, float) else str(v) for v in value["at"].values()]
            table.add_row(name.replace("_", " "), extreme, f"{value['value']:.5g}", found["units"], *at)
    console.print(table)
    console.print(f"{report['seconds']:.2f} s, {report['runs_per_second']:.3g} runs per second")
    for bad in report["faults"][:MOST_FAULTS]:
        where = ", ".join(f"{key} = {value}" for key, value in bad["at"].items())
        console.print(f"bad input at {where}: {bad['fault']}")
    if len(report["faults"]) > MOST_FAULTS:
        console.print(f"bad input in {len(report['faults']) - MOST_FAULTS} more runs: see the files")
    for said in report["notices"]:
        console.print(f"note     {said}", style="bold")
    _assumed(console, report["assumed"])


def bench_tables(report: dict[str, Any]) -> None:
    """Speed against error, as :func:`towercrane.bench.measure` gives it."""
    console = _console()
    for subject in report["subjects"]:
        table = _table(subject["title"], *subject["columns"], left=subject.get("left", 1))
        for row in subject["rows"]:
            table.add_row(*row)
        console.print(table)
        for note in subject["notes"]:
            console.print(f"  {note}", style="dim")
