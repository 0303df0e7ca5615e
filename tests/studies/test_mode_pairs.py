"""Modes of a run's plane model beside the exact crane's: paired by their shapes, never by their rank."""

import json

import numpy as np
import pytest
from numpy.testing import assert_allclose

from towercrane.cases.case import load_case
from towercrane.cranes.tower.file.build import crane_frame
from towercrane.report.tables.modes import modes_tables
from towercrane.studies.natural import natural_frequencies
from towercrane.studies.plane_modes import MEMBERS, PlaneCrane

TAPERED, RIGID = "towers/tapered", "model.counter_jib_vertical_modes=0"


@pytest.fixture(scope="module")
def tapered():
    return natural_frequencies(load_case(TAPERED, (RIGID,)))


def test_mode_of_a_counter_jib_that_bends_is_missing_from_a_model_that_keeps_it_rigid(tapered):
    crane = PlaneCrane(crane_frame(load_case(TAPERED).checked))
    for row, frequency in zip(tapered["crane"], (1.104559, 1.099980), strict=True):
        (missing,) = row["missing_from_the_model"]
        assert missing["member"] == "counter-jib"
        assert_allclose(missing["frequency_hz"], frequency, atol=1e-6)
        modes = crane.modes(row["trolley_position_m"], 5)
        in_counter_jib = modes.energy_shares[:, MEMBERS.index("counter-jib")]
        # It is the fourth, and the only one of the five whose energy is there.
        assert (in_counter_jib > 0.5).tolist() == [False, False, False, True, False]
        assert_allclose(modes.frequencies[3], frequency, atol=1e-6)
        assert_allclose(row["exact_hz"][:3], modes.frequencies[:3], rtol=1e-12)
        assert 0.0 < max(row["relative_difference"][:3]) < 0.01
        # The model's next two mix what the counter-jib parts in the exact crane: they are like none of its modes.
        assert row["exact_hz"][3:] == row["relative_difference"][3:] == [None, None]
        assert_allclose(row["exact_unlike_the_model_hz"], modes.frequencies[4:], rtol=1e-12)
    json.dumps(tapered, allow_nan=False)


def test_the_stiffer_the_counter_jib_the_nearer_is_every_mode_of_the_model():
    worst = []
    for inertia in (0.12, 9.6):
        case = load_case(TAPERED, (f"crane.counter_jib.second_moment_of_area='{inertia} m^4'", RIGID))
        rows = natural_frequencies(case)["crane"]
        assert [row["missing_from_the_model"] + row["exact_unlike_the_model_hz"] for row in rows] == [[], []]
        worst.append(max(max(row["relative_difference"]) for row in rows))
    # One over the stiffness, but for what the jib modes left out cost.
    assert 0.01 < worst[0] < 0.1
    assert worst[1] < 2e-3


@pytest.mark.parametrize(
    ("tower", "jib", "without", "missing"),
    [(1, 5, 3, [(2.130, "tower")]), (5, 1, 4, [(2.941, "jib"), (7.614, "jib")])],
)
def test_modes_beyond_one_that_the_model_lacks_keep_their_partners(tower, jib, without, missing):
    counts = (f"model.tower_modes={tower}", f"model.jib_vertical_modes={jib}", "modes.trolley_positions=[5]")
    case = load_case("towers/laced", counts)
    (row,) = natural_frequencies(case)["crane"]
    found = [(mode["frequency_hz"], mode["member"]) for mode in row["missing_from_the_model"]]
    assert [member for _, member in found] == [member for _, member in missing]
    assert_allclose([f for f, _ in found], [f for f, _ in missing], atol=1e-3)
    exact = PlaneCrane(crane_frame(case.checked)).modes(5.0, 8).frequencies
    lacking = [int(np.argmin(np.abs(exact - f))) for f, _ in found]
    assert_allclose(row["exact_hz"], np.delete(exact, lacking)[:5], rtol=1e-12)
    assert np.abs(row["relative_difference"]).max() < 0.07
    assert lacking[0] == without


def test_a_rich_model_has_every_mode_of_the_exact_crane():
    for row in natural_frequencies(load_case("hard/modes-8-14"))["crane"]:
        assert row["missing_from_the_model"] == row["exact_unlike_the_model_hz"] == []
        assert np.abs(row["relative_difference"]).max() < 3e-6


def test_table_names_the_modes_without_a_partner(tapered, capsys, monkeypatch):
    monkeypatch.setattr("towercrane.report.tables.layout.WIDTH_OF_A_PIPE", 400)
    modes_tables(tapered)
    said = capsys.readouterr().out
    differences = [
        line.strip("│ ").split("│")[1:] for line in said.splitlines() if "difference from exact crane" in line
    ]
    assert [[cell.strip() for cell in row[3:]] for row in differences] == [["-", "-"]] * 2
    assert "trolley at 4 m: the exact crane's counter-jib mode at 1.104559 Hz is missing from the model" in said
    assert "trolley at 4 m: no mode of the model is like the exact crane's at 4.417182 Hz" in said
    assert "- the exact crane has no mode of that shape" in said
