"""What pictures of runs draw is what the data say: every line's data, marks and labels beside made-up runs."""

import numpy as np
import pytest
import xarray as xr
from numpy.testing import assert_allclose, assert_array_equal
from samples.pictures import DEGREE, JIB, RADIAL, ROWS, SLEWING, SPACE, TIMES, made

from towercrane.report.plots import style
from towercrane.report.plots.runs import jib, plane, slewing, tower
from towercrane.results.spectrum import amplitude_spectrum

UNITS = {"deg": DEGREE, "mm": 1e3, "kN": 1e-3, "kN m": 1e-3, "mrad": 1e3, "deg/s": DEGREE}
"""Factor from SI of the unit that a label names; of others it is one."""


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
    (tower, RADIAL, {
        "overview.png": [["trolley_position"], ["rope_length"], ["sway_radial"], ["tower_tip_displacement"],
                         ["jib_tip_deflection"], ["hoist_rope_force"]],
        "swing.png": [["sway_radial"]],
        "tower.png": [["tower_tip_displacement"]],
        "jib.png": [["jib_tip_deflection"]],
    }),
    (slewing, SLEWING, {
        "overview.png": [["shaft_speed"], ["sway_tangential", "sway_radial"],
                         ["jib_moment_horizontal", "jib_moment_vertical"], ["drive_torque", "drive_torque_elastic"],
                         ["hoist_rope_force"]],
        "sway.png": [["sway_tangential"], ["sway_radial"]],
        "moments.png": [["jib_moment_horizontal"], ["jib_moment_vertical"]],
        "torque.png": [["drive_torque"], ["drive_torque_elastic"]],
    }),
    (tower, SPACE, {
        "overview.png": [["slewing_angle", "shaft_angle"], ["trolley_position", "rope_length"],
                         ["sway_radial", "sway_tangential"], ["slewing_torque"],
                         ["tower_tip_displacement", "tower_tip_displacement_sideways"], ["hoist_rope_force"]],
        "sway.png": [["sway_radial"], ["sway_tangential"]],
        "torque.png": [["slewing_torque"], ["trolley_force"], ["hoist_rope_force"]],
        "tower.png": [["tower_tip_displacement", "tower_tip_displacement_sideways"],
                      ["tower_tip_twist", "tower_tip_tilt", "tower_tip_roll"]],
        "jib.png": [["jib_tip_deflection", "jib_tip_deflection_sideways"],
                    ["jib_root_moment", "jib_root_moment_sideways"]],
        "counter-jib.png": [["counter_jib_tip_deflection", "counter_jib_tip_deflection_sideways"],
                            ["counter_jib_root_moment", "counter_jib_root_moment_sideways"]],
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
        ("torques.png", "joint_torque", 1e-3, ("hoist_rope_force", 1e-3)),
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
    position, speed, acceleration = plane.run_pictures(RADIAL)["motion.png"].axes
    assert_allclose(position.get_lines()[0].get_ydata(), RADIAL["trolley_position"].values)
    assert_allclose(speed.get_lines()[0].get_ydata(), RADIAL["trolley_speed"].values)
    rate = np.gradient(RADIAL["trolley_speed"].values, TIMES)
    assert_allclose(acceleration.get_lines()[0].get_ydata(), rate)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_ends_of_the_ramps_are_marked_in_their_rows(sign):
    """At rest to row 10, faster to row 30, steady to row 61, at rest from row 80 on."""
    speed = sign * 0.8 * np.interp(np.arange(ROWS), [10, 30, 61, 80], [0.0, 1.0, 1.0, 0.0])
    result = RADIAL.assign(trolley_speed=("time", speed, RADIAL["trolley_speed"].attrs))
    assert plane._ramp_ends(result) == [("A", 10), ("B", 30), ("C", 61), ("D", 80)]
    assert plane._ramp_ends(result.isel(time=slice(0, 62))) == [("A", 10), ("B", 30)]
    assert plane._ramp_ends(result.isel(time=slice(0, 70))) == [("A", 10), ("B", 30), ("C", 61)]
    assert plane._ramp_ends(result.isel(time=slice(0, 11))) == []
    (axes,) = plane.phase([result]).axes
    path, *marks = axes.get_lines()
    angle, rate = DEGREE * result["sway_radial"].values, DEGREE * result["swing_rate"].values
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
    (axes,) = plane.spectrum([result]).axes
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
    # A drive that stands names nothing.
    driven["shaft_speed"] = 0.0 * driven["shaft_speed"]
    assert style.run_label(driven).startswith("some-case: 777 kg")


@pytest.mark.parametrize(("kind", "result"), [(slewing, SLEWING), (tower, SPACE), (jib, JIB)])
def test_every_picture_names_its_lines(kind, result):
    for name, figure in kind.run_pictures(result).items():
        legends = [axes.get_legend() for axes in figure.axes]
        shared = name in ("sway.png", "moments.png", "torque.png", "angles.png") and kind is not tower
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
        "sway_radial",
        "swing_rate",
        "tower_tip_displacement",
    ]
    made_up = {n: made(names, seed=n, case=f"condition-{n}") for n in (1, 2, 3, 4)}
    pairs = dict.fromkeys(("04", "05", "06", "07", "08"), (1, 2)) | {"09": (3, 4), "10": (3, 4), "11": (2, 3)}
    shown = {"05": "sway_radial", "07": "tower_tip_displacement", "09": "sway_radial"}
    shown |= dict.fromkeys(("10", "11"), "tower_tip_displacement")
    for name, figure in plane.source_figures(made_up).items():
        number = name.split("-")[1]
        named = [
            text.get_text() for axes in figure.axes if (legend := axes.get_legend()) for text in legend.get_texts()
        ]
        assert [text.partition(":")[0] for text in named] == [f"condition-{n}" for n in pairs[number]], name
        if number in shown:
            factor = DEGREE if "sway" in shown[number] else 1e3
            for line, n in zip(figure.axes[0].get_lines(), pairs[number], strict=True):
                assert_allclose(line.get_ydata(), factor * made_up[n][shown[number]].values)


@pytest.mark.parametrize(("value", "noise", "half"), [(0.0, 1e-15, 0.05), (12.0, 1e-14, 0.6), (-4e-4, 1e-17, 2e-5)])
def test_lines_that_stand_still_show_no_rounding_and_no_offset_over_the_names(tmp_path, value, noise, half):
    figure = style.figure_of(4.0, 3.0)
    axes = figure.subplots()
    axes.plot(TIMES, value + noise * np.cos(9.0 * TIMES))
    axes.axvline(1.0)
    style.put(figure, tmp_path / "still.png")
    assert_allclose(axes.get_ylim(), (value - half, value + half), rtol=1e-9)
    assert axes.yaxis.get_major_formatter().get_offset() == ""


def test_lines_that_move_a_little_keep_their_scale_without_an_offset(tmp_path):
    figure = style.figure_of(4.0, 3.0)
    axes = figure.subplots()
    axes.plot(TIMES, 2e4 + 1e-3 * np.cos(TIMES))
    style.put(figure, tmp_path / "small.png")
    low, high = axes.get_ylim()
    assert 1e-3 < high - low < 3e-3
    assert axes.yaxis.get_major_formatter().get_offset() == ""
