"""What pictures draw is what the data say: every line's data, marks and labels beside made-up runs."""

import json

import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose, assert_array_equal

from modal import Beam, EndBody, cantilever_modes
from towercrane.report.plots import style
from towercrane.report.plots.runs import jib, radial, slewing, space
from towercrane.report.plots.studies import sensitivity, sweep
from towercrane.results.recording import Quantity, Recording
from towercrane.results.spectrum import amplitude_spectrum
from towercrane.studies.sensitivity import Study

ROWS = 90
TIMES = np.cumsum(np.random.default_rng(3).uniform(0.05, 0.15, ROWS))
DEGREE = 180.0 / np.pi

UNITS = {"deg": DEGREE, "mm": 1e3, "kN": 1e-3, "kN m": 1e-3, "mrad": 1e3, "deg/s": DEGREE}
"""Factor from SI of the unit that a label names; of others it is one."""


def made(names, seed=1, **attrs):
    """A run whose every value is different; names of vectors end in ``:`` and their dimension."""
    random, found = np.random.default_rng(seed), {}
    for k, name in enumerate(names):
        name, _, dimension = name.partition(":")
        shape = (ROWS, 3) if dimension else (ROWS,)
        values = (k + 2.0) * random.uniform(0.1, 1.0, shape) * (-1.0) ** k
        found[name] = Quantity(("time", dimension) if dimension else ("time",), values, "1", f"what {name} is")
    about = {"crane": "Some crane", "case": "folder/some-case", "payload_mass": 777.0, "outcome": "finished",
             "end_time": TIMES[-1], "assumed": json.dumps([["a.key", "3 m", "why"]])}  # fmt: skip
    return Recording(TIMES, found, {**about, **attrs}).dataset()


RADIAL = made(
    ["trolley_position", "trolley_speed", "rope_length", "swing_angle", "swing_rate", "tower_tip_displacement",
     "jib_tip_deflection", "rope_tension"]
)  # fmt: skip
SLEWING = made(
    ["shaft_speed", "rope_length", "sway_tangential", "sway_radial", "jib_moment_horizontal", "jib_moment_vertical",
     "drive_torque", "drive_torque_elastic", "rope_tension", "platform_angle", "shaft_angle", "payload_position:axis"]
)  # fmt: skip
SPACE = made(
    ["slewing_angle", "shaft_angle", "trolley_position", "rope_length", "sway_radial", "sway_tangential",
     "slewing_torque", "trolley_force", "rope_tension", "tower_tip_displacement", "tower_tip_displacement_sideways",
     "tower_tip_twist", "tower_tip_tilt", "tower_tip_roll", "jib_tip_deflection", "jib_tip_deflection_sideways",
     "jib_root_moment", "jib_root_moment_sideways", "base_moment_x", "base_moment_y", "base_torque",
     "wind_x", "wind_y", "wind_z", "payload_position:axis"]
)  # fmt: skip
JIB = made(
    ["joint_angle:joint", "rope_length", "sway_in_plane", "sway_lateral", "joint_torque:joint", "rope_tension",
     "payload_position:axis"]
)  # fmt: skip


def unit_of(axes):
    return axes.get_ylabel().partition("[")[2].rstrip("]")


def drawn(figure):
    """Over time: for each panel its lines' ordinates in SI, times checked."""
    found = []
    for axes in figure.axes:
        factor = UNITS.get(unit_of(axes), 1.0)
        found.append([line.get_ydata() / factor for line in axes.get_lines()])
        for line in axes.get_lines():
            assert_array_equal(line.get_xdata(), TIMES)
    return found


def assert_draws(figure, result, panels):
    """Panels of names of variables."""
    found = drawn(figure)
    assert [len(lines) for lines in found] == [len(names) for names in panels]
    for lines, names in zip(found, panels, strict=True):
        for line, name in zip(lines, names, strict=True):
            assert_allclose(line, result[name].values, rtol=1e-12, err_msg=name)


OVER_TIME = [
    (radial, RADIAL, {
        "overview.png": [["trolley_position"], ["rope_length"], ["swing_angle"], ["tower_tip_displacement"],
                         ["jib_tip_deflection"], ["rope_tension"]],
        "swing.png": [["swing_angle"]],
        "tower.png": [["tower_tip_displacement"]],
        "jib.png": [["jib_tip_deflection"]],
    }),
    (slewing, SLEWING, {
        "overview.png": [["shaft_speed"], ["sway_tangential", "sway_radial"],
                         ["jib_moment_horizontal", "jib_moment_vertical"], ["drive_torque", "drive_torque_elastic"],
                         ["rope_tension"]],
        "sway.png": [["sway_tangential"], ["sway_radial"]],
        "moments.png": [["jib_moment_horizontal"], ["jib_moment_vertical"]],
        "torque.png": [["drive_torque"], ["drive_torque_elastic"]],
    }),
    (space, SPACE, {
        "overview.png": [["slewing_angle", "shaft_angle"], ["trolley_position", "rope_length"],
                         ["sway_radial", "sway_tangential"], ["slewing_torque"],
                         ["tower_tip_displacement", "tower_tip_displacement_sideways"], ["rope_tension"]],
        "sway.png": [["sway_radial"], ["sway_tangential"]],
        "torque.png": [["slewing_torque"], ["trolley_force"], ["rope_tension"]],
        "tower.png": [["tower_tip_displacement", "tower_tip_displacement_sideways"],
                      ["tower_tip_twist", "tower_tip_tilt", "tower_tip_roll"]],
        "jib.png": [["jib_tip_deflection", "jib_tip_deflection_sideways"],
                    ["jib_root_moment", "jib_root_moment_sideways"]],
        "base.png": [["base_moment_x", "base_moment_y"], ["base_torque"]],
        "wind.png": [["wind_x", "wind_y", "wind_z"]],
    }),
    (jib, JIB, {"sway.png": [["sway_in_plane"], ["sway_lateral"]]}),
]  # fmt: skip


@pytest.mark.parametrize(
    ("kind", "result", "name", "panels"),
    [(kind, result, name, panels) for kind, result, pictures in OVER_TIME for name, panels in pictures.items()],
    ids=lambda value: value if isinstance(value, str) else getattr(value, "__name__", ""),
)
def test_lines_over_time_are_the_outputs_in_the_unit_of_the_label(kind, result, name, panels):
    figure = kind.run_pictures(result)[name]
    assert_draws(figure, result, panels)
    assert (
        "some-case" in figure.get_suptitle() or "some-case" in figure.axes[0].get_legend().get_texts()[0].get_text()
    )
    assert "Some crane" in figure.get_suptitle()
    assert figure._supxlabel.get_text() == "assumed, given by no source: a.key = 3 m"


def test_joints_and_paths_of_the_jib_crane():
    figures = jib.run_pictures(JIB)
    for name, variable, factor, other in (
        ("plan.png", "joint_angle", DEGREE, ("rope_length", 1.0)),
        ("torques.png", "joint_torque", 1e-3, ("rope_tension", 1e-3)),
    ):
        above, below = figures[name].axes
        assert [text.get_text() for text in above.get_legend().get_texts()] == ["slew", "luff", "fold"]
        for k, line in enumerate(above.get_lines()):
            assert_allclose(line.get_ydata(), factor * JIB[variable].values[:, k], rtol=1e-12)
        assert_allclose(below.get_lines()[0].get_ydata(), other[1] * JIB[other[0]].values, rtol=1e-12)
    x, y, z = JIB["payload_position"].values.T
    for axes, across, up in zip(figures["path.png"].axes, (x, np.hypot(x, y)), (y, z), strict=True):
        whole, start, end = axes.get_lines()
        for line, part in ((whole, slice(None)), (start, slice(0, 1)), (end, slice(-1, None))):
            assert_allclose(line.get_xdata(), across[part], rtol=1e-12)
            assert_allclose(line.get_ydata(), up[part], rtol=1e-12)
        assert [line.get_label() for line in (whole, start, end)] == ["load", "start", "end"]


def test_platform_and_path_of_a_slewing_crane():
    figures = slewing.run_pictures(SLEWING)
    platform, behind = figures["angles.png"].axes
    turned, shaft = SLEWING["platform_angle"].values, SLEWING["shaft_angle"].values
    assert_allclose(platform.get_lines()[0].get_ydata(), DEGREE * turned, rtol=1e-12)
    assert_allclose(behind.get_lines()[0].get_ydata(), DEGREE * (turned - shaft), rtol=1e-12)
    (axes,) = figures["path.png"].axes
    whole, start, end, foot = axes.get_lines()
    place = SLEWING["payload_position"].values
    for line, part in ((whole, place), (start, place[:1]), (end, place[-1:]), (foot, np.zeros((1, 2)))):
        assert_allclose(np.ravel(line.get_xdata()), part[:, 0])
        assert_allclose(np.ravel(line.get_ydata()), part[:, 1])
    assert (start.get_marker(), end.get_marker()) == ("o", "s")


def test_motion_is_drawn_with_its_derivative():
    position, speed, acceleration = radial.run_pictures(RADIAL)["motion.png"].axes
    assert_allclose(position.get_lines()[0].get_ydata(), RADIAL["trolley_position"].values)
    assert_allclose(speed.get_lines()[0].get_ydata(), RADIAL["trolley_speed"].values)
    rate = np.gradient(RADIAL["trolley_speed"].values, TIMES)
    assert_allclose(acceleration.get_lines()[0].get_ydata(), rate)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_ends_of_the_ramps_are_marked_in_their_rows(sign):
    """At rest to row 10, faster to row 30, steady to row 61, at rest from row 80 on."""
    speed = sign * 0.8 * np.interp(np.arange(ROWS), [10, 30, 61, 80], [0.0, 1.0, 1.0, 0.0])
    result = RADIAL.assign(trolley_speed=("time", speed, RADIAL["trolley_speed"].attrs))
    assert radial._ramp_ends(result) == [("A", 10), ("B", 30), ("C", 61), ("D", 80)]
    assert radial._ramp_ends(result.isel(time=slice(0, 62))) == [("A", 10), ("B", 30)]
    assert radial._ramp_ends(result.isel(time=slice(0, 70))) == [("A", 10), ("B", 30), ("C", 61)]
    assert radial._ramp_ends(result.isel(time=slice(0, 11))) == []
    (axes,) = radial.phase([result]).axes
    path, *marks = axes.get_lines()
    angle, rate = DEGREE * result["swing_angle"].values, DEGREE * result["swing_rate"].values
    assert_allclose(path.get_xdata(), angle)
    assert_allclose(path.get_ydata(), rate)
    for row, mark, text in zip((10, 30, 61, 80), marks, axes.texts, strict=True):
        assert_allclose([np.ravel(mark.get_xdata())[0], np.ravel(mark.get_ydata())[0]], [angle[row], rate[row]])
        assert_allclose(text.xy, (angle[row], rate[row]))
    assert [text.get_text() for text in axes.texts] == ["A", "B", "C", "D"]


def test_peaks_of_a_drawn_spectrum_are_labelled_where_they_are():
    times = 0.05 * np.arange(2000)
    top = 3e-3 * np.sin(2.0 * np.pi * 0.31 * times) + 1e-3 * np.sin(2.0 * np.pi * 0.82 * times)
    result = xr.Dataset(
        {"tower_tip_displacement": ("time", top), "rope_length": ("time", np.full(2000, 9.0))},
        {"time": times},
        RADIAL.attrs,
    )
    (axes,) = radial.spectrum([result]).axes
    frequencies, amplitudes = amplitude_spectrum(times, top)
    (line,) = axes.get_lines()
    assert_allclose(line.get_xdata(), frequencies)
    assert_allclose(line.get_ydata(), 1e3 * amplitudes)
    assert [text.get_text() for text in axes.texts] == ["0.310 Hz", "0.820 Hz"]
    assert_allclose([text.xy for text in axes.texts], [(0.31, 3.0), (0.82, 1.0)], rtol=0.01)
    low, high = axes.get_ylim()
    assert low < 1e-4 * 3.0
    assert high > 3.0


def test_lines_are_named_by_what_tells_runs_apart():
    label = style.run_label(RADIAL)
    speed = abs(RADIAL["trolley_speed"].values).max()
    first, last = RADIAL["rope_length"].values[[0, -1]]
    assert label == f"some-case: {speed:.3g} 1, 777 kg, rope {first:.4g} to {last:.4g} m"
    ended = made(["rope_length"], outcome="slack rope", end_time=3.21987)
    assert style.run_label(ended).endswith(" (slack rope at 3.22 s)")
    driven = made(["shaft_speed", "slewing_speed", "rope_length"])
    fastest = abs(driven["shaft_speed"].values).max()
    assert style.run_label(driven).startswith(f"some-case: {fastest:.3g} 1, 777 kg")


# --- studies -------------------------------------------------------------------------------------------


def swept(**varied):
    """Sweep over all combinations; sizes of extremes are all different."""
    grid = np.meshgrid(*varied.values(), indexing="ij")
    runs = grid[0].size
    random = np.random.default_rng(5)
    order = random.permutation(runs)
    columns = {key: values.ravel()[order] for key, values in zip(varied, grid, strict=True)}
    variables = {
        "swing_angle_max": ("run", random.uniform(0.0, 0.2, runs), {"units": "rad"}),
        "swing_angle_min": ("run", random.uniform(-0.3, 0.0, runs), {"units": "rad"}),
        "rope_tension_max": ("run", random.uniform(5e3, 9e3, runs), {"units": "N"}),
        "rope_tension_min": ("run", random.uniform(1e3, 4e3, runs), {"units": "N"}),
        "outcome": ("run", np.where(np.arange(runs) == 2, "slack rope", "finished").astype(object)),
    }
    about = {
        key: ("run", values, {"units": "kg", "long_name": key.replace("_", " ")}) for key, values in columns.items()
    }
    attrs = {
        "varied": json.dumps([key.replace("_", ".", 1) for key in varied]),
        "outputs": json.dumps(["trolley_position", "swing_angle", "rope_tension"]),
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
        figure.axes, ("swing_angle", "rope_tension"), (DEGREE, 1e-3), ("deg", "kN"), strict=True
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
    for axes, name, factor in zip(panels, ("swing_angle", "rope_tension"), (DEGREE, 1e-3), strict=True):
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
        "largest size of swing angle [deg]",
        "largest size of rope tension [kN]",
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
    left, right = radial.modes(tower, arm, []).axes
    for axes, shapes, upright, zeros in ((left, tower, True, 1), (right, arm, False, 1)):
        lines = axes.get_lines()[:-zeros]
        assert len(lines) == min(len(shapes.frequencies_hz), radial.MOST_SHAPES)
        for i, line in enumerate(lines):
            across, along = (line.get_xdata(), line.get_ydata())[:: 1 if upright else -1]
            assert_allclose(along[[0, -1]], [0.0, shapes.length])
            whole = shapes(along)[i]
            assert_allclose(across, whole / abs(whole).max(), atol=1e-12)
            assert line.get_label() == f"mode {i + 1}: {shapes.frequencies_hz[i]:.4g} Hz"


@pytest.mark.parametrize(("kind", "result"), [(slewing, SLEWING), (space, SPACE), (jib, JIB)])
def test_every_picture_names_its_lines(kind, result):
    for name, figure in kind.run_pictures(result).items():
        legends = [axes.get_legend() for axes in figure.axes]
        shared = name in ("sway.png", "moments.png", "torque.png", "angles.png") and kind is not space
        for axes, named in zip(figure.axes, legends, strict=True):
            if named is not None or not shared:
                labels = [line.get_label() for line in axes.get_lines() if not line.get_label().startswith("_")]
                assert [text.get_text() for text in named.get_texts()] == labels, name
        assert legends[0] is not None


def test_figures_of_the_source_compare_its_conditions():
    names = [
        "trolley_position",
        "trolley_speed",
        "rope_length",
        "swing_angle",
        "swing_rate",
        "tower_tip_displacement",
    ]
    made_up = {n: made(names, seed=n, case=f"condition-{n}") for n in (1, 2, 3, 4)}
    pairs = dict.fromkeys(("04", "05", "06", "07", "08"), (1, 2)) | {"09": (3, 4), "10": (3, 4), "11": (2, 3)}
    shown = {"05": "swing_angle", "07": "tower_tip_displacement", "09": "swing_angle"}
    shown |= dict.fromkeys(("10", "11"), "tower_tip_displacement")
    for name, figure in radial.source_figures(made_up).items():
        number = name.split("-")[1]
        named = [
            text.get_text() for axes in figure.axes if (legend := axes.get_legend()) for text in legend.get_texts()
        ]
        assert [text.partition(":")[0] for text in named] == [f"condition-{n}" for n in pairs[number]], name
        if number in shown:
            factor = DEGREE if "swing" in shown[number] else 1e3
            for line, n in zip(figure.axes[0].get_lines(), pairs[number], strict=True):
                assert_allclose(line.get_ydata(), factor * made_up[n][shown[number]].values)
