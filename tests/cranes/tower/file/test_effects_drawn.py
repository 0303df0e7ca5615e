"""What is said to be in the results is in them, and what is left out costs what is said; on drawn towers too."""

import json

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples.program import towercrane
from samples.tower_files import REST

from modal import Chain, EndBody, Foundation, Segment, chain_frequencies, chain_structure
from modal.structures.influence import effects_of, influence, keeping
from modal.structures.structure_modes import structure_modes
from towercrane import load_case
from towercrane.accuracy.promise import stated
from towercrane.accuracy.scene import scene_of, setting_of
from towercrane.cranes.tower.file.build import tower_model
from towercrane.cranes.tower.file.effects import effects_in, effects_report, kept_tower
from towercrane.cranes.tower.file.members import joined
from towercrane.cranes.tower.modes.parameters import as_chain
from towercrane.studies.natural import natural_frequencies

BLOCK = (
    'crane.foundation={rotation_stiffness="100 GN m/rad", translation_stiffness="8 GN/m"}',
    'crane.tower.bodies=[{height="0 m", mass="500 t"}]',
)
CASE = """
[payload]
mass = "1500 kg"
[rope]
length = "10 m"
[motion.trolley]
shape = "rest"
start = "20 m"
[run]
duration = "10 s"
[crane]
name = "Drawn"
"""
DRAWN = 25


def test_a_block_at_the_foot_vibrates_on_the_springs_that_a_clamped_tower_does_not_see():
    case = load_case("qtz5613/condition-3", [*BLOCK, "accuracy.frequency=2e-2"])
    effects = effects_in(case.checked)
    assert "foundation" in effects.kept
    # 500 t on 8 GN/m: 20.1 Hz, below the clamped tower's fourth frequency of 50 Hz.
    assert effects.influence.changes["foundation"][3] == -1.0
    assert_allclose(effects.influence.changes["foundation"][:3], effects.actual("foundation")[:3], rtol=0.07)
    assert natural_frequencies(case)["tower"]["frequencies_hz"][3] == pytest.approx(20.245, abs=2e-3)


@pytest.mark.parametrize("offset", [-6.0, 0.0, 6.0])
def test_the_prediction_of_a_foundation_knows_what_the_foot_carries(offset):
    """Offsets couple sliding and turning of the foot: a wrong sign costs 8 % here."""
    segment = Segment(23.8, 350.0, 206e9 * 0.014)
    bodies = {0: EndBody(1e5, 1e5, offset), 1: EndBody(23973.0, 9.481e6)}
    tower = Chain((segment,), bodies, Foundation(2e12, 4e9))
    plain = structure_modes(chain_structure(keeping(tower, ())), 3)
    actual = chain_frequencies(tower, 3) / plain.angular_frequencies - 1.0
    assert_allclose(influence(plain, tower).changes["foundation"], actual, rtol=0.006)


def drawn_case(random, folder):
    """A tower of one to three segments with any of taper, shear, rotary inertia, bodies and springs below."""

    def log(low, high):
        return float(np.exp(random.uniform(np.log(low), np.log(high))))

    height, count = random.uniform(15.0, 60.0), int(random.integers(1, 4))
    ends = np.sort([0.0, *random.uniform(0.2, 0.8, count - 1), 1.0]) * height
    lines = ["[crane.tower]", "youngs_modulus = 2.1e11"]
    for length in np.diff(ends):
        lines += ["[[crane.tower.segments]]", f"length = {length}", f"mass_per_length = {log(200, 1200)}"]
        lines += [f"second_moment_of_area = {log(8e-3, 6e-2)}"]
        lines += [f"shear_stiffness = {log(1e8, 1e10)}"] if random.uniform() < 0.6 else []
        lines += [f"rotary_inertia_per_length = {log(50, 2000)}"] if random.uniform() < 0.5 else []
        if random.uniform() < 0.4:
            taper = random.choice(["legs", "wedge", "cone"])
            lines += [f"top_breadth_ratio = {random.uniform(0.5, 1.0)}", f'taper = "{taper}"']
    for share in [0.0, random.uniform(0.3, 1.0)]:
        if random.uniform() < 0.5:
            lines += [
                "[[crane.tower.bodies]]",
                f"height = {share * height}",
                f"mass = {log(1e3, 5e5 if not share else 1e4)}",
            ]
            lines += [f"offset = {random.uniform(-1.0, 2.0)}"]
    lines += ["[crane.foundation]"]
    lines += [f"rotation_stiffness = {log(2e10, 2e12)}"] if random.uniform() < 0.7 else []
    lines += [f"translation_stiffness = {log(1e9, 1e11)}"] if random.uniform() < 0.5 else []
    path = folder / "case.toml"
    rest = REST.replace("[jib]", "[crane.jib]").replace("[counter_jib]", "[crane.counter_jib]")
    path.write_text(CASE + "\n".join(lines) + rest.replace("[trolley]", "[crane.trolley]"), "utf-8")
    return path, log(3e-4, 3e-2)


def test_what_is_left_out_of_drawn_towers_costs_less_than_the_tolerance(tmp_path):
    random, left_out, kept, judged = np.random.default_rng(11), 0, 0, 0
    for number in range(DRAWN):
        path, tolerance = drawn_case(random, tmp_path)
        case = load_case(path, [f"accuracy.frequency={tolerance}"])
        everything = effects_in(load_case(path, ["accuracy.frequency=1e-9"]).checked)
        assert everything.left_out == ()
        effects, whole = effects_in(case.checked), chain_frequencies(everything.results_tower, 4)
        results = chain_frequencies(effects.results_tower, 4)
        lost = np.abs(results / whole - 1.0).max()
        assert lost <= tolerance
        assert lost <= effects_report(effects)["left_out_may_cost"] / (1.0 - tolerance) + 1e-15
        # What is said to be in the results is there: in the run's model, and by another method in the table.
        assert set(effects_of(as_chain(kept_tower(case.checked)))) == set(effects.kept) - {"weight"}
        if number % 8 == 0:
            report = natural_frequencies(case)
            assert_allclose(report["tower"]["frequencies_hz"], results / (2.0 * np.pi), rtol=1e-12)
            assert_allclose(report["finite_elements"]["relative_difference"], 0.0, atol=1e-5)
        assert tower_model(case.checked).weight_softening is ("weight" in effects.kept)
        left_out, kept = left_out + len(effects.left_out), kept + len(effects.kept)
        for effect, change in effects.influence.changes.items():
            small = np.abs(change) < 0.02
            judged += np.count_nonzero(small)
            # Mutual changes of like size aside, a small change is as large as predicted.
            assert_allclose(effects.actual(effect)[small], change[small], rtol=0.1, atol=2e-5)
    assert min(left_out, kept) > DRAWN // 2
    assert judged > DRAWN


def test_weight_that_is_in_the_results_is_in_every_table():
    case = load_case("towers/laced", ["accuracy.frequency=1e-3"])
    assert "weight" in effects_in(case.checked).kept
    report = natural_frequencies(case)
    assert report["tower"]["frequencies_hz"][0] == pytest.approx(0.468872, abs=1e-6)
    assert report["finite_elements"]["frequencies_hz"][0] == pytest.approx(0.468872, abs=1e-6)
    assert setting_of(case).weight_softening
    assert stated(case, scene_of(case))["weight_softening"]
    asked = load_case("towers/laced", ["model.weight_softening=true"])
    assert natural_frequencies(asked)["tower"]["frequencies_hz"][0] == pytest.approx(0.468872, abs=1e-6)
    without = load_case("towers/laced", ["accuracy.frequency=0.05"])
    assert natural_frequencies(without)["tower"]["frequencies_hz"][0] == pytest.approx(0.47394, abs=5e-5)
    assert not stated(without, scene_of(without))["weight_softening"]


def test_a_tower_that_its_weight_buckles_has_no_frequencies():
    report = natural_frequencies(load_case("hard/buckled"))
    assert report["tower"]["outcome"] == "tower buckled"
    assert report["tower"]["frequencies_hz"] == []
    without = load_case("hard/buckled", ["model.weight_softening=false"])
    assert effects_report(effects_in(without.checked))["left_out_may_cost"] == 1.0


def test_a_map_has_the_weight_that_a_tolerance_keeps(tmp_path):
    found = {}
    for name, change in {
        "by tolerance": "accuracy.frequency=1e-3",
        "asked for": "model.weight_softening=true",
    }.items():
        out = tmp_path / name
        options = ("--positions", "2", "--payload", "800 kg", "--no-pictures", "--json", "--out", str(out))
        done = towercrane("map", "towers/laced", "--set", change, *options)
        report = json.loads(done.stdout)
        assert report["weight_softening"]
        found[name] = [branch["frequencies_hz"] for branch in report["payloads"][0]["branches"]]
    assert found["by tolerance"] == found["asked for"]


def test_modes_prints_what_each_effect_does_and_what_is_left_out():
    text = towercrane("modes", "towers/laced", "--set", "accuracy.frequency=5e-3", "--actual").stdout
    assert "softened by all weights" in text
    rows = {
        row[0]: row[1:] for row in ([c.strip() for c in line.split("│")[1:-1]] for line in text.splitlines()) if row
    }
    assert rows["weight"][:2] == ["yes", "-0.993"]
    assert rows["shear"][0] == "yes"
    assert "actual" in rows
    assert "the tower buckles under 42.47 times" in text
    text = towercrane("modes", "qtz5613/condition-3").stdout
    assert "left out: shear, weight, rotary inertia; that may cost" in text


def test_two_bodies_on_one_node_add_up_whichever_has_no_mass():
    assert joined(EndBody(0.0, 4.0), EndBody(0.0, 3.0)) == EndBody(0.0, 7.0)
    assert joined(EndBody(0.0, 4.0), EndBody(2.0, 3.0, 1.5)) == EndBody(2.0, 7.0, 1.5)
    assert joined(EndBody(2.0, 3.0, 1.5), EndBody(0.0, 4.0)) == EndBody(2.0, 7.0, 1.5)
