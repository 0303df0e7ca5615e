"""The command that runs a case over a grid of values."""

from __future__ import annotations

import json
import time
from collections import Counter
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from towercrane.commands.terminal import (
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
    load,
    options_of,
    say,
    say_notices,
    suggest,
    tell,
    with_bar,
    write,
)

if TYPE_CHECKING:
    import xarray as xr

    from towercrane.cases.case import Case

INTERRUPTED_RUN = "interrupted"
"""Outcome of runs that Ctrl-C did not let end."""

MOST_RUNS = 1_000_000
"""Runs beyond which a grid is more likely a slip."""


def sweep(
    case: CaseName,
    vary: Annotated[
        list[str],
        typer.Option(
            "--vary",
            metavar="KEY=FROM:TO:COUNT",
            help="Values of a key, e.g. --vary payload.mass=100kg:2000kg:20 or --vary model.jib_modes=1,2,3; "
            "with several keys all combinations.",
        ),
    ],
    out: Out = None,
    threads: Annotated[int | None, typer.Option("--threads", min=1, help="Threads; all cores by default.")] = None,
    changes: Changes = None,
    as_json: AsJson = False,
    pictures: Pictures = True,
) -> None:
    """Run a case over a grid of values; write sweep.nc, sweep.csv and a picture."""
    loaded = load(case, changes)
    say_notices(loaded)
    folder = out if out is not None else Path("results") / f"{loaded.name}-sweep"
    folder_for_results(folder)
    values = _values(loaded, vary)
    from towercrane.runs.sweep import grid

    announce_compilation("lanes" if loaded.kind == "radial" else loaded.kind, "runs")
    began = time.perf_counter()
    data = _with_progress(loaded, grid(values), threads)
    if not set(data["outcome"].values) - {INTERRUPTED_RUN}:
        say("interrupted before the first run had ended: nothing is written")
        raise typer.Exit(INTERRUPTED)
    summary = report(data, time.perf_counter() - began)
    files: dict[str, Any] = {"sweep.nc": data, "sweep.csv": runs_csv(data)}
    if pictures:
        from towercrane.report.plots.studies import sweep as pictured

        files |= pictured.extremes(data)
    write(folder, files)
    if as_json:
        tell(json.dumps(summary, indent=2, allow_nan=False))
    else:
        from towercrane.report.tables.studies import sweep_tables

        sweep_tables(summary)
        tell(f"written to {folder}: {', '.join(files)}")
        suggest("run", case, *options_of([*(changes or []), *_worst(data)]))
    if INTERRUPTED_RUN in summary["outcomes"]:
        raise typer.Exit(INTERRUPTED)
    if faults := summary["faults"]:
        say(f"bad input in {len(faults)} of {summary['runs']} runs, the first: {faults[0]['fault']}")
        raise typer.Exit(NOT_AS_EXPECTED)


def report(data: xr.Dataset, seconds: float) -> dict[str, Any]:
    """Largest and smallest value of every output over all runs and where they occur, ready for JSON."""
    import numpy as np

    from towercrane.runs.summary import assumed

    varied = {key: data[key.replace(".", "_")] for key in json.loads(data.attrs["varied"])}

    def where(place: int) -> dict[str, Any]:
        return {key: values.values[place].item() for key, values in varied.items()}

    def at(name: str, place: int) -> dict[str, Any]:
        return {"value": float(data[name].values[place]), "at": where(place)}

    extremes = {}
    for name in json.loads(data.attrs["outputs"]):
        largest, smallest = data[f"{name}_max"].values, data[f"{name}_min"].values
        if np.any(np.isfinite(largest)):
            high, low = int(np.nanargmax(largest)), int(np.nanargmin(smallest))
            units = data[f"{name}_max"].attrs["units"]
            extremes[name] = {"largest": at(f"{name}_max", high), "smallest": at(f"{name}_min", low), "units": units}
    runs = len(data["run"])
    ended = int((data["outcome"] != INTERRUPTED_RUN).sum())
    notices = json.loads(data.attrs["notices"])
    faults = data["fault"].values.tolist() if "fault" in data else []
    if "accuracy" in data:
        promised = Counter(data["accuracy"].values.tolist())
        notices.append("error asked for: " + ", ".join(f"{count} {name}" for name, count in promised.items() if name))
    return {
        "case": data.attrs["case"],
        "title": data.attrs["title"],
        "crane": data.attrs["crane"],
        "changes": json.loads(data.attrs["changes"]),
        "runs": runs,
        "outcomes": dict(Counter(data["outcome"].values.tolist()).most_common()),
        "varied": [
            {"key": key, "units": values.attrs["units"], "values": sorted(set(values.values.tolist()))}
            for key, values in varied.items()
        ],
        "extremes": extremes,
        "faults": [{"at": where(place), "fault": fault} for place, fault in enumerate(faults) if fault],
        "notices": notices,
        "assumed": [{"key": key, "value": value, "why": why} for key, value, why in assumed(data)],
        "seconds": seconds,
        "runs_per_second": ended / seconds,
    }


def runs_csv(data: xr.Dataset) -> str:
    """A line per run: the varied values, then everything that is known of it."""
    import csv
    import io

    from towercrane.runs.summary import assumed

    keys = [key.replace(".", "_") for key in json.loads(data.attrs["varied"])]
    # In the header, and not as lines above it: a row per run is all that readers of tables find.
    notes = "; ".join(f"{key} = {value}" for key, value, _ in assumed(data))
    tail = [f"assumed, given by no source: {notes}"] if notes else []
    names = ["run", *keys, *(str(name) for name, variable in data.data_vars.items() if variable.dims == ("run",))]
    units = (data[name].attrs.get("units") for name in names)
    header = [f"{name} [{unit}]" if unit else name for name, unit in zip(names, units, strict=True)]
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([*header, *tail])
    columns = [data[name].values.tolist() for name in names]
    for row in zip(*columns, strict=True):
        cells = [f"{value:.12g}" if isinstance(value, float) else value for value in row]
        writer.writerow([*cells, *("" for _ in tail)])
    return text.getvalue()


def _values(case: Case, vary: list[str]) -> dict[str, list[Any]]:
    """The values of every key that is varied."""
    from math import prod

    from towercrane.cases.case import load_case
    from towercrane.cases.kinds import knows, plain_key, unit_of
    from towercrane.schema.units import UnitError, to_si

    values: dict[str, list[Any]] = {}
    for option in vary:
        key, sign, written = option.partition("=")
        key = key.strip()
        if not (key and sign and written.strip()):
            fail(f"--vary {option}: wanted KEY=FROM:TO:COUNT or KEY=VALUE,VALUE,..., such as rope.length=5m:20m:16")
        if key in values:
            fail(f"--vary {option}: the key stands in two options")
        unit, parts = unit_of(case.kind, key), [part.strip() for part in written.split(":")]
        if not knows(case.kind, plain_key(key)):
            # The case itself tells best what is wrong with a key.
            load_case(case.path, [*case.changes, f"{key}={parts[0].partition(',')[0]}"])
        try:
            if len(parts) == 1:
                given = [part.strip() for part in written.split(",")]
                values[key] = [_number(part) if unit is None else to_si(_number(part), unit) for part in given]
            else:
                values[key] = _steps(option, parts, None if unit is None else (to_si, unit))
        except UnitError as error:
            fail(f"--vary {option}: {error}")
    if (runs := prod(len(given) for given in values.values())) > MOST_RUNS:
        fail(f"--vary: wanted at most {MOST_RUNS} runs, got {runs}")
    return values


def _steps(option: str, parts: list[str], quantity: Any) -> list[Any]:
    """Equal steps from one value to another."""
    import numpy as np

    if len(parts) != 3 or not parts[2].isdecimal() or int(parts[2]) < 2:
        fail(f"--vary {option}: wanted FROM:TO:COUNT with a count of two or more, got {':'.join(parts)}")
    ends, count = [_number(part) for part in parts[:2]], int(parts[2])
    if count > MOST_RUNS:
        fail(f"--vary {option}: wanted at most {MOST_RUNS} values, got {count}")
    if quantity is not None:
        read, unit = quantity
        return list(np.linspace(read(ends[0], unit), read(ends[1], unit), count).tolist())
    if not all(isinstance(end, int) for end in ends):
        fail(f"--vary {option}: wanted whole numbers, or single values such as {option.partition('=')[0]}=a,b")
    steps = np.linspace(ends[0], ends[1], count)
    if not np.all(steps == np.round(steps)):
        fail(f"--vary {option}: wanted steps that are whole numbers, got {(ends[1] - ends[0]) / (count - 1):g}")
    return [int(step) for step in steps]


def _number(text: str) -> Any:
    """A number if the text is one, else the text."""
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text


def _worst(data: xr.Dataset) -> list[str]:
    """The varied values of the first run that ended early, or else of that with the largest first output."""
    # What is bad input cannot be run.
    import numpy as np

    from towercrane.runs.sweep_data import BAD_INPUT

    outcomes, first = data["outcome"].values, json.loads(data.attrs["outputs"])[:1]
    early = np.flatnonzero(~np.isin(outcomes, ["finished", INTERRUPTED_RUN, BAD_INPUT]))
    if len(early):
        run = int(early[0])
    elif first and np.any(np.isfinite(data[f"{first[0]}_max"].values)):
        run = int(np.nanargmax(data[f"{first[0]}_max"].values))
    else:
        run = 0
    return [f"{key}={data[key.replace('.', '_')].values[run].item()}" for key in json.loads(data.attrs["varied"])]


def _with_progress(case: Case, values: dict[str, list[Any]], threads: int | None) -> xr.Dataset:
    """Run with a progress bar if somebody is looking."""
    from towercrane.runs.sweep import sweep as run_all

    count = len(next(iter(values.values())))
    return with_bar(f"{count} runs", partial(run_all, case, values, threads=threads), count)
