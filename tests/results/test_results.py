"""Results: units and provenance in the file, written whole or not at all."""

import json

import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose
from samples.qtz5613 import model, motions

from towercrane.cases.case import load_case
from towercrane.results import files as results
from towercrane.runs.run import record_case
from towercrane.simulation.simulate import record, simulate


@pytest.fixture(scope="module")
def recording():
    return record(model(2, 3), motions(), 10.0)


@pytest.fixture(scope="module")
def result(recording):
    return recording.dataset()


@pytest.mark.parametrize("name", ["qtz5613/manoeuvre", "jib-crane/plan"], ids=["axes and modes", "joints"])
def test_recording_is_written_as_its_data_set(name, tmp_path):
    case = load_case(name, ["solver.rtol=1e-4"])
    recording = record_case(case)
    labelled = recording.dataset()
    results.save(recording, tmp_path / "short.nc")
    results.save(labelled, tmp_path / "long.nc")
    short, long = (results.load(tmp_path / name) for name in ("short.nc", "long.nc"))
    xr.testing.assert_identical(short, long)
    xr.testing.assert_identical(short, labelled)
    assert list(short.variables) == list(long.variables)
    assert short["axis"].values.tolist() == ["outward", "sideways", "up"]
    assert short["fixed_axis"].values.tolist() == ["x", "y", "up"]
    assert len(short.dims) > 3
    for dimension in set(short.dims) - {"time", "axis", "fixed_axis", "joint"}:
        assert short[dimension].values.tolist() == list(range(1, short.sizes[dimension] + 1))


def test_a_turned_crane_tells_its_load_in_fixed_axes_and_in_its_own(tmp_path):
    # The trolley at 40 m of a jib that has turned by 90 degrees: 40 m along y, 40 m outward.
    turned = record_case(load_case("qtz5613/manoeuvre", ["solver.rtol=1e-4"]))
    path = tmp_path / "run.csv"
    results.save_csv(turned, path)
    lines = [line for line in path.read_text("utf-8").splitlines() if not line.startswith("#")]
    row = dict(zip(lines[0].split(","), map(float, lines[-1].split(",")), strict=True))
    places = {name: value for name, value in row.items() if name.startswith("payload")}
    assert list(places) == [
        *(f"payload_position {axis} [m]" for axis in ("x", "y", "up")),
        *(f"payload_in_crane_axes {axis} [m]" for axis in ("outward", "sideways", "up")),
    ]
    assert abs(places["payload_position x [m]"]) < 10.0 < 30.0 < places["payload_position y [m]"]
    assert abs(places["payload_in_crane_axes sideways [m]"]) < 10.0 < 30.0
    assert 30.0 < places["payload_in_crane_axes outward [m]"] < 45.0
    assert places["payload_in_crane_axes up [m]"] == places["payload_position up [m]"]
    x, y = (places[f"payload_position {axis} [m]"] for axis in "xy")
    heading = row["slewing_angle [rad]"] + row["tower_tip_twist [rad]"]
    assert_allclose(places["payload_in_crane_axes outward [m]"], x * np.cos(heading) + y * np.sin(heading), rtol=1e-9)
    assert_allclose(
        places["payload_in_crane_axes sideways [m]"], y * np.cos(heading) - x * np.sin(heading), atol=1e-8
    )


@pytest.mark.parametrize(
    ("name", "angle"), [("slewing/multi-mass/example-1", "jib_angle"), ("jib-crane/combined", "joint_angle")]
)
def test_every_crane_that_turns_tells_its_load_in_both_axes(name, angle):
    recording = record_case(load_case(name, ["run.duration=30 s", "solver.rtol=1e-4"]))
    heading = recording[angle].values.reshape(len(recording.times), -1)[:, 0]
    fixed, own = recording["payload_position"], recording["payload_in_crane_axes"]
    assert (fixed.dims, own.dims) == (("time", "fixed_axis"), ("time", "axis"))
    assert abs(heading[-1]) > 0.01
    turned = np.exp(-1j * heading) * (fixed.values[:, 0] + 1j * fixed.values[:, 1])
    assert_allclose(own.values, np.stack([turned.real, turned.imag, fixed.values[:, 2]], axis=1), atol=1e-9)
    assert "x, y, up" in fixed.long_name
    assert "turn with the crane" in own.long_name


def test_recording_reads_like_its_data_set(recording, result):
    assert "time" in recording
    assert "sway_radial" in recording
    assert "outward" not in recording
    for name in ("time", *recording.data_vars):
        assert recording[name].dims == result[name].dims
        assert recording[name].attrs == result[name].attrs
        assert np.array_equal(recording[name].values, result[name].values)
    xr.testing.assert_equal(simulate(model(2, 3), motions(), 10.0), result)


def test_every_variable_has_a_unit_and_a_name(result):
    import pint

    registry = pint.UnitRegistry()
    wanted = {
        "trolley_position", "tower_tip_displacement", "tower_tip_tilt", "jib_tip_deflection", "sway_radial",
        "hoist_rope_force", "tower_x_coordinate", "jib_vertical_coordinate", "total_energy",
    }  # fmt: skip
    assert wanted <= set(result.data_vars)
    for variable in result.data_vars.values():
        assert variable.attrs["long_name"]
        registry.parse_units(variable.attrs["units"])
        assert variable.dims[0] == "time"


def test_file_gives_back_every_number_and_the_provenance(result, tmp_path):
    path = tmp_path / "new" / "result.nc"
    results.save(result, path)
    again = results.load(path)
    for name, variable in result.data_vars.items():
        assert np.array_equal(again[name].values, variable.values)
        assert again[name].attrs["units"] == variable.attrs["units"]
    assert again.attrs["method"] == "dop853"
    assert again.attrs["outcome"] == "finished"
    assert again.attrs["wall_seconds"] > 0.0
    assert "numpy" in json.loads(again.attrs["versions"])
    assert [p.name for p in path.parent.iterdir()] == ["result.nc"]


def test_csv_has_units_in_its_header_and_the_same_numbers(recording, tmp_path):
    path = tmp_path / "result.csv"
    results.save_csv(recording, path)
    lines = path.read_text(encoding="utf-8").splitlines()
    header = next(line for line in lines if not line.startswith("#")).split(",")
    assert header[0] == "time [s]"
    assert "tower_tip_displacement [m]" in header
    assert "payload_position x [m]" in header
    table = np.loadtxt(path, delimiter=",", skiprows=sum(line.startswith("#") for line in lines) + 1)
    assert table.shape == (len(recording.times), len(header))
    assert_allclose(
        table[:, header.index("sway_radial [rad]")], recording["sway_radial"].values, rtol=1e-11, atol=1e-15
    )


def test_failed_write_leaves_the_old_file_and_no_half_one(tmp_path):
    path = tmp_path / "result.nc"
    path.write_text("old", encoding="utf-8")

    def die_half_way():
        with results.replacing(path) as temporary:
            temporary.write_text("half", encoding="utf-8")
            raise RuntimeError

    with pytest.raises(RuntimeError):
        die_half_way()
    assert path.read_text(encoding="utf-8") == "old"
    assert [p.name for p in tmp_path.iterdir()] == ["result.nc"]


def test_simulation_refuses_an_absurd_grid():
    with pytest.raises(ValueError, match="0 < step <= duration"):
        simulate(model(0, 0), motions(), 10.0, output_step=20.0)
