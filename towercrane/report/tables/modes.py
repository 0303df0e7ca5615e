"""Natural frequencies and linear models as tables on the terminal."""

from __future__ import annotations

from math import degrees
from typing import TYPE_CHECKING, Any

from towercrane.report.tables.layout import assumed_values as _assumed
from towercrane.report.tables.layout import console_of_reports as _console
from towercrane.report.tables.layout import report_table as _table
from towercrane.report.tables.layout import said

if TYPE_CHECKING:
    from collections.abc import Collection

    from rich.console import Console

LEANING = 1e-6
"""Inclination of the rope at an equilibrium that is shown [rad]."""


def modes_tables(report: dict[str, Any]) -> None:
    """Natural frequencies beside finite elements, as :func:`towercrane.studies.natural.natural_frequencies` gives
    them."""
    console = _console()
    _tower(console, report)
    _effects(console, report)

    jib = report["jib"]
    roots, title = jib.get("roots", []), f"{report['name']}: jib, clamped at the tower"
    table = _table(title, "mode", *["root"][: len(roots)], "frequency [Hz]")
    for i, frequency in enumerate(jib["frequencies_hz"]):
        table.add_row(str(i + 1), *[f"{root:.6f}" for root in roots[i : i + 1]], f"{frequency:.6f}")
    console.print(table)

    model = report["crane_model"]
    title = (
        f"{report['name']}: coupled crane, {model['tower_modes']} tower and {model['jib_vertical_modes']} jib modes, "
        f"load {report['payload_mass_kg']:g} kg on {report['rope_length_m']:g} m; * the load's swing"
    )
    most = max((len(row["frequencies_hz"]) for row in report["crane"]), default=0)
    table = _table(title, "trolley [m]", *(f"f{i} [Hz]" for i in range(1, most + 1)))
    for row in report["crane"]:
        swing = row.get("swing_mode")
        cells = [f"{f:.6f}" + ("*" if i == swing else "") for i, f in enumerate(row["frequencies_hz"], start=1)]
        table.add_row(f"{row['trolley_position_m']:g}", *cells)
        if "relative_difference" in row:
            table.add_row(
                "  difference from exact crane", *(_signed(d) for d in row["relative_difference"]), style="dim"
            )
            table.add_row(
                "  predicted, as jib modes are left out",
                *(f"{d:+.1e}" for d in row["predicted_difference"]),
                style="dim",
            )
    console.print(table)
    for row in report["crane"]:
        where = f"trolley at {row['trolley_position_m']:g} m"
        if "outcome" in row:
            console.print(f"{where}: {row['outcome']}: {row['message']}")
        for mode in row.get("missing_from_the_model", ()):
            named = f"{mode['member']} mode at {mode['frequency_hz']:.6f} Hz"
            console.print(f"{where}: the exact crane's {named} is missing from the model")
        if unlike := row.get("exact_unlike_the_model_hz"):
            listed = ", ".join(f"{frequency:.6f}" for frequency in unlike)
            console.print(f"{where}: no mode of the model is like the exact crane's at {listed} Hz")
    for row in report.get("uniform_jib", ()):
        changes = ", ".join(f"{100.0 * change:+.2g}" for change in row["relative_difference"])
        if max(map(abs, row["relative_difference"])) < 1e-9:
            # Several segments that are all alike.
            continue
        console.print(
            f"trolley at {row['trolley_position_m']:g} m: a uniform jib, as heavy and with the same first frequency, "
            f"would change the exact crane's f1 to f{len(row['relative_difference'])} by {changes} %"
        )
    if any(None in row.get("relative_difference", ()) for row in report["crane"]):
        console.print("- the exact crane has no mode of that shape")

    if "lattice" in report:
        table = _table(f"{report['name']}: tower lattice as a beam", "property", "value", "unit", "use", left=1)
        table.columns[3].justify = "left"
        for name, found in report["lattice"].items():
            table.add_row(name.replace("_", " "), f"{found['value']:.5g}", found["unit"], found["use"])
        console.print(table)
    said(console, report["left_out"])
    _assumed(console, report["assumed"])


def _tower(console: Console, report: dict[str, Any]) -> None:
    """Frequencies of the tower beside finite elements; of a uniform one roots, beside published ones."""
    tower, check = report["tower"], report["finite_elements"]
    roots, printed = tower.get("roots", []), tower.get("published_roots", [])
    columns = ["mode", *["root"][: len(roots)], "f [Hz]", f"{check['elements']} elements [Hz]", "relative"]
    if printed:
        columns += ["published", "ours less published"]
    weight = ", softened by all weights" if "weight" in report["effects"]["kept"] else ""
    table = _table(f"{report['name']}: tower with the slewing part on its end{weight}", *columns)
    rows = zip(tower["frequencies_hz"], check["frequencies_hz"], check["relative_difference"], strict=True)
    for i, (frequency, element, difference) in enumerate(rows):
        cells = [str(i + 1), *[f"{root:.6f}" for root in roots[i : i + 1]]]
        cells += [f"{frequency:.6f}", f"{element:.6f}", f"{difference:.1e}"]
        if i < len(printed):
            gap = roots[i] - printed[i]
            cells += [f"{printed[i]:.3f}", f"{gap:+.4f}" + (" (!)" if abs(gap) > 0.005 else "")]
        table.add_row(*cells)
    console.print(table)
    if "outcome" in tower:
        console.print(f"tower alone: {tower['outcome']}: {tower['message']}")
        return
    if any(abs(root - published) > 0.005 for root, published in zip(roots, printed, strict=False)):
        console.print("(!) discrepancy: no mass, inertia or offset near the published data gives this root")
    console.print("elements solve the same beam: they check how it is solved, not whether it is the tower")
    times = f"{1e3 * tower['seconds']:.3f} ms, finite elements {1e3 * check['seconds']:.1f} ms (median of 5)"
    console.print(f"{tower['method']} {times}")


def _effects(console: Console, report: dict[str, Any]) -> None:
    """Predicted, and where solved actual, changes of the tower's frequencies by each effect."""
    effects = report["effects"]
    if not effects["changes"]:
        return
    title = f"{report['name']}: change of the tower's frequencies by each effect, predicted from the plain modes [%]"
    count = max(len(row["predicted"]) for row in effects["changes"].values())
    table = _table(title, "effect", "in the results", *(f"f{i}" for i in range(1, count + 1)), left=2)
    for effect, rows in effects["changes"].items():
        for found, changes in rows.items():
            name = effect if found == "predicted" else f"  {found}"
            kept = ("yes" if effect in effects["kept"] else "no") if found == "predicted" else ""
            table.add_row(name, kept, *(f"{100.0 * change:+.3g}" for change in changes))
    console.print(table)
    tolerance = effects["tolerance"]
    asked = f"; the case accepts {100.0 * tolerance:g} %" if tolerance is not None else ""
    if effects["left_out"]:
        cost = 100.0 * effects["left_out_may_cost"]
        console.print(f"left out: {', '.join(effects['left_out'])}; that may cost {cost:.3g} % of a frequency{asked}")
    if (factor := report["buckling_factor"]) is not None:
        console.print(f"the tower buckles under {factor:.4g} times all weights, trolley and load included")


def map_tables(report: dict[str, Any]) -> None:
    """Branches over payload and trolley position, as :func:`towercrane.studies.map_report.map_report` gives them."""
    console = _console()
    pivots, richer = "luffing_angles_rad" in report, report.get("change_by_more_modes", {})
    places = [degrees(angle) for angle in report["luffing_angles_rad"]] if pivots else report["positions_m"]
    unit = "deg" if pivots else "m"
    shown = sorted({round(i * (len(places) - 1) / 4) for i in range(5)})
    softened = "softened" if report["weight_softening"] else "not softened"
    title = (
        f"{report['name']}: natural frequencies [Hz], rope {report['rope_length_m']:g} m, "
        f"tower {softened} by its weight"
    )
    columns = ["branch", "load [kg]", *(f"at {places[i]:.4g} {unit}" for i in shown), "energy"]
    table = _table(title, *columns, *(["more modes"] if richer else []), left=1)
    stable = [row for row in report["payloads"] if row["outcome"] == "finished"]
    for k, name in enumerate(report["branches"]):
        for row in stable:
            branch = row["branches"][k]
            shares = sorted(branch["energy_share"].items(), key=lambda item: -item[1])[:2]
            energy = ", ".join(f"{member} {share:.0%}" for member, share in shares if share >= 0.005)
            frequencies = (f"{branch['frequencies_hz'][i]:.5f}" for i in shown)
            first = row is stable[0]
            change = [f"{richer[name]:.1e}" if first else ""] if richer else []
            table.add_row(name if first else "", f"{row['payload_kg']:g}", *frequencies, energy, *change)
    console.print(table)
    if richer:
        console.print(
            f"frequencies of a model in {report['shapes']}; more modes: by how much they change at most at the ends "
            f"in {report['shapes_of_the_richer']}"
        )
    elif stable:
        row = stable[len(stable) // 2]
        table = _table(
            f"Part of each mode in static outputs under a unit force on the trolley at {places[-1]:.4g} m, "
            f"load {row['payload_kg']:g} kg",
            "branch",
            *(
                f"{output}, {load}"
                for load in ("weight", "push")
                for output in ("tower top", "jib end", "base moment")
            ),
        )
        for branch in row["branches"]:
            parts = [value for load in branch["contribution"].values() for value in load.values()]
            table.add_row(branch["name"], *("-" if part is None else f"{part:.2%}" for part in parts))
        console.print(table)
        console.print("weight: force down, push: force outward; all modes together make 100 %")
    for row in report["payloads"]:
        factor = "no" if row["buckling_factor"] is None else f"{row['buckling_factor']:.5g}"
        alone = "the tower alone" if richer else "tower"
        text = f"load {row['payload_kg']:g} kg: {alone} buckles in the jib's plane at {factor} times all weights"
        console.print(text + ("" if row["outcome"] == "finished" else f": {row['outcome']}, no frequencies"))
    for step in report["doubtful"]:
        place = degrees(step["luffing_angle_rad"]) if pivots else step["position_m"]
        where = f"load {step['payload_kg']:g} kg, just before {place:.4g} {unit}"
        console.print(f"doubtful {step['branch']}: its shape changes abruptly at {where}")
    said(console, report["left_out"])
    _assumed(console, report["assumed"])


def linear_tables(report: dict[str, Any], drives: Collection[str]) -> None:
    """Eigenvalues as :func:`towercrane.studies.linear_report.linear_report` gives them, without those of the
    drives."""
    console = _console()
    known = [*report["states"], *report["inputs"]]
    values = {signal["name"]: f"{_rounded(signal['value'], 9):g} {signal['units']}" for signal in known}
    # A head that a scene in the plane holds is no drive of the model.
    where = ", ".join(f"{name} {values[name]}" for name in drives if name in values)
    title = f"{report['name']}: small motions about {report['about']}"
    table = _table(
        f"{title}, {where}", "moves most", "frequency [Hz]", "period [s]", "damping ratio", "eigenvalue [1/s]"
    )
    for row in report["eigenvalues"]:
        if row["dominant_state"] in drives:
            continue
        frequency, ratio, imaginary = row["frequency_hz"], row["damping_ratio"], row["imaginary"]
        table.add_row(
            row["dominant_state"].replace("_", " "),
            f"{frequency:.6f}",
            f"{1.0 / frequency:.4f}" if imaginary else "",
            "" if ratio is None else f"{_rounded(ratio, 6):.6f}",
            f"{_rounded(row['real'], 6):.6f}" + (f" +- {imaginary:.6f}i" if imaginary else ""),
        )
    console.print(table)
    if report["rope_inclination_rad"] > LEANING:
        console.print(f"the rope leans by {report['rope_inclination_rad']:.4f} rad there")
    if not report["equilibrium"]:
        slope, state = max(zip(report["slope"], report["states"], strict=True), key=lambda pair: abs(pair[0]))
        console.print(f"there {state['name']} changes by {slope:.3g} {state['units']} per second")
    sizes = ", ".join(f"{len(report[kind])} {kind}" for kind in ("states", "inputs", "outputs"))
    console.print(f"{sizes}; inputs: {', '.join(signal['name'] for signal in report['inputs'])}")
    said(console, report["left_out"])
    _assumed(console, report["assumed"])


def _signed(difference: float | None) -> str:
    return "-" if difference is None else f"{difference:+.1e}"


def _rounded(value: float, digits: int) -> float:
    """Rounded, and never minus zero."""
    return round(value, digits) + 0.0
