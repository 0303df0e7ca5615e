"""Every run of a sweep is the single run of its case, whatever varies; one that a single run refuses is a row."""

import csv
import json
import re
from typing import Literal, get_args, get_origin

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples.program import towercrane

import towercrane.runs.sweep as sweeps
from towercrane import load_case, run_case, sweep
from towercrane.cases.kinds import unit_of
from towercrane.cases.plausibility import ranges_in
from towercrane.cranes.registry import KINDS
from towercrane.cranes.tower.file.build import tower_model
from towercrane.results import files as results
from towercrane.runs.summary import accuracy, peaks
from towercrane.runs.sweep import grid
from towercrane.runs.sweep_data import BAD_INPUT
from towercrane.runs.sweep_report import report
from towercrane.runs.variants import Variants
from towercrane.schema.faults import CaseError
from towercrane.schema.fields import known_keys, tables
from towercrane.schema.units import to_si

SHORT = ("run.duration=3 s", "solver.rtol=1e-4", "solver.atol=1e-6")
HOIST = 'motion.hoist={shape="trapezoid", end="18 m", speed="0.5 m/s", acceleration="0.2 m/s^2"}'
FOUNDATION = 'crane.foundation={rotation_stiffness="12 GN m/rad"}'


@pytest.fixture(autouse=True)
def few_runs_share_lanes(monkeypatch):
    monkeypatch.setattr(sweeps, "FEWEST", 1)


def single_run(case, **changes):
    settings = [f"{key}={value if isinstance(value, str) else json.dumps(value)}" for key, value in changes.items()]
    return run_case(load_case(case.path, [*case.changes, *settings]))


def assert_single_runs(case, vary):
    """Every run of the sweep as the single run has it: outcome, steps, extremes, faults, promises."""
    count = len(next(iter(vary.values())))
    alone = []
    for run in range(count):
        try:
            alone.append(single_run(case, **{key: values[run] for key, values in vary.items()}))
        except CaseError as refused:
            alone.append(refused)
    if all(isinstance(run, CaseError) for run in alone):
        with pytest.raises(CaseError) as raised:
            sweep(case, vary)
        assert [(f.key, f.wanted) for f in raised.value.faults] == [(f.key, f.wanted) for f in alone[0].faults]
        return None
    data = sweep(case, vary)
    for run, single in enumerate(alone):
        row = data.isel(run=run)
        if isinstance(single, CaseError):
            assert row["outcome"].item() == BAD_INPUT
            assert all(fault.wanted in row["fault"].item() for fault in single.faults)
            continue
        assert row["outcome"].item() == single.attrs["outcome"]
        assert float(row["end_time"]) == single.attrs["end_time"]
        assert int(row["evaluations"]) == single.attrs["evaluations"]
        promised = accuracy(single)
        assert "accuracy" not in data or row["accuracy"].item() == (promised["outcome"] if promised else "")
        found_alone = peaks(single)
        for name, found in found_alone.items():
            size = max(abs(found["maximum"]), abs(found["minimum"]), 1e-300)
            assert_allclose(row[f"{name}_max"], found["maximum"], rtol=0, atol=1e-12 * size)
            assert_allclose(row[f"{name}_min"], found["minimum"], rtol=0, atol=1e-12 * size)
    return data


def largest_swings(data):
    return np.maximum(data["sway_radial_max"], -data["sway_radial_min"]).values


def test_ramps_are_shaped_for_the_load_and_rope_of_each_run():
    case = load_case("qtz5613/condition-3", ["motion.trolley.shape=zv", "solver.rtol=1e-5", "solver.atol=1e-7"])
    data = assert_single_runs(case, {"rope.length": [10.0, 18.0, 12.0]})
    assert_allclose(data["sway_radial_max"].values[0], 0.01020, atol=1e-5)
    case = load_case("qtz5613/condition-3", ["motion.trolley.shape=ei", *SHORT])
    assert_single_runs(case, {"payload.mass": [200.0, 900.0, 1500.0, 400.0]})


def test_each_run_is_asked_whether_it_hoists():
    # The rope hauls from every length but the one it ends at, which is that of the case.
    case = load_case("qtz5613/condition-3", [HOIST, *SHORT])
    assert_single_runs(case, {"rope.length": [18.0, 20.0, 17.0, 18.0]})
    assert_single_runs(case, {"rope.length": [18.0, 20.0, 16.0], "motion.hoist.end": [10.0, 10.0, 16.0]})


def test_what_a_tolerance_of_frequencies_leaves_out_hangs_on_each_run():
    # At 3 % the weight of the heaviest load is kept and that of the lightest is not.
    case = load_case("qtz5613/condition-3", ["accuracy.frequency=3e-2", FOUNDATION, *SHORT])
    loads = [100.0, 40e3, 900.0]
    softened = [
        tower_model(load_case(case.path, [*case.changes, f"payload.mass={m}"]).checked).weight_softening
        for m in loads
    ]
    assert softened == [False, True, False]
    assert_single_runs(case, {"payload.mass": loads})


def test_a_combination_that_a_single_run_refuses_is_a_row_with_its_fault():
    case = load_case("qtz5613/condition-3", SHORT)
    # The case's own rope, 18 m, is too long for the lowest tower, but those of its runs are not.
    heights, ropes = [50.0, 23.8, 9.0], [8.0, 8.5, 9.0, 20.0, 40.0]
    data = assert_single_runs(case, grid({"crane.tower.height": heights, "rope.length": ropes}))
    bad = [rope > height for height in heights for rope in ropes]
    assert [fault != "" for fault in data["fault"].values] == bad
    assert np.array_equal(np.isnan(data["sway_radial_max"]), bad)
    assert "rope.length: wanted rope lengths above 0 and up to 23.8 m" in data["fault"].values[9]
    data = assert_single_runs(case, {"payload.mass": [500.0, 0.0, 2e7, 700.0, float("nan"), 800.0]})
    assert data["outcome"].values.tolist() == ["finished", BAD_INPUT, BAD_INPUT, "finished", BAD_INPUT, "finished"]


def test_the_command_codes_and_says_bad_combinations(tmp_path):
    changes = [part for change in SHORT for part in ("--set", change)]
    vary = "--vary", "crane.tower.height=50 m,23.8 m", "--vary", "rope.length=20,40"
    done = towercrane("sweep", "qtz5613/condition-3", *vary, *changes, "--out", str(tmp_path), "--json")
    assert done.returncode == 1
    assert "bad input in 1 of 4 runs" in done.stderr
    report = json.loads(done.stdout)
    assert report["outcomes"] == {"finished": 3, BAD_INPUT: 1}
    (bad,) = report["faults"]
    assert bad["at"] == {"crane.tower.height": 23.8, "rope.length": 40.0}
    assert results.load(tmp_path / "sweep.nc")["fault"].values.tolist() == ["", "", "", bad["fault"]]
    with open(tmp_path / "sweep.csv", encoding="utf-8", newline="") as file:
        assert [row["fault"] for row in csv.DictReader(file)] == ["", "", "", bad["fault"]]
    done = towercrane("sweep", "qtz5613/condition-3", *vary, *changes, "--out", str(tmp_path))
    assert "bad input at crane.tower.height = 23.8, rope.length = 40.0" in done.stdout
    assert "rope.length=20.0" in done.stdout.splitlines()[-1]


def test_scenes_methods_and_tolerances_may_vary_from_run_to_run():
    case = load_case("qtz5613/slewing", ["run.duration=1 s", "model.tower_modes=1", "model.torsion_modes=0"])
    assert_single_runs(case, {"solver.method": ["dop853", "scipy-rk45"], "solver.rtol": [1e-4, 1e-5]})
    # The first stays in the jib's plane, and shares lanes; the second turns.
    case = load_case("qtz5613/slewing", ["model.tower_modes=1"])
    vary = {"motion.slewing.end": ["0 deg", "30 deg"], "run.duration": [1.0, 1.0]}
    turning = assert_single_runs(case, vary)
    assert "slewing_torque" in json.loads(turning.attrs["outputs"])
    assert np.isnan(turning["slewing_torque_max"].values).tolist() == [True, False]
    told = report(turning, 1.0)["notices"]
    assert any("1 of 2 runs do not have" in said and "slewing torque" in said for said in told)
    assert any(said.startswith("nothing turns the head") for said in told)
    # What both have is known of both.
    for name in ("base_moment_y", "trolley_force", "hoist_rope_force"):
        assert np.isfinite(turning[f"{name}_max"].values).all(), name
    case = load_case("qtz5613/condition-3", SHORT)
    methods = {"solver.method": ["dop853", "scipy-dop853", "dopri5"], "solver.rtol": [1e-4, 1e-5, 1e-3]}
    data = assert_single_runs(case, methods)
    assert "rtol" not in data.attrs
    assert any("1e-03" in said or "0.001" in said for said in json.loads(data.attrs["notices"]))


def test_another_load_shares_all_that_does_not_hang_on_it():
    for softening in (False, True):
        options = [f"model.weight_softening={json.dumps(softening)}", "model.jib_vertical_damping_ratio=0.01"]
        light, heavy = (
            tower_model(load_case("qtz5613/condition-3", [*options, m]).checked)
            for m in ("payload.mass=100", "payload.mass=9e4")
        )
        shared, own = light.with_load(heavy.load).system, heavy.system
        assert shared.alike(own)
        assert np.array_equal(shared.numbers, own.numbers)
        assert np.array_equal(shared.constants.stiffness, light.constants.stiffness) is not softening
        assert shared.fastest() == own.fastest()


def test_heads_that_stand_at_angles_of_their_own_keep_them_in_lanes():
    variants = Variants(
        load_case("qtz5613/condition-3", ["motion.slewing.shape=rest"]), {"motion.slewing.start": [0, 1]}
    )
    assert [variants[run].run.model.heading for run in range(2)] == [0.0, 1.0]


def leaf_keys(kind):
    """Keys of a kind of case that hold one value and not a name, and what they admit."""
    for key in known_keys(KINDS[kind].tables):
        field, within = None, [KINDS[kind].tables]
        for name in key.split("."):
            known = [item for table in within for item in table.model_fields.items()]
            fields = [field for own, field in known if name == (field.alias or own)]
            field, within = fields[0], [inner for f in fields for inner in tables(f.annotation)]
        first = key.split(".")[0]
        if not within and first not in ("title", "kind", "allow_implausible", "modes", "map", "expect", "accuracy"):
            yield key, field.annotation


def drawn(random, case, key, annotation):
    """A value near that of the case, or one of its range; None for keys that hold text or lists."""
    unit, tree = unit_of(case.kind, key), case.as_written
    if get_origin(annotation) is Literal:
        return str(random.choice(get_args(annotation)))
    if annotation is bool:
        return bool(random.integers(2))
    if annotation is int:
        return int(random.integers(0, 4))
    if unit is None:
        return None
    for name in key.split("."):
        tree = tree.get(name, {}) if isinstance(tree, dict) else {}
    written = tree.get("value") if isinstance(tree, dict) else tree
    if written is not None and not isinstance(written, list):
        return to_si(written, unit) * random.uniform(0.85, 1.1)
    rule = ranges_in((key,), case.kind).get(key)
    return None if rule is None else float(np.exp(random.uniform(np.log(rule.low), np.log(rule.high))))


QUICK = ("run.duration=1 s", "solver.rtol=1e-4", "solver.atol=1e-6")
BASES = {
    "plain": ("qtz5613/condition-3", QUICK, 8),
    "shaped": ("qtz5613/condition-3", ("motion.trolley.shape=zvd", *QUICK), 4),
    "hoisting": ("qtz5613/condition-3", (HOIST, "motion.hoist.end=9 m", *QUICK), 4),
    "frequency": ("towers/tapered", ("accuracy.frequency=2e-2", *QUICK), 3),
    "target": ("qtz5613/condition-3", ("accuracy.target=3e-2", "run.duration=2 s"), 2),
    "space": ("qtz5613/soft-drive", ("model.tower_modes=1", *QUICK), 2),
    "multi-mass": ("slewing/multi-mass/example-1", QUICK, 2),
    "enhanced": ("slewing/enhanced/example-1", QUICK, 2),
    "basic": ("slewing/basic/example-1", QUICK, 2),
    "jib": ("jib-crane/plan", QUICK, 2),
    "overhead": ("overhead-crane/travel", QUICK, 2),
}


@pytest.mark.parametrize("base", BASES)
def test_drawn_keys_of_every_kind_give_the_single_runs(base):
    name, changes, sweeps = BASES[base]
    case, random = load_case(name, changes), np.random.default_rng(sum(map(ord, base)))
    keys = [(key, annotation) for key, annotation in leaf_keys(case.kind) if key.partition(".")[0] != "run"]
    for _ in range(sweeps):
        vary = {}
        wanted = int(random.integers(2, 4))
        while len(vary) < wanted:
            often = random.uniform() < 0.4
            key, annotation = keys[random.integers(len(keys))]
            if often:
                key, annotation = [("payload.mass", float), ("rope.length", float)][random.integers(2)]
            values = [drawn(random, case, key, annotation) for _ in range(3)]
            if None not in values and key not in vary:
                vary[key] = values
        assert_single_runs(case, vary)


@pytest.mark.parametrize(
    ("name", "options", "masses"),
    [
        ("qtz5613/gusts-working", ["model.torsion_modes=1", "model.tower_modes=1", *SHORT], [500.0, 900.0]),
        ("jib-crane/combined", SHORT, [150.0, 90.0]),
        ("overhead-crane/travel", SHORT, [3e3, 800.0]),
        ("slewing/basic/example-1", ["crane.drive.stiff_stiffness=20 N m/rad", *SHORT], [60.0, 120.0]),
        # Its coupling has a corner; as many as share lanes.
        ("slewing/basic/example-1", SHORT, [float(mass) for mass in range(60, 150, 10)]),
    ],
)
def test_cranes_of_every_kind_are_swept_with_all_their_outputs(name, options, masses):
    data = assert_single_runs(load_case(name, options), {"payload.mass": masses})
    assert {"total_energy", "input_work", "hoist_rope_force"} <= set(json.loads(data.attrs["outputs"]))


def test_only_the_outputs_that_are_wanted_are_kept():
    case = load_case("qtz5613/condition-3", SHORT)
    data = sweep(case, {"payload.mass": [100.0, 900.0]}, outputs=["base_moment_y", "sway_radial"])
    assert json.loads(data.attrs["outputs"]) == ["base_moment_y", "sway_radial"]
    with pytest.raises(sweeps.UnknownOutput, match=r"wanted some of .*base_moment_y.*, got 'base_momnt'"):
        sweep(case, {"payload.mass": [100.0, 900.0]}, outputs=["base_momnt"])


@pytest.mark.parametrize("count", [2, 3, 7, 9])
def test_few_runs_that_differ_in_load_and_rope_have_their_own(count, monkeypatch):
    monkeypatch.setattr(sweeps, "FEWEST", 8)
    ropes, loads = np.linspace(8.0, 16.0, count).tolist(), np.linspace(300.0, 900.0, count).tolist()
    assert_single_runs(load_case("qtz5613/condition-3", SHORT), {"rope.length": ropes})
    assert_single_runs(load_case("qtz5613/condition-3", SHORT), {"rope.length": ropes, "payload.mass": loads})


def test_an_output_that_only_some_scenes_have_may_be_asked_for():
    case = load_case("qtz5613/condition-3", ["wind.speed=8", *SHORT])
    data = sweep(case, {"wind.direction": ["90 deg", "0 deg"]}, outputs=["base_torque", "sway_radial"])
    assert np.isnan(data["base_torque_max"].values).tolist() == [False, True]
    assert np.isfinite(data["sway_radial_max"].values).all()


def test_series_of_a_rope_that_is_varied_stand_beside_its_lengths():
    data = sweep(load_case("qtz5613/condition-3", SHORT), {"rope.length": [8.0, 10.0]}, series=True)
    assert data["rope_length"].values.tolist() == [8.0, 10.0]
    assert_allclose(data["rope_length_over_time"].values, [[8.0] * len(data["time"]), [10.0] * len(data["time"])])


@pytest.mark.parametrize(
    ("vary", "options", "words"),
    [
        ({"payload.mass": "800 kg"}, {}, "vary: wanted a list of values for payload.mass, got '800 kg'"),
        ({"payload.mass": [800.0]}, {"outputs": "sway_radial"}, "outputs: wanted names in a list, got 'sway_radial'"),
    ],
)
def test_a_text_is_no_list(vary, options, words):
    with pytest.raises(ValueError, match=re.escape(words)):
        sweep("qtz5613/condition-3", vary, **options)
