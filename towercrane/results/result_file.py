"""Result files from elsewhere: looked at before anything of them is loaded, judged before anything is drawn."""

from __future__ import annotations

import json
from math import prod
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from pathlib import Path

    import xarray as xr

MOST_EXPANDED, FREE = 100, 64 * 2**20
"""Bytes in memory over bytes in the file, and bytes besides, beyond which a file asks for more than it holds."""

MOST_MEMBERS = 1000
"""Variables of one file; a run has some fifty."""

LARGEST = 1e12
"""Size of a number in SI beyond which it is no crane's."""

MOST_MODES = 50
"""Coordinates of one kind."""

POSITIVE, NUMBER, TEXT = "a positive number", "a number", "text"

ATTRIBUTES = {
    "outcome": TEXT,
    "case": TEXT,
    "crane": TEXT,
    "end_time": NUMBER,
    "gravity": POSITIVE,
    "output_step": POSITIVE,
    "payload_mass": POSITIVE,
}
"""What every result states of its run."""

ENTRIES = {"payload_position": (3,), "hook_position": (3,), "joint_angle": (3,)}
"""Shape of a row of the variables that are no plain numbers; coordinates of modes have one entry for each."""


def check_structure(path: Path) -> None:
    """Refuse a file that leads elsewhere or asks for more memory than it can fill.

    Raises
    ------
    OSError
        If it cannot be opened, or is no HDF5 file.
    ValueError
        If it holds links, groups, references, data that other files keep, or too much.
    """
    import h5py

    size = path.stat().st_size
    if not path.is_file():
        raise ValueError(f"wanted a regular file, got {'a folder' if path.is_dir() else 'another kind'}")
    allowed, asked = MOST_EXPANDED * size + FREE, 0
    with h5py.File(path, "r") as file:
        if len(file) > MOST_MEMBERS:
            raise ValueError(f"wanted at most {MOST_MEMBERS} variables, got {len(file)}")
        for name in file:
            if not isinstance(file.get(name, getlink=True), h5py.HardLink):
                raise ValueError(f"{name}: wanted data, got a link")
            found = file[name]
            if not isinstance(found, h5py.Dataset):
                raise ValueError(f"{name}: wanted data, got a {type(found).__name__.lower()}")
            if found.external or found.is_virtual:
                raise ValueError(f"{name}: wanted data, got some of another file")
            _check_dimensions(name, found)
            asked += _bytes(name, found.id, size) + _attributes(found, size)
        asked += _attributes(file, size)
    if asked > allowed:
        raise ValueError(f"wanted at most {allowed:.3g} bytes of data in a file of {size}, got {asked:.3g}")


def _check_dimensions(name: str, found: Any) -> None:
    """Refuse a variable that is not as long as its dimensions, or has one of them twice."""
    sized = zip(found.dims, found.shape, strict=True)
    scales = [(dimension[0], length) for dimension, length in sized if len(dimension)]
    if len({scale.name for scale, _ in scales}) < len(scales):
        raise ValueError(f"{name}: wanted a dimension once, got it twice")
    for scale, length in scales:
        if scale.shape != (length,):
            raise ValueError(f"{name}: wanted {scale.shape} values along {scale.name}, got {length}")


def _attributes(owner: Any, size: int) -> int:
    """Bytes that the attributes of a file or a variable take in memory; those of the format itself are small."""
    asked = 0
    for name in owner.attrs:
        if name not in ("DIMENSION_LIST", "REFERENCE_LIST"):
            asked += _bytes(name, owner.attrs.get_id(name), size)
    return asked


def _bytes(name: str, found: Any, size: int) -> int:
    """Bytes that a variable or an attribute takes in memory; a text of any length at most the file's."""
    import h5py

    kind = found.dtype
    if h5py.check_string_dtype(kind) is None and kind.kind not in "fiub":
        raise ValueError(f"{name}: wanted numbers or text, got others")
    each = kind.itemsize if kind.kind != "O" else kind.itemsize + size
    return prod(int(length) for length in found.shape or ()) * int(each)


def saved_axes(path: Path) -> int:
    """Axes of the space in which the load of a run moved; 3 where a file does not tell."""
    import h5py

    try:
        with h5py.File(path, "r") as file:
            return int(json.loads(file.attrs["end"])["axes"])
    except (OSError, KeyError, TypeError, ValueError):
        return 3


def check_run(result: xr.Dataset) -> None:
    """Refuse a data set that is no run of this program.

    Raises
    ------
    ValueError
        If attributes or variables are missing, of another type or shape, or no numbers of a crane.
    """
    if "time" not in result.coords or "outcome" not in result.attrs:
        raise ValueError("wanted a result.nc of `towercrane run`, got another data set")
    for name, wanted in ATTRIBUTES.items():
        _check_attribute(name, wanted, result.attrs.get(name))
    for name in ("changes", "assumed"):
        _check_list(name, result.attrs.get(name, "[]"))
    for name in ("rope_length", "payload_position"):
        if name not in result:
            raise ValueError(f"wanted a result with all that `towercrane run` writes, got one without: {name}")
        entries(result, name)
    times = numbers(result, "time")
    if not (len(times) and (np.diff(times) > 0.0).all()):
        raise ValueError("wanted times that increase from row to row, got others")
    for variable, values in result.data_vars.items():
        if values.dims[:1] == ("time",):
            numbers(result, str(variable))
    if not (numbers(result, "rope_length") > 0.0).all():
        raise ValueError("rope_length: wanted positive lengths, got others")


def numbers(result: xr.Dataset, name: str) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Values of a variable over time; shape (times, ...).

    Raises
    ------
    ValueError
        If there are none, or they are no finite numbers of a crane.
    """
    if name not in result:
        raise ValueError(f"wanted a result with {name}, got one without")
    values = result[name].values
    if values.dtype.kind not in "fiu" or result[name].dims[:1] != ("time",):
        raise ValueError(f"{name}: wanted numbers over time, got others")
    fine = (abs(values.reshape(len(values), -1)) <= LARGEST).all(axis=1)
    if not fine.all():
        row = int(fine.argmin()) + 1
        raise ValueError(f"{name}: wanted finite values up to {LARGEST:g}, got others in row {row}")
    return np.asarray(values, dtype=float)


def entries(result: xr.Dataset, name: str) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Values of a variable over time whose rows have the shape of its kind; shape (times, ...).

    Raises
    ------
    ValueError
        If there are none, or their shape is another.
    """
    values = numbers(result, name)
    shape = values.shape[1:]
    if name.endswith("_coordinate"):
        if len(shape) != 1 or shape[0] > MOST_MODES:
            raise ValueError(f"{name}: wanted up to {MOST_MODES} coordinates in a row, got shape {shape}")
    elif shape != (wanted := ENTRIES.get(name, ())):
        raise ValueError(f"{name}: wanted rows of shape {wanted}, got {shape}")
    return values


def _check_attribute(name: str, wanted: str, value: Any) -> None:
    if isinstance(value, np.generic):
        value = value.item()
    fits = isinstance(value, str) if wanted == TEXT else isinstance(value, int | float) and abs(value) <= LARGEST
    if not fits or (wanted == POSITIVE and not value > 0.0):
        raise ValueError(f"attribute {name}: wanted {wanted}, got {'none' if value is None else repr(value)[:60]}")


def _check_list(name: str, text: Any) -> None:
    """A list as JSON, of texts or of rows of three."""
    try:
        found = json.loads(text)
        rows = [[entry] if name == "changes" else entry for entry in found]
        wide = 1 if name == "changes" else 3
        fits = isinstance(found, list) and all(len(row) == wide for row in rows)
        fits = fits and all(isinstance(part, str) for row in rows for part in row)
    except (TypeError, ValueError, RecursionError):
        fits = False
    if not fits:
        raise ValueError(f"attribute {name}: wanted a list as JSON, got {repr(text)[:60]}")
