"""Every key of every kind of case with values that nobody means: a located fault or a case, nothing else."""

import time

import pytest
from typer.testing import CliRunner

from towercrane.cases.case import CaseError, load_case
from towercrane.cases.plausibility import ranges_in
from towercrane.cli import app
from towercrane.cranes.registry import KINDS
from towercrane.runs.run import record_case
from towercrane.schema.fields import known_keys
from towercrane.schema.ranges import FARTHEST

CASES = {
    "tower in the plane": "towers/stepped",
    "tower in space": "qtz5613/soft-drive",
    "multi-mass": "slewing/multi-mass/example-1",
    "basic": "slewing/basic/example-1",
    "enhanced": "slewing/enhanced/example-1",
    "jib": "jib-crane/plan",
    "overhead": "overhead-crane/travel",
}

ODD = (
    "1e308", "-1e308", "5e-324", "0", "-1", "nan", "-inf", "1e160", "9" * 5000, '"1e308 m"', '"1 kg"', "$5 \\foo",
    '"\\u0000"', '"\\u001b[31m"', "true", "[]", "{}", "[[1]]", "[{}]", "{value=1e308,assumed='x'}",
    "{value={value=1},assumed=1}", "1979-05-27T07:32:00Z", '"/dev/zero"', '"../../../../etc/passwd"', "[" * 5000,
    "a" * 100_000, "\udcff",
)  # fmt: skip
"""Sizes, units, types, texts and depths that no case has."""

RUNS = {
    "tower in the plane": ("payload.mass", "crane.gravity", "crane.trolley.mass", "crane.counter_jib.counterweight"),
    "basic": ("crane.gravity",),
    "jib": ("crane.gravity",),
}
"""Keys whose extremes do not make the crane's own vibration so fast that a run has no end."""


def said(case, *overrides):
    """Faults of a case, each with its place; none if it is taken."""
    try:
        load_case(case, overrides)
    except CaseError as error:
        found = error
    else:
        return []
    assert found.faults
    assert all(fault.file and fault.wanted and fault.got for fault in found.faults)
    assert all(line.isprintable() and len(line) < 1010 for line in str(found).splitlines())
    return found.faults


def places(kind):
    """Keys of a kind, those inside lists in their first item."""
    for key in known_keys(KINDS[kind].tables):
        yield key
        for parent in ("segments", "bodies", "steps"):
            if f".{parent}." in key:
                yield key.replace(f".{parent}.", f".{parent}.0.")


@pytest.mark.parametrize("scene", CASES)
def test_every_key_with_every_odd_value_is_a_fault_or_a_case(scene):
    keys = list(dict.fromkeys(places(scene.partition(" ")[0])))
    # One or two of the values for each key, and each value for many keys.
    found = [said(CASES[scene], f"{key}={value}") for i, key in enumerate(keys) for value in ODD[i % 20 :: 20]]
    assert sum(map(bool, found)) > 0.8 * len(found) > 100


@pytest.mark.parametrize(
    "override",
    [
        ".".join(["payload"] * 3000) + "=1", f"crane.tower.segments.{'9' * 5000}.length=1", "=", "payload.=1",
        ".=1", "mass",
        "payload.mass=" + "[" * 300 + "]" * 300, "crane={}", "crane.kind=[1]", "kind=3",
        "motion=3", "map.position_count=1001",
        "\udcff=1", "title=\ud800", f"crane={'x' * 5000}", "crane=/dev/zero", "crane=.",
    ],
    ids=lambda text: ascii(text[:20]),
)  # fmt: skip
def test_odd_overrides_are_named(override):
    assert said(CASES["tower in the plane"], override)


@pytest.mark.parametrize(
    "content",
    [b"", b"\xff\xfe", b"\0" * 100, b"x" * 5_000_000, b"a=" + b"[" * 10_000, ".".join(["a"] * 5000).encode() + b"=1"],
    ids=["empty", "no text", "zeros", "large", "lists", "tables"],
)
def test_odd_files_are_named(content, tmp_path):
    (tmp_path / "case.toml").write_bytes(content)
    began = time.process_time()
    assert said(tmp_path / "case.toml")
    # A file that makes reading hang would take minutes.
    assert time.process_time() - began < 60.0


def _runs():
    for scene, keys in RUNS.items():
        for key in keys:
            rule = ranges_in((key,), scene.partition(" ")[0])[key]
            for value in (rule.low / FARTHEST, rule.high * FARTHEST):
                yield scene, key, f"{value:.3g}"


@pytest.mark.parametrize(("scene", "key", "value"), list(_runs()))
def test_absurd_but_finite_numbers_that_a_case_allows_end_by_a_name(scene, key, value):
    kind = scene.partition(" ")[0]
    short = ["run.duration=0.05", "run.output_step=0.05", "solver.rtol=1e-4", f'allow_implausible=["{key}"]']
    case = load_case(CASES[scene], [*short, f"{key}={value}"])
    assert record_case(case).attrs["outcome"]
    farther = float(value) * (1e-3 if float(value) < ranges_in((key,), kind)[key].low else 1e3)
    (fault,) = said(CASES[scene], *short, f"{key}={farther}")
    assert fault.key == key.removeprefix("crane.") or fault.file.startswith("--set")


@pytest.mark.parametrize("command", ["run", "modes", "linearise", "map", "compare", "shape", "sensitivity"])
@pytest.mark.parametrize("override", ["payload.mass=1e308", "crane.gravity=1e-300", "rope.length=nan", "x=1"])
def test_commands_refuse_odd_values_in_words_and_write_nothing(command, override, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(app, [command, CASES["tower in the plane"], "--set", override])
    assert isinstance(done.exception, CaseError)
    assert list(tmp_path.iterdir()) == []
