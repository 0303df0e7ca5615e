"""Text in pictures is text, whatever cranes and cases are called."""

import io

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

from towercrane.cases.case import load_case
from towercrane.commands.shared.pictures import run_pictures
from towercrane.report.plots import style
from towercrane.report.plots.literal import LiteralFigure
from towercrane.runs.run import record_case

ODD = ["a $5 \\foo $6", "$$ \\frac{", "$x_1^2$", "_hidden", "x\ny", "中文 кран \u202e \x1b[31m", "%s {} [red] " * 3]


def drawn(kind, text, *, wrap=False):
    """Pixels of a picture whose every text is the same."""
    figure = kind(figsize=(6.0, 4.0), layout="constrained")
    axes = figure.subplots()
    axes.plot([1.0, 10.0], [1.0, 10.0], label=f"n {text}")
    axes.set(xlabel=text, ylabel=text, title=text)
    axes.legend()
    figure.suptitle(text)
    figure.supxlabel(text, wrap=wrap)
    file = io.BytesIO()
    figure.savefig(file, format="png")
    again = io.BytesIO()
    figure.savefig(again, format="png")
    assert file.getvalue() == again.getvalue()
    return np.asarray(Image.open(file))


@pytest.mark.parametrize("text", ["a $5 \\foo $6", "$x_1^2$", "costs \\$3 or $4"])
def test_formulas_are_drawn_as_they_are_written(text):
    with mpl.rc_context({"text.parse_math": False}):
        plain = drawn(Figure, text)
    assert np.array_equal(drawn(LiteralFigure, text), plain)
    # What breaks lines has its own reader of formulas.
    assert np.array_equal(drawn(LiteralFigure, text, wrap=True), plain)


def test_powers_of_ten_beside_a_logarithmic_axis_stay_formulas():
    def axis(kind):
        figure = kind(figsize=(3.0, 2.0), layout="constrained")
        figure.subplots().loglog([1.0, 1e6], [1.0, 1e6])
        file = io.BytesIO()
        figure.savefig(file, format="png")
        return np.asarray(Image.open(file))

    assert np.array_equal(axis(LiteralFigure), axis(Figure))


@pytest.mark.parametrize("text", [*ODD, "y" * 100_000, "\n" * 500, "a " * 2000], ids=range(len(ODD) + 3))
def test_any_text_makes_a_picture_without_a_word(text):
    drawn(LiteralFigure, text, wrap=True)


@pytest.mark.parametrize(
    "name", ["qtz5613/condition-3", "qtz5613/manoeuvre", "slewing/basic/example-1", "jib-crane/plan"]
)
def test_every_picture_of_a_run_bears_any_name(name, tmp_path):
    odd = f"'''{' '.join(ODD[:4])}'''"
    short = ("run.duration=0.1 s", "run.output_step=0.05 s", "solver.rtol=1e-4")
    case = load_case(name, [f"crane.name={odd}", f"title={odd}", *short])
    for file, figure in run_pictures(case, record_case(case)).items():
        style.save(figure, tmp_path / file)
