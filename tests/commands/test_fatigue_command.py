"""The command `fatigue` and duty files: runs, cases and days; what is wrong with either is one message."""

import json
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from towercrane import load_case
from towercrane.commands.loads.fatigue import fatigue as command
from towercrane.results.files import save
from towercrane.runs.run import record_case
from towercrane.schema.faults import CaseError
from towercrane.studies.fatigue.counting import cycles_repeated, equivalent_range
from towercrane.studies.fatigue.duty import read_duty
from towercrane.studies.fatigue.study import Operation, Spectra, fatigue

SHORT = ["run.duration=6 s", "model.tower_modes=1", "model.jib_vertical_modes=1"]
NONE = {"output": None, "days": None, "exponents": None, "out": None, "changes": None}


@pytest.fixture(scope="module")
def run():
    return record_case(load_case("qtz5613/condition-3", SHORT))


@pytest.fixture(scope="module")
def saved(run, tmp_path_factory):
    folder = tmp_path_factory.mktemp("runs") / "short"
    folder.mkdir()
    save(run, folder / "result.nc")
    return folder


def asked(capsys, *work, code=0, **options):
    """Report, or what is said of bad input."""
    arguments = NONE | {"as_json": True, "pictures": False} | options
    if code:
        with pytest.raises(SystemExit) as ended:
            command(list(work), **arguments)
        assert ended.value.code == code
        return capsys.readouterr().err
    command(list(work), **arguments)
    return json.loads(capsys.readouterr().out)


def test_ranges_are_those_of_the_run_as_often_as_it_occurs(run, saved, tmp_path, capsys):
    report = asked(capsys, str(saved), out=tmp_path / "out", days=2500.0, exponents="3,5")
    assert {path.name for path in (tmp_path / "out").iterdir()} == {"fatigue.json", "cycles.csv"}
    assert {"jib_root_moment", "base_moment_y", "hoist_rope_force"} < set(report["outputs"])
    assert "overturning_moment" not in report["outputs"]
    found = report["outputs"]["base_moment_y"]
    cycles = cycles_repeated(run.rows["base_moment_y"].values)
    for spectrum, exponent in zip(found["spectra"], (3.0, 5.0), strict=True):
        expected = 2500.0 ** (1.0 / exponent) * equivalent_range(cycles, exponent)
        assert_allclose(spectrum["equivalent_range"], expected, rtol=1e-7)
        assert_allclose(found["largest_range"] * spectrum["s"] ** (1 / exponent), expected, rtol=1e-7)
    assert found["largest_range"] == np.ptp(run.rows["base_moment_y"].values)
    assert any(own["key"] == "crane.jib.second_moment_of_area" for own in report["assumed"])
    rows = np.genfromtxt(tmp_path / "out" / "cycles.csv", delimiter=",", names=True, dtype=None, encoding="utf-8")
    assert_allclose(sum(rows["cycles"][rows["output"] == "base_moment_y"]), found["cycles"], rtol=1e-9)


def test_a_day_of_runs_and_cases(run, saved, tmp_path, capsys):
    path = tmp_path / "duty.toml"
    changes = ", ".join(f'"{change}"' for change in [*SHORT, "payload.mass=300 kg"])
    path.write_text(
        'days = 200\nexponents = [4]\nreference_cycles = 1e6\noutputs = ["hoist_rope_force"]\nstandard = "ours"\n'
        f'[[operations]]\nrun = "{saved}"\ncount = 30\n'
        f'[[operations]]\ncase = "qtz5613/condition-3"\nset = [{changes}]\ncount = 0.5\n'
        "[classes]\nlow = 1e-3\nhigh = 1\n"
    )
    report = asked(capsys, str(path), out=tmp_path / "out")
    light = record_case(load_case("qtz5613/condition-3", [*SHORT, "payload.mass=300 kg"]))
    told = Spectra(200.0, (4.0,), 1e6, classes={"low": 1e-3, "high": 1.0}, standard="ours")
    again = fatigue([Operation("a", run.rows, 30.0), Operation("b", light, 0.5)], ["hoist_rope_force"], told)
    assert report["outputs"] == json.loads(json.dumps(again.report["outputs"]))
    assert report["standard"] == "ours"
    assert set(report["classes"]) == {"low", "high"}
    assert [one["count"] for one in report["operations"]] == [30.0, 0.5]
    # Nothing of a day but the heavy load's swing: the light one is lifted in half of them.
    assert again.cycles["hoist_rope_force"][0, 0] < 0.5 * 500 * 9.81


def test_bad_input_is_one_message(saved, tmp_path, capsys):
    said = asked(capsys, str(saved), output=["jib_rot_moment"], code=2)
    assert "got 'jib_rot_moment'" in said
    assert 'did you mean "jib_root_moment"?' in said
    said = asked(capsys, str(saved), output=["rope_tension"], code=2)
    assert 'now called "hoist_rope_force"' in said
    said = asked(capsys, str(tmp_path / "gone.nc"), code=2)
    assert said.count("\n") == 1
    assert "wanted a case or a result.nc, got no file" in said
    (tmp_path / "empty").mkdir()
    assert "result.nc: wanted a case or a result.nc, got no file" in asked(capsys, str(tmp_path / "empty"), code=2)
    assert "--days -1: wanted a number above 0" in asked(capsys, str(saved), days=-1.0, code=2)
    assert "--exponents 3;4: wanted numbers" in asked(capsys, str(saved), exponents="3;4", code=2)
    assert "exponents: wanted numbers from 1 to 20, got 0" in asked(capsys, str(saved), exponents="0", code=2)
    assert "wanted a case to change" in asked(capsys, str(saved), changes=["payload.mass=1 t"], code=2)
    with pytest.raises(CaseError, match="wanted: a case file or the name of a shipped case"):
        asked(capsys, "qtz5613/condition-33")
    assert not (tmp_path / "results").exists()


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("count = -1", ["operations.0.count", "a number from 0", "-1"]),
        ('count = "often"', ["operations.0.count", '"often"']),
        ("cuont = 1", ['the unknown key "cuont"', 'did you mean "count"?']),
        ('case = "qtz5613/condition-3"', ['either run = "results/..." or case = "..."', "both"]),
        ('set = ["payload.mass=1 t"]', ["changes of a finished run"]),
        ("[classes]\nS0 = 2\nS1 = 1", ["classes", "limits that ascend"]),
        ("[classes]\nS0 = -2", ["classes.S0", "a number above 0"]),
        ("count = nan", ["operations.0.count", "a number from 0"]),
    ],
)
def test_faults_of_duty_files_name_the_key(line, words, tmp_path):
    path = tmp_path / "duty.toml"
    path.write_text(f'[[operations]]\nrun = "a"\n{line}\n')
    with pytest.raises(CaseError) as fault:
        read_duty(path)
    assert len(fault.value.faults) == 1
    assert str(path) in str(fault.value)
    for word in words:
        assert word in str(fault.value)


def test_faults_of_whole_duty_files(tmp_path):
    path = tmp_path / "duty.toml"
    path.write_text('days = 0\nexponents = [0.5]\ncounting = "repeatd"\noperations = []\n')
    with pytest.raises(CaseError) as fault:
        read_duty(path)
    assert [own.key for own in fault.value.faults] == ["operations", "counting", "days", "exponents"]


def test_runs_that_ended_early_and_outputs_that_rest_are_told(run):
    early = replace(run.rows, attrs=run.attrs | {"outcome": "slack rope", "end_time": 5.0})
    found = fatigue([Operation("short", early)], ["overturning_moment"])
    ended, signless = found.report["notices"]
    assert "ended early, at 5 s: slack rope" in ended
    assert "is a resultant" in signless
    with pytest.raises(ValueError, match="wanted one or more that occur, got none"):
        fatigue([Operation("never", run.rows, 0.0)])
