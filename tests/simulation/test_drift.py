"""Energy drift of the solvers: figures as data, warnings, refusals; both sides of every limit."""

import warnings
from dataclasses import replace

import numpy as np
import pytest
from samples.qtz5613 import model, motions

from towercrane.bench.runs.stability import agrees
from towercrane.bench.scenes.free_vibration import FreeVibration
from towercrane.cases.case import CaseError, load_case
from towercrane.runs.run import record_case
from towercrane.runs.summary import summarise
from towercrane.simulation.methods import method as drift
from towercrane.simulation.methods.registry import METHODS
from towercrane.simulation.methods.tableaus import DOPRI5
from towercrane.simulation.simulate import simulate

CASE = "qtz5613/condition-3"


@pytest.mark.parametrize("method", METHODS.values(), ids=METHODS)
def test_every_method_has_its_figures_loosest_first(method):
    tolerances = [rtol for rtol, _ in method.energy_drift]
    assert tolerances == sorted(tolerances, reverse=True)
    # Each ends where a run has nothing to say, so that there is always something to recommend.
    assert abs(method.energy_drift[-1][1]) < drift.NAMED


@pytest.mark.parametrize("figures", [((1e-4, 0.001), (1e-3, 0.5)), ((1e-3, 0.5), (1e-4, -0.01))])
def test_figures_out_of_order_or_without_a_good_end_make_no_method(figures):
    with pytest.raises(ValueError, match="dopri5: wanted energy_drift loosest first, down to less than 1%"):
        replace(DOPRI5, energy_drift=figures)


STATED = [(name, *row) for name, method in METHODS.items() for row in method.energy_drift]


@pytest.mark.parametrize(("method", "rtol", "stated"), [row for row in STATED if "scipy" not in row[0]])
def test_stated_figures_are_those_of_the_solver(method, rtol, stated):
    assert METHODS[method].energy_change(rtol, 1e-2 * rtol) == stated
    found = []
    for modes in ((1, 1), (2, 3)):
        scene = FreeVibration(*modes)
        found.append(scene.energy_change(scene.run(method, rtol, drift.SPAN)))
    worst = max(found, key=abs)
    assert 0.9 * abs(stated) < abs(worst) < 1.1 * abs(stated)
    assert np.sign(worst) == np.sign(stated)
    assert agrees(worst, stated)


@pytest.mark.parametrize(("method", "rtol", "stated"), [row for row in STATED if "scipy" in row[0] and row[2] < 1.0])
def test_stated_figures_of_scipy_are_those_of_its_first_seconds(method, rtol, stated):
    scene, span = FreeVibration(1, 1), 20.0
    found = scene.energy_change(scene.run(method, rtol, span))
    assert 0.9 < found / ((1.0 + stated) ** (span / drift.SPAN) - 1.0) < 4.0


def test_a_method_that_blows_up_is_refused_for_that():
    scene = FreeVibration(2, 3)
    assert DOPRI5.refusal(1e-2, 1e-4)
    assert scene.energy_change(scene.run("dopri5", 1e-2, 600.0)) > 1e4


@pytest.mark.parametrize(
    ("method", "rtol", "atol", "said", "refused"),
    [
        ("dop853", 1e-8, 1e-10, "", False),
        ("dop853", 1e-5, 1e-7, "", False),
        ("dop853", 1.01e-5, 1e-7, "dop853 at rtol 1.01e-05 loses energy: -1.04 % in 600 s", False),
        ("dop853", 1e-8, 1e-5, "", False),
        ("dop853", 1e-8, 1.01e-5, "dop853 at atol 1.01e-05 loses energy: -1.04 % in 600 s", False),
        ("dop853", 1e-8, 1e-3, "use atol 1e-05", False),
        ("dopri5", 1e-5, 1e-7, "", False),
        ("dopri5", 1e-4, 1e-6, "use rtol 1e-05 or dop853", False),
        ("dopri5", 1e-3, 1e-6, "dopri5 at rtol 0.001 gains energy: +71 % in 600 s", False),
        ("dopri5", 1.01e-3, 1e-6, "", True),
        ("dopri5", 1e-8, 1.01e-3, "", True),
        ("scipy-lsoda", 1e-2, 1e-4, "", True),
        ("scipy-radau", 1e-4, 1e-6, "", False),
    ],
)
def test_notice_and_refusal_on_both_sides_of_their_limits(method, rtol, atol, said, refused):
    assert bool(METHODS[method].refusal(rtol, atol)) is refused
    if refused:
        return
    notice = METHODS[method].notice(rtol, atol)
    assert bool(notice) is bool(said)
    assert said in notice


def test_simulate_warns_and_refuses():
    short = {"duration": 1.0, "output_step": 0.5}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        simulate(model(), motions(), **short, rtol=1e-5, atol=1e-7)
    with pytest.warns(drift.EnergyDriftWarning, match=r"dop853 at rtol 0.0001 loses energy: -1.04 %"):
        simulate(model(), motions(), **short, rtol=1e-4, atol=1e-6)
    with pytest.raises(ValueError, match=r"dopri5 feeds free vibration without bound beyond rtol or atol 0.001"):
        simulate(model(), motions(), **short, method="dopri5", rtol=1e-2, atol=1e-4)


def test_a_run_says_it_in_its_summary_once_and_a_case_is_refused_at_the_door():
    changes = ["run.duration=2 s", "solver.method=dopri5", "solver.rtol=1e-3", "solver.atol=1e-6"]
    case = load_case(CASE, changes)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        notices = summarise(case, record_case(case))["notices"]
    assert len([n for n in notices if "gains energy" in n]) == 1
    with pytest.raises(CaseError, match=r"(?s)solver.rtol.*tolerances at which dopri5 is stable"):
        load_case(CASE, ["solver.method=dopri5", "solver.rtol=2e-3"])


def test_figures_that_no_longer_hold_are_seen():
    assert agrees(5.0, 5.6)
    assert not agrees(5.6 * 4, 5.6)
    assert not agrees(-5.6, 5.6)
    assert agrees(-1e-9, -5e-3)
    assert not agrees(-0.05, -5e-3)
    assert agrees(np.inf, None)
    assert not agrees(0.01, None)
