"""Benchmark of the exact structures: a tower of three segments and the frequency map, beside finite elements."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from modal import Chain, EndBody, Segment, chain_frequencies, chain_structure, crane_structure
from towercrane.bench.clock import interleaved, short
from towercrane.bench.structures.roots import family
from towercrane.cases.case import load_case
from towercrane.cranes.tower.file.build import crane_frame
from towercrane.cranes.tower.file.case_tables import TowerCase

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from modal import CraneFrame
    from towercrane.bench.clock import Timing

    Floats = NDArray[np.float64]

CASE = "qtz5613/condition-3"

POSITIONS, FEW_POSITIONS = 50, 10
"""Of the trolley, with all repeats and with few."""

MODES = 8

EXACT = "dynamic stiffness"

NO_MPMATH = "errors not measured: they need mpmath (pip install mpmath)"

TOWER = Chain(
    (
        Segment(24.0, 780.0, 6.6e9, 4.6e8, 780.0),
        Segment(18.0, 600.0, 4.9e9, 3.9e8, 600.0),
        Segment(18.0, 460.0, 3.3e9, 3.1e8, 460.0),
    ),
    {3: EndBody(11000.0, 6e4)},
)
"""A tower of 60 m in three sections with shear strain and rotary inertia, and a slewing part on its top."""


def stepped_tower(repeats: int) -> dict[str, Any]:
    """Eight frequencies of a tower of three shear-flexible segments."""
    from modal.elements.structure_elements import finite_element_structure_frequencies

    def elements(number: int) -> Callable[[], Floats]:
        return lambda: finite_element_structure_frequencies(chain_structure(TOWER), MODES, elements=number)

    contestants: dict[str, Callable[[], Floats]] = {EXACT: lambda: chain_frequencies(TOWER, MODES)}
    contestants |= {f"{n} elements a segment": elements(n) for n in (2, 4, 8, 16)}
    values, timings = interleaved(contestants, repeats)
    reference, note = transfer_matrices(TOWER, values[EXACT])
    return _compared(
        "tower",
        "Eight frequencies of a tower of three shear-flexible segments with a body: relative error of the worst",
        values, timings, reference, [note],
    )  # fmt: skip


def crane_map(repeats: int) -> dict[str, Any]:
    """Eight frequencies of the plane QTZ5613 along its jib."""
    from modal.elements.structure_elements import finite_element_structure_frequencies
    from towercrane.studies.frequency_map import SPARE, frequency_map

    case = load_case(CASE)
    frame = crane_frame(case.tables(TowerCase))
    number = POSITIONS if repeats > 3 else FEW_POSITIONS
    places = np.linspace(0.0, case.crane.jib.length, number)

    def exact() -> Floats:
        return np.array([crane_structure(frame, float(x)).angular_frequencies(MODES) for x in places])

    def branches() -> Floats:
        found = frequency_map(frame, places, [frame.payload_mass], modes=MODES - SPARE)
        return 2.0 * np.pi * np.sort(found["frequency"].values[0], axis=1)

    def elements(number: int) -> Floats:
        structures = (crane_structure(frame, float(x)) for x in places)
        return np.array([finite_element_structure_frequencies(s, MODES, elements=number) for s in structures])

    contestants: dict[str, Callable[[], Floats]] = {
        EXACT: exact,
        f"{EXACT}, with shapes, branches, participation": branches,
        "8 elements a member": partial(elements, 8),
        "16 elements a member": partial(elements, 16),
    }
    values, timings = interleaved(contestants, min(repeats, 3))
    found = zip(places.tolist(), values[EXACT], strict=True)
    rows = [_krylov_functions(frame, position, near) for position, near in found]
    reference = None if rows[0] is None else np.array(rows)
    note = "reference: Krylov functions of the three uniform spans, matched in 50-digit arithmetic"
    return _compared(
        "map",
        f"Plane QTZ5613, eight frequencies at {number} positions of the trolley: relative error of the worst",
        values, timings, reference, [NO_MPMATH if reference is None else note],
    )  # fmt: skip


def _compared(
    name: str,
    title: str,
    values: dict[str, Floats],
    timings: dict[str, Timing],
    reference: Floats | None,
    notes: list[str],
) -> dict[str, Any]:
    """Table of errors and times; methods with fewer frequencies are compared by those."""
    records: list[dict[str, Any]] = []
    for method, found in values.items():
        error = None
        if reference is not None:
            error = float(np.max(abs(found / reference[..., : found.shape[-1]] - 1.0)))
        records.append(
            {"method": method, "family": family(method), "error": error, "milliseconds": 1e3 * timings[method].wall}
        )
    return {
        "name": name,
        "title": title,
        "columns": ["method", "error", "median [ms]"],
        "rows": [[r["method"], short(r["error"]), f"{r['milliseconds']:.2f}"] for r in records],
        "records": records,
        "notes": notes,
    }


def transfer_matrices(chain: Chain, near: Floats) -> tuple[Floats | None, str]:
    """Frequencies of a clamped chain without weight, whose only body is on its top, in 50-digit arithmetic.

    Parameters
    ----------
    chain : Chain
        Of uniform segments.
    near : ndarray
        Angular frequencies to start from [rad/s].

    Returns
    -------
    tuple
        Angular frequencies by matrix exponentials, None without mpmath, and what a table says of them.
    """
    try:
        import mpmath as mp
    except ImportError:
        return None, NO_MPMATH
    body = chain.bodies.get(len(chain.segments), EndBody())

    def closing(omega: Any) -> Any:
        state = mp.matrix([[0, 0], [0, 0], [1, 0], [0, 1]])
        for s in chain.segments:
            mass = s.mass_per_length / (1 - s.mass_flexibility * s.mass_per_length * omega**2)
            # Deflection, rotation, transverse force and moment along a Timoshenko beam.
            slopes = mp.matrix(
                [
                    [0, 1, 1 / mp.mpf(s.shear_stiffness), 0],
                    [0, 0, 0, 1 / mp.mpf(s.bending_stiffness)],
                    [-mass * omega**2, 0, 0, 0],
                    [0, -s.rotary_inertia * omega**2, -1, 0],
                ]
            )
            state = mp.expm(slopes * s.length) * state
        first = body.mass * mp.mpf(body.offset)
        second = body.rotary_inertia + first * body.offset
        inertia = -(omega**2) * mp.matrix([[body.mass, first], [first, second]])
        return mp.det(inertia * state[:2, :] + state[2:, :])

    def root(x: float) -> float:
        # From both sides: the secant of a point that is the root but for rounding leads anywhere.
        return float(mp.findroot(closing, tuple(mp.mpf(x) * (1 + mp.mpf(d)) for d in ("-1e-7", "1e-7"))))

    with mp.workdps(50):
        exact = [root(x) for x in near]
    return np.array(exact), "reference: transfer matrices in 50-digit arithmetic"


def _krylov_functions(frame: CraneFrame, position: float, near: Floats) -> Floats | None:
    """Frequencies of a crane of two uniform Euler beams in 50-digit arithmetic; None without mpmath."""
    try:
        import mpmath as mp
    except ImportError:
        return None
    assert frame.jib is not None, "the benchmark's crane has one"
    (tower,), (jib,), head = frame.tower.segments, frame.jib.segments, frame.tower.bodies[1]
    carried = mp.mpf(frame.trolley_mass) + mp.mpf(frame.payload_mass)
    along = head.mass + mp.mpf(jib.mass_per_length) * jib.length + frame.trolley_mass
    swing2 = mp.mpf(frame.gravity) / frame.rope_length

    def span(segment: Segment, length: Any, omega: Any) -> Any:
        # (v, theta, V, M) at the far end from that at the near end, by Krylov's functions and their derivatives.
        stiffness = mp.mpf(segment.bending_stiffness)
        k = mp.sqrt(omega * mp.sqrt(segment.mass_per_length / stiffness))
        x = k * length
        even, odd = (mp.cosh(x) + mp.cos(x)) / 2, (mp.sinh(x) + mp.sin(x)) / 2
        even2, odd2 = (mp.cosh(x) - mp.cos(x)) / 2, (mp.sinh(x) - mp.sin(x)) / 2
        units = (1, 1 / k, -1 / (stiffness * k**3), 1 / (stiffness * k**2))
        waves = (
            (even, odd, odd2, even2),
            (odd2, even, even2, odd),
            (odd, even2, even, odd2),
            (even2, odd2, odd, even),
        )
        return mp.matrix([[waves[i][j] * units[j] / units[i] for j in range(4)] for i in range(4)])

    def closing(omega: Any) -> Any:
        top = span(tower, mp.mpf(tower.length), omega)[:, 2:]
        trolley = mp.eye(4)
        trolley[2, 0] = -carried * omega**2
        inner, outer = (span(jib, x, omega) for x in (mp.mpf(position), mp.mpf(jib.length) - position))
        end = outer * trolley * inner
        rows = mp.zeros(4, 4)
        for j in range(2):
            # Head, jib and trolley move outward, the load as far as its pendulum follows.
            rows[0, j] = (top[2, j] - omega**2 * along * top[0, j]) * (swing2 - omega**2)
            rows[0, j] -= omega**2 * frame.payload_mass * swing2 * top[0, j]
            rows[1, j] = top[3, j] - omega**2 * head.rotary_inertia * top[1, j]
            rows[2, j], rows[3, j] = -end[2, 1] * top[1, j], -end[3, 1] * top[1, j]
            rows[2, 2 + j], rows[3, 2 + j] = end[2, 2 + j], end[3, 2 + j]
        rows[1, 3] = 1
        return mp.det(rows)

    with mp.workdps(50):
        exact = [
            float(mp.findroot(closing, tuple(mp.mpf(x) * (1 + mp.mpf(d)) for d in ("-1e-9", "1e-9")))) for x in near
        ]
    return np.array(exact)
