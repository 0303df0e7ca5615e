"""Cycles of forces and moments as tables on the terminal."""

from __future__ import annotations

from typing import Any

from towercrane.report.tables.layout import assumed_values, console_of_reports, report_table, said

WIDTH = 80

KILO = {"N": "kN", "N m": "kN m"}


def fatigue_tables(report: dict[str, Any]) -> None:
    """Report of :func:`towercrane.studies.fatigue.study.fatigue`."""
    console = console_of_reports(WIDTH)
    table = report_table(f"{report['title']}: what it consists of", "run", "in a day", "to [s]", "looks [s]")
    for one in report["operations"]:
        table.add_row(one["name"], f"{one['count']:g}", f"{one['end_time_s']:g}", f"{one['look_step_s']:.3g}")
    console.print(table)
    reference = f"{report['reference_cycles']:g}"
    lines = [f"m = {exponent:g}" for exponent in report["exponents"]]
    title = f"Cycles in {_days(report['days'])}, and the range that does their damage in {reference} cycles"
    ranges = report_table(title, "output", "cycles", "largest", *lines)
    classes = report_table("Spectrum factors s and their classes", "output", *lines)
    for name, found in report["outputs"].items():
        spectra, words = found["spectra"], name.replace("_", " ")
        equivalent = [_kilo(own["equivalent_range"]) for own in spectra]
        largest = _kilo(found["largest_range"])
        ranges.add_row(f"{words} [{KILO[found['units']]}]", f"{found['cycles']:.4g}", largest, *equivalent)
        classes.add_row(words, *(f"{own['s']:.2g} {own['class']}" for own in spectra))
    console.print(ranges)
    console.print(classes)
    ways = {
        "repeated": "rainflow, of a day that is repeated: every cycle closes",
        "alone": "rainflow, ASTM E1049-85: what a run leaves open counts by halves",
    }
    console.print(f"counting  {ways[report['counting']]}")
    console.print(f"classes   {report['standard']}, by s = sum n (S/S_max)^m / {reference}")
    console.print("ranges    of forces and moments, not of stresses")
    said(console, [f"note      {notice}" for notice in report["notices"]])
    assumed_values(console, report["assumed"])


def _kilo(value: float) -> str:
    return f"{1e-3 * value:.3g}"


def _days(count: float) -> str:
    return "one day" if count == 1.0 else f"{count:g} days"
