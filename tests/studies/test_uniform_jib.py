"""A uniform beam in place of a jib of segments."""

import json

import pytest
from samples.flat_top_crane import FRAME
from typer.testing import CliRunner

from towercrane.cli import app
from towercrane.studies.natural import uniform_jib_cost

PRINTED = {20.0: (-2.8, -3.0, 2.0, 28.0), 58.0: (-2.0, 8.0, 3.0, 42.0)}
"""What it costs from the second frequency to the fifth [%], the larger ones to whole numbers."""


def test_a_uniform_jib_of_the_same_first_frequency_misses_those_of_the_crane():
    for row in uniform_jib_cost(FRAME, tuple(PRINTED), 5):
        found = [100.0 * change for change in row["relative_difference"]]
        assert abs(found[0]) < 0.05
        for change, printed in zip(found[1:], PRINTED[row["trolley_position_m"]], strict=True):
            assert change == pytest.approx(printed, abs=0.06 if printed % 1.0 else 0.6)


def test_the_command_says_so_in_a_line_where_it_is_asked(tmp_path):
    arguments = [
        "modes",
        "flat-top/travel",
        "--actual",
        "--set",
        "modes.trolley_positions=[58]",
        "--out",
        str(tmp_path),
    ]
    said = CliRunner().invoke(app, arguments).stdout
    assert "a uniform jib, as heavy" in said
    report = json.loads(CliRunner().invoke(app, [*arguments, "--json"]).stdout)
    (row,) = report["uniform_jib"]
    assert max(map(abs, row["relative_difference"])) > 0.1
    plain = json.loads(CliRunner().invoke(app, [*arguments[:2], *arguments[3:], "--json"]).stdout)
    assert "uniform_jib" not in plain
