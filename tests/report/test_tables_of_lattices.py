"""What tables of lattices say: every number, beside a made-up report, and within 80 columns."""

import json

import pytest
from samples.tables import ASSUMED, said
from samples.tower_files import UNIFORM, write_case

from towercrane.cases.case import load_case
from towercrane.report.tables.lattice import WIDTH, lattice_tables
from towercrane.studies.lattice import lattice_report

ANSWERS = {"force_deflection": 1.75e-6, "moment_deflection": 9.8e-8, "frequencies_hz": [2.5, 11.5],
           "body_frequencies_hz": [0.47, 1.52]}  # fmt: skip
ERRORS = {"force_deflection": -0.0015, "moment_deflection": 0.155, "frequencies_hz": [0.0026, 0.44],
          "body_frequencies_hz": [-0.062, 0.13]}  # fmt: skip


def in_space(name, factor, last=9.0):
    frequencies = {"vertical": [2.0, 8.0], "lateral": [1.0, 4.0], "torsion": [3.0, last]}
    return {
        "name": name,
        "deflections": {"vertical": 2e-6 * factor, "lateral": 3e-6 * factor, "twist": 4e-8 * factor},
        "frequencies_hz": {kind: [f and factor * f for f in values] for kind, values in frequencies.items()},
        "seconds": 0.012,
    }


def report(*, alike=False, models=True):
    both = [{"name": name, "answers": ANSWERS, "errors": ERRORS, "seconds": 0.042} for name in ("truss", "euler")]
    models_in_space = [in_space("pinned", 1.0), in_space("rigid joints", 0.9), in_space("beam", 1.02, None)]
    lattice = {"name": "jib", "length_m": 60.0, "planes_alike": alike, "models": models_in_space}
    return {
        "name": "Some crane", "height_m": 23.8, "models": both if models else [], "lattices": [lattice], "tube": 10.0,
        "assumed": ASSUMED,
    }  # fmt: skip


@pytest.mark.usefixtures("wide")
def test_a_lattice_in_the_plane_and_in_space(capsys):
    lattice_tables(report())
    rows, lines = said(capsys)
    assert rows[:8] == [
        ["", "truss", "euler"],
        ["deflection, force [um/kN]", "1750", "-0.15"],
        ["deflection, moment [um/(kN m)]", "98", "+15.50"],
        ["f1 bare [Hz]", "2.5", "+0.26"],
        ["f2 bare [Hz]", "11.5", "+44.00"],
        ["f1 with body [Hz]", "0.47", "-6.20"],
        ["f2 with body [Hz]", "1.52", "+13.00"],
        ["time [ms]", "42.00", "42.00"],
    ]
    assert rows[8:] == [
        ["", "pinned", "rigid joints", "beam"],
        ["deflection up [um/kN]", "2000", "-10.00", "+2.00"],
        ["deflection aside [um/kN]", "3000", "-10.00", "+2.00"],
        ["twist [urad/(kN m)]", "40", "-10.00", "+2.00"],
        ["vertical f1 [Hz]", "2", "-10.00", "+2.00"],
        ["vertical f2 [Hz]", "8", "-10.00", "+2.00"],
        ["lateral f1 [Hz]", "1", "-10.00", "+2.00"],
        ["lateral f2 [Hz]", "4", "-10.00", "+2.00"],
        ["torsion f1 [Hz]", "3", "-10.00", "+2.00"],
        ["torsion f2 [Hz]", "9", "-10.00", "none"],
        ["time [ms]", "12", "12", "12"],
    ]
    assert lines[0].startswith("Some crane: lattice of 23.8 m")
    text = " ".join(" ".join(lines).split())
    assert "jib of 60 m in space" in text
    assert "round tubes 10 times as wide as their wall, which is assumed" in text


@pytest.mark.usefixtures("wide")
def test_planes_that_are_alike_are_said_once_and_a_crane_may_have_a_lattice_jib_alone(capsys):
    lattice_tables(report(alike=True, models=False))
    rows, _ = said(capsys)
    assert [row[0] for row in rows] == [
        "", "deflection [um/kN]", "twist [urad/(kN m)]", "bending f1 [Hz]", "bending f2 [Hz]", "torsion f1 [Hz]",
        "torsion f2 [Hz]", "time [ms]",
    ]  # fmt: skip


def test_tables_of_lattices_keep_to_eighty_columns(capsys):
    lattice_tables(report())
    assert max(len(line) for line in capsys.readouterr().out.splitlines()) <= WIDTH == 80


def test_a_report_has_every_lattice_of_a_case_in_space():
    found = lattice_report(load_case("qtz5613/condition-3"))
    tower, jib = found["lattices"]
    assert jib["name"] == "jib"
    assert (tower["name"], tower["planes_alike"]) == ("tower", True)
    pinned, rigid, beam = tower["models"]
    assert [model["name"] for model in tower["models"]] == ["pinned", "rigid joints", "beam"]
    plane = found["models"][0]["answers"]
    assert pinned["deflections"]["vertical"] == pytest.approx(plane["force_deflection"], rel=1e-3)
    assert pinned["frequencies_hz"]["vertical"][0] == pytest.approx(plane["frequencies_hz"][0], rel=1e-2)
    for kind in ("vertical", "torsion"):
        assert beam["frequencies_hz"][kind] == pytest.approx(pinned["frequencies_hz"][kind], rel=1.1e-2)
    assert rigid["deflections"]["twist"] < 0.97 * pinned["deflections"]["twist"]
    json.dumps(found)


def test_a_jib_stands_beside_the_beams_that_its_results_rest_on():
    found = lattice_report(load_case("flat-top/travel"))
    tower, jib = found["lattices"]
    assert (tower["name"], jib["name"], jib["planes_alike"]) == ("tower", "jib", False)
    pinned, _, beam, plane = jib["models"]
    assert plane["name"] == "in each plane"
    assert beam["frequencies_hz"]["torsion"] == pytest.approx(pinned["frequencies_hz"]["torsion"], rel=2.5e-3)
    for kind in ("vertical", "lateral"):
        assert beam["frequencies_hz"][kind] == pytest.approx(pinned["frequencies_hz"][kind], rel=2e-3)
        assert plane["frequencies_hz"][kind] == pytest.approx(pinned["frequencies_hz"][kind], rel=8e-3)
    assert plane["deflections"]["vertical"] == pytest.approx(pinned["deflections"]["vertical"], rel=3e-4)
    assert plane["deflections"]["twist"] is None
    assert plane["frequencies_hz"]["torsion"] == [None] * 3
    lattice_tables(found)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        (["crane.tower.lattice.horizontal_area=0 cm^2"], r"^crane\.tower\.lattice: .*mechanism|pins hold together"),
    ],
)
def test_a_lattice_that_is_none_is_refused_by_its_key(changes, message):
    with pytest.raises(ValueError, match=message):
        lattice_report(load_case("qtz5613/condition-3", changes))


def test_a_crane_without_members_is_refused(tmp_path):
    with pytest.raises(ValueError, match=r"^crane\.tower\.lattice: wanted all members of the tower, or of a jib"):
        lattice_report(load_case(write_case(tmp_path, UNIFORM)))


def test_heights_of_a_jib_that_do_not_meet_are_refused_by_their_key():
    changes = ["crane.jib.segments.3.lattice.height=1.2 m"]
    with pytest.raises(ValueError, match=r"^crane\.jib: LatticeJib\.parts: wanted a height of 1\.5 m"):
        lattice_report(load_case("flat-top/travel", changes))
