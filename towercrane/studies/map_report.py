"""What a frequency map says: report, rows of text, provenance."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cases.assumptions import as_attribute, rests_on
from towercrane.cranes.tower.file.case_tables import TowerCase
from towercrane.cranes.tower.file.requests import left_out_in_plane
from towercrane.results.versions import versions
from towercrane.runs.summary import assumed
from towercrane.simulation.outcomes import FINISHED
from towercrane.studies.frequency_map import doubtful_steps
from towercrane.studies.plane_modes import LOADS, STATIC_OUTPUTS

if TYPE_CHECKING:
    import xarray as xr

    from towercrane.cases.case import Case


def provenance(case: Case) -> dict[str, Any]:
    """Where a map is from, for its attributes."""
    return {
        "case": case.name,
        "title": case.title,
        "crane": case.crane.name,
        "changes": json.dumps(case.changes),
        "case_text": json.dumps(case.as_written),
        "left_out": json.dumps(left_out_in_plane(case.tables(TowerCase))),
        "assumed": as_attribute(rests_on(case, exact_crane=True)),
        "versions": json.dumps(versions()),
    }


def map_report(data: xr.Dataset) -> dict[str, Any]:
    """A map, ready for JSON.

    Returns
    -------
    dict
        ``outcome``, ``positions_m``, ``branches`` (names), ``payloads``: payload_kg, outcome, buckling_factor and,
        where the tower stands, ``frequencies_hz`` and ``energy_share`` (mean per member) by branch, and
        ``contribution`` by branch: each mode's part, from 0 to 1 or beyond, in the static outputs under a unit force
        on the trolley at its outermost position; None where the static output is zero. ``doubtful``: where a branch
        may have been lost. Of a crane in the modes of a model without ``contribution``, with ``change_by_more_modes``
        by branch, ``shapes`` and ``shapes_of_the_richer`` in words; of one whose jib pivots ``luffing_angles_rad`` in
        place of positions. ``left_out``, ``assumed``, ``versions``, ``wall_seconds``.
    """
    attributes, modelled = data.attrs, "change_by_more_modes" in data
    pivots = data["position"].attrs["units"] == "rad"
    one_place, places = ("luffing_angle_rad", "luffing_angles_rad") if pivots else ("position_m", "positions_m")
    names = [str(name) for name in data["branch"].values]
    payloads = []
    for i, outcome in enumerate(data["outcome"].values):
        one = data.isel(payload=i)
        row: dict[str, Any] = {
            "payload_kg": float(one["payload"]),
            "outcome": str(outcome),
            "buckling_factor": _finite(float(one["buckling_factor"])),
        }
        if outcome == FINISHED:
            shares = one["energy_share"].mean("position")
            row["branches"] = [
                {
                    "name": name,
                    "frequencies_hz": one["frequency"].values[:, k].tolist(),
                    "energy_share": dict(zip(data["member"].values.tolist(), shares.values[k].tolist(), strict=True)),
                    **({} if modelled else {"contribution": _contribution(one.isel(position=-1, mode=k))}),
                }
                for k, name in enumerate(names)
            ]
        payloads.append(row)
    return {
        "case": attributes["case"],
        "name": attributes["crane"],
        "outcome": attributes["outcome"],
        "rope_length_m": float(attributes["rope_length"]),
        "weight_softening": bool(attributes["weight_softening"]),
        places: data["position"].values.tolist(),
        "branches": names,
        "payloads": payloads,
        "doubtful": [{"payload_kg": p, one_place: x, "branch": names[k - 1]} for p, x, k in doubtful_steps(data)],
        **(_richer(data) if modelled else {}),
        "left_out": json.loads(attributes["left_out"]),
        "assumed": [{"key": key, "value": value, "why": why} for key, value, why in assumed(data)],
        "versions": json.loads(attributes["versions"]),
        "spectra_computed": int(attributes["spectra_computed"]),
        "wall_seconds": float(attributes["wall_seconds"]),
    }


def _richer(data: xr.Dataset) -> dict[str, Any]:
    """What a model in more modes says of the branches."""
    names, change = data["branch"].values.tolist(), data["change_by_more_modes"].values.tolist()
    words = {key: str(data.attrs[key]) for key in ("shapes", "shapes_of_the_richer")}
    return {"change_by_more_modes": dict(zip(names, change, strict=True)), **words}


def _contribution(mode: xr.Dataset) -> dict[str, dict[str, float | None]]:
    """Share of one mode in every static output, per load on the trolley."""
    shares: dict[str, dict[str, float | None]] = {}
    for load in LOADS:
        one = mode.sel(load=load)
        totals = {name: float(one[f"static_{name}"]) for name in STATIC_OUTPUTS}
        shares[load] = {
            name: float(one[f"modal_{name}"]) / total if total != 0.0 else None for name, total in totals.items()
        }
    return shares


def _finite(value: float) -> float | None:
    return value if np.isfinite(value) else None


def csv_text(data: xr.Dataset) -> str:
    """One line per payload, position and mode, with units in the header, after comment lines on the origin.

    Static outputs of all modes stand beside each mode's part in them.
    """
    scalars = ["frequency", "shape_agreement"]
    statics = ((f"{part}_{name}", "load") for name in STATIC_OUTPUTS for part in ("modal", "static"))
    split = [("energy_share", "member"), *(own for own in statics if own[0] in data)]
    header = ["payload [kg]", f"position [{data['position'].attrs['units']}]", "mode", "branch"]
    header += [f"{name} [{data[name].attrs['units']}]" for name in scalars]
    header += [f"{name} {label} [{data[name].attrs['units']}]" for name, dim in split for label in data[dim].values]
    lines = [f"# {key}: {value}" for key, value in data.attrs.items() if "\n" not in str(value)]
    lines += [
        f"# load {float(mass):g} kg: {outcome}, buckling factor {float(factor):.6g}"
        for mass, outcome, factor in zip(
            data["payload"], data["outcome"].values, data["buckling_factor"], strict=True
        )
    ]
    lines.append(",".join(header))
    for i, outcome in enumerate(data["outcome"].values):
        if outcome != FINISHED:
            continue
        for j in range(data.sizes["position"]):
            for k in range(data.sizes["mode"]):
                row = data.isel(payload=i, position=j, mode=k)
                values = [float(row[name]) for name in scalars]
                values += [float(value) for name, _ in split for value in row[name].values]
                place = f"{float(row['payload']):.12g},{float(row['position']):.12g},{int(row['mode'])}"
                lines.append(f"{place},{row['branch'].values},{','.join(f'{value:.12g}' for value in values)}")
    return "\n".join(lines) + "\n"
