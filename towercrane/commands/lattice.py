"""The command `lattice`: a tower's lattice, as the truss that it is, beside the beams that stand for it."""

from __future__ import annotations

from towercrane.commands.shared.skeleton import begin
from towercrane.commands.shared.terminal import AsJson, CaseName, Changes


def lattice(case: CaseName, changes: Changes = None, as_json: AsJson = False) -> None:
    """The tower's lattice as beams beside its truss.

    Deflections, frequencies, errors and times.
    """
    task = begin(case, changes, as_json=as_json)
    task.need("lattice", "lattice")
    from towercrane.cranes.tower.file.members import has_lattice

    if not has_lattice(task.case.crane):
        task.refuse("crane.tower.lattice: wanted the members of the tower, or of each of its segments, got none")
    from towercrane.report.tables.lattice import lattice_tables
    from towercrane.studies.lattice import lattice_report

    try:
        report = lattice_report(task.case)
    except ValueError as error:
        task.refuse(f"crane.tower.lattice: {error}")
    task.finish(report, lattice_tables, task.command("modes", "--actual"))
