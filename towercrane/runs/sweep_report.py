"""What a sweep found: the extremes of all its runs, a table of them, and the run to look at."""

from __future__ import annotations

import csv
import io
import json
from collections import Counter
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.runs.summary import assumed
from towercrane.runs.sweep_data import BAD_INPUT
from towercrane.simulation.outcomes import FINISHED, INTERRUPTED

if TYPE_CHECKING:
    import xarray as xr


def report(data: xr.Dataset, seconds: float) -> dict[str, Any]:
    """Largest and smallest value of every output over all runs and where they occur, ready for JSON."""
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
    ended = int((data["outcome"] != INTERRUPTED).sum())
    notices = json.loads(data.attrs["notices"])
    if told := _not_of_all(data):
        notices.append(told)
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


def _not_of_all(data: xr.Dataset) -> str:
    """Outputs that not every run has, as scenes in a plane have none across it; nothing where all have all."""
    known = np.isfinite(data["end_time"].values)
    lacking = {
        name: int(np.isnan(data[f"{name}_max"].values[known]).sum()) for name in json.loads(data.attrs["outputs"])
    }
    names = ", ".join(name.replace("_", " ") for name, count in lacking.items() if count)
    return (
        f"{max(lacking.values())} of {known.sum()} runs do not have {names}: extremes are of the others"
        if names
        else ""
    )


def runs_csv(data: xr.Dataset) -> str:
    """A line per run: the varied values, then everything that is known of it."""
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


def worst(data: xr.Dataset) -> list[str]:
    """The varied values of the first run that ended early, or else of that with the largest first output."""
    # What is bad input cannot be run.
    outcomes, first = data["outcome"].values, json.loads(data.attrs["outputs"])[:1]
    early = np.flatnonzero(~np.isin(outcomes, [FINISHED, INTERRUPTED, BAD_INPUT]))
    if len(early):
        run = int(early[0])
    elif first and np.any(np.isfinite(data[f"{first[0]}_max"].values)):
        run = int(np.nanargmax(data[f"{first[0]}_max"].values))
    else:
        run = 0
    return [f"{key}={data[key.replace('.', '_')].values[run].item()}" for key in json.loads(data.attrs["varied"])]
