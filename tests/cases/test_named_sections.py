"""Sections that a case names: their outputs, what they have to do with collars, and faults in their tables."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from towercrane import load_case
from towercrane.cases.models import model_of, motions_of
from towercrane.linear.linearise import linearise
from towercrane.runs.run import record_case
from towercrane.schema.faults import CaseError

CASE = "qtz5613/condition-3"
SHORT = ["run.duration=1 s", "model.tower_modes=1"]


def sections(*tables):
    return "sections=[" + ", ".join(f"{{ {table} }}" for table in tables) + "]"


def test_sections_are_outputs_of_runs_and_of_linear_models():
    asked = sections('name = "mid", of = "tower", height = "12 m"', 'name = "a_1", of = "jib", position = "20 m"')
    case = load_case(CASE, [*SHORT, "model.jib_vertical_modes=1", asked])
    run = record_case(case)
    plane = {"mid": {"force_x", "force_z", "shear", "moment_y", "moment"}, "a_1": {"axial_force", "shear", "moment"}}
    names = {f"section_{name}_{kind}" for name, kinds in plane.items() for kind in kinds}
    assert {name for name in run.data_vars if name.startswith("section_")} == names
    model = model_of(case)
    shown = {output.name for output in linearise(model, motions_of(case, model)).outputs}
    assert "overturning_moment" in shown
    assert names - {"section_mid_shear"} <= shown
    # At rest nothing pushes sideways: a resultant of nothing has no slope.
    assert shown.isdisjoint({"base_shear", "section_mid_shear"})


def test_a_collar_takes_its_force_between_the_sections_beside_it():
    asked = [
        f'name = "{name}", of = "tower", height = "{height} m"'
        for name, height in (("under", 29.999999), ("over", 30.000001))
    ]
    run = record_case(load_case("towers/tied-wind", ["run.duration=0.2 s", "model.tower_modes=2", sections(*asked)]))
    held = run["collar_1_force_x"].values
    assert np.max(abs(held)) > 100.0
    jump = run["section_over_force_x"].values - run["section_under_force_x"].values
    assert_allclose(jump, held, rtol=0, atol=1e-4 * np.max(abs(held)))


@pytest.mark.parametrize(
    ("case", "table", "words"),
    [
        (CASE, 'name = "A 1", of = "jib", position = "2 m"', ["sections.0.name", "small letters", '"A 1"']),
        (CASE, 'name = "a", of = "jip", position = "2 m"', ["sections.0.of", 'did you mean "jib"?']),
        (CASE, 'name = "a", of = "jib"', ["sections.0.position", "nothing: the key is missing"]),
        (CASE, 'name = "a", of = "tower", height = "24 m"', ["a height up to 23.8 m, the end of the tower", "24 m"]),
        (CASE, 'name = "a", of = "jib", position = "56 m"', ["a position up to 55.6 m, the end of the jib"]),
        (CASE, 'name = "a", of = "jib", position = "-2 m"', ["sections.0.position", "from 0"]),
        (CASE, 'name = "a", of = "jib", position = "2 kg"', ["sections.0.position", "2 kg"]),
        (CASE, 'name = "a", of = "tower", height = "2 m", position = "2 m"', ["a height, of a section of the tower"]),
        (CASE, 'name = "a", of = "tower", hight = "2 m"', ['closest known key: "height"']),
    ],
)
def test_a_fault_in_a_section_names_its_key(case, table, words):
    with pytest.raises(CaseError) as fault:
        load_case(case, [sections(table)])
    assert len(fault.value.faults) == 1, fault.value
    for word in words:
        assert word in str(fault.value)


def test_two_sections_have_two_names():
    table = 'name = "a", of = "tower", height = "2 m"'
    with pytest.raises(CaseError, match="another section has this name"):
        load_case(CASE, [sections(table, table)])


def test_a_jib_on_ties_turns_freely_at_its_foot_and_steps_where_ties_hold_it():
    places = {"root": 0.0, "inside": 43.999999, "outside": 44.000001}
    asked = [f'name = "{name}", of = "jib", position = "{place} m"' for name, place in places.items()]
    run = record_case(load_case("hammerhead/travel", ["run.duration=2 s", sections(*asked)]))
    tension, length = run["jib_tie_2_tension"].values, np.hypot(44.0, 8.5 - 1.2)
    lift = tension * (8.5 - 1.2) / length
    # All that is beyond the hinge is in balance about it, but for terms of third order in the slopes.
    assert np.max(abs(run["section_root_moment"].values)) < 2e-5 * np.max(lift * 44.0)
    assert_allclose(run["section_root_axial_force"].values, -run["jib_compression"].values, rtol=2e-4)
    # The lower end bears half of the tie's weight.
    step = run["section_inside_shear"].values - run["section_outside_shear"].values
    assert_allclose(step, lift - 0.5 * 23.0 * length * 9.81, rtol=1e-2)
    pulled = run["section_outside_axial_force"].values - run["section_inside_axial_force"].values
    assert_allclose(pulled, tension * 44.0 / length, rtol=1e-3)
    moment = run["section_inside_moment"].values - run["section_outside_moment"].values
    # The tie pulls over the jib's axis.
    assert_allclose(moment, -pulled * 1.2, rtol=1e-2)


def test_a_jib_that_pivots_bears_nothing_about_its_hinge_and_its_own_weight_between_sections():
    asked = [f'name = "{name}", of = "jib", position = "{place} m"' for name, place in (("foot", 0), ("mid", 20))]
    case = load_case("luffing/manoeuvre", ["run.duration=3 s", sections(*asked)])
    run = record_case(case)
    assert_allclose(run["section_foot_axial_force"].values, -run["jib_compression"].values, rtol=1e-12)
    aside = run["jib_root_moment_sideways"].values
    assert_allclose(run["section_foot_moment_sideways"].values, aside, rtol=0, atol=1e-12 * np.max(abs(aside)))
    assert np.max(abs(run["section_foot_moment"].values)) < 1e-3 * np.max(abs(run["section_mid_moment"].values))
    # At rest twenty metres of jib weigh between them.
    weight = 20.0 * case.crane.jib.mass_per_length * 9.81
    angle = run["luffing_angle"].values[0] - run["tower_tip_tilt"].values[0]
    for kind, share in (("axial_force", -np.sin(angle)), ("shear", -np.cos(angle))):
        step = run[f"section_foot_{kind}"].values[0] - run[f"section_mid_{kind}"].values[0]
        assert step == pytest.approx(share * weight, rel=1e-3), kind
