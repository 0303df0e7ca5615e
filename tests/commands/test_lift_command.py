"""The command `lift`: files, table, classes of another standard; what it cannot lift is one message."""

import json

import pytest

from towercrane.commands.loads.lift import lift as command

NONE = dict.fromkeys(
    ("speeds", "positions", "slack", "acceleration", "creep", "classes", "standard", "out", "changes")
) | {"window": 10.0}
SMALL = ["model.tower_modes=1", "model.jib_vertical_modes=1", "model.jib_vertical_damping_ratio=0.02"]


def refused(capsys, case, **options):
    with pytest.raises(SystemExit) as ended:
        command(case, **NONE | options)
    assert ended.value.code == 2
    said = capsys.readouterr().err
    return said.splitlines()[-1]


def test_a_study_in_files_and_tables(tmp_path, capsys):
    own = ["ours=1.5,1", "wild=3,2"]
    asked = NONE | {"speeds": "0.2 m/s,0.5", "positions": "40", "window": 4.0, "creep": 0.0, "classes": own}
    command("qtz5613/lift-off", **asked | {"out": tmp_path, "changes": SMALL, "standard": "our own"})
    table = capsys.readouterr().out
    assert {path.name for path in tmp_path.iterdir()} == {"lift.json", "lift.png"}
    report = json.loads((tmp_path / "lift.json").read_text())
    assert report["window_s"] == 4.0
    assert report["structural_damping"] == {"jib_vertical_damping_ratio": 0.02}
    assert (report["standard"], list(report["hoisting_classes"])) == ("our own", ["ours", "wild"])
    assert [row["speed_m_s"] for row in report["runs"]] == [0.2, 0.5]
    for row in report["runs"]:
        assert row["classes"] == {"ours": 1.5 + row["speed_m_s"], "wild": 3.0 + 2.0 * row["speed_m_s"]}
        assert row["class_that_covers_the_rope"] == "ours"
        assert set(row["dynamic_factor"]) == {"rope", "base", "jib_root"}
    lines = table.splitlines()
    assert max(len(line) for line in lines if not line.startswith(("written to", "next:"))) <= 80
    words = " ".join(table.split())
    assert "within 4 s after lift-off" in words
    assert "damping ratios jib vertical 0.02; relaxation time of the rope 3 ms" in words
    assert f"{report['runs'][0]['dynamic_factor']['rope']['value']:.3f}" in table
    assert lines[-1].startswith("next: towercrane run qtz5613/lift-off --set model.tower_modes=1")
    assert lines[-1].endswith("--set motion.trolley.start=40")


@pytest.mark.parametrize(("case", "options", "words"), [
    ("qtz5613/condition-3", {}, "rope.stiffness: wanted a rope that stretches and goes slack"),
    ("qtz5613/lift-off", {"speeds": "0.5,-1"}, "speeds: wanted values above 0 m/s, got -1 m/s"),
    ("qtz5613/lift-off", {"speeds": "fast"}, '--speeds fast: wanted a speed, such as "0.8 m/s"'),
    ("qtz5613/lift-off", {"positions": "60"}, "positions: wanted places on the jib, up to 55.6 m, got 60 m"),
    ("qtz5613/lift-off", {"positions": "0"}, "positions: wanted values above 0 m, got 0 m"),
    ("qtz5613/lift-off", {"window": 60.0}, "window: wanted one within which 18 m of rope are not hauled in, got 60"),
    ("qtz5613/lift-off", {"window": float("nan")}, "window: wanted a number above 0, got nan"),
    ("qtz5613/lift-off", {"acceleration": 0.0}, "acceleration: wanted a number above 0, got 0"),
    ("qtz5613/lift-off", {"slack": -0.1}, "slack: wanted a number from 0, got -0.1"),
    ("qtz5613/lift-off", {"classes": ["HC1=1.05"]}, "--class HC1=1.05: wanted NAME=PHI2MIN,BETA2"),
    ("qtz5613/lift-off", {"classes": ["HC1=0.9,0.1"]}, "--class: classes: wanted phi2min from 1"),
    ("qtz5613/lift-off", {"standard": "ours"}, "--standard ours: wanted classes"),
    ("qtz5613/lift-off", {"changes": ['motion.hoist={shape="rest"}']}, "speeds: wanted some, for the case's hoist"),
    ("luffing/manoeuvre", {"changes": ["rope.stiffness=14 MN"]}, "the jib pivots"),
    ("qtz5613/weathervane", {"changes": ["rope.stiffness=14 MN"]}, "the head is free to turn"),
    ("qtz5613/turbulence", {"changes": ["rope.stiffness=14 MN"]}, "wind: wanted still air"),
    ("qtz5613/release", {"speeds": "0.5"}, "release: wanted a load that stays whole"),
    ("qtz5613/hook-and-slings", {"changes": ["rope.stiffness=14 MN"], "speeds": "0.5"}, "hook: wanted a load on"),
    ("overhead-crane/hoist", {}, "a crane of kind 'overhead' has no trolley on a jib"),
])  # fmt: skip
def test_what_cannot_be_lifted_is_refused(case, options, words, tmp_path, capsys):
    assert words in refused(capsys, case, out=tmp_path / "out", **options)
    assert not (tmp_path / "out").exists()
