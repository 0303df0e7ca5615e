"""What tables of modes and linear models say: every number, beside made-up reports."""

import numpy as np
import pytest
from samples.tables import ASSUMED, said

from towercrane.report.tables.modes import linear_tables
from towercrane.report.tables.space import space_modes_tables

pytestmark = pytest.mark.usefixtures("wide")


def test_modes_in_space(capsys):
    shares = {"radial": 0.25, "torsion": 0.75}
    mode = {"kind": "lateral sway", "frequency_hz": 0.1234567, "relative_difference": 2e-4, "energy_shares": shares}
    turned = {"value": np.pi / 3.0, "frequencies_hz": [0.25, 0.5], "kinds": ["torsion", "radial sway"]}
    buckled = {"value": 4.5, "frequencies_hz": [], "kinds": [], "outcome": "tower buckled"}
    space_modes_tables(
        {
            "name": "Some crane", "at": {"trolley_position_m": 12.5, "rope_length_m": 7.5}, "payload_mass_kg": 640.0,
            "modes": [mode, {**mode, "kind": "torsion", "relative_difference": None}], "pendulum_hz": 0.1820261,
            "missing_from_the_model": [{"frequency_hz": 0.0987654, "kind": "lateral"}], "assumed": ASSUMED,
            "left_out": ["what it knows of play"],
            "sweeps": {"slewing_angle": [turned], "rope_length": [buckled]},
        }
    )  # fmt: skip
    rows, lines = said(capsys)
    assert rows[0] == ["kind", "frequency [Hz]", "more modes", "radial energy", "torsion energy"]
    assert rows[1] == ["lateral sway", "0.123457", "-2.0e-04", "25.0%", "75.0%"]
    assert rows[2] == ["torsion", "0.123457", "-", "25.0%", "75.0%"]
    assert "missing from the model: 0.098765 Hz, lateral" in lines
    assert ["60", "0.25000 T", "0.50000 RS"] in rows
    assert ["4.5", "tower buckled"] in rows
    assert lines[0] == "Some crane: small motions, trolley 12.5 m, rope 7.5 m, load 640 kg"
    assert any("swings at 0.182026 Hz" in line for line in lines)
    assert "what it knows of play" in lines


def test_a_linear_model(capsys):
    row = {
        "dominant_state": "sway_radial",
        "frequency_hz": 0.16,
        "damping_ratio": 0.0125,
        "real": -0.25,
        "imaginary": 1.5,
    }
    signals = [{"name": name, "value": 2.5, "units": "m"} for name in ("trolley", "sway_radial")]
    linear_tables(
        {
            "name": "Some crane", "states": signals, "inputs": signals[:1], "outputs": [], "left_out": [],
            "assumed": ASSUMED,
            "equilibrium": False, "about": "a state that is no equilibrium", "rope_inclination_rad": 0.0625,
            "slope": [0.5, -3.25],
            "eigenvalues": [row, {**row, "dominant_state": "trolley"},
                            {**row, "dominant_state": "creep", "imaginary": 0.0, "damping_ratio": None,
                             "real": -1e-9}],
        },
        ["trolley"],
    )  # fmt: skip
    rows, lines = said(capsys)
    assert rows[1:] == [
        ["sway radial", "0.160000", "6.2500", "0.012500", "-0.250000 +- 1.500000i"],
        ["creep", "0.160000", "", "", "0.000000"],
    ]
    assert "trolley 2.5 m" in lines[0]
    assert "2 states, 1 inputs, 0 outputs; inputs: trolley" in lines
    assert "small motions about a state that is no equilibrium" in lines[0]
    assert "the rope leans by 0.0625 rad there" in lines
    assert "there sway_radial changes by -3.25 m per second" in lines
