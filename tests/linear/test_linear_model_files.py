"""Linear models as files and on the command line, and the differences that they are made of."""

import json

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples.program import towercrane
from samples.qtz5613 import model, standing
from scipy.io import loadmat

from towercrane import load_case
from towercrane.linear.linearise import linearise
from towercrane.linear.statespace import OperatingPoint, Signal, StateSpace
from towercrane.motions.motion import rest
from towercrane.simulation.differences import jacobian
from towercrane.studies.linear_report import linear_model

# --- differences ---------------------------------------------------------------------------------------


def test_derivatives_of_smooth_sharp_and_kinked_functions():
    def function(x):
        u, v = x
        return np.array(
            [np.exp(u), u**7 + v, np.tanh(v / 0.01), abs(v) * v + 3 * v, np.maximum(v, 0.0), 1e6 * np.sin(u)]
        )

    values, errors = jacobian(function, np.array([1.0, 0.0]), np.array([1.0, 1.0]))
    expected = [[np.e, 0], [7, 1], [0, 100], [0, 3], [0, 0.5], [1e6 * np.cos(1), 0]]
    assert_allclose(values, expected, rtol=1e-10, atol=1e-12)
    assert np.all(abs(values - expected) <= 100 * errors + 1e-11 * np.max(np.abs(expected), axis=1)[:, None])


def test_a_slope_as_narrow_as_the_smallest_steps_is_resolved():
    width, at = 5e-5, 1.5e-5
    values, _ = jacobian(lambda x: np.tanh(x / width), np.array([at]), np.array([1.0]))
    assert_allclose(values, [[(1.0 - np.tanh(at / width) ** 2) / width]], rtol=3e-8)


# --- files and wrong arguments -------------------------------------------------------------------------


@pytest.fixture(scope="module")
def linear():
    return linearise(model(1, 1), standing(20.0, 18.0))


@pytest.mark.parametrize("ending", [".mat", ".npz"])
def test_saved_file_is_read_back(linear, tmp_path, ending):
    path = tmp_path / f"crane{ending}"
    linear.save(path)
    assert [p.name for p in tmp_path.iterdir()] == [path.name]
    read = loadmat(path, squeeze_me=True) if ending == ".mat" else np.load(path)
    for name in "ABCD":
        assert_allclose(read[name], getattr(linear, name.lower()), rtol=0)
    for kind in ("states", "inputs", "outputs"):
        assert read[kind].tolist() == [signal.name for signal in getattr(linear, kind)]
        assert read[f"{kind[:-1]}_units"].tolist() == [signal.units for signal in getattr(linear, kind)]
    assert_allclose(read["x0"], linear.point.states, rtol=0)
    assert_allclose(read["y0"], linear.point.outputs, rtol=0)
    assert_allclose(read["slope"], linear.point.slope, rtol=0)


def test_a_file_that_cannot_be_written_leaves_the_old_one(linear, tmp_path, monkeypatch):
    path = tmp_path / "crane.npz"
    path.write_bytes(b"old")

    def fail(file, **_):
        file.write(b"half")
        raise OSError("disk full")

    monkeypatch.setattr(np, "savez", fail)
    with pytest.raises(OSError, match="disk full"):
        linear.save(path)
    assert [(p.name, p.read_bytes()) for p in tmp_path.iterdir()] == [("crane.npz", b"old")]
    with pytest.raises(ValueError, match=r"\.mat or \.npz"):
        linear.save(tmp_path / "crane.txt")


def test_eigenvalues_of_a_given_matrix():
    def states(matrix, *called):
        n, nothing = len(called), np.empty(0)
        point = OperatingPoint(nothing, nothing, nothing, nothing, nothing)
        signals = tuple(Signal(name, "") for name in called)
        return StateSpace(
            np.array(matrix), np.zeros((n, 0)), np.zeros((0, n)), np.zeros((0, 0)), signals, (), (), point
        )

    oscillator = states([[0.0, 1.0, 0.0], [-4.0, -0.4, 0.0], [0.0, 0.0, -3.0]], "x", "x_rate", "lag")
    pair, real = oscillator.eigenvalues()
    assert_allclose([pair.frequency, pair.damping_ratio], [1 / np.pi, 0.1], rtol=1e-12)
    assert (pair.state, real.state, real.value, real.damping_ratio) == ("x", "lag", -3.0, 1.0)
    assert_allclose(oscillator.frequencies, [1 / np.pi])
    assert states([[2.0]], "fall").eigenvalues()[0].damping_ratio == -1.0
    with pytest.raises(ValueError, match=r"StateSpace\.a: wanted shape \(1, 1\)"):
        states([[1.0, 2.0]], "x")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"inputs": "force"}, "inputs: wanted 'acceleration' or 'motion', got 'force'"),
        ({"outputs": ["sing_angle"]}, "outputs: 'sing_angle' is none of trolley_position"),
        ({"state": np.zeros(3)}, r"state: wanted shape \(5,\), got \(3,\)"),
        ({"turning": "trolley"}, "turning: wanted a load that swings in space"),
        ({"motions": {"trolley": rest(1.0)}}, "motions: wanted trolley, rope; 'rope' is missing"),
        ({"motions": np.zeros((1, 3))}, "motions: wanted a row for each"),
    ],
)
def test_wrong_arguments_are_named(change, message):
    motions = change.pop("motions", standing(20.0, 18.0))
    with pytest.raises(ValueError, match=message):
        linearise(model(0, 0), motions, **change)


# --- the command ---------------------------------------------------------------------------------------


FEW = ["model.tower_modes=1", "model.jib_vertical_modes=1"]
SET = [part for change in FEW for part in ("--set", change)]


def test_command_prints_writes_and_says_what_is_next(tmp_path):
    options = ("--at", "20", "--out", "out/crane.mat", *SET)
    done = towercrane("linearise", "qtz5613/condition-3", *options, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    linear = linear_model(load_case("qtz5613/condition-3", FEW), 20.0)
    assert "trolley 17.8 m, rope 18 m" in done.stdout
    for frequency in linear.frequencies:
        assert f" {frequency:.6f} " in done.stdout
    assert "sway outward" in done.stdout
    assert "│ trolley " not in done.stdout  # a drive is no motion of the crane
    assert "-0.000000" not in done.stdout
    assert done.stdout.splitlines()[-2:] == [
        "written to out/crane.mat",
        f"next: towercrane run qtz5613/condition-3 {' '.join(SET)}",
    ]
    assert_allclose(loadmat(tmp_path / "out" / "crane.mat")["A"], linear.a, rtol=1e-12, atol=1e-12)


def test_command_in_json(tmp_path):
    done = towercrane("linearise", "qtz5613/condition-3", "--json", *SET, cwd=tmp_path)
    report = json.loads(done.stdout)
    assert report["states"][0] == {
        "name": "tower_x_mode_1",
        "units": "kg^0.5 m",
        "value": report["states"][0]["value"],
    }
    assert np.shape(report["A"]) == (10, 10)
    assert [e["damping_ratio"] for e in report["eigenvalues"][:4]] == [None] * 4
    assert_allclose(report["eigenvalues"][4]["frequency_hz"], 0.1174, atol=1e-4)
    assert list(tmp_path.iterdir()) == []


def test_command_refuses_what_it_cannot_do(tmp_path):
    done = towercrane("linearise", "qtz5613/condition-3", "--out", "crane.txt", cwd=tmp_path)
    assert (done.returncode, done.stderr) == (2, "--out crane.txt: wanted a file that ends in .mat or .npz\n")
    assert towercrane("linearise", "qtz5613/condition-3", "--at", "nan", cwd=tmp_path).returncode == 2
    soft = ("--set", "model.weight_softening=true", "--set", "crane.tower.second_moment_of_area=0.0002 m^4")
    done = towercrane("linearise", "qtz5613/condition-3", *soft, cwd=tmp_path)
    assert done.returncode == 3, done.stderr
    assert "tower buckled" in done.stderr
