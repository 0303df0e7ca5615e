"""The program: ``python -m towercrane`` and the command ``towercrane``."""

from __future__ import annotations

from typing import TYPE_CHECKING

from towercrane.commands.shared.program import program

if TYPE_CHECKING:
    from typer import Typer


def main() -> None:
    """Entry point."""
    program(_commands)


def _commands() -> Typer:
    from towercrane.cli import app

    return app


if __name__ == "__main__":
    main()
