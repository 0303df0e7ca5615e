"""What of a case's wind belongs together, checked on the tables as written."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from towercrane.schema.faults import Fault, shown
from towercrane.schema.ranges import at, si_at
from towercrane.schema.units import wanted

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

MISSING = "nothing: the key is missing"

MOST_STEPS = 100_000
"""Values of a turbulent wind in one record: beyond them it takes minutes to make and to run."""

OF_PROFILES = {
    "reference_height": ("power", "log"), "exponent": ("power",), "minimum_height": ("power", "log"),
}  # fmt: skip
"""Keys of a wind that only some of its profiles have."""


def check_wind(tree: dict[str, Any], pressed: Mapping[str, str]) -> Iterator[Fault]:
    """A wind that is described twice or not at all, or meets nothing.

    Parameters
    ----------
    tree : dict
        A case as written.
    pressed : mapping of str to str
        What the wind may press on, by its key, and its unit.
    """
    wind = at(tree, "wind")
    if not isinstance(wind, dict):
        return
    steady = [name for name in ("speed", "direction", "upward", "turbulence") if name in wind]
    if wind.get("series") and steady:
        what = "a wind with a speed or a series of gusts, not both"
        yield Fault("", "wind.series", what, f"{shown(wind['series'])} beside {', '.join(steady)}", "leave one out")
    elif not wind.get("series") and "speed" not in wind:
        what = f"{wanted('m/s')}, or series, the name of a CSV file"
        yield Fault("", "wind.speed", what, MISSING)
    if all(si_at(tree, key, unit, 0.0) == 0.0 for key, unit in pressed.items()):
        areas = " or ".join(dict.fromkeys(_table(key) for key in pressed))
        yield Fault("", "wind", f"something that the wind presses on: {areas} above 0", "no area at all")
    yield from _check_profile(tree, wind)
    if isinstance(wind.get("turbulence"), dict):
        yield from _check_turbulence(tree, wind["turbulence"])


def _table(key: str) -> str:
    return key.rpartition(".")[0] if key.startswith("crane.") else key


def _check_profile(tree: dict[str, Any], wind: dict[str, Any]) -> Iterator[Fault]:
    """Keys that the profile does not have, and heights at which a logarithm is none."""
    law = wind.get("profile", "uniform")
    for key, laws in OF_PROFILES.items():
        if key in wind and law not in laws:
            hint = f"a key of profile = {' or '.join(map(shown, laws))}"
            yield Fault("", f"wind.{key}", f"nothing where profile = {shown(law)}", shown(wind[key]), hint)
    eurocode = at(tree, "wind.turbulence.spectrum") == "en-1991-1-4"
    if law != "log" and not eurocode and "roughness_length" in wind:
        hint = 'a key of profile = "log" and of the spectrum "en-1991-1-4"'
        yield Fault("", "wind.roughness_length", "nothing for this wind", shown(wind["roughness_length"]), hint)
    rough, lowest = si_at(tree, "wind.roughness_length", "m", 0.05), si_at(tree, "wind.minimum_height", "m", 2.0)
    reference = si_at(tree, "wind.reference_height", "m", 10.0)
    if (law == "log" or eurocode) and rough and lowest and reference and not 0.0 < rough < min(lowest, reference):
        what = f"less than the lowest height that counts, {min(lowest, reference):g} m"
        yield Fault("", "wind.roughness_length", what, f"{rough:g} m", "cm or mm mixed up?")


def _check_turbulence(tree: dict[str, Any], table: dict[str, Any]) -> Iterator[Fault]:
    """Turbulence without a mean or an intensity, with two, or whose record does not fit the run."""
    key, spectrum = "wind.turbulence", table.get("spectrum")
    if si_at(tree, "wind.speed", "m/s") == 0.0:
        yield Fault("", "wind.speed", "a mean above 0 m/s, which turbulence blows about", "0 m/s")
    given = [name for name in ("intensity", "reference_class") if name in table]
    if len(given) == 2:
        got = f"both, {shown(table['intensity'])} and {shown(table['reference_class'])}"
        yield Fault("", f"{key}.reference_class", "intensity or reference_class", got, "leave one out")
    elif not given and spectrum in ("kaimal", "von-karman"):
        what = 'an intensity, such as 0.15, or a reference_class of IEC 61400-1, such as "B"'
        yield Fault("", f"{key}.intensity", what, MISSING)
    if table.get("across") is False and "across_ratio" in table:
        hint = "across = false leaves that component out"
        yield Fault("", f"{key}.across_ratio", "nothing without it", shown(table["across_ratio"]), hint)
    run, step = si_at(tree, "run.duration", "s"), si_at(tree, f"{key}.step", "s", 0.1)
    duration = si_at(tree, f"{key}.duration", "s")
    if run and duration and duration < run:
        what, hint = f"at least run.duration, {run:g} s", "a record repeats itself; leave the key out"
        yield Fault("", f"{key}.duration", what, f"{duration:g} s", hint)
    longest = max(duration or 0.0, run or 0.0)
    if step and longest / step > MOST_STEPS:
        what = f"at least {longest / MOST_STEPS:g} s, {MOST_STEPS} values in {longest:g} s"
        yield Fault("", f"{key}.step", what, f"{step:g} s", "ms and s mixed up?")
    if step and run and step > 0.1 * run:
        yield Fault("", f"{key}.step", f"at most a tenth of run.duration, {0.1 * run:g} s", f"{step:g} s")
