"""What a run builds it hands on: its summary, its pictures and its film build no crane, model or mode again."""

import pytest
from typer.testing import CliRunner

from modal import Beam, Modes
from modal.beams.torsion import Shaft, TorsionModes
from modal.structures.chain_modes import ChainModes
from towercrane.cli import app
from towercrane.cranes.jib.model import PlannedJibCrane
from towercrane.cranes.jib.parameters import JibCrane
from towercrane.cranes.overhead.model import OverheadModel
from towercrane.cranes.overhead.parameters import OverheadCrane
from towercrane.cranes.slewing.description import LumpedCrane
from towercrane.cranes.slewing.model import LumpedModel
from towercrane.cranes.tower.model import FlexibleModel
from towercrane.cranes.tower.modes.modal_crane import FlexibleCrane
from towercrane.cranes.tower.modes.parameters import TowerCrane

SINGLE = (
    TowerCrane, FlexibleCrane, LumpedModel, LumpedCrane, PlannedJibCrane, JibCrane,
    OverheadModel, OverheadCrane, TorsionModes, Shaft,
)  # fmt: skip
TOLD_BY = {
    FlexibleModel: lambda model: (model.axes, model.cap),
    Beam: lambda beam: beam,
    Modes: lambda modes: (modes.beam, modes.end_body, modes.count),
    ChainModes: lambda modes: (modes.chain, modes.count),
}
"""What tells one member from another, modes of it from others, and coordinates of a crane from others."""

TOWER = {FlexibleModel, TowerCrane, FlexibleCrane}
SHORT = ("--set", "run.duration=2 s", "--set", "solver.rtol=1e-5")
CASES = {
    "plane": ("qtz5613/condition-3", (), TOWER),
    "shaped": ("qtz5613/condition-3", ("--set", "motion.trolley.shape=zvd"), TOWER),
    "segments": ("towers/tapered", (), TOWER),
    "space": ("qtz5613/manoeuvre", (), TOWER),
    "slewing": ("slewing/basic/example-1", (), {LumpedModel, LumpedCrane}),
    "jib": ("jib-crane/plan", (), {PlannedJibCrane, JibCrane}),
    "overhead": ("overhead-crane/hoist", (), {OverheadModel, OverheadCrane}),
}


@pytest.fixture
def built(monkeypatch):
    """What is built from now on, by its class."""
    found = {kind: [] for kind in (*SINGLE, *TOLD_BY)}

    def counted(kind, start):
        def begin(self, *arguments, **keywords):
            start(self, *arguments, **keywords)
            found[kind].append(self)

        return begin

    for kind in found:
        monkeypatch.setattr(kind, "__init__", counted(kind, kind.__init__))
    return found


def check(built, cranes):
    assert {kind for kind in SINGLE if len(built[kind]) > 1} == set()
    assert {kind for kind in cranes if not built[kind]} == set()
    for kind, told_by in TOLD_BY.items():
        ones = [told_by(one) for one in built[kind]]
        assert not [one for number, one in enumerate(ones) if one in ones[:number]], kind


@pytest.mark.parametrize("kind", CASES)
def test_a_run_builds_its_crane_once(built, kind, tmp_path):
    name, changes, cranes = CASES[kind]
    done = CliRunner().invoke(app, ["run", name, "--no-pictures", "--out", str(tmp_path), *SHORT, *changes])
    assert done.exit_code == 0, done.output
    check(built, cranes)


@pytest.mark.parametrize(
    "arguments",
    [("run", "qtz5613/condition-3", "--out", "."), ("animate", "slewing/basic/example-1", "--out", "film.gif"),
     ("animate", "qtz5613/manoeuvre", "--out", "film.gif")],
)  # fmt: skip
def test_pictures_and_films_show_the_crane_that_was_run(built, arguments, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(app, [*arguments, *SHORT])
    assert done.exit_code == 0, done.output
    check(built, {FlexibleModel} if "qtz5613" in arguments[1] else {LumpedModel})


def test_a_verification_stands_on_the_crane_that_was_run(built, tmp_path):
    command = ["run", "qtz5613/condition-3", "--verify", "--no-pictures", "--out", str(tmp_path), *SHORT]
    done = CliRunner().invoke(app, command)
    assert done.exit_code == 0, done.output
    assert len(built[TowerCrane]) == 1
    assert len(built[FlexibleModel]) > 1
