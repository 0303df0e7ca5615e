"""Frequency map of a crane: branches of natural modes over trolley position and payload, and the buckling load."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from towercrane.simulation.outcomes import FINISHED, TOWER_BUCKLED
from towercrane.studies.branches import Branches, follow
from towercrane.studies.plane_modes import LOADS, MEMBERS, STATIC_OUTPUTS, PlaneCrane, PlaneModes

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import xarray as xr
    from numpy.typing import NDArray

    from modal import CraneFrame
    from towercrane.studies.ritz.plane_crane import RitzCrane, RitzModes

    Floats = NDArray[np.float64]
    Crane = PlaneCrane | RitzCrane
    Modes = PlaneModes | RitzModes

POSITIONS = 50
"""Places of the trolley where none are asked for."""

MODES = 6
"""Branches where no number is asked for."""

SPARE = 2
"""Modes above those asked for, so that a branch may cross them."""

DOUBTFUL = 0.5
"""Modal assurance criterion between steps below which a branch is not known to be the same."""

MODE_NAMES = {
    "tower": "tower bending",
    "jib": "jib bending",
    "counter-jib": "counter-jib bending",
    "foundation": "rocking on the foundation",
    "collars": "motion on the collars",
    "ties": "motion on the ties",
    "luffing rope": "motion on the luffing rope",
    "load": "load swing",
}
"""What a mode is called whose energy is most in a member."""

ORDINALS = ("first", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth", "ninth", "tenth")

UNITS = {"tower_tip": "m/N", "jib_tip": "m/N", "base_moment": "N m/N"}
"""Of an output under a unit force."""

LONG_NAMES = {
    "tower_tip": "displacement of the tower's top, outward",
    "jib_tip": "displacement of the jib's end, down",
    "base_moment": "bending moment at the tower's foot",
}


@dataclass(frozen=True, eq=False)
class _Scan:
    """All places of the trolley with one payload."""

    branches: Branches[Modes]

    def table(self, values: Callable[[Any], Floats], count: int) -> Floats:
        """Something of every mode, shape (positions, count, ...), in the order of the branches."""
        pairs = zip(self.branches.spectra, self.branches.ranks, strict=True)
        return np.array([values(modes)[ranks[:count]] for modes, ranks in pairs])

    def static(self) -> Floats:
        """Outputs under unit forces of exact cranes, shape (positions, loads, outputs)."""
        return np.array([modes.static for modes in self.branches.spectra if isinstance(modes, PlaneModes)])


def frequency_map(
    frame: CraneFrame,
    positions: Sequence[float] | Floats,
    payloads: Sequence[float],
    *,
    modes: int = MODES,
    progress: Callable[[float], None] | None = None,
) -> xr.Dataset:
    """Natural frequencies of the whole plane crane over trolley position and payload, as branches of like shapes.

    A branch keeps its number along the trolley's way, see `towercrane.studies.branches.follow`, and from one payload
    to the next, where it is followed at the first position. It is named after the member that holds most of its
    potential energy on average.

    Parameters
    ----------
    frame : CraneFrame
        With a flexible jib; its payload is replaced. With gravity on the tower, weight softens it.
    positions : sequence of float
        Distances of the trolley from the tower's axis [m], ascending.
    payloads : sequence of float
        Masses of the load [kg], ascending.
    modes : int
        Number of branches.
    progress : callable, optional
        Told the fraction that is done.

    Returns
    -------
    xarray.Dataset
        Over ``payload`` [kg], ``position`` [m] and ``mode`` (counted from 1): ``frequency`` [Hz], ``energy_share``
        per ``member``, ``shape_agreement`` with the position before, and what each mode adds to static
        outputs under a unit force on the trolley, ``modal_tower_tip``, ``modal_jib_tip`` [m/N] and
        ``modal_base_moment`` [N m/N] per ``load`` direction, with ``static_...`` the response of all modes. Per
        payload ``buckling_factor`` [1] and ``outcome``; ``branch`` names the modes. A payload under which the tower
        buckles has the outcome "tower buckled" and no numbers but its buckling factor.

    Raises
    ------
    ValueError
        If a position is off the jib, positions or payloads are none or not ascending, or a number is out of range.
    """
    places, masses = ascending("positions", positions), ascending("payloads", payloads)
    if frame.jib is not None and not 0.0 <= places[0] <= places[-1] <= frame.jib.length * (1.0 + 1e-12):
        raise ValueError(f"positions: wanted 0 to {frame.jib.length:g} m, got {places[0]:g} to {places[-1]:g}")
    if not (masses[0] > 0.0 and masses[-1] < np.inf):
        raise ValueError(f"payloads: wanted masses above 0 kg, got {masses[0]:g} to {masses[-1]:g}")
    factors = [buckling_factor(replace(frame, payload_mass=float(mass)), float(places[0])) for mass in masses]
    outcomes = [FINISHED if factor > 1.0 else TOWER_BUCKLED for factor in factors]

    def loaded(mass: float) -> PlaneCrane:
        return PlaneCrane(replace(frame, payload_mass=mass))

    result = mapped(loaded, factors, outcomes, places, masses, modes, progress=progress)
    result.attrs |= {"rope_length": frame.rope_length, "trolley_mass": frame.trolley_mass, "gravity": frame.gravity}
    result.attrs["weight_softening"] = int(frame.tower.gravity > 0.0)
    return result


def mapped(
    loaded: Callable[[float], Any],
    factors: list[float],
    outcomes: list[str],
    places: Floats,
    masses: Floats,
    modes: int,
    members: tuple[str, ...] = MEMBERS,
    progress: Callable[[float], None] | None = None,
) -> xr.Dataset:
    """A map of a crane that is made for each load; buckling factors and outcomes are given, by load."""
    if modes < 1:
        raise ValueError(f"modes: wanted one or more, got {modes!r}")
    began = time.perf_counter()
    stable = [i for i, outcome in enumerate(outcomes) if outcome == FINISHED]
    first, far = float(places[0]), float(np.ptp(places)) or 1.0
    scans: dict[int, _Scan] = {}
    for i, start in zip(stable, _starts(loaded, masses[stable], first, modes), strict=True):
        crane = loaded(float(masses[i]))

        def solve(position: float, crane: Crane = crane, done: int = len(scans)) -> Modes:
            if progress is not None:
                progress((done + (position - first) / far) / len(stable))
            return crane.modes(position, modes + SPARE)

        scans[i] = _Scan(follow(solve, places.tolist(), modes, start))
    result = _dataset(places, masses, modes, scans, members)
    result["buckling_factor"] = (
        "payload",
        np.array(factors),
        {"units": "1", "long_name": "factor on all weights at which the tower buckles"},
    )
    result["outcome"] = ("payload", outcomes)
    result.attrs |= {
        "outcome": next((outcome for outcome in outcomes if outcome != FINISHED), FINISHED),
        "spectra_computed": sum(scan.branches.solved for scan in scans.values()),
        "wall_seconds": time.perf_counter() - began,
    }
    return result


def buckling_factor(frame: CraneFrame, position: float = 0.0) -> float:
    """Factor on all weights, payload included, at which the tower buckles in the plane of its jib [1].

    The weight of the jibs, the trolley and the load acts on the tower's axis, wherever the trolley stands.
    """
    from modal import crane_structure

    tower = replace(frame.tower, gravity=frame.tower.gravity or frame.gravity)
    return crane_structure(replace(frame, tower=tower), position).buckling_factor()


def doubtful_steps(result: xr.Dataset) -> list[tuple[float, float, int]]:
    """Payload [kg], position [m] and mode where a branch is not known to be the one of the position before."""
    low = result["shape_agreement"].values < DOUBTFUL
    return [
        (float(result["payload"][i]), float(result["position"][j]), int(result["mode"][k]))
        for i, j, k in np.argwhere(low)
    ]


def ascending(name: str, values: Sequence[float] | Floats) -> Floats:
    """Values as they are.

    Raises
    ------
    ValueError
        If they are none, not finite or not ascending.
    """
    found = np.atleast_1d(np.asarray(values, dtype=float))
    if found.ndim != 1 or found.size == 0 or not np.isfinite(found).all() or not (np.diff(found) > 0.0).all():
        raise ValueError(f"{name}: wanted one or more ascending finite numbers, got {values!r}")
    return found


def _starts(loaded: Callable[[float], Crane], masses: Floats, position: float, modes: int) -> list[NDArray[np.int64]]:
    """Ranks of the branches at the first position with every payload, followed from the lightest one."""
    if masses.size == 0:
        return []

    def solve(logarithm: float) -> Modes:
        return loaded(float(np.exp(logarithm))).modes(position, modes + SPARE)

    return list(follow(solve, np.log(masses).tolist(), modes).ranks)


def _dataset(
    places: Floats, masses: Floats, modes: int, scans: dict[int, _Scan], members: tuple[str, ...]
) -> xr.Dataset:
    """All scans as one labelled data set; a payload without a scan has no numbers."""
    import xarray as xr

    def stacked(values: Callable[[_Scan], Floats], *shape: int) -> Floats:
        found = np.full((len(masses), len(places), *shape), np.nan)
        for i, scan in scans.items():
            found[i] = values(scan)
        return found

    along = ("payload", "position", "mode")
    shares = stacked(lambda s: s.table(lambda m: m.energy_shares, modes), modes, len(members))
    frequency = stacked(lambda s: s.table(lambda m: m.frequencies, modes), modes)
    variables: dict[str, Any] = {
        "frequency": (along, frequency, {"units": "Hz", "long_name": "natural frequency"}),
        "energy_share": (
            (*along, "member"), shares,
            {"units": "1", "long_name": "share in the mode's potential energy"},
        ),
        "shape_agreement": (
            along, stacked(lambda s: s.branches.agreement[:, :modes], modes),
            {"units": "1", "long_name": "modal assurance criterion with the position before"},
        ),
    }  # fmt: skip
    exact = members == MEMBERS
    if exact:
        modal = stacked(lambda s: s.table(lambda m: m.modal_static, modes), modes, len(LOADS), len(STATIC_OUTPUTS))
        static = stacked(lambda s: s.static(), len(LOADS), len(STATIC_OUTPUTS))
    for k, name in enumerate(STATIC_OUTPUTS if exact else ()):
        words = f"{LONG_NAMES[name]} under a unit force on the trolley"
        variables[f"modal_{name}"] = (
            (*along, "load"), modal[..., k], {"units": UNITS[name], "long_name": f"the mode's part in the {words}"},
        )  # fmt: skip
        variables[f"static_{name}"] = (
            ("payload", "position", "load"), static[..., k], {"units": UNITS[name], "long_name": words},
        )  # fmt: skip
    coordinates = {
        "payload": ("payload", masses, {"units": "kg", "long_name": "mass of the load"}),
        "position": (
            "position",
            places,
            {"units": "m", "long_name": "distance of the trolley from the tower's axis"},
        ),
        "mode": np.arange(1, modes + 1),
        "member": list(members),
        **({"load": list(LOADS)} if exact else {}),
        "branch": ("mode", branch_names(frequency, shares, members)),
    }
    return xr.Dataset(variables, coordinates)


def branch_names(frequency: Floats, shares: Floats, members: tuple[str, ...] = MEMBERS) -> list[str]:
    """Names of the branches by the member that holds most of their energy, counted by mean frequency.

    Parameters
    ----------
    frequency : ndarray, shape (payloads, positions, modes)
        [Hz]; NaN where there is none.
    shares : ndarray, shape (payloads, positions, modes, members)
        Shares of the members [1].
    members : tuple of str
        Their names.
    """
    count = frequency.shape[2]
    known = np.isfinite(frequency).all(axis=(1, 2))
    if not known.any():
        return [f"mode {k + 1}" for k in range(count)]
    most = np.argmax(shares[known].mean(axis=(0, 1)), axis=1)
    height = frequency[known].mean(axis=(0, 1))
    names = []
    for k in range(count):
        rank = int(((most == most[k]) & (height < height[k])).sum())
        name = MODE_NAMES[members[most[k]]]
        ordinal = ORDINALS[rank] if rank < len(ORDINALS) else f"{rank + 1}th"
        names.append(name if name == MODE_NAMES["load"] and rank == 0 else f"{ordinal} {name}")
    return names
