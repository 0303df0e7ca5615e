"""What a run leaves: its quantities over time, with units and the provenance of the numbers."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Mapping

    import xarray as xr
    from numpy.typing import NDArray


LABELS: dict[str, list[Any]] = {
    "axis": ["outward", "sideways", "up"],
    "fixed_axis": ["x", "y", "up"],
    "joint": ["slew", "luff", "fold"],
}
"""Entries of dimensions that have names: the crane's own axes, which turn with its jib; fixed ones, of which x is
where the jib points at an angle of zero and y is to its left; and joints."""


def labels(dimension: str, size: int) -> list[Any]:
    """What the entries along a dimension are called: directions, joints, or numbers from 1."""
    return LABELS.get(dimension, list(range(1, size + 1)))


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

    @property
    def attrs(self) -> dict[str, str]:
        """Units and name, as a data set has them."""
        return {"units": self.units, "long_name": self.long_name}


@dataclass(frozen=True, eq=False)
class Recording:
    """A run's quantities over time, read like an :class:`xarray.Dataset`: by name, ``dims``, ``values``, ``attrs``.

    It is there because a run should not wait for pandas and xarray, which take longer to import than it takes.

    Parameters
    ----------
    times : ndarray, shape (times,)
        [s]
    data_vars : mapping of str to Quantity
    attrs : dict
        Provenance: text, numbers and arrays of numbers.
    looks : int
        Of so many times one is a row of the result; those between are for extremes, periods and spectra.
    """

    times: NDArray[np.float64]
    data_vars: Mapping[str, Quantity]
    attrs: dict[str, Any]
    looks: int = 1

    def __getitem__(self, name: str) -> Quantity:
        return self.time if name == "time" else self.data_vars[name]

    def __contains__(self, name: str) -> bool:
        return name == "time" or name in self.data_vars

    @property
    def time(self) -> Quantity:
        """The times as a quantity over themselves."""
        return Quantity(("time",), self.times, "s", "time")

    @property
    def coordinates(self) -> dict[str, Any]:
        """Times, and what the entries along the other dimensions are called."""
        found: dict[str, Any] = {"time": self.times}
        for quantity in self.data_vars.values():
            for dimension, size in zip(quantity.dims[1:], quantity.values.shape[1:], strict=True):
                found.setdefault(dimension, labels(dimension, size))
        return found

    @property
    def rows(self) -> Recording:
        """The same at the times that were asked for; what ended the run early shows in its last row."""
        if self.looks == 1:
            return self
        kept = np.arange(len(self.times)) % self.looks == 0
        kept[-1] |= self.attrs["outcome"] != "finished"
        quantities = {name: replace(q, values=q.values[kept]) for name, q in self.data_vars.items()}
        return replace(self, times=self.times[kept], data_vars=quantities, looks=1)

    def dataset(self) -> xr.Dataset:
        """The same as a labelled data set."""
        import pandas as pd
        import xarray as xr

        def parts(quantity: Quantity) -> tuple[Any, ...]:
            return quantity.dims, quantity.values, quantity.attrs

        # xarray would make an index of other sequences itself, and import pint, dask and all for it where installed.
        found = xr.Dataset(
            {name: parts(quantity) for name, quantity in self.data_vars.items()},
            {name: pd.Index(entries) for name, entries in self.coordinates.items()},
            dict(self.attrs),
        )
        found["time"].attrs.update(self.time.attrs)
        return found


if TYPE_CHECKING:
    Result = Recording | xr.Dataset
