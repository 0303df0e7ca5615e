"""Linear state-space model with named states, inputs and outputs; its eigenvalues; files that other tools read."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    import os
    from collections.abc import Sequence

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

FILE_TYPES = (".mat", ".npz")
"""Endings of the files that :meth:`StateSpace.save` writes."""

RATE = "_rate"
"""Ending of a state's name that is the rate of the state of that name."""


BALANCED = 1e-7
"""Rate of a state, relative to the terms that cancel in it, below which it is rounding."""


class Signal(NamedTuple):
    """A state, an input or an output."""

    name: str
    units: str

    def __str__(self) -> str:
        return f"{self.name} [{self.units}]" if self.units else self.name


class Eigenvalue(NamedTuple):
    """A real eigenvalue or a complex pair.

    ``frequency`` is |value| / 2 pi [Hz], ``damping_ratio`` is -real / |value| (nan at zero) and ``state`` the
    coordinate that takes part most.
    """

    value: complex
    frequency: float
    damping_ratio: float
    state: str


@dataclass(frozen=True, eq=False)
class OperatingPoint:
    """What the linear model is about: x' = slope + A (x - states) + B (u - inputs).

    Parameters
    ----------
    states, inputs, outputs : ndarray
        Values there, as the linear model orders them; sway angles count from here and are zero.
    slope : ndarray
        Rates of change of the states there: zero at an equilibrium.
    full_state : ndarray
        State of the nonlinear model.
    inclination : float
        Angle of the rope from the vertical there [rad].
    steady : ndarray, optional
        What the slope is of a state that turns steadily with its head: zero but for the angles that turn.
    """

    states: Floats
    inputs: Floats
    outputs: Floats
    slope: Floats
    full_state: Floats
    inclination: float = 0.0
    steady: Floats | None = None

    @property
    def spin(self) -> float:
        """Rate at which the head turns steadily [rad/s]."""
        return 0.0 if self.steady is None else float(max(self.steady, key=abs, default=0.0))


@dataclass(frozen=True, eq=False)
class StateSpace:
    """Linear model x' = A x + B u, y = C x + D u of small departures from an operating point.

    Parameters
    ----------
    a, b, c, d : ndarray
        Matrices, with as many rows and columns as there are states, inputs and outputs.
    states, inputs, outputs : tuple of Signal
        Names and units. A state and its rate are called ``name`` and ``name_rate``.
    point : OperatingPoint
    error : float
        Estimated error of A and B by numerical differentiation, relative to the largest entry of a row.
    """

    a: Floats
    b: Floats
    c: Floats
    d: Floats
    states: tuple[Signal, ...]
    inputs: tuple[Signal, ...]
    outputs: tuple[Signal, ...]
    point: OperatingPoint
    error: float = 0.0

    def __post_init__(self) -> None:
        n, m, p = len(self.states), len(self.inputs), len(self.outputs)
        for name, wanted in (("a", (n, n)), ("b", (n, m)), ("c", (p, n)), ("d", (p, m))):
            if getattr(self, name).shape != wanted:
                raise ValueError(f"StateSpace.{name}: wanted shape {wanted}, got {getattr(self, name).shape}")

    def eigenvalues(self) -> list[Eigenvalue]:
        """Eigenvalues of A by ascending frequency, one entry for each complex pair.

        A coordinate takes part by the length of its share (value and rate) of the right eigenvector times that of
        the left one: no choice of units changes which is largest.
        """
        from scipy.linalg import eig

        if not self.states:
            return []
        values, left, right = eig(self.a, left=True, right=True)
        names = [signal.name.removesuffix(RATE) for signal in self.states]
        coordinates = list(dict.fromkeys(names))
        member = np.array([[name == coordinate for name in names] for coordinate in coordinates], dtype=float)
        share = np.sqrt((member @ abs(left) ** 2) * (member @ abs(right) ** 2))
        table = []
        for index in np.lexsort((values.real, abs(values))):
            value, size = complex(values[index]), float(abs(values[index]))
            if value.imag >= 0.0:
                ratio = -value.real / size if size else np.nan
                dominant = coordinates[int(np.argmax(share[:, index]))]
                table.append(Eigenvalue(value, size / (2.0 * np.pi), ratio, dominant))
        return table

    @property
    def at_equilibrium(self) -> bool:
        """Whether the states do not change where the model is taken, but for rounding and a steady rotation."""
        point = self.point
        terms = abs(self.a) @ abs(point.states) + abs(self.b) @ abs(point.inputs)
        changing = point.slope if point.steady is None else point.slope - point.steady
        return bool(np.all(abs(changing) <= BALANCED * (1.0 + terms)))

    @property
    def frequencies(self) -> Floats:
        """Natural frequencies of all oscillations, ascending [Hz]."""
        return np.array([e.frequency for e in self.eigenvalues() if e.value.imag > 0.0])

    def save(self, path: str | os.PathLike[str], assumed: Sequence[tuple[str, str, str]] = ()) -> None:
        """Write a file for MATLAB (``.mat``) or NumPy (``.npz``), whole or not at all.

        Fields: A, B, C, D; states, inputs, outputs and their units (cell arrays of text in MATLAB); x0, u0, y0,
        slope and the rope's inclination at the operating point; assumed: a line for each value that no source gives,
        from its key, value and reason. In MATLAB ``ss(A, B, C, D, 'StateName', states)``, in
        python-control ``control.ss(m["A"], m["B"], m["C"], m["D"])`` of ``m = scipy.io.loadmat(path)``.

        Raises
        ------
        ValueError
            If the path ends otherwise.
        """
        from towercrane.results.files import replacing

        ending = Path(path).suffix.lower()
        if ending not in FILE_TYPES:
            raise ValueError(f"path: wanted a name that ends in {' or '.join(FILE_TYPES)}, got {str(path)!r}")
        with replacing(path) as temporary, open(temporary, "wb") as file:
            if ending == ".mat":
                from scipy.io import savemat

                savemat(file, self._fields(object, assumed))
            else:
                np.savez(file, **self._fields(str, assumed))

    def _fields(self, text: type, assumed: Sequence[tuple[str, str, str]]) -> dict[str, Any]:
        fields: dict[str, Any] = {"A": self.a, "B": self.b, "C": self.c, "D": self.d}
        for group in ("states", "inputs", "outputs"):
            signals: tuple[Signal, ...] = getattr(self, group)
            fields[group] = np.array([signal.name for signal in signals], dtype=text)
            fields[f"{group[:-1]}_units"] = np.array([signal.units for signal in signals], dtype=text)
        fields["assumed"] = np.array([f"{key} = {value}: {why}" for key, value, why in assumed], dtype=text)
        point = self.point
        fields |= {"x0": point.states, "u0": point.inputs, "y0": point.outputs, "slope": point.slope}
        return fields | {"inclination": point.inclination}
