"""What a tower on collars asks of the number of its modes."""

import json

import numpy as np
import pytest

from towercrane import load_case
from towercrane.cranes.tower.file.build import crane_of
from towercrane.cranes.tower.modes.left_out.collar_statics import LOOKED_AT, base_moments, notice
from towercrane.runs.run import record_case

TIED = "towers/tied-wind"
SHORT = ["run.duration=1 s"]


def test_few_modes_bring_too_much_of_a_moment_at_the_top_down_to_the_base_and_a_note_says_how_many_do():
    crane = crane_of(load_case(TIED).checked)
    moments = base_moments(crane)
    assert len(moments) == LOOKED_AT
    said = notice(crane, 3)
    enough = int(said.rpartition(" = ")[2])
    assert 3 < enough < 14
    assert notice(crane, enough) == ""
    (told,) = json.loads(record_case(load_case(TIED, [*SHORT, "model.tower_modes=3"])).attrs["notices"])
    assert told == said
    assert "collars:" not in record_case(load_case(TIED, SHORT)).attrs["notices"]


def test_the_note_is_about_what_runs_show():
    """At rest in still air the moment on the base is off by as much as the note says."""
    still = [*SHORT, "wind.speed=0 m/s"]
    first = {
        modes: record_case(load_case(TIED, [*still, f"model.tower_modes={modes}"]))["base_moment_y"].values[0]
        for modes in (3, 11, 14)
    }
    assert abs(first[3] - first[14]) > abs(first[14])
    assert first[11] == pytest.approx(first[14], rel=0.15)
    assert np.isfinite(list(first.values())).all()


def test_a_tower_without_collars_is_told_nothing():
    assert notice(crane_of(load_case("towers/laced").checked), 1) == ""
    assert notice(crane_of(load_case("qtz5613/condition-3").checked), 1) == ""
