"""Commands that study a case or the program itself: linearise, sensitivity, shape, bench."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from towercrane.commands.terminal import (
    ENDED_EARLY,
    NOT_AS_EXPECTED,
    AsJson,
    CaseName,
    Changes,
    Out,
    Pictures,
    announce_compilation,
    fail,
    folder_for_results,
    load,
    options_of,
    path_of,
    say,
    say_notices,
    suggest,
    tell,
    with_bar,
    write,
)

if TYPE_CHECKING:
    from towercrane.cases.case import Case


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
    out: Out = None,
    changes: Changes = None,
    as_json: AsJson = False,
    pictures: Pictures = True,
) -> None:
    """Which parameters and degrees of freedom of a slewing crane matter, and the reduced crane that follows."""
    loaded = load(case, changes)
    folder = out if out is not None else Path("results") / f"{loaded.name}-sensitivity"
    folder_for_results(folder)
    if not 1.0 <= step <= 100.0:
        fail(f"--step {step:g}: wanted percents from 1 to 100")
    if not 0.0 < tolerance < 1.0:
        fail(f"--tolerance {tolerance:g}: wanted a fraction between 0 and 1")
    from towercrane.cranes.slewing.build import parameters_of as written
    from towercrane.cranes.slewing.tables import SlewingCase
    from towercrane.studies.sensitivity import parameters_of

    parameters = written(loaded.tables(SlewingCase).crane)

    names = parameters_of(parameters, vary or ["*"])
    if not names:
        known = ", ".join(parameters_of(parameters))
        fail(f"--vary {' '.join(vary or [])}: wanted patterns that match some of {known}")
    from towercrane.cases.models import uses_of

    announce_compilation(*uses_of(loaded), "runs")
    from towercrane.cases.assumptions import as_attribute, rests_on

    study = _study(loaded, names, step, tolerance)
    study.data.attrs["assumed"] = as_attribute(rests_on(loaded))
    from towercrane.studies.sensitivity import report

    summary = report(study, loaded)
    files: dict[str, Any] = {"sensitivity.nc": study.data, "sensitivity.json": json.dumps(summary, indent=2) + "\n"}
    if pictures:
        from towercrane.report.plots.studies import sensitivity as pictured

        files["ranking.png"] = pictured.ranking(study)
        files |= {f"surface-{name}.png": pictured.surface(study.data, name) for name in names}
    write(folder, files)
    if as_json:
        tell(json.dumps(summary, indent=2))
        return
    from towercrane.report.tables.studies import sensitivity_tables

    sensitivity_tables(summary)
    tell(f"written to {folder}: {len(files)} files")
    suggest("run", case, *options_of(changes))


def linearise(
    case: CaseName,
    at: Annotated[
        float,
        typer.Option("--at", metavar="SECONDS", min=0.0, help="When: trolley and rope stand where they are then."),
    ] = 0.0,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            metavar="FILE",
            help="Write A, B, C, D to a .mat or .npz file.",
            parser=path_of,
        ),
    ] = None,
    changes: Changes = None,
    as_json: AsJson = False,
) -> None:
    """Linear state-space model of a case: eigenvalues, and a file for MATLAB or Python."""
    from towercrane.linear.statespace import FILE_TYPES

    loaded = load(case, changes)
    say_notices(loaded)
    if not at < float("inf"):
        fail(f"--at {at}: wanted a finite number of seconds")
    if out is not None:
        if out.suffix.lower() not in FILE_TYPES or out.is_dir():
            fail(f"--out {out}: wanted a file that ends in {' or '.join(FILE_TYPES)}")
        folder_for_results(out.parent)
    from towercrane.cases.models import uses_of

    announce_compilation(*uses_of(loaded), "runs")
    from towercrane.cases.assumptions import as_notes, rests_on
    from towercrane.cases.models import motions_of
    from towercrane.simulation.system import NoEquilibrium
    from towercrane.studies.linear_report import linear_model, linear_report

    try:
        linear = linear_model(loaded, at)
    except NoEquilibrium as failure:
        say(f"{failure.outcome}: {failure}")
        raise typer.Exit(ENDED_EARLY) from None
    if out is not None:
        linear.save(out, as_notes(rests_on(loaded)))
    report = linear_report(loaded, at, linear)
    if as_json:
        tell(json.dumps(report, indent=2, allow_nan=False))
        return
    from towercrane.report.tables.modes import linear_tables

    linear_tables(report, tuple(motions_of(loaded)))
    if out is not None:
        tell(f"written to {out}")
        suggest("run", case, *options_of(changes))
    else:
        suggest(
            "linearise",
            case,
            *(("--at", f"{at:g}") if at else ()),
            *options_of(changes),
            "--out",
            f"results/{loaded.name}.mat",
        )


def shape(
    case: CaseName,
    within: Annotated[
        float, typer.Option("--within", metavar="METRES", help="Distance from its rest at which the load is at rest.")
    ] = 0.1,
    step: Annotated[
        float, typer.Option("--step", metavar="SECONDS", help="Time between two rows of a drive's table.")
    ] = 0.05,
    out: Out = None,
    changes: Changes = None,
    as_json: AsJson = False,
    pictures: Pictures = True,
) -> None:
    """Motions that leave the load at rest: how still, how surely, how fast; tables for the drives."""
    loaded = load(case, changes)
    say_notices(loaded)
    folder = out if out is not None else Path("results") / f"{loaded.name}-shape"
    folder_for_results(folder)
    if not 0.0 < within < float("inf"):
        fail(f"--within {within:g}: wanted a positive distance")
    if not 1e-3 <= step <= 10.0:
        fail(f"--step {step:g}: wanted seconds from 0.001 to 10")
    from towercrane.cases.kinds import TOWER_CRANES
    from towercrane.studies.candidates import driven

    if loaded.kind not in TOWER_CRANES:
        fail(f"{case}: wanted a crane of kind {' or '.join(TOWER_CRANES)}, whose modes are known; got {loaded.kind}")
    if not driven(loaded.plans):
        fail(f"{case}: wanted a trolley or a slewing drive that moves, got none")
    from towercrane.cases.models import uses_of

    announce_compilation(*uses_of(loaded), "runs")
    from towercrane.cases.assumptions import as_attribute, as_entries, as_notes, rests_on
    from towercrane.cases.models import flexible_model
    from towercrane.report.drive_table import drive_table
    from towercrane.simulation.system import NoEquilibrium
    from towercrane.studies.rest_study import report, study

    try:
        run = partial(study, flexible_model(loaded), loaded.plans, allowed=within)
        done = with_bar(f"motions of {loaded.name}", run)
    except NoEquilibrium as failure:
        say(f"{failure.outcome}: {failure}")
        raise typer.Exit(ENDED_EARLY) from None
    notes, known = as_notes(rests_on(loaded)), {"case": loaded.name, "crane": loaded.crane.name}
    summary = {**known, **report(done), "assumed": as_entries(rests_on(loaded))}
    chosen = done.recommended.candidate
    files: dict[str, Any] = {"shape.json": json.dumps(summary, indent=2, allow_nan=False) + "\n"}
    for channel in driven(loaded.plans):
        unit = "m" if channel == "trolley" else "rad"
        about = {**known, "drive": channel, "motion": chosen.title, "assumed": as_attribute(rests_on(loaded))}
        files[f"drive-{channel}.csv"] = drive_table(chosen.motions[channel], step, unit, about)
    if pictures:
        from towercrane.report.plots.studies import shaping as pictured

        files["residuals.png"] = pictured.residuals(done, loaded.crane.name, notes)
        files["profiles.png"] = pictured.profiles(done, loaded.crane.name, notes)
    write(folder, files)
    if as_json:
        tell(json.dumps(summary, indent=2, allow_nan=False))
        return
    from towercrane.report.tables.studies import shape_tables

    shape_tables(summary)
    tell(f"written to {folder}: {', '.join(files)}")
    suggest("run", case, *options_of(changes), *_reshaped(loaded, chosen.name, driven(loaded.plans)))


def _reshaped(case: Case, name: str, channels: list[str]) -> list[str]:
    """Options that give every planned drive of a case another shape; none where its motion has other keys."""
    from towercrane.motions.shaping import DESIGNS

    shapes = [getattr(getattr(case.checked.motion, channel), "shape", "") for channel in channels]
    if name not in DESIGNS or not {*shapes} <= {"trapezoid", *DESIGNS}:
        return []
    return [part for channel in channels for part in ("--set", f"motion.{channel}.shape={name}")]


def _study(case: Case, names: list[str], step: float, tolerance: float) -> Any:
    """Run a sensitivity study."""
    from towercrane.cases.models import motions_of
    from towercrane.cranes.slewing.build import builder_of, parameters_of
    from towercrane.cranes.slewing.tables import SlewingCase
    from towercrane.studies.sensitivity import study

    tables = case.tables(SlewingCase)
    percent = sorted({step * i for i in range(int(200.0 / step) + 1)} | {50.0, 100.0, 150.0})
    run = partial(
        study, parameters_of(tables.crane), builder_of(tables), motions_of(case), case.run.duration,
        vary=names, percent=percent, tolerance=tolerance,
    )  # fmt: skip
    return with_bar(f"{len(names)} parameters, {len(percent)} values each", run)


def bench(
    quick: Annotated[bool, typer.Option("--quick", help="Fewer repeats and rivals; about a minute.")] = False,
    subject: Annotated[str, typer.Option("--subject", metavar="NAME", help="Measure one subject only.")] = "",
    hard: Annotated[bool, typer.Option("--hard", help="Run the hard cases against their targets.")] = False,
    stability: Annotated[
        bool, typer.Option("--stability", help="Energy drift, error growth and failures of every method.")
    ] = False,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            metavar="DIR",
            help="Folder for bench.json and the pictures.",
            parser=path_of,
        ),
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Measure speed against error on this machine, beside other solvers."""
    chosen = [
        name for name, wanted in (("--subject", subject), ("--hard", hard), ("--stability", stability)) if wanted
    ]
    if len(chosen) > 1:
        fail(f"bench: wanted one of --subject, --hard and --stability, got {' and '.join(chosen)}")
    if out is not None:
        folder_for_results(out)
    report = _measured(quick, subject, hard, stability)
    if out is not None:
        from towercrane.report.plots.bench.work import pictures

        files = {**pictures(report), "bench.json": json.dumps(_finite(report), indent=2, allow_nan=False) + "\n"}
        write(out, files)
    if as_json:
        tell(json.dumps(_finite(report), indent=2, allow_nan=False))
    else:
        from towercrane.report.tables.studies import bench_tables

        bench_tables(report)
        if out is not None:
            tell(f"written to {out}: {', '.join(files)}")
        suggest("run", "qtz5613/condition-3", "--set", "solver.rtol=1e-6")
    if not report.get("met", True):
        say("not all as expected, see the rows marked NO or !")
        raise typer.Exit(NOT_AS_EXPECTED)


def _measured(quick: bool, subject: str, hard: bool, stability: bool) -> dict[str, Any]:
    """What the benchmark was asked for."""
    announce_compilation("radial", "runs")
    if hard:
        from towercrane.bench.runs.hard import hard_cases

        found = hard_cases(say)
        return {"subjects": [found], "met": found["met"]}
    if stability:
        from towercrane.bench.runs import stability as long_run

        return long_run.stability(quick=quick, say=say)
    from towercrane.bench import SUBJECTS, measure

    if subject and subject not in SUBJECTS:
        fail(f"--subject: wanted one of {', '.join(SUBJECTS)}, got {subject!r}")
    return measure(quick=quick, subject=subject, say=say)


def _finite(node: Any) -> Any:
    """The report with what is not finite as text: JSON has no infinity."""
    if isinstance(node, dict):
        return {key: _finite(item) for key, item in node.items()}
    if isinstance(node, list):
        return [_finite(item) for item in node]
    return str(node) if isinstance(node, float) and not abs(node) < float("inf") else node
