"""Picture of a sweep: extremes of the outputs over one varied value as lines, over two as maps."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.report.plots.style import COLOURS, figure_of, footnote
from towercrane.runs.summary import assumed
from towercrane.runs.sweep_data import BAD_INPUT

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

MOST_OUTPUTS = 4
"""Outputs that are shown; the files hold all."""

DRIVEN = ("trolley_", "rope_length", "slewing_angle", "slewing_speed", "shaft_", "wind_")
"""Beginnings of the names of outputs that are rather inputs."""

SHOWN = {"rad": (180.0 / np.pi, "deg"), "N": (1e-3, "kN")}
"""Factor and unit of what is shown in another unit than it is computed in."""


def extremes(data: xr.Dataset) -> dict[str, Figure]:
    """Picture by file name; none unless one or two numbers were varied over a grid."""
    keys = json.loads(data.attrs["varied"])
    axes = [np.unique(data[key.replace(".", "_")].values) for key in keys]
    grid = int(np.prod([len(axis) for axis in axes])) == len(data["run"])
    numbers = all(np.issubdtype(axis.dtype, np.number) and len(axis) > 1 for axis in axes)
    outputs = [name for name in json.loads(data.attrs["outputs"]) if not name.startswith(DRIVEN)][:MOST_OUTPUTS]
    if not (grid and numbers and outputs and len(keys) in (1, 2)):
        return {}
    figure = figure_of(9.0, 3.1 * -(-len(outputs) // 2) + 0.6)
    panels = np.atleast_1d(figure.subplots(-(-len(outputs) // 2), 2 if len(outputs) > 1 else 1)).ravel()
    for panel, name in zip(panels, outputs, strict=False):
        if len(keys) == 1:
            _lines(panel, data, keys[0], name)
        else:
            _map(figure, panel, data, keys, name)
    for panel in panels[len(outputs) :]:
        panel.set_visible(False)
    bad, early = np.count_nonzero(data["outcome"].values == BAD_INPUT), np.count_nonzero(_early(data))
    ended = f"; crosses: {early} runs that ended early" if early else ""
    ended += f"; left out: {bad} that are bad input" if bad else ""
    figure.suptitle(f"{data.attrs['crane']}: {data.attrs['title']}{ended}", fontsize=10)
    footnote(figure, assumed(data))
    return {"sweep.png": figure}


def _lines(axes: Axes, data: xr.Dataset, key: str, name: str) -> None:
    """Largest and smallest value of an output over a varied value."""
    order = np.argsort(data[key.replace(".", "_")].values)
    x, early = data[key.replace(".", "_")].values[order], _early(data)[order]
    factor, unit = _shown(data, name)
    for colour, dash, end in zip(COLOURS, ("-", "--"), ("max", "min"), strict=False):
        values = factor * data[f"{name}_{end}"].values[order]
        label = {"max": "largest", "min": "smallest"}[end]
        axes.plot(x, values, dash, color=colour, lw=1.2, label=label)
        axes.plot(x[early], values[early], "x", color=colour, ms=5)
    axes.set(xlabel=_label(data, key), ylabel=f"{name.replace('_', ' ')} [{unit}]")
    axes.grid(axis="y", color="0.9", lw=0.6)
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), borderaxespad=0.2, ncols=2, fontsize=8, frameon=False)


def _map(figure: Figure, axes: Axes, data: xr.Dataset, keys: list[str], name: str) -> None:
    """Largest size of an output over two varied values."""
    from matplotlib.ticker import ScalarFormatter

    first, second = (data[key.replace(".", "_")].values for key in keys)
    x, column = np.unique(first, return_inverse=True)
    y, row = np.unique(second, return_inverse=True)
    factor, unit = _shown(data, name)
    size = np.full((len(y), len(x)), np.nan)
    size[row, column] = factor * np.maximum(abs(data[f"{name}_max"].values), abs(data[f"{name}_min"].values))
    mesh = axes.pcolormesh(x, y, size, cmap="viridis", shading="nearest", rasterized=True)
    early = _early(data)
    axes.plot(first[early], second[early], "x", color="white", ms=4)
    axes.set(xlabel=_label(data, keys[0]), ylabel=_label(data, keys[1]))
    # An offset above the bar would have to be added to every number beside it.
    numbers = ScalarFormatter(useOffset=False)
    figure.colorbar(mesh, ax=axes, format=numbers, label=f"largest size of {name.replace('_', ' ')} [{unit}]")


def _early(data: xr.Dataset) -> NDArray[np.bool_]:
    """Runs that ended early."""
    return ~np.isin(data["outcome"].values.astype(str), ["finished", BAD_INPUT])


def _shown(data: xr.Dataset, name: str) -> tuple[float, Any]:
    unit = data[f"{name}_max"].attrs["units"]
    return SHOWN.get(unit, (1.0, unit))


def _label(data: xr.Dataset, key: str) -> str:
    about = data[key.replace(".", "_")].attrs
    return f"{about['long_name']} [{about['units']}]"
