"""Pictures of a sensitivity study: outputs over time and parameter, and what matters."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from towercrane.report.plots.style import COLOURS, figure_of, footnote
from towercrane.runs.summary import assumed

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

    from towercrane.studies.sensitivity import Study

SHOWN = {"rad": (180.0 / np.pi, "deg")}
"""Factor and unit of what is shown in another unit than it is computed in."""


def surface(data: xr.Dataset, parameter: str) -> Figure:
    """Every output of a study over time and one parameter."""
    outputs = list(data.data_vars)
    figure = figure_of(8.0, 2.1 * len(outputs) + 0.6)
    rows = np.atleast_1d(figure.subplots(len(outputs), 1, sharex=True))
    for axes, name in zip(rows, outputs, strict=True):
        factor, unit = SHOWN.get(data[name].attrs["units"], (1.0, data[name].attrs["units"]))
        # What is there at rest, such as the moment of the weights, would drown the rest.
        values = factor * data[name].sel(parameter=parameter).values
        values = values - values[:, :1]
        # Symmetric colours show what is positive and negative at a glance.
        largest = float(np.nanmax(abs(values)))
        mesh = axes.pcolormesh(
            data["time"].values, data["percent"].values, values, cmap="RdBu_r", vmin=-largest, vmax=largest,
            shading="nearest", rasterized=True,
        )  # fmt: skip
        axes.axhline(100.0, color="black", lw=0.5)
        axes.set_ylabel("value [% of nominal]", fontsize=7)
        figure.colorbar(mesh, ax=axes, label=f"{str(name).replace('_', ' ')}\n[{unit}]")
    rows[-1].set_xlabel("time [s]")
    footnote(figure, assumed(data))
    figure.suptitle(
        f"{parameter.replace('_', ' ')}: change of the outputs since the start\n{data.attrs['crane']}", fontsize=10
    )
    return figure


def ranking(study: Study) -> Figure:
    """Largest change of each output per parameter, within 50 to 150 percent of nominal."""
    outputs = list(study.data.data_vars)
    figure = figure_of(8.0, 0.34 * len(study.influence) + 1.6)
    axes = figure.subplots()
    height = 0.8 / len(outputs)
    places = np.arange(len(study.influence))
    for k, name in enumerate(outputs):
        sizes = [max(100.0 * entry["near"][name], 1e-3) for entry in study.influence]
        axes.barh(
            places + (k - 0.5 * (len(outputs) - 1)) * height, sizes, height, color=COLOURS[k % 6],
            label=str(name).replace("_", " "),
        )  # fmt: skip
    axes.set_yticks(places, [entry["parameter"].replace("_", " ") for entry in study.influence], fontsize=8)
    axes.invert_yaxis()
    axes.set(
        xscale="log",
        xlim=(1e-3, max(200.0, 2.0 * axes.get_xlim()[1])),
        xlabel="largest change of the output within 50 to 150 % of nominal [% of its peak]",
    )
    axes.set_ylabel("parameter [varied alone]")
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=3, fontsize=8, frameon=False)
    footnote(figure, assumed(study.data))
    return figure
