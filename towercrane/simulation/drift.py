"""What a solver's steps do to the energy of a crane that nothing drives and nothing damps.

An explicit pair that takes steps as long as its stability allows feeds a vibration or eats it, while its error
estimate is content. The figures below were measured by ``towercrane bench --stability``: QTZ5613 with its trolley
parked at 23 m, 800 kg on 18 m of rope, ringing after its weights were switched on and swinging by 0.1 rad, for 600 s,
atol a hundredth of rtol; the worse of 1 + 1 and 2 + 3 modes. They are relative to the vibration's energy.
"""

from __future__ import annotations

SPAN = 600.0
"""Span of the free vibration that the figures are for [s]."""

ENERGY_DRIFT: dict[str, tuple[tuple[float, float], ...]] = {
    "dop853": ((1e-2, -0.39), (1e-3, -0.18), (1e-4, -0.016), (1e-5, -1.1e-3), (1e-6, -8.9e-5)),
    "dopri5": ((1e-3, 5.6), (1e-4, -0.037), (1e-5, -5.2e-3), (1e-6, -5.7e-4)),
    "scipy-dop853": ((1e-2, -0.40), (1e-3, -0.19), (1e-4, -0.017), (1e-5, -1.2e-3), (1e-6, -9.5e-5)),
    "scipy-rk45": ((1e-3, 7.0), (1e-4, -0.038), (1e-5, -5.5e-3), (1e-6, -6.0e-4)),
    "scipy-lsoda": ((1e-3, 0.33), (1e-4, -0.055), (1e-5, -0.013), (1e-6, -1.1e-3)),
    "scipy-radau": ((1e-2, -0.32), (1e-3, -0.034), (1e-4, -1.7e-3), (1e-5, -9.0e-5)),
}
"""Tolerance and relative change of the energy over the span, loosest first; positive: the vibration is fed."""

LOOSEST = {"dopri5": 1e-3, "scipy-rk45": 1e-3, "scipy-lsoda": 1e-3}
"""Tolerance beyond which a method is refused: at ten times that it feeds vibration sixtyfold or fails."""

NAMED = 0.01
"""Relative change of the energy over the span from which a run says so."""

ATOL_SHARE = 1e-2
"""atol over rtol in the measurements."""


class EnergyDriftWarning(UserWarning):
    """The solver's tolerance lets the energy of a free vibration drift."""


def effective_tolerance(rtol: float, atol: float) -> float:
    """The rtol whose drift is to be expected from both tolerances.

    With rtol at 1e-8 an atol of 1e-5 to 1e-3 was found to change the energy about as much as that rtol does.
    """
    return max(rtol, atol)


def energy_drift(method: str, rtol: float, atol: float) -> float:
    """Relative change of a free vibration's energy in 600 s: the figure of the next looser tolerance measured.

    Parameters
    ----------
    method : str
        One of :data:`towercrane.simulation.integrate.METHODS`.
    rtol, atol : float
        As in :func:`towercrane.simulation.integrate.integrate`.
    """
    rows = ENERGY_DRIFT[method]
    reached = [row for row in rows if row[0] >= effective_tolerance(rtol, atol) * (1.0 - 1e-9)]
    return (reached[-1] if reached else rows[0])[1]


def refusal(method: str, rtol: float, atol: float) -> str:
    """Why a method is not offered at these tolerances; empty if it is."""
    limit = LOOSEST.get(method)
    if limit is None or effective_tolerance(rtol, atol) <= limit * (1.0 + 1e-9):
        return ""
    remedy = _remedy(method, rtol, atol)
    return f"{method} feeds free vibration without bound beyond rtol or atol {limit:g}; {remedy}"


def notice(method: str, rtol: float, atol: float) -> str:
    """What these tolerances do to a free vibration, in a sentence; empty if it is less than one per cent."""
    change = energy_drift(method, rtol, atol)
    if abs(change) < NAMED:
        return ""
    verb = "gains" if change > 0.0 else "loses"
    tolerance = f"rtol {rtol:g}" if rtol >= atol else f"atol {atol:g}"
    crane = "2+3 modes, more with more" if change > 1.0 else "few modes"
    return (
        f"{method} at {tolerance} {verb} energy: {100.0 * change:+.3g} % in {SPAN:g} s of free vibration "
        f"with {crane}; {_remedy(method, rtol, atol)}"
    )


def _remedy(method: str, rtol: float, atol: float) -> str:
    good = next(tolerance for tolerance, change in ENERGY_DRIFT[method] if abs(change) < NAMED)
    names = " and ".join(name for name, value in (("rtol", rtol), ("atol", atol)) if value > good)
    return f"use {names} {good:g}" + ("" if method == "dop853" else " or dop853")
