"""Pictures: units and legends on every axis, assumed values named, and the look of the main ones."""

import json

import matplotlib
import numpy as np
import pytest
from samples.qtz5613 import CONDITIONS, CRANE, model, motions

from modal import cantilever_modes
from towercrane.report.plots import style
from towercrane.report.plots.runs import plane
from towercrane.simulation.simulate import simulate

matplotlib.use("Agg")

BASELINE_VERSION = "3.11"
"""Other versions set type a pixel off, which moves every line of a picture."""

ASSUMED = [("crane.jib.second_moment_of_area", "0.0035 m^4", "not printed")]


def looks_like(filename: str):
    """Compare the returned figure with baseline/FILENAME (made anew by --mpl-generate-path=tests/report/baseline)."""

    def mark(test):
        test = pytest.mark.mpl_image_compare(filename=filename, tolerance=8, style="default")(test)
        other = not matplotlib.__version__.startswith(BASELINE_VERSION)
        return pytest.mark.skipif(other, reason=f"pictures to compare are of matplotlib {BASELINE_VERSION}")(test)

    return mark


@pytest.fixture(scope="module")
def conditions():
    found = {}
    for number, (speed, load, rope) in CONDITIONS.items():
        found[number] = simulate(model(2, 3, load), motions(speed, rope), 120.0)
        found[number].attrs |= {"case": f"qtz5613/condition-{number}", "assumed": json.dumps(ASSUMED)}
    return found


def test_every_axis_has_a_unit_and_every_line_a_name(conditions):
    figures = plane.run_pictures(conditions[3]) | plane.source_figures(conditions)
    assert len(figures) == 15
    for name, figure in figures.items():
        for axes in figure.axes:
            # One legend names the same lines of a column of panels.
            assert axes.get_legend() is not None or (name.endswith("motion.png") and figure.axes[0].get_legend()), (
                name
            )
            assert "[" in axes.get_ylabel() or axes.get_shared_y_axes().get_siblings(axes) or "phase" in name
        assert any("[" in axes.get_xlabel() for axes in figure.axes), name
        assert any("0.0035 m^4" in text.get_text() for text in [figure._supxlabel]), name


def test_run_without_motion_or_cut_short_is_drawn_too(conditions):
    parked = simulate(model(0, 0), {**motions(), "trolley": motions()["trolley"]}, 0.1)
    for figure in plane.run_pictures(parked).values():
        figure.canvas.draw()


def test_peaks_are_named_where_the_spectrum_has_them(conditions):
    axes = plane.spectrum([conditions[1], conditions[2]]).axes[0]
    curves = {line.get_color(): line.get_data() for line in axes.get_lines()}
    assert len(axes.texts) >= 2
    for name in axes.texts:
        frequencies, amplitudes = curves[name.get_color()]
        at, height = name.xy
        assert name.get_text() == f"{at:.3f} Hz"
        near = abs(frequencies - at) < 2.0 * frequencies[1]
        assert height == pytest.approx(amplitudes[near].max(), rel=0.02)


@looks_like("modes.png")
def test_look_of_the_mode_shapes():
    return plane.modes(cantilever_modes(CRANE.tower, 4, CRANE.end_body), cantilever_modes(CRANE.jib, 4), ASSUMED)


@looks_like("overview.png")
def test_look_of_the_overview(conditions):
    return plane.overview(conditions[3])


@looks_like("phase.png")
def test_look_of_the_phase_path(conditions):
    return plane.phase([conditions[1], conditions[2]])


def test_picture_is_written_whole_or_not_at_all(tmp_path, conditions):
    figure = plane.swing([conditions[3]])
    style.save(figure, tmp_path / "swing.png")
    assert (tmp_path / "swing.png").read_bytes()[:4] == b"\x89PNG"
    figure.savefig = lambda *a, **k: (_ for _ in ()).throw(OSError("full"))
    with pytest.raises(OSError, match="full"):
        style.save(figure, tmp_path / "other.png")
    assert [path.name for path in tmp_path.iterdir()] == ["swing.png"]


def test_colours_differ_in_grey():
    luminance = [np.dot([0.299, 0.587, 0.114], matplotlib.colors.to_rgb(c)) for c in style.COLOURS[:2]]
    assert style.DASHES[0] != style.DASHES[1]
    assert abs(luminance[0] - luminance[1]) > 0.03
