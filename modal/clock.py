"""Time that a call takes."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, TypeVar

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

Result = TypeVar("Result")


def timed(function: Callable[[], Result], repeats: int = 5) -> tuple[Result, float]:
    """Result and median time of a few calls [s]; the first, which loads code, is not counted."""
    result = function()
    seconds = []
    for _ in range(repeats):
        began = time.perf_counter()
        function()
        seconds.append(time.perf_counter() - began)
    return result, float(np.median(seconds))
