"""Modes of the published crane as the command answers them: numbers, discrepancies, assumed values."""

import json

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples.program import towercrane

from towercrane.cases.shipped import case_folder


def test_modes_answers_in_the_documented_json():
    report = json.loads(towercrane("modes", "qtz5613/condition-3", "--json").stdout)
    roots = report["tower"]["roots"]
    assert_allclose(roots, [0.769077, 1.512129, 4.799683, 7.896404], atol=1e-6)
    printed = np.array([0.765, 1.508, 4.780, 7.896])
    assert_allclose(np.delete(roots, 2), np.delete(printed, 2), atol=0.005)
    assert roots[2] - printed[2] > 0.015
    assert_allclose(report["tower"]["frequencies_hz"][0], 0.477056, atol=1e-6)
    assert_allclose(report["jib"]["frequencies_hz"][0], 0.436846, atol=1e-6)
    # The worst of four at 32 elements.
    differences = np.array(report["finite_elements"]["relative_difference"])
    assert_allclose(report["finite_elements"]["frequencies_hz"], report["tower"]["frequencies_hz"], rtol=3e-6)
    assert np.max(abs(differences[:3])) < 1e-6
    assert [row["trolley_position_m"] for row in report["crane"]] == [5.0, 23.0, 41.0]
    assert_allclose(report["crane"][2]["frequencies_hz"][:3], [0.117452, 0.311804, 0.794508], atol=1e-6)
    assert np.max(np.abs(report["crane"][2]["relative_difference"][:3])) < 2e-5
    assert report["lattice"]["equivalent_second_moment_of_area"]["use"]
    assert any(entry["key"] == "crane.jib.second_moment_of_area" for entry in report["assumed"])


def test_modes_table_names_the_discrepancy_and_the_assumed_values():
    text = towercrane("modes", "qtz5613/condition-3").stdout
    assert "(!) discrepancy" in text
    assert "f [Hz]" in text
    assert "trolley [m]" in text
    assert "assumed  crane.jib.second_moment_of_area = 0.0035 m^4" in text
    assert "next: towercrane run qtz5613/condition-3" in text


@pytest.mark.parametrize(("command", "area"), [("modes", "1e-5 cm^2"), ("modes", "1e-3 cm^2"), ("map", "1e-5 cm^2")])
def test_horizontals_that_leave_few_modes_are_refused_by_their_key(command, area, tmp_path):
    """A tenth of a square millimetre of steel or less: beyond what is plausible, and allowed all the same."""
    crane = (case_folder() / "towers/crane-laced.toml").read_text("utf-8")
    case = (case_folder() / "towers/laced.toml").read_text("utf-8")
    assert '"8 cm^2", assumed = "not printed; taken' in crane
    crane = crane.replace('"8 cm^2", assumed = "not printed; taken', f'"{area}", assumed = "not printed; taken')
    (tmp_path / "crane-laced.toml").write_text(crane, "utf-8")
    allowed = 'allow_implausible = ["crane.tower.lattice.horizontal_area"]\n'
    (tmp_path / "laced.toml").write_text(allowed + case, "utf-8")
    done = towercrane(command, str(tmp_path / "laced.toml"), "--out", str(tmp_path / "out"))
    assert done.returncode == 2
    assert "crane.tower.lattice: wanted horizontals that leave the modes asked for" in " ".join(done.stderr.split())
    assert not (tmp_path / "out").exists()
