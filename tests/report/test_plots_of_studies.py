"""What pictures of studies draw is what the data say: bars, surfaces and shapes beside made-up studies."""

import json

import numpy as np
import xarray as xr
from numpy.testing import assert_allclose
from samples.pictures import DEGREE

from modal import Beam, EndBody, cantilever_modes
from towercrane.report.plots.runs import plane
from towercrane.report.plots.studies import sensitivity, sweep
from towercrane.studies.sensitivity import Study


def swept(**varied):
    """Sweep over all combinations; sizes of extremes are all different."""
    grid = np.meshgrid(*varied.values(), indexing="ij")
    runs = grid[0].size
    random = np.random.default_rng(5)
    order = random.permutation(runs)
    columns = {key: values.ravel()[order] for key, values in zip(varied, grid, strict=True)}
    variables = {
        "sway_radial_max": ("run", random.uniform(0.0, 0.2, runs), {"units": "rad"}),
        "sway_radial_min": ("run", random.uniform(-0.3, 0.0, runs), {"units": "rad"}),
        "hoist_rope_force_max": ("run", random.uniform(5e3, 9e3, runs), {"units": "N"}),
        "hoist_rope_force_min": ("run", random.uniform(1e3, 4e3, runs), {"units": "N"}),
        "outcome": ("run", np.where(np.arange(runs) == 2, "slack rope", "finished").astype(object)),
    }
    about = {
        key: ("run", values, {"units": "kg", "long_name": key.replace("_", " ")}) for key, values in columns.items()
    }
    attrs = {
        "varied": json.dumps([key.replace("_", ".", 1) for key in varied]),
        "outputs": json.dumps(["trolley_position", "sway_radial", "hoist_rope_force"]),
        "crane": "Some crane",
        "title": "Some title",
        "assumed": "[]",
    }
    return xr.Dataset(variables, about, attrs)


def test_a_sweep_over_one_value_is_drawn_in_its_order():
    data = swept(payload_mass=np.array([100.0, 400.0, 900.0, 1000.0]))
    figure = sweep.extremes(data)["sweep.png"]
    order = np.argsort(data["payload_mass"].values)
    early = data["outcome"].values[order] != "finished"
    for axes, name, factor, unit in zip(
        figure.axes, ("sway_radial", "hoist_rope_force"), (DEGREE, 1e-3), ("deg", "kN"), strict=True
    ):
        high, high_early, low, low_early = axes.get_lines()
        for line, marks, kind, label in ((high, high_early, "max", "largest"), (low, low_early, "min", "smallest")):
            values = factor * data[f"{name}_{kind}"].values[order]
            assert_allclose(line.get_xdata(), [100.0, 400.0, 900.0, 1000.0])
            assert_allclose(line.get_ydata(), values)
            assert_allclose(marks.get_xdata(), data["payload_mass"].values[order][early])
            assert_allclose(marks.get_ydata(), values[early])
            assert line.get_label() == label
        assert axes.get_ylabel() == f"{name.replace('_', ' ')} [{unit}]"
        assert axes.get_xlabel() == "payload mass [kg]"
    assert "crosses: 1 runs that ended early" in figure.get_suptitle()


def test_a_sweep_over_two_values_has_each_run_in_its_place():
    data = swept(payload_mass=np.array([100.0, 400.0, 900.0]), rope_length=np.array([5.0, 20.0]))
    figure = sweep.extremes(data)["sweep.png"]
    panels = [axes for axes in figure.axes if axes.collections and axes.get_xlabel()]
    for axes, name, factor in zip(panels, ("sway_radial", "hoist_rope_force"), (DEGREE, 1e-3), strict=True):
        sizes = axes.collections[0].get_array()
        assert sizes.shape == (2, 3)
        for run in range(6):
            column = [100.0, 400.0, 900.0].index(float(data["payload_mass"][run]))
            row = [5.0, 20.0].index(float(data["rope_length"][run]))
            size = max(abs(float(data[f"{name}_max"][run])), abs(float(data[f"{name}_min"][run])))
            assert_allclose(sizes[row, column], factor * size)
        (mark,) = axes.get_lines()
        assert_allclose([mark.get_xdata()[0], mark.get_ydata()[0]], [data["payload_mass"][2], data["rope_length"][2]])
    bars = [axes for axes in figure.axes if axes not in panels]
    figure.canvas.draw()
    assert [bar.get_ylabel() for bar in bars] == [
        "largest size of sway radial [deg]",
        "largest size of hoist rope force [kN]",
    ]
    assert all(not bar.yaxis.get_offset_text().get_text() for bar in bars)


def test_influence_is_drawn_as_bars_and_surfaces():
    names, outputs = ["first_one", "second_one"], ["sway_radial", "drive_torque"]
    values = np.random.default_rng(2).uniform(-1.0, 1.0, (2, 2, 3, 5))
    near = [{"sway_radial": 0.31, "drive_torque": 0.02}, {"sway_radial": 0.0, "drive_torque": 1.7}]
    data = xr.Dataset(
        {name: (("parameter", "percent", "time"), values[k], {"units": unit})
         for k, (name, unit) in enumerate(zip(outputs, ("rad", "N m"), strict=True))},
        {"parameter": names, "percent": [50.0, 100.0, 150.0], "time": np.arange(5.0)},
        {"crane": "Some crane"},
    )  # fmt: skip
    influence = [{"parameter": name, "near": sizes} for name, sizes in zip(names, near, strict=True)]
    study = Study(data=data, influence=influence, members=[], reduced={}, ended=[], degrees_of_freedom=10)
    (axes,) = sensitivity.ranking(study).axes
    assert [text.get_text() for text in axes.get_yticklabels()] == ["first one", "second one"]
    assert axes.yaxis_inverted()
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["sway radial", "drive torque"]
    for k, (bars, output) in enumerate(zip(axes.containers, outputs, strict=True)):
        assert_allclose([bar.get_width() for bar in bars], [max(100.0 * sizes[output], 1e-3) for sizes in near])
        # Of two bars one is above the parameter's name, one below.
        centres = [bar.get_y() + 0.5 * bar.get_height() for bar in bars]
        assert_allclose(centres, np.arange(2) + (-0.2, 0.2)[k])
        assert all(bar.get_width() < axes.get_xlim()[1] for bar in bars)
    figure = sensitivity.surface(data, "second_one")
    panels = [axes for axes in figure.axes if "nominal" in axes.get_ylabel()]
    for k, (axes, factor) in enumerate(zip(panels, (DEGREE, 1.0), strict=True)):
        shown = factor * (values[k, 1] - values[k, 1][:, :1])
        mesh = axes.collections[0]
        assert_allclose(mesh.get_array(), shown)
        assert_allclose(mesh.get_clim(), (-abs(shown).max(), abs(shown).max()))
    assert "second one" in figure.get_suptitle()


def test_mode_shapes_stand_and_lie_as_their_beams_do():
    tower = cantilever_modes(Beam(20.0, 300.0, 2e11, 0.01), 8, EndBody(2e4, 5e6))
    arm = cantilever_modes(Beam(50.0, 100.0, 2e11, 0.003), 3)
    left, right, last = plane.modes(tower, arm, [], arm).axes
    assert len(plane.modes(tower, arm, []).axes) == 2
    for axes, shapes, upright, zeros in ((left, tower, True, 1), (right, arm, False, 1), (last, arm, False, 1)):
        lines = axes.get_lines()[:-zeros]
        assert len(lines) == min(len(shapes.frequencies_hz), plane.MOST_SHAPES)
        for i, line in enumerate(lines):
            across, along = (line.get_xdata(), line.get_ydata())[:: 1 if upright else -1]
            assert_allclose(along[[0, -1]], [0.0, shapes.length])
            whole = shapes(along)[i]
            assert_allclose(across, whole / abs(whole).max(), atol=1e-12)
            assert line.get_label() == f"mode {i + 1}: {shapes.frequencies_hz[i]:.4g} Hz"
