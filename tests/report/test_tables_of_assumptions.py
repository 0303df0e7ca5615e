"""Values that no source gives, below a table: with reasons, by name, or counted by table of the case."""

import pytest

from towercrane.report.tables.console import ReportConsole
from towercrane.report.tables.layout import MOST_ASSUMED, MOST_NAMED, assumed_values


@pytest.mark.parametrize("count", [MOST_ASSUMED, MOST_NAMED, MOST_NAMED + 1])
def test_few_values_are_explained_some_named_and_many_counted_by_table(count):
    entries = [
        {"key": f"crane.jib.segments.{k}.lattice.height", "value": f"{k} m", "why": "tapers"} for k in range(count)
    ]
    entries[-1] = {"key": "payload.mass", "value": "2 t", "why": "a guess"}
    console = ReportConsole(width=10_000, record=True)
    assumed_values(console, entries)
    lines = console.export_text().splitlines()
    if count == MOST_ASSUMED:
        assert lines[0] == "assumed  crane.jib.segments.0.lattice.height = 0 m: tapers"
        assert len(lines) == count
        return
    (line,) = lines
    assert line.startswith(f"assumed  {count} values that no source gives (reasons: --json): ")
    if count == MOST_NAMED:
        assert line.endswith(", payload.mass = 2 t")
    else:
        assert line.endswith(f": {count - 1} in [crane.jib.segments.lattice], 1 in [payload]")
