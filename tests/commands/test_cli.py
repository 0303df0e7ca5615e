"""The command line as a newcomer meets it: help, cases, next commands, bad input, and no traceback."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from samples.program import towercrane


def test_help_and_version_name_every_command():
    text = towercrane("--help").stdout
    for command in (
        "modes",
        "run",
        "animate",
        "linearise",
        "shape",
        "sweep",
        "map",
        "lattice",
        "compare",
        "fatigue",
        "lift",
        "figures",
        "bench",
        "cases",
    ):
        assert command in text
    assert towercrane("--version").stdout.startswith("towercrane 0.")


def test_help_has_a_whole_sentence_for_each_command_in_80_columns():
    _, _, listed = towercrane("--help").stdout.partition("Commands:\n")
    commands = listed.partition("\n\n")[0].splitlines()
    assert len(commands) == 15
    assert all(line.endswith(".") and not line.endswith("...") and len(line) <= 80 for line in commands)


@pytest.mark.parametrize("command", [(), ("run",)], ids=["all", "run"])
def test_help_loads_nothing_heavy(command):
    heavy = {"numpy", "llvmlite", "scipy", "skfem", "xarray", "pint", "matplotlib", "rich"}
    check = f"""if True:
        import atexit, sys, towercrane.cli
        atexit.register(lambda: print(sorted({heavy} & set(sys.modules)), file=sys.stderr))
        towercrane.cli.main()"""
    arguments = [sys.executable, "-c", check, *command, "--help"]
    done = subprocess.run(arguments, capture_output=True, text=True, check=True)
    assert done.stderr.strip() == "[]"


@pytest.mark.parametrize(
    ("arguments", "idle"),
    [
        (
            ("run", "qtz5613/condition-3", "--no-pictures"),
            {"pint", "matplotlib", "scipy.optimize", "scipy.sparse", "xarray", "pandas"},
        ),
        (("modes", "qtz5613/condition-3"), {"pint", "matplotlib", "scipy.optimize", "xarray", "pandas"}),
    ],
    ids=["run", "modes"],
)
def test_commands_load_only_what_they_use(arguments, idle, tmp_path):
    check = f"""if True:
        import atexit, sys, towercrane.cli
        atexit.register(lambda: print(sorted({idle} & set(sys.modules)), file=sys.stderr))
        towercrane.cli.main()"""
    command = [sys.executable, "-c", check, *arguments]
    done = subprocess.run(command, capture_output=True, text=True, check=True, cwd=tmp_path)
    assert done.stderr.splitlines()[-1] == "[]"


def test_cases_are_listed_with_the_next_command():
    lines = towercrane("cases").stdout.splitlines()
    names = [line.split()[0] for line in lines[:-1]]
    assert {f"qtz5613/condition-{n}{kind}" for n in (1, 2, 3, 4) for kind in ("", "-paper")} <= set(names)
    assert "qtz5613/condition-4-zero" in names
    assert lines[-1].startswith("next: towercrane modes ")


def test_cases_are_handed_out_once_and_run_where_they_are(tmp_path):
    assert towercrane("cases", "copy", str(tmp_path / "mine")).returncode == 0
    case = tmp_path / "mine" / "qtz5613" / "condition-4.toml"
    text = case.read_text(encoding="utf-8").replace('length = "10 m"', 'length = "12 m"')
    case.write_text(text, encoding="utf-8")
    again = towercrane("cases", "copy", str(tmp_path / "mine"))
    assert again.returncode == 2
    assert "would be overwritten" in again.stderr
    assert case.read_text(encoding="utf-8") == text
    done = towercrane("run", str(case), "--no-pictures", "--json", "--set", "run.duration=2 s", cwd=tmp_path)
    assert done.returncode == 0
    assert (tmp_path / "results" / "condition-4" / "result.nc").exists()


def test_sensitivity_writes_ranking_surfaces_and_reduced_crane(tmp_path):
    done = towercrane(
        "sensitivity", "slewing/basic/cycle", "--vary", "stiffness_rope", "--step", "100", "--out", str(tmp_path),
        "--json", "--set", "run.duration=12 s",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    report = json.loads(done.stdout)
    assert report["degrees_of_freedom"] == 7
    assert {path.name for path in tmp_path.iterdir()} == {
        "sensitivity.nc", "sensitivity.json", "ranking.png", "surface-stiffness_rope.png",
    }  # fmt: skip
    for wrong in (("--vary", "nonsense"), ("--step", "0"), ("--tolerance", "3")):
        refused = towercrane("sensitivity", "slewing/basic/cycle", "--out", str(tmp_path / "no"), *wrong)
        assert refused.returncode == 2
        assert "wanted" in refused.stderr
    assert towercrane("sensitivity", "qtz5613/condition-3", "--out", str(tmp_path / "no")).returncode == 2
    assert not (tmp_path / "no").exists()


def test_brackets_in_names_are_text(tmp_path):
    odd = ("--set", 'title="load [/b] 800 kg"', "--set", 'crane.name="A [red]"')
    done = towercrane("run", "qtz5613/condition-3", "--out", str(tmp_path), "--no-pictures", *odd)
    assert done.returncode == 0
    assert "A [red]: load [/b] 800 kg" in done.stdout
    assert "at [s]" in done.stdout
    assert 'title="load [/b] 800 kg"' in done.stdout


def test_next_command_works_as_printed(tmp_path):
    folder = tmp_path / "my cases"
    copied = towercrane("cases", "copy", str(folder)).stdout.splitlines()[-1]
    import shlex

    command = shlex.split(copied.removeprefix("next: "))
    assert command[:2] == ["towercrane", "run"]
    assert Path(command[2]).is_file()
    done = towercrane("modes", command[2], "--set", "payload.mass=900 kg").stdout.splitlines()[-1]
    again = shlex.split(done.removeprefix("next: "))
    assert again == ["towercrane", "run", command[2], "--set", "payload.mass=900 kg"]


BAD = {
    "missing file": (["run", "condition-9"], ["condition-9", "wanted"]),
    "misspelt key": (
        ["run", "qtz5613/condition-3", "--set", "payload.mas=3 kg"],
        ["payload.mas", 'closest known key: "mass"'],
    ),
    "wrong unit": (["modes", "qtz5613/condition-3", "--set", "rope.length=18 s"], ["rope.length", "18 s"]),
    "absurd modulus": (
        ["modes", "qtz5613/condition-3", "--set", "crane.tower.youngs_modulus=206"],
        ["youngs_modulus", "206", "GPa"],
    ),
    "off the jib": (
        ["run", "qtz5613/condition-3", "--set", "motion.trolley.end=60 m"],
        ["motion.trolley", "60", "55.6"],
    ),
    "too few elements": (
        ["modes", "qtz5613/condition-3", "--set", "modes.elements=2"],
        ["modes.elements", "4 modes"],
    ),
    "unknown method": (["run", "qtz5613/condition-3", "--set", "solver.method=euler"], ["solver.method", "dop853"]),
    "unknown option": (["run", "qtz5613/condition-3", "--setx", "a=b"], ["--setx"]),
}


@pytest.mark.parametrize(("arguments", "words"), BAD.values(), ids=BAD)
def test_bad_input_is_one_clear_message_and_exit_code_2(arguments, words, tmp_path):
    done = towercrane(*arguments, cwd=tmp_path)
    assert done.returncode == 2
    assert "Traceback" not in done.stderr + done.stdout
    assert done.stdout == ""
    for word in words:
        assert word in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_output_folder_that_is_a_file_is_refused_before_the_run(tmp_path):
    target = tmp_path / "taken"
    target.write_text("mine", encoding="utf-8")
    done = towercrane("run", "qtz5613/condition-3", "--out", str(target))
    assert done.returncode == 2
    assert "wanted a folder" in done.stderr
    assert target.read_text(encoding="utf-8") == "mine"
