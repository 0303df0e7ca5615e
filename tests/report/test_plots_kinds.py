"""Pictures of slewing and jib cranes and of studies: units, names, nothing left out."""

import json

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples.lab_crane import crane, motions

from towercrane.cases.case import load_case
from towercrane.report.folder import RUN_FILES
from towercrane.report.plots.runs import jib, slewing, tower
from towercrane.report.plots.studies import sensitivity
from towercrane.runs.run import run_case
from towercrane.simulation.simulate import simulate

DEGREES = 180.0 / np.pi
NOTE = json.dumps([["crane.mass.jib_tip", "14 kg", "not printed"]])


@pytest.fixture(scope="module")
def turned():
    result = simulate(crane("basic"), motions(), 5.0, output_step=0.05)
    result.attrs |= {"case": "slewing/basic/example-1", "assumed": NOTE}
    return result


def check(figures):
    for name, figure in figures.items():
        figure.canvas.draw()
        assert any(axes.get_legend() is not None for axes in figure.axes), name
        assert all("[" in axes.get_ylabel() for axes in figure.axes), name
        assert any("[" in axes.get_xlabel() for axes in figure.axes), name


def test_slewing_pictures(turned):
    figures = slewing.run_pictures(turned)
    assert set(figures) == {"overview.png", "sway.png", "moments.png", "torque.png", "angles.png", "path.png"}
    check(figures)
    for figure in figures.values():
        assert "14 kg" in figure._supxlabel.get_text()


def test_several_runs_share_a_picture(turned):
    lines = slewing.sway([turned, turned]).axes[0].get_lines()
    assert len(lines) == 2
    assert lines[0].get_linestyle() != lines[1].get_linestyle()


def test_each_panel_of_a_slewing_crane_shows_its_output_of_its_run(turned):
    other = (
        (1.5 * turned.drop_attrs(deep=False))
        .assign_coords(turned.coords)
        .assign_attrs(turned.attrs | {"case": "a/b"})
    )
    panels = {
        slewing.sway: ((DEGREES, "sway_tangential"), (DEGREES, "sway_radial")),
        slewing.moments: ((1.0, "jib_moment_horizontal"), (1.0, "jib_moment_vertical")),
        slewing.torque: ((1.0, "drive_torque"), (1.0, "drive_torque_elastic")),
        slewing.angles: ((DEGREES, "platform_angle"), (DEGREES, "lag")),
    }
    runs = [run.assign(lag=run["platform_angle"] - run["shaft_angle"]) for run in (turned, other)]
    for picture, rows in panels.items():
        figure = picture(runs)
        for axes, (factor, name) in zip(figure.axes, rows, strict=True):
            for line, run in zip(axes.get_lines(), runs, strict=True):
                assert_allclose(line.get_ydata(), factor * run[name], rtol=1e-12, err_msg=name)
        names = [text.get_text() for text in figure.axes[0].get_legend().get_texts()]
        assert [name.partition(":")[0] for name in names] == ["example-1", "b"]


def test_overview_of_a_slewing_crane_names_every_line(turned):
    names = [[line.get_label() for line in axes.get_lines()] for axes in slewing.overview(turned).axes]
    assert names == [
        ["shaft speed"],
        ["sway tangential", "sway radial"],
        ["jib moment horizontal", "jib moment vertical"],
        ["drive torque", "drive torque elastic"],
        ["hoist rope force"],
    ]


def test_path_from_above_begins_with_a_circle_and_ends_with_a_square(turned):
    path, first, last, axis = slewing.path_from_above([turned]).axes[0].get_lines()
    place = turned["payload_position"].values
    assert_allclose(np.column_stack(path.get_data()), place[:, :2])
    for mark, shape, point in ((first, "o", place[0]), (last, "s", place[-1]), (axis, "+", (0.0, 0.0))):
        assert mark.get_marker() == shape
        assert_allclose(np.ravel(mark.get_data()), point[:2])


def test_jib_crane_pictures():
    result = run_case(load_case("jib-crane/plan")).assign_attrs(assumed=NOTE)
    figures = jib.run_pictures(result)
    assert set(figures) == {"plan.png", "sway.png", "torques.png", "path.png"}
    check(figures)
    for name, figure in figures.items():
        assert "14 kg" in figure.get_supxlabel(), name
    above, side = figures["path.png"].axes
    x, y, z = result["payload_position"].values.T
    for axes, across, up in ((above, x, y), (side, np.hypot(x, y), z)):
        for line, rows in zip(axes.get_lines(), (slice(None), slice(1), slice(-1, None)), strict=True):
            assert_allclose(line.get_data(), (across[rows], up[rows]))


def test_surface_shows_every_output_over_time_and_percent(turned):
    import xarray as xr

    values = np.stack([turned["sway_radial"].values * f for f in (0.5, 1.0, 2.0)])[None]
    data = xr.Dataset(
        {"sway_radial": (("parameter", "percent", "time"), values, turned["sway_radial"].attrs)},
        {"parameter": ["drive_corner"], "percent": [0.0, 100.0, 200.0], "time": turned["time"].values},
        {"crane": "laboratory crane"},
    )
    figure = sensitivity.surface(data, "drive_corner")
    figure.canvas.draw()
    assert figure.axes[0].get_ylabel() == "value [% of nominal]"
    assert "[deg]" in figure.axes[1].get_ylabel()


@pytest.mark.parametrize("name", ["soft-drive", "gusts-working"])
def test_pictures_of_runs_in_space(name):
    figures = tower.run_pictures(run_case(load_case(f"qtz5613/{name}", ["run.duration=4 s"])))
    drawn = {"overview", "sway", "torque", "tower", "jib", "base", "path"} | ({"wind"} if "gusts" in name else set())
    assert set(figures) == {f"{picture}.png" for picture in drawn}
    check(figures)
    assert set(figures) <= set(RUN_FILES)
    shaft = [line.get_label() for line in figures["overview.png"].axes[0].get_lines()]
    assert shaft == (["head", "shaft of its drive"] if name == "soft-drive" else ["head"])
    assert "assumed" in figures["sway.png"]._supxlabel.get_text()
