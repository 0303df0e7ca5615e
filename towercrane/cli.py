"""The command line: every command under its name."""

from __future__ import annotations

from typing import Annotated

import typer

from towercrane.commands.animate import animate
from towercrane.commands.bench import bench
from towercrane.commands.cases import cases_app
from towercrane.commands.compare import compare
from towercrane.commands.figures import figures
from towercrane.commands.lattice import lattice
from towercrane.commands.linearise import linearise
from towercrane.commands.loads.fatigue import fatigue
from towercrane.commands.loads.lift import lift
from towercrane.commands.map import frequency_map
from towercrane.commands.modes import modes
from towercrane.commands.run import run
from towercrane.commands.sensitivity import sensitivity
from towercrane.commands.shape import shape
from towercrane.commands.shared.program import program
from towercrane.commands.shared.terminal import tell
from towercrane.commands.sweep import sweep

app = typer.Typer(
    help="How a tower crane vibrates and how its load swings.",
    epilog="Start with: towercrane cases",
    rich_markup_mode=None,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
app.add_typer(cases_app, name="cases")
app.command()(modes)
app.command()(run)
app.command()(figures)
app.command()(animate)
app.command()(lattice)
app.command()(linearise)
app.command("map")(frequency_map)
app.command()(compare)
app.command()(sensitivity)
app.command()(sweep)
app.command()(fatigue)
app.command()(lift)
app.command()(bench)
app.command()(shape)


def _version(wanted: bool) -> None:
    if wanted:
        from towercrane.results.versions import __version__

        tell(f"towercrane {__version__}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    pass


def main() -> None:
    """Run the commands."""
    program(lambda: app)


if __name__ == "__main__":
    main()
