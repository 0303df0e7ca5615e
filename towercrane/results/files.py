"""One result type for every run: a labelled data set, written whole or not at all."""

from __future__ import annotations

import contextlib
import io
import os
import platform
import re
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.results.recording import Recording

if TYPE_CHECKING:
    from collections.abc import Iterator

    import xarray as xr


def save(result: Recording | xr.Dataset, path: str | os.PathLike[str]) -> None:
    """Write a result as NetCDF; a file that was there stays until the new one is whole."""
    with replacing(path) as temporary:
        put(result, temporary)


def put(result: Recording | xr.Dataset, path: Path) -> None:
    """Write a result as NetCDF to a file that nobody reads yet."""
    import h5netcdf

    # HDF5 that meets a full disk crashes the process as it closes the file: it writes to memory instead.
    content = io.BytesIO()
    with h5netcdf.File(content, "w") as file:
        if isinstance(result, Recording):
            _write(result.rows, file)
        else:
            from xarray.backends import H5NetCDFStore

            result.dump_to_store(H5NetCDFStore(file))
    path.write_bytes(content.getbuffer())


def load(path: str | os.PathLike[str]) -> xr.Dataset:
    """Read a result that :func:`save` wrote.

    Raises
    ------
    OSError
        If the file cannot be read.
    ValueError
        If it is of another kind, leads to other files, or asks for more memory than it can fill.
    """
    import xarray as xr

    from towercrane.results.result_file import check_structure

    check_structure(Path(path))
    with xr.open_dataset(path, engine="h5netcdf") as opened:
        return opened.load()


def _write(recording: Recording, file: Any) -> None:
    """Fill an open file with what xarray writes of the same data set."""
    import h5py

    coordinates = recording.coordinates
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
    with replacing(path) as temporary:
        put_csv(result, temporary)


def put_csv(result: Recording, path: Path) -> None:
    """Write the columns to a file that nobody reads yet."""
    result = result.rows
    columns, names, coordinates = [result.times], ["time [s]"], result.coordinates
    for name, variable in result.data_vars.items():
        flat = variable.values.reshape(len(columns[0]), -1)
        tails = [""] if variable.values.ndim == 1 else [f" {label}" for label in coordinates[variable.dims[1]]]
        names += [f"{name}{tail} [{variable.units}]" for tail in tails]
        columns += list(flat.T)
    origin = "".join(f"# {key}: {value}\n" for key, value in result.attrs.items() if "\n" not in str(value))
    with open(path, "w", encoding="utf-8", newline="\n") as file:
        file.write(origin + ",".join(names) + "\n")
        np.savetxt(file, np.column_stack(columns), delimiter=",", fmt="%.12g")


@contextlib.contextmanager
def replacing(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Name of a temporary file beside ``path`` that takes its place on success and vanishes on failure."""
    target = Path(path)
    target.parent.mkdir(parents=True, exist_ok=True)
    if target.is_dir():
        raise IsADirectoryError(f"{target} is a folder")
    _clear(target.parent)
    handle, name = tempfile.mkstemp(prefix=f"{_TEMPORARY}{os.getpid()}-", suffix=target.suffix, dir=target.parent)
    os.close(handle)
    temporary = Path(name)
    try:
        yield temporary
        # A temporary file is private; the result gets the rights that any new file has.
        temporary.chmod(0o666 & ~_umask())
        temporary.replace(target)
    finally:
        temporary.unlink(missing_ok=True)


_TEMPORARY = f".towercrane-{re.sub(r'[^0-9A-Za-z]', '_', platform.node())}-"
"""How names of temporary files of this machine begin; the number of the process follows."""


def _clear(folder: Path) -> None:
    """Remove temporary files of processes of this machine that were killed."""
    for path in folder.glob(f"{_TEMPORARY}*"):
        found = re.fullmatch(rf"{_TEMPORARY}(\d+)-\w+(\.\w+)?", path.name)
        if found and not _lives(int(found[1])):
            with contextlib.suppress(OSError):
                path.unlink()


def _lives(process: int) -> bool:
    """Whether a process of this number is there; on Windows nobody can ask without ending it."""
    if os.name == "nt":
        return True
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except (OSError, OverflowError):
        return True
    return True


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
