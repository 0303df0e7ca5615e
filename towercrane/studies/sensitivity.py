"""Which parameters and degrees of freedom matter: the study of Jerman (2006), section 2.3, for any lumped crane.

Each parameter is varied from near zero to twice its nominal value while the others stay. Each elastic member is made
rigid in turn, which is what leaving out its degree of freedom means; those that change nothing leave together, and
the reduced crane runs beside the full one.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.cases.assumptions import as_entries, rests_on
from towercrane.cranes.slewing.reduce import make_rigid
from towercrane.simulation.outcomes import INTERRUPTED
from towercrane.simulation.simulate import simulate

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import xarray as xr
    from numpy.typing import NDArray

    from towercrane.cases.case import Case
    from towercrane.cranes.slewing.description import LumpedCrane
    from towercrane.cranes.slewing.model import LumpedModel
    from towercrane.motions.motion import Motion

    Floats = NDArray[np.float64]

STUDIED_OUTPUTS = ("sway_tangential", "sway_radial", "jib_moment_horizontal", "jib_moment_vertical", "drive_torque")
"""What the study looks at."""

PERCENT = tuple(range(0, 201, 20))
"""Parameter values in percent of nominal."""

NEAR_ZERO = 0.01
"""A member without any stiffness would fall apart; zero percent of a stiffness means this fraction."""

TOLERANCE = 0.02
"""Change of every output, relative to its peak, below which a degree of freedom is left out."""


@dataclass(frozen=True, eq=False)
class Study:
    """Result of a sensitivity study.

    Parameters
    ----------
    data : xarray.Dataset
        Each output over ``parameter``, ``percent`` and ``time``; not a number where a run had ended.
    influence : list of dict
        Per parameter, the most influential first: ``parameter``, ``near`` and ``far`` by output: the largest change
        relative to the output's nominal peak within 50 to 150 percent and over the whole range.
    members : list of dict
        Per elastic member, the least important first: ``member`` and ``change`` by output if it is made rigid;
        None where the output is read off that very member, which then has to stay.
    reduced : dict
        ``rigid`` (members left out), ``coordinates``, ``degrees_of_freedom``, ``change`` by output and ``cost``,
        evaluations relative to the full crane's.
    ended : list of str
        Runs that ended before their time, with the outcome.
    degrees_of_freedom : int
        Of the full crane with its load.
    """

    data: xr.Dataset
    influence: list[dict[str, Any]]
    members: list[dict[str, Any]]
    reduced: dict[str, Any]
    ended: list[str]
    degrees_of_freedom: int


def report(found: Study, case: Case) -> dict[str, Any]:
    """Study ready for JSON, with the case's assumed values."""
    return {
        "case": case.name,
        "crane": found.data.attrs["crane"],
        "changes": list(case.changes),
        "outputs": list(map(str, found.data.data_vars)),
        "percent": found.data["percent"].values.tolist(),
        "degrees_of_freedom": found.degrees_of_freedom,
        "influence": found.influence,
        "members": found.members,
        "reduced": found.reduced,
        "ended": found.ended,
        "assumed": as_entries(rests_on(case)),
    }


def parameters_of(parameters: Any, patterns: Sequence[str] = ("*",)) -> list[str]:
    """Names of a parameter set's positive numbers that match any of the patterns, in its order."""
    fields = [f.name for f in dataclasses.fields(parameters)]
    numbers = [name for name in fields if isinstance(getattr(parameters, name), float) and getattr(parameters, name)]
    return [name for name in numbers if name != "gravity" and any(fnmatchcase(name, p) for p in patterns)]


def study(
    parameters: Any,
    build: Callable[[Any], LumpedModel],
    motions: dict[str, Motion],
    duration: float,
    *,
    vary: Sequence[str] | None = None,
    outputs: Sequence[str] = STUDIED_OUTPUTS,
    percent: Sequence[float] = PERCENT,
    tolerance: float = TOLERANCE,
    output_step: float = 0.1,
    rtol: float = 1e-7,
    atol: float = 1e-9,
    progress: Callable[[float], None] | None = None,
) -> Study:
    """Vary parameters, make members rigid, and run the reduced crane that follows.

    Parameters
    ----------
    parameters : dataclass
        Nominal parameter set.
    build : callable
        Model of a parameter set.
    motions, duration, output_step, rtol, atol
        As in :func:`towercrane.simulation.simulate.simulate`.
    vary : sequence of str, optional
        Names of parameters; by default all positive numbers of the set.
    outputs : sequence of str
        Names of outputs over time.
    percent : sequence of float
        Values in percent of nominal.
    tolerance : float
        Largest change of any output, relative to its peak, at which a member is made rigid.
    progress : callable, optional
        Told the fraction that is done.

    Raises
    ------
    ValueError
        If a parameter or an output does not exist.
    KeyboardInterrupt
        If somebody interrupts one of the runs: half a study ranks nothing.
    """
    vary = list(vary) if vary is not None else parameters_of(parameters)
    if unknown := set(vary) - set(parameters_of(parameters)):
        raise ValueError(f"vary: wanted parameters that are not zero, got {', '.join(sorted(unknown))}")

    def run(model: LumpedModel) -> xr.Dataset:
        result = simulate(model, motions, duration, output_step=output_step, rtol=rtol, atol=atol)
        if result.attrs["outcome"] == INTERRUPTED:
            raise KeyboardInterrupt
        return result

    full = build(parameters)
    nominal = run(full)
    if unknown := set(outputs) - set(nominal.data_vars):
        raise ValueError(f"outputs: wanted some of {', '.join(map(str, nominal.data_vars))}, got {min(unknown)}")
    rows, ended = nominal.sizes["time"], []
    values = np.full((len(outputs), len(vary), len(percent), rows), np.nan)
    jobs = [(i, j) for i in range(len(vary)) for j in range(len(percent))]
    for done, (i, j) in enumerate(jobs):
        result = nominal if percent[j] == 100.0 else run(build(_scaled(parameters, vary[i], percent[j] / 100.0)))
        if result.attrs["outcome"] != "finished":
            ended.append(
                f"{vary[i]} at {percent[j]:g} %: {result.attrs['outcome']} at {result.attrs['end_time']:.2f} s"
            )
        for k, name in enumerate(outputs):
            seen = result[name].values[:rows]
            values[k, i, j, : len(seen)] = seen
        if progress is not None:
            progress((done + 1) / (len(jobs) + 1))
    data = _dataset(values, vary, percent, nominal, outputs)
    members = _members(full, nominal, outputs, run)
    leave = [m["member"] for m in members if _worst(m["change"]) < tolerance]
    reduced_model = dataclasses.replace(full, crane=make_rigid(full.crane, leave))
    reduced = run(reduced_model)
    if progress is not None:
        progress(1.0)
    return Study(
        data=data,
        influence=_influence(values, vary, percent, nominal, outputs),
        members=members,
        reduced={
            "rigid": leave,
            "coordinates": list(reduced_model.crane.coordinates),
            "degrees_of_freedom": reduced_model.freedoms,
            "change": _change(reduced, nominal, outputs),
            "cost": reduced.attrs["evaluations"] / nominal.attrs["evaluations"],
        },
        ended=ended,
        degrees_of_freedom=full.freedoms,
    )


def _scaled(parameters: Any, name: str, fraction: float) -> Any:
    """Parameter set with one value scaled; where zero makes no crane, near zero stands for it."""
    if "stiffness" in name:
        fraction = max(fraction, NEAR_ZERO)
    value = getattr(parameters, name)
    try:
        return dataclasses.replace(parameters, **{name: value * fraction})
    except ValueError:
        return dataclasses.replace(parameters, **{name: value * NEAR_ZERO})


def _change(result: xr.Dataset, nominal: xr.Dataset, outputs: Sequence[str]) -> dict[str, float | None]:
    """Largest difference over the nominal peak, by output; None for an output that the result has lost."""
    rows = min(result.sizes["time"], nominal.sizes["time"])
    found: dict[str, float | None] = dict.fromkeys(outputs)
    for name in outputs:
        if name in result:
            gap = np.max(abs(result[name].values[:rows] - nominal[name].values[:rows]))
            found[name] = float(gap / np.max(abs(nominal[name].values)))
    return found


def _worst(change: dict[str, float | None]) -> float:
    """Largest change; a lost output cannot be left out, whatever the tolerance."""
    return max(np.inf if value is None else value for value in change.values())


def _members(
    full: LumpedModel, nominal: xr.Dataset, outputs: Sequence[str], run: Callable[[LumpedModel], xr.Dataset]
) -> list[dict[str, Any]]:
    """What each member's rigidity changes, least first."""
    crane: LumpedCrane = full.crane
    names = [spring.name for spring in crane.springs] + (["rope"] if crane.rope else [])
    found: list[dict[str, Any]] = []
    for name in names:
        rigid = dataclasses.replace(full, crane=make_rigid(crane, [name]))
        found.append({"member": name, "change": _change(run(rigid), nominal, outputs)})
    return sorted(found, key=lambda entry: _worst(entry["change"]))


def _influence(
    values: Floats, vary: Sequence[str], percent: Sequence[float], nominal: xr.Dataset, outputs: Sequence[str]
) -> list[dict[str, Any]]:
    close = np.array([50.0 <= p <= 150.0 for p in percent])
    found = []
    for i, name in enumerate(vary):
        entry: dict[str, Any] = {"parameter": name, "near": {}, "far": {}}
        for k, output in enumerate(outputs):
            base = nominal[output].values
            gaps = np.nanmax(abs(values[k, i] - base), axis=1) / np.max(abs(base))
            entry["near"][output] = float(np.max(gaps[close])) if close.any() else 0.0
            entry["far"][output] = float(np.max(gaps))
        found.append(entry)
    return sorted(found, key=lambda entry: -max(entry["near"].values()))


def _dataset(
    values: Floats, vary: Sequence[str], percent: Sequence[float], nominal: xr.Dataset, outputs: Sequence[str]
) -> xr.Dataset:
    import xarray as xr

    dims = ("parameter", "percent", "time")
    variables = {name: (dims, values[k], nominal[name].attrs) for k, name in enumerate(outputs)}
    coordinates = {
        "parameter": list(vary),
        "percent": ("percent", np.array(percent, dtype=float), {"units": "percent", "long_name": "of nominal"}),
        "time": ("time", nominal["time"].values, {"units": "s", "long_name": "time"}),
    }
    kept = ("crane", "payload_mass", "gravity", "method", "rtol", "atol", "versions")
    return xr.Dataset(variables, coordinates, {key: nominal.attrs[key] for key in kept})
