"""Cases in a wind that differs from place to place: what is refused, what a run says, runs side by side."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples.case_files import only_fault

from towercrane.cases.case import load_case
from towercrane.cases.models import motions_of
from towercrane.cases.table_notices import table_notices
from towercrane.cranes.tower.file.plane import heading_of, heading_written
from towercrane.runs.run import record_case
from towercrane.runs.summary import peaks
from towercrane.runs.sweep import sweep

CASE = "qtz5613/turbulence"
STILL = ["model.tower_modes=1", "model.torsion_modes=1", "model.jib_lateral_modes=1", "model.jib_vertical_modes=1"]
RIGID = [f"model.{kind}_modes=0" for kind in ("tower", "torsion", "jib_lateral", "jib_vertical")]
SHORT = [*STILL, "run.duration=8 s", "wind.turbulence.ramp=3 s"]


@pytest.mark.parametrize(("changes", "key", "wanted"), [
    (["wind.turbulence.intensity=0.2"], "wind.turbulence.reference_class", "intensity or reference_class"),
    (["wind.turbulence.spectrum=kaiman"], "wind.turbulence.spectrum", 'one of "kaimal", "von-karman"'),
    (["wind.turbulence.seed=1.5"], "wind.turbulence.seed", "a whole number from 0"),
    (["wind.turbulence.duration=60 s"], "wind.turbulence.duration", "at least run.duration, 600 s"),
    (["wind.turbulence.ramp=700 s"], "wind.turbulence.ramp", "a ramp shorter than run.duration, 600 s"),
    (["run.duration=20 s"], "wind.turbulence.ramp", "a ramp shorter than run.duration, 20 s"),
    (["wind.turbulence.step=1 ms"], "wind.turbulence.step", "at least 0.006 s"),
    (["wind.turbulence.step=9 s", "run.duration=80 s"], "wind.turbulence.step", "a tenth of run.duration"),
    (["wind.speed=0 m/s"], "wind.speed", "a mean above 0 m/s"),
    (["wind.series=gusts.csv"], "wind.series", "a wind with a speed or a series"),
    (["wind.exponent=0.2"], "wind.exponent", 'nothing where profile = "uniform"'),
    (["wind.roughness_length=0.1 m"], "wind.roughness_length", "nothing for this wind"),
    (["wind.profile=log", "wind.roughness_length=3 m"], "wind.roughness_length", "less than the lowest height"),
    (["wind.turbulence.across=false", "wind.turbulence.across_ratio=0.7"], "wind.turbulence.across_ratio", "nothing"),
    (["wind.turbulence.length_scale=60 mm"], "wind.turbulence.length_scale", "a value from 1 to 3000 m"),
    (["wind.turbulence.sed=3"], "wind.turbulence.sed", "one of the keys spectrum, seed"),
])  # fmt: skip
def test_a_wrong_wind_is_one_message(changes, key, wanted):
    fault = only_fault(CASE, *changes)
    assert fault.key == key
    assert wanted in fault.wanted


def test_a_spectrum_that_gives_no_intensity_wants_one(tmp_path):
    text = load_case(CASE).path.read_text("utf-8")
    (tmp_path / "crane.toml").write_text((load_case(CASE).path.parent / "crane.toml").read_text("utf-8"), "utf-8")
    bare = tmp_path / "bare.toml"
    bare.write_text(text.replace('reference_class = "B"\n', ""), "utf-8")
    assert only_fault(bare).key == "wind.turbulence.intensity"
    # The Eurocode's follows from the ground, 1 / ln(23.8 / 0.05) of 12 m/s.
    (notice, *_) = table_notices(load_case(bare, ["wind.turbulence.spectrum=en-1991-1-4"]))
    assert "standard deviations of 1.95 m/s along" in notice


def test_turbulence_along_the_jib_alone_stays_in_its_plane():
    along = ["wind.direction=0 deg", "wind.turbulence.across=false"]
    for changes, heading in ((along, 0.0), (along[:1], None), (["wind.turbulence.across=false"], None)):
        case = load_case(CASE, changes)
        assert heading_of(case.checked) == heading
        assert heading_written(case.as_written) == heading
    run = record_case(load_case(CASE, [*along, *SHORT]))
    assert run.model.axes == 2
    assert run.attrs["outcome"] == "finished"
    # Energy that wind and drag put in or take is all accounted for.
    gained = run["total_energy"].values - run["total_energy"].values[0]
    assert abs(gained - run["input_work"].values).max() < 1e-8 * np.ptp(run["total_energy"].values) + 1e-6


def test_seeds_side_by_side_come_to_what_single_runs_do_after_the_ramp():
    rigid = [*SHORT, *RIGID]
    case = load_case(CASE, rigid)
    names = ["sway_tangential", "slewing_torque", "wind_speed_tip"]
    found = sweep(case, {"wind.turbulence.seed": list(range(1, 9))}, outputs=names)
    assert len(set(found["slewing_torque_max"].values)) == 8
    for seed in (1, 6):
        single = record_case(load_case(CASE, [*rigid, f"wind.turbulence.seed={seed}"]))
        for name in names:
            peak, row = peaks(single)[name], found.sel(run=seed)
            assert min(peak["maximum_time_s"], peak["minimum_time_s"]) >= 3.0
            wanted = [peak[way] for way in ("maximum", "maximum_time_s", "minimum", "minimum_time_s")]
            got = [float(row[f"{name}_{way}"]) for way in ("max", "max_time", "min", "min_time")]
            assert_allclose(got, wanted, rtol=1e-6)
    with_series = sweep(case, {"wind.turbulence.seed": list(range(1, 9))}, outputs=names, series=True)
    for ending in ("max", "max_time", "min", "min_time"):
        assert_allclose(with_series[f"slewing_torque_{ending}"], found[f"slewing_torque_{ending}"], rtol=1e-12)


def test_a_run_begins_at_rest_in_the_mean_wind_and_says_what_blows():
    run = record_case(load_case(CASE, [*SHORT, "wind.profile=power"]))
    first = run["time"].values < 0.1
    for name in ("tower_tip_displacement", "sway_tangential", "tower_tip_twist"):
        values = run[name].values
        assert np.ptp(values[first]) < 1e-4 * np.ptp(values)
    mean = 12.0 * (np.array([23.8, 8.8]) / 10.0) ** 0.2
    assert_allclose([run["wind_speed_tip"].values[0], run["wind_speed_load"].values[0]], mean, rtol=1e-12)
    assert "at 9 places" in run.attrs["notices"]


def test_a_profile_alone_needs_few_places_and_names_a_load_that_leaves_its_wind():
    steady = ["wind.speed=9 m/s", "wind.direction=90 deg", "wind.profile=log"]
    case = load_case("qtz5613/manoeuvre", steady)
    motions = motions_of(case)
    blown = {name: motion.end for name, motion in motions.items() if name.startswith("wind")}
    shares = np.log(np.array([5.95, 17.85, 23.8, 3.8]) / 0.05) / np.log(200.0)
    assert_allclose([blown[f"wind_y{node}"] for node in ("_1", "_2", "_3", "")], 9.0 * shares, rtol=1e-12)
    assert len(blown) == 9
    (notice,) = table_notices(case)
    assert "the load's wind stays that of its height at the start, 3.8 m" in notice
