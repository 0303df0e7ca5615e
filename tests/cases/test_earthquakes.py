"""The door for earthquakes: files of the ground and of floors, the plane of a scene, and what is said of records."""

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from towercrane.accuracy.scene import scene_of
from towercrane.cases.case import CaseError, case_folder, load_case
from towercrane.cases.models import model_of, motions_of
from towercrane.cases.table_notices import table_notices
from towercrane.cranes.tower.file.plane import heading_of

TIED = "towers/tied-earthquake"
HEADER = "time [s],x [m/s^2],y [m/s^2],z [m/s^2]\n"
REST = "0,0,0,0\n1,0.5,0,0\n2,0,0,0\n"


@pytest.fixture
def tied(tmp_path):
    """Writes the tied tower's case beside a record of one's own, with its text changed."""

    def write(record=HEADER + REST, *changes, **files):
        text = (case_folder() / f"{TIED}.toml").read_text("utf-8")
        for old, new in changes:
            assert old in text
            text = text.replace(old, new, 1)
        for name in ("crane-tied.toml",):
            (tmp_path / name).write_text((case_folder() / "towers" / name).read_text("utf-8"), "utf-8")
        if record is not None:
            (tmp_path / "earthquake.csv").write_text(record, "utf-8")
        for name, content in files.items():
            (tmp_path / f"{name}.csv").write_text(content, "utf-8")
        path = tmp_path / "case.toml"
        path.write_text(text, "utf-8")
        return path

    return write


def faults_of(path, *changes):
    with pytest.raises(CaseError) as caught:
        load_case(path, list(changes))
    return caught.value.faults


FILE = 'file = { value = "earthquake.csv", assumed = "no record: made from random sines, see the file" }'


def test_the_ground_moves_as_its_file_says():
    case = load_case(TIED, ["earthquake.factor=2", 'earthquake.axes=["x","z"]'])
    rows = np.loadtxt(case_folder() / "towers" / "earthquake.csv", delimiter=",", skiprows=3)
    motions = motions_of(case)
    for column, (axis, acts) in enumerate(zip("xyz", (2.0, 0.0, 2.0), strict=True), start=1):
        assert_allclose(motions[f"ground_{axis}"](rows[:-1, 0], 2), acts * rows[:-1, column], atol=1e-12)
    # At rest where it began, but for the rounding of the file.
    whole = motions_of(load_case(TIED))
    for axis in "xyz":
        assert abs(whole[f"ground_{axis}"](16.0, 1)) < 1e-4
        assert abs(whole[f"ground_{axis}"](16.0)) < 1e-3
    model = model_of(case)
    assert model.ground
    assert set(model.channels) <= set(motions)


@pytest.mark.parametrize(
    ("axes", "start", "heading"),
    [
        ('["x"]', "0 deg", 0.0), ('["x", "z"]', "0 deg", 0.0), ('["z"]', "30 deg", np.pi / 6.0),
        ('["x"]', "180 deg", np.pi), ('["y"]', "90 deg", np.pi / 2.0), ('["x"]', "30 deg", None),
        ('["y"]', "0 deg", None), ('["x", "y"]', "0 deg", None),
    ],
)  # fmt: skip
def test_an_earthquake_along_the_jib_leaves_the_crane_in_its_plane(axes, start, heading):
    changes = [f"earthquake.axes={axes}", "motion.slewing.shape=rest", f"motion.slewing.start={start}"]
    case = load_case(TIED, changes)
    found = heading_of(case.checked)
    assert found == pytest.approx(heading) if heading is not None else found is None
    assert (model_of(case).axes == 2) == (heading is not None)
    if heading is None:
        return
    refused = faults_of(TIED, *changes, "accuracy.target=1e-2", 'accuracy.outputs=["base_torque"]')
    assert [fault.key for fault in refused] == ["accuracy.outputs"]


WRONG = [
    (None, [], "", ["no readable file", "named by earthquake.file"]),
    (HEADER.replace("x [m/s^2]", "x [m/s]") + REST, [], "line 1", ["column 2 (x)", "another quantity"]),
    (HEADER.replace("x [m/s^2]", "x [gal]") + REST, [], "line 1", ["column 2 (x)", "an unknown unit"]),
    (HEADER + "0,0,0,0\n1,0.5,0,0\n1,0,0,0\n", [], "line 4", ["a time after the last"]),
    (HEADER + "0,0,0,0\n1,0.5,0,0\n4,0,0,0\n5,0,0,0\n6,0,0,0\n", [], "line 4", ["evenly spaced"]),
    (HEADER + "0,0,0,0\n1,0.5,0,nan\n2,0,0,0\n", [], "line 3", ["four finite numbers"]),
    (HEADER + "0,0,0,0\n1,150,0,0\n2,0,0,0\n", [], "line 3", ["up to 50 m/s^2", "cm/s^2", "earthquake.file"]),
    (HEADER + "0,0,0,0\n", [], "", ["two or more"]),
    (HEADER + REST, [(FILE, "")], "earthquake.file", ["missing"]),
    (HEADER + REST, [(FILE, 'file = ""')], "earthquake.file", []),
    (HEADER + REST, [(FILE, 'fil = "earthquake.csv"')], "earthquake.fil", ["unknown key", '"file"']),
    (HEADER + REST, [(FILE, f"{FILE}\nfactor = 0")], "earthquake.factor", ["a plain number", "above 0"]),
    (HEADER + REST, [(FILE, f"{FILE}\nfactor = 981")], "earthquake.factor", ["% meant?"]),
    (HEADER + REST, [(FILE, f'{FILE}\naxes = ["x", "up"]')], "earthquake.axes.1", ['"x"', '"y"', '"z"', '"up"']),
    (HEADER + REST, [(FILE, f"{FILE}\naxes = []")], "earthquake.axes", ['a list of one of "x"']),
    (HEADER + REST, [(FILE, f'{FILE}\nfloors = ["floor.csv"]')], "earthquake.floors",
     ["each of 2 collars", "move with the ground"]),
    (HEADER + REST, [("[earthquake]", "[eartquake]")], "eartquake", ["unknown key", '"earthquake"']),
]  # fmt: skip


@pytest.mark.parametrize(("record", "changes", "key", "words"), WRONG)
def test_one_slip_makes_one_message(tied, record, changes, key, words):
    floor = "time [s],x [mm],y [mm]\n0,0,0\n1,4,0\n2,0,0\n"
    path = tied(record, *changes, floor=floor)
    faults = faults_of(path)
    assert [fault.key for fault in faults] == [key], "\n".join(map(str, faults))
    named = "earthquake.csv" if key.startswith("line") or not key else "case.toml"
    assert Path(faults[0].file).name == named
    assert all(word in str(faults[0]) for word in words), str(faults[0])


def test_a_record_in_g_is_in_standard_gravities(tied):
    motions = motions_of(load_case(tied(HEADER.replace("m/s^2", "g") + REST)))
    assert float(motions["ground_x"](1.0, 2)) == pytest.approx(0.5 * 9.80665)


def test_floors_are_read_in_their_units_one_for_each_collar(tied):
    floors = (FILE, f'{FILE}\nfloors = ["low.csv", "high.csv"]')
    header = "time [s],x [mm],y [mm]\n"
    low, high = header + "0,0,0\n1,4,0\n2,0,-2\n", header + "0,0,0\n1,8,0\n2,0,-4\n"
    case = load_case(tied(HEADER + REST, floors, low=low, high=high))
    motions = motions_of(case)
    assert_allclose([motions["floor_1_x"](1.0), motions["floor_2_x"](0.5)], 4e-3)
    assert_allclose(motions["floor_2_y"](9.0), -4e-3)
    assert model_of(case).floors == 2
    flat = load_case(tied(HEADER + REST, floors, low=low, high=high), ['earthquake.axes=["x"]'])
    assert motions_of(flat)["floor_1_y"].range() == (0.0, 0.0)
    far, fast = (header.replace("mm", unit) + "0,0,0\n1,8,0\n2,0,0\n" for unit in ("m", "m/s^2"))
    (fault,) = faults_of(tied(HEADER + REST, floors, low=low, high=far))
    assert fault.key == "line 3"
    assert "up to 5 m" in str(fault)
    assert "named by earthquake.floors.1" in str(fault)
    wrong = faults_of(tied(HEADER + REST, floors, low=low, high=fast))
    assert {fault.key for fault in wrong} == {"line 1"}
    assert "column 2 (x)" in str(wrong[0])


@pytest.mark.parametrize(
    ("record", "duration", "words"),
    [
        (REST, "30 s", ["ends at 2 s", "28 s", "moves on at its last velocity, x, y, z = 0.5, 0, 0 m/s"]),
        ("0,0,0,0\n1,0.5,0,0\n2,0,0,0\n3,-0.5,0,0\n4,0,0,0\n", "30 s", ["ends at 4 s", "26 s", "the ground rests"]),
        (REST, "2 s", ["leaves the ground moving", "0.5, 0, 0 m/s"]),
        (REST, "1 s", ["goes on to 2 s", "ends at 1 s", "felt up to 0.5 m/s^2", "misses up to 0 m/s^2"]),
    ],
)
def test_records_that_end_before_or_after_the_run_are_named(tied, record, duration, words):
    (said,) = table_notices(load_case(tied(HEADER + record), [f"run.duration={duration}"]))
    assert all(word in said for word in words), said


def test_small_motions_in_the_plane_foretell_no_earthquake():
    still, shaken = (
        load_case(name, changes) for name, changes in (("towers/laced", []), (TIED, ['earthquake.axes=["x"]']))
    )
    assert scene_of(still).foretells({"sway_radial"})
    assert scene_of(shaken).planar
    assert not scene_of(shaken).foretells({"sway_radial"})


def test_other_cranes_know_no_earthquake():
    (fault,) = faults_of("jib-crane/plan", "earthquake.file=earthquake.csv")
    assert fault.key == "earthquake"
