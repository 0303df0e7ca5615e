"""The door for case files: missing and broken files, and overrides of single values."""

from pathlib import Path

import pytest
from samples.case_files import CASE, CRANE, SEQUENCE, faults_of, only_fault, with_motion

from towercrane.cases.case import load_case
from towercrane.cases.models import motions_of
from towercrane.cranes.tower.file.requests import modes_of

# Files


def test_a_file_of_four_mebibytes_is_read_and_a_larger_one_is_not(write):
    full = CASE + "#" * (4 * 2**20 - len(CASE.encode()))
    assert load_case(write(case_text=full)).payload.mass == 800.0
    assert "a TOML file of at most 4194304 bytes" in str(only_fault(write(case_text=full + "#")))


@pytest.mark.parametrize(
    ("text", "key", "words"),
    [
        (CASE.replace('"800 kg"', "800 kg"), "line 4, column 12", ["TOML", "mass = 800 kg", "in quotes"]),
        (CASE.replace('"800 kg"', "heavy"), "line 4, column 8", ["TOML", "mass = heavy", "in quotes"]),
        (CASE.replace('mass = "800 kg"', "mass ="), "line 4, column 7", ["TOML"]),
        (CASE.replace("[rope]", "[payload]"), "line 5, column 9", ["twice"]),
        (CASE + '"', "end of file", ["TOML"]),
        (CASE + "\nx = " + "9" * 5000, "", ["TOML"]),
        (CASE + "\nx = " + "[" * 5000, "", ["TOML"]),
    ],
)
def test_syntax_errors_give_line_and_column(write, text, key, words):
    fault = only_fault(write(case_text=text))
    if key:
        assert fault.key.split(",")[0] == key.split(",")[0]
        assert fault.key.split("column")[0] == key.split("column")[0]
    for word in words:
        assert word in str(fault)


def test_syntax_error_in_the_crane_leaves_the_case_checked(write, tmp_path):
    path = write(('"800 kg"', '"800 m"'))
    (tmp_path / "crane.toml").write_text("[tower\n")
    faults = faults_of(path)
    assert [Path(f.file).name for f in faults] == ["crane.toml", "case.toml"]
    assert faults[0].key.startswith("line 1, column ")
    assert faults[1].key == "payload.mass"


def test_empty_files(write, tmp_path):
    path = write()
    (tmp_path / "crane.toml").write_text("# nothing\n")
    fault = only_fault(path)
    assert (Path(fault.file).name, fault.got) == ("crane.toml", "an empty file")
    path.write_text("\n")
    fault = only_fault(path)
    assert fault.got == "an empty file"
    assert "[motion.trolley]" in fault.wanted


def test_missing_and_unreadable_files(write, tmp_path):
    path = write(('"crane.toml"', '"carne.toml"'))
    fault = only_fault(path)
    assert (fault.file, fault.key) == (str(path), "crane")
    assert 'did you mean "crane.toml"?' in fault.hint
    assert "a folder" in only_fault(tmp_path).got
    assert "case.toml" in only_fault(tmp_path).hint
    path.write_bytes(b"title = '\xff'")
    assert "UTF-8" in only_fault(path).got
    assert "crane file" in only_fault(tmp_path / "crane.toml").got
    assert only_fault(write(('"crane.toml"', "3"))).key == "crane"
    assert "no regular file" in only_fault(write(('"crane.toml"', '"."'))).got
    assert "no such file" in only_fault("a" * 5000).got


def test_a_byte_order_mark_is_harmless(write):
    path = write()
    path.write_text("\ufeff" + path.read_text(), "utf-8")
    assert load_case(path).title == "A case"


# Overrides


def test_overrides(write):
    case = load_case(
        write(),
        [
            "payload.mass = 1200 kg",
            "crane.jib.second_moment_of_area=0.004 m^4",
            "solver.rtol=1e-6",
            "start.state=zero",
            "model.weight_softening=true",
            'modes.trolley_positions=["5 m", 9]',
        ],
    )
    assert case.payload.mass == 1200.0
    assert case.crane.jib.second_moment_of_area == 0.004
    assert case.solver.rtol == 1e-6
    assert case.start.state == "zero"
    assert case.checked.model.weight_softening is True
    assert modes_of(case.checked, motions_of(case)["trolley"]).trolley_positions == (5.0, 9.0)
    assert case.as_written["payload"]["mass"] == "1200 kg"
    assert case.as_written["crane"]["jib"]["second_moment_of_area"] == "0.004 m^4"


def test_an_override_can_exchange_the_crane_and_change_it(write, tmp_path):
    path = write()
    (tmp_path / "long.toml").write_text(CRANE.replace('"40 m"', '"60 m"'))
    case = load_case(path, ["crane.tower.height=50 m", "crane=long.toml"])
    assert (case.crane.jib.length, case.crane.tower.height) == (60.0, 50.0)


def test_an_override_reaches_into_a_step(write):
    text = SEQUENCE + 'steps = [{ shape = "trapezoid", end = 50, speed = 1, acceleration = 1 }]'
    path = write(case_text=with_motion(text))
    assert motions_of(load_case(path, ["motion.trolley.steps.0.end=20"]))["trolley"].end == pytest.approx(20.0)
    for beyond in ("steps.7=3", "steps.7.end=3"):
        fault = faults_of(path, f"motion.trolley.{beyond}")[0]
        assert ("index below 1" in fault.wanted, fault.got) == (True, '"7"')


@pytest.mark.parametrize(
    ("override", "key", "words"),
    [
        ("payload.mas=3", "payload.mas", ["unknown key", '"mass"']),
        ("crane.jbi.length=3 m", "crane.jbi", ["unknown key", '"jib"']),
        ("crane.jib.length=3 s", "crane.jib.length", ["a length", "a time"]),
        ("paylod.mass=3 kg", "paylod", ['"payload"']),
        ("payload.mass.value=3", "payload.mass", ["a table", '"800 kg"']),
        ("payload.mass", "", ["key=value", '"payload.mass"']),
        ("=3", "", ["key=value"]),
        ("payload..mass=3", "", ["key=value"]),
        ("payload.mass=1\nx=2", "payload.mass", ["a mass"]),
        ("payload.mass=", "payload.mass", ["a mass", '""']),
        ("crane.jib.segments.0.length=3 m", "crane.jib.segments", ["a list, such as [[crane.jib.segments]]", "none"]),
        ("run=3", "run", ["a table [run] with duration"]),
    ],
)
def test_faults_of_an_override_name_it(write, override, key, words):
    fault = only_fault(write(), override)
    assert fault.file.startswith("--set ")
    assert fault.file.removeprefix("--set ").startswith(override.split("\n")[0])
    assert fault.key == key
    for word in words:
        assert word in str(fault)
