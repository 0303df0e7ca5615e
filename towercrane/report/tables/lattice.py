"""Lattices of a crane beside the beams that stand for them, as tables on the terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from towercrane.report.tables.layout import assumed_values, console_of_reports, report_table

if TYPE_CHECKING:
    from rich.console import Console

WIDTH = 80
"""Columns that these tables keep to."""

PLANE = (
    ("deflection, force [um/kN]", 1e9), ("deflection, moment [um/(kN m)]", 1e9), ("f1 bare [Hz]", 1.0),
    ("f2 bare [Hz]", 1.0), ("f1 with body [Hz]", 1.0), ("f2 with body [Hz]", 1.0),
)  # fmt: skip
"""What is said of a tower in the plane, and what a value in SI is multiplied by."""

DEFLECTIONS = {
    "vertical": ("deflection up [um/kN]", 1e9),
    "lateral": ("deflection aside [um/kN]", 1e9),
    "twist": ("twist [urad/(kN m)]", 1e9),
}


def lattice_tables(report: dict[str, Any]) -> None:
    """Trusses and beams as :func:`towercrane.studies.lattice.lattice_report` gives them."""
    console = console_of_reports(WIDTH)
    if report["models"]:
        _plane(console, report)
    for lattice in report["lattices"]:
        _space(console, report["name"], lattice)
    console.print(
        f"rigid joints: members as round tubes {report['tube']:g} times as wide as their wall, which is assumed; "
        "members bend between their ends as well"
    )
    if any(not lattice["planes_alike"] for lattice in report["lattices"]):
        console.print(
            "a jib's truss ends with its last nodes, as the beam in space does; those of each plane reach to the tip"
        )
    console.print("loads act on the tip, a force to the side of a jib on its rail; the root is clamped, the tip bare")
    assumed_values(console, report["assumed"])


def _plane(console: Console, report: dict[str, Any]) -> None:
    """A tower in one plane, with the slewing part on it and without."""
    names = [model["name"] for model in report["models"]]
    title = f"{report['name']}: lattice of {report['height_m']:g} m as beams; errors relative to the truss [%]"
    table = report_table(title, "", names[0], *names[1:])
    answers, *errors = (
        [
            found["force_deflection"],
            found["moment_deflection"],
            *found["frequencies_hz"],
            *found["body_frequencies_hz"],
        ]
        for found in (report["models"][0]["answers"], *(model["errors"] for model in report["models"][1:]))
    )
    for (name, size), value, *changes in zip(PLANE, answers, *errors, strict=True):
        table.add_row(name, f"{size * value:.5g}", *(f"{100.0 * change:+.2f}" for change in changes))
    table.add_row("time [ms]", *(f"{1e3 * model['seconds']:.2f}" for model in report["models"]))
    console.print(table)
    console.print("deflections are those of the top under a force or a moment on it; the body is the slewing part")
    console.print(
        "foot clamped, without bodies between foot and top; the truss, all pins, shares nothing with the beams"
    )


def _space(console: Console, name: str, lattice: dict[str, Any]) -> None:
    """A lattice in both planes and in torsion."""
    pinned, *others = lattice["models"]
    title = (
        f"{name}: {lattice['name']} of {lattice['length_m']:g} m in space; errors relative to the pinned truss [%]"
    )
    table = report_table(title, "", *(model["name"] for model in lattice["models"]))

    def row(what: str, size: float, values: list[float | None]) -> None:
        reference, *rest = values
        if reference is None:
            table.add_row(what, "none", *("" for _ in rest))
            return
        shown = ("none" if value is None else f"{100.0 * (value / reference - 1.0):+.2f}" for value in rest)
        table.add_row(what, f"{size * reference:.5g}", *shown)

    alike = lattice["planes_alike"]
    for kind, (what, size) in DEFLECTIONS.items():
        if not (alike and kind == "lateral"):
            text = what.replace(" up", "") if alike else what
            row(text, size, [model["deflections"][kind] for model in lattice["models"]])
    for kind, frequencies in pinned["frequencies_hz"].items():
        if not (alike and kind == "lateral"):
            text = "bending" if alike and kind == "vertical" else kind
            for k in range(len(frequencies)):
                values = [model["frequencies_hz"][kind][k] for model in lattice["models"]]
                row(f"{text} f{k + 1} [Hz]", 1.0, values)
    table.add_row("time [ms]", *(f"{1e3 * model['seconds']:.0f}" for model in (pinned, *others)))
    console.print(table)
