"""The command line as a program: every ending becomes a message and an exit code.

Ctrl-C is watched for before anything heavy is imported: a library that meets it in its own code turns it into another
error, or into none.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
import warnings
from typing import TYPE_CHECKING, Any, NoReturn

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from typer import Typer

GARBAGE = 500_000
"""New objects between two searches for garbage."""

INTERRUPTED = 130
"""Exit code of Ctrl-C."""

CLOSED_PIPE = 141
"""Exit code where the reader of the output has gone, as of a program that the signal SIGPIPE ends."""


def program(commands: Callable[[], Typer]) -> NoReturn:
    """Run the command line: bad input becomes a message and exit code 2, Ctrl-C exit code 130.

    Parameters
    ----------
    commands : callable
        Gives the commands; called when Ctrl-C is watched for, since they take long to import.
    """
    import gc

    interrupts = _watch()
    # Imports make objects by the hundred thousand that live to the end: searching them for garbage costs 0.2 s a run.
    gc.set_threshold(GARBAGE)
    for stream in (sys.stdout, sys.stderr):
        # A terminal that lacks a letter shows its number.
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")
    try:
        code = _run(commands)
        sys.stdout.flush()
    except BaseException as error:
        code = _code(error, bool(interrupts))
    if code == CLOSED_PIPE:
        os._exit(code)
    if interrupts or code == INTERRUPTED:
        from towercrane.commands.shared.terminal import say

        say("interrupted")
        # At once: after Ctrl-C an orderly end may report the signal instead.
        sys.stdout.flush()
        os._exit(INTERRUPTED)
    # Nor are they searched once more at the end.
    gc.freeze()
    sys.exit(code)


def _run(commands: Callable[[], Typer]) -> int:
    """Do what the arguments say; the exit code."""
    app = commands()
    from towercrane.commands.shared.terminal import show_warning

    warnings.showwarning = lambda message, *place, **more: show_warning(message)
    return app(standalone_mode=False) or 0


def _code(error: BaseException, interrupted: bool) -> Any:
    """Exit code of an ending by an exception, whose message is said; one that nobody foresaw is raised again."""
    from towercrane.commands.shared.terminal import BAD_INPUT, say
    from towercrane.schema.faults import CaseError

    causes = list(_causes(error))
    if any(isinstance(cause, BrokenPipeError) for cause in causes):
        return CLOSED_PIPE
    if interrupted or any(isinstance(cause, KeyboardInterrupt) for cause in causes):
        return INTERRUPTED
    if isinstance(error, SystemExit):
        return error.code
    if isinstance(error, CaseError):
        say(str(error))
    elif isinstance(error, OSError):
        say(f"cannot write the output: {error.strerror or error}")
    # What typer finds wrong with the arguments; its classes have moved from one version to the next.
    elif hasattr(error, "format_message"):
        context, message = getattr(error, "ctx", None), error.format_message()
        # Without arguments there is help instead of a message.
        if message:
            say("\n".join([*([context.get_usage()] if context else []), message]))
    else:
        raise error
    return BAD_INPUT


def _watch() -> list[int]:
    """Signals of Ctrl-C from now on; where they are ignored they stay so."""
    caught: list[int] = []

    def note(number: int, frame: Any) -> None:
        caught.append(number)
        raise KeyboardInterrupt

    if (
        threading.current_thread() is threading.main_thread()
        and signal.getsignal(signal.SIGINT) is not signal.SIG_IGN
    ):
        signal.signal(signal.SIGINT, note)
    return caught


def _causes(error: BaseException) -> Iterator[BaseException]:
    """An exception and those it came from."""
    found: BaseException | None = error
    while found is not None:
        yield found
        found = found.__cause__ or found.__context__
