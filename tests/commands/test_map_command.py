"""The command map: table, files, JSON, exit codes, and one message per bad input."""

import json

import pytest
from samples.program import towercrane

from towercrane.results import files as results

SMALL = ("--positions", "4", "--modes", "3", "--payload", "400 kg, 1.6 t")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("map")


@pytest.fixture(scope="module")
def shown(folder):
    done = towercrane("map", "qtz5613/condition-3", *SMALL, "--shapes", "23 m", "--out", str(folder))
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_table_names_branches_buckling_and_what_is_assumed(shown):
    for text in (
        "load swing",
        "first jib bending",
        "at 55.6 m",
        "base moment",
        "tower buckles in the jib's plane at",
    ):
        assert text in shown
    assert "assumed  crane.jib.second_moment_of_area = 0.0035 m^4" in shown
    assert shown.rstrip().splitlines()[-1].startswith("next: towercrane run qtz5613/condition-3")


def test_files_hold_the_same_numbers(shown, folder):
    assert {path.name for path in folder.iterdir()} == {
        "map.nc", "map.csv", "map.json", "map.png", "shapes.png",
    }  # fmt: skip
    data = results.load(folder / "map.nc")
    assert dict(data.sizes) == {"payload": 2, "position": 4, "mode": 3, "member": 6, "load": 2}
    assert data.frequency.attrs["units"] == "Hz"
    assert all(variable.attrs.get("units") for name, variable in data.data_vars.items() if name != "outcome")
    assert json.loads(data.attrs["assumed"])[1][0] == "crane.jib.second_moment_of_area"
    report = json.loads((folder / "map.json").read_text(encoding="utf-8"))
    heavy = report["payloads"][1]
    assert heavy["payload_kg"] == 1600.0
    assert heavy["branches"][1]["frequencies_hz"] == data.frequency.values[1, :, 1].tolist()
    # With the trolley on the jib's end its weight moves the end as its push moves the tower's top: Maxwell.
    parts = heavy["branches"][1]["contribution"]
    assert parts["vertical"]["tower_tip"] == pytest.approx(parts["horizontal"]["jib_tip"], rel=1e-9)
    lines = (folder / "map.csv").read_text(encoding="utf-8").splitlines()
    rows = [line.split(",") for line in lines if not line.startswith("#")]
    assert rows[0][:5] == ["payload [kg]", "position [m]", "mode", "branch", "frequency [Hz]"]
    assert len(rows) == 1 + 2 * 4 * 3
    assert all(len(row) == len(rows[0]) for row in rows)
    assert float(rows[1 + 12 + 9 + 1][4]) == pytest.approx(data.frequency.values[1, 3, 1], rel=1e-11)


def test_folder_that_cannot_be_is_refused_before_the_work(tmp_path):
    (tmp_path / "file").write_text("", encoding="utf-8")
    done = towercrane("map", "qtz5613/condition-3", "--out", str(tmp_path / "file" / "map"))
    assert done.returncode == 2
    assert "wanted a folder" in done.stderr


def test_places_and_loads_of_the_case_are_the_default(tmp_path):
    settings = ('map.trolley_positions=["41 m", "5 m"]', 'map.payload_masses=["2 t", "1 t"]')
    options = [part for setting in settings for part in ("--set", setting)]
    done = towercrane("map", "qtz5613/condition-3", "--json", "--no-pictures", "--out", str(tmp_path), *options)
    assert done.returncode == 0, done.stderr
    report = json.loads(done.stdout)
    assert report["positions_m"] == [5.0, 41.0]
    assert [row["payload_kg"] for row in report["payloads"]] == [1000.0, 2000.0]


def test_buckled_tower_ends_with_its_own_code_and_keeps_what_stands(tmp_path):
    done = towercrane(
        "map", "qtz5613/condition-3", *SMALL[:4], "--payload", "400 kg, 20 t", "--out", str(tmp_path),
        "--set", "crane.tower.second_moment_of_area=3.6e-4", "--json",
        "--set", "allow_implausible=['crane.tower.second_moment_of_area']",
    )  # fmt: skip
    assert done.returncode == 3, done.stderr
    assert "load 20000 kg: tower buckled at 0." in done.stderr
    report = json.loads(done.stdout)
    assert [row["outcome"] for row in report["payloads"]] == ["finished", "tower buckled"]
    assert "branches" not in report["payloads"][1]
    assert (tmp_path / "map.png").exists()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--positions", "0"), "--positions 0: wanted 1 to 1000"),
        (("--modes", "21"), "--modes 21: wanted 1 to 20"),
        (("--payload", "400 kN"), '--payload 400 kN: wanted a mass, such as "800 kg"'),
        (("--payload", "400 kg,"), '--payload : wanted a mass, such as "800 kg"'),
        (("--payload", "3 m"), "which is a length"),
        (("--payload", "0 kg"), "--payload 0 kg: wanted a mass above 0"),
        (("--shapes", "56 m"), "--shapes 56 m: wanted a place on the jib, 0 to 55.6 m"),
        (("--shapes", "2 kg"), "--shapes 2 kg: wanted a length"),
    ],
)
def test_bad_options_get_one_message(tmp_path, options, message):
    done = towercrane("map", "qtz5613/condition-3", *options, "--out", str(tmp_path / "new"))
    assert done.returncode == 2
    assert message in done.stderr
    assert "Traceback" not in done.stderr
    assert not (tmp_path / "new").exists()


def test_crane_without_beams_is_sent_elsewhere():
    done = towercrane("map", "jib-crane/plan")
    assert done.returncode == 2
    assert "try: towercrane linearise jib-crane/plan" in done.stderr


def test_pictures_name_units_branches_and_loads():
    from samples.plane_crane import FRAME

    from towercrane.report.plots.studies import frequency_map as pictured
    from towercrane.studies.frequency_map import frequency_map
    from towercrane.studies.plane_modes import PlaneCrane

    data = frequency_map(FRAME, [0.0, 25.0, 50.0], [400.0, 800.0], modes=2)
    data.attrs |= {"crane": "crane", "assumed": json.dumps([["crane.jib.length", "50 m", "no source"]])}
    figure = pictured.frequencies(data)
    (axes,) = figure.axes
    assert axes.get_xlabel().endswith("[m]")
    assert axes.get_ylabel().endswith("[Hz]")
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    assert labels[:2] == data.branch.values.tolist()
    assert labels[2].startswith("load 400 kg")
    styles = [(line.get_color(), line.get_linestyle()) for line in axes.lines]
    assert len(set(styles)) == 4
    assert "crane.jib.length = 50 m" in figure._supxlabel.get_text()

    drawn = pictured.shapes(PlaneCrane(FRAME).modes(25.0, 4), "modes", [])
    panels = [axes for axes in drawn.axes if axes.get_visible()]
    assert len(panels) == 4
    assert all("Hz" in axes.get_title() and axes.get_aspect() == 1.0 for axes in panels)
    # Undeformed and deformed tower, jib and rope; the crane hangs together.
    tower, jib, rope = (line.get_xydata() for line in panels[1].lines[1:6:2])
    assert tower[-1] == pytest.approx(jib[0])
    assert jib[50][1] - rope[0][1] == pytest.approx(0.0, abs=0.5)


def test_what_the_drives_do_is_nothing_to_a_map(tmp_path):
    done = towercrane("map", "qtz5613/manoeuvre", "--positions", "3", "--json", "--out", str(tmp_path))
    assert done.returncode == 0, done.stderr
    keys = [entry["key"] for entry in json.loads(done.stdout)["assumed"]]
    assert "crane.jib.second_moment_of_area" in keys
    assert not any(key.startswith("motion.") for key in keys)
