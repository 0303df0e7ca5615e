"""What a run reports of its vibration, beside signals of known frequencies and however far apart its rows are."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from towercrane import load_case
from towercrane.cranes.registry import KINDS
from towercrane.results.measures import gap
from towercrane.results.recording import Quantity, Recording
from towercrane.results.spectral_lines import lines
from towercrane.runs.run import record_case
from towercrane.runs.summary import peaks, summarise
from towercrane.runs.sweep import sweep
from towercrane.runs.vibration import cycles, vibration
from towercrane.simulation.simulate import LOOK, MOST_LOOKS, looks_per_row, rows_of

SIGNALS = KINDS["tower"].signals
TIMES = np.arange(2401) * 0.05
CASE, CHANGES = "qtz5613/condition-3", ["run.duration=200 s", "solver.rtol=1e-6", "solver.atol=1e-8"]


def sines(times, *parts):
    """Sum of sines, each of a frequency, an amplitude and a phase."""
    return sum(a * np.sin(2.0 * np.pi * f * times + p) for f, a, p in parts)


@pytest.fixture(scope="module")
def runs():
    """The same run with rows 0.05, 1 and 8 s apart."""
    cases = {step: load_case(CASE, [*CHANGES, f"run.output_step={step} s"]) for step in (0.05, 1, 8)}
    return {step: (case, record_case(case)) for step, case in cases.items()}


@pytest.mark.parametrize("step", [1, 8])
def test_reports_do_not_hang_on_how_far_apart_the_rows_are(runs, step):
    fine, coarse = (summarise(*runs[s]) for s in (0.05, step))
    assert_allclose(fine["swing_period_s"], 8.5138, atol=2e-3)
    assert_allclose(fine["spectrum_peaks_hz"], [0.1175, 0.3123, 0.8028], atol=2e-3)
    for name, peak in fine["peaks"].items():
        for key, value in peak.items():
            # Looks are at times that differ by rounding, and the run is taken up again from other states.
            near = pytest.approx(value, rel=1e-8, abs=1e-6) if key != "units" else value
            assert coarse["peaks"][name][key] == near, name
    for key in ("swing_period_s", "spectrum_peaks_hz", "spectrum_other_hz", "notices"):
        assert coarse[key] == (fine[key] if key == "notices" else pytest.approx(fine[key], rel=1e-12)), key
    assert coarse["energy_balance"]["largest_gap_j"] == pytest.approx(fine["energy_balance"]["largest_gap_j"])
    assert (coarse["look_step_s"], coarse["output_step_s"]) == (LOOK, step)


@pytest.mark.parametrize("step", [1, 8])
def test_rows_are_those_that_were_asked_for(runs, step):
    recording, fine = runs[step][1], runs[0.05][1]
    rows = recording.rows
    assert_array_equal(rows.times, np.arange(200 // step + 1) * float(step))
    every = round(step / LOOK)
    for name, quantity in rows.data_vars.items():
        assert_array_equal(quantity.values, recording[name].values[::every])
        assert_allclose(quantity.values, fine[name].values[::every], rtol=1e-11, atol=1e-12)
    assert fine.rows is fine


def test_a_data_set_of_coarse_rows_gives_no_frequencies(runs):
    case = runs[8][0]
    summary = summarise(case, record_case(case).rows)
    assert summary["look_step_s"] == 8.0
    assert summary["swing_period_s"] is None
    assert summary["spectrum_peaks_hz"] == summary["spectrum_other_hz"] == []
    assert summary["spectrum_to_hz"] is None
    unseen = [said for said in summary["notices"] if "looks 8 s apart" in said]
    assert len(unseen) == 2
    assert "too far for the load's swing" in unseen[0]
    assert "nothing above 0.0625 Hz" in unseen[1]
    assert "the crane has 0.1175 Hz" in unseen[1]


def test_a_run_that_ends_early_keeps_its_last_row_between_the_rows():
    case = load_case("qtz5613/condition-4-zero", ["rope.slack=stop", "run.output_step=5 s", "run.duration=60 s"])
    recording = record_case(case)
    assert recording.attrs["outcome"] == "slack rope"
    assert_array_equal(recording.rows.times, [0.0, 5.0, 10.0, recording.attrs["end_time"]])
    assert 11.0 < recording.rows.times[-1] < 12.0
    assert recording.rows["hoist_rope_force"].values[-1] == recording["hoist_rope_force"].values[-1]


def test_what_follows_the_last_row_is_seen():
    """Rows at 0, 50 and 100 s of 120."""
    case = load_case(CASE, ["run.output_step=50 s"])
    recording = record_case(case)
    assert_array_equal(recording.rows.times, [0.0, 50.0, 100.0])
    assert recording.times[-1] == 120.0
    assert summarise(case, recording)["peaks"]["jib_tip_deflection"]["minimum_time_s"] > 100.0


def test_extremes_of_a_sweep_are_those_of_the_looks(runs):
    found = sweep(runs[8][0], {"payload.mass": [800.0, 1200.0]}, series=True)
    expected = peaks(runs[8][1])
    for name in ("tower_tip_displacement", "sway_radial", "hoist_rope_force", "jib_tip_deflection"):
        assert float(found[f"{name}_max"][0]) == pytest.approx(expected[name]["maximum"], rel=1e-12)
        assert float(found[f"{name}_min"][0]) == pytest.approx(expected[name]["minimum"], rel=1e-12)
        assert float(found[f"{name}_max_time"][0]) == expected[name]["maximum_time_s"]
        assert_allclose(found[name].values[0], runs[8][1].rows[name].values, rtol=1e-11, atol=1e-12)
    assert_array_equal(found["time"], runs[8][1].rows.times)


def test_a_promise_rests_on_looks():
    promises = []
    for step in ("0.05 s", "20 s"):
        case = load_case("qtz5613/within-1e-3", ["run.duration=60 s", f"run.output_step={step}"])
        promises.append(summarise(case, record_case(case))["accuracy"]["outputs"])
    assert promises[0] == promises[1]


def test_looks_are_near_each_other_and_not_too_many():
    assert looks_per_row(600.0, 0.05) == looks_per_row(600.0, 0.01) == 1
    assert [looks_per_row(600.0, step) for step in (0.0501, 0.15, 1.0, 1.1, 600.0)] == [2, 3, 20, 22, 12000]
    assert looks_per_row(1e6, 100.0) == MOST_LOOKS * 100 // 1_000_000
    assert looks_per_row(1e6, 1.0) == 1
    times = rows_of(1.0, 0.3, 6)
    assert_allclose(times, np.arange(21) * 0.05, atol=1e-15)
    assert_array_equal(times[::6], rows_of(1.0, 0.3))


def test_no_peak_is_missed_named_or_made_up():
    """Sums of sines with all frequencies known: the crane's own, sums and a difference of its swings', and others."""
    signal = sines(
        TIMES,
        (0.12, 1.0, 0.3),
        (0.24, 0.6, 1.0),
        (0.05, 0.5, 2.0),
        (0.8, 0.7, 0.1),
        (0.55, 0.4, 0.2),
        (2.3, 0.3, 0.0),
    )
    found = lines(TIMES, signal, [0.12, 0.8, 3.1], [0.12, 0.17], LOOK)
    assert_allclose(found.own, [0.05, 0.12, 0.24, 0.8], atol=1e-3)
    assert_allclose(found.others, [0.55], atol=1e-3)
    assert found.highest == pytest.approx(10.0)
    assert found.beyond == []


def test_what_is_folded_is_no_peak():
    """At 20 Hz a mode of 18.75 Hz shows at 1.25 Hz, and one of 31 Hz at 9."""
    signal = sines(TIMES, (0.3, 1.0, 0.0), (18.75, 0.5, 1.0), (31.0, 0.4, 0.5), (2.0, 0.3, 0.0))
    found = lines(TIMES, signal, [31.0, 0.3, 18.75], [], LOOK)
    assert_allclose(found.own, [0.3], atol=1e-3)
    assert_allclose(found.others, [2.0], atol=1e-3)
    assert found.beyond == [18.75, 31.0]


def test_coarse_samples_of_fast_modes_have_no_spectrum():
    slow, times = sines(TIMES[::20], (0.3, 1.0, 0.0)), TIMES[::20]
    assert lines(times, slow, [0.3, 0.8], [], LOOK) == ([], [], None, [0.8])
    assert_allclose(lines(times, slow, [0.3, 0.49], [], LOOK).own, [0.3], atol=1e-3)
    assert lines(times[:2], slow[:2], [0.3], [], LOOK) == ([], [], None, [])


def made(times, tower, swing, **attrs):
    """Recording with these signals."""

    def of(values, units):
        return Quantity(("time",), values, units, "made")

    return Recording(
        times,
        {
            "tower_tip_displacement": of(tower, "m"),
            "sway_radial": of(swing, "rad"),
            "rope_length": of(np.full(len(times), 10.0), "m"),
        },
        {"gravity": 9.81, "output_step": times[1], **attrs},
    )


def test_the_free_vibration_counts_its_own_cycles():
    """A free span of two cycles of the slowest mode is none, however late it begins; one of four is."""
    before, after = TIMES < 80.0, TIMES >= 80.0
    tower = sines(TIMES, (0.5, 1.0, 0.0)) * before + sines(TIMES, (1.1, 1.0, 0.0)) * after
    recording = made(TIMES, tower, 1e-2 * sines(TIMES, (0.157, 1.0, 0.0)))
    free = slice(int(np.argmax(after)), None)
    assert cycles(TIMES[free], 0.05) == pytest.approx(2.0)
    few = vibration(SIGNALS, recording, free, [0.157], [0.05, 1.1], lambda: [0.1, 0.5])
    assert_allclose(few.lines.own, [0.5, 1.1], atol=5e-3)
    many = vibration(SIGNALS, recording, free, [0.157], [0.1, 1.1], lambda: [0.1, 0.5])
    assert_allclose(many.lines.own, [1.1], atol=5e-3)
    assert many.lines.others == []


def test_the_period_is_that_of_the_free_swing():
    swing = np.where(TIMES < 60.0, 0.02 * np.sin(2.0 * np.pi * TIMES / 3.0), 0.01 * np.cos(2.0 * np.pi * TIMES / 6.4))
    recording = made(TIMES, np.zeros_like(TIMES), swing)
    seen = vibration(SIGNALS, recording, slice(1200, None), [], [0.157], list)
    assert_allclose(seen.period, 6.4, rtol=1e-3)
    assert seen.unseen == []
    assert vibration(SIGNALS, recording, slice(2400, None), [], [0.157], list).period is None


def test_samples_too_few_for_a_swing_give_no_period():
    """8 samples of the pendulum's 6.34 s are 0.79 s apart; a faster known swing asks for more."""
    for step, swings, told in ((0.75, [], True), (0.85, [], False), (0.75, [0.2], False)):
        times = np.arange(0.0, 200.0, step)
        recording = made(times, np.zeros_like(times), 0.01 * np.cos(2.0 * np.pi * times / 6.35))
        seen = vibration(SIGNALS, recording, slice(None), swings, [], list)
        assert (seen.period is not None) == told, (step, swings)
        assert bool(seen.unseen) != told


def test_one_row_says_nothing():
    recording = made(np.array([0.0, 0.1]), np.zeros(2), np.zeros(2))
    seen = vibration(SIGNALS, recording, slice(2, None), [0.2], [0.2, 1.0], list)
    assert seen.report()["spectrum_peaks_hz"] == []
    assert seen.period is None
    case = load_case(CASE, ["run.duration=0.05 s"])
    summary = summarise(case, record_case(case))
    assert (summary["look_step_s"], summary["swing_period_s"], summary["spectrum_to_hz"]) == (0.05, None, None)


def test_outputs_are_compared_at_the_same_times(runs):
    """Looks at one run beside the rows of another: every twentieth time is of both."""
    assert gap(runs[0.05][1], runs[1][1].rows, "tower_tip_displacement") < 1e-12
    moved = made(TIMES[::20] + 1.0, TIMES[::20] * 2.0, TIMES[::20])
    assert gap(made(TIMES, TIMES, TIMES), moved, "tower_tip_displacement") == pytest.approx(120.0 - 2.0)
