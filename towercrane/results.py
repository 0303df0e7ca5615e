"""One result type for every run: a labelled data set, written whole or not at all."""

from __future__ import annotations

import contextlib
import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from towercrane.recording import Recording

if TYPE_CHECKING:
    from collections.abc import Iterator

    import xarray as xr


def save(result: Recording | xr.Dataset, path: str | os.PathLike[str]) -> None:
    """Write a result as NetCDF; a file that was there stays until the new one is whole."""
    with replacing(path) as temporary:
        if isinstance(result, Recording):
            _write(result.rows, temporary)
        else:
            result.to_netcdf(temporary, engine="h5netcdf")


def load(path: str | os.PathLike[str]) -> xr.Dataset:
    """Read a result that :func:`save` wrote."""
    import xarray as xr

    with xr.open_dataset(path, engine="h5netcdf") as opened:
        return opened.load()


def _write(recording: Recording, path: Path) -> None:
    """The file that xarray writes of the same data set."""
    import h5netcdf
    import h5py

    coordinates = recording.coordinates
    with h5netcdf.File(path, "w") as file:
        file.attrs.update(recording.attrs)
        file.dimensions = {name: len(entries) for name, entries in coordinates.items()}
        for name, entries in coordinates.items():
            kind = h5py.string_dtype() if isinstance(entries[0], str) else None
            file.create_variable(name, (name,), data=np.array(entries, kind))
        for name, quantity in recording.data_vars.items():
            file.create_variable(name, quantity.dims, data=quantity.values)
        for name in ("time", *recording.data_vars):
            file.variables[name].attrs.update(recording[name].attrs)


def save_csv(result: Recording, path: str | os.PathLike[str]) -> None:
    """Write every variable over time as columns with units in the header, after comment lines on the origin."""
    result = result.rows
    columns, names, coordinates = [result.times], ["time [s]"], result.coordinates
    for name, variable in result.data_vars.items():
        flat = variable.values.reshape(len(columns[0]), -1)
        tails = [""] if variable.values.ndim == 1 else [f" {label}" for label in coordinates[variable.dims[1]]]
        names += [f"{name}{tail} [{variable.units}]" for tail in tails]
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
