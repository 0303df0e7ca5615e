"""Hard cases: each comes to what it expects, and what does not is never silent."""

import json

import pytest
from samples.program import towercrane

from towercrane.bench.runs import hard
from towercrane.cases.case import CaseError, list_cases, load_case
from towercrane.runs.run import record_case, run_case
from towercrane.runs.summary import expected, summarise

NAMES = [name for name, _ in list_cases() if name.startswith(hard.FOLDER)]
LONG = {
    "hard/one-hour",
    "hard/stiff-drive",
    "hard/friction-as-a-jump",
    "hard/modes-8-14",
    "hard/springs-a-thousandfold",
}
ENDS = {
    "hard/buckled": "tower buckled",
    "hard/slack-above-the-horizontal": "slack rope",
    "hard/slack-while-lowering": "slack rope",
    "hard/slings-slack-below-the-hook": "slack sling",
    "hard/space-gust-slackens-the-rope": "slack rope",
    "hard/zero-start-slack": "slack rope",
}


def test_every_hard_case_states_a_target_or_an_outcome():
    assert len(NAMES) >= 20
    for name in NAMES:
        expect = load_case(name).expect
        assert (expect.error is None) == (name in ENDS)
        assert expect.outcome == ENDS.get(name, "finished")
        assert expect.error is None or expect.error <= 1e-5


@pytest.mark.parametrize("name", [name for name in NAMES if name not in LONG])
def test_hard_case_comes_to_what_it_expects(name):
    record = hard.run_hard_case(name)
    assert record["met"], record
    assert record["misses"] == []
    assert record["outcome"] == ENDS.get(name, "finished")


@pytest.mark.parametrize("name", sorted(LONG))
def test_long_hard_case_keeps_its_energy(name):
    case = load_case(name, ["run.duration=2 s" if name != "hard/stiff-drive" else "run.duration=0.1 s"])
    found = expected(case, run_case(case))
    assert found == {"met": True, "misses": []}


def test_roots_and_finite_elements():
    records = {record["case"]: record for record in hard.root_records()}
    assert all(record["met"] for record in records.values()), records
    assert records["512 finite elements, past round-off"]["outcome"] == "refused"
    assert max(r["error"] for r in records.values() if r["error"] is not None) < 4e-15


def test_a_target_that_is_missed_and_an_outcome_that_is_not_met_are_told_apart():
    wanted = load_case("hard/hard-stop").expect
    assert hard.within(0.9e-6, 0.9e-6, wanted)
    assert not hard.within(1.1e-6, None, wanted)
    assert not hard.within(0.9e-6, 1.1e-6, wanted)
    assert not hard.within(None, None, wanted)
    # Without a target an end has to be named.
    assert hard.within(None, None, load_case("hard/buckled").expect)
    assert not hard.within(None, None, wanted.model_copy(update={"error": None}))


def test_runs_that_end_differently_have_no_error():
    slack = run_case(load_case("hard/slack-while-lowering"))
    whole = run_case(load_case("hard/slack-while-lowering", ["rope.slack=rod", "expect.outcome=finished"]))
    assert hard.difference("tower", slack, whole) is None
    assert hard.difference("tower", slack, slack) == 0.0
    assert hard.difference("tower", whole, whole) == 0.0


def test_a_hard_case_with_a_wrong_expectation_is_reported(monkeypatch):
    other = load_case("hard/slack-while-lowering", ["expect.outcome=finished"])
    real = hard.load_case
    monkeypatch.setattr(hard, "load_case", lambda name, changes=(): real(name, changes) if changes else other)
    record = hard.run_hard_case("hard/slack-while-lowering")
    assert not record["met"]
    assert record["misses"] == ['expected the outcome "finished", got "slack rope"']
    assert hard._row(record)[-1].startswith("NO; expected the outcome")


def test_expectations_are_checked_after_a_run():
    case = load_case("hard/hard-stop", ["run.duration=1 s", "expect.energy_gap=1e-20"])
    summary = summarise(case, record_case(case))
    assert not summary["expected"]["met"]
    assert summary["expected"]["misses"][0].startswith("expected an energy balance within 1e-20, got ")
    assert summarise(load_case("hard/hard-stop"), record_case(case))["expected"]["met"]
    plain = load_case("qtz5613/condition-3", ["run.duration=1 s"])
    assert summarise(plain, record_case(plain))["expected"] is None


def test_expect_is_a_checked_table():
    with pytest.raises(CaseError, match=r"expect\.eror"):
        load_case("qtz5613/condition-3", ["expect.eror=1e-6"])
    with pytest.raises(CaseError, match=r"expect\.error"):
        load_case("qtz5613/condition-3", ["expect.error=-1"])


@pytest.mark.parametrize(("changes", "code"), [((), 3), (("expect.outcome=finished",), 1)])
def test_run_ends_with_the_code_of_what_it_came_to(tmp_path, changes, code):
    options = [part for change in changes for part in ("--set", change)]
    command = ("run", "hard/slack-while-lowering", "--no-pictures", "--json", "--out", str(tmp_path))
    done = towercrane(*command, *options)
    assert done.returncode == code, done.stderr
    assert json.loads(done.stdout)["expected"]["met"] is (code == 3)
    assert ("expected the outcome" in done.stderr) is (code == 1)
