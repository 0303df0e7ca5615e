"""The door for what a case asks of its answers: accuracy of frequencies, and the map."""

import pytest
from samples.case_files import faults_of
from samples.tower_files import CASE, UNIFORM

from towercrane.cases.case import load_case
from towercrane.cranes.tower.file.requests import map_of


def test_accuracy_and_map_have_defaults(write_tower):
    case = load_case(write_tower(UNIFORM))
    assert case.checked.accuracy.frequency is None
    positions = map_of(case.checked).trolley_positions
    assert (len(positions), positions[0], positions[-1]) == (50, 0.0, 40.0)
    assert positions[7] == pytest.approx(40.0 * 7 / 49)
    assert map_of(case.checked).payload_masses == (400.0, 800.0, 1600.0)


def test_accuracy_and_map_as_written(write_tower):
    tables = '[accuracy]\nfrequency = "0.1 %"\n[map]\nposition_count = 3\npayload_masses = ["0.5 t", 900]\n'
    case = load_case(write_tower(UNIFORM, case=CASE + tables))
    assert case.checked.accuracy.frequency == pytest.approx(1e-3)
    assert map_of(case.checked).trolley_positions == (0.0, 20.0, 40.0)
    assert map_of(case.checked).payload_masses == (500.0, 900.0)
    changed = load_case(case.path, ['map.trolley_positions=["3 m", 40]'])
    assert map_of(changed.checked).trolley_positions == (3.0, 40.0)


@pytest.mark.parametrize("name", ["map", "accuracy"])
def test_slewing_cranes_have_neither(name):
    assert not hasattr(load_case("slewing/basic/example-1").checked, name)


@pytest.mark.parametrize(
    ("override", "key", "words"),
    [
        ("accuracy.frequency=0.9e-9", "accuracy.frequency", ["from 1e-09 to 0.1", "9e-10"]),
        ("accuracy.frequency=0.11", "accuracy.frequency", ["from 1e-09 to 0.1", "0.11"]),
        ("accuracy.frequency=1 Hz", "accuracy.frequency", ["a plain number"]),
        ("accuracy.freqency=1e-3", "accuracy.freqency", ["unknown key", '"frequency"']),
        ("map.position_count=1", "map.position_count", ["from 2 to 1000"]),
        ("map.position_count=1001", "map.position_count", ["from 2 to 1000"]),
        ("map.trolley_positions=[5, 41]", "map.trolley_positions.1", ["40 m", "41", "leaves the jib"]),
        ("map.payload_masses=[0]", "map.payload_masses.0", ["a mass", "above 0"]),
        ("map.payload_masses=[0.8]", "map.payload_masses.0", ["1 to 1e+06 kg", "t meant?"]),
        ("map.payload_masses=800", "map.payload_masses", ["a list"]),
    ],
)
def test_faults_of_accuracy_and_map(write_tower, override, key, words):
    (fault,) = faults_of(write_tower(UNIFORM), override)
    assert fault.key == key
    assert all(word in str(fault) for word in words)


@pytest.mark.parametrize("override", [
    "accuracy.frequency=1e-9", "accuracy.frequency=0.1", "map.position_count=2", "map.position_count=1000",
    "map.trolley_positions=[0, 40]", "map.payload_masses=[1]",
])  # fmt: skip
def test_limits_of_accuracy_and_map_may_be_reached(write_tower, override):
    load_case(write_tower(UNIFORM), [override])
