"""The command line: thin doors to the package. Heavy imports happen inside the commands."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from towercrane.__main__ import main
from towercrane.commands.animate import animate
from towercrane.commands.compare import compare
from towercrane.commands.lattice import lattice
from towercrane.commands.linearise import bench, linearise, sensitivity, shape
from towercrane.commands.map import frequency_map
from towercrane.commands.space_modes import space_modes
from towercrane.commands.sweep import sweep
from towercrane.commands.terminal import (
    ENDED_EARLY,
    INTERRUPTED,
    NOT_AS_EXPECTED,
    AsJson,
    CaseName,
    Changes,
    Out,
    Pictures,
    announce_compilation,
    fail,
    folder_for_results,
    held_interrupts,
    load,
    options_of,
    path_of,
    say,
    suggest,
    tell,
    with_progress,
    write,
    write_run,
)

if TYPE_CHECKING:
    import xarray as xr

    from towercrane.cases.case import Case

app = typer.Typer(
    help="How a tower crane vibrates and how its load swings.",
    epilog="Start with: towercrane cases",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
cases_app = typer.Typer(help="List the cases that ship with the program, or copy them.", no_args_is_help=False)
app.add_typer(cases_app, name="cases")


def _version(wanted: bool) -> None:
    if wanted:
        from towercrane.results.versions import __version__

        tell(f"towercrane {__version__}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    pass


@cases_app.callback(invoke_without_command=True)
def cases(context: typer.Context) -> None:
    """List the cases that ship with the program."""
    if context.invoked_subcommand is not None:
        return
    from towercrane.cases.case import list_cases

    found = list_cases()
    width = max(len(name) for name, _ in found)
    for name, title in found:
        tell(f"{name:<{width}}  {title}")
    suggest("modes", "qtz5613/condition-3")


@cases_app.command("copy")
def copy_cases(
    folder: Annotated[
        Path,
        typer.Argument(
            metavar="DIR",
            help="Folder to copy into; it must not hold them yet.",
            parser=path_of,
        ),
    ],
) -> None:
    """Copy the shipped cases to a folder of yours, to change them."""
    from towercrane.cases.case import case_folder

    source = case_folder()
    found = sorted([*source.rglob("*.toml"), *source.rglob("*.csv")])
    files = {str(path.relative_to(source)): path.read_text("utf-8") for path in found}
    if existing := [str(folder / name) for name in files if (folder / name).exists()]:
        fail(f"{folder}: nothing copied, {existing[0]} and {len(existing) - 1} more would be overwritten")
    write(folder, files)
    tell(f"{len(files)} files in {folder}")
    suggest("run", str(folder / "qtz5613" / "condition-3.toml"))


@app.command()
def modes(
    case: CaseName,
    changes: Changes = None,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            metavar="DIR",
            help="Folder for pictures of the modes.",
            parser=path_of,
        ),
    ] = None,
    actual: Annotated[
        bool, typer.Option("--actual", help="Solve for the effect of shear, weight, ... beside its prediction.")
    ] = False,
    as_json: AsJson = False,
) -> None:
    """Natural frequencies of tower, jib and crane, each checked a second way; what matters for them."""
    loaded = load(case, changes)
    if loaded.kind == "space":
        space_modes(loaded, case, changes, out, as_json)
        return
    if loaded.kind != "radial":
        fail(f"{case}: a crane of kind {loaded.kind!r} has no beams; try: towercrane linearise {case}")
    if out is not None:
        folder_for_results(out)
    announce_compilation("modes", "chain")
    from towercrane.studies.natural import natural_frequencies

    report = natural_frequencies(loaded, actual=actual)
    if out is not None:
        write(out, {"modes.png": _mode_picture(loaded)})
    if as_json:
        tell(json.dumps(report, indent=2))
    else:
        from towercrane.report.tables.modes import modes_tables

        modes_tables(report)
        if out is not None:
            tell(f"written to {out}: modes.png")
        suggest("run", case, *options_of(changes))
    if any("outcome" in row for row in report["crane"]):
        raise typer.Exit(ENDED_EARLY)


@app.command()
def run(
    case: CaseName,
    out: Out = None,
    changes: Changes = None,
    as_json: AsJson = False,
    pictures: Pictures = True,
    csv: Annotated[bool, typer.Option("--csv", help="Write result.csv as well.")] = False,
    verify: Annotated[
        bool, typer.Option("--verify", help="Run a richer model with a tighter tolerance as well and compare.")
    ] = False,
) -> None:
    """Simulate a case; write result.nc, summary.json and pictures."""
    loaded = load(case, changes)
    if verify and loaded.kind not in ("radial", "space"):
        fail(f"--verify: wanted a case of kind 'radial' or 'space', got {loaded.kind!r}")
    folder = out if out is not None else Path("results") / loaded.name
    from towercrane.report.folder import RUN_FILES

    folder_for_results(folder, RUN_FILES)
    from towercrane.cases.models import uses_of

    announce_compilation(*uses_of(loaded), "runs")
    from towercrane.runs.run import record_case
    from towercrane.runs.summary import summarise

    result = with_progress(loaded, record_case)
    interrupted, verified = result.attrs["outcome"] == "interrupted", {}
    if verify and result.attrs["outcome"] == "finished":
        from towercrane.accuracy.promise import settle, verification

        try:
            verified["verification"] = verification(loaded, result)
            settle(result, verified["verification"])
        except KeyboardInterrupt:
            say("the run is kept, its verification is not")
            interrupted = True
    summary = summarise(loaded, result) | verified
    files: dict[str, Any] = {"result.nc": result, **({"result.csv": result} if csv else {})}
    try:
        if pictures and not interrupted:
            with held_interrupts():
                files |= _pictures(loaded, result.dataset())
    except KeyboardInterrupt:
        interrupted = True
    finally:
        # Whatever becomes of the pictures, the run is kept.
        text, stale = write_run(folder, files, summary)
    files["summary.json"] = text
    if as_json:
        tell(text)
    else:
        from towercrane.report.tables.runs import run_tables, verification_tables

        run_tables(summary)
        if "verification" in summary:
            verification_tables(summary["verification"])
        tell(f"written to {folder}: {', '.join(files)}")
        if stale:
            tell(f"removed, of an earlier run: {', '.join(stale)}")
        if changes:
            suggest("modes" if loaded.kind in ("radial", "space") else "linearise", case, *options_of(changes))
        elif loaded.kind == "radial":
            suggest("run", case, "--set", "model.jib_modes=5", "--out", f"results/{loaded.name}-5-jib-modes")
        else:
            suggest("modes" if loaded.kind == "space" else "linearise", case)
    if interrupted:
        say(f"kept in {folder}: {', '.join(files)}")
        raise typer.Exit(INTERRUPTED)
    if summary["expected"] and not summary["expected"]["met"]:
        say("\n".join(summary["expected"]["misses"]))
        raise typer.Exit(NOT_AS_EXPECTED)
    if summary["outcome"] != "finished":
        say(f"the run ended at {summary['end_time_s']:.6g} s: {summary['outcome']}")
        raise typer.Exit(ENDED_EARLY)
    if "accuracy" in summary:
        from towercrane.accuracy.promise import AS_ASKED

        if summary["accuracy"]["outcome"] not in AS_ASKED:
            say(f"the error asked for is {summary['accuracy']['outcome']}")
            raise typer.Exit(NOT_AS_EXPECTED)


@app.command()
def figures(
    out: Annotated[
        Path,
        typer.Option(
            "--out",
            metavar="DIR",
            help="Folder for the pictures.",
            parser=path_of,
        ),
    ] = Path("results/figures"),
    changes: Changes = None,
) -> None:
    """Draw Fig. 4 to 11 of Gao et al. (2023) from the corrected model."""
    folder_for_results(out)
    announce_compilation("radial", "runs")
    from towercrane.report.plots.runs import radial
    from towercrane.runs.run import run_case

    conditions = {}
    for number in (1, 2, 3, 4):
        conditions[number] = with_progress(load(f"qtz5613/condition-{number}", changes), run_case)
        if conditions[number].attrs["outcome"] == "interrupted":
            raise KeyboardInterrupt
    drawn = radial.source_figures(conditions)
    write(out, drawn)
    tell(f"written to {out}: {', '.join(drawn)}")
    suggest("run", "qtz5613/condition-4-zero")


def _pictures(case: Case, result: xr.Dataset) -> dict[str, Any]:
    """Pictures of a run, as its kind of crane has them."""
    if case.kind == "radial":
        from towercrane.report.plots.runs import radial

        return {**radial.run_pictures(result), "modes.png": _mode_picture(case)}
    if case.kind == "jib":
        from towercrane.report.plots.runs import jib

        return dict(jib.run_pictures(result))
    if case.kind == "space":
        from towercrane.report.plots.runs import space

        return dict(space.run_pictures(result))
    from towercrane.report.plots.runs import slewing

    return dict(slewing.run_pictures(result))


def _mode_picture(case: Case) -> Any:
    from towercrane.cases.assumptions import as_notes, rests_on
    from towercrane.cranes.tower.file.build import radial_crane
    from towercrane.cranes.tower.file.case_tables import RadialCase
    from towercrane.report.plots.runs import radial

    tables = case.tables(RadialCase)
    crane, count = radial_crane(tables), tables.modes.count
    notes = as_notes(a for a in rests_on(case) if a.key.startswith("crane."))
    return radial.modes(crane.tower_modes(count), crane.jib_modes(count), notes)


app.command()(animate)
app.command()(lattice)
app.command()(linearise)
app.command("map")(frequency_map)
app.command()(compare)
app.command()(sensitivity)
app.command()(sweep)
app.command()(bench)
app.command()(shape)


if __name__ == "__main__":
    main()
