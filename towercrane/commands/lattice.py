"""The command `lattice`: a crane's lattices, as the trusses that they are, beside the beams that stand for them."""

from __future__ import annotations

from towercrane.commands.shared.skeleton import begin
from towercrane.commands.shared.terminal import AsJson, CaseName, Changes


def lattice(case: CaseName, changes: Changes = None, as_json: AsJson = False) -> None:
    """Lattices of tower and jibs as beams beside their trusses.

    Deflections, frequencies, errors and times.
    """
    task = begin(case, changes, as_json=as_json)
    task.need("lattice", "lattice")
    from towercrane.report.tables.lattice import lattice_tables
    from towercrane.studies.lattice import lattice_report

    try:
        report = lattice_report(task.case)
    except ValueError as error:
        task.refuse(str(error))
    task.finish(report, lattice_tables, task.command("modes", "--actual"))
