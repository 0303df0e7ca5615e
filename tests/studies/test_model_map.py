"""Frequency maps of cranes on ties and with a jib that pivots: numbers, names, ends, what more modes say."""

import json
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples.program import towercrane

from towercrane.cases.case import CaseError, load_case
from towercrane.cranes.tower.equations.small_motions import natural_modes
from towercrane.studies.frequency_map import doubtful_steps
from towercrane.studies.ritz.model_map import model_map
from towercrane.studies.ritz.plane_crane import rich_crane

FEW = {"tower_modes": 2, "jib_vertical_modes": 2, "counter_jib_vertical_modes": 0}
MORE = {"tower_modes": 3, "jib_vertical_modes": 4, "counter_jib_vertical_modes": 1}
PLACES = {"hammerhead/travel": [0.0, 20.0, 45.0, 60.0], "luffing/manoeuvre": np.radians([20.0, 45.0, 80.0])}
LOADS = [1000.0, 4000.0]


@pytest.fixture(scope="module", params=list(PLACES))
def mapped(request):
    tables = load_case(request.param).checked
    crane, richer = rich_crane(tables, FEW), rich_crane(tables, MORE)
    return crane, richer, model_map(crane, richer, PLACES[request.param], LOADS, modes=4)


def test_frequencies_are_those_in_the_plane_of_the_crane_in_space(mapped):
    crane, _, data = mapped
    model = replace(crane.model, axes=3)
    for i, mass in enumerate(LOADS):
        loaded = model.with_load(replace(model.load, mass=mass))
        for j, place in enumerate(data.position.values):
            modes = natural_modes(loaded, float(place), crane.rope_length)
            inside = [m.frequency_hz for m in modes if m.shares["radial"] + m.shares["radial sway"] > 0.5]
            assert_allclose(np.sort(data.frequency.values[i, j]), inside[:4], rtol=1e-6)


def test_branches_hold_together_and_are_named_after_what_holds_their_energy(mapped):
    crane, _, data = mapped
    names = data.branch.values.tolist()
    assert (names[0], len(set(names))) == ("load swing", 4)
    assert ("first motion on the ties" in names) == ("ties" in crane.members)
    assert doubtful_steps(data) == []
    assert_allclose(data.energy_share.sum("member"), 1.0, rtol=1e-9)
    # More load swings all but the swing itself more slowly, but for the hoist rope's pull.
    first = data.frequency.sel(mode=2).values
    assert first[1, 1] < first[0, 1]
    assert (data.outcome == "finished").all()
    assert np.all(data.buckling_factor.values > 1.0)


def test_the_change_by_more_modes_bounds_that_by_still_more(mapped):
    """What the map prints beside its frequencies against a model that it has not seen."""
    crane, _, data = mapped
    tables = load_case("hammerhead/travel" if "ties" in crane.members else "luffing/manoeuvre").checked
    most = rich_crane(tables, {"tower_modes": 5, "jib_vertical_modes": 8, "counter_jib_vertical_modes": 2})
    change = data.change_by_more_modes.values
    assert 1e-7 < change.max() < 1e-2
    for i, mass in enumerate(LOADS):
        for j in (0, -1):
            exact = most.loaded(mass).modes(float(data.position[j]), 4).frequencies
            assert np.all(abs(np.sort(data.frequency.values[i, j]) / exact - 1.0) < 1.5 * change.max())


def test_a_load_with_which_the_crane_does_not_stand_has_an_outcome_and_no_numbers(mapped):
    crane, richer, data = mapped
    heavy, outcome = (3e6, "tower buckled") if "ties" in crane.members else (90000.0, "no stable equilibrium")
    found = model_map(crane, richer, data.position.values, [1000.0, heavy], modes=3)
    assert found.outcome.values.tolist() == ["finished", outcome]
    assert found.attrs["outcome"] == found.outcome.values[1]
    assert np.isfinite(found.frequency[0]).all()
    assert np.isnan(found.frequency[1]).all()


def test_commands_print_what_more_modes_change_and_write_all_files(tmp_path):
    options = ("--positions", "3", "--modes", "3", "--payload", "2 t", "--out", tmp_path)
    done = towercrane("map", "luffing/manoeuvre", *options)
    assert done.returncode == 0, done.stderr
    for text in ("at 15 deg", "at 85 deg", "more modes", "6 shapes of the tower", "the tower alone buckles"):
        assert text in done.stdout
    assert {path.name for path in tmp_path.iterdir()} == {"map.nc", "map.csv", "map.json", "map.png"}
    report = json.loads((tmp_path / "map.json").read_text("utf-8"))
    assert report["luffing_angles_rad"] == pytest.approx(np.radians([15.0, 50.0, 85.0]))
    assert set(report["change_by_more_modes"]) == set(report["branches"])
    assert max(report["change_by_more_modes"].values()) < 1e-3
    assert "contribution" not in report["payloads"][0]["branches"][0]
    assert "position [rad]" in (tmp_path / "map.csv").read_text("utf-8")
    for wrong, said in (
        (("--shapes", "20 m"), "towercrane modes luffing/manoeuvre --out"),
        (("--modes", "20"), "1 to"),
    ):
        done = towercrane("map", "luffing/manoeuvre", *wrong, "--out", tmp_path / "new")
        assert (done.returncode, said in done.stderr) == (2, True)


@pytest.mark.parametrize(
    ("name", "change", "key", "said"),
    [
        ("luffing/manoeuvre", 'map.trolley_positions=["5 m"]', "map.trolley_positions", "map.luffing_angles"),
        ("luffing/manoeuvre", 'map.luffing_angles=["5 deg", "40 deg"]', "map.luffing_angles.0", "15 to 85 deg"),
        ("luffing/manoeuvre", 'map.luffing_angles=["5 m"]', "map.luffing_angles.0", "length"),
        ("hammerhead/travel", 'map.luffing_angles=["40 deg"]', "map.luffing_angles", "does not pivot"),
    ],
)
def test_places_that_such_a_crane_has_not_are_refused(name, change, key, said):
    with pytest.raises(CaseError) as refused:
        load_case(name, [change])
    (fault,) = refused.value.faults
    assert fault.key == key
    assert said in f"{fault.wanted} {fault.got} {fault.hint}"


def test_modes_of_a_scene_in_the_plane_of_a_crane_on_ties_stand_beside_those_of_more(tmp_path):
    done = towercrane("modes", "hammerhead/travel", "--json", "--set", "modes.crane_count=5", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    modes = json.loads(done.stdout)["modes"]
    assert [mode["kind"] for mode in modes] == ["lateral sway", "radial sway", "torsion", "radial", "lateral"]
    assert all(1e-7 < abs(mode["relative_difference"]) < 1e-3 for mode in modes)
