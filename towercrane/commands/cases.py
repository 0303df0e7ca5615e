"""The command `cases`: the cases that ship with the program, listed or copied."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from towercrane.commands.shared.terminal import fail, path_of, suggest, tell, write

cases_app = typer.Typer(help="List the cases that ship with the program, or copy them.", no_args_is_help=False)


@cases_app.callback(invoke_without_command=True)
def cases(context: typer.Context) -> None:
    """List the cases that ship with the program."""
    if context.invoked_subcommand is not None:
        return
    from towercrane.cases.case import list_cases

    found = list_cases()
    width = max(len(name) for name, _ in found)
    for name, title in found:
        tell(f"{name:<{width}}  {title}")
    suggest("modes", "qtz5613/condition-3")


@cases_app.command("copy")
def copy_cases(
    folder: Annotated[
        Path,
        typer.Argument(metavar="DIR", help="Folder to copy into; it must not hold them yet.", parser=path_of),
    ],
) -> None:
    """Copy the shipped cases to a folder of yours, to change them."""
    from towercrane.cases.case import case_folder

    source = case_folder()
    found = sorted([*source.rglob("*.toml"), *source.rglob("*.csv")])
    files = {str(path.relative_to(source)): path.read_text("utf-8") for path in found}
    if existing := [str(folder / name) for name in files if (folder / name).exists()]:
        fail(f"{folder}: nothing copied, {existing[0]} and {len(existing) - 1} more would be overwritten")
    write(folder, files)
    tell(f"{len(files)} files in {folder}")
    suggest("run", str(folder / "qtz5613" / "condition-3.toml"))
