"""Reports on cranes in space as tables on the terminal."""

from __future__ import annotations

from math import degrees
from typing import Any

from towercrane.report.tables.layout import assumed_values, console_of_reports, report_table, said


def space_modes_tables(report: dict[str, Any]) -> None:
    """Natural frequencies in space, as :func:`towercrane.studies.space_modes.space_frequencies` gives them."""
    console = console_of_reports()
    at = report["at"]
    position = f"trolley {at['trolley_position_m']:g} m" if "trolley_position_m" in at else _jib_at(at)
    where = f"{position}, rope {at['rope_length_m']:g} m"
    title = f"{report['name']}: small motions, {where}, load {report['payload_mass_kg']:g} kg"
    kinds = list(report["modes"][0]["energy_shares"]) if report["modes"] else []
    table = report_table(title, "kind", "frequency [Hz]", "more modes", *(f"{kind} energy" for kind in kinds))
    for mode in report["modes"]:
        shares = (f"{share:.1%}" for share in mode["energy_shares"].values())
        change = "-" if mode["relative_difference"] is None else f"{-mode['relative_difference']:+.1e}"
        table.add_row(mode["kind"], f"{mode['frequency_hz']:.6f}", change, *shares)
    console.print(table)
    if "outcome" in report:
        console.print(f"{report['outcome']}: {report['message']}")
    console.print(f"the rope by itself swings at {report['pendulum_hz']:.6f} Hz")
    console.print("more modes: change of the frequency by two more modes of every kind that the crane has data for")
    if any(mode["relative_difference"] is None for mode in report["modes"]):
        console.print("- no mode of that shape with more modes")
    for mode in report["missing_from_the_model"]:
        console.print(f"missing from the model: {mode['frequency_hz']:.6f} Hz, {mode['kind']}")
    for name, rows in report["sweeps"].items():
        factor, unit = (57.29577951308232, "deg") if name.endswith("_angle") else (1.0, "m")
        most = max(len(row["frequencies_hz"]) for row in rows)
        title = f"natural frequencies [Hz] over {name.replace('_', ' ')}, the other drives as above"
        table = report_table(title, f"{name.replace('_', ' ')} [{unit}]", *(f"f{i}" for i in range(1, most + 1)))
        for row in rows:
            cells = [f"{f:.5f} {_initials(k)}" for f, k in zip(row["frequencies_hz"], row["kinds"], strict=True)]
            table.add_row(f"{factor * row['value']:g}", *(cells or [row.get("outcome", "")]))
        console.print(table)
    console.print("R radial, L lateral, T torsion, RS radial sway, LS lateral sway: what holds most of the energy")
    said(console, report["left_out"])
    assumed_values(console, report["assumed"])


def _jib_at(at: dict[str, float]) -> str:
    return f"jib at {degrees(at['luffing_angle_rad']):g} deg"


def _initials(kind: str) -> str:
    return "".join(word[0].upper() for word in kind.split())


def comparison_tables(report: dict[str, Any]) -> None:
    """Models beside each other, as :func:`towercrane.studies.comparison.compare` gives them."""
    console = console_of_reports()
    in_space = len(report["rows"][0]["sway"]) > 1
    columns = [f"{name}\n[deg]" for name in (("along", "across") if in_space else ("swing",))]
    columns += ["torque\n[kN m]"] if in_space else ["tower top\n[mm]"]
    columns += ["hor.\n[m]", "vert.\n[m]", "relative", "calls", "CPU\n[s]"]
    table = report_table(f"{report['crane']}: {report['title'] or report['case']}", "model", "modes", *columns)
    for row in report["rows"]:
        cells = [f"{sway['peak_deg']:.2f}, {_shown(sway['residual_deg'], '.2f')}" for sway in row["sway"].values()]
        torque = row["slewing_torque_nm"]
        cells.append(f"{1e3 * row['tower_tip_m']:.1f}" if torque is None else f"{1e-3 * torque:.0f}")
        cells += [_shown(row[f"{way}_error_m"], ".3f") for way in ("horizontal", "vertical")]
        cells.append(row["outcome"] if row["relative_error"] is None else f"{row['relative_error']:.1e}")
        cells += [str(row["evaluations"]), f"{row['cpu_seconds']:.2f}"]
        modes = "+".join(str(count) for count in row["modes"].values())
        table.add_row(row["name"], modes, *cells, style="bold" if row["name"] == report["recommended"] else None)
    console.print(table)
    order = " + ".join(report["kinds_of_modes"])
    swings = "sway along and across the jib" if in_space else "swing"
    console.print(f"modes: {order}; {swings}: largest, and largest once all drives stand; calls: of the equations")
    console.print("hor., vert., relative: how far the load is off the richest model's at most, and that over the")
    console.print(
        f"{report['departure_m']:.3g} m by which it leaves the place where it would hang on a rigid crane at rest"
    )
    said(console, report["left_out"])
    for reason in report["reasons"]:
        console.print(f"  {reason}")
    if report["recommended"] is None:
        conclusion = f"no model but the richest is within {report['target']:g}: give the case more modes"
    else:
        needed = ", ".join(report["needed"]) or "no modes"
        conclusion = f"for an error of {report['target']:g} it needs {needed}; cheapest: {report['recommended']}"
    console.print(conclusion, style="bold")
    assumed_values(console, report["assumed"])


def _shown(value: float | None, form: str) -> str:
    return "-" if value is None else format(value, form)
