"""Reports on cranes in space as tables on the terminal."""

from __future__ import annotations

from typing import Any

from towercrane.report_tables import assumed_values, console_of_reports, report_table


def space_modes_tables(report: dict[str, Any]) -> None:
    """Natural frequencies in space, as :func:`towercrane.space_modes.space_frequencies` gives them."""
    console = console_of_reports()
    at = report["at"]
    where = f"trolley {at['trolley_position_m']:g} m, rope {at['rope_length_m']:g} m"
    title = f"{report['name']}: small motions, {where}, load {report['payload_mass_kg']:g} kg"
    kinds = list(report["modes"][0]["energy_shares"]) if report["modes"] else []
    table = report_table(title, "kind", "frequency [Hz]", "more modes", *(f"{kind} energy" for kind in kinds))
    for mode in report["modes"]:
        shares = (f"{share:.1%}" for share in mode["energy_shares"].values())
        table.add_row(mode["kind"], f"{mode['frequency_hz']:.6f}", f"{-mode['relative_difference']:+.1e}", *shares)
    console.print(table)
    if "outcome" in report:
        console.print(f"{report['outcome']}: {report['message']}")
    console.print(f"the rope by itself swings at {report['pendulum_hz']:.6f} Hz; more modes: change of the frequency")
    for name, rows in report["sweeps"].items():
        degrees, unit = (57.29577951308232, "deg") if name == "slewing_angle" else (1.0, "m")
        most = max(len(row["frequencies_hz"]) for row in rows)
        title = f"natural frequencies [Hz] over {name.replace('_', ' ')}, the other drives as above"
        table = report_table(title, f"{name.replace('_', ' ')} [{unit}]", *(f"f{i}" for i in range(1, most + 1)))
        for row in rows:
            cells = [f"{f:.5f} {_initials(k)}" for f, k in zip(row["frequencies_hz"], row["kinds"], strict=True)]
            table.add_row(f"{degrees * row['value']:g}", *(cells or [row.get("outcome", "")]))
        console.print(table)
    console.print("R radial, L lateral, T torsion, RS radial sway, LS lateral sway: what holds most of the energy")
    assumed_values(console, report["assumed"])


def _initials(kind: str) -> str:
    return "".join(word[0].upper() for word in kind.split())


def comparison_tables(report: dict[str, Any]) -> None:
    """Models beside each other, as :func:`towercrane.comparison.compare` gives them."""
    console = console_of_reports()
    in_space = report["kind"] == "space"
    sways = ("along", "across") if in_space else ("swing",)
    columns = [f"{name} peak / residual [deg]" for name in sways]
    columns += ["torque [kN m]"] if in_space else ["tower top [mm]"]
    title = f"{report['crane']}: {report['title'] or report['case']}"
    table = report_table(
        title, "model", "modes", *columns, "hor. / vert. error [m]", "relative", "evaluations", "CPU [s]"
    )  # fmt: skip
    for row in report["rows"]:
        cells = [f"{sway['peak_deg']:.2f} / {_shown(sway['residual_deg'], '.2f')}" for sway in row["sway"].values()]
        torque = row["slewing_torque_nm"]
        cells.append(f"{1e3 * row['tower_tip_m']:.1f}" if torque is None else f"{1e-3 * torque:.0f}")
        errors = f"{_shown(row['horizontal_error_m'], '.3f')} / {_shown(row['vertical_error_m'], '.3f')}"
        relative = row["outcome"] if row["relative_error"] is None else f"{row['relative_error']:.1e}"
        modes = "+".join(str(count) for count in row["modes"].values())
        cost = [str(row["evaluations"]), f"{row['cpu_seconds']:.2f}"]
        style = "bold" if row["name"] == report["recommended"] else None
        table.add_row(row["name"], modes, *cells, errors, relative, *cost, style=style)
    console.print(table)
    console.print(f"modes: {' + '.join(report['kinds_of_modes'])}; errors against the richest model")
    console.print(f"relative: to {report['departure_m']:.3g} m, how far the load leaves the place it would hang at")
    for reason in report["reasons"]:
        console.print(f"  {reason}")
    if report["recommended"] is None:
        console.print(
            f"no model but the richest is within {report['target']:g}: give the case more modes", style="bold"
        )
    else:
        needed = ", ".join(report["needed"]) or "no modes"
        text = f"for an error of {report['target']:g} it needs {needed}; cheapest: {report['recommended']}"
        console.print(text, style="bold")
    assumed_values(console, report["assumed"])


def _shown(value: float | None, form: str) -> str:
    return "-" if value is None else format(value, form)
