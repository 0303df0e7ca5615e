"""Jib cranes and plans of the tests: the source's data, the same with booms of plausible weight, and its plan."""

import numpy as np

from towercrane.cranes.jib.model import PlannedJibCrane
from towercrane.cranes.jib.parameters import JibCrane
from towercrane.kernels.load import Load
from towercrane.motions.motion import rest, sequence
from towercrane.motions.profiles import smooth_ramps, trapezoid

PRINTED = JibCrane(
    name="Al-Ajmi et al., Table 1",
    post_height=0.0,
    post_inertia=1e4,
    primary_length=15.0,
    primary_mass_per_length=1.5,
    secondary_length=10.0,
    secondary_mass_per_length=1.5,
)
"""Table 1; the post's height is not given."""

HEAVY = JibCrane(
    name="heavy booms",
    post_height=12.0,
    post_inertia=2e5,
    primary_length=15.0,
    primary_mass_per_length=200.0,
    secondary_length=10.0,
    secondary_mass_per_length=120.0,
)
"""Assumed: booms whose inertia shows, where 1.5 kg/m hides errors below one per cent."""

LOAD = Load(5000.0)

TIGHT = {"rtol": 1e-11, "atol": 1e-13}
G = 9.81


def planned(crane: JibCrane = HEAVY, load: Load = LOAD, **options) -> PlannedJibCrane:
    return PlannedJibCrane(crane, load, **options)


def after(delay, motion):
    return sequence(rest(float(motion(0.0)), delay), motion)


def printed_plan(luff: float = 0.3, fold: float = 0.0, faster: float = 1.0) -> dict:
    """The source's plan: 0.001 rad/s^2 for 20 s, steady for 40 s, down for 20 s; all in 1/faster of the time."""
    return {
        "slew": rest(0.0),
        "luff": trapezoid(luff, luff + 1.2, 0.02 * faster, 0.001 * faster**2),
        "fold": rest(fold),
        "rope": rest(20.0),
    }


def smooth_plan(turn: float = 0.0) -> dict:
    """All joints and the rope at once on smooth ramps."""
    return {
        "slew": smooth_ramps(turn, 0.05, 8.0, 32.0),
        "luff": after(10.0, smooth_ramps(0.4, 0.01, 6.0, 34.0)),
        "fold": after(5.0, smooth_ramps(-0.2, -0.005, 5.0, 35.0)),
        "rope": after(15.0, smooth_ramps(20.0, -0.2, 4.0, 36.0)),
    }


def trapezoid_plan() -> dict:
    """Slew, luff and hoist on trapezoids with the fold held."""
    return {
        "slew": trapezoid(0.0, 2.0, 0.05, 0.01),
        "luff": after(10.0, trapezoid(0.4, 0.8, 0.01, 0.002)),
        "fold": rest(-0.2),
        "rope": after(15.0, trapezoid(20.0, 12.0, 0.2, 0.04)),
    }


def standing(slew: float = 0.0, luff: float = 0.6, fold: float = -0.2, rope: float = 20.0) -> dict:
    return {"slew": rest(slew), "luff": rest(luff), "fold": rest(fold), "rope": rest(rope)}


def constant(*values):
    """Channels that rest at these values, in the order of the model's."""
    return tuple(rest(v) for v in values)


def peak(values) -> float:
    return float(np.max(abs(values)))
