"""No modes of a kind means a rigid member: every command takes it, alone and with all others."""

from __future__ import annotations

import numpy as np
import pytest
from typer.testing import CliRunner

from towercrane.cli import app
from towercrane.results import files as results

IN_THE_PLANE, IN_SPACE = "qtz5613/condition-3", "qtz5613/slewing"
PLANE = ("tower_modes", "jib_vertical_modes")
SPACE = ("tower_modes", "torsion_modes", "jib_lateral_modes", "jib_vertical_modes")
RIGID = [
    *((IN_THE_PLANE, kinds) for kinds in (PLANE[:1], PLANE[1:], PLANE)),
    *((IN_SPACE, kinds) for kinds in (*((kind,) for kind in SPACE), SPACE)),
]
COORDINATES = {
    IN_THE_PLANE: {"tower_modes": {"tower_x"}, "jib_vertical_modes": {"jib_vertical"}},
    IN_SPACE: {
        "tower_modes": {"tower_x", "tower_y"},
        "torsion_modes": {"torsion"},
        "jib_lateral_modes": {"jib_lateral"},
        "jib_vertical_modes": {"jib_vertical"},
    },
}


def invoked(command, case, kinds, *options):
    changes = [f"model.{kind}=0" for kind in kinds] + ["run.duration=2 s"]
    done = CliRunner().invoke(app, [command, case, *options, *(part for c in changes for part in ("--set", c))])
    assert done.exit_code == 0, (done.output, done.exception)
    return done


@pytest.mark.parametrize(("case", "kinds"), RIGID)
def test_a_run_with_rigid_members_leaves_out_their_coordinates(case, kinds, tmp_path):
    invoked("run", case, kinds, "--no-pictures", "--csv", "--verify", "--out", str(tmp_path))
    result = results.load(tmp_path / "result.nc")
    stored = {str(name).removesuffix("_coordinate") for name in result.data_vars if str(name).endswith("_coordinate")}
    assert stored == {m for kind, members in COORDINATES[case].items() if kind not in kinds for m in members}
    assert "_coordinate" not in (tmp_path / "result.csv").read_text().splitlines()[-1]
    if "tower_modes" in kinds:
        assert np.all(result["tower_tip_displacement"].values == 0.0)
    assert float(abs(result["hoist_rope_force"].values).min()) > 0.0


@pytest.mark.parametrize(("case", "kinds"), [*RIGID[:3], (IN_SPACE, SPACE)])
@pytest.mark.parametrize("command", [("modes", "--json"), ("linearise", "--json")])
def test_small_motions_take_rigid_members(command, case, kinds):
    invoked(command[0], case, kinds, *command[1:])


@pytest.mark.parametrize("kinds", [PLANE[:1], PLANE[1:], PLANE])
def test_maps_take_rigid_members(kinds, tmp_path):
    invoked("map", IN_THE_PLANE, kinds, "--positions", "3", "--out", str(tmp_path))


def test_comparisons_and_sweeps_pass_through_rigid_members(tmp_path):
    invoked("compare", IN_THE_PLANE, ("jib_vertical_modes",), "--out", str(tmp_path))
    invoked("sweep", IN_THE_PLANE, (), "--vary", "model.jib_vertical_modes=0,1", "--out", str(tmp_path))


@pytest.mark.parametrize(("case", "kinds"), [(IN_THE_PLANE, PLANE), (IN_SPACE, SPACE)])
def test_a_film_shows_rigid_members(case, kinds, tmp_path):
    invoked("animate", case, kinds, "--out", str(tmp_path / "film.gif"), "--to", "0.2")
    assert (tmp_path / "film.gif").stat().st_size > 1000


def test_motions_that_leave_the_load_at_rest_take_rigid_members(tmp_path):
    invoked("shape", IN_THE_PLANE, PLANE, "--step", "0.5", "--out", str(tmp_path))
