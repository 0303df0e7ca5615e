"""Case files for the tests of the door, and the faults it finds in them."""

import tomllib
from pathlib import Path

import pytest

from towercrane.cases.case import CaseError, Fault, case_folder, load_case

MULTI, BASIC, ENHANCED = (f"slewing/{kind}/example-1" for kind in ("multi-mass", "basic", "enhanced"))
PLAN, HEAVY, COMBINED = (f"jib-crane/{name}" for name in ("plan", "heavy", "combined"))
RADIAL = "qtz5613/condition-3"

CRANE = """\
name = "Small"
[tower]
height = "30 m"
mass_per_length = "300 kg/m"
youngs_modulus = "210 GPa"
second_moment_of_area = "0.01 m^4"
[jib]
length = "40 m"
mass_per_length = "100 kg/m"
youngs_modulus = "210 GPa"
second_moment_of_area = "0.003 m^4"
[counter_jib]
length = "10 m"
mass_per_length = "150 kg/m"
counterweight = "10 t"
[trolley]
mass = "300 kg"
"""

CASE = """\
title = "A case"
crane = "crane.toml"
[payload]
mass = "800 kg"
[rope]
length = "12 m"
[motion.trolley]
shape = "trapezoid"
start = "5 m"
end = "30 m"
speed = "0.8 m/s"
acceleration = "0.1 m/s^2"
[run]
duration = "60 s"
"""

SEQUENCE = 'shape = "sequence"\nstart = 5\n'


def with_motion(text, hoist=""):
    start = CASE.index("[motion.trolley]")
    return CASE[:start] + "[motion.trolley]\n" + text + hoist + "\n" + CASE[CASE.index("[run]") :]


def write_case(folder: Path, *changes: tuple[str, str], crane=(), case_text: str = CASE) -> Path:
    """Write a case and its crane, with replacements; return the case's path."""
    texts = {"crane.toml": (CRANE, crane), "case.toml": (case_text, changes)}
    for name, (text, replacements) in texts.items():
        for old, new in replacements:
            assert old in text
            text = text.replace(old, new, 1)
        (folder / name).write_text(text, "utf-8")
    return folder / "case.toml"


def copy_case(folder: Path, name: str, *changes: tuple[str, str]) -> Path:
    """Copy a shipped case with its cranes and tables, with replacements in any of them; return the case's path."""
    source = case_folder() / f"{name}.toml"
    crane = source.with_name(tomllib.loads(source.read_text("utf-8"))["crane"])
    files = {source, crane, *source.parent.glob("crane.toml"), *source.parent.glob("*.csv")}
    texts = {path.name: path.read_text("utf-8") for path in files}
    for old, new in changes:
        assert any(old in text for text in texts.values()), old
        texts = {file: text.replace(old, new, 1) for file, text in texts.items()}
    for file, text in texts.items():
        (folder / file).write_text(text, "utf-8")
    return folder / source.name


def faults_of(case: str | Path, *overrides: str) -> list[Fault]:
    """All that the door finds wrong with a case."""
    with pytest.raises(CaseError) as caught:
        load_case(case, overrides)
    return caught.value.faults


def only_fault(case: str | Path, *overrides: str) -> Fault:
    """The one thing that is wrong with a case."""
    (fault,) = faults_of(case, *overrides)
    return fault
