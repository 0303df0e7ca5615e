"""Lift-off as tables on the terminal."""

from __future__ import annotations

from typing import Any

from towercrane.report.tables.layout import assumed_values, console_of_reports, report_table, said

WIDTH = 80

SECTIONS = {"rope": "rope", "base": "base", "jib_root": "jib root"}


def lift_tables(report: dict[str, Any]) -> None:
    """Report of :func:`towercrane.studies.lift.study.lift`."""
    console = console_of_reports(WIDTH)
    sections = {name: words for name, words in SECTIONS.items() if name in _known(report)}
    title = f"{report['crane']}: dynamic factors of {report['payload_kg']:g} kg lifted off the ground"
    columns = ("x [m]", "v [m/s]", "off [s]", *sections.values(), "k", "k_eff", "class")
    table = report_table(title, *columns, left=0)
    taken = {own["trolley_position_m"]: own["by_hand_with"] for own in report["positions"]}
    for row in report["runs"]:
        factors, off = row["dynamic_factor"], row["lift_off_s"]
        starred = taken[row["trolley_position_m"]]
        table.add_row(
            f"{row['trolley_position_m']:g}",
            f"{row['speed_m_s']:.3g}",
            "-" if off is None else f"{off:.2f}",
            *(f"{factors[name]['value']:.3f}" if name in factors else "-" for name in sections),
            *(f"{own:.3f}{'*' if name == starred else ' '}" for name, own in row["by_hand"].items()),
            (row["class_that_covers_the_rope"] or "-").replace("beyond ", "> "),
        )
    console.print(table)
    places = report_table("How the crane yields to the load", "x [m]", "c_s [um/N]", "k_eff [kN/m]", "c_s k", left=0)
    for own in report["positions"]:
        places.add_row(
            f"{own['trolley_position_m']:g}", f"{1e6 * own['compliance_m_n']:.3g}",
            f"{1e-3 * own['k_eff_n_m']:.4g}", f"{own['compliance_times_k']:.3g}",
        )  # fmt: skip
    console.print(places)
    said(console, [f"{name:9} {text}" for name, text in _explained(report).items()])
    said(console, [f"note      {notice}" for notice in report["notices"]])
    assumed_values(console, report["assumed"])


def stated(report: dict[str, Any]) -> dict[str, str]:
    """What factors hang on: the hoist, the time in which they are sought, what dies away."""
    creep = f", {report['creep_m_s']:g} m/s until it hangs" if report["creep_m_s"] else ""
    ratios = ", ".join(
        f"{name.removesuffix('_damping_ratio').replace('_', ' ')} {value:g}"
        for name, value in report["structural_damping"].items()
    )
    return {
        "hoist": f"{1e3 * report['slack_m']:g} mm of slack, {report['acceleration_m_s2']:.3g} m/s^2{creep}",
        "window": f"largest values within {report['window_s']:g} s after lift-off",
        "damping": (f"damping ratios {ratios}" if ratios else "no damping in the structure")
        + f"; relaxation time of the rope {1e3 * report['rope_relaxation_time_s']:g} ms",
    }


def _known(report: dict[str, Any]) -> set[str]:
    return {name for row in report["runs"] for name in row["dynamic_factor"]}


def _explained(report: dict[str, Any]) -> dict[str, str]:
    classes = ", ".join(
        f"{name} {own['phi2min']:g} + {own['beta2_s_m']:g} v" for name, own in report["hoisting_classes"].items()
    )
    return {
        "factors": "rope max T / (m g); moments (max M - M_0) / (M_st - M_0), M_0 without load",
        **stated(report),
        "by hand": f"1 + v/g sqrt(k/m), k = {1e-3 * report['rope_spring_n_m']:.4g} kN/m of the rope alone, "
        "k_eff with the crane; * is the one to take: k_eff where c_s k < 0.4, else k",
        "class": f"the first that covers the rope's factor; {report['standard']}: {classes}; v is the speed at "
        "lift-off: that of creeping, else the whole",
    }
