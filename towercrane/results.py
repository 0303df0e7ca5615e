"""One result type for every run: a labelled data set, written whole or not at all."""

from __future__ import annotations

import contextlib
import os
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    import xarray as xr
    from numpy.typing import NDArray


LABELS: dict[str, list[Any]] = {"axis": ["outward", "sideways", "up"], "joint": ["slew", "luff", "fold"]}
"""Entries of dimensions that have names."""


@dataclass(frozen=True, eq=False)
class Quantity:
    """One variable of a result.

    Parameters
    ----------
    dims : tuple of str
    values : ndarray
    units : str
        SI, in words that pint reads.
    long_name : str
    """

    dims: tuple[str, ...]
    values: NDArray[np.float64]
    units: str
    long_name: str


def dataset(
    times: NDArray[np.float64], quantities: Mapping[str, Quantity], provenance: Mapping[str, Any]
) -> xr.Dataset:
    """Labelled data set over time, with units on every variable and the provenance in its attributes."""
    import pandas as pd
    import xarray as xr

    # xarray would turn other sequences into an index itself, and import pint, dask and all for it where installed.
    coordinates: dict[str, Any] = {"time": ("time", pd.Index(times), {"units": "s", "long_name": "time"})}
    variables = {}
    for name, quantity in quantities.items():
        for dimension, size in zip(quantity.dims, quantity.values.shape, strict=True):
            coordinates.setdefault(dimension, pd.Index(labels(dimension, size)))
        variables[name] = (
            quantity.dims,
            quantity.values,
            {"units": quantity.units, "long_name": quantity.long_name},
        )
    return xr.Dataset(variables, coordinates, dict(provenance))


def labels(dimension: str, size: int) -> list[Any]:
    """What the entries along a dimension are called: directions, joints, or numbers from 1."""
    return LABELS.get(dimension, list(range(1, size + 1)))


def save(result: xr.Dataset, path: str | os.PathLike[str]) -> None:
    """Write a result as NetCDF; a file that was there stays until the new one is whole."""
    with replacing(path) as temporary:
        result.to_netcdf(temporary, engine="h5netcdf")


def load(path: str | os.PathLike[str]) -> xr.Dataset:
    """Read a result that :func:`save` wrote."""
    import xarray as xr

    with xr.open_dataset(path, engine="h5netcdf") as opened:
        return opened.load()


def save_csv(result: xr.Dataset, path: str | os.PathLike[str]) -> None:
    """Write every variable over time as columns with units in the header, after comment lines on the origin."""
    columns, names = [result["time"].values], ["time [s]"]
    for name, variable in result.data_vars.items():
        flat = variable.values.reshape(len(columns[0]), -1)
        tails = [""] if variable.ndim == 1 else [f" {label}" for label in result[variable.dims[1]].values]
        names += [f"{name}{tail} [{variable.attrs['units']}]" for tail in tails]
        columns += list(flat.T)
    origin = "".join(f"# {key}: {value}\n" for key, value in result.attrs.items() if "\n" not in str(value))
    with replacing(path) as temporary, open(temporary, "w", encoding="utf-8", newline="\n") as file:
        file.write(origin + ",".join(names) + "\n")
        np.savetxt(file, np.column_stack(columns), delimiter=",", fmt="%.12g")


def write_text(text: str, path: str | os.PathLike[str]) -> None:
    """Write a text file whole or not at all."""
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


@contextlib.contextmanager
def replacing(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Name of a temporary file beside ``path`` that takes its place on success and vanishes on failure."""
    target = Path(path)
    target.parent.mkdir(parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(prefix=f".{target.stem}-", suffix=target.suffix, dir=target.parent)
    os.close(handle)
    temporary = Path(name)
    try:
        yield temporary
        # A temporary file is private; the result gets the rights that any new file has.
        temporary.chmod(0o666 & ~_umask())
        temporary.replace(target)
    finally:
        temporary.unlink(missing_ok=True)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
