"""Reports as tables on the terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from towercrane.report_tables import assumed_values as _assumed
from towercrane.report_tables import console_of_reports as _console
from towercrane.report_tables import report_table as _table

if TYPE_CHECKING:
    from collections.abc import Collection

    from rich.console import Console


def modes_tables(report: dict[str, Any]) -> None:
    """Natural frequencies beside finite elements, as :func:`towercrane.natural.natural_frequencies` gives them."""
    console = _console()
    _tower(console, report)
    _effects(console, report)

    jib = report["jib"]
    table = _table(f"{report['name']}: jib, clamped at the tower", "mode", "root", "frequency [Hz]")
    for i, (root, frequency) in enumerate(zip(jib["roots"], jib["frequencies_hz"], strict=True)):
        table.add_row(str(i + 1), f"{root:.6f}", f"{frequency:.6f}")
    console.print(table)

    model = report["crane_model"]
    title = (
        f"{report['name']}: coupled crane, {model['tower_modes']} tower and {model['jib_modes']} jib modes, "
        f"load {report['payload_mass_kg']:g} kg on {report['rope_length_m']:g} m; * the load's swing"
    )
    most = max((len(row["frequencies_hz"]) for row in report["crane"]), default=0)
    table = _table(title, "trolley [m]", *(f"f{i} [Hz]" for i in range(1, most + 1)))
    for row in report["crane"]:
        swing = row.get("swing_mode")
        cells = [f"{f:.6f}" + ("*" if i == swing else "") for i, f in enumerate(row["frequencies_hz"], start=1)]
        table.add_row(f"{row['trolley_position_m']:g}", *cells)
        if "relative_difference" in row:
            table.add_row("  less exact", *(f"{d:+.1e}" for d in row["relative_difference"]), style="dim")
            table.add_row(
                "  by the jib modes, predicted", *(f"{d:+.1e}" for d in row["predicted_difference"]), style="dim"
            )
    console.print(table)
    for row in report["crane"]:
        if "outcome" in row:
            console.print(f"trolley at {row['trolley_position_m']:g} m: {row['outcome']}: {row['message']}")

    if "lattice" in report:
        table = _table(f"{report['name']}: tower lattice as a beam", "property", "value", "unit", "use", left=1)
        table.columns[3].justify = "left"
        for name, found in report["lattice"].items():
            table.add_row(name.replace("_", " "), f"{found['value']:.5g}", found["unit"], found["use"])
        console.print(table)
    _assumed(console, report["assumed"])


def _tower(console: Console, report: dict[str, Any]) -> None:
    """Frequencies of the tower beside finite elements; of a uniform one roots, beside published ones."""
    tower, check = report["tower"], report["finite_elements"]
    roots, printed = tower.get("roots", []), tower.get("published_roots", [])
    columns = ["mode", *["root"][: len(roots)], "f [Hz]", f"{check['elements']} elements [Hz]", "relative"]
    if printed:
        columns += ["published", "ours less published"]
    table = _table(f"{report['name']}: tower with the slewing part on its end", *columns)
    rows = zip(tower["frequencies_hz"], check["frequencies_hz"], check["relative_difference"], strict=True)
    for i, (frequency, element, difference) in enumerate(rows):
        cells = [str(i + 1), *[f"{root:.6f}" for root in roots[i : i + 1]]]
        cells += [f"{frequency:.6f}", f"{element:.6f}", f"{difference:.1e}"]
        if i < len(printed):
            gap = roots[i] - printed[i]
            cells += [f"{printed[i]:.3f}", f"{gap:+.4f}" + (" (!)" if abs(gap) > 0.005 else "")]
        table.add_row(*cells)
    console.print(table)
    if any(abs(root - published) > 0.005 for root, published in zip(roots, printed, strict=False)):
        console.print("(!) discrepancy: no mass, inertia or offset near the published data gives this root")
    times = f"{1e3 * tower['seconds']:.3f} ms, finite elements {1e3 * check['seconds']:.1f} ms (median of 5)"
    console.print(f"{tower['method']} {times}")


def _effects(console: Console, report: dict[str, Any]) -> None:
    """Predicted, and where solved actual, changes of the tower's frequencies by each effect."""
    effects = report["effects"]
    if not effects["changes"]:
        return
    title = f"{report['name']}: change of the tower's frequencies by each effect, predicted from the plain modes [%]"
    count = len(report["tower"]["frequencies_hz"])
    table = _table(title, "effect", "in the results", *(f"f{i}" for i in range(1, count + 1)), left=2)
    for effect, rows in effects["changes"].items():
        for kind, changes in rows.items():
            name = effect if kind == "predicted" else f"  {kind}"
            kept = ("yes" if effect in effects["kept"] else "no") if kind == "predicted" else ""
            table.add_row(name, kept, *(f"{100.0 * change:+.3g}" for change in changes))
    console.print(table)
    tolerance = effects["tolerance"]
    asked = f"; the case accepts {100.0 * tolerance:g} %" if tolerance is not None else ""
    if effects["left_out"]:
        cost = 100.0 * effects["left_out_may_cost"]
        console.print(f"left out: {', '.join(effects['left_out'])}; that may cost {cost:.3g} % of a frequency{asked}")
    if (factor := report["buckling_factor"]) is not None:
        console.print(f"the tower buckles under {factor:.4g} times all weights, trolley and load included")


def lattice_tables(report: dict[str, Any]) -> None:
    """Truss and beams as :func:`towercrane.lattice_command.lattice_report` gives them."""
    console = _console()
    title = f"{report['name']}: lattice of {report['height_m']:g} m as beams; errors relative to the truss [%]"
    columns = ("force", "moment", "f1 bare", "f2 bare", "f1 with body", "f2 with body", "time [ms]")
    table = _table(title, "model", *columns)
    for model in report["models"]:
        found, errors = (
            [m["force_deflection"], m["moment_deflection"], *m["frequencies_hz"], *m["body_frequencies_hz"]]
            for m in (model["answers"], model["errors"])
        )
        if model["name"] == "truss":
            units = ("um/kN", "um/(kN m)", "Hz", "Hz", "Hz", "Hz")
            scaled = [1e9 * found[0], 1e9 * found[1], *found[2:]]
            cells = [f"{value:.5g} {unit}" for value, unit in zip(scaled, units, strict=True)]
        else:
            cells = [f"{100.0 * error:+.2f}" for error in errors]
        table.add_row(model["name"], *cells, f"{1e3 * model['seconds']:.2f}")
    console.print(table)
    console.print("deflections are those of the top under a force or a moment on it; the body is the slewing part")
    _assumed(console, report["assumed"])


def linear_tables(report: dict[str, Any], drives: Collection[str]) -> None:
    """Eigenvalues as :func:`towercrane.linear_report.linear_report` gives them, without those of the drives."""
    console = _console()
    values = {signal["name"]: f"{signal['value']:g} {signal['units']}" for signal in report["states"]}
    where = ", ".join(f"{name} {values[name]}" for name in drives)
    title = f"{report['name']}: small motions about the equilibrium"
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
    sizes = ", ".join(f"{len(report[kind])} {kind}" for kind in ("states", "inputs", "outputs"))
    console.print(f"{sizes}; inputs: {', '.join(signal['name'] for signal in report['inputs'])}")
    _assumed(console, report["assumed"])


def _rounded(value: float, digits: int) -> float:
    """Rounded, and never minus zero."""
    return round(value, digits) + 0.0


def run_tables(summary: dict[str, Any]) -> None:
    """Summary of a run, as :func:`towercrane.summary.summarise` gives it."""
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
    console.print(f"extremes are those of the result's rows, every {summary['output_step_s']:g} s")
    for change in summary["changes"]:
        console.print(f"changed               {change}")
    period = summary["swing_period_s"]
    console.print(
        f"swing period          {f'{period:.4f} s' if period else 'none: no regular swing after the drives stopped'}"
    )
    shown = ", ".join(f"{f:.4f}" for f in summary["spectrum_peaks_hz"]) or "none"
    console.print(f"spectrum peaks        {shown} Hz in {summary['spectrum_of'].replace('_', ' ')}")
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
        f"{solver['solver_wall_seconds']:.3f} s of {summary['wall_seconds']:.3f} s wall"
    )
    if expected := summary["expected"]:
        for miss in expected["misses"] or ["met"]:
            console.print(f"expected by the case  {miss}", style="bold" if expected["misses"] else None)
    if "accuracy" in summary:
        _accuracy(console, summary["accuracy"])
    for notice in summary["notices"]:
        console.print(f"note     {notice}", style="bold")
    if summary["idle"]:
        console.print(f"idle     {', '.join(summary['idle'])}: in the crane file, of no use to this run")
    _assumed(console, summary["assumed"])


def _accuracy(console: Console, promised: dict[str, Any]) -> None:
    """What was asked for, chosen and is expected, as :func:`towercrane.promise.promise` gives it."""
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
        console.print(f"stated by the case    {', '.join(promised['stated']).replace('_', ' ')}")
    for reason in promised["left_out"]:
        console.print(f"left out              {reason}")
    console.print(
        f"choice                {promised['tried']} settings looked at, {1e3 * promised['choice_cpu_seconds']:.0f} ms"
    )


def setting_words(setting: dict[str, Any]) -> str:
    """Model and solver of a run in words, as :func:`towercrane.scene.provenance` gives them."""
    cap = f" capped at {setting['cap']:.3g} Hz" if setting["cap"] else ""
    softening = "with" if setting["weight_softening"] else "without"
    return (
        f"{setting['tower_modes']} tower and {setting['jib_modes']} jib modes{cap}, {softening} the weight's "
        f"softening, {setting['method']} at rtol {setting['rtol']:.1e}, atol {setting['atol']:.1e}"
    )


def verification_tables(report: dict[str, Any]) -> None:
    """Expected beside actual errors, as :func:`towercrane.promise.verification` gives them."""
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


def sensitivity_tables(summary: dict[str, Any]) -> None:
    """Ranked parameters, members and the reduced crane, as :func:`towercrane.sensitivity.report` gives them."""
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


def map_tables(report: dict[str, Any]) -> None:
    """Branches over payload and trolley position, as :func:`towercrane.map_report.map_report` gives them."""
    console = _console()
    places = report["positions_m"]
    shown = sorted({round(i * (len(places) - 1) / 4) for i in range(5)})
    weight = "softened by the weight" if report["weight_softening"] else "without the weight's softening"
    title = f"{report['name']}: natural frequencies [Hz], rope {report['rope_length_m']:g} m, tower {weight}"
    table = _table(title, "branch", "load [kg]", *(f"at {places[i]:.4g} m" for i in shown), "energy", left=1)
    stable = [row for row in report["payloads"] if row["outcome"] == "finished"]
    for k, name in enumerate(report["branches"]):
        for row in stable:
            branch = row["branches"][k]
            shares = sorted(branch["energy_share"].items(), key=lambda item: -item[1])[:2]
            energy = ", ".join(f"{member} {share:.0%}" for member, share in shares if share >= 0.005)
            frequencies = (f"{branch['frequencies_hz'][i]:.5f}" for i in shown)
            table.add_row(name if row is stable[0] else "", f"{row['payload_kg']:g}", *frequencies, energy)
    console.print(table)
    if stable:
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
        text = f"load {row['payload_kg']:g} kg: tower buckles in the jib's plane at {factor} times all weights"
        console.print(text + ("" if row["outcome"] == "finished" else f": {row['outcome']}, no frequencies"))
    for step in report["doubtful"]:
        where = f"load {step['payload_kg']:g} kg, just before {step['position_m']:.4g} m"
        console.print(f"doubtful {step['branch']}: its shape changes at once with {where}")
    _assumed(console, report["assumed"])


def shape_tables(report: dict[str, Any]) -> None:
    """Motions beside each other, as :func:`towercrane.rest_study.report` gives them."""
    console = _console()
    drives = list(report["frequencies_hz"])
    first = report["candidates"][0]
    ropes, torsions = (
        [f"{100 * float(f):.0f} %" for f in first[key]] for key in ("rope_residual_m", "torsion_residual_m")
    )
    slews = any(drive != "trolley" for drive in drives)
    columns = ["motion", "time [s]", "left [m]", *(f"rope {percent}" for percent in ropes if percent != "100 %")]
    columns += [f"GJ {percent}" for percent in torsions]
    columns += ["torque [kN m]"] if slews else []
    columns += ["force [kN]"] if "trolley" in drives else []
    title = (
        f"{report['crane']}: largest distance of the load from its rest in {report['watched_s']:g} s after the last "
        f"motion, {report['damping_ratio']:.0%} modal damping; peaks of torque and trolley force"
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
        cells += [f"{1e-3 * row['peak_trolley_force_N']:.2f}"] if "trolley" in drives else []
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
    """Extremes over all runs, as :func:`towercrane.sweeps.report` gives them."""
    console = _console()
    keys = [varied["key"] for varied in report["varied"]]
    units = {varied["key"]: varied["units"] for varied in report["varied"]}
    ended = ", ".join(f"{count} {outcome}" for outcome, count in report["outcomes"].items())
    table = _table(
        f"{report['crane']}: {report['title']}; {report['runs']} runs, {ended}",
        "output", "", "value", "unit", *(f"{key} [{units[key]}]" for key in keys), left=2,
    )  # fmt: skip
    for name, found in report["extremes"].items():
        for kind in ("largest", "smallest"):
            value = found[kind]
            at = [f"{v:.5g}" if isinstance(v, float) else str(v) for v in value["at"].values()]
            table.add_row(name.replace("_", " "), kind, f"{value['value']:.5g}", found["units"], *at)
    console.print(table)
    console.print(f"{report['seconds']:.2f} s, {report['runs_per_second']:.0f} runs per second")
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
