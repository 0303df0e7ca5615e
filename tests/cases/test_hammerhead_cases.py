"""Case files of cranes on tie bars: what they say, what is refused, and how their runs end."""

import re

import numpy as np
import pytest
from samples import hammerhead as sample

from modal import Chain, Segment
from towercrane.cases.case import CaseError, case_folder, load_case
from towercrane.cases.models import model_of
from towercrane.cranes.tower.modes.tied.bars import Tie, TieBars
from towercrane.cranes.tower.tied_model import TiedModel
from towercrane.motions.motion import rest
from towercrane.report.plots.runs.tower import run_pictures
from towercrane.runs.run import run_case
from towercrane.simulation.outcomes import NOT_LEVEL, SLACK_TIE
from towercrane.simulation.simulate import simulate

SHIPPED = case_folder() / "hammerhead"

REST = """
title = "At rest"
crane = "crane.toml"
[payload]
mass = "2.6 t"
[rope]
length = "20 m"
[motion.trolley]
shape = "rest"
start = "50 m"
[model]
tower_modes = 0
jib_vertical_modes = 1
[run]
duration = "2 s"
"""


@pytest.fixture
def written(tmp_path):
    """Write the crane and a case at rest, with replacements, and give the case's path."""

    def write(*crane, case=()):
        text = (SHIPPED / "crane.toml").read_text("utf-8")
        body = REST
        for old, new in crane:
            assert re.search(old, text, flags=re.DOTALL), old
            text = re.sub(old, new, text, count=1, flags=re.DOTALL)
        for old, new in case:
            assert old in body, old
            body = body.replace(old, new, 1)
        (tmp_path / "crane.toml").write_text(text, "utf-8")
        (tmp_path / "case.toml").write_text(body, "utf-8")
        return tmp_path / "case.toml"

    return write


def faults(path):
    with pytest.raises(CaseError) as refused:
        load_case(path)
    return [(f.key, f.wanted, f.got, f.hint) for f in refused.value.faults]


def test_the_shipped_crane_is_that_of_the_tests():
    case = load_case("hammerhead/manoeuvre")
    model = model_of(case)
    assert isinstance(model, TiedModel)
    assert len(case.assumed) == 57
    assert model.crane.written.tie_bars == sample.BARS
    assert model.counts["counter_jib_vertical"] == 2
    assert model.counts["tie_sideways"] == 3


def test_a_load_at_rest_is_held_by_the_ties(written):
    """The base bears all weights; the back tie what the ballast needs."""
    run = run_case(load_case(written()))
    assert run.attrs["outcome"] == "finished"
    tensions = [float(run[f"jib_tie_{k}_tension"][-1]) for k in (1, 2)]
    assert tensions == pytest.approx([134e3, 319e3], rel=5e-3)
    weights = 45 * 700 + 7000 + 8.5 * 220 + 40 * 130 + 20 * 100 + 14 * 200 + 12e3 + 400 + 2600
    ties = (23, 18, 1.2), (23, 44, 1.2), (46, 12.5, 0.6)
    bars = sum(rate * np.hypot(place, 8.5 - height) for rate, place, height in ties)
    assert float(run["base_force_z"][-1]) == pytest.approx(-9.81 * (weights + bars), rel=1e-9)
    assert "jib_root_moment" not in run
    drawn = [line.get_label() for axes in run_pictures(run)["ties.png"].axes for line in axes.get_lines()]
    assert drawn == ["tension of tie 1", "tension of tie 2", "tension of tie 1"]
    drift = abs(run["total_energy"].values - float(run["total_energy"][0]))
    assert np.max(drift) < 1e-9 * abs(float(run["total_energy"][0]))


@pytest.mark.parametrize(
    ("crane", "key", "said"),
    [
        ((r'\[tower_head\].*?\[jib\]', "[jib]"), "tower_head", "ties in [jib] without it"),
        ((r'axial_stiffness = \{ value = "1100 MN"[^\n]*\n', ""), "jib.segments.1.axial_stiffness", "compress it"),
        ((r'axial_stiffness = \{ value = "1500 MN"[^\n]*\n', ""), "counter_jib.axial_stiffness", "compress it"),
        ((r'\[\[counter_jib.ties\]\].*?\[trolley\]', "[trolley]"), "counter_jib.ties", "holds jib and counter-jib"),
        ((r'value = "44 m"', 'value = "61 m"'), "jib.ties.1.position", "outward"),
        ((r'value = "44 m"', 'value = "18 m"'), "jib.ties.1.position", "one tie twice"),
        ((r'value = "0.6 m"', 'value = "8.5 m"'), "counter_jib.ties.0.height", "lower end"),
        ((r'value = "1.2 m"', 'value = "1200 m"'), "jib.ties.0.height", "lower end"),
        ((r'value = "580 MN"', 'value = "580 N"'), "jib.ties.0.axial_stiffness", "MN meant?"),
        ((r'value = "580 MN"', 'value = "-580 MN"'), "jib.ties.0.axial_stiffness", "-580 MN"),
        ((r'value = "23 kg/m"', 'value = "23 kg"'), "jib.ties.0.mass_per_length", "23 kg"),
        ((r"\[\[jib.ties\]\]\nposition", "[[jib.ties]]\npretention = \"9 kN\"\nposition"), "jib.ties.0.pretention",
         "pretension"),
        ((r"\[tower_head\]\nheight", "[tower_head]\nhight"), "tower_head.hight", "height"),
    ],
)  # fmt: skip
def test_each_slip_in_the_crane_is_named(written, crane, key, said):
    found = {name.removeprefix("crane."): " ".join(map(str, rest)) for name, *rest in faults(written(crane))}
    assert said in found[key]


@pytest.mark.parametrize(
    ("case", "key"),
    [
        (("[run]", '[start]\nstate = "zero-no-self-weight"\n[run]'), "start.state"),
    ],
)
def test_what_is_for_clamped_jibs_is_refused(written, case, key):
    assert [name for name, *_ in faults(written(case=[case]))] == [key]


def test_a_jib_without_ties_has_no_axial_stiffness(written):
    without = (r"\[\[jib.ties\]\].*?\[counter_jib\]", "[counter_jib]")
    back = (r"\[\[counter_jib.ties\]\].*?\[trolley\]", "[trolley]")
    found = faults(written((r"\[tower_head\].*?\[jib\]", "[jib]"), without, back))
    assert {name for name, *_ in found} == {
        "jib.segments.0.axial_stiffness", "jib.segments.1.axial_stiffness", "counter_jib.axial_stiffness",
    }  # fmt: skip


def test_ties_that_would_push_end_a_run_by_name(written):
    """A tie that is pulled too hard leaves nothing to the other."""
    strained = (r"(position = \{ value = \"44 m\")", r'pretension = "600 kN"\n\1')
    run = run_case(load_case(written(strained)))
    assert run.attrs["outcome"] == SLACK_TIE
    assert "600" in run.attrs["message"]


def test_a_single_tie_at_the_end_of_a_uniform_jib_pulls_as_statics_says():
    chain = Chain((Segment(60.0, 130.0, 6e8, 6e7),))
    bars = TieBars(sample.HEAD, (Tie(60.0, 1.2, 5.8e8, 23.0),), sample.BACK_TIE, ((60.0, 1.7e9),), ((14.0, 1.5e9),))
    crane = sample.bare(jib=chain, jib_lateral=chain, tie_bars=bars)
    model = sample.model(crane=crane, lateral=0, planes=1)
    still = {channel: rest({"trolley": 10.0, "rope": 20.0}.get(channel, 0.0)) for channel in model.channels}
    shown = simulate(model, still, 0.2)
    assert not model.constants.jointed
    load = (3000.0 + crane.trolley_mass) * 10.0 + 130.0 * 60.0 * 30.0 + 0.5 * 23.0 * np.hypot(60.0, 7.3) * 60.0
    # The line of the tie passes the foot at this distance.
    arm = 8.5 * 60.0 / np.hypot(60.0, 7.3)
    assert shown["jib_tie_1_tension"].values[0] == pytest.approx(9.81 * load / arm, rel=5e-3)
    assert shown["counter_jib_tie_1_tension"].values[0] > 0.0


def test_a_stated_pretension_that_does_not_carry_the_weight_is_an_outcome_by_name(written):
    path = written(case=[('duration = "2 s"', 'duration = "1 s"')])
    case = load_case(path, ["crane.jib.ties.0.pretension=30 kN", "crane.jib.ties.1.pretension=130 kN"])
    found = run_case(case).attrs
    assert (found["outcome"], found["end_time"]) == (NOT_LEVEL, 0.0)
    assert "m off level" in found["message"]
