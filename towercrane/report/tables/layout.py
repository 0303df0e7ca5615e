"""What the tables of all reports share: a console, a table, and the assumed values below it."""

from __future__ import annotations

import re
from collections import Counter
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

WIDTH_OF_A_PIPE = 120
"""Columns where no terminal tells its width."""


def console_of_reports(width: int | None = None) -> Console:
    """Console as wide as the terminal, or as a pipe should be."""
    from towercrane.report.tables.console import ReportConsole

    return ReportConsole(width=None if ReportConsole().is_terminal else width or WIDTH_OF_A_PIPE)


def report_table(title: str, *columns: str, left: int = 1) -> Table:
    """Empty table with a title and columns, the first ``left`` of them aligned left."""
    from rich.table import Table

    table = Table(title=title, title_justify="left", title_style="bold", header_style="bold")
    for number, column in enumerate(columns):
        table.add_column(column, justify="left" if number < left else "right", overflow="fold")
    return table


MOST_ASSUMED = 8
"""Assumed values that are explained one by one."""


def said(console: Console, sentences: list[str]) -> None:
    """Say what a report leaves out."""
    for sentence in sentences:
        console.print(sentence)


MOST_NAMED = 40
"""Assumed values that are named one by one; of more it is told how many are in each table."""


def assumed_values(console: Console, assumed: list[dict[str, str]]) -> None:
    """Name the values that no source gives, with reasons where they are few."""
    if len(assumed) <= MOST_ASSUMED:
        for entry in assumed:
            console.print(f"assumed  {entry['key']} = {entry['value']}: {entry['why']}")
        return
    named = [f"{entry['key']} = {entry['value']}" for entry in assumed]
    if len(assumed) > MOST_NAMED:
        tables = Counter(_table_of(entry["key"]) for entry in assumed)
        named = [f"{count} in [{table}]" for table, count in tables.items()]
    listed = ", ".join(named)
    console.print(f"assumed  {len(assumed)} values that no source gives (reasons: --json): {listed}", markup=False)


def by_table(keys: list[str]) -> str:
    """Keys of a case together with others of their table; those of a list are one."""
    found: dict[str, dict[str, None]] = {}
    for key in keys:
        found.setdefault(_table_of(key), {})[key.rpartition(".")[2]] = None
    return "; ".join(f"{', '.join(names)} in [{table}]" for table, names in found.items())


def _table_of(key: str) -> str:
    """Table of a case that a key is in; those of a list are one."""
    return re.sub(r"\.\d+", "", key).rpartition(".")[0]
