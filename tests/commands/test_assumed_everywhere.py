"""Every command names the assumed values that its output rests on in every table, file and picture it writes."""

import json
from pathlib import Path

import numpy as np
import pytest
from scipy.io import loadmat
from typer.testing import CliRunner

from towercrane.cli import app
from towercrane.report.plots import style
from towercrane.results import files as results

RADIAL = "qtz5613/condition-3"
BENDS = 'crane.counter_jib.second_moment_of_area={value="0.0021 m^4", assumed="test"}'
BENDING = (BENDS, 'crane.counter_jib.youngs_modulus="206 GPa"')
LACED = 'crane.tower.lattice.leg_area={value="51 cm^2", assumed="test"}'
LOAD = 'payload.mass={value="811 kg", assumed="test"}'
TWIST = 'crane.tower.torsional_stiffness={value="171 MN m^2", assumed="test"}'
SHORT = ("run.duration=3 s", "solver.rtol=1e-4", "solver.atol=1e-6", LOAD)

BENT, TWISTED = "crane.counter_jib.second_moment_of_area", "crane.tower.torsional_stiffness"
SHAPES = "--positions", "2", "--modes", "3", "--shapes", "20 m"

COMMANDS = {
    "run": (RADIAL, ("--csv",), SHORT, "payload.mass"),
    "run in space": ("qtz5613/soft-drive", ("--csv",), SHORT, "payload.mass"),
    "run a slewing crane": ("slewing/basic/example-1", ("--csv",), SHORT, "payload.mass"),
    "run a jib crane": ("jib-crane/plan", ("--csv",), SHORT, "payload.mass"),
    "map": (RADIAL, SHAPES, BENDING, BENT),
    "modes": (RADIAL, (), (*BENDING, LACED), BENT),
    "modes in space": ("qtz5613/soft-drive", (), (LOAD,), "payload.mass"),
    "lattice": (RADIAL, (), (LACED,), "crane.tower.lattice.leg_area"),
    "sweep": (RADIAL, ("--vary", "rope.length=10,12"), SHORT, "payload.mass"),
    "linearise to .mat": (RADIAL, (), (LOAD,), "payload.mass"),
    "linearise to .npz": (RADIAL, (), (LOAD,), "payload.mass"),
    "shape": (RADIAL, (), (LOAD, "model.tower_modes=1", "model.jib_vertical_modes=1"), "payload.mass"),
    "sensitivity": ("slewing/basic/example-1", ("--vary", "stiffness_*", "--step", "50"), SHORT, "payload.mass"),
    "lift": (
        "qtz5613/lift-off", ("--speeds", "0.5", "--positions", "40", "--window", "2"),
        (LOAD, "model.tower_modes=1", "model.jib_vertical_modes=1"), "payload.mass",
    ),
    "compare": ("qtz5613/slewing", (), ("run.duration=1 s", "model.torsion_modes=0", TWIST), TWISTED),
}  # fmt: skip


def words_of(path: Path) -> str:
    """All that a file says of the values it rests on."""
    match path.suffix:
        case ".nc":
            return results.load(path).attrs["assumed"]
        case ".mat":
            return " ".join(str(entry[0]) for entry in loadmat(path)["assumed"].ravel())
        case ".npz":
            return " ".join(np.load(path)["assumed"].tolist())
    return path.read_text("utf-8")


@pytest.fixture
def pictures_as_text(monkeypatch):
    """Every picture is a file of its texts; nothing is drawn."""

    def put(figure, path):
        texts = figure.findobj(lambda artist: hasattr(artist, "get_text"))
        path.write_text(" ".join(text.get_text() for text in texts), "utf-8")

    monkeypatch.setattr(style, "put", put)


def assert_names(text, key, what):
    # A picture counts them where they are too many for its margin.
    assert key in text or "values that this rests on are assumed" in text, what


@pytest.mark.usefixtures("pictures_as_text")
@pytest.mark.parametrize("name", COMMANDS)
def test_each_output_of_a_command_names_what_it_rests_on(name, tmp_path):
    case, options, changes, key = COMMANDS[name]
    command, out = name.split()[0], tmp_path / "out"
    settings = [part for change in changes for part in ("--set", change)]
    if command == "linearise":
        out = tmp_path / f"crane{name.split()[-1]}"
    to = () if command == "lattice" else ("--out", str(out))
    said = CliRunner().invoke(app, [command, case, *options, *settings, *to])
    assert said.exit_code == 0, (said.output, said.exception)
    assert key in said.stdout.replace("\n", "")
    written = [out] if out.is_file() else sorted(out.iterdir()) if to else []
    assert bool(written) == bool(to)
    for path in written:
        # Shapes of tower and jib by themselves rest on neither load nor counter-jib.
        own = "crane.jib.second_moment_of_area" if case == RADIAL and path.name == "modes.png" else key
        assert_names(words_of(path), own, path.name)
    options = [option for option in options if option != "--csv"]
    report = json.loads(CliRunner().invoke(app, [command, case, *options, *settings, *to, "--json"]).stdout)
    assert key in [entry["key"] for entry in report["assumed"]]
