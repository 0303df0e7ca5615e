"""Tables of the tests of reports are not broken where a terminal would end."""

import pytest


@pytest.fixture
def wide(monkeypatch):
    monkeypatch.setattr("towercrane.report.tables.layout.WIDTH_OF_A_PIPE", 400)
