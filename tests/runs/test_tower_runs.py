"""General towers behind the door: frequencies, runs, linear models and reports of what case files describe."""

import json
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples.program import towercrane
from samples.qtz5613 import in_plane
from samples.tower_files import ONE_SEGMENT, SEGMENTS, UNIFORM, write_case

from modal import Beam, Chain, CraneFrame, EndBody, Foundation, LacedColumn, Segment, crane_structure
from towercrane import Load, TowerCrane, load_case, run_case
from towercrane.cases.models import motions_of
from towercrane.cranes.tower.equations.small_motions import plane_modes
from towercrane.cranes.tower.file.build import crane_frame, crane_of, tower_model
from towercrane.cranes.tower.file.effects import kept_tower
from towercrane.cranes.tower.file.requests import modes_of
from towercrane.linear.linearise import linearise
from towercrane.motions.motion import rest
from towercrane.motions.profiles import trapezoid
from towercrane.report.tables.modes import modes_tables
from towercrane.runs.run import record_case
from towercrane.runs.summary import summarise
from towercrane.simulation.simulate import simulate
from towercrane.studies.natural import natural_frequencies

TOWERS = ("towers/laced", "towers/stepped", "towers/tapered")
JIB = Segment(40.0, 100.0, 210e9 * 0.003)
OUTPUTS = ("tower_tip_displacement", "tower_tip_tilt", "jib_tip_deflection", "sway_radial")

COLUMN = LacedColumn(50e-4, 1.7, 1.4, 8e-4, 210e9, "X", 6e-4)
MAST = Segment(18.0, 350.0, COLUMN.bending_stiffness.value, COLUMN.shear_stiffness.value, 350.0 * 0.85**2)
BY_HAND = Chain(
    (Segment(12.0, 500.0, 206e9 * 0.02, 150e6, 300.0, 0.6, 1.0, 3.0, 1.0), *MAST.split(8.0)),
    {0: EndBody(100e3), 2: EndBody(2000.0, 3000.0, -0.4), 3: EndBody(5000.0, 0.0, 1.0)},
    Foundation(2e9, 300e6),
    shear_theory="engesser",
)


def hertz(frame, position, count=6):
    return crane_structure(frame, position).angular_frequencies(count) / (2 * np.pi)


def largest_difference(one, other):
    """Largest difference of any output over its range."""
    gaps = [abs(one[name] - other[name]).max() / np.ptp(one[name].values) for name in OUTPUTS]
    return float(max(gaps))


def test_one_segment_is_the_uniform_tower(tmp_path):
    uniform = load_case(write_case(tmp_path, UNIFORM))
    (tmp_path / "segment").mkdir()
    segment = load_case(write_case(tmp_path / "segment", ONE_SEGMENT))
    assert isinstance(kept_tower(uniform.checked), Beam)
    assert isinstance(kept_tower(segment.checked), Chain)
    modes = [crane_of(case.checked).tower_modes(6).angular_frequencies for case in (uniform, segment)]
    assert_allclose(modes[1], modes[0], rtol=1e-12)
    assert_allclose(hertz(crane_frame(segment.checked), 30.0), hertz(crane_frame(uniform.checked), 30.0), rtol=1e-14)
    assert largest_difference(run_case(uniform), run_case(segment)) < 1e-9


@pytest.mark.parametrize("softening", [False, True])
def test_run_of_a_segmented_tower_is_that_of_the_model_built_by_hand(tmp_path, softening):
    case = load_case(write_case(tmp_path, SEGMENTS), [f"model.weight_softening={json.dumps(softening)}"])
    crane = TowerCrane("by hand", BY_HAND, Beam(40.0, 100.0, 210e9, 0.003), 10.0, 150.0, 10e3, 300.0)
    model = in_plane(crane, Load(800.0), weight_softening=softening)
    way = {"trolley": trapezoid(5.0, 30.0, 0.8, 0.1), "rope": rest(12.0)}
    found, wanted = run_case(case), simulate(model, way, 20.0)
    assert largest_difference(found, wanted) < 1e-9
    # Softening by 12 t on top is no small thing: the bound above would show a tower without it.
    stiff = simulate(replace(model, weight_softening=not softening), way, 20.0)
    assert largest_difference(found, stiff) > 1e-4


def test_frame_of_a_segmented_tower_is_that_built_by_hand(tmp_path):
    case = load_case(write_case(tmp_path, SEGMENTS))
    top = {3: EndBody(16.5e3, 150.0 * 10.0**3 / 3 + 10e3 * 10.0**2 + 5000.0 * 11.5e3 / 16.5e3, 5000.0 / 16.5e3)}
    tower = replace(BY_HAND, bodies={**BY_HAND.bodies, **top})
    frame = CraneFrame(tower, Chain((JIB,)), None, 300.0, 800.0, 12.0)
    assert_allclose(hertz(crane_frame(case.checked), 17.0), hertz(frame, 17.0), rtol=1e-12)
    heavy = replace(frame, tower=replace(tower, gravity=9.81))
    assert_allclose(hertz(crane_frame(case.checked, weight=True), 17.0), hertz(heavy, 17.0), rtol=1e-12)


def test_a_counter_jib_that_bends(tmp_path):
    bends = (
        'counterweight = "10 t"',
        'counterweight = "10 t"\nyoungs_modulus = "210 GPa"\nsecond_moment_of_area = 1e-3',
    )
    path = write_case(tmp_path, UNIFORM, bends)
    case = load_case(path)
    counter = Chain((Segment(10.0, 150.0, 210e6),), {1: EndBody(10e3)})
    tower = Chain((Segment(30.0, 300.0, 210e7),))
    frame = CraneFrame(tower, Chain((JIB,)), counter, 300.0, 800.0, 12.0)
    assert_allclose(hertz(crane_frame(case.checked), 17.0), hertz(frame, 17.0), rtol=1e-13)
    assert crane_of(case.checked).counter_jib == counter
    # Ever stiffer it comes to a rigid one, as one over its stiffness.
    (tmp_path / "rigid").mkdir()
    plain = load_case(write_case(tmp_path / "rigid", UNIFORM))
    gaps = []
    for inertia in (1e-3, 1, 10):
        stiff = load_case(path, [f"crane.counter_jib.second_moment_of_area={inertia}"])
        found, rigid = (hertz(crane_frame(one.checked), 17.0) for one in (stiff, plain))
        gaps.append(abs(found / rigid - 1.0).max())
    assert gaps[0] > 0.1
    assert_allclose(gaps[1] / gaps[2], 10.0, rtol=0.02)


def test_the_shipped_laced_tower_is_the_published_crane_on_its_lattice():
    laced = load_case("towers/laced")
    published = load_case("qtz5613/condition-3", ["crane.tower.beam=shear-flexible"])
    in_its_plane = replace(crane_of(published.checked), jib_lateral=None, shaft=None)
    assert replace(crane_of(laced.checked), name="QTZ5613") == in_its_plane
    assert motions_of(laced)["trolley"].switch_times == pytest.approx(motions_of(published)["trolley"].switch_times)
    # Lacing as soft as this costs the first mode, which the slewing part's inertia governs, next to nothing.
    stated = crane_of(load_case("qtz5613/condition-3").checked).tower_modes(4).frequencies_hz
    loss = crane_of(laced.checked).tower_modes(4).frequencies_hz / stated - 1.0
    assert_allclose(loss, [-0.00665, -0.17462, -0.42957, -0.57459], atol=1e-4)


RIGID = ["crane.counter_jib={length=11, mass_per_length=180, counterweight=10300}"]


@pytest.mark.parametrize(("name", "rigid"), [("towers/laced", []), ("towers/stepped", []), ("towers/tapered", RIGID)])
def test_many_modes_of_a_shipped_tower_reach_the_exact_crane(name, rigid):
    case = load_case(name, rigid)
    position = modes_of(case.checked, motions_of(case)["trolley"]).trolley_positions[-1]
    exact = hertz(crane_frame(case.checked, weight=case.checked.model.weight_softening), position, 5)
    found = [plane_modes(tower_model(case.checked, **modes), position, case.rope.length)[0][:5] / (2 * np.pi)
             for modes in ({}, {"tower_modes": 10, "jib_vertical_modes": 12})]  # fmt: skip
    # Modes that are left out make a crane too stiff; mass on horizontals, a flexibility in few shapes, a little soft.
    assert np.all(found[1] / exact > 1.0 - 1e-6)
    assert np.all(found[0] / found[1] > 1.0 - 1e-9)
    assert_allclose(found[1], exact, rtol=6e-6)
    assert_allclose(found[0], exact, rtol=6e-4)


@pytest.mark.parametrize("name", TOWERS)
def test_shipped_towers_answer_every_question(name, capsys):
    case = load_case(name, ["run.duration=6 s"])
    report = natural_frequencies(case)
    json.dumps(report)
    modes_tables(report)
    shown = capsys.readouterr().out
    frequencies = report["tower"]["frequencies_hz"]
    assert all(f"{frequency:.6f}" in shown for frequency in frequencies)
    assert all(row["swing_mode"] == 1 and len(row["frequencies_hz"]) == 5 for row in report["crane"])
    result = record_case(case)
    summary = summarise(case, result)
    assert (summary["outcome"], summary["energy_balance"]["relative_gap"] < 1e-8) == ("finished", True)
    linear = linearise(tower_model(case.checked), motions_of(case), outputs=[])
    swing = min(value.frequency for value in linear.eigenvalues() if value.value.imag > 0)
    assert_allclose(swing, report["crane"][0]["frequencies_hz"][0], rtol=3e-6)
    assert len(summary["assumed"]) >= 6


def test_small_slopes_are_judged_by_the_whole_tower():
    case = load_case("towers/stepped", ["run.duration=0.1 s"])
    result = record_case(case)
    assert not any("tower tip" in notice for notice in summarise(case, result)["notices"])
    result["tower_tip_displacement"].values[0] = 6.1
    assert any("tower tip displacement reaches 10%" in notice for notice in summarise(case, result)["notices"])


def test_a_segmented_tower_on_the_command_line(tmp_path):
    done = towercrane("run", "towers/stepped", "--set", "run.duration=3 s", "--out", str(tmp_path))
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "modes.png").stat().st_size > 10_000
    assert json.loads((tmp_path / "summary.json").read_text("utf-8"))["outcome"] == "finished"


def test_a_load_on_the_ground_is_never_pulled_and_the_note_says_when_it_leaves():
    case = load_case("qtz5613/lift-off", ["run.duration=5 s"])
    summary = summarise(case, record_case(case))
    assert summary["peaks"]["load_ground_force"]["minimum"] == 0.0
    assert any("lifted off at 3.757 s" in notice for notice in summary["notices"])
