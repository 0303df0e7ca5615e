"""The command line: thin doors to the package. Heavy imports happen inside the commands."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    import xarray as xr

    from towercrane.case import Case

BAD_INPUT, ENDED_EARLY, INTERRUPTED = 2, 3, 130
"""Exit codes besides 0: bad input; the run ended before its time with a named outcome; Ctrl-C."""

app = typer.Typer(
    help="How a tower crane vibrates and how its load swings.",
    epilog="Start with: towercrane cases",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
cases_app = typer.Typer(help="List the cases that ship with the program, or copy them.", no_args_is_help=False)
app.add_typer(cases_app, name="cases")

CaseName = Annotated[str, typer.Argument(metavar="CASE", help="A case file, or the name of a shipped case.")]
Changes = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="KEY=VALUE", help='Change a key, e.g. --set payload.mass="1200 kg".'),
]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON instead of tables.")]


def main() -> None:
    """Entry point: bad input becomes a message and exit code 2, Ctrl-C exit code 130."""
    from towercrane.faults import CaseError

    try:
        app()
    except CaseError as error:
        _fail(str(error))
    except KeyboardInterrupt:
        _say("interrupted")
        sys.exit(INTERRUPTED)
    except OSError as error:
        _fail(f"cannot write the output: {error.strerror or error}")


def _version(wanted: bool) -> None:
    if wanted:
        from towercrane import __version__

        typer.echo(f"towercrane {__version__}")
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
    from towercrane.case import list_cases

    found = list_cases()
    width = max(len(name) for name, _ in found)
    for name, title in found:
        typer.echo(f"{name:<{width}}  {title}")
    _next("modes", "qtz5613/condition-3")


@cases_app.command("copy")
def copy_cases(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="Folder to copy into; it must not hold them yet.")],
) -> None:
    """Copy the shipped cases to a folder of yours, to change them."""
    import shutil

    from towercrane.case import case_folder

    source = case_folder()
    clashes = [folder / path.relative_to(source) for path in sorted(source.rglob("*.toml"))]
    if existing := [str(path) for path in clashes if path.exists()]:
        _fail(f"{folder}: nothing copied, {existing[0]} and {len(existing) - 1} more would be overwritten")
    try:
        shutil.copytree(source, folder, dirs_exist_ok=True, ignore=shutil.ignore_patterns("__pycache__"))
    except OSError as error:
        _fail(f"{folder}: cannot copy the cases there: {error.strerror or error}")
    typer.echo(f"{len(clashes)} files in {folder}")
    _next("run", str(folder / "qtz5613" / "condition-3.toml"))


@app.command()
def modes(
    case: CaseName,
    changes: Changes = None,
    out: Annotated[
        Path | None, typer.Option("--out", metavar="DIR", help="Folder for the picture of the mode shapes.")
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Natural frequencies of tower, jib and crane, each beside finite elements."""
    loaded = _load(case, changes)
    if loaded.kind != "radial":
        _fail(f"{case}: a crane of kind {loaded.kind!r} has no beams; try: towercrane linearise {case}")
    _announce_compilation("modal.roots")
    from towercrane.natural import natural_frequencies

    report = natural_frequencies(loaded)
    if out is not None:
        _write(out, {"modes.png": _mode_picture(loaded)})
    if as_json:
        typer.echo(json.dumps(report, indent=2))
    else:
        from towercrane.tables import modes_tables

        modes_tables(report)
        if out is not None:
            typer.echo(f"written to {out}: modes.png")
        _next("run", case, *_set(changes))
    if any("outcome" in row for row in report["crane"]):
        raise typer.Exit(ENDED_EARLY)


@app.command()
def run(
    case: CaseName,
    out: Annotated[Path | None, typer.Option("--out", metavar="DIR", help="Folder for the results.")] = None,
    changes: Changes = None,
    as_json: AsJson = False,
    pictures: Annotated[bool, typer.Option(help="Draw the pictures.")] = True,
    csv: Annotated[bool, typer.Option("--csv", help="Write result.csv as well.")] = False,
) -> None:
    """Simulate a case; write result.nc, summary.json and pictures."""
    loaded = _load(case, changes)
    folder = out if out is not None else Path("results") / loaded.name
    _folder_for_results(folder)
    _announce_compilation("towercrane.stepper")
    from towercrane.folder import remove_stale
    from towercrane.simulate import run_case
    from towercrane.summary import summarise

    result = _with_progress(loaded, run_case)
    summary = summarise(loaded, result)
    text = json.dumps(summary, indent=2, allow_nan=False)
    files: dict[str, Any] = {"result.nc": result, "summary.json": text + "\n"}
    if csv:
        files["result.csv"] = result
    if pictures:
        files |= _pictures(loaded, result)
    _write(folder, files)
    stale = remove_stale(folder, files)
    if as_json:
        typer.echo(text)
    else:
        from towercrane.tables import run_tables

        run_tables(summary)
        typer.echo(f"written to {folder}: {', '.join(files)}")
        if stale:
            typer.echo(f"removed, of an earlier run: {', '.join(stale)}")
        if changes:
            _next("modes" if loaded.kind == "radial" else "linearise", case, *_set(changes))
        elif loaded.kind == "radial":
            _next("run", case, "--set", "model.jib_modes=5", "--out", f"results/{loaded.name}-5-jib-modes")
        else:
            _next("linearise", case)
    if summary["outcome"] == "interrupted":
        raise typer.Exit(INTERRUPTED)
    if summary["outcome"] != "finished":
        _say(f"the run ended at {summary['end_time_s']:.6g} s: {summary['outcome']}")
        raise typer.Exit(ENDED_EARLY)


@app.command()
def sensitivity(
    case: CaseName,
    vary: Annotated[
        list[str] | None,
        typer.Option("--vary", metavar="PATTERN", help='Parameters, e.g. --vary "stiffness_*"; all by default.'),
    ] = None,
    step: Annotated[float, typer.Option("--step", help="Percent of nominal between two values.")] = 20.0,
    tolerance: Annotated[
        float, typer.Option("--tolerance", help="Change of every output below which a member is made rigid.")
    ] = 0.02,
    out: Annotated[Path | None, typer.Option("--out", metavar="DIR", help="Folder for the results.")] = None,
    changes: Changes = None,
    as_json: AsJson = False,
    pictures: Annotated[bool, typer.Option(help="Draw the pictures.")] = True,
) -> None:
    """Which parameters and degrees of freedom of a slewing crane matter, and the reduced crane that follows."""
    loaded = _load(case, changes)
    folder = out if out is not None else Path("results") / f"{loaded.name}-sensitivity"
    _folder_for_results(folder)
    if not 1.0 <= step <= 100.0:
        _fail(f"--step {step:g}: wanted percents from 1 to 100")
    if not 0.0 < tolerance < 1.0:
        _fail(f"--tolerance {tolerance:g}: wanted a fraction between 0 and 1")
    parameters = loaded.lumped_parameters()
    from towercrane.sensitivity import parameters_of

    names = parameters_of(parameters, vary or ["*"])
    if not names:
        known = ", ".join(parameters_of(parameters))
        _fail(f"--vary {' '.join(vary or [])}: wanted patterns that match some of {known}")
    _announce_compilation("towercrane.stepper")
    study = _study(loaded, names, step, tolerance)
    from towercrane.sensitivity import report

    summary = report(study, loaded)
    files: dict[str, Any] = {"sensitivity.nc": study.data, "sensitivity.json": json.dumps(summary, indent=2) + "\n"}
    if pictures:
        from towercrane.plots import sensitivity as pictured

        files["ranking.png"] = pictured.ranking(study)
        files |= {f"surface-{name}.png": pictured.surface(study.data, name) for name in names}
    _write(folder, files)
    if as_json:
        typer.echo(json.dumps(summary, indent=2))
        return
    from towercrane.tables import sensitivity_tables

    sensitivity_tables(summary)
    typer.echo(f"written to {folder}: {len(files)} files")
    _next("run", case, *_set(changes))


@app.command()
def linearise(
    case: CaseName,
    at: Annotated[
        float,
        typer.Option("--at", metavar="SECONDS", min=0.0, help="When: trolley and rope stand where they are then."),
    ] = 0.0,
    out: Annotated[
        Path | None, typer.Option("--out", metavar="FILE", help="Write A, B, C, D to a .mat or .npz file.")
    ] = None,
    changes: Changes = None,
    as_json: AsJson = False,
) -> None:
    """Linear state-space model of a case: eigenvalues, and a file for MATLAB or Python."""
    from towercrane.statespace import FILE_TYPES

    loaded = _load(case, changes)
    if not at < float("inf"):
        _fail(f"--at {at}: wanted a finite number of seconds")
    if out is not None:
        if out.suffix.lower() not in FILE_TYPES or out.is_dir():
            _fail(f"--out {out}: wanted a file that ends in {' or '.join(FILE_TYPES)}")
        _folder_for_results(out.parent)
    _announce_compilation("towercrane.cranes.radial_kernel")
    from towercrane.natural import linear_model, linear_report
    from towercrane.system import NoEquilibrium

    try:
        linear = linear_model(loaded, at)
    except NoEquilibrium as failure:
        _say(f"{failure.outcome}: {failure}")
        raise typer.Exit(ENDED_EARLY) from None
    if out is not None:
        linear.save(out)
    report = linear_report(loaded, at, linear)
    if as_json:
        typer.echo(json.dumps(report, indent=2, allow_nan=False))
        return
    from towercrane.tables import linear_tables

    linear_tables(report, tuple(loaded.motions))
    if out is not None:
        typer.echo(f"written to {out}")
        _next("run", case, *_set(changes))
    else:
        _next(
            "linearise",
            case,
            *(("--at", f"{at:g}") if at else ()),
            *_set(changes),
            "--out",
            f"results/{loaded.name}.mat",
        )


@app.command()
def figures(
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Folder for the pictures.")] = Path(
        "results/figures"
    ),
    changes: Changes = None,
) -> None:
    """Draw Fig. 4 to 11 of Gao et al. (2023) from the corrected model."""
    _folder_for_results(out)
    _announce_compilation("towercrane.stepper")
    from towercrane.plots import radial
    from towercrane.simulate import run_case

    conditions = {}
    for number in (1, 2, 3, 4):
        conditions[number] = _with_progress(_load(f"qtz5613/condition-{number}", changes), run_case)
        if conditions[number].attrs["outcome"] == "interrupted":
            raise KeyboardInterrupt
    drawn = radial.source_figures(conditions)
    _write(out, drawn)
    typer.echo(f"written to {out}: {', '.join(drawn)}")
    _next("run", "qtz5613/condition-4-zero")


@app.command()
def bench(
    quick: Annotated[bool, typer.Option("--quick", help="Fewer repeats; under a minute.")] = False,
    as_json: AsJson = False,
) -> None:
    """Measure speed against error on this machine."""
    _announce_compilation("towercrane.stepper")
    from towercrane.bench import measure
    from towercrane.tables import bench_tables

    report = measure(quick=quick, say=_say)
    if as_json:
        typer.echo(json.dumps(report, indent=2))
        return
    bench_tables(report)
    _next("run", "qtz5613/condition-3", "--set", "solver.rtol=1e-6")


def _load(name: str, changes: list[str] | None) -> Case:
    from towercrane.case import load_case

    return load_case(name, changes or [])


def _pictures(case: Case, result: xr.Dataset) -> dict[str, Any]:
    """Pictures of a run, as its kind of crane has them."""
    if case.kind == "radial":
        from towercrane.plots import radial

        return {**radial.run_pictures(result), "modes.png": _mode_picture(case)}
    if case.kind == "jib":
        from towercrane.plots import jib

        return dict(jib.run_pictures(result))
    from towercrane.plots import slewing

    return dict(slewing.run_pictures(result))


def _mode_picture(case: Case) -> Any:
    from modal import cantilever_modes
    from towercrane.plots import radial

    crane, count = case.radial_crane(), case.modes.count
    # The shapes rest on the equivalent beams, not on the lattice's members.
    beams = [a for a in case.assumed if a.key.startswith("crane.") and ".lattice." not in a.key]
    notes = [(a.key, str(a.value), a.why) for a in beams]
    return radial.modes(
        cantilever_modes(crane.tower, count, crane.end_body), cantilever_modes(crane.jib, count), notes
    )


def _with_progress(case: Case, simulate: Callable[..., xr.Dataset]) -> xr.Dataset:
    """Run with a progress bar if somebody is looking; Ctrl-C ends the run and keeps what is finished."""
    if not sys.stderr.isatty():
        return simulate(case)
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

    columns = (TextColumn("{task.description}"), BarColumn(), TextColumn("{task.completed:.0f} s"))
    with Progress(*columns, TimeRemainingColumn(), console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(case.name, total=case.run.duration)
        return simulate(case, progress=lambda time: bar.update(task, completed=time))


def _study(case: Case, names: list[str], step: float, tolerance: float) -> Any:
    """Run a sensitivity study with a progress bar if somebody is looking."""
    from functools import partial

    from towercrane.models import slewing_builder
    from towercrane.sensitivity import study

    percent = [step * i for i in range(int(200.0 / step) + 1)]
    run = partial(
        study, case.lumped_parameters(), slewing_builder(case), case.motions, case.run.duration,
        vary=names, percent=percent, tolerance=tolerance,
    )  # fmt: skip
    if not sys.stderr.isatty():
        return run()
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(f"{len(names)} parameters, {len(percent)} values each", total=1.0)
        return run(progress=lambda done: bar.update(task, completed=done))


def _announce_compilation(module: str) -> None:
    from modal.compiled import is_compiled

    if not is_compiled(module):
        _say("compiling for the first time, about ten seconds; later runs start at once ...")


def _folder_for_results(folder: Path) -> None:
    """Refuse a folder that cannot be written before the work, not after it."""
    from towercrane.folder import obstacle

    if reason := obstacle(folder):
        _fail(f"--out {folder}: {reason}")


def _write(folder: Path, files: Mapping[str, Any]) -> None:
    from towercrane.folder import write

    _folder_for_results(folder)
    try:
        write(folder, files)
    except OSError as error:
        _fail(f"{folder}: cannot be written: {error.strerror or error}")


def _set(changes: list[str] | None) -> list[str]:
    return [part for change in changes or [] for part in ("--set", change)]


def _say(text: str) -> None:
    typer.echo(text, err=True)


def _next(*arguments: str) -> None:
    import shlex

    typer.echo(f"next: {shlex.join(['towercrane', *arguments])}")


def _fail(message: str) -> None:
    _say(message)
    sys.exit(BAD_INPUT)


if __name__ == "__main__":
    main()
