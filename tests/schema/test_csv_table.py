"""The reader of CSV tables: units and order by the header, times, what is refused, what is said of a run."""

import json
import os

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples.case_files import RADIAL, only_fault
from scipy.signal import savgol_filter

from towercrane.cases.case import CaseError, load_case
from towercrane.cases.models import motions_of
from towercrane.cases.table_notices import scatter, table_notices
from towercrane.cases.wind_file import read_gusts
from towercrane.motions.profiles import table, trapezoid
from towercrane.runs.run import record_case
from towercrane.runs.summary import summarise
from towercrane.schema.csv_table import MOST_BYTES, MOST_ROWS, TIME, Column, read_table

ANGLE, PARKED, SLEWING = (TIME, Column("value", "rad")), "qtz5613/gusts-parked", "qtz5613/slewing"


def written(folder, text: str | bytes):
    path = folder / "table.csv"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def table_of(channel: str, path) -> str:
    return f'motion.{channel}={{shape="table", file="{path}"}}'


READ = [
    ("time [s],slew [deg]\n0,0\n40,45\n", [[0, 0], [40, np.pi / 4]]),
    ("time [min],slew [°]\n0,0\n1.5,90\n", [[0, 0], [90, np.pi / 2]]),
    ("time,slew\n0,0\n40,0.5\n", [[0, 0], [40, 0.5]]),
    ("Time (ms),slew (rev)\n0,0\n40,0.5\n", [[0, 0], [0.04, np.pi]]),
    ("slew [deg],t [s]\n0,0\n90,40\n", [[0, 0], [40, np.pi / 2]]),
    ('\ufeff"time [s]","slew [deg]"\r\n"0",0\r\n\r\n 40 , 90 \r\n', [[0, 0], [40, np.pi / 2]]),
    ("# of a run\ntime [s],slew [rad]\n# begin\n0,0\n1e1,-.5\n", [[0, 0], [10, -0.5]]),
]


@pytest.mark.parametrize(("text", "expected"), READ)
def test_units_and_order_are_those_of_the_header(tmp_path, text, expected):
    assert_allclose(read_table(written(tmp_path, text), ANGLE).values, expected, rtol=1e-14)


REFUSED = [
    ("time [s],slew [dge]\n0,0\n40,9\n", "line 1", "column 2 (value): an angle", "an unknown unit", "mrad, deg, rev"),
    ("time [s],slew [mm]\n0,0\n40,9\n", "line 1", "column 2 (value): an angle", "another quantity", "known units"),
    ("time [s],slew []\n0,0\n40,9\n", "line 1", "column 2 (value)", "an empty unit", "known units"),
    ("time [deg],slew [deg]\n0,0\n40,9\n", "line 1", "column 1 (time): a time", "another quantity", "known units"),
    ("slew [deg],zeit [s]\n0,0\n40,9\n", "line 1", "column 1 (time): a time", "another quantity", ""),
    ("time,slew_deg\n0,0\n40,9\n", "line 1", "column 2 (value)", "without brackets", "time [s]"),
    ("time,slew in degrees\n0,0\n40,9\n", "line 1", "column 2 (value)", "without brackets", "time [s]"),
    ("time,time\n0,0\n40,9\n", "line 1", "two columns", "time twice", "once"),
    ("time,slew,rate\n0,0\n40,9\n", "line 1", "two columns", "3 in", ""),
    ("time,slew\n0,0,1\n40,9,1\n", "line 2", "two columns", "3 in", ""),
    ("time;slew\n0;0,5\n40;9,5\n", "line 2", "two columns", "column 1", "columns are parted by commas"),
    ("time,slew\n0,0\n1,5,0,5\n", "line 3", "two columns", "4 in", "decimal sign is a point"),
    ("time,slew\n0,0\n1,inf\n", "line 3", "finite numbers", "none in column 2", ""),
    ("time,slew\n0,0\n1,\n", "line 3", "finite numbers", "none in column 2", ""),
    ("time,slew\n0,0\n1,1\n1,2\n", "line 4", "a time after the last", "1", "after 1"),
    ("time,slew\n0,0\n2,1\n1,2\n", "line 4", "a time after the last", "1", "after 2"),
    ("time,slew\n1,0\n2,1\n", "line 2", "a first time of 0", "1", ""),
    ("time,slew\n", "", "a CSV file", "0 lines", "two or more"),
    ("", "", "a CSV file", "0 lines", "two or more"),
    (b"\xff\xfe\x00", "", "a CSV file", "not UTF-8", "UTF-8"),
    ("time,slew\n" + "0,0\n" * (MOST_ROWS + 1), "", f"at most {MOST_ROWS}", "lines", "tenth"),
    ("time,slew\n" + "0," + "0" * MOST_BYTES + "\n", "", "at most 8 MB", "larger", ""),
]  # fmt: skip


@pytest.mark.parametrize(("text", "line", "wanted", "got", "hint"), REFUSED, ids=range(len(REFUSED)))
def test_a_slip_is_named_by_its_line_and_nothing_is_read(tmp_path, text, line, wanted, got, hint):
    path = written(tmp_path, text)
    with pytest.raises(CaseError) as caught:
        read_table(path, ANGLE)
    first = caught.value.faults[0]
    assert (first.file, first.key) == (str(path), line)
    assert wanted in first.wanted
    assert got in first.got
    assert hint in first.hint


def test_devices_and_pipes_are_not_opened(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    for path in ("/dev/zero", tmp_path / "pipe", tmp_path):
        fault = only_fault(SLEWING, table_of("slewing", path))
        assert fault.file == str(path)
        assert fault.got == "a folder, a device or a pipe"


SECRET = "root:x:0:0:secret:/root\nother,secret [secret]\n1,secret\nsecret = secret\n"


@pytest.mark.parametrize(
    "text", [SECRET, "secret [secret],t\n0,0\n1,1\n", "[secret]\nsecret = 1\n", "[secret]\nsecret = secret\n",
             "[secret]\n[secret]\n", "secret.a = 1\nsecret = 2\n"],
)  # fmt: skip
def test_of_a_file_that_is_no_case_nothing_is_quoted(tmp_path, text):
    path = written(tmp_path, text)
    for case, changes in [
        (RADIAL, [table_of("trolley", path)]),
        (RADIAL, [f"crane={path}"]),
        (path, []),
        (PARKED, [f"wind.series={path}"]),
    ]:
        with pytest.raises(CaseError) as caught:
            load_case(case, changes)
        assert all(str(path) in fault.file for fault in caught.value.faults)
        assert "secret" not in str(caught.value)
        assert "root" not in str(caught.value).replace(str(tmp_path), "")


# --- turns ---------------------------------------------------------------------------------------------


def test_a_turn_in_degrees_is_read_and_one_that_no_tower_crane_makes_refused(tmp_path):
    turn = "time [s],slew [{}]\n0,0\n20,25\n40,45\n"
    motion = motions_of(load_case(SLEWING, [table_of("slewing", written(tmp_path, turn.format("deg")))]))["slewing"]
    assert_allclose(motion.range(), (0.0, np.pi / 4), rtol=1e-14)
    fault = only_fault(SLEWING, table_of("slewing", written(tmp_path, turn.format("rad"))))
    assert (fault.key, fault.wanted) == ("motion.slewing.file", "speeds up to 0.5 rad/s")
    assert "radians?" in fault.hint
    slow = only_fault(SLEWING, table_of("slewing", written(tmp_path, "t,a\n0,0\n2000,360\n")))
    assert slow.wanted == "angles up to 100 rad"
    assert slow.got == "a motion from 0 to 360 rad"


# --- gusts ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize("decimals", [3, 6])
def test_gusts_at_thirty_a_second_are_read_by_their_own_times(tmp_path, decimals):
    rows = [f"{k / 30:.{decimals}f},{8 + np.sin(k):.3f},{k % 7},0.5" for k in range(4000)]
    path = written(tmp_path, "time [s],x [m/s],y [km/h],z [m/s]\n" + "\n".join(rows) + "\n")
    times, velocities = read_gusts(path)
    assert_allclose(times, np.round(np.arange(4000) / 30, decimals), rtol=1e-15)
    assert_allclose(velocities[:, 1], (np.arange(4000) % 7) / 3.6, rtol=1e-14)
    case = load_case(PARKED, [f"wind.series={path}"])
    assert_allclose(motions_of(case)["wind_x"](times), velocities[:, 0], rtol=1e-12)
    gap = written(tmp_path, "t,x,y,z\n" + "\n".join(rows[:700] + rows[701:]) + "\n")
    fault = only_fault(PARKED, f"wind.series={gap}")
    assert fault.key == "line 702"
    assert fault.wanted == "the time 23.3333 s, evenly spaced from 0"


def test_gusts_in_other_columns_and_too_strong_ones(tmp_path):
    path = written(tmp_path, "time,z [m/s],y,x [km/h]\n0,1,2,36\n1,0,0,72\n")
    assert_allclose(read_gusts(path)[1], [[10, 2, 1], [20, 0, 0]], rtol=1e-14)
    strong = written(tmp_path, "t,x,y,z\n0,1,2,3\n1,0,90,0\n")
    fault = only_fault(PARKED, f"wind.series={strong}")
    assert (fault.key, fault.wanted) == ("line 3", "components up to 80 m/s")


def test_a_record_that_ends_before_the_run_is_named(tmp_path):
    path = written(tmp_path, "t,x,y,z\n0,0,36,0\n1,0,38,0\n2,0,40,0\n")
    case = load_case(PARKED, [f"wind.series={path}", "run.duration=3 s"])
    (notice,) = table_notices(case)
    assert "the record ends at 2 s; in the 1 s" in notice
    assert "x, y, z = 0, 40, 0 m/s" in notice
    result = record_case(case)
    assert json.loads(result.attrs["notices"]) == [notice]
    assert notice in summarise(case, result)["notices"]
    assert table_notices(load_case(PARKED, [f"wind.series={path}", "run.duration=2 s"])) == ()
    assert table_notices(load_case(PARKED)) == ()


# --- motions -------------------------------------------------------------------------------------------


def test_a_hoist_runs_between_its_points_only(tmp_path):
    text = "t,l\n0,18\n50,18\n51,17.95\n52,17.9\n120,17.9\n"
    case = load_case(RADIAL, [table_of("hoist", written(tmp_path, text))])
    assert motions_of(case)["rope"].range() == (17.9, 18.0)
    assert_allclose(motions_of(case)["rope"]([50.0, 51.0, 52.0, 70.0]), [18.0, 17.95, 17.9, 17.9], rtol=1e-15)


@pytest.mark.parametrize(("decimals", "named"), [(1, True), (2, True), (5, False)])
def test_rounding_that_the_drive_feels_is_named_with_a_smoothing_that_mends_it(tmp_path, decimals, named):
    true, times = trapezoid(18.0, 8.0, 0.4713, 0.2), np.arange(0.0, 26.0, 0.1)
    values = np.round(true(times), decimals)
    rows = "\n".join(f"{t:.1f},{v:.{decimals}f}" for t, v in zip(times, values, strict=True))
    case = load_case(RADIAL, [table_of("hoist", written(tmp_path, f"t,l\n{rows}\n"))])
    assert bool(table_notices(case)) == named
    step, size = scatter(motions_of(case)["rope"])
    assert_allclose(step, 0.1)
    assert size < 1.6 * 10.0**-decimals / np.sqrt(12.0)
    if not named:
        assert size < 1e-5
        return
    (notice,) = table_notices(case)
    assert size > 0.7 * 10.0**-decimals / np.sqrt(12.0)
    span = float(notice.split("each point over ")[1].split(" s")[0])
    count = 2 * round(span / step / 2) + 1
    smooth = savgol_filter(values, count, 2)
    acceleration = savgol_filter(values, count, 2, deriv=2, delta=step)
    inner = slice(count, -count)
    assert np.std((acceleration - true(times, 2))[inner]) < 0.1
    assert abs(smooth - true(times))[inner].max() < 2 * 10.0**-decimals


def test_scatter_of_noise_is_its_standard_deviation_and_of_smooth_ways_none():
    rng, times = np.random.default_rng(3), np.arange(0.0, 60.0, 0.2)
    noisy = table(times, 10.0 + 3e-3 * rng.normal(size=len(times)))
    assert_allclose(scatter(noisy)[1], 3e-3, rtol=0.15)
    for smooth in (np.sin(0.3 * times), np.exp(-times), trapezoid(0.0, 20.0, 0.5, 0.2)(times)):
        assert scatter(table(times, smooth))[1] < 1e-9
