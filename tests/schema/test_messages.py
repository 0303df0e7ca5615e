"""What messages about bad input are made of: faults as blocks, closest keys, values on one short line."""

from towercrane.cases.case import CaseError, Fault
from towercrane.schema.faults import closest, did_you_mean, shown
from towercrane.schema.text import leaves


def test_fault_reads_as_a_block():
    fault = Fault("a.toml", "rope.length", "a length", '"3 s"', "seconds?")
    assert str(fault) == 'a.toml: rope.length\n  wanted: a length\n  got:    "3 s"\n  hint:   seconds?'
    assert str(Fault("a.toml", "", "x", "y")) == "a.toml\n  wanted: x\n  got:    y"
    assert str(CaseError([fault])).startswith("1 fault in the input\n\n")


def test_closest_ignores_case_and_gives_up():
    assert closest("HEIGTH", ["height", "length"]) == "height"
    assert closest("zzz", ["height"]) is None
    assert did_you_mean("zzz", ["height"], "no") == "no"


def test_shown_is_one_short_line():
    assert shown("a\nb") == '"a\\nb"'
    assert len(shown("x" * 500)) == 80
    assert (shown({}), shown([])) == ("an empty table", "an empty list")
    assert shown(False) == "false"


def test_leaves_are_dotted():
    assert dict(leaves({"a": {"b": 1, "c": [2, {"d": 3}]}})) == {"a.b": 1, "a.c.0": 2, "a.c.1.d": 3}
