"""The program, called as its command is, without the second or two that a process of its own takes to start."""

import contextlib
import gc
import io
import os
import signal
import subprocess
import sys
import warnings
from pathlib import Path
from unittest import mock

from towercrane.cli import main


def towercrane(*arguments: str, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
    """What it prints and the code that it ends with."""
    threshold, handler = gc.get_threshold(), signal.getsignal(signal.SIGINT)
    command, out, err = ["towercrane", *arguments], io.StringIO(), io.StringIO()
    with contextlib.ExitStack() as stack:
        stack.enter_context(contextlib.chdir(cwd or Path.cwd()))
        stack.enter_context(mock.patch.object(sys, "argv", command))
        stack.enter_context(mock.patch.dict(os.environ, NO_COLOR="1"))
        stack.enter_context(contextlib.redirect_stdout(out))
        stack.enter_context(contextlib.redirect_stderr(err))
        # The program says warnings, and its own way of saying them goes with it.
        stack.enter_context(warnings.catch_warnings())
        warnings.resetwarnings()
        try:
            main()
        except SystemExit as ending:
            code = int(ending.code or 0)
        finally:
            gc.set_threshold(*threshold)
            gc.unfreeze()
            signal.signal(signal.SIGINT, handler)
    return subprocess.CompletedProcess(command, code, out.getvalue(), err.getvalue())
