"""What tables on the terminal say, cell by cell, and the assumed values of made-up reports."""

ASSUMED = [{"key": "a.key", "value": "3 m", "why": "some reason"}]


def rows_of(text):
    """Cells of every row of every table, and the lines between the tables."""
    lines = text.splitlines()
    rows = [
        [cell.strip() for cell in line.strip("│┃").replace("┃", "│").split("│")] for line in lines if line[:1] in "│┃"
    ]
    return rows, [line.rstrip() for line in lines if line[:1] not in "│┃┏┡└├"]


def said(capsys):
    return rows_of(capsys.readouterr().out)
