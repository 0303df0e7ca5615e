"""The door for case files: motions of trolley and rope, and tables of them."""

import pytest
from samples.case_files import faults_of, only_fault, with_motion

from towercrane.cases.case import CaseError, load_case
from towercrane.cases.models import motions_of
from towercrane.cases.profiles import read_points
from towercrane.cranes.tower.file.requests import modes_of

# Motions


def test_s_curve_and_delay(write):
    text = 'shape = "s-curve"\nstart = 5\nend = 20\nspeed = 0.8\nacceleration = 0.1\njerk = 0.05\ndelay = "4 s"'
    motion = motions_of(load_case(write(case_text=with_motion(text))))["trolley"]
    assert float(motion(3.9)) == 5.0
    assert float(motion(5.0, 2)) == pytest.approx(0.05)
    assert motion.end == pytest.approx(20.0)


def test_rest_is_where_the_modes_are_shown(write):
    case = load_case(write(case_text=with_motion('shape = "rest"\nstart = "7 m"')))
    assert motions_of(case)["trolley"].range() == (7.0, 7.0)
    assert modes_of(case.checked, motions_of(case)["trolley"]).trolley_positions == (7.0,)


def test_sequence_of_trolley_and_hoist(write):
    move = 'speed = "0.5 m/s", acceleration = "0.1 m/s^2"'
    text = f"""shape = "sequence"
start = "5 m"
delay = "1 s"
steps = [{{ shape = "trapezoid", end = "20 m", {move} }}, {{ shape = "rest", duration = "10 s" }},
         {{ shape = "s-curve", end = "8 m", {move}, jerk = "0.1 m/s^3", delay = "2 s" }}]
"""
    hoist = f'[motion.hoist]\nshape = "trapezoid"\nend = "20 m"\n{move.replace(", ", chr(10))}\n'
    case = load_case(write(case_text=with_motion(text, hoist)))
    trolley, rope = motions_of(case)["trolley"], motions_of(case)["rope"]
    first = 15 / 0.5 + 5
    assert float(trolley(1.0 + first + 12.0)) == pytest.approx(20.0)
    assert float(trolley(1.0 + first + 12.5)) < 20.0
    assert trolley.end == pytest.approx(8.0)
    assert trolley.range() == pytest.approx((5.0, 20.0))
    assert (float(rope(0.0)), rope.end) == (12.0, pytest.approx(20.0))


def test_table_from_csv(write, tmp_path):
    (tmp_path / "way.csv").write_text("\ufefftime,position\n0,5\n10,12.5\n\n20,20\n", "utf-8")
    case = load_case(write(case_text=with_motion('shape = "table"\nfile = "way.csv"\ndelay = 2')))
    assert float(motions_of(case)["trolley"](12.0)) == pytest.approx(12.5)
    assert motions_of(case)["trolley"].end == pytest.approx(20.0)


CSV_FAULTS = [
    ("t,x\n0,5,1\n1,6\n2,7\n", "line 2", "two columns", "3 in"),
    ("t;x\n0;5\n1;6\n", "line 2", "commas", "1 in"),
    ("t,x\n0,5\n2,6\n2,7\n", "line 4", "a time after 2", "2"),
    ("t,x\n0,5\n1,six\n", "line 3", "two finite numbers", "none in column 2"),
    ("t,x\n0,5\n1,nan\n", "line 3", "two finite numbers", "none in column 2"),
    ("t,x\n1,5\n2,6\n", "line 2", "a first time of 0", "1"),
    ("0,5\n1,6\n", "line 1", "a header line", "numbers"),
    ("", "", "a CSV file", "0 lines"),
    ("t,x\n0,5\n", "", "two or more", "1 lines"),
]


@pytest.mark.parametrize(("text", "line", "wanted", "got"), CSV_FAULTS)
def test_csv_faults_name_file_and_line(write, tmp_path, text, line, wanted, got):
    (tmp_path / "way.csv").write_text(text)
    fault = faults_of(write(case_text=with_motion('shape = "table"\nfile = "way.csv"')))[0]
    assert fault.file == str(tmp_path / "way.csv")
    assert fault.key == line
    assert wanted in str(fault)
    assert got in fault.got


def test_csv_that_is_missing_or_not_text(write, tmp_path):
    path = write(case_text=with_motion('shape = "table"\nfile = "way.csv"'))
    assert only_fault(path).file == str(tmp_path / "way.csv")
    (tmp_path / "way.csv").write_bytes(b"\xff\xfe\x00")
    assert "UTF-8" in only_fault(path).got
    assert "no readable file" in only_fault(path, r'motion.trolley.file="a\u0000b"').got


def test_csv_reports_every_faulty_line(tmp_path):
    path = tmp_path / "way.csv"
    path.write_text("t,x\n0,5\nx,6\n2,7,8\n")
    with pytest.raises(CaseError) as caught:
        read_points(path)
    assert [f.key for f in caught.value.faults] == ["line 3", "line 4"]


def test_hoist_table_begins_at_the_rope_length(write, tmp_path):
    (tmp_path / "rope.csv").write_text("t,l\n0,13\n10,15\n")
    hoist = '\n[motion.hoist]\nshape = "table"\nfile = "rope.csv"\n'
    path = write(case_text=with_motion('shape = "rest"\nstart = "7 m"', hoist))
    fault = only_fault(path)
    assert fault.key == "motion.hoist.file"
    assert "rope.length, 12 m" in fault.wanted
    assert "13 m" in fault.got
    assert motions_of(load_case(path, ["rope.length=13 m"]))["rope"].end == pytest.approx(15.0)


def test_a_table_ends_at_the_jibs_end_and_no_further(write, tmp_path):
    (tmp_path / "way.csv").write_text("t,x\n0,5\n10,39.9\n11,40\n12,40\n")
    path = write(case_text=with_motion('shape = "table"\nfile = "way.csv"'))
    assert motions_of(load_case(path))["trolley"].range() == (5.0, 40.0)
    (tmp_path / "way.csv").write_text("t,x\n0,5\n10,39.9\n11,40.5\n12,40\n")
    fault = only_fault(path)
    assert fault.key == "motion.trolley.file"
    assert "40 m" in fault.wanted
    assert fault.got == "a motion from 5 to 40.5 m"
