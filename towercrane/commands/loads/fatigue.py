"""The command `fatigue`: cycles in the forces and moments of runs."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from towercrane.commands.shared.skeleton import as_text, finish
from towercrane.commands.shared.terminal import (
    ENDED_EARLY,
    INTERRUPTED,
    AsJson,
    Changes,
    Out,
    Pictures,
    fail,
    folder_for_results,
    load,
    load_run,
    say,
    with_progress,
)
from towercrane.simulation import outcomes

if TYPE_CHECKING:
    from towercrane.studies.fatigue.duty import Duty
    from towercrane.studies.fatigue.study import Operation

FILES = ("fatigue.json", "cycles.csv", "histogram.png", "range-mean.png")


def fatigue(
    work: Annotated[
        list[str],
        typer.Argument(
            metavar="RUN...|CASE|DUTY",
            help="Results of runs (result.nc or folders), cases, or a duty file: what a day consists of.",
        ),
    ],
    output: Annotated[
        list[str] | None,
        typer.Option("--output", metavar="NAME", help="Only this output, e.g. jib_root_moment; may be repeated."),
    ] = None,
    days: Annotated[
        float | None, typer.Option("--days", metavar="N", help="How often all of it occurs; 1 if nothing says else.")
    ] = None,
    exponents: Annotated[
        str | None, typer.Option("--exponents", metavar="M,M", help="Exponents of fatigue lines; 3,4,5 by default.")
    ] = None,
    out: Out = None,
    changes: Changes = None,
    as_json: AsJson = False,
    pictures: Pictures = True,
) -> None:
    """Count the cycles in forces and moments of runs.

    Rainflow counting, equivalent ranges, spectrum factors, histogram and range-mean pictures.
    """
    duty = _asked(_duty(work, changes or []), days, exponents, output)
    folder = out if out is not None else Path("results") / _name(work)
    folder_for_results(folder, FILES)
    operations = _operations(duty)
    from towercrane.report.tables.fatigue import fatigue_tables
    from towercrane.studies.fatigue.study import fatigue as study

    try:
        found = study(operations, duty.outputs or None, duty.spectra)
    except ValueError as error:
        fail(f"{' '.join(work)}: {error}")
    report = {"title": duty.title, **found.report}
    files: dict[str, Any] = {"fatigue.json": as_text(report) + "\n", "cycles.csv": _csv(found.cycles, found.units)}
    if pictures:
        from towercrane.report.plots.studies import fatigue as pictured

        files |= {"histogram.png": pictured.histogram(found), "range-mean.png": pictured.range_mean(found)}
    following = (
        ("--days", "5000") if days is None and duty.spectra.days == 1.0 else ("--output", next(iter(found.cycles)))
    )
    finish(report, fatigue_tables, ("fatigue", *work, *following), files, folder=folder, as_json=as_json)
    if any(one["outcome"] != outcomes.FINISHED for one in report["operations"]):
        say("some of the runs ended early")
        raise typer.Exit(ENDED_EARLY)


def _duty(work: list[str], changes: list[str]) -> Duty:
    """What was typed as a day's work."""
    from towercrane.studies.fatigue.duty import Duty, Task, is_duty, read_duty

    duties = [name for name in work if is_duty(Path(name))]
    if duties:
        if len(work) > 1:
            fail(f"{duties[0]}: wanted a duty file alone, got {len(work)} names")
        if changes:
            fail(f"--set {changes[0]}: wanted a case to change, got the duty file {duties[0]}")
        return read_duty(Path(duties[0]))
    tasks = []
    for name in work:
        path = Path(name)
        finished = path.suffix == ".nc" or path.is_dir()
        if finished and changes:
            fail(f"--set {changes[0]}: wanted a case to change, got the finished result {name}")
        tasks.append(Task(run=path) if finished else Task(case=name, changes=tuple(changes)))
    return Duty(", ".join(work), tuple(tasks))


def _asked(duty: Duty, days: float | None, exponents: str | None, outputs: list[str] | None) -> Duty:
    """With what the options ask for."""
    spectra = duty.spectra
    if days is not None:
        if not 0.0 < days < float("inf"):
            fail(f"--days {days:g}: wanted a number above 0")
        spectra = replace(spectra, days=days)
    if exponents is not None:
        try:
            spectra = replace(spectra, exponents=tuple(float(own) for own in exponents.split(",")))
        except ValueError:
            fail(f"--exponents {exponents}: wanted numbers with commas between them, such as 3,4,5")
    return replace(duty, spectra=spectra, outputs=tuple(outputs or duty.outputs))


def _operations(duty: Duty) -> list[Operation]:
    """The runs, those of cases made now; all that is typed is read before the first case is run."""
    from towercrane.studies.fatigue.study import Operation

    read: list[Any] = []
    for task in duty.tasks:
        if task.run is None:
            read.append(load(task.case, list(task.changes)))
            continue
        path = task.run / "result.nc" if task.run.is_dir() else task.run
        read.append(load_run(str(path)))
    from towercrane.runs.run import record_case

    operations = []
    for task, own in zip(duty.tasks, read, strict=True):
        result = own if task.run is not None else with_progress(own, record_case)
        if task.run is None and result.attrs["outcome"] == outcomes.INTERRUPTED:
            say("nothing is written")
            raise typer.Exit(INTERRUPTED)
        name = str(task.run) if task.run is not None else own.name
        operations.append(Operation(" ".join([name, *task.changes]), result, task.count))
    return operations


def _name(work: list[str]) -> str:
    """Folder of the results under that of all results."""
    first = Path(work[0])
    stem = first.parent.name if first.name == "result.nc" else first.stem if first.suffix else first.name
    return f"{stem or 'runs'}-fatigue"


def _csv(cycles: dict[str, Any], units: dict[str, str]) -> str:
    """All cycles, a row for each range and mean."""
    lines = ["output,units,range,mean,cycles"]
    lines += [
        f"{name},{units[name]},{size:.12g},{mean:.12g},{count:.12g}"
        for name, found in cycles.items()
        for size, mean, count in found
    ]
    return "\n".join(lines) + "\n"
