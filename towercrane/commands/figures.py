"""The command `figures`: the figures of a paper, drawn from its four shipped cases."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from towercrane.commands.shared.terminal import (
    Changes,
    folder_for_results,
    load,
    out_option,
    suggest,
    tell,
    with_progress,
    write,
)
from towercrane.simulation import outcomes


def figures(
    out: Annotated[Path, out_option("Folder for the pictures.")] = Path("results/figures"),
    changes: Changes = None,
) -> None:
    """Draw figures 4 to 11 of the source from the corrected model.

    The source is Gao et al. (2023).
    """
    folder_for_results(out)
    from towercrane.report.plots.runs import plane
    from towercrane.runs.run import run_case

    conditions = {}
    for number in (1, 2, 3, 4):
        conditions[number] = with_progress(load(f"qtz5613/condition-{number}", changes), run_case)
        if conditions[number].attrs["outcome"] == outcomes.INTERRUPTED:
            raise KeyboardInterrupt
    drawn = plane.source_figures(conditions)
    write(out, drawn)
    tell(f"written to {out}: {', '.join(drawn)}")
    suggest("run", "qtz5613/condition-4-zero")
